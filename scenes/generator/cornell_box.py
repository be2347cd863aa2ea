"""The Cornell box of Cornell's Program of Computer Graphics, its walls made rectangular."""

import dataclasses

from . import materials
from .parameters import Checked, parameter
from .xml import BLANK, Comment, Element, document, integer, number, ref, rgb, string, to_world

HEADER = """
The Cornell box, from the measurements that Cornell's Program of Computer Graphics published ("The Cornell Box", data
of the physical box), in metres. Simplified: the walls are made rectangular (the real ones are up to 6 mm out of true),
the lamp hangs 1 mm below a closed ceiling instead of in a hole, and the measured spectra became linear RGB.

What it stresses: diffuse interreflection with strong colour bleeding; soft shadows of blocks that stand on the floor
(coplanar faces and contact edges); corners, where connections between points are nearly singular; a small lamp close to
the ceiling, which is lit at grazing angles only through other walls.
"""

WHITE, RED, GREEN = (0.73, 0.71, 0.68), (0.63, 0.06, 0.05), (0.14, 0.45, 0.09)


@dataclasses.dataclass(frozen=True)
class Parameters(Checked):
    """All measures are the physical box's; only the picture's size is free."""

    size: int = parameter(256, "pixels along each edge of the picture", 1, 32768)


class CornellBox:
    """The scene: nothing but rectangles and cubes, so that scene.xml is its only file."""

    triangles = 36

    def __init__(self, size):
        self.size = size

    def files(self):
        scene = Element("scene", *_settings(self.size), BLANK, *_bsdfs(), BLANK, *_walls(), BLANK, *_blocks(), BLANK,
                        _lamp(), version="3.0.0")
        return {"scene.xml": document(HEADER, scene).encode("utf-8")}


def generate(parameters):
    return CornellBox(parameters.size)


def _settings(size):
    film = Element("film", integer("width", "$size"), integer("height", "$size"), string("pixel_format", "rgb"),
                   Element("rfilter", type="box"), type="hdrfilm")
    return (
        Element("default", name="size", value=size),
        Element("default", name="spp", value=64),
        Element("default", name="max_depth", value=7),
        BLANK,
        Element("integrator", integer("max_depth", "$max_depth"), type="path"),
        BLANK,
        Comment("35 mm lens before a film of 25 x 25 mm: fov = 2 atan(12.5 / 35)"),
        Element("sensor", number("fov", 39.3077),
                to_world(Element("lookat", origin=(0.278, 0.273, -0.8), target=(0.278, 0.273, 0), up=(0, 1, 0))),
                Element("sampler", integer("sample_count", "$spp"), type="independent"), film, type="perspective"))


def _bsdfs():
    for name, colour in (("white", WHITE), ("red", RED), ("green", GREEN)):
        bsdf = materials.two_sided(materials.diffuse(colour))
        bsdf.attributes["id"] = name
        yield bsdf
    black = materials.diffuse(0)
    black.attributes["id"] = "black"
    yield black


def _placed(kind, name, material, *steps):
    return Element("shape", to_world(*steps), ref(material), type=kind, id=name)


def _walls():
    """Walls from 0 to 0.5528 (x), 0.5488 (y) and 0.5592 (z), normals inwards, open towards the camera."""
    depth, width, height = 0.2796, 0.2764, 0.2744
    floor = Element("scale", x=width, y=depth)
    side = Element("scale", x=depth, y=height)
    yield _placed("rectangle", "floor", "white", floor, Element("rotate", x=1, angle=-90),
                  Element("translate", x=width, z=depth))
    yield _placed("rectangle", "ceiling", "white", floor, Element("rotate", x=1, angle=90),
                  Element("translate", x=width, y=2 * height, z=depth))
    yield _placed("rectangle", "back_wall", "white", Element("scale", x=width, y=height),
                  Element("rotate", y=1, angle=180), Element("translate", x=width, y=height, z=2 * depth))
    yield Comment("The camera looks along +z with +x to its left")
    yield _placed("rectangle", "left_wall", "red", side, Element("rotate", y=1, angle=-90),
                  Element("translate", x=2 * width, y=height, z=depth))
    yield _placed("rectangle", "right_wall", "green", side, Element("rotate", y=1, angle=90),
                  Element("translate", y=height, z=depth))


def _blocks():
    yield _placed("cube", "short_block", "white", Element("scale", x=0.0836, y=0.0825, z=0.0836),
                  Element("rotate", y=1, angle=-17.03), Element("translate", x=0.1855, y=0.0825, z=0.169))
    yield _placed("cube", "tall_block", "white", Element("scale", x=0.0827, y=0.165, z=0.0837),
                  Element("rotate", y=1, angle=17.23), Element("translate", x=0.3685, y=0.165, z=0.3513))


def _lamp():
    return Element(
        "shape",
        to_world(Element("scale", x=0.065, y=0.0525), Element("rotate", x=1, angle=90),
                 Element("translate", x=0.278, y=0.5478, z=0.2795)),
        ref("black"), Element("emitter", rgb("radiance", (17, 12, 4)), type="area"), type="rectangle", id="lamp")
