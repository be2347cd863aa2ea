"""Pictures of 8 bits, and noise to draw them with."""

import math


class Image:
    """A picture of `rows` of bytes, the top row first; 1 channel (grey) or 3 (sRGB)."""

    def __init__(self, width, height, channels, rows):
        self.width, self.height, self.channels, self.rows = width, height, channels, rows


def picture(width, height, colour):
    """An sRGB picture of colour(u, v), three numbers in [0, 1], at pixel centres; v grows upwards."""
    return _sampled(width, height, 3, colour)


def grey_picture(width, height, value):
    """A picture of one channel of value(u, v) in [0, 1]."""
    return _sampled(width, height, 1, lambda u, v: (value(u, v),))


def _sampled(width, height, channels, function):
    rows = []
    for y in range(height):
        v = 1 - (y + 0.5) / height
        row = bytearray()
        for x in range(width):
            row.extend(min(255, max(0, round(255 * value))) for value in function((x + 0.5) / width, v))
        rows.append(bytes(row))
    return Image(width, height, channels, rows)


def hashed(x, y, seed):
    """A number in [0, 1) that depends on three integers alone."""
    h = (x * 0x9E3779B1 ^ y * 0x85EBCA77 ^ seed * 0xC2B2AE3D) & 0xFFFFFFFF
    for multiplier in (0x7FEB352D, 0x846CA68B):
        h = ((h ^ h >> 15) * multiplier) & 0xFFFFFFFF
    return (h ^ h >> 16) / 2.0**32


def noise(u, v, period_u, period_v, seed):
    """Smooth noise in [0, 1] with `period_u` x `period_v` cells in the unit square, which it repeats."""
    x, y = u * period_u, v * period_v
    i, j = math.floor(x), math.floor(y)
    s, t = _ease(x - i), _ease(y - j)
    i0, i1, j0, j1 = i % period_u, (i + 1) % period_u, j % period_v, (j + 1) % period_v
    low = hashed(i0, j0, seed) * (1 - s) + hashed(i1, j0, seed) * s
    high = hashed(i0, j1, seed) * (1 - s) + hashed(i1, j1, seed) * s
    return low * (1 - t) + high * t


def _ease(t):
    return t * t * (3 - 2 * t)


def fractal(u, v, period_u, period_v, seed, octaves=3):
    """Noise in [0, 1] with ever finer and weaker detail."""
    total, weight, amplitude = 0.0, 0.0, 1.0
    for octave in range(octaves):
        total += amplitude * noise(u, v, period_u << octave, period_v << octave, seed + octave)
        weight += amplitude
        amplitude /= 2
    return total / weight


def blend(a, b, t):
    """The colour a fraction t in [0, 1] of the way from a to b."""
    t = min(1.0, max(0.0, t))
    return tuple(x + (y - x) * t for x, y in zip(a, b))
