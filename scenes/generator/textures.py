"""The pictures that the scenes put on their surfaces. Colours here are sRGB in [0, 1]."""

import math

from .image import blend, fractal, grey_picture, hashed, noise, picture


def wood(light, dark, seed, rings=9, size=256):
    """Wood with its grain along u, between two colours; `rings` bands of grain in a repeat."""
    def colour(u, v):
        bend = fractal(u, v, 2, 3, seed) + 0.25 * noise(u, v, 3, 9, seed + 7)
        band = 0.5 + 0.5 * math.sin(2 * math.pi * (rings * v + 1.6 * bend))
        fibre = noise(u, v, 6, 96, seed + 9)
        return blend(light, dark, 0.55 * band ** 2 + 0.35 * fibre + 0.1 * bend)
    return picture(size, size, colour)


def tiles(colour, grout, columns, rows, joint, variation, seed, size=256):
    """Tiles that each differ a little in brightness. joint: half width of the joints, in tiles."""
    def shade(u, v):
        if joint_depth(u * columns, v * rows, joint) > 0.5:
            return grout
        own = hashed(math.floor(u * columns), math.floor(v * rows), seed) - 0.5
        cloud = fractal(u, v, 2 * columns, 2 * rows, seed + 1) - 0.5
        return tuple(c * (1 + variation * (own + 0.7 * cloud)) for c in colour)
    return picture(size, size, shade)


def tile_heights(columns, rows, joint, size=256):
    """The relief of `tiles`: 1 on a tile, 0 in a joint, with a rounded edge."""
    return grey_picture(size, size, lambda u, v: 1 - joint_depth(u * columns, v * rows, joint))


def joint_depth(x, y, joint):
    """How deep a point lies in the joint between unit tiles: 0 on the tile, 1 in the middle of the joint."""
    distance = min(abs(x - round(x)), abs(y - round(y)))
    return min(1.0, max(0.0, 1.5 - distance / joint))


def wallpaper(ground, figure, columns, rows, seed, size=256):
    """A damask of petals in staggered rows over faintly woven paper."""
    def colour(u, v):
        row = math.floor(v * rows * 2)
        x = (u * columns + 0.5 * (row % 2)) % 1 - 0.5
        y = (v * rows * 2) % 1 - 0.5
        radius, angle = math.hypot(x, 0.8 * y), math.atan2(y, x)
        petals = 0.27 + 0.10 * math.cos(4 * angle) + 0.05 * math.cos(8 * angle)
        inside = min(1.0, max(0.0, (petals - radius) * 18)) * min(1.0, max(0.0, (radius - 0.07) * 30))
        weave = 0.5 * noise(u, v, 128, 16, seed) + 0.5 * noise(u, v, 16, 128, seed + 1)
        return tuple(c * (0.94 + 0.12 * weave) for c in blend(ground, figure, inside))
    return picture(size, size, colour)


def landscape(seed, width=128, height=96):
    """A painting: hills in ever warmer greens under an evening sky."""
    def colour(u, v):
        shade = blend((0.93, 0.76, 0.55), (0.42, 0.58, 0.72), 1.4 * v - 0.4)
        sun = math.hypot((u - 0.68) * width / height, v - 0.66)
        shade = blend((1.0, 0.93, 0.72), shade, (sun - 0.06) * 25)
        for hill in range(4):
            crest = 0.56 - 0.13 * hill + 0.16 * (fractal(u, 0.5, 3, 2, seed + 11 * hill) - 0.5)
            if v < crest:
                shade = blend((0.42, 0.50, 0.52), (0.20, 0.27, 0.13), hill / 3)
        brush = 0.9 + 0.2 * noise(u, v, 40, 30, seed + 3)
        return tuple(c * brush for c in shade)
    return picture(width, height, colour)


def abstract(seed, colours, size=96):
    """A painting of overlapping bands of colour."""
    def colour(u, v):
        bend = fractal(u, v, 2, 2, seed)
        band = math.floor((v + 0.5 * bend) * 5 + 2 * hashed(math.floor(u * 3 + bend), 0, seed))
        brush = 0.92 + 0.16 * noise(u, v, 30, 6, seed + 5)
        return tuple(c * brush for c in colours[band % len(colours)])
    return picture(size, size, colour)


def grass(seed, size=256):
    """A lawn seen from afar: clumps of lighter and darker blades."""
    def colour(u, v):
        clump = fractal(u, v, 5, 5, seed, octaves=4)
        blade = noise(u, v, 90, 60, seed + 20)
        shade = blend((0.19, 0.29, 0.10), (0.47, 0.53, 0.22), 0.75 * clump + 0.35 * blade - 0.1)
        return blend(shade, (0.52, 0.47, 0.28), 2.5 * (noise(u, v, 7, 7, seed + 30) - 0.72))
    return picture(size, size, colour)


def leaf_opacity(size=64):
    """A pointed leaf on a short stem, its tip at v = 1: 1 inside, 0 outside."""
    def inside(u, v):
        width = 0.46 * math.sin(math.pi * min(1.0, max(0.0, (v - 0.08) / 0.92)) ** 0.8)
        stem = 0.03 if v < 0.2 else 0.0
        return 1.0 if abs(u - 0.5) < max(width, stem) else 0.0
    return grey_picture(size, size, inside)


def lace_opacity(size=128):
    """Needle lace: rings and a net of threads; repeats."""
    def thread(u, v):
        x, y = u * 4 % 1 - 0.5, v * 4 % 1 - 0.5
        radius = math.hypot(x, y)
        rings = abs(radius - 0.36) < 0.06 or radius < 0.12
        spokes = radius < 0.36 and abs(math.sin(4 * math.atan2(y, x))) < 0.22
        net = min(abs(x - y), abs(x + y)) < 0.05 and radius > 0.36
        edge = min(0.5 - abs(x), 0.5 - abs(y)) < 0.05
        return 1.0 if rings or spokes or net or edge else 0.0
    return grey_picture(size, size, thread)
