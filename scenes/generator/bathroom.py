"""A bathroom with a mirror, a free-standing bath behind a glass screen, chrome, tiles and a plant."""

import dataclasses
import math

from . import materials, props, textures
from .geometry import Transform, on_circle
from .mesh import Mesh, merged
from .parameters import Checked, parameter
from .scene_folder import SceneFolder
from .solids import box, boxes
from .surfaces import arc, grid, lathe, ring, tube
from .xml import Element, number, to_world

HEADER = """
A bathroom, in metres: a round mirror over a basin, a bath behind a pane of glass, a lace towel, a plant. Light comes
through a frosted window on the right, from two globes beside the mirror and from a ceiling lamp.

What it stresses: a mirror and chrome, which camera paths follow before they gather; light that the mirror throws back
into the room; a pane that is a vertex of every path through it (thindielectric), solid glass (dielectric); surfaces cut
out by masks; glossy tiles with a bump map; a small bright room, where connections are short.
Made by scripts/generate-scenes. CC0.
"""

LEFT, RIGHT, BACK, FRONT, CEILING = -1.6, 1.6, -1.5, 2.5, 2.6
TILED = 2.1  # height of the tiles
WINDOW_Z, WINDOW_Y = (-0.75, 0.45), (1.25, 2.15)
VANITY_X, VANITY_TOP, VANITY_DEPTH = (-1.3, 0.0), 0.8, 0.5
BASIN_X, MIRROR_Y = -0.65, 1.55
TILE = 0.6  # metres for one repeat of the wall's tiles


@dataclasses.dataclass(frozen=True)
class Parameters(Checked):
    """What may vary; the room is fixed."""

    tile_rows: int = parameter(6, "wall tiles in 0.6 m, upwards", 2, 12)
    mirror_radius: float = parameter(0.40, "radius of the round mirror, metres", 0.2, 0.45)
    glass_height: float = parameter(1.95, "height of the glass screen, metres", 1.5, 2.1)
    leaves: int = parameter(90, "leaves of the plant", 10, 400)
    window_radiance: float = parameter(17.0, "radiance of the frosted window", 0.0, 100.0)


def generate(parameters):
    scene = SceneFolder(HEADER, width=1024, height=1024)
    scene.camera((-0.35, 1.42, 2.35), (0.07, 1.07, -1.5), fov=57)
    _add_materials(scene, parameters)
    _add_room(scene)
    _add_lights(scene, parameters)
    _add_vanity(scene)
    _add_mirror(scene, parameters)
    _add_bath(scene)
    _add_screen(scene, parameters)
    _add_towel(scene)
    _add_small_things(scene)
    _add_plant(scene, parameters)
    return scene


