"""Curved surfaces: grids of points, surfaces of revolution, tubes along curves, spheres of leaves."""

import math

from .geometry import add, cross, dot, normalise, scale, subtract
from .mesh import Mesh

_CREASE_DEGREES = 40  # a profile that turns more sharply than this gets an edge


def grid(rows, uvs=None):
    """A smooth surface through rows of points. Its front is the side of (along the row) x (to the next row).

    uvs: texture coordinates in rows alike; by default the unit square. A first and last row (or column) that coincide
    are shaded without a seam.
    """
    height, width = len(rows), len(rows[0])
    normals = _grid_normals(rows)
    mesh = Mesh()
    for j in range(height):
        for i in range(width):
            uv = uvs[j][i] if uvs else (i / (width - 1), j / (height - 1))
            mesh.add_vertex(rows[j][i], normals[j][i], uv)
    for j in range(height - 1):
        for i in range(width - 1):
            a, b = j * width + i, (j + 1) * width + i
            mesh.add_face(a, a + 1, b + 1)
            mesh.add_face(a, b + 1, b)
    return mesh


def _grid_normals(rows):
    height, width = len(rows), len(rows[0])
    closed_rows = rows[0] == rows[-1]
    closed_columns = all(row[0] == row[-1] for row in rows)

    def neighbours(index, count, closed):
        before, after = index - 1, index + 1
        if closed:
            return (before if before >= 0 else count - 2), (after if after < count else 1)
        return max(before, 0), min(after, count - 1)

    normals = []
    for j in range(height):
        below, above = neighbours(j, height, closed_rows)
        row = []
        for i in range(width):
            left, right = neighbours(i, width, closed_columns)
            along = subtract(rows[j][right], rows[j][left])
            up = subtract(rows[above][i], rows[below][i])
            row.append(normalise(cross(along, up)))
        normals.append(row)
    return normals


def lathe(profile, segments=32):
    """Turns a profile of (radius, height) points round the y axis; a profile that goes up looks outwards.

    Corners of more than 40 degrees stay sharp. A profile that goes up outside and down inside makes a vessel.
    u goes round once, v along the profile from 0 to 1.
    """
    lengths = [math.dist(p, q) for p, q in zip(profile, profile[1:])]
    total = sum(lengths)
    slopes = [((q[1] - p[1]) / d, (p[0] - q[0]) / d) for p, q, d in zip(profile, profile[1:], lengths)]
    mesh = Mesh()
    travelled = 0.0
    for k, (low, high) in enumerate(zip(profile, profile[1:])):
        low_normal = _profile_normal(slopes, k - 1, k, k)
        high_normal = _profile_normal(slopes, k, k + 1, k)
        rings = []
        for (radius, height), (outwards, upwards), distance in (
                (low, low_normal, travelled), (high, high_normal, travelled + lengths[k])):
            ring = []
            for i in range(segments + 1):
                angle = 2 * math.pi * (i % segments) / segments
                c, s = math.cos(angle), math.sin(angle)
                ring.append(mesh.add_vertex((radius * c, height, -radius * s),
                                            (outwards * c, upwards, -outwards * s),
                                            (i / segments, distance / total)))
            rings.append(ring)
        for i in range(segments):
            a, b, c, d = rings[0][i], rings[0][i + 1], rings[1][i + 1], rings[1][i]
            mesh.add_face(a, b, c)
            mesh.add_face(a, c, d)
        travelled += lengths[k]
    return _without_copies(mesh)


def _profile_normal(slopes, before, after, own):
    """Normal (outwards, upwards) of piece `own` at the corner between the pieces `before` and `after`."""
    if before < 0 or after >= len(slopes):
        return slopes[own]
    (a, b), (c, d) = slopes[before], slopes[after]
    if a * c + b * d < math.cos(math.radians(_CREASE_DEGREES)):
        return slopes[own]
    size = math.hypot(a + c, b + d)
    return ((a + c) / size, (b + d) / size)


def _without_copies(mesh):
    """The same mesh with vertices that are alike in everything written once, and unused ones left out."""
    result = Mesh()
    known = {}

    def kept(index):
        vertex = (mesh.positions[index], mesh.normals[index], mesh.uvs[index])
        if vertex not in known:
            known[vertex] = result.add_vertex(*vertex)
        return known[vertex]

    result.faces = [tuple(kept(i) for i in face) for face in mesh.faces]
    return result


def arc(centre, radius, first, last, count):
    """`count` + 1 points of a circle, for profiles: angles in degrees from +radius towards +height."""
    points = []
    for i in range(count + 1):
        angle = math.radians(first + (last - first) * i / count)
        points.append((max(0.0, centre[0] + radius * math.cos(angle)), centre[1] + radius * math.sin(angle)))
    return points


def tube(path, radius, sides=10, closed=False, uv_size=0.1):
    """A round bar along a path of points. An open one ends in flat caps; a closed one must not repeat its first point.

    radius: one number, or one for each point. uv_size: metres per repeat along the path.
    """
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    points = list(path) + ([path[0]] if closed else [])
    radii = list(radii) + ([radii[0]] if closed else [])
    frames = _frames_along(points, closed)
    rows, uvs = [], []
    travelled = 0.0
    for k, (point, (side, up)) in enumerate(zip(points, frames)):
        if k:
            travelled += math.dist(points[k - 1], point)
        ring = []
        for i in range(sides + 1):
            angle = 2 * math.pi * (i % sides) / sides
            offset = add(scale(side, math.cos(angle) * radii[k]), scale(up, math.sin(angle) * radii[k]))
            ring.append(add(point, offset))
        rows.append(ring)
        uvs.append([(i / sides, travelled / uv_size) for i in range(sides + 1)])
    if closed:
        rows[-1] = rows[0]
    mesh = grid(rows, uvs)
    if not closed:
        flat = [(0.5, 0.5)] * sides
        mesh.add_polygon(rows[0][sides:0:-1], flat)
        mesh.add_polygon(rows[-1][:sides], flat)
    return mesh


def _frames_along(points, closed):
    """A pair (side, up) across the path at each point, turning as little as possible from one to the next."""
    frames = []
    side = None
    for k in range(len(points)):
        before = points[k - 1] if k else (points[-2] if closed else points[0])
        after = points[k + 1] if k + 1 < len(points) else (points[1] if closed else points[-1])
        tangent = normalise(subtract(after, before))
        if side is None:
            helper = (0, 1, 0) if abs(tangent[1]) < 0.9 else (1, 0, 0)
            side = cross(helper, tangent)
        side = normalise(subtract(side, scale(tangent, dot(side, tangent))))
        frames.append((side, cross(tangent, side)))
    return frames


def ring(radius, thickness, segments=48, sides=10):
    """A torus in the plane z = 0, `thickness` the radius of its bar."""
    path = [(radius * math.cos(2 * math.pi * i / segments), radius * math.sin(2 * math.pi * i / segments), 0.0)
            for i in range(segments)]
    return tube(path, thickness, sides, closed=True)


def heightfield(function, x_range, z_range, columns, rows, uv_size=1.0):
    """The surface y = function(x, z), front upwards."""
    points, uvs = [], []
    for j in range(rows + 1):
        z = z_range[1] + (z_range[0] - z_range[1]) * j / rows
        xs = [x_range[0] + (x_range[1] - x_range[0]) * i / columns for i in range(columns + 1)]
        points.append([(x, function(x, z), z) for x in xs])
        uvs.append([(x / uv_size, -z / uv_size) for x in xs])
    return grid(points, uvs)
