"""A clapboard house with a veranda in a garden, under a sun and a clear sky."""

import dataclasses
import math
import random

from . import materials, props, textures
from .geometry import Transform, normalise, on_circle, scale
from .mesh import Mesh, merged
from .parameters import Checked, parameter
from .scene_folder import SceneFolder
from .sky import environment
from .solids import box, boxes, frame, prism
from .surfaces import grid, heightfield, lathe, tube
from .xml import Element

HEADER = """
The veranda of a clapboard house, in metres, seen from its garden in the afternoon. The sky is Preetham's, a picture of
192 x 96 pixels in textures/sky.hdr; the sun is a directional emitter. Both are in units of 20 kcd/m^2.

What it stresses: light from infinity, by far the most of it from one direction; the shade below the roof, which is lit
by the sky, the lawn and the boards; thin geometry (balusters, clapboards, leaves cut out by masks); plants whose files
are placed several times; rooms behind panes, dark beside the lawn.
Made by scripts/generate-scenes. CC0.
"""

# The house's front wall is the plane z = 0 and the veranda stands before it, up to z = DEPTH.
WIDTH, DEPTH, FLOOR = 7.6, 2.3, 0.54
WALL_TOP, EAVES, RIDGE = 3.35, 2.95, 5.4
STAIRS_X, STAIRS_WIDTH = -0.6, 1.5
DOOR_X, DOOR_WIDTH, DOOR_HEIGHT = -0.6, 0.95, 2.1
WINDOWS_X, WINDOW_WIDTH, WINDOW_HEIGHT, WINDOW_LOW = (-2.55, 2.0), 1.15, 1.45, FLOOR + 0.75
POSTS = 5
UNIT = 0.05  # radiance in the scene of 1 kcd/m^2
SUN_ILLUMINANCE = (104.0, 92.0, 76.0)  # kilolux across the sun's direction, on a clear afternoon


@dataclasses.dataclass(frozen=True)
class Parameters(Checked):
    """The light and the garden; the house is fixed."""

    sun_elevation: float = parameter(38.0, "of the sun above the horizon, degrees", 5.0, 80.0)
    sun_azimuth: float = parameter(40.0, "of the sun from the front (+z) towards the left (-x), degrees", -80.0, 80.0)
    turbidity: float = parameter(2.5, "of the air: 2 very clear, 10 hazy", 2.0, 10.0)
    leaves: int = parameter(420, "leaves of a bush", 50, 3000)
    seed: int = parameter(1, "of the garden", 0, 1000000)


def generate(parameters):
    scene = SceneFolder(HEADER, width=1280, height=720)
    scene.camera((-5.3, 1.75, 10.6), (-0.1, 2.05, 0.9), fov=50)
    _add_materials(scene)
    _add_house(scene)
    _add_openings(scene)
    _add_deck(scene)
    _add_roof(scene)
    _add_railing(scene)
    _add_furniture(scene)
    _add_garden(scene, parameters)
    _add_daylight(scene, parameters)
    return scene


