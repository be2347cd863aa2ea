"""What a scene's folder holds: scene.xml, meshes/ and textures/."""

from . import files
from .xml import BLANK, Element, document, integer, number, ref, rgb, string, to_world


class SceneFolder:
    """Collects a scene. Shapes, emitters and bsdfs are written in the order in which they are added."""

    def __init__(self, header, width, height, spp=64, max_depth=7):
        """header: what the scene shows and stresses, written at the top of the file."""
        self.header = header
        self.defaults = (("width", width), ("height", height), ("spp", spp), ("max_depth", max_depth))
        self.sensor = None
        self.bsdfs = []
        self.shapes = []
        self.emitters = []
        self.contents = {}
        self.triangles = 0

    def camera(self, origin, target, fov, fov_axis="x"):
        """A pinhole camera; fov in degrees along fov_axis ("x", "y", "smaller" ...)."""
        self.sensor = Element(
            "sensor", string("fov_axis", fov_axis), number("fov", float(fov)),
            to_world(Element("lookat", origin=origin, target=target, up=(0, 1, 0))),
            Element("sampler", integer("sample_count", "$spp"), type="independent"),
            Element("film", integer("width", "$width"), integer("height", "$height"), string("pixel_format", "rgb"),
                    Element("rfilter", type="box"), type="hdrfilm"),
            type="perspective")

    def material(self, identifier, bsdf):
        """Names a bsdf, for shapes to refer to."""
        bsdf.attributes["id"] = f"{identifier}_bsdf"
        self.bsdfs.append(bsdf)

    def texture(self, name, image):
        """Adds a picture; returns the path that a bitmap texture needs."""
        path = f"textures/{name}.png"
        self.contents[path] = files.png(image)
        return path

    def environment(self, name, rows, brightness):
        """Lights the scene by a latitude-longitude picture in physical units times `brightness`."""
        path = f"textures/{name}.hdr"
        self.contents[path] = files.radiance_hdr(rows)
        self.emitters.append(Element("emitter", string("filename", path), number("scale", brightness), type="envmap"))

    def mesh(self, name, mesh, material, places=(None,), emission=None):
        """Adds a mesh once for each of `places`: transforms as lists of XML steps, or None where it stands already."""
        path = f"meshes/{name}.ply"
        self.contents[path] = files.ply(mesh)
        for number_, steps in enumerate(places):
            identifier = name if len(places) == 1 else f"{name}_{number_ + 1}"
            parts = [string("filename", path)]
            if steps is not None:
                parts.append(to_world(*steps))
            self._add_shape("ply", identifier, parts, material, emission, len(mesh.faces))

    def shape(self, kind, name, material, *parts, emission=None):
        """Adds a shape that needs no file: rectangle, cube (transforms among `parts`), sphere, disk ..."""
        self._add_shape(kind, name, list(parts), material, emission, {"rectangle": 2, "cube": 12}.get(kind, 0))

    def _add_shape(self, kind, identifier, parts, material, emission, triangles):
        parts.append(ref(f"{material}_bsdf"))
        if emission is not None:
            parts.append(Element("emitter", rgb("radiance", emission), type="area"))
        self.shapes.append(Element("shape", *parts, type=kind, id=identifier))
        self.triangles += triangles

    def sun(self, direction, irradiance):
        """A directional emitter: `direction` points the way the light goes; irradiance across it."""
        self.emitters.append(Element("emitter", Element("vector", name="direction", value=direction),
                                     rgb("irradiance", irradiance), type="directional"))

    def files(self):
        """Path within the folder -> bytes."""
        names = [part.attributes["id"] for part in (*self.bsdfs, *self.shapes)]
        if len(set(names)) < len(names):
            raise ValueError(f"ids are given twice: {sorted(name for name in set(names) if names.count(name) > 1)}")
        integrator = Element("integrator", integer("max_depth", "$max_depth"), type="path")
        defaults = [Element("default", name=name, value=value) for name, value in self.defaults]
        parts = [*defaults, BLANK, integrator, BLANK, self.sensor, BLANK, *self.bsdfs, BLANK, *self.shapes]
        if self.emitters:
            parts += [BLANK, *self.emitters]
        text = document(self.header, Element("scene", *parts, version="3.0.0"))
        return {"scene.xml": text.encode("utf-8"), **self.contents}
