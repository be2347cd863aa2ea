"""Boxes and extrusions: flat faces, sharp or softened edges."""

import math

from .geometry import add, normalise, scale
from .mesh import Mesh, merged


def box(low, high, bevel=0.0, uv_size=1.0, along=0, uv_offset=(0.0, 0.0)):
    """The box between the corners `low` and `high`.

    bevel: width of the chamfers, in metres, shaded as if round; 0 for sharp edges.
    uv_size: metres per repeat of the texture.
    along: the axis (0, 1, 2) that u follows on the four faces beside it: the grain of wood.
    uv_offset: moves the texture, so that boards do not look alike.
    """
    mesh = Mesh()
    corners = {}
    for axis in range(3):
        for side in (0, 1):
            for index in _face_corners(axis, side):
                point = tuple(
                    (high[i] if index[i] else low[i]) if i == axis
                    else (high[i] - bevel if index[i] else low[i] + bevel) for i in range(3))
                normal = tuple((1.0 if side else -1.0) if i == axis else 0.0 for i in range(3))
                uv = _box_uv(point, axis, along, uv_size, uv_offset)
                corners[axis, index] = mesh.add_vertex(point, normal, uv)
            a, b, c, d = (corners[axis, index] for index in _face_corners(axis, side))
            mesh.add_face(a, b, c)
            mesh.add_face(a, c, d)
    if bevel > 0:
        _add_chamfers(mesh, corners)
    return mesh


def _face_corners(axis, side):
    """Corners of one face, as triples of 0 (low) and 1 (high), counter-clockwise seen from outside."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    corners = []
    for a, b in ring if side else reversed(ring):
        index = [0, 0, 0]
        index[axis], index[first], index[second] = side, a, b
        corners.append(tuple(index))
    return corners


def _box_uv(point, axis, along, uv_size, uv_offset):
    across = [i for i in range(3) if i != axis]
    u_axis, v_axis = across if across[0] == along or along == axis else across[::-1]
    return (point[u_axis] / uv_size + uv_offset[0], point[v_axis] / uv_size + uv_offset[1])


def _add_chamfers(mesh, corners):
    for x, y, z in ((a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)):
        triangle = [corners[axis, (x, y, z)] for axis in range(3)]
        outwards = (x + y + z) % 2 == 1
        mesh.add_face(*(triangle if outwards else triangle[::-1]))
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
            ends = []
            for end in (0, 1):
                index = [0, 0, 0]
                index[axis], index[first], index[second] = end, a, b
                ends.append(tuple(index))
            quad = [corners[first, ends[0]], corners[second, ends[0]],
                    corners[second, ends[1]], corners[first, ends[1]]]
            if a != b:
                quad.reverse()
            mesh.add_face(quad[0], quad[1], quad[2])
            mesh.add_face(quad[0], quad[2], quad[3])


def boxes(bounds, **options):
    """One mesh of several boxes, given as (low, high) pairs; options as for `box`."""
    return merged([box(low, high, **options) for low, high in bounds])


def frame(width, height, bar, depth, bevel=0.002, **options):
    """A rectangular frame round the opening width x height, in the plane z = 0 with its back there and centre at 0.

    bar: width of its four bars, outside the opening; depth: how far it stands out, towards +z.
    """
    x, y = width / 2, height / 2
    uprights = [box((side * (x + bar / 2) - bar / 2, -y - bar, 0), (side * (x + bar / 2) + bar / 2, y + bar, depth),
                    bevel=bevel, along=1, **options) for side in (-1, 1)]
    rails = [box((-x, side * (y + bar / 2) - bar / 2, 0), (x, side * (y + bar / 2) + bar / 2, depth),
                 bevel=bevel, along=0, **options) for side in (-1, 1)]
    return merged(uprights + rails)


def prism(outline, bottom, top, uv_size=1.0, smooth=False):
    """Stands a convex polygon up: `outline` holds (x, z) points, clockwise seen from above (from +x towards +z).

    smooth: shade the sides as one round surface.
    """
    mesh = Mesh()
    count = len(outline)
    for height, points in ((top, outline[::-1]), (bottom, outline)):
        mesh.add_polygon([(x, height, z) for x, z in points], [(x / uv_size, z / uv_size) for x, z in points])
    edges = [(outline[(i + 1) % count][0] - outline[i][0], outline[(i + 1) % count][1] - outline[i][1])
             for i in range(count)]
    normals = [normalise((dz, 0.0, -dx)) for dx, dz in edges]
    distance = 0.0
    for i, (dx, dz) in enumerate(edges):
        (x0, z0), (x1, z1) = outline[i], outline[(i + 1) % count]
        before, after = normals[i], normals[i]
        if smooth:
            before = normalise(scale(add(normals[i - 1], normals[i]), 0.5))
            after = normalise(scale(add(normals[i], normals[(i + 1) % count]), 0.5))
        u0, u1 = distance / uv_size, (distance + math.hypot(dx, dz)) / uv_size
        a = mesh.add_vertex((x0, bottom, z0), before, (u0, bottom / uv_size))
        b = mesh.add_vertex((x0, top, z0), before, (u0, top / uv_size))
        c = mesh.add_vertex((x1, top, z1), after, (u1, top / uv_size))
        d = mesh.add_vertex((x1, bottom, z1), after, (u1, bottom / uv_size))
        mesh.add_face(a, b, c)
        mesh.add_face(a, c, d)
        distance += math.hypot(dx, dz)
    return mesh