def _add_materials(scene):
    grass = scene.texture("grass", textures.grass(seed=2))
    boards = scene.texture("boards", textures.wood((0.62, 0.53, 0.43), (0.42, 0.34, 0.27), seed=51, rings=6))
    leaf = scene.texture("leaf", textures.leaf_opacity())
    two_sided = materials.two_sided
    scene.material("clapboard", two_sided(materials.diffuse((0.50, 0.60, 0.62))))
    scene.material("trim", two_sided(materials.rough_plastic((0.74, 0.73, 0.69), 0.3)))
    scene.material("boards", two_sided(materials.rough_plastic(materials.bitmap("diffuse_reflectance", boards), 0.3)))
    scene.material("shingles", two_sided(materials.diffuse((0.17, 0.13, 0.115))))
    scene.material("brick", two_sided(materials.diffuse((0.36, 0.16, 0.11))))
    scene.material("stone", two_sided(materials.diffuse((0.42, 0.40, 0.36))))
    scene.material("door_paint", two_sided(materials.rough_plastic((0.32, 0.05, 0.04), 0.2)))
    scene.material("brass", two_sided(materials.rough_metal("gold", 0.15)))
    scene.material("pane", materials.pane())
    scene.material("curtain", two_sided(materials.diffuse((0.72, 0.68, 0.60))))
    scene.material("room", two_sided(materials.diffuse((0.42, 0.36, 0.29))))
    scene.material("lawn", two_sided(materials.diffuse(materials.bitmap("reflectance", grass))))
    scene.material("cushion", two_sided(materials.diffuse((0.58, 0.18, 0.10))))
    scene.material("clay", two_sided(materials.diffuse((0.52, 0.25, 0.15))))
    scene.material("soil", two_sided(materials.diffuse((0.06, 0.045, 0.035))))
    scene.material("bark", two_sided(materials.diffuse((0.16, 0.11, 0.08))))
    scene.material("blade", two_sided(materials.rough_plastic((0.11, 0.26, 0.07), 0.3)))
    for name, colour in (("leaf", (0.12, 0.24, 0.06)), ("blossom", (0.66, 0.16, 0.27))):
        opacity = materials.bitmap("opacity", leaf, raw=True)
        scene.material(name, materials.mask(opacity, two_sided(materials.diffuse(colour))))


def _openings():
    """The door's and windows' openings in the front wall: (x0, x1, y0, y1), from left to right."""
    holes = [(x - WINDOW_WIDTH / 2, x + WINDOW_WIDTH / 2, WINDOW_LOW, WINDOW_LOW + WINDOW_HEIGHT) for x in WINDOWS_X]
    holes.append((DOOR_X - DOOR_WIDTH / 2, DOOR_X + DOOR_WIDTH / 2, FLOOR, FLOOR + DOOR_HEIGHT))
    return sorted(holes)


def _add_house(scene):
    """Clapboards around the openings, corner boards, side walls and the inside of the front room."""
    x0, x1, low, board = -WIDTH / 2, WIDTH / 2, FLOOR - 0.02, 0.115
    clapboards = Mesh()
    count = round((WALL_TOP - low) / board)
    for k in range(count):
        y0, y1 = low + k * board, low + (k + 1) * board
        for a, b in _free_spans(x0, x1, y0, y1):
            # Each board leans out over the one below it.
            for quad in ([(a, y0, 0.022), (b, y0, 0.022), (b, y1, 0.002), (a, y1, 0.002)],
                         [(a, y0, 0.002), (b, y0, 0.002), (b, y0, 0.022), (a, y0, 0.022)]):
                clapboards.add_polygon(quad, [(0, 0), (1, 0), (1, 1), (0, 1)])
    scene.mesh("clapboards", clapboards, "clapboard")
    corners = [((x - 0.07, 0.02, -0.02), (x + 0.07, WALL_TOP, 0.035)) for x in (x0, x1)]
    scene.mesh("corner_boards", boxes(corners, bevel=0.004), "trim")

    depth, thick = 4.2, 0.14
    shell = [((x0, 0.3, -depth), (x0 + thick, WALL_TOP, -0.02)), ((x1 - thick, 0.3, -depth), (x1, WALL_TOP, -0.02)),
             ((x0, 0.3, -depth - thick), (x1, WALL_TOP, -depth))]
    back = -depth - thick
    eaves = WALL_TOP + 0.75
    gable = [(WALL_TOP, -0.02), (eaves, -0.02), (RIDGE + 0.85, -2.2), (eaves, back), (WALL_TOP, back)]
    walls = boxes(shell)
    for x, outline in ((x0, gable), (x1, gable[::-1])):
        walls.add_polygon([(x, y, z) for y, z in outline], [(z, y) for y, z in outline])
    scene.mesh("side_walls", walls, "clapboard")
    front = [((a, y0, -thick), (b, y1, 0.0)) for y0, y1 in _bands(FLOOR, WALL_TOP)
             for a, b in _free_spans(x0 + thick, x1 - thick, y0, y1)]
    scene.mesh("front_wall", boxes(front), "room")
    scene.mesh("inside", boxes([((x0 + thick, FLOOR - 0.05, -depth), (x1 - thick, FLOOR - 0.001, -thick)),
                                ((x0 + thick, WALL_TOP - 0.4, -depth), (x1 - thick, WALL_TOP - 0.3, -thick)),
                                ((0.6, FLOOR, -depth), (0.7, WALL_TOP - 0.4, -thick))]), "room")
    scene.mesh("foundation", boxes([((x0 + 0.03, -0.1, -depth), (x1 - 0.03, FLOOR - 0.05, -0.03))]), "brick")


