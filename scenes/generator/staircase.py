"""A hall with a helical staircase, lit through one high window."""

import dataclasses
import math

from . import materials, props, textures
from .geometry import Transform, on_circle
from .mesh import Mesh, merged
from .parameters import Checked, parameter
from .scene_folder import SceneFolder
from .solids import box, boxes, prism
from .surfaces import arc, grid, lathe, tube
from .xml import Element, to_world

HEADER = """
A hall with a helical staircase, in metres: oak treads between a newel and a painted string, steel balusters, a gallery.
All light comes from the sky, through two windows in the left wall: a tall one out of sight, before the gallery, and a
small one above it.

What it stresses: light that reaches much of the hall (below the gallery, behind the treads, the ceiling) only after
several bounces; a glossy floor that shows the staircase; thin occluders (balusters) by the hundred; rough metal; strong
contrast beside the window.
Made by scripts/generate-scenes. CC0.
"""

LEFT, RIGHT, BACK, FRONT, CEILING = -2.3, 1.9, -2.6, 6.6, 6.2  # inner faces of the room
WALL = 0.3  # its thickness
AXIS_X, AXIS_Z = 0.25, 0.0
NEWEL_RADIUS = 0.08
TREAD_THICKNESS = 0.045
END_ANGLE = -90.0  # the staircase ends behind its axis, and is left towards -x
# Openings in the left wall, as (z0, z1, y0, y1), from the back to the front.
WINDOWS = ((-1.7, -0.8, 4.3, 5.5), (0.9, 2.5, 1.1, 4.6))
SKY = (11.0, 12.0, 13.5)  # radiance of what is seen through them


@dataclasses.dataclass(frozen=True)
class Parameters(Checked):
    """The staircase; the hall around it is fixed."""

    steps: int = parameter(17, "treads between floor and gallery", 8, 24)
    turn: float = parameter(255.0, "angle that the staircase turns through, degrees", 180.0, 270.0)
    radius: float = parameter(1.2, "outer radius of the treads, metres", 0.9, 1.3)
    gallery: float = parameter(3.33, "height of the gallery's floor, metres", 2.8, 3.6)
    rail: float = parameter(0.95, "height of handrails above treads and gallery, metres", 0.8, 1.1)
    balusters: int = parameter(2, "balusters on each tread", 1, 4)


def generate(parameters):
    scene = SceneFolder(HEADER, width=720, height=1280)
    scene.camera((-0.15, 1.6, 6.3), (-0.12, 2.3, 0), fov=66, fov_axis="y")
    _add_materials(scene)
    _add_room(scene)
    _add_stairs(scene, parameters)
    _add_railings(scene, parameters)
    _add_gallery(scene, parameters)
    _add_windows(scene)
    _add_furniture(scene)
    return scene


def _add_materials(scene):
    oak = scene.texture("oak", textures.wood((0.72, 0.52, 0.33), (0.50, 0.32, 0.18), seed=11))
    view = scene.texture("landscape", textures.landscape(seed=5))
    bands = scene.texture("bands", textures.abstract(
        31, ((0.80, 0.74, 0.62), (0.22, 0.30, 0.36), (0.72, 0.40, 0.24), (0.86, 0.82, 0.76), (0.35, 0.42, 0.40))))
    two_sided = materials.two_sided
    scene.material("plaster", two_sided(materials.diffuse((0.78, 0.74, 0.67))))
    scene.material("ceiling_white", two_sided(materials.diffuse((0.82, 0.81, 0.79))))
    scene.material("floor_tiles", two_sided(materials.rough_plastic(
        materials.checkerboard("diffuse_reflectance", (0.62, 0.58, 0.52), (0.06, 0.07, 0.08), repeats=1.0), 0.08)))
    scene.material("oak", two_sided(materials.rough_plastic(materials.bitmap("diffuse_reflectance", oak), 0.2)))
    scene.material("paint", two_sided(materials.rough_plastic((0.76, 0.75, 0.72), 0.25)))
    scene.material("steel", two_sided(materials.rough_metal("chromium", 0.2)))
    scene.material("brass", two_sided(materials.rough_metal("gold", 0.15)))
    scene.material("green_glaze", two_sided(materials.plastic((0.05, 0.20, 0.19))))
    scene.material("clay", two_sided(materials.diffuse((0.52, 0.25, 0.15))))
    scene.material("soil", two_sided(materials.diffuse((0.06, 0.045, 0.035))))
    scene.material("leaf", two_sided(materials.rough_plastic((0.10, 0.24, 0.06), 0.3)))
    scene.material("twig", two_sided(materials.diffuse((0.16, 0.10, 0.07))))
    scene.material("landscape", two_sided(materials.diffuse(materials.bitmap("reflectance", view))))
    scene.material("bands", two_sided(materials.diffuse(materials.bitmap("reflectance", bands))))
    scene.material("black", materials.diffuse((0.0, 0.0, 0.0)))


