"""Things that stand about in more than one scene. Each is built at the origin, standing or with its back to z = 0."""

import math
import random

from .geometry import Transform, add, cross, normalise, scale
from .mesh import Mesh, merged
from .solids import box, boxes, frame
from .surfaces import arc, grid, lathe, tube


def canvas(width, height, z):
    """A picture that fills the unit square of its texture, facing +z."""
    x, y = width / 2, height / 2
    mesh = Mesh()
    mesh.add_polygon([(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)], [(0, 0), (1, 0), (1, 1), (0, 1)])
    return mesh


def picture_frame(width, height, bar=0.05, depth=0.03):
    """A frame with the back to the wall, round an opening for `canvas`."""
    return frame(width, height, bar, depth, bevel=0.006, uv_size=0.4)


def table(width, depth, height, top=0.035, leg=0.05):
    """A table with four square legs and an apron; the grain runs along x."""
    x, z = width / 2, depth / 2
    parts = [box((-x, height - top, -z), (x, height, z), bevel=0.004, uv_size=0.8)]
    inset = 0.02
    for sx in (-1, 1):
        for sz in (-1, 1):
            cx, cz = sx * (x - inset - leg / 2), sz * (z - inset - leg / 2)
            parts.append(box((cx - leg / 2, 0, cz - leg / 2), (cx + leg / 2, height - top, cz + leg / 2),
                             bevel=0.003, uv_size=0.8, along=1, uv_offset=(0.3 * sx, 0.2 * sz)))
    ax, az, low = x - inset - leg, z - inset - leg, height - top - 0.09
    for s in (-1, 1):
        parts.append(box((-ax, low, s * (az + leg / 2) - 0.01), (ax, height - top, s * (az + leg / 2) + 0.01),
                         uv_size=0.8))
        parts.append(box((s * (ax + leg / 2) - 0.01, low, -az), (s * (ax + leg / 2) + 0.01, height - top, az),
                         uv_size=0.8, along=2))
    return merged(parts)


def vase(height, radius, wall=0.004, segments=36):
    """A bellied vase with a wall, open at the top."""
    shape = [(0.0, 0.55), (0.1, 0.78), (0.25, 0.97), (0.4, 1.0), (0.55, 0.88), (0.7, 0.62), (0.82, 0.42), (0.91, 0.38),
             (1.0, 0.48)]
    outside = [(radius * r, height * t) for t, r in shape]
    inside = [(r - wall, max(h, wall)) for r, h in reversed(outside)]
    return lathe([(0.0, 0.0), *outside, *inside, (0.0, wall)], segments)


def pot(height, radius, segments=32):
    """A tapered flower pot with a rim and earth in it: (pot, earth)."""
    rim = 0.012
    profile = [(0, 0), (0.7 * radius, 0), (0.95 * radius, 0.8 * height), (radius, 0.8 * height), (radius, height),
               (radius - rim, height), (radius - rim, 0.85 * height)]
    earth = lathe([(radius - rim, 0.85 * height), (0, 0.88 * height)], segments)
    return lathe(profile, segments), earth


def blade(base, direction, size, width, droop, segments=6):
    """A strap leaf that leaves `base` along `direction` and bends downwards; one surface, to be made two-sided.

    size: its length; droop: how far its tip sinks below the straight line.
    """
    side = normalise(cross(direction, (0, 1, 0))) if abs(direction[1]) < 0.999 else (1, 0, 0)
    rows, uvs = [], []
    for k in range(segments + 1):
        t = k / segments
        spine = add(add(base, scale(direction, size * t)), (0, -droop * t * t, 0))
        half = 0.5 * width * (0.55 + 0.45 * math.sin(math.pi * (0.15 + 0.6 * t))) * (1 - t**4) + 0.0008
        cup = (0, 0.25 * half, 0)
        rows.append([add(add(spine, scale(side, -half)), cup), spine, add(add(spine, scale(side, half)), cup)])
        uvs.append([(0, t), (0.5, t), (1, t)])
    return grid(rows, uvs)