def _bands(low, high):
    """The wall cut at the openings' heights: (y0, y1), from below."""
    cuts = sorted({low, high, *(y for _, _, y0, y1 in _openings() for y in (y0, y1))})
    return list(zip(cuts, cuts[1:]))


def _free_spans(x0, x1, y0, y1):
    """The parts of x0 to x1 that no opening takes anywhere between y0 and y1 (but for the last few millimetres)."""
    spans, edge = [], x0
    for a, b, low, high in _openings():
        if low < y1 - 0.005 and high > y0 + 0.005:
            spans.append((edge, a))
            edge = b
    spans.append((edge, x1))
    return spans


def _add_openings(scene):
    frames, panes, curtains = [], Mesh(), Mesh()
    for x in WINDOWS_X:
        y = WINDOW_LOW + WINDOW_HEIGHT / 2
        place = Transform.translation(x, y, 0.0)
        frames.append(frame(WINDOW_WIDTH - 0.01, WINDOW_HEIGHT - 0.01, 0.1, 0.045).moved(place))
        frames.append(frame(WINDOW_WIDTH - 0.09, WINDOW_HEIGHT - 0.09, 0.045, 0.04).moved(
            Transform.translation(0, 0, -0.07) @ place))
        for low, high in (((-WINDOW_WIDTH / 2 + 0.04, -0.02, -0.065), (WINDOW_WIDTH / 2 - 0.04, 0.02, -0.03)),
                          ((-0.015, 0.02, -0.06), (0.015, WINDOW_HEIGHT / 2 - 0.04, -0.035)),
                          ((-0.015, -WINDOW_HEIGHT / 2 + 0.04, -0.06), (0.015, -0.02, -0.035))):
            frames.append(box(low, high, bevel=0.002).moved(place))
        frames.append(box((-WINDOW_WIDTH / 2 - 0.14, -WINDOW_HEIGHT / 2 - 0.14, 0.0),
                          (WINDOW_WIDTH / 2 + 0.14, -WINDOW_HEIGHT / 2 - 0.1, 0.09), bevel=0.004).moved(place))
        panes.add(props.canvas(WINDOW_WIDTH - 0.08, WINDOW_HEIGHT - 0.08, -0.048), place)
        for side in (-1, 1):
            inwards = Transform.translation(side * (WINDOW_WIDTH / 2 - 0.16), 0, -0.2)
            curtains.add(_curtain(0.34, WINDOW_HEIGHT + 0.1), inwards @ place)
    x, y = DOOR_X, FLOOR + DOOR_HEIGHT / 2
    jamb = [((x - DOOR_WIDTH / 2 - 0.1, FLOOR, 0), (x - DOOR_WIDTH / 2 + 0.005, FLOOR + DOOR_HEIGHT + 0.1, 0.045)),
            ((x + DOOR_WIDTH / 2 - 0.005, FLOOR, 0), (x + DOOR_WIDTH / 2 + 0.1, FLOOR + DOOR_HEIGHT + 0.1, 0.045)),
            ((x - DOOR_WIDTH / 2 + 0.005, y + DOOR_HEIGHT / 2 - 0.005, 0),
             (x + DOOR_WIDTH / 2 - 0.005, FLOOR + DOOR_HEIGHT + 0.1, 0.045))]
    frames.append(boxes(jamb, bevel=0.003))
    scene.mesh("window_frames", merged(frames), "trim")
    scene.mesh("panes", panes, "pane")
    scene.mesh("curtains", curtains, "curtain")
    leaf = props.door(DOOR_WIDTH - 0.02, DOOR_HEIGHT - 0.02)
    scene.mesh("door", props.placed(leaf, x, FLOOR + 0.005, -0.06), "door_paint")
    knob = lathe([(0.012, 0), (0.012, 0.03), (0.022, 0.036), (0.028, 0.05), (0.022, 0.064), (0, 0.07)], 24)
    place = Transform.translation(x + 0.4, FLOOR + 0.98, -0.021) @ Transform.rotation("x", 90)
    scene.mesh("knob", knob.moved(place), "brass")