def _add_room(scene):
    x0, x1, z0, z1, top = LEFT, RIGHT, BACK, FRONT, CEILING
    tiles = Mesh()
    tile = 0.9
    corners = [(x0, 0, z1), (x1, 0, z1), (x1, 0, z0), (x0, 0, z0)]
    tiles.add_polygon(corners, [(x / tile, -z / tile) for x, _, z in corners])
    scene.mesh("floor", tiles, "floor_tiles")

    walls = boxes([((x1, 0, z0 - WALL), (x1 + WALL, top, z1)), ((x0 - WALL, 0, z0 - WALL), (x1, top, z0)),
                   ((x0 - WALL, 0, z1), (x1 + WALL, top, z1 + WALL)), *_wall_with_windows()])
    scene.mesh("walls", walls, "plaster")
    scene.mesh("ceiling", box((x0 - WALL, top, z0 - WALL), (x1 + WALL, top + 0.2, z1 + WALL)), "ceiling_white")

    board, high = 0.018, 0.16
    scene.mesh("skirting", boxes([((x0, 0, z0), (x1, high, z0 + board)), ((x0, 0, z0 + board), (x0 + board, high, z1)),
                                  ((x1 - board, 0, z0 + board), (x1, high, z1))], bevel=0.004), "paint")


def _wall_with_windows():
    """The left wall, in uprights beside its windows and pieces above and below each."""
    outer = LEFT - WALL
    edge = BACK
    for z0, z1, y0, y1 in WINDOWS:
        yield (outer, 0, edge), (LEFT, CEILING, z0)
        yield (outer, 0, z0), (LEFT, y0, z1)
        yield (outer, y1, z0), (LEFT, CEILING, z1)
        edge = z1
    yield (outer, 0, edge), (LEFT, CEILING, FRONT)


def _add_windows(scene):
    frames, sills = [], []
    for number, (z0, z1, y0, y1) in enumerate(WINDOWS, start=1):
        frames += _window_bars(z0, z1, y0, y1)
        sills.append(((LEFT - 0.15, y0 - 0.03, z0 - 0.05), (LEFT + 0.06, y0, z1 + 0.05)))
        sky = to_world(Element("scale", x=(z1 - z0) / 2 + 0.4, y=(y1 - y0) / 2 + 0.4), Element("rotate", y=1, angle=90),
                       Element("translate", x=LEFT - WALL - 0.25, y=(y0 + y1) / 2 + 0.2, z=(z0 + z1) / 2))
        scene.shape("rectangle", f"sky_{number}", "black", sky, emission=SKY)
    scene.mesh("windows", boxes(frames, bevel=0.003), "paint")
    scene.mesh("sills", boxes(sills, bevel=0.004), "paint")


def _window_bars(z0, z1, y0, y1):
    """A frame with a mullion and transoms at most 0.6 m apart, as bounds of boxes."""
    x0, x1, bar, thin = LEFT - 0.2, LEFT - 0.15, 0.05, 0.015
    yield (x0, y0, z0), (x1, y0 + bar, z1)
    yield (x0, y1 - bar, z0), (x1, y1, z1)
    yield (x0, y0 + bar, z0), (x1, y1 - bar, z0 + bar)
    yield (x0, y0 + bar, z1 - bar), (x1, y1 - bar, z1)
    middle = (z0 + z1) / 2
    yield (x0 + 0.01, y0 + bar, middle - thin), (x1 - 0.01, y1 - bar, middle + thin)
    panes = math.ceil((y1 - y0) / 0.6)
    for k in range(1, panes):
        y = y0 + (y1 - y0) * k / panes
        for low, high in ((z0 + bar, middle - thin), (middle + thin, z1 - bar)):
            yield (x0 + 0.01, y - thin, low), (x1 - 0.01, y + thin, high)


