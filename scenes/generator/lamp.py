"""A table lamp: a bulb in a frosted globe under a shade, on a desk before a papered wall."""

import dataclasses
import math

from . import materials, props, textures
from .geometry import Transform, on_circle
from .mesh import Mesh, merged
from .parameters import Checked, parameter
from .scene_folder import SceneFolder
from .solids import box
from .surfaces import arc, grid, lathe, ring, tube
from .xml import Element, number, to_world

HEADER = """
A table lamp at night, in metres: a round bulb inside a globe of frosted glass, open at its top, under a pleated shade, on
a desk before a papered wall, with books, a glass ball, a copper bowl of apples, pens and a picture. A little moonlight
comes from the left.

What it stresses: the camera never sees the bulb, and only the ceiling, the upper parts of the walls and of the shade's
lining do; what else comes from it passes two rough surfaces of glass (roughdielectric), where next-event estimation fails
and paths must find the bulb by chance (it fills most of the globe, for their sake); an opaque shade with a white lining,
which leaves bright pools on wall and desk that light the rest; a caustic of a glass ball (dielectric); brass, copper and
silver near the light.
Made by scripts/generate-scenes. CC0.
"""

DESK = 0.76  # height of its top
DESK_HALF_WIDTH, DESK_DEPTH = 0.9, 0.75
WALL_Z = -0.42
LAMP_X, LAMP_Z = -0.05, -0.12
GLOBE_Y = DESK + 0.37
GLOBE_WALL = 0.003  # thickness of its glass
NECK = 0.022  # radius of the globe's opening, which stands on the socket
GLOBE_OPEN = 25  # degrees above the globe's middle where it ends
SHADE_BOTTOM, SHADE_TOP = 0.17, 0.125  # radii
GAP = 0.0001  # between things that stand on one another, so that their faces do not coincide


@dataclasses.dataclass(frozen=True)
class Parameters(Checked):
    """The lamp and its light; what lies around it is fixed."""

    globe_radius: float = parameter(0.085, "outer radius of the frosted globe, metres", 0.06, 0.09)
    globe_roughness: float = parameter(0.3, "alpha of the frosted glass", 0.05, 0.6)
    bulb_share: float = parameter(0.8, "radius of the bulb as a part of the globe's; small is hard to find", 0.1, 0.85)
    bulb_power: float = parameter(70.0, "power that the bulb sends out, summed over red, green and blue", 0.0, 10000.0)
    shade_height: float = parameter(0.19, "height of the shade, metres", 0.16, 0.26)
    pleats: int = parameter(40, "pleats of the shade", 8, 80)
    moonlight: float = parameter(1.5, "radiance of the window on the left", 0.0, 100.0)


def generate(parameters):
    scene = SceneFolder(HEADER, width=1024, height=1024, spp=256, max_depth=12)
    scene.camera((0.24, 1.12, 1.06), (-0.01, 1.0, -0.2), fov=42)
    _add_materials(scene, parameters)
    _add_room(scene, parameters)
    _add_lamp(scene, parameters)
    _add_shade(scene, parameters)
    _add_books(scene)
    _add_bowl(scene)
    _add_things(scene)
    return scene