def _curtain(width, height):
    """A hanging cloth in folds, facing +z, its centre at the origin."""
    rows = []
    for y in (-height / 2, height / 2):
        rows.append([(width * (k / 32 - 0.5), y, 0.025 * math.sin(2 * math.pi * 5 * k / 32)) for k in range(33)])
    return grid(rows)


def _add_deck(scene):
    x0, x1 = -WIDTH / 2 - 0.1, WIDTH / 2 + 0.1
    width, gap = 0.14, 0.006
    count = round(DEPTH / width)
    width = DEPTH / count
    planks = [box((x0, FLOOR - 0.035, 0.036 + k * width), (x1, FLOOR, 0.036 + (k + 1) * width - gap), bevel=0.003,
                  uv_size=1.1, uv_offset=(0.31 * k, 0.17 * k)) for k in range(count)]
    step_rise = FLOOR / 4
    for k in range(3):
        top, z = FLOOR - (k + 1) * step_rise, DEPTH + 0.036 + k * 0.29
        planks.append(box((STAIRS_X - STAIRS_WIDTH / 2, top - 0.04, z), (STAIRS_X + STAIRS_WIDTH / 2, top, z + 0.31),
                          bevel=0.004, uv_size=1.1, uv_offset=(0.4 * k, 0.3 * k)))
    scene.mesh("deck", merged(planks), "boards")
    edge = DEPTH + 0.03
    below = [((x0 + 0.01, FLOOR - 0.24, edge - 0.05), (x1 - 0.01, FLOOR - 0.036, edge)),
             ((x0 + 0.01, FLOOR - 0.24, 0.04), (x0 + 0.06, FLOOR - 0.036, edge - 0.05)),
             ((x1 - 0.06, FLOOR - 0.24, 0.04), (x1 - 0.01, FLOOR - 0.036, edge - 0.05))]
    for k in range(3):
        top, z = FLOOR - (k + 1) * step_rise - 0.04, DEPTH + 0.036 + k * 0.29
        for side in (-1, 1):
            x = STAIRS_X + side * (STAIRS_WIDTH / 2 - 0.08)
            below.append(((x - 0.03, -0.05, z + 0.02), (x + 0.03, top, z + 0.29)))
    scene.mesh("deck_trim", boxes(below, bevel=0.003), "trim")
    piers = [((x - 0.16, -0.15, edge - 0.36), (x + 0.16, FLOOR - 0.24, edge - 0.04)) for x in _post_places()]
    scene.mesh("piers", boxes(piers), "brick")


def _post_places():
    first, last = -WIDTH / 2 + 0.05, WIDTH / 2 - 0.05
    return [first + (last - first) * k / (POSTS - 1) for k in range(POSTS)]