class _Helix:
    """Angles and heights along the staircase; angles fall from the first step to END_ANGLE."""

    def __init__(self, parameters):
        self.steps = parameters.steps
        self.rise = parameters.gallery / (parameters.steps + 1)
        self.step_angle = parameters.turn / parameters.steps
        self.first_angle = END_ANGLE + parameters.turn

    def point(self, step, radius, above=0.0):
        """The point `above` the line through the treads' front edges, `step` (a real number) treads from the first."""
        x, _, z = on_circle(radius, self.first_angle - step * self.step_angle)
        return (AXIS_X + x, (step + 1) * self.rise + above, AXIS_Z + z)


def _add_stairs(scene, parameters):
    helix = _Helix(parameters)
    treads = []
    for step in range(parameters.steps):
        high = helix.first_angle - step * helix.step_angle + 1.5  # the nosing stands out over the step below
        low = helix.first_angle - (step + 1) * helix.step_angle
        outline = [on_circle(parameters.radius, low + (high - low) * k / 4) for k in range(5)]
        outline += [on_circle(NEWEL_RADIUS - 0.01, high), on_circle(NEWEL_RADIUS - 0.01, low)]
        top = (step + 1) * helix.rise
        tread = prism([(x, z) for x, _, z in outline], top - TREAD_THICKNESS, top, uv_size=0.7)
        middle = (low + high) / 2
        tread.uvs = [_along_the_tread(p, middle, step) for p in tread.positions]
        treads.append(tread.moved(Transform.translation(AXIS_X, 0, AXIS_Z)))
    scene.mesh("treads", merged(treads), "oak")
    scene.mesh("string", _string(helix, parameters.radius, parameters.radius + 0.03), "paint")
    top = parameters.gallery + parameters.rail + 0.06
    newel = lathe([(NEWEL_RADIUS + 0.05, 0), (NEWEL_RADIUS + 0.05, 0.03), (NEWEL_RADIUS, 0.06), (NEWEL_RADIUS, top),
                   *arc((0, top + 0.06), 0.085, -60, 90, 10)], segments=40)
    scene.mesh("newel", props.placed(newel, AXIS_X, 0, AXIS_Z), "paint")


def _along_the_tread(point, angle, step):
    """Texture coordinates with the grain from the newel outwards, each tread from another part of the tree."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return ((c * point[0] + s * point[2]) / 0.7, (c * point[2] - s * point[0] + point[1]) / 0.7 + 0.37 * step)


def _string(helix, inner, outer):
    """The band that carries the treads' outer ends: four surfaces of a swept rectangle and its two ends."""
    pieces = 6 * helix.steps
    low, high = -0.20, 0.05
    sections = []
    for k in range(pieces + 1):
        step = helix.steps * k / pieces
        sections.append([helix.point(step, inner, max(low, -(step + 1) * helix.rise)), helix.point(step, inner, high),
                         helix.point(step, outer, high), helix.point(step, outer, max(low, -(step + 1) * helix.rise))])
    mesh = Mesh()
    for side in range(4):
        a, b = side, (side + 1) % 4
        mesh.add(grid([[section[a], section[b]] for section in sections]))
    uvs = [(0, 0), (0, 1), (1, 1), (1, 0)]
    mesh.add_polygon(sections[0][::-1], uvs)
    mesh.add_polygon(sections[-1], uvs)
    return mesh


