"""Triangle meshes with a normal and a texture coordinate at every vertex."""

from .geometry import cross, dot, length, normalise, subtract


class Mesh:
    """Vertices (`positions`, `normals`, `uvs`, of one length) and `faces`, triples of vertex indices.

    Faces are wound counter-clockwise when seen from the side that the normals point to.
    """

    def __init__(self):
        self.positions = []
        self.normals = []
        self.uvs = []
        self.faces = []

    def add_vertex(self, position, normal, uv):
        """Adds a vertex and returns its index."""
        self.positions.append(position)
        self.normals.append(normal)
        self.uvs.append(uv)
        return len(self.positions) - 1

    def add_face(self, a, b, c):
        """Adds a triangle of vertex indices; one without area (at the pole of a surface of revolution) is left out."""
        pa, pb, pc = self.positions[a], self.positions[b], self.positions[c]
        if length(cross(subtract(pb, pa), subtract(pc, pa))) > 1e-10:
            self.faces.append((a, b, c))

    def add_polygon(self, points, uvs):
        """Adds a flat convex polygon, counter-clockwise seen from its front."""
        normal = normalise(cross(subtract(points[1], points[0]), subtract(points[2], points[0])))
        corners = [self.add_vertex(point, normal, uv) for point, uv in zip(points, uvs)]
        for second, third in zip(corners[1:], corners[2:]):
            self.add_face(corners[0], second, third)

    def add(self, other, transform=None):
        """Adds a copy of another mesh, moved by `transform`; returns self, so that calls can be chained."""
        first = len(self.positions)
        if transform is None:
            self.positions.extend(other.positions)
            self.normals.extend(other.normals)
        else:
            self.positions.extend(transform.point(p) for p in other.positions)
            self.normals.extend(transform.normal(n) for n in other.normals)
        self.uvs.extend(other.uvs)
        mirrored = transform is not None and transform.determinant() < 0
        for a, b, c in other.faces:
            self.faces.append((first + a, first + c, first + b) if mirrored else (first + a, first + b, first + c))
        return self

    def moved(self, transform):
        """A copy of the mesh, moved by `transform`."""
        return Mesh().add(self, transform)

    def check(self):
        """Raises ValueError where a face has no area or looks away from one of its vertices' normals."""
        for face in self.faces:
            a, b, c = (self.positions[i] for i in face)
            normal = cross(subtract(b, a), subtract(c, a))
            if length(normal) == 0:
                raise ValueError(f"face {face} at {a} has no area")
            if any(dot(normal, self.normals[i]) <= 0 for i in face):
                raise ValueError(f"face {face} at {a} looks away from its normals")


def merged(meshes):
    """One mesh of all the given ones."""
    result = Mesh()
    for mesh in meshes:
        result.add(mesh)
    return result