def _add_roof(scene):
    """The veranda's lean-to roof and, behind it, the slope of the house's own."""
    x0, x1, over = -WIDTH / 2 - 0.35, WIDTH / 2 + 0.35, 0.4
    front = DEPTH + over
    top = WALL_TOP + 0.55
    slope = (top - EAVES) / front
    shingles, rows = Mesh(), 15
    _add_shingles(shingles, x0, x1, (EAVES, front), (top, 0.03), rows)
    _add_shingles(shingles, x0 - 0.05, x1 + 0.05, (top + 0.3, 0.25), (RIDGE + 0.9, -2.2), 15)
    ridge, eaves = (RIDGE + 0.9, -2.2), (WALL_TOP + 0.75, -4.6)
    shingles.add_polygon([(x1 + 0.05, *eaves), (x0 - 0.05, *eaves), (x0 - 0.05, *ridge), (x1 + 0.05, *ridge)],
                         [(0, 0), (1, 0), (1, 1), (0, 1)])
    scene.mesh("shingles", shingles, "shingles")

    timber = Mesh()
    soffit = [(x0, EAVES - 0.03, front), (x0, top - 0.03, 0.03), (x1, top - 0.03, 0.03), (x1, EAVES - 0.03, front)]
    timber.add_polygon(soffit, [(0, 0), (0, 1), (1, 1), (1, 0)])
    for k in range(15):
        x = x0 + 0.1 + (x1 - x0 - 0.2) * k / 14
        low, high = EAVES + 0.01 - 0.13, top - 0.03 - 0.13
        rafter = box((x - 0.025, -0.06, 0), (x + 0.025, 0.06, math.hypot(front - 0.06, high - low)), bevel=0.003)
        tilt = Transform.rotation("x", math.degrees(math.atan(slope)))
        timber.add(rafter, Transform.translation(0, high + 0.0, 0.04) @ tilt)
    scene.mesh("rafters", timber, "trim")
    beam_z = DEPTH - 0.12
    under = EAVES + slope * (front - beam_z) - 0.03 - 0.2
    posts = []
    for x in _post_places():
        posts.append(((x - 0.06, FLOOR, beam_z - 0.06), (x + 0.06, under - 0.18, beam_z + 0.06)))
        posts.append(((x - 0.085, FLOOR, beam_z - 0.085), (x + 0.085, FLOOR + 0.16, beam_z + 0.085)))
        posts.append(((x - 0.085, under - 0.3, beam_z - 0.085), (x + 0.085, under - 0.24, beam_z + 0.085)))
    posts.append(((x0 + 0.25, under - 0.18, beam_z - 0.07), (x1 - 0.25, under, beam_z + 0.07)))
    gutter = ((x0 - 0.02, EAVES - 0.17, front - 0.02), (x1 + 0.02, EAVES + 0.0, front + 0.03))
    fascia = ((x0 - 0.05, top + 0.1, 0.2), (x1 + 0.05, top + 0.29, 0.25))
    frieze = ((x0 + 0.3, top + 0.0, 0.0), (x1 - 0.3, top + 0.3, 0.2))
    scene.mesh("posts", boxes([*posts, gutter, fascia, frieze], bevel=0.004), "trim")


def _add_shingles(mesh, x0, x1, low, high, rows):
    """Courses of shingles between the (y, z) of the lower and the upper edge, each lying on the one below."""
    thick = 0.02
    for k in range(rows):
        (y0, z0), (y1, z1) = ([a + (b - a) * (k + i) / rows for a, b in zip(low, high)] for i in (0, 1))
        courses = 46
        for i in range(courses):
            shift = 0.5 * (k % 2)
            a = max(x0, x0 + (x1 - x0) * (i - shift) / courses)
            b = min(x1, x0 + (x1 - x0) * (i + 1 - shift) / courses) if i + 1 < courses else x1
            lift = thick * (0.7 + 0.3 * ((i * 7 + k * 3) % 5) / 4)
            front = [(a, y0, z0), (b, y0, z0), (b, y0 + lift, z0), (a, y0 + lift, z0)]
            face = [(a, y0 + lift, z0), (b, y0 + lift, z0), (b, y1 + 0.002, z1), (a, y1 + 0.002, z1)]
            for quad in (front, face):
                mesh.add_polygon(quad, [(0, 0), (1, 0), (1, 1), (0, 1)])