def _add_materials(scene, parameters):
    rows = parameters.tile_rows
    wall = scene.texture("wall_tiles", textures.tiles((0.72, 0.85, 0.83), (0.90, 0.90, 0.88), rows // 2, rows, 0.035,
                                                      0.14, seed=3))
    relief = scene.texture("wall_relief", textures.tile_heights(rows // 2, rows, 0.035))
    floor = scene.texture("floor_tiles", textures.tiles((0.50, 0.50, 0.50), (0.70, 0.69, 0.67), 2, 2, 0.015, 0.22,
                                                        seed=8))
    wood = scene.texture("walnut", textures.wood((0.55, 0.38, 0.25), (0.33, 0.21, 0.13), seed=23))
    lace = scene.texture("lace", textures.lace_opacity())
    leaf = scene.texture("leaf", textures.leaf_opacity())
    two_sided = materials.two_sided
    scene.material("wall_tiles", two_sided(materials.bumpy(
        materials.bitmap("height", relief, raw=True),
        materials.rough_plastic(materials.bitmap("diffuse_reflectance", wall), 0.08), scale=0.004)))
    floor_colour = materials.bitmap("diffuse_reflectance", floor)
    scene.material("floor_tiles", two_sided(materials.rough_plastic(floor_colour, 0.15)))
    scene.material("plaster", two_sided(materials.diffuse((0.80, 0.79, 0.76))))
    scene.material("walnut", two_sided(materials.rough_plastic(materials.bitmap("diffuse_reflectance", wood), 0.2)))
    scene.material("stone", two_sided(materials.rough_plastic((0.70, 0.68, 0.64), 0.1)))
    scene.material("ceramic", two_sided(materials.plastic((0.80, 0.80, 0.78))))
    scene.material("chrome", two_sided(materials.rough_metal("chromium", 0.05)))
    scene.material("brass", two_sided(materials.rough_metal("gold", 0.12)))
    scene.material("mirror", two_sided(materials.mirror()))
    scene.material("pane", materials.pane())
    scene.material("glass", materials.glass())
    scene.material("towel", two_sided(materials.diffuse((0.62, 0.36, 0.26))))
    scene.material("lace", materials.mask(materials.bitmap("opacity", lace, raw=True),
                                          two_sided(materials.diffuse((0.80, 0.77, 0.70)))))
    scene.material("leaf", materials.mask(materials.bitmap("opacity", leaf, raw=True),
                                          two_sided(materials.rough_plastic((0.09, 0.25, 0.06), 0.25))))
    scene.material("stem", two_sided(materials.diffuse((0.20, 0.22, 0.09))))
    scene.material("soil", two_sided(materials.diffuse((0.06, 0.045, 0.035))))
    scene.material("amber", two_sided(materials.plastic((0.30, 0.10, 0.02))))
    scene.material("white_paint", two_sided(materials.rough_plastic((0.76, 0.75, 0.72), 0.2)))
    scene.material("black", materials.diffuse((0.0, 0.0, 0.0)))


def _rectangle(a, b, c, d, uv_size):
    """A flat wall; uvs run along a-b and a-d in metres / uv_size."""
    mesh = Mesh()
    width, height = math.dist(a, b) / uv_size, math.dist(a, d) / uv_size
    mesh.add_polygon([a, b, c, d], [(0, 0), (width, 0), (width, height), (0, height)])
    return mesh


def _add_room(scene):
    x0, x1, z0, z1, top = LEFT, RIGHT, BACK, FRONT, CEILING
    scene.mesh("floor", _rectangle((x0, 0, z1), (x1, 0, z1), (x1, 0, z0), (x0, 0, z0), 0.8), "floor_tiles")
    scene.mesh("ceiling", _rectangle((x0, top, z0), (x1, top, z0), (x1, top, z1), (x0, top, z1), 1.0), "plaster")

    def wall(a, b, low, high, uv_size):
        return _rectangle((a[0], low, a[1]), (b[0], low, b[1]), (b[0], high, b[1]), (a[0], high, a[1]), uv_size)

    (w0, w1), (y0, y1) = WINDOW_Z, WINDOW_Y
    tiled = [wall((x0, z1), (x0, z0), 0, TILED, TILE), wall((x0, z0), (x1, z0), 0, TILED, TILE),
             wall((x1, z0), (x1, z1), 0, y0, TILE), wall((x1, z0), (x1, w0), y0, TILED, TILE),
             wall((x1, w1), (x1, z1), y0, TILED, TILE), wall((x1, z1), (x0, z1), 0, TILED, TILE)]
    scene.mesh("tiled_walls", merged(tiled), "wall_tiles")
    plain = [wall((x0, z1), (x0, z0), TILED, top, 1.0), wall((x0, z0), (x1, z0), TILED, top, 1.0),
             wall((x1, z1), (x0, z1), TILED, top, 1.0), wall((x1, w1), (x1, z1), TILED, top, 1.0),
             wall((x1, z0), (x1, w0), TILED, top, 1.0), wall((x1, w0), (x1, w1), y1, top, 1.0)]
    scene.mesh("upper_walls", merged(plain), "plaster")
    deep = x1 + 0.2
    reveal = [_rectangle((x1, y0, w1), (deep, y0, w1), (deep, y0, w0), (x1, y0, w0), 1.0),
              _rectangle((x1, y1, w0), (deep, y1, w0), (deep, y1, w1), (x1, y1, w1), 1.0),
              _rectangle((x1, y0, w0), (deep, y0, w0), (deep, y1, w0), (x1, y1, w0), 1.0),
              _rectangle((deep, y0, w1), (x1, y0, w1), (x1, y1, w1), (deep, y1, w1), 1.0)]
    scene.mesh("window_reveal", merged(reveal), "plaster")
    bar, middle = 0.05, (w0 + w1) / 2
    bars = [((deep - 0.06, y0, w0), (deep - 0.01, y0 + bar, w1)), ((deep - 0.06, y1 - bar, w0), (deep - 0.01, y1, w1)),
            ((deep - 0.06, y0 + bar, w0), (deep - 0.01, y1 - bar, w0 + bar)),
            ((deep - 0.06, y0 + bar, w1 - bar), (deep - 0.01, y1 - bar, w1)),
            ((deep - 0.06, y0 + bar, middle - bar / 2), (deep - 0.01, y1 - bar, middle + bar / 2))]
    scene.mesh("window_frame", boxes(bars, bevel=0.004), "white_paint")
    scene.mesh("door", props.placed(props.door(0.85, 2.02), 0.75, 0.001, FRONT, 180), "white_paint")


def _add_lights(scene, parameters):
    (w0, w1), (y0, y1) = WINDOW_Z, WINDOW_Y
    window = to_world(Element("scale", x=(w1 - w0) / 2, y=(y1 - y0) / 2), Element("rotate", y=1, angle=-90),
                      Element("translate", x=RIGHT + 0.195, y=(y0 + y1) / 2, z=(w0 + w1) / 2))
    r = parameters.window_radiance
    scene.shape("rectangle", "window", "black", window, emission=(0.90 * r, 0.97 * r, 1.08 * r))

    dish = lathe([(0, 0), (0.19, 0), (0.2, 0.01), (0.2, 0.055)], 48)
    scene.mesh("ceiling_lamp", props.placed(dish, 0, CEILING - 0.055, 0.6), "brass")
    lamp = to_world(Element("scale", x=0.18, y=0.18), Element("rotate", x=1, angle=90),
                    Element("translate", x=0.0, y=CEILING - 0.056, z=0.6))
    scene.shape("disk", "ceiling_light", "black", lamp, emission=(20.0, 18.0, 15.0))


def _add_vanity(scene):
    x0, x1 = VANITY_X
    front = BACK + VANITY_DEPTH
    low, top = 0.16, VANITY_TOP - 0.04
    carcass = [((x0, low, BACK), (x1, top, front - 0.02))]
    doors = 3
    for k in range(doors):
        a, b = x0 + (x1 - x0) * k / doors, x0 + (x1 - x0) * (k + 1) / doors
        carcass.append(((a + 0.004, low + 0.004, front - 0.02), (b - 0.004, top - 0.004, front)))
    carcass += [((x, 0, z), (x + 0.05, low, z + 0.05))
                for x in (x0 + 0.02, x1 - 0.07) for z in (BACK + 0.02, front - 0.1)]
    scene.mesh("vanity", boxes(carcass, bevel=0.003, uv_size=0.7), "walnut")
    scene.mesh("counter", box((x0 - 0.01, top, BACK), (x1 + 0.01, VANITY_TOP, front + 0.02), bevel=0.004), "stone")
    knob_places = [(x0 + (x1 - x0) * k / doors + 0.05, low + 0.38) for k in range(doors)]
    knobs = [tube([(x, y, front), (x, y, front + 0.025)], 0.011, sides=16) for x, y in knob_places]
    scene.mesh("knobs", merged(knobs), "brass")

    rim = arc((0.205, 0.135), 0.009, 0, 180, 6)
    bowl = [(0, 0), (0.09, 0), (0.13, 0.025), (0.185, 0.085), (0.214, 0.135), *rim[1:], (0.175, 0.085), (0.12, 0.035),
            (0.07, 0.018), (0.018, 0.014), (0, 0.014)]
    centre = Transform.translation(BASIN_X, VANITY_TOP, BACK + 0.27)
    scene.mesh("basin", lathe(bowl, 64).moved(centre), "ceramic")
    drain = lathe([(0.022, 0.0145), (0.022, 0.019), (0.018, 0.021), (0, 0.021)], 24)
    scene.mesh("drain", drain.moved(centre), "chrome")
    scene.mesh("tap", _tap(0.24, 0.15).moved(Transform.translation(BASIN_X, VANITY_TOP, BACK + 0.045)), "chrome")


def _tap(height, reach):
    """A swan-necked tap on a foot, its mouth `reach` towards +z, with a lever on its right."""
    foot = lathe([(0.028, 0), (0.028, 0.008), (0.017, 0.012), (0.017, 0.05), (0.0, 0.05)], 24)
    radius = reach / 2
    neck = [(0, 0.05, 0), (0, height - radius, 0)]
    for k in range(1, 13):
        angle = math.radians(180 - 15 * k)
        neck.append((0, height - radius + radius * math.sin(angle), radius + radius * math.cos(angle)))
    neck.append((0, height - radius - 0.03, reach))
    lever = tube([(0.012, 0.035, 0), (0.05, 0.038, 0), (0.095, 0.062, 0)], [0.008, 0.006, 0.005], sides=12)
    return merged([foot, tube(neck, 0.011, sides=14), lever])


def _add_mirror(scene, parameters):
    radius, z = parameters.mirror_radius, BACK + 0.02
    place = to_world(Element("scale", x=radius, y=radius), Element("translate", x=BASIN_X, y=MIRROR_Y, z=z))
    scene.shape("disk", "mirror_glass", "mirror", place)
    centre = Transform.translation(BASIN_X, MIRROR_Y, z)
    scene.mesh("mirror_ring", ring(radius, 0.014, 72, 12).moved(centre), "brass")
    back = lathe([(radius, 0), (radius, 0.018), (0, 0.018)], 48).moved(Transform.rotation("x", 90))
    scene.mesh("mirror_back", back.moved(Transform.translation(BASIN_X, MIRROR_Y, BACK)), "walnut")
    arms = []
    for k, side in enumerate((-1, 1), start=1):
        x = BASIN_X + side * (radius + 0.14)
        y = MIRROR_Y + 0.1
        arms.append(tube([(x, y, BACK), (x, y, BACK + 0.09), (x, y + 0.03, BACK + 0.1)], 0.009, sides=12))
        arms.append(lathe([(0.012, 0), (0.035, 0.008), (0.035, 0.02), (0, 0.02)], 24).moved(
            Transform.translation(x, MIRROR_Y + 0.125, BACK + 0.1)))
        centre = Element("point", name="center", x=x, y=MIRROR_Y + 0.199, z=BACK + 0.1)
        scene.shape("sphere", f"globe_{k}", "black", centre, number("radius", 0.055), emission=(14.0, 11.0, 7.5))
    scene.mesh("lamp_arms", merged(arms), "brass")


def _superellipse(half_x, half_z, y, count=56):
    """A closed ring of points with flattened sides, counter-clockwise seen from above."""
    points = []
    for k in range(count + 1):
        angle = -2 * math.pi * (k % count) / count
        c, s = math.cos(angle), math.sin(angle)
        points.append((half_x * math.copysign(abs(c) ** 0.75, c), y, half_z * math.copysign(abs(s) ** 0.75, s)))
    return points


def _add_bath(scene):
    sections = [(0.27, 0.62, 0.0), (0.29, 0.65, 0.04), (0.325, 0.72, 0.25), (0.36, 0.79, 0.5), (0.378, 0.815, 0.575),
                (0.39, 0.83, 0.585), (0.392, 0.832, 0.595), (0.385, 0.825, 0.603), (0.365, 0.803, 0.603),
                (0.352, 0.79, 0.592), (0.335, 0.765, 0.5), (0.295, 0.69, 0.25), (0.255, 0.6, 0.13), (0.2, 0.5, 0.1),
                (0.1, 0.3, 0.095), (0.03, 0.03, 0.094)]
    place = Transform.translation(1.03, 0.0, -0.5)
    scene.mesh("bath", grid([_superellipse(*section) for section in sections]).moved(place), "ceramic")
    drain = lathe([(0.038, 0.094), (0.038, 0.098), (0.03, 0.101), (0, 0.101)], 28).moved(place)
    pipes = [tube([(0.9, 0, BACK + 0.09), (0.9, 0.8, BACK + 0.09)], 0.012, sides=14),
             tube([(1.16, 0, BACK + 0.09), (1.16, 0.8, BACK + 0.09)], 0.012, sides=14),
             tube([(0.84, 0.81, BACK + 0.09), (1.22, 0.81, BACK + 0.09)], 0.026, sides=18),
             tube([(1.03, 0.81, BACK + 0.09), (1.03, 0.82, BACK + 0.22), (1.03, 0.8, BACK + 0.27)], 0.014, sides=14),
             tube([(1.03, 0.83, BACK + 0.06), (1.03, 2.0, BACK + 0.06), (1.03, 2.08, BACK + 0.1),
                   (1.03, 2.1, BACK + 0.2), (1.03, 2.1, BACK + 0.36), (1.03, 2.06, BACK + 0.38)], 0.009, sides=12)]
    head = lathe([(0.11, 0), (0.112, 0.006), (0.03, 0.02), (0.012, 0.05), (0.0, 0.05)], 40)
    underside = lathe([(0, 0), (0.11, 0)], 40)
    shower = merged([head, underside]).moved(Transform.translation(1.03, 2.01, BACK + 0.38))
    scene.mesh("bath_fittings", merged([*pipes, drain, shower]), "chrome")


def _add_screen(scene, parameters):
    x, z0, z1, top = 0.48, BACK + 0.012, -0.35, parameters.glass_height
    pane = _rectangle((x, 0.012, z0), (x, 0.012, z1), (x, top, z1), (x, top, z0), 1.0)
    scene.mesh("screen", pane, "pane")
    rails = [((x - 0.012, 0, BACK), (x + 0.012, top, BACK + 0.02)),
             ((x - 0.012, 0, BACK + 0.02), (x + 0.012, 0.02, z1)),
             ((x - 0.008, top - 0.004, BACK + 0.02), (x + 0.008, top + 0.008, z1)),
             ((x - 0.008, 0.02, z1 - 0.004), (x + 0.008, top - 0.004, z1 + 0.008))]
    bars = boxes(rails, bevel=0.001)
    bars.add(tube([(x + 0.008, top - 0.02, z1 - 0.03), (RIGHT, top - 0.02, z1 - 0.03)], 0.009, sides=12))
    scene.mesh("screen_rails", bars, "chrome")


def _drape(x0, x1, rail_y, rail_z, radius, front, back):
    """A cloth over a rail along x: `front` and `back` are the lengths that hang down before and behind it."""
    profile = [(rail_y - back * (1 - k / 6), -radius) for k in range(6)]
    profile += [(rail_y + radius * math.sin(math.pi * k / 6), -radius * math.cos(math.pi * k / 6)) for k in range(7)]
    profile += [(rail_y - front * k / 10, radius) for k in range(1, 11)]
    columns = 28
    rows, uvs = [], []
    travelled = 0.0
    for k, (y, z) in enumerate(profile):
        if k:
            travelled += math.dist(profile[k - 1], (y, z))
        hanging = max(0.0, rail_y - y)
        row = []
        for i in range(columns + 1):
            t = i / columns
            fold = 0.05 * hanging * (1 + math.sin(13 * t + 0.6)) * math.copysign(1, z)
            row.append((x0 + (x1 - x0) * (t + 0.1 * hanging * (0.5 - t)), y, rail_z + z + 0.5 * fold))
        rows.append(row)
        uvs.append([(i / columns * (x1 - x0), -travelled) for i in range(columns + 1)])
    return rows, uvs


def _add_towel(scene):
    y, z = 1.18, BACK + 0.09
    rail = tube([(0.08, y, BACK), (0.08, y, z), (0.42, y, z), (0.42, y, BACK)], 0.008, sides=12)
    scene.mesh("towel_rail", rail, "chrome")
    rows, uvs = _drape(0.12, 0.38, y, z, 0.013, 0.42, 0.36)
    scene.mesh("towel", grid(rows, uvs), "towel")
    edge = rows[-1]
    lace_rows, lace_uvs = [], []
    for k in range(4):
        lace_rows.append([(x, yy - 0.1 * k / 3, zz) for x, yy, zz in edge])
        lace_uvs.append([(i / (len(edge) - 1) * 3, 1 - k / 3) for i in range(len(edge))])
    scene.mesh("lace_hem", grid(lace_rows, lace_uvs), "lace")


def _add_small_things(scene):
    top = VANITY_TOP
    tumbler = props.placed(props.cup(0.10, 0.036, wall=0.003, base=0.008), -0.22, top + 0.0005, BACK + 0.16)
    scene.mesh("tumbler", tumbler, "glass")
    brushes = [tube([(-0.235, top + 0.012, BACK + 0.15), (-0.205, top + 0.185, BACK + 0.175)], 0.0045, sides=8),
               tube([(-0.205, top + 0.012, BACK + 0.165), (-0.245, top + 0.18, BACK + 0.15)], 0.0045, sides=8)]
    scene.mesh("brushes", merged(brushes), "towel")
    wide = [(0, 0), (0.034, 0), (0.036, 0.003), (0.036, 0.11), (0.033, 0.122), (0.014, 0.132), (0.013, 0.15), (0, 0.15)]
    slim = [(0.8 * radius, 1.25 * height) for radius, height in wide]
    bottles = [props.placed(lathe(wide, 32), -1.12, top, BACK + 0.14),
               props.placed(lathe(slim, 32), -1.2, top, BACK + 0.22)]
    scene.mesh("bottles", merged(bottles), "amber")
    soap = box((-0.045, 0, -0.03), (0.045, 0.024, 0.03), bevel=0.008)
    scene.mesh("soap", props.placed(soap, -0.3, top, BACK + 0.36, 25), "ceramic")
    rug = box((-0.45, 0.0, -0.28), (0.45, 0.015, 0.28), bevel=0.006)
    scene.mesh("rug", props.placed(rug, -0.6, 0.0005, -0.5), "towel")


def _add_plant(scene, parameters):
    x, z = 0.24, -0.95
    stand = Transform.translation(x, 0, z)
    pot, earth = props.pot(0.3, 0.16)
    scene.mesh("pot", pot.moved(stand), "ceramic")
    scene.mesh("earth", earth.moved(stand), "soil")
    scene.mesh("stems", props.twigs(17, 7, 0.75, 0.2, 0.007).moved(Transform.translation(x, 0.25, z)), "stem")
    leaves = Mesh()
    card = props.leaf_card(0.085, 0.17)
    for k in range(parameters.leaves):
        t = (k + 0.5) / parameters.leaves
        angle = 137.508 * k
        ax, y, az = on_circle(0.05 + 0.12 * math.sqrt(t), angle, 0.42 + 0.55 * t)
        leaves.add(card, Transform.translation(x + 0.7 * ax, y, z + 0.7 * az) @ Transform.rotation("y", 90 - angle)
                   @ Transform.rotation("x", 25 - 70 * t))
    scene.mesh("leaves", leaves, "leaf")