def blades(seed, count, base_radius, size, width, spread, droop, height=0.0):
    """A tuft of strap leaves: `spread` is the tangent of the outermost leaves' lean, `height` where they begin."""
    random_ = random.Random(seed)
    leaves = []
    for k in range(count):
        angle = 2.399963 * k + 0.4 * random_.random()  # the golden angle spreads them evenly
        lean = spread * math.sqrt((k + 0.5) / count)
        c, s = math.cos(angle), math.sin(angle)
        start = base_radius * math.sqrt((k + 0.5) / count)
        own = size * (0.75 + 0.25 * random_.random())
        leaves.append(blade((start * c, height, start * s), normalise((lean * c, 1, lean * s)), own, width,
                            droop * lean * own))
    return merged(leaves)


def leaf_card(width, size):
    """A leaf for `textures.leaf_opacity`: base at the origin, growing along +z, folded a little and drooping."""
    rows, uvs = [], []
    for k in range(3):
        t = k / 2
        y = -0.3 * size * t * t
        edge = y + 0.12 * width
        rows.append([(-width / 2, edge, size * t), (0, y, size * t), (width / 2, edge, size * t)])
        uvs.append([(0, t), (0.5, t), (1, t)])
    return grid([row[::-1] for row in rows], [row[::-1] for row in uvs])


def twigs(seed, count, height, spread, thickness):
    """Bare branches that rise from the origin, bending outwards."""
    random_ = random.Random(seed)
    parts = []
    for k in range(count):
        angle = 2.399963 * k + random_.random()
        lean = spread * (0.35 + 0.65 * random_.random())
        own = height * (0.7 + 0.3 * random_.random())
        path, radii = [], []
        for step in range(7):
            t = step / 6
            wiggle = 0.02 * height * math.sin(5 * t + 6 * k) * t
            path.append((lean * t**1.5 * math.cos(angle) + wiggle, own * t, lean * t**1.5 * math.sin(angle) - wiggle))
            radii.append(thickness * (1 - 0.75 * t))
        parts.append(tube(path, radii, sides=6))
    return merged(parts)


def book(width, thickness, depth, cover=0.003):
    """A closed book lying on its back, spine along +z at x = -width/2: (cover, pages)."""
    x, z = width / 2, depth / 2
    covers = boxes([((-x, 0, -z), (x, cover, z)), ((-x, thickness - cover, -z), (x, thickness, z)),
                    ((-x, cover, -z), (-x + cover, thickness - cover, z))])
    pages = box((-x + cover, cover, -z + 0.004), (x - 0.005, thickness - cover, z - 0.004))
    return covers, pages


def cup(height, radius, wall=0.003, base=0.004, segments=36):
    """A straight-sided cup or tumbler with a wall."""
    lip = arc((radius - wall / 2, height - wall / 2), wall / 2, 0, 180, 4)
    return lathe([(0, 0), (radius, 0), *lip, (radius - wall, base), (0, base)], segments)


def door(width, height, thickness=0.04):
    """A panelled door leaf with its back at z = 0 and its foot at y = 0."""
    x = width / 2
    parts = [box((-x, 0, 0), (x, height, thickness), bevel=0.003)]
    panel = (width - 0.3) / 2
    for low, high in ((0.18, 0.42 * height), (0.42 * height + 0.14, height - 0.14)):
        for side in (-1, 1):
            centre = Transform.translation(side * (panel / 2 + 0.05), (low + high) / 2, thickness)
            parts.append(frame(panel - 0.06, high - low - 0.06, 0.03, 0.012, bevel=0.004).moved(centre))
    return merged(parts)


def placed(mesh, x=0.0, y=0.0, z=0.0, turn=0.0):
    """The mesh turned round the y axis by `turn` degrees, then moved."""
    return mesh.moved(Transform.translation(x, y, z) @ Transform.rotation("y", turn))