def _add_railing(scene):
    z = DEPTH - 0.12
    left, right = STAIRS_X - STAIRS_WIDTH / 2 - 0.02, STAIRS_X + STAIRS_WIDTH / 2 + 0.02
    low, high = FLOOR + 0.12, FLOOR + 0.92
    bars = []

    def span(a, b):
        bars.append(box((a, high - 0.05, z - 0.035), (b, high, z + 0.035), bevel=0.006))
        bars.append(box((a, low - 0.05, z - 0.02), (b, low, z + 0.02), bevel=0.004))
        count = round((b - a) / 0.12)
        for k in range(1, count):
            x = a + (b - a) * k / count
            bars.append(box((x - 0.016, low, z - 0.016), (x + 0.016, high - 0.05, z + 0.016)))

    stops = [(x - 0.06, x + 0.06) for x in _post_places()]
    for side in (left, right):
        bars.append(box((side - 0.05, FLOOR, z - 0.05), (side + 0.05, high + 0.06, z + 0.05), bevel=0.006))
        stops.append((side - 0.05, side + 0.05))
    stops.sort()
    for (_, a), (b, _) in zip(stops, stops[1:]):
        if b - a > 0.1 and not (a >= left and b <= right):
            span(a, b)
    scene.mesh("railing", merged(bars), "trim")


def _add_furniture(scene):
    """A bench below the left window, a small table with a vase, pots beside the stairs."""
    bench = Mesh()
    for k in range(4):
        bench.add(box((-0.7, 0.40, -0.2 + 0.1 * k), (0.7, 0.43, -0.11 + 0.1 * k), bevel=0.004, uv_size=0.9,
                      uv_offset=(0.2 * k, 0.1 * k)))
    for k in range(3):
        y = 0.55 + 0.11 * k
        bench.add(box((-0.7, y, -0.24), (0.7, y + 0.09, -0.215), bevel=0.004, uv_size=0.9, uv_offset=(0.3 * k, 0.5)))
    for x in (-0.64, 0.64):
        bench.add(box((x - 0.03, 0, -0.215), (x + 0.03, 0.9, -0.165), bevel=0.004, along=1))
        bench.add(box((x - 0.03, 0, 0.12), (x + 0.03, 0.4, 0.17), bevel=0.004, along=1))
        bench.add(box((x - 0.03, 0.34, -0.165), (x + 0.03, 0.4, 0.12), bevel=0.003, along=2))
    scene.mesh("bench", props.placed(bench, 2.0, FLOOR, 0.42), "boards")
    cushion = box((-0.2, 0, -0.19), (0.2, 0.09, 0.19), bevel=0.035)
    scene.mesh("cushions", merged([props.placed(cushion, 1.62, FLOOR + 0.43, 0.42, 4),
                                   props.placed(cushion, 2.36, FLOOR + 0.43, 0.41, -6)]), "cushion")
    scene.mesh("table", props.placed(props.table(0.55, 0.55, 0.5), 3.1, FLOOR, 0.7), "boards")
    scene.mesh("jug", props.placed(props.vase(0.24, 0.08), 3.1, FLOOR + 0.5, 0.7), "clay")

    pot, earth = props.pot(0.36, 0.2)
    tuft = props.blades(4, 40, 0.09, 0.75, 0.06, 0.9, 0.5, height=0.31)
    places = [[Element("translate", x=x, y=FLOOR, z=z)] for x, z in ((-1.75, 1.75), (0.6, 1.75), (-3.3, 0.5))]
    scene.mesh("pot", pot, "clay", places)
    scene.mesh("earth", earth, "soil", places)
    scene.mesh("tuft", tuft, "blade", places)


