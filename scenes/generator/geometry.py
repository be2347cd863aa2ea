"""Points, directions and affine maps, as plain tuples of three numbers."""

import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, factor):
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalise(a):
    """`a` at unit length; the zero vector stays what it is."""
    size = length(a)
    return scale(a, 1 / size) if size > 0 else a


def on_circle(radius, angle, y=0.0):
    """The point at `angle` degrees from +x towards +z on a horizontal circle round the y axis."""
    radians = math.radians(angle)
    return (radius * math.cos(radians), y, radius * math.sin(radians))


class Transform:
    """An affine map: three rows of four numbers. `(a @ b).point(p)` is `a.point(b.point(p))`."""

    def __init__(self, rows):
        self.rows = tuple(tuple(row) for row in rows)

    @staticmethod
    def translation(x, y, z):
        return Transform(((1, 0, 0, x), (0, 1, 0, y), (0, 0, 1, z)))

    @staticmethod
    def scaling(x, y, z):
        return Transform(((x, 0, 0, 0), (0, y, 0, 0), (0, 0, z, 0)))

    @staticmethod
    def rotation(axis, degrees):
        """A right-handed turn round the axis "x", "y" or "z"."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
        rows = [[1.0 if i == j else 0.0 for j in range(4)] for i in range(3)]
        rows[first][first], rows[first][second] = c, -s
        rows[second][first], rows[second][second] = s, c
        return Transform(rows)

    def __matmul__(self, other):
        columns = list(zip(*other.rows))
        rows = []
        for row in self.rows:
            product = [dot(row, column) for column in columns]
            product[3] += row[3]
            rows.append(product)
        return Transform(rows)

    def point(self, p):
        return tuple(dot(row, p) + row[3] for row in self.rows)

    def normal(self, n):
        """Maps a unit normal by the cofactors of the linear part, which keep it at a right angle to the surface."""
        a, b, c = (row[:3] for row in self.rows)
        cofactors = (cross(b, c), cross(c, a), cross(a, b))
        sign = 1 if self.determinant() > 0 else -1
        return normalise(tuple(sign * dot(row, n) for row in cofactors))

    def determinant(self):
        a, b, c = (row[:3] for row in self.rows)
        return dot(a, cross(b, c))