def _add_materials(scene, parameters):
    wood = scene.texture("cherry", textures.wood((0.66, 0.40, 0.25), (0.42, 0.21, 0.12), seed=41, rings=7, size=192))
    paper = scene.texture("wallpaper", textures.wallpaper((0.50, 0.58, 0.55), (0.66, 0.70, 0.62), 3, 3, seed=6, size=192))
    view = scene.texture("landscape", textures.landscape(seed=9))
    two_sided = materials.two_sided
    scene.material("cherry", two_sided(materials.rough_plastic(materials.bitmap("diffuse_reflectance", wood), 0.15)))
    scene.material("wallpaper", two_sided(materials.diffuse(materials.bitmap("reflectance", paper))))
    scene.material("plaster", two_sided(materials.diffuse((0.76, 0.72, 0.65))))
    scene.material("floorboards", two_sided(materials.diffuse((0.30, 0.20, 0.13))))
    scene.material("frosted_glass", materials.frosted_glass(parameters.globe_roughness))
    scene.material("glass", materials.glass())
    scene.material("shade_cloth", two_sided(materials.diffuse((0.72, 0.60, 0.42))))
    scene.material("shade_lining", two_sided(materials.diffuse((0.86, 0.84, 0.80))))
    scene.material("shade_trim", two_sided(materials.diffuse((0.34, 0.10, 0.07))))
    scene.material("celadon", two_sided(materials.rough_plastic((0.16, 0.34, 0.30), 0.1)))
    scene.material("brass", two_sided(materials.rough_metal("gold", 0.15)))
    scene.material("copper", two_sided(materials.rough_metal("copper", 0.2)))
    scene.material("silver", two_sided(materials.rough_metal("silver", 0.1)))
    scene.material("landscape", two_sided(materials.diffuse(materials.bitmap("reflectance", view))))
    scene.material("pages", two_sided(materials.diffuse((0.74, 0.69, 0.57))))
    for name, colour in (("red", (0.36, 0.05, 0.04)), ("blue", (0.05, 0.10, 0.24)), ("green", (0.07, 0.18, 0.10)),
                         ("ochre", (0.48, 0.30, 0.08))):
        scene.material(f"{name}_cloth", two_sided(materials.rough_plastic(colour, 0.4)))
    scene.material("apple", two_sided(materials.rough_plastic((0.44, 0.09, 0.04), 0.15)))
    scene.material("stalk", two_sided(materials.diffuse((0.12, 0.07, 0.04))))
    scene.material("black", materials.diffuse((0.0, 0.0, 0.0)))


def _rectangle(a, b, c, d, uv_size=1.0):
    mesh = Mesh()
    width, height = math.dist(a, b) / uv_size, math.dist(a, d) / uv_size
    mesh.add_polygon([a, b, c, d], [(0, 0), (width, 0), (width, height), (0, height)])
    return mesh


def _add_room(scene, parameters):
    x, back, front, top = 1.6, WALL_Z, 2.2, 2.4
    scene.mesh("floor", _rectangle((-x, 0, front), (x, 0, front), (x, 0, back), (-x, 0, back)), "floorboards")
    scene.mesh("papered_wall", _rectangle((-x, 0, back), (x, 0, back), (x, top, back), (-x, top, back), 0.5), "wallpaper")
    walls = [_rectangle((-x, 0, front), (-x, 0, back), (-x, top, back), (-x, top, front)),
             _rectangle((x, 0, back), (x, 0, front), (x, top, front), (x, top, back)),
             _rectangle((x, 0, front), (-x, 0, front), (-x, top, front), (x, top, front)),
             _rectangle((-x, top, back), (x, top, back), (x, top, front), (-x, top, front))]
    scene.mesh("other_walls", merged(walls), "plaster")
    window = to_world(Element("scale", x=0.45, y=0.6), Element("rotate", y=1, angle=90),
                      Element("translate", x=-x + 0.001, y=1.5, z=0.9))
    m = parameters.moonlight
    scene.shape("rectangle", "window", "black", window, emission=(0.55 * m, 0.75 * m, 1.2 * m))

    desk = box((-DESK_HALF_WIDTH, DESK - 0.035, WALL_Z), (DESK_HALF_WIDTH, DESK, WALL_Z + DESK_DEPTH), bevel=0.005,
               uv_size=0.5)
    legs = [box((sx - 0.03, 0, sz - 0.03), (sx + 0.03, DESK - 0.035, sz + 0.03), bevel=0.004, along=1, uv_size=0.5)
            for sx in (-DESK_HALF_WIDTH + 0.06, DESK_HALF_WIDTH - 0.06) for sz in (WALL_Z + 0.06, WALL_Z + DESK_DEPTH - 0.06)]
    scene.mesh("desk", merged([desk, *legs]), "cherry")
    place = Transform.translation(-0.40, 1.34, WALL_Z)
    scene.mesh("frame", props.picture_frame(0.28, 0.21, bar=0.03, depth=0.02).moved(place), "brass")
    scene.mesh("painting", props.canvas(0.28, 0.21, 0.008).moved(place), "landscape")


def _neck_height(radius):
    """Height at which a sphere round the globe's centre is as wide as the neck, below its middle."""
    return GLOBE_Y - math.sqrt(radius**2 - NECK**2)


