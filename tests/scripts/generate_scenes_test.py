"""scripts/generate-scenes: the committed scenes are what it writes, and sound; its parameters work."""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ("bathroom", "cornell-box", "lamp", "staircase", "veranda")
# What Mitsuba 3 knows under these names, and every renderer of its format.
PLUGINS = {
    "shape": {"rectangle", "cube", "sphere", "disk", "cylinder", "obj", "ply"},
    "bsdf": {"diffuse", "conductor", "roughconductor", "dielectric", "thindielectric", "roughdielectric", "plastic",
             "roughplastic", "twosided", "mask", "bumpmap", "normalmap", "blendbsdf"},
    "texture": {"bitmap", "checkerboard"},
    "emitter": {"area", "constant", "envmap", "point", "spot", "directional"},
    "sensor": {"perspective", "thinlens"},
    "film": {"hdrfilm"},
    "rfilter": {"box"},
    "sampler": {"independent"},
    "integrator": {"path"},
}

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scenes"))
from generator import files, solids, surfaces  # noqa: E402
from generator.geometry import Transform  # noqa: E402
from generator.mesh import Mesh  # noqa: E402


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def generate(folder, *arguments):
    command = [ROOT / "scripts" / "generate-scenes", "--out", folder, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


class GeneratedScenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_committed_scenes_are_what_the_generator_writes(self):
        outcome = generate(self.folder)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted(SCENES))
        for scene in SCENES:
            made, committed = contents(self.folder / scene), contents(ROOT / "scenes" / scene)
            self.assertEqual(sorted(made), sorted(committed), scene)
            differing = [path for path, data in made.items() if data != committed[path]]
            self.assertEqual(differing, [], f"{scene}: run scripts/generate-scenes and look at the images")

    def test_committed_scenes_use_common_plugins_and_their_own_files(self):
        size = 0
        for scene in SCENES:
            folder = ROOT / "scenes" / scene
            size += sum(map(len, contents(folder).values()))
            used = {"scene.xml"}
            for element in xml.etree.ElementTree.parse(folder / "scene.xml").getroot().iter():
                if element.tag in PLUGINS:
                    self.assertIn(element.get("type"), PLUGINS[element.tag], f"{scene}: <{element.tag}>")
                if element.get("name") == "filename":
                    used.add(element.get("value"))
            self.assertEqual(sorted(used), sorted(contents(folder)), scene)
        self.assertLess(size, 6e6, "bytes of all scenes")

    def test_parameters_change_a_scene(self):
        outcome = generate(self.folder, "--set", "staircase.steps=12", "staircase")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["staircase"])
        self.assertNotEqual((self.folder / "staircase/meshes/treads.ply").read_bytes(),
                            (ROOT / "scenes/staircase/meshes/treads.ply").read_bytes())

    def test_wrong_arguments_are_refused_in_one_line(self):
        for arguments, words in ((("--set", "staircase.steps=99"), "steps must be 8 to 24, not 99"),
                                 (("--set", "staircase.stairs=9"), 'staircase has no parameter "stairs"'),
                                 (("--set", "attic.steps=9"), "not SCENE.PARAMETER=VALUE"),
                                 (("--set", "staircase.steps=many"), "staircase.steps: invalid literal"),
                                 (("attic",), 'no scene "attic"')):
            outcome = generate(self.folder, *arguments)
            self.assertEqual(outcome.returncode, 1, arguments)
            self.assertIn(words, outcome.stderr)
            self.assertEqual(outcome.stderr.count("\n"), 1, outcome.stderr)
            self.assertEqual(list(self.folder.iterdir()), [])


class Shapes(unittest.TestCase):
    """A closed mesh encloses its volume by the divergence theorem: not where a face is missing or turned round."""

    @staticmethod
    def volume(mesh):
        total = 0.0
        for face in mesh.faces:
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (mesh.positions[i] for i in face)
            total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        return total / 6

    def test_volumes(self):
        square = [(1, 0), (0, 1), (-1, 0), (0, -1)]
        path = [(0, 0.1 * k, 0) for k in range(11)]
        for mesh, expected, tolerance in (
                (solids.box((1, 2, 3), (2, 4, 6)), 6.0, 1e-9),
                (solids.box((0, 0, 0), (1, 1, 1), bevel=0.1), 1 - 12 * 0.1**2 / 2 * 0.8 - 8 * 0.1**3 * 5 / 6, 1e-9),
                (solids.prism(square, 0.0, 3.0), 6.0, 1e-9),
                (surfaces.lathe([(0, 0), (1, 0), (1, 2), (0, 2)], 128), 6.2832, 0.01),
                (surfaces.lathe(surfaces.arc((0, 0), 1, -90, 90, 64), 128), 4.18879, 0.01),
                (surfaces.tube(path, 0.5, sides=128), 0.7854, 0.001),
                (surfaces.ring(1.0, 0.1, 128, 64), 0.19739, 0.001)):
            mesh.check()
            self.assertAlmostEqual(self.volume(mesh), expected, delta=tolerance)
            mirrored = mesh.moved(Transform.scaling(-2, 1, 1))
            mirrored.check()
            self.assertAlmostEqual(self.volume(mirrored), 2 * expected, delta=2 * tolerance)

    def test_a_face_turned_round_is_refused(self):
        mesh = Mesh()
        for position in ((0, 0, 0), (1, 0, 0), (0, 1, 0)):
            mesh.add_vertex(position, (0, 0, -1), (0, 0))
        mesh.add_face(0, 1, 2)
        with self.assertRaisesRegex(ValueError, "looks away"):
            files.ply(mesh)

    def test_rgbe_is_accurate(self):
        for colour in ((1.0, 0.5, 0.25), (0.999999, 0.1, 0.0), (255.7, 3.0, 80.0), (1e-3, 2e-3, 0.0)):
            *mantissas, exponent = files.radiance_hdr([[colour]])[-4:]
            for mantissa, value in zip(mantissas, colour):
                self.assertAlmostEqual(mantissa * 2.0 ** (exponent - 136), value, delta=max(colour) / 200)


if __name__ == "__main__":
    unittest.main()