def _add_railings(scene, parameters):
    helix = _Helix(parameters)
    radius = parameters.radius - 0.04
    end = AXIS_Z - radius
    path = [helix.point(parameters.steps * k / 96, radius, parameters.rail) for k in range(97)]
    rail_y = parameters.gallery + parameters.rail
    path += [(AXIS_X, rail_y, end - 0.12), (AXIS_X, rail_y, (BACK + end) / 2), (AXIS_X, rail_y, BACK + 0.001)]
    rails = [tube(path, 0.024, sides=10, uv_size=0.7),
             tube([(LEFT + 0.001, rail_y, AXIS_Z), (AXIS_X - NEWEL_RADIUS + 0.005, rail_y, AXIS_Z)], 0.024,
                  uv_size=0.7)]
    scene.mesh("handrails", merged(rails), "oak")

    bars = []
    for step in range(parameters.steps):
        for k in range(parameters.balusters):
            along = step + (k + 0.5) / parameters.balusters
            x, y, z = helix.point(along, radius, parameters.rail)
            bars.append(((x, (step + 1) * helix.rise, z), (x, y, z)))
    bars += [((x, parameters.gallery, AXIS_Z), (x, rail_y, AXIS_Z))
             for x in _spread(LEFT + 0.1, AXIS_X - NEWEL_RADIUS - 0.08, 0.115)]
    bars += [((AXIS_X, parameters.gallery, z), (AXIS_X, rail_y, z)) for z in _spread(BACK + 0.1, end - 0.1, 0.115)]
    scene.mesh("balusters", merged([tube(bar, 0.008, sides=6) for bar in bars]), "steel")


def _spread(first, last, spacing):
    """Places from first to last, evenly, at most `spacing` apart."""
    count = math.ceil((last - first) / spacing)
    return [first + (last - first) * k / count for k in range(count + 1)]


def _add_gallery(scene, parameters):
    """A floor over the back left of the hall: its front edge before the newel, its right edge at the last tread."""
    top = parameters.gallery
    scene.mesh("gallery_floor", box((LEFT, top - 0.03, BACK), (AXIS_X + 0.03, top, AXIS_Z + 0.04), bevel=0.004,
                                    uv_size=0.7), "oak")
    beam = ((LEFT, top - 0.26, AXIS_Z - 0.08), (AXIS_X - NEWEL_RADIUS, top - 0.03, AXIS_Z + 0.02))
    slab = ((LEFT, top - 0.18, BACK), (AXIS_X, top - 0.03, AXIS_Z - 0.08))
    scene.mesh("gallery", boxes([slab, beam], bevel=0.004), "paint")


def _add_furniture(scene):
    wall = BACK + 0.018
    scene.mesh("console", props.placed(props.table(1.1, 0.34, 0.82), -1.5, 0, wall + 0.19), "oak")
    scene.mesh("vase", props.placed(props.vase(0.34, 0.11), -1.78, 0.82, wall + 0.19), "green_glaze")
    scene.mesh("branches", props.placed(props.twigs(3, 9, 0.85, 0.38, 0.006), -1.78, 0.86, wall + 0.19), "twig")
    bowl = lathe([(0, 0), (0.05, 0), (0.06, 0.01), (0.13, 0.06), (0.15, 0.09), (0.143, 0.09), (0.12, 0.06),
                  (0.05, 0.02), (0, 0.018)], 40)
    scene.mesh("bowl", props.placed(bowl, -1.2, 0.82, wall + 0.17), "brass")

    for name, width, height, x, y in (("landscape", 0.9, 0.66, -1.35, 1.75), ("bands", 0.62, 0.62, -1.0, 4.75)):
        _hang(scene, name, width, height, Transform.translation(x, y, BACK))
    turn = Transform.rotation("y", -90)
    _hang(scene, "bands", 0.55, 0.75, Transform.translation(RIGHT, 1.75, -0.9) @ turn, suffix="_right")
    _hang(scene, "landscape", 0.8, 0.6, Transform.translation(RIGHT, 3.5, -0.9) @ turn, suffix="_right")

    pot, earth = props.pot(0.42, 0.24)
    stand = Transform.translation(1.42, 0, 0.95)
    scene.mesh("pot", pot.moved(stand), "clay")
    scene.mesh("earth", earth.moved(stand), "soil")
    leaves = props.blades(8, 34, 0.1, 0.95, 0.085, 0.8, 0.45, height=0.36)
    scene.mesh("plant", leaves.moved(stand), "leaf")


def _hang(scene, picture, width, height, place, suffix=""):
    name = f"{picture}{suffix}"
    scene.mesh(f"{name}_frame", props.picture_frame(width, height).moved(place), "oak")
    scene.mesh(f"{name}_canvas", props.canvas(width, height, 0.012).moved(place), picture)
