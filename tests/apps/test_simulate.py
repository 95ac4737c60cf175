"""What a user of `hoist simulate` types, and what comes out.

Run by ctest with the program in the environment.
"""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["HOIST_PROGRAM"]

# two visits to two sites, small, with all that is drawn in parallel
SCENE = """name: yard
sensor: {kind: kinect, width: 160, height: 120, fx: 140, registration_error: 0.002}
camera: {distance: [2, 3]}
area: [3, 3]
light: {lamps: [1, 2]}
visits: {count: 2, frames: 2, new: 0.3, moved: 0.3, removed: 0.3}
things:
  - {kind: [carton, block, bucket], count: [2, 4], stacked: 0.3, timbers: 0.4}
"""


def hoist(*arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
    )


class Simulate(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-simulate-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scene = self.write("scene.yaml", SCENE)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def simulate(self, *arguments):
        result = hoist("simulate", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def assert_same(self, one, other, but=()):
        """Two results of files() are the same, but for the files named."""
        self.assertEqual(set(one), set(other))
        differing = [name for name in one if one[name] != other[name] and name not in but]
        self.assertEqual(differing, [])

    def assert_one_line(self, result, code, *words):
        """Ended with this code and one line on stderr that has these words."""
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)

    def files(self, folder):
        """Name to bytes of all files in a folder."""
        folder = self.folder / folder
        return {str(path.relative_to(folder)): path.read_bytes()
                for path in sorted(folder.rglob("*")) if path.is_file()}


class Frames(Simulate):
    def test_same_bytes_at_any_number_of_threads(self):
        for threads in (1, 2, 5):
            self.simulate(self.scene, "--seed", 3, "-n", 8, "-q", "-j", threads,
                          "--formats", "pcd,pts,compact", "-o", self.folder / str(threads))
        alone = self.files("1")
        self.assertEqual(len(alone), 8 * 6 + 2 + 1)  # and two plans, one description
        self.assert_same(alone, self.files("2"))
        self.assert_same(alone, self.files("5"))

    def test_machines_can_share_a_set(self):
        self.simulate(self.scene, "-n", 3, "-q", "-o", self.folder / "all")
        for first in range(3):
            self.simulate(self.scene, "-n", 1, "--first", first, "-q", "-o",
                          self.folder / "shared")
        # the description says how its folder was made
        self.assert_same(self.files("all"), self.files("shared"), ["description.yaml"])

    def test_truth_names_files_that_are_there(self):
        self.simulate(self.scene, "-n", 2, "-q", "--formats", "compact", "-o",
                      self.folder / "out")
        truths = sorted((self.folder / "out").glob("yard-*.json"))
        self.assertEqual([path.name for path in truths],
                         ["yard-000000.json", "yard-000001.json"])
        for path in truths:
            truth = json.loads(path.read_text(encoding="utf-8"))
            self.assertEqual(set(truth["files"]), {"color", "depth", "instances"})
            for name in truth["files"].values():
                self.assertTrue((path.parent / name).is_file(), name)

    def test_description_that_was_used_makes_the_same_again(self):
        self.simulate(self.scene, "-n", 2, "--seed", 5, "-q", "-o", self.folder / "a")
        used = self.folder / "a" / "description.yaml"
        self.assertIn("--seed 5", used.read_text(encoding="utf-8"))
        self.simulate(used, "-n", 2, "--seed", 5, "-q", "-o", self.folder / "b")
        self.assert_same(self.files("a"), self.files("b"), ["description.yaml"])

    def test_seeds_differ(self):
        for seed in (1, 2):
            self.simulate(self.scene, "--seed", seed, "-q", "-o", self.folder / str(seed))
        self.assertNotEqual(self.files("1")["yard-000000.pcd"],
                            self.files("2")["yard-000000.pcd"])


class Resume(Simulate):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.settings = [self.scene, "-n", 4, "--seed", 3, "--formats", "pcd,compact",
                         "-o", self.out]
        self.simulate(*self.settings, "-q")
        self.before = self.files("out")
        for path in self.out.rglob("*"):  # long ago: what is made anew is newer
            if path.is_file():
                os.utime(path, (1e9, 1e9))

    def frames_made_anew(self):
        return {path.name.split(".")[0] for path in self.out.glob("yard-*")
                if path.stat().st_mtime > 1e9}

    def test_just_the_frame_with_a_lost_file_is_made_with_the_same_bytes(self):
        for ending in (".pcd", ".jpg", ".depth.png", ".instances.png", ".json"):
            with self.subTest(ending):
                for path in self.out.glob("yard-*"):
                    os.utime(path, (1e9, 1e9))
                (self.out / f"yard-000002{ending}").unlink()
                result = self.simulate(*self.settings, "--resume")
                self.assertIn("1 frames (3 were there)", result.stderr)
                self.assert_same(self.files("out"), self.before)
                self.assertEqual(self.frames_made_anew(), {"yard-000002"})

    def test_nothing_lost_nothing_made(self):
        self.simulate(*self.settings, "--resume")
        self.assert_same(self.files("out"), self.before)
        self.assertEqual(self.frames_made_anew(), set())

    def test_truth_that_is_cut_off_is_made_again(self):
        truth = self.out / "yard-000001.json"
        truth.write_bytes(truth.read_bytes()[:100])
        os.utime(truth, (1e9, 1e9))
        self.simulate(*self.settings, "--resume")
        self.assert_same(self.files("out"), self.before)
        self.assertEqual(self.frames_made_anew(), {"yard-000001"})

    def test_frames_of_another_seed_are_no_frames_of_this_one(self):
        other = [4 if setting == 3 else setting for setting in self.settings]
        self.simulate(*other, "--resume")
        resumed = self.files("out")
        other[-1] = self.folder / "fresh"
        self.simulate(*other)
        self.assert_same(resumed, self.files("fresh"))

    def test_a_format_more_is_made(self):
        more = [*self.settings, "--resume"]
        more[more.index("pcd,compact")] = "pcd,compact,pts"
        self.simulate(*more)
        self.assertEqual(len(list(self.out.glob("yard-*.pts"))), 4)


class Usage(Simulate):
    def test_help_names_every_option_and_the_exit_codes(self):
        result = self.simulate("--help")
        for word in ("SCENE", "--suite", "--list-suites", "--print", "--output",
                     "--seed", "-n", "--first", "--formats", "pcd", "pts", "compact",
                     "--threads", "--resume", "--quiet", "Exit codes", "Example"):
            self.assertIn(word, result.stdout)

    def test_every_suite_can_be_printed_and_used(self):
        listed = self.simulate("--list-suites").stdout.splitlines()
        names = [line.split()[0] for line in listed]
        self.assertLessEqual({"crane-stereo", "crane-tof", "table-kinect",
                              "worksite-train", "worksite-val", "worksite-test",
                              "site-revisit"}, set(names))
        printed = self.simulate("--suite", "crane-tof", "--print").stdout
        own = self.write("own.yaml", printed)
        seed = next(line for line in listed if line.startswith("crane-tof "))
        seed = seed.split("seed ")[1].split(",")[0]
        self.simulate("--suite", "crane-tof", "-n", 1, "-q", "-o", self.folder / "a")
        self.simulate(own, "--seed", seed, "-n", 1, "-q", "-o", self.folder / "b")
        self.assert_same(self.files("a"), self.files("b"), ["description.yaml"])

    def test_what_is_missing_or_unknown_is_exit_2(self):
        out = self.folder / "out"
        self.assert_one_line(hoist("simulate", "-o", out), 2, "SCENE", "--suite")
        self.assert_one_line(hoist("simulate", self.scene, "--suite", "crane-tof",
                                   "-o", out), 2, "SCENE", "--suite")
        self.assert_one_line(hoist("simulate", "--suite", "crane-sonar", "-o", out), 2,
                             "crane-sonar", "--list-suites")
        self.assert_one_line(hoist("simulate", self.scene), 2, "--output")
        self.assert_one_line(hoist("simulate", self.folder / "none.yaml", "-o", out), 2,
                             "none.yaml")
        for bad in (["-n", "0"], ["-n", "x"], ["--threads", "0"], ["--first", "-1"],
                    ["--formats", "ply"], ["--seed", "-1"], ["--fast"]):
            with self.subTest(bad):
                result = hoist("simulate", self.scene, "-o", out, *bad)
                self.assert_one_line(result, 2, bad[0].lstrip("-"))
        self.assertFalse(out.exists())

    def test_mistakes_in_a_description_are_told_with_their_line(self):
        out = self.folder / "out"
        for text, line, words in (
                ("name: x\nsensor: sonar\n", 2, ["sonar"]),
                ("name: x\n\nspeed: 3\n", 3, ["speed"]),
                ("camera: {distance: [4, 2]}\n", 1, ["range"]),
                ("things:\n  - {kind: carton}\n  - {kind: zeppelin}\n", 3, ["zeppelin"]),
                ("things:\n  - {kind: carton, count: -1}\n", 2, ["-1"]),
                ("name: [x\n", 2, [])):
            with self.subTest(text):
                scene = self.write("bad.yaml", text)
                result = hoist("simulate", scene, "-o", out)
                self.assert_one_line(result, 2, f"bad.yaml:{line}", *words)
        self.assertFalse(out.exists())

    def test_mesh_that_cannot_be_used(self):
        self.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n")
        scene = self.write("mesh.yaml", "things:\n  - {kind: block, mesh: broken.obj}\n")
        self.assert_one_line(hoist("simulate", scene, "-q", "-o", self.folder / "out"), 1,
                             "broken.obj:3")

    def test_place_that_cannot_be_written(self):
        occupied = self.write("file", "")
        for out in (occupied, occupied / "out"):
            self.assert_one_line(hoist("simulate", self.scene, "-q", "-o", out), 1, "file")
        self.assertEqual(occupied.read_bytes(), b"")


if __name__ == "__main__":
    unittest.main()