def _add_lamp(scene, parameters):
    """From the desk upwards: a brass plate, a ceramic body, a brass rod with the socket, the globe with the bulb."""
    stand = Transform.translation(LAMP_X, 0, LAMP_Z)
    radius = parameters.globe_radius
    foot, belly, rod_y = DESK + GAP, DESK + 0.014 + 2 * GAP, DESK + 0.214 + 3 * GAP
    top = _neck_height(radius) - GAP - rod_y  # of the socket, above the rod's foot
    plate = [(0, 0), (0.072, 0), (0.074, 0.003), (0.07, 0.012), (0.05, 0.014), (0, 0.014)]
    body = [(0, 0), (0.042, 0), (0.047, 0.006), (0.06, 0.03), (0.072, 0.06), (0.076, 0.085), (0.07, 0.112), (0.052, 0.14),
            (0.032, 0.16), (0.022, 0.175), (0.02, 0.19), (0.024, 0.2), (0, 0.2)]
    rod = [(0, 0), (0.021, 0), (0.021, 0.005), (0.008, 0.01), (0.008, top - 0.041), (0.018, top - 0.036),
           (0.026, top - 0.026), (0.027, top - 0.004), (0.025, top), (0, top)]
    brass = merged([lathe(plate, 48).moved(Transform.translation(0, foot, 0)),
                    lathe(rod, 32).moved(Transform.translation(0, rod_y, 0))])
    scene.mesh("lamp_stand", brass.moved(stand), "brass")
    scene.mesh("lamp_body", lathe(body, 48).moved(stand @ Transform.translation(0, belly, 0)), "celadon")

    inside = radius - GLOBE_WALL
    outer = arc((0, GLOBE_Y), radius, math.degrees(math.asin(NECK / radius)) - 90, GLOBE_OPEN, 12)
    inner = arc((0, GLOBE_Y), inside, GLOBE_OPEN, math.degrees(math.asin(NECK / inside)) - 90, 12)
    scene.mesh("globe", lathe([*outer, *inner, outer[0]], 40).moved(stand), "frosted_glass")

    bulb = parameters.bulb_share * radius
    total = parameters.bulb_power / (math.pi * 4 * math.pi * bulb**2)
    warm = [total * part for part in (0.48, 0.335, 0.185)]
    centre = Element("point", name="center", x=LAMP_X, y=GLOBE_Y, z=LAMP_Z)
    scene.shape("sphere", "bulb", "black", centre, number("radius", bulb), emission=tuple(warm))
    stem = tube([(0, rod_y + top + GAP / 2, 0), (0, GLOBE_Y - bulb + 0.0005, 0)], 0.008, sides=12)
    scene.mesh("bulb_stem", stem.moved(stand), "brass")


def _add_shade(scene, parameters):
    """Pleated cloth with a lining, bound at both rims, on three spokes from the socket."""
    stand = Transform.translation(LAMP_X, 0, LAMP_Z)
    low = GLOBE_Y - 0.36 * parameters.shade_height
    high = low + parameters.shade_height
    thickness = 0.0015
    rims = ((SHADE_BOTTOM, low), (SHADE_TOP, high))
    outside = [_pleated_ring(radius, y, parameters.pleats) for radius, y in rims]
    inside = [_pleated_ring(radius - thickness, y, parameters.pleats) for radius, y in reversed(rims)]
    scene.mesh("shade", grid(outside).moved(stand), "shade_cloth")
    scene.mesh("lining", grid(inside).moved(stand), "shade_lining")
    bindings = [ring(radius - thickness / 2, 0.0036, 48, 6).moved(
        Transform.translation(0, y, 0) @ Transform.rotation("x", 90)) for radius, y in rims]
    scene.mesh("bindings", merged(bindings).moved(stand), "shade_trim")

    socket = _neck_height(parameters.globe_radius)
    spokes = []
    for k in range(3):
        turn = Transform.rotation("y", 120 * k + 30)
        spoke = [(0.02, socket - 0.014, 0), (0.09, socket - 0.018, 0), (SHADE_BOTTOM - thickness / 2, low, 0)]
        spokes.append(tube([turn.point(p) for p in spoke], 0.002, sides=6))
    scene.mesh("spokes", merged(spokes).moved(stand), "brass")


