"""Tests of scripts/fetch-scenes with tiny zips, checksum lists of their own, and no network."""

import functools
import hashlib
import http.server
import os
import shutil
import subprocess
import tempfile
import threading
import unittest
import zipfile
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "fetch-scenes"
BASH = shutil.which("bash")

VERIFIED = {
    "scene_v0.6.xml": b"<scene version='0.6.0'/>\n",
    "models/Mesh001.obj": b"v 0 0 0\n" * 400,
    "textures/wood, old.jpg": bytes(range(256)) * 20,
}
UNVERIFIED = {"models/Mesh002.obj": b"v 1 1 1\n"}
PUBLISHED = {**VERIFIED, **UNVERIFIED, "TungstenRender.exr": b"not in any list"}


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class FetchScenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.zips = self.root / "zips"
        self.target = self.root / "target"
        self.checksums = self.root / "checksums"
        self.zips.mkdir()
        self.checksums.mkdir()
        for name in ("attic", "cellar"):
            lines = [f"{hashlib.sha256(data).hexdigest()}  {path}\n" for path, data in sorted(VERIFIED.items())]
            (self.checksums / f"{name}.sha256").write_text("".join(lines))
            (self.checksums / f"{name}.unverified").write_text("".join(f"{path}\n" for path in UNVERIFIED))
            self.write_zip(name, PUBLISHED)
        self.environment = {
            "PATH": os.environ["PATH"],
            "GRADSLC_SCENE_CHECKSUMS": str(self.checksums),
            "GRADSLC_SCENES_URL": "http://127.0.0.1:1",
        }

    def write_zip(self, name, files, prefix=None):
        prefix = f"{name}/" if prefix is None else prefix
        with zipfile.ZipFile(self.zips / f"{name}.zip", "w", zipfile.ZIP_DEFLATED) as archive:
            for path, data in files.items():
                archive.writestr(prefix + path, data)

    def fetch(self, *arguments):
        return subprocess.run([BASH, SCRIPT, *arguments, self.target], env=self.environment, cwd=self.root, timeout=30,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)

    def fetch_from_zips(self, *arguments):
        return self.fetch("--from", self.zips, *arguments)

    def installed(self):
        return sorted(path.name for path in self.target.iterdir()) if self.target.exists() else []

    def files_of(self, name):
        scene = self.target / name
        return {str(path.relative_to(scene)): path.read_bytes() for path in scene.rglob("*") if path.is_file()}

    def assert_success(self, result):
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)

    def assert_failure(self, result, status, *parts):
        self.assertEqual(result.returncode, status, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("scripts/fetch-scenes: "), result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)

    def test_installs_all_scenes_and_nothing_else(self):
        self.assert_success(self.fetch_from_zips())
        self.assertEqual(self.installed(), ["attic", "cellar"])
        for name in ("attic", "cellar"):
            self.assertEqual(self.files_of(name), PUBLISHED)

    def test_downloads_from_the_address(self):
        self.environment["GRADSLC_SCENES_URL"] = self.zips.as_uri()
        self.assert_success(self.fetch())
        self.assertEqual(self.installed(), ["attic", "cellar"])

    def test_answer_that_is_not_the_zip(self):
        handler = functools.partial(QuietHandler, directory=str(self.zips))
        (self.zips / "cellar.zip").unlink()
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            self.environment["GRADSLC_SCENES_URL"] = f"http://127.0.0.1:{server.server_port}"
            result = self.fetch()
            server.shutdown()
        self.assert_failure(result, 1, "cannot download", "cellar.zip", "404")
        self.assertEqual(self.installed(), ["attic"])

    def test_zip_without_a_folder(self):
        self.write_zip("attic", PUBLISHED, prefix="")
        self.assert_success(self.fetch_from_zips("--only", "attic"))
        self.assertEqual(self.files_of("attic"), PUBLISHED)

    def test_zip_with_a_folder_of_another_name(self):
        self.write_zip("attic", PUBLISHED, prefix="the attic/")
        self.assert_success(self.fetch_from_zips("--only", "attic"))
        self.assertEqual(self.files_of("attic"), PUBLISHED)

    def test_only(self):
        self.assert_success(self.fetch_from_zips("--only", "cellar"))
        self.assertEqual(self.installed(), ["cellar"])
        self.assert_success(self.fetch_from_zips("--only", "cellar", "--only", "attic"))
        self.assertEqual(self.installed(), ["attic", "cellar"])

    def test_scene_that_is_there_is_not_fetched_again(self):
        self.assert_success(self.fetch_from_zips())
        before = (self.target / "attic").stat().st_ino
        result = self.fetch()  # from an address that does not answer
        self.assert_success(result)
        self.assertIn("attic: is there already", result.stdout)
        self.assertEqual((self.target / "attic").stat().st_ino, before)

    def test_scene_that_is_there_and_changed_is_neither_accepted_nor_lost(self):
        self.assert_success(self.fetch_from_zips())
        mesh = self.target / "attic" / "models" / "Mesh001.obj"
        mesh.write_bytes(b"edited")
        self.assert_failure(self.fetch_from_zips(), 2, "attic is there, but models/Mesh001.obj has a wrong SHA-256")
        self.assertEqual(mesh.read_bytes(), b"edited")

    def test_wrong_checksum_installs_nothing(self):
        self.write_zip("attic", {**PUBLISHED, "textures/wood, old.jpg": b"another"})
        self.assert_failure(self.fetch_from_zips("--only", "attic"), 2, "attic",
                            "textures/wood, old.jpg has a wrong SHA-256 (wrong files: 1)")
        self.assertEqual(self.installed(), [])

    def test_failure_keeps_the_scenes_before_it(self):
        self.write_zip("cellar", {**PUBLISHED, "models/Mesh001.obj": b"another"})
        self.assert_failure(self.fetch_from_zips(), 2, "cellar")
        self.assertEqual(self.installed(), ["attic"])
        self.assertEqual(self.files_of("attic"), PUBLISHED)

    def test_missing_file_installs_nothing(self):
        for path in ("models/Mesh001.obj", "models/Mesh002.obj", "scene_v0.6.xml"):
            with self.subTest(path):
                self.write_zip("attic", {other: data for other, data in PUBLISHED.items() if other != path})
                self.assert_failure(self.fetch_from_zips("--only", "attic"), 2, "attic", f"{path} is missing")
                self.assertEqual(self.installed(), [])

    def test_truncated_zip_installs_nothing(self):
        archive = self.zips / "attic.zip"
        whole = archive.read_bytes()
        for length in (0, len(whole) // 2, len(whole) - 10):
            with self.subTest(length):
                archive.write_bytes(whole[:length])
                self.assert_failure(self.fetch_from_zips("--only", "attic"), 2, "attic", "cannot be unpacked")
                self.assertEqual(self.installed(), [])

    def test_unreachable_address_installs_nothing(self):
        self.assert_failure(self.fetch(), 1, "cannot download http://127.0.0.1:1/attic.zip")
        self.assertEqual(self.installed(), [])

    def test_missing_zip(self):
        (self.zips / "attic.zip").unlink()
        self.assert_failure(self.fetch_from_zips(), 2, "attic.zip does not exist")
        self.assertEqual(self.installed(), [])

    def test_wrong_usage(self):
        self.assert_failure(self.fetch_from_zips("--only", "garage"), 2, 'no scene "garage"', "attic cellar")
        self.assert_failure(self.fetch("--only", ""), 2, "--only needs a value")
        self.assert_failure(self.fetch("--form", self.zips), 2, '"--form" is not known')
        self.assert_failure(self.fetch("--from", self.root / "nowhere"), 2, "is not a folder")
        self.assert_failure(self.fetch("another folder"), 2, "one folder")
        self.assertEqual(self.installed(), [])

    def test_help(self):
        result = self.fetch("--help")
        self.assert_success(result)
        self.assertIn("usage: scripts/fetch-scenes", result.stdout)
        self.assertIn("attic cellar", result.stdout)

    def test_folder_that_cannot_be_made(self):
        self.target.write_text("a file in its place")
        self.assert_failure(self.fetch_from_zips(), 1, "cannot make the folder")

    def test_broken_lists(self):
        (self.checksums / "attic.sha256").write_text("")
        self.assert_failure(self.fetch_from_zips(), 2, "attic.sha256 is malformed")
        self.environment["GRADSLC_SCENE_CHECKSUMS"] = str(self.zips)
        self.assert_failure(self.fetch_from_zips(), 2, "holds no checksum lists")
        self.assertEqual(self.installed(), [])

    def use_tools_without(self, missing):
        """Lets PATH hold nothing but the tools that the script uses, without one of them."""
        folder = self.root / f"without {missing}"
        folder.mkdir()
        for tool in ("cat", "curl", "cut", "dirname", "mkdir", "mktemp", "mv", "rm", "sha256sum", "unzip"):
            if tool != missing:
                (folder / tool).symlink_to(shutil.which(tool))
        self.environment["PATH"] = str(folder)

    def test_missing_tools(self):
        for tool in ("curl", "unzip", "sha256sum"):
            with self.subTest(tool):
                self.use_tools_without(tool)
                self.assert_failure(self.fetch(), 1, f"{tool} is missing")
                self.assertEqual(self.installed(), [])

    def test_zips_at_hand_need_no_curl(self):
        self.use_tools_without("curl")
        self.assert_success(self.fetch_from_zips())


class CommittedLists(unittest.TestCase):
    def test_names_and_form(self):
        lists = sorted((SCRIPT.parent / "scene-checksums").glob("*.sha256"))
        self.assertEqual([path.stem for path in lists], ["bathroom", "cornell-box", "house", "lamp", "staircase"])
        for path in lists:
            lines = path.read_text().splitlines()
            files = [line[66:] for line in lines]
            self.assertEqual(files, sorted(set(files)), path)
            self.assertIn("scene_v0.6.xml", files)
            for line in lines:
                self.assertRegex(line, r"^[0-9a-f]{64}  \S.*$")
            unverified = path.with_suffix(".unverified")
            if unverified.exists():
                self.assertFalse(set(files) & set(unverified.read_text().splitlines()), path)


if __name__ == "__main__":
    unittest.main()