def _add_garden(scene, parameters):
    def hills(x, z):
        away = max(0.0, math.hypot(x + 0.5, z - 2.0) - 6.0)
        return 0.012 * math.sin(0.9 * x + 0.4) * math.sin(0.7 * z) + 0.014 * away**1.5 - 0.012
    scene.mesh("lawn", heightfield(hills, (-40.0, 40.0), (-45.0, 22.0), 80, 67, uv_size=2.4), "lawn")

    random_ = random.Random(parameters.seed)
    stones = []
    for k in range(9):
        x, z = STAIRS_X - 0.1 * k - 0.012 * k * k, DEPTH + 1.25 + 0.62 * k
        outline = [on_circle(0.24 + 0.05 * random_.random(), angle) for angle in range(0, 360, 36)]
        ground = hills(x, z)
        stones.append(prism([(1.35 * px + x, pz + z) for px, _, pz in outline], ground - 0.04, ground + 0.025))
    scene.mesh("path", merged(stones), "stone")

    bush = _foliage(random_, parameters.leaves, 0.55, 0.5, 0.13)
    spots = [(-3.2, 3.0, 0.95), (-2.2, 3.05, 0.7), (1.1, 3.05, 0.8), (2.1, 3.0, 1.05), (3.2, 3.05, 0.85),
             (4.4, 2.4, 1.2), (-4.6, 1.6, 1.25), (-4.8, -0.5, 1.5), (4.9, 0.4, 1.6)]
    places = [[Element("scale", value=size), Element("rotate", y=1, angle=67 * k),
               Element("translate", x=x, y=hills(x, z) - 0.02, z=z)] for k, (x, z, size) in enumerate(spots)]
    scene.mesh("bush", bush, "leaf", places)
    blossoms = _foliage(random_, parameters.leaves // 6, 0.57, 0.52, 0.07)
    scene.mesh("blossoms", blossoms, "blossom", [places[k] for k in (0, 2, 3)])

    trunk = merged([tube([(0, -0.1, 0), (0.05, 1.2, 0.03), (-0.04, 2.6, 0.0)], [0.22, 0.17, 0.12], sides=12),
                    tube([(0.02, 1.9, 0.02), (0.7, 2.9, 0.2), (1.0, 3.8, 0.2)], [0.1, 0.07, 0.03], sides=8),
                    tube([(-0.02, 2.2, 0.0), (-0.6, 3.1, -0.3), (-0.8, 4.0, -0.4)], [0.1, 0.07, 0.03], sides=8)])
    crown = _foliage(random_, 4 * parameters.leaves, 1.9, 1.5, 0.26).moved(Transform.translation(0, 2.7, 0))
    spots = ((-8.5, -6.0, 1.5), (-13.5, -12.0, 2.0), (8.5, -7.0, 1.6), (9.0, 1.0, 1.2), (-19.0, -6.0, 1.8),
             (15.0, -13.0, 2.2), (-10.0, -22.0, 2.3))
    trees = [[Element("rotate", y=1, angle=80 * k), Element("scale", value=size),
              Element("translate", x=x, y=hills(x, z), z=z)] for k, (x, z, size) in enumerate(spots)]
    scene.mesh("trunk", trunk, "bark", trees)
    scene.mesh("crown", crown, "leaf", trees)


def _foliage(random_, count, radius, half_height, size):
    """Leaves over an ellipsoid that stands on the ground, facing outwards, denser towards its surface."""
    card = props.leaf_card(0.62 * size, size)
    leaves = Mesh()
    for k in range(count):
        y = 1 - 2 * (k + 0.5) / count
        angle = 137.508 * k + 20 * random_.random()
        shell = 0.62 + 0.38 * random_.random() ** 0.5
        flat = math.sqrt(1 - y * y)
        x, _, z = on_circle(radius * shell * flat, angle)
        leaves.add(card, Transform.translation(x, half_height * (1 + shell * y), z)
                   @ Transform.rotation("y", 90 - angle + 90 * (random_.random() - 0.5))
                   @ Transform.rotation("x", 40 * random_.random() - 55 * y))
    return leaves


def _add_daylight(scene, parameters):
    elevation, azimuth = math.radians(parameters.sun_elevation), math.radians(parameters.sun_azimuth)
    sun = (-math.cos(elevation) * math.sin(azimuth), math.sin(elevation), math.cos(elevation) * math.cos(azimuth))
    scene.environment("sky", environment(normalise(sun), parameters.turbidity, ground=(1.6, 1.8, 0.9)), UNIT)
    scene.sun(scale(sun, -1.0), tuple(UNIT * e for e in SUN_ILLUMINANCE))