def _pleated_ring(radius, y, pleats):
    """A closed ring of points that swings 1.8 mm about `radius`, from +x towards -z."""
    count = 6 * pleats
    points = []
    for k in range(count + 1):
        angle = -2 * math.pi * (k % count) / count
        own = radius + 0.0018 * math.cos(pleats * angle)
        points.append((own * math.cos(angle), y, own * math.sin(angle)))
    return points


def _add_books(scene):
    stack = (("red", 0.17, 0.034, 0.24, 188), ("blue", 0.155, 0.026, 0.22, 175), ("ochre", 0.13, 0.02, 0.19, 194))
    y = DESK
    for name, width, thickness, depth, turn in stack:
        _add_book(scene, name, (width, thickness, depth), (0.31, y + GAP, -0.16), turn)
        y += thickness + GAP
    _add_book(scene, "green", (0.14, 0.03, 0.2), (-0.30, DESK + GAP, 0.11), 35)


def _add_book(scene, colour, size, place, turn):
    cover, pages = props.book(*size)
    scene.mesh(f"{colour}_cover", props.placed(cover, *place, turn), f"{colour}_cloth")
    scene.mesh(f"{colour}_pages", props.placed(pages, *place, turn), "pages")


def _add_bowl(scene):
    """A bowl that is part of a sphere, with three apples that touch it and one another."""
    x, z = -0.3, -0.15
    curve, wall, foot, half_angle = 0.11, 0.002, 0.006, 60
    centre = foot + wall + curve  # height of the sphere's centre above the desk
    below = -90 + half_angle
    outer = arc((0, centre), curve + wall, -73, below, 6)
    inner = arc((0, centre), curve, below, -90, 10)
    bowl = lathe([(0, 0), (outer[0][0], 0), *outer, *inner], 40)
    scene.mesh("bowl", props.placed(bowl, x, DESK + GAP, z), "copper")

    radius = 0.034
    apart = 2 * (radius + GAP) / math.sqrt(3)  # from the bowl's axis to an apple's
    height = centre - math.sqrt((curve - radius - 0.0005) ** 2 - apart**2)
    apples, stalks = [], []
    stalk = tube([(0, 0.66 * radius, 0), (0.001, 0.85 * radius, 0), (0.004, 1.12 * radius, 0.001)], 0.0013, sides=6)
    for k, lean in enumerate((6, -8, 5)):
        ax, _, az = on_circle(apart, 120 * k + 20)
        place = (Transform.translation(x + ax, DESK + GAP + height, z + az) @ Transform.rotation("y", 70 * k)
                 @ Transform.rotation("z", lean))
        apples.append(_apple(radius).moved(place))
        stalks.append(stalk.moved(place))
    scene.mesh("apples", merged(apples), "apple")
    scene.mesh("stalks", merged(stalks), "stalk")


def _apple(radius):
    """A sphere round the origin with a dimple at each pole."""
    profile = []
    for k in range(15):
        angle = math.pi * k / 14  # from the lower pole
        lower, upper = math.exp(-((angle / 0.28) ** 2)), math.exp(-(((math.pi - angle) / 0.34) ** 2))
        own = radius * (1 - 0.12 * lower - 0.3 * upper)
        profile.append((own * math.sin(angle) if 0 < k < 14 else 0.0, -own * math.cos(angle)))
    return lathe(profile, 20)


def _add_things(scene):
    radius = 0.04
    ball = Element("point", name="center", x=0.13, y=DESK + radius + GAP, z=0.12)
    scene.shape("sphere", "glass_ball", "glass", ball, number("radius", radius))

    height, radius, wall, base, pen = 0.095, 0.034, 0.002, 0.003, 0.0035
    place = Transform.translation(0.14, DESK + GAP, -0.27)
    scene.mesh("pen_holder", props.cup(height, radius, wall, base, segments=32).moved(place), "silver")
    at_foot, at_rim, foot = 0.012, radius - wall - pen - 0.0007, base + 0.0015
    pens = []
    for angle, end in ((20, 0.165), (140, 0.185), (250, 0.175)):
        at_end = at_foot + (at_rim - at_foot) * (end - foot) / (height - foot)  # leaning on the rim
        pens.append(tube([on_circle(at_foot, angle, foot), on_circle(at_end, angle, end)], pen, sides=8))
    scene.mesh("pens", merged(pens).moved(place), "ochre_cloth")
