"""What a user of the program types, and what comes out.

Run by ctest with the program, the folder of the sample scenes and, for the real frames,
HOIST_REAL_DATA in the environment.
"""

import csv
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

PROGRAM = os.environ["HOIST_PROGRAM"]
SAMPLES = pathlib.Path(os.environ["HOIST_SAMPLES"])
REAL = os.environ.get("HOIST_REAL_DATA")


def hoist(*arguments, cwd=None, env=None):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        cwd=cwd,
        env={**os.environ, **(env or {})},
        timeout=300,
    )


def strict_json(text):
    """JSON as the standard has it: no NaN, no Infinity."""

    def refuse(constant):
        raise ValueError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def write_pcd(path, width, height, point, color=True):
    """An ascii PCD; point(u, v) gives x, y, z, packed rgb."""
    with open(path, "w", encoding="ascii") as file:
        file.write("VERSION 0.7\n")
        file.write("FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
                   if color else
                   "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n")
        file.write(f"WIDTH {width}\nHEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\n")
        file.write(f"POINTS {width * height}\nDATA ascii\n")
        for v in range(height):
            for u in range(width):
                values = point(u, v)
                file.write(" ".join(map(str, values if color else values[:3])) + "\n")


def wall(u, v):
    z = 2.0
    return (u - 79.5) * z / 131.25, (v - 59.5) * z / 131.25, z, 0x909090


def png_size(path):
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    return struct.unpack(">II", data[16:24])


def png_pixels(path):
    """Number of different bytes in the image data: a blank picture has few."""
    data, position, packed = path.read_bytes(), 8, b""
    while position < len(data):
        (length,) = struct.unpack(">I", data[position:position + 4])
        if data[position + 4:position + 8] == b"IDAT":
            packed += data[position + 8:position + 8 + length]
        position += 12 + length
    return len(set(zlib.decompress(packed)))


def without_name(result):
    return {key: value for key, value in result.items() if key != "scene"}


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-cli-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def sample(self, name):
        path = SAMPLES / name
        self.assertTrue(path.is_file(), path)
        return path

    def assert_one_line(self, result, code, *words):
        """Ended with this code and one line on stderr that has these words."""
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def recognize(self, *arguments):
        result = hoist("recognize", "--quiet", "--json", "-", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return strict_json(result.stdout)


class Usage(CommandLine):
    def test_help_tells_options_and_exit_codes(self):
        result = hoist("--help")
        self.assertEqual(result.returncode, 0)
        for word in ("recognize", "info", "convert", "Exit codes"):
            self.assertIn(word, result.stdout)
        result = hoist("recognize", "--help")
        self.assertEqual(result.returncode, 0)
        for word in ("--mode", "--roi", "--json", "--sensor", "--cluster-distance",
                     "--config", "Exit codes"):
            self.assertIn(word, result.stdout)
        self.assertLessEqual(max(map(len, result.stdout.splitlines())), 120)

    def test_version(self):
        result = hoist("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^\d+\.\d+\.\d+\n$")

    def test_no_command_and_unknown_command(self):
        self.assert_one_line(hoist(), 2)
        self.assert_one_line(hoist("lift"), 2, "lift")

    def test_missing_arguments(self):
        for command in ("recognize", "info", "convert"):
            self.assert_one_line(hoist(command), 2, f"hoist {command}", "required")

    def test_unknown_option(self):
        frame = self.sample("scenes/crate.pcd")
        self.assert_one_line(hoist("recognize", frame, "--radius", 1), 2, "--radius")
        self.assert_one_line(hoist("recognize", frame, "--radius=1"), 2, "--radius")
        self.assert_one_line(hoist("recognize", frame, "-z"), 2, "-z")
        self.assert_one_line(hoist("--verbose", "info", frame), 2, "--verbose")

    def test_missing_file(self):
        for command in ("recognize", "info"):
            self.assert_one_line(hoist(command, "nowhere.pcd"), 2, "nowhere.pcd")
        self.assert_one_line(hoist("convert", "nowhere.pcd", "a.pts"), 2, "nowhere.pcd")

    def test_bad_values(self):
        frame = self.sample("scenes/crate.pcd")
        bad = {
            "--min-side": ("abc", "-1", "0", "nan", "inf", "1e400", "0.1x", "0,1", ""),
            "--min-score": ("1.01", "-0.01", "nan"),
            "--max-cuboids": ("-1", "1.5", "x", "99999999999999999999"),
            "--mode": ("Paper", "fast", ""),
            "--longest": ("0.3", "0.3,0.2", "-0.1,1", "a,b", "0.1,nan", "0.1,0.2,0.3"),
            "--known-size": ("0.3", "0.3,0.2", "0.3,0.2,0", "0.3,0.2,x", "1,2,3,4"),
            "--known-tolerance": ("0", "-0.01", "x"),
            "--support-plane": ("0,0,0,1", "0,1,0", "0,1,0,x", "1"),
            "--sensor": ("kinekt", "stereo", "stereo:", "stereo:0", "stereo:-5",
                         "stereo:50,x", "stereo:50,1,1", "constant", "constant:nan",
                         "kinect:1"),
            "--roi": ("1,2,3", "1,2,3,4,5", "a,b,c,d", "0,0,0,5", "-1,0,5,5",
                      "1.5,0,5,5", "0 0 5 5"),
            "--material": ("kryptonite",),
            "--white-balance": ("auto",),
            "--formats": ("json,gif",),
            "--cluster-distance": ("-0.03", "nan"),
            "--max-degree": ("2",),
        }
        for option, values in bad.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    result = hoist("recognize", frame, f"{option}={value}")
                    self.assert_one_line(result, 2)
                    self.assertEqual(result.stdout, "")

    def test_values_that_contradict_each_other(self):
        frame = self.sample("scenes/crate.pcd")
        result = hoist("recognize", frame, "--min-side", 2, "--max-side", 1)
        self.assert_one_line(result, 2, "--min-side")
        result = hoist("recognize", frame, "--canny-low", 200, "--canny-high", 100)
        self.assert_one_line(result, 2, "--canny-low")

    def test_region_outside_the_frame(self):
        frame = self.sample("scenes/crate.pcd")
        result = hoist("recognize", "-q", frame, "--roi", "5000,0,10,10")
        self.assert_one_line(result, 2, "--roi")

    def test_pixel_outside_the_frame(self):
        frame = self.sample("scenes/crate.pcd")
        for pixel in ("5000,0", "1", "a,b", "-1,3", "1,2,3"):
            with self.subTest(pixel=pixel):
                result = hoist("recognize", "-q", frame, f"--why={pixel}")
                self.assert_one_line(result, 2, "--why")
        result = hoist("recognize", "-q", frame, "--why", "1,2", "--mode", "paper")
        self.assert_one_line(result, 2, "--why")

    def test_two_inputs_of_one_name(self):
        frame = self.sample("scenes/crate.pcd")
        (self.folder / "other").mkdir()
        copy = shutil.copy(frame, self.folder / "other")
        result = hoist("recognize", frame, copy, "-o", self.folder / "out")
        self.assert_one_line(result, 2, "crate")
        self.assertFalse((self.folder / "out").exists())

    def test_output_folder_that_is_a_file(self):
        (self.folder / "out").write_text("")
        frame = self.sample("scenes/crate.pcd")
        result = hoist("recognize", "-q", frame, "-o", self.folder / "out")
        self.assert_one_line(result, 1, "out")


class Settings(CommandLine):
    def config(self, text):
        path = self.folder / "settings.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    def run_with(self, text, *arguments):
        return hoist("recognize", "-q", self.sample("scenes/crate.pcd"), "-c",
                     self.config(text), *arguments)

    def test_same_as_on_the_command_line(self):
        frame = self.sample("scenes/stacked.pcd")
        typed = self.recognize(frame, "--mode", "paper", "--cluster-distance", "0.05",
                               "--keep-texture", "--canny-blur", "1.5", "--roi",
                               "100,50,400,350")
        config = self.config("# a comment\nmode: paper\ncluster_distance: 0.05\n"
                             "keep-texture: true\nraw-delta: false\ncanny:\n"
                             "  blur: 1.5\nroi: [100, 50, 400, 350]\n")
        self.assertEqual(self.recognize(frame, "--config", config), typed)
        self.assertEqual(typed["mode"], "paper")

    def test_command_line_wins(self):
        result = self.recognize(self.sample("scenes/crate.pcd"), "--mode", "full", "-c",
                                self.config("mode: paper\n"))
        self.assertEqual(result["mode"], "full")

    def test_empty_file_changes_nothing(self):
        frame = self.sample("scenes/crate.pcd")
        self.assertEqual(self.recognize(frame, "-c", self.config("")),
                         self.recognize(frame))

    def test_unknown_key_is_named_with_its_line(self):
        result = self.run_with("mode: paper\n\nmin_size: 0.1\n")
        self.assert_one_line(result, 2, "settings.yaml:3", "min-size")
        result = self.run_with("mode: paper\ncanny:\n  blurr: 1\n")
        self.assert_one_line(result, 2, "settings.yaml:3", "canny-blurr")

    def test_bad_value_is_named_with_its_line(self):
        self.assert_one_line(self.run_with("mode: paper\nmin-side: -1\n"), 2,
                             "settings.yaml:2")
        self.assert_one_line(self.run_with("keep-texture: maybe\n"), 2,
                             "settings.yaml:1", "maybe")
        self.assert_one_line(self.run_with("min-side: {a: 1}\n"), 2, "settings.yaml:1")
        self.assert_one_line(self.run_with("min-side:\n"), 2, "settings.yaml:1")
        self.assert_one_line(self.run_with("sensor: sonar\n"), 2, "settings.yaml:1")

    def test_key_given_twice(self):
        self.assert_one_line(self.run_with("min-side: 1\nmin_side: 2\n"), 2,
                             "settings.yaml:2", "twice")

    def test_what_is_no_setting(self):
        for key in ("files", "config", "help", "quiet"):
            self.assert_one_line(self.run_with(f"{key}: x\n"), 2, "settings.yaml:1")

    def test_broken_yaml(self):
        self.assert_one_line(self.run_with("mode: [paper\nmin-side: 1\n"), 2,
                             "settings.yaml:")
        self.assert_one_line(self.run_with("- a\n- b\n"), 2, "settings.yaml:1")
        self.assert_one_line(self.run_with("just words\n"), 2, "settings.yaml:1")


class Recognize(CommandLine):
    def test_writes_json_and_overlay(self):
        out = self.folder / "new" / "out"
        frame = self.sample("scenes/crate.pcd")
        result = hoist("recognize", frame, "-o", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(p.name for p in out.iterdir()),
                         ["crate.json", "crate.png"])
        found = strict_json((out / "crate.json").read_text(encoding="utf-8"))
        self.assertEqual(found["scene"], "crate")
        width, height = png_size(out / "crate.png")
        self.assertGreaterEqual(width, 1280)
        self.assertGreater(height, width * found["height"] // found["width"])
        self.assertGreater(png_pixels(out / "crate.png"), 100)

    def test_table_and_progress(self):
        frames = [self.sample(f"scenes/{name}.pcd") for name in ("crate", "stacked")]
        result = hoist("recognize", *frames)
        self.assertEqual(result.returncode, 0)
        self.assertTrue(result.stdout.startswith("scene"))
        self.assertIn("crate", result.stdout)
        self.assertIn("[1/2]", result.stderr)
        self.assertIn("[2/2]", result.stderr)
        self.assertNotIn("\r", result.stderr)  # no terminal
        self.assertEqual(hoist("recognize", "-q", *frames).stderr, "")

    def test_finds_the_sample_boxes(self):
        """Every visible box is met by a cuboid: centre within 2 cm."""
        for truth_file in sorted((SAMPLES / "truth").glob("*.json")):
            truth = json.loads(truth_file.read_text(encoding="utf-8"))
            found = self.recognize(self.sample(f"scenes/{truth_file.stem}.pcd"))
            for box in truth["cuboids"]:
                if box["difficult"]:  # hardly visible
                    continue
                nearest = min((math.dist(box["center"], c["center"])
                               for c in found["cuboids"]), default=math.inf)
                with self.subTest(scene=truth_file.stem, box=box["center"]):
                    self.assertLess(nearest, 0.02)

    def test_cuboids_are_cuboids(self):
        for name in ("crate", "stacked", "cartons"):
            for cuboid in self.recognize(self.sample(f"scenes/{name}.pcd"))["cuboids"]:
                size, axes = cuboid["size"], cuboid["rotation"]
                self.assertGreater(size[2], 0)
                for i in range(3):
                    for j in range(3):
                        dot = sum(axes[k][i] * axes[k][j] for k in range(3))
                        self.assertAlmostEqual(dot, float(i == j), places=9)
                self.assertTrue(0 <= cuboid["score"] <= 1)

    def test_json_of_one_frame_and_of_several(self):
        crate, stacked = (self.sample(f"scenes/{n}.pcd") for n in ("crate", "stacked"))
        one = self.recognize(crate)
        both = self.recognize(crate, stacked)
        self.assertEqual(both[0], one)
        self.assertEqual(both[1], self.recognize(stacked))
        result = hoist("recognize", "-q", crate, "--json", self.folder / "a.json")
        self.assertEqual(result.returncode, 0)
        self.assertTrue(result.stdout.startswith("scene"))
        self.assertEqual(strict_json((self.folder / "a.json").read_text()), one)

    def test_same_bytes_every_time(self):
        frame = self.sample("scenes/stacked.pcd")
        for mode in ("full", "paper"):
            runs = {hoist("recognize", "-q", "--mode", mode, "--json", "-", frame,
                          env={"OMP_NUM_THREADS": n}).stdout for n in ("1", "2", "5")}
            self.assertEqual(len(runs), 1)

    def test_locale_does_not_matter(self):
        frame = self.sample("scenes/crate.pcd")
        runs = {hoist("recognize", "-q", "--json", "-", frame, "--min-side", "0.02",
                      env={"LC_ALL": name}).stdout for name in ("C", "de_DE.UTF-8")}
        self.assertEqual(len(runs), 1)

    def test_all_formats(self):
        out = self.folder / "out"
        frame = self.sample("scenes/stacked.pcd")
        result = hoist("recognize", "-q", frame, "-o", out, "--formats",
                       "json,csv,pcd,ply,png")
        self.assertEqual(result.returncode, 0, result.stderr)
        found = strict_json((out / "stacked.json").read_text())["cuboids"]
        with open(out / "stacked.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(len(list(csv.reader(file))), 1 + len(found))
        self.assertTrue((out / "stacked.ply").read_text().startswith("ply"))
        self.assertIn(b"label", (out / "stacked_labels.pcd").read_bytes()[:400])
        self.assertTrue((out / "stacked.png").is_file())
        self.assertEqual(len(list(out.iterdir())), 5)

    def test_no_cuboid_is_a_result(self):
        frame = self.folder / "wall.pcd"
        write_pcd(frame, 160, 120, wall)
        for mode in ("full", "paper"):
            result = hoist("recognize", "-q", frame, "--mode", mode, "-o", self.folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("no cuboid", result.stdout)
            found = strict_json((self.folder / "wall.json").read_text())
            self.assertEqual(found["cuboids"], [])
            self.assertIn("rejected", found)
            self.assertTrue((self.folder / "wall.png").is_file())

    def test_frame_without_colour(self):
        frame = self.folder / "plain.pcd"
        write_pcd(frame, 160, 120, wall, color=False)
        result = hoist("recognize", "-q", frame, "-o", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "plain.png").is_file())
        self.assert_one_line(hoist("recognize", "-q", frame, "--mode", "paper"), 1,
                             "colour")

    def test_region_restricts(self):
        frame = self.sample("scenes/stacked.pcd")
        everything = self.recognize(frame)
        whole = self.recognize(
            frame, "--roi", f"0,0,{everything['width']},{everything['height']}")
        self.assertEqual(whole["cuboids"], everything["cuboids"])
        corner = self.recognize(frame, "--roi", "0,0,40,40")
        self.assertEqual(corner["cuboids"], [])

    def test_why(self):
        frame = self.sample("scenes/stacked.pcd")
        found = self.recognize(frame)
        camera = found["intrinsics"]
        x, y, z = found["cuboids"][0]["center"]
        pixel = (f"{round(camera['fx'] * x / z + camera['cx'])},"
                 f"{round(camera['fy'] * y / z + camera['cy'])}")
        result = hoist("recognize", "-q", frame, "--why", pixel, "--why", "0,0")
        self.assertEqual(result.returncode, 0)
        self.assertIn(f"pixel {pixel}: ", result.stdout)
        self.assertIn(": recognised\n", result.stdout)
        self.assertIn("no box was thought of here", result.stdout.split("pixel 0,0")[1])
        strict = hoist("recognize", "-q", frame, "--why", pixel, "--min-side", "0.9")
        self.assertNotIn(": recognised\n", strict.stdout)

    def test_limits(self):
        frame = self.sample("scenes/stacked.pcd")
        everything = self.recognize(frame)["cuboids"]
        self.assertGreater(len(everything), 1)
        self.assertEqual(len(self.recognize(frame, "--max-cuboids", 1)["cuboids"]), 1)
        for cuboid in self.recognize(frame, "--min-side", "0.18")["cuboids"]:
            self.assertGreaterEqual(min(cuboid["size"]), 0.18)
        for cuboid in self.recognize(frame, "--max-side", "0.3")["cuboids"]:
            self.assertLessEqual(max(cuboid["size"]), 0.3)

    def test_sizes_that_are_known(self):
        frame = self.sample("scenes/stacked.pcd")
        everything = self.recognize(frame)["cuboids"]
        for wanted in everything:
            size = sorted(wanted["size"], reverse=True)
            known = ",".join(f"{side:.4f}" for side in size)
            longest = f"{size[0] - 0.005:.4f},{size[0] + 0.005:.4f}"
            for options in (["--known-size", known], ["--longest", longest]):
                with self.subTest(options=options):
                    some = self.recognize(frame, *options)["cuboids"]
                    centers = [cuboid["center"] for cuboid in some]
                    self.assertLess(min(math.dist(wanted["center"], center)
                                        for center in centers), 0.005)
                    for cuboid in some:
                        self.assertLess(abs(max(cuboid["size"]) - size[0]), 0.0101)
        self.assertEqual(self.recognize(frame, "--known-size", "3,2,1")["cuboids"], [])
        # two sizes, in any way that they can be written
        two = [sorted(cuboid["size"]) for cuboid in everything[:2]]
        typed = [f"--known-size={','.join(map(str, size))}" for size in two]
        expected = self.recognize(frame, *typed)["cuboids"]
        self.assertGreaterEqual(len(expected), 2)
        settings = self.folder / "sizes.yaml"
        flat = [side for size in two for side in size]
        for text in (f"known_size: {two}", f"known-size: {flat}",
                     f"known: {{size: {two}}}"):
            with self.subTest(text=text):
                settings.write_text(text + "\n")
                found = self.recognize(frame, "--config", settings)["cuboids"]
                self.assertEqual(found, expected)

    def test_single_faces(self):
        # of the table's top and the boxes' sides nothing is said that is not asked for
        frame = self.sample("scenes/stacked.pcd")
        models = {cuboid["model"] for cuboid in self.recognize(frame)["cuboids"]}
        self.assertNotIn("face", models)
        faces = [cuboid for cuboid in self.recognize(frame, "--single-faces")["cuboids"]
                 if cuboid["model"] == "face"]
        self.assertEqual(len(faces), 1)  # the ground, 1 m x 0.8 m
        for side, expected in zip(sorted(faces[0]["size"], reverse=True), (1, 0.8)):
            self.assertAlmostEqual(side, expected, delta=0.02)
        self.assertIn("unknown", faces[0]["dimension_source"])

    def test_material_gives_a_weight(self):
        frame = self.sample("scenes/crate.pcd")
        result = hoist("recognize", "-q", frame, "--material", "steel")
        self.assertIn("kg", result.stdout)
        text = json.dumps(self.recognize(frame, "--material", "steel"))
        self.assertIn("steel", text)

    def test_bad_file_among_good_ones(self):
        bad = self.folder / "bad.pcd"
        bad.write_text("VERSION 0.7\nFIELDS x y\nnonsense\n")
        empty = self.folder / "empty.pcd"
        empty.write_bytes(b"")
        result = hoist("recognize", "-q", bad, self.sample("scenes/crate.pcd"), empty,
                       "-o", self.folder / "out")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 2, result.stderr)
        self.assertIn("bad.pcd", result.stderr)
        self.assertIn("empty.pcd", result.stderr)
        self.assertTrue((self.folder / "out" / "crate.json").is_file())
        self.assertFalse((self.folder / "out" / "bad.json").exists())

    def test_folder_that_cannot_be_made(self):
        result = hoist("recognize", "-q", self.sample("scenes/crate.pcd"), "-o",
                       "/proc/none/out")
        self.assert_one_line(result, 1, "/proc/none/out")


class InfoAndConvert(CommandLine):
    def test_info(self):
        result = hoist("info", self.sample("scenes/crate.pcd"),
                       self.sample("scenes/crate.pts"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("PCD", result.stdout)
        self.assertIn("Bumblebee", result.stdout)
        self.assertEqual(len(re.findall(r"size +320 x 240 pixels", result.stdout)), 2)
        self.assertRegex(result.stdout, r"fx \d+\.\d+")

    def test_info_of_a_file_that_is_no_cloud(self):
        bad = self.folder / "bad.pts"
        bad.write_text("version: 1\nn_points: 68\n{\n1 2\n}\n")
        self.assert_one_line(hoist("info", bad), 1, "bad.pts")

    def test_every_format_gives_the_same_cuboids(self):
        frame = self.sample("scenes/crate.pcd")
        expected = self.recognize(frame)
        self.assertGreater(len(expected["cuboids"]), 0)
        previous = frame
        for name in ("a.pts", "b.ply", "c.pcd", "d.PTS", "e.pcd"):
            target = self.folder / name
            arguments = ["--ascii"] if name == "e.pcd" else []
            result = hoist("convert", previous, target, *arguments)
            self.assertEqual(result.returncode, 0, f"{name}: {result.stderr}")
            found = self.recognize(target)
            self.assertEqual(found["cuboids"], expected["cuboids"], name)
            previous = target

    def test_converting_twice_gives_the_same_bytes(self):
        frame = self.sample("scenes/crate.pcd")
        for name in ("pts", "ply", "pcd"):
            first, second = self.folder / f"1.{name}", self.folder / f"2.{name}"
            self.assertEqual(hoist("convert", frame, first).returncode, 0)
            self.assertEqual(hoist("convert", first, second).returncode, 0)
            self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_sensor_pose_survives(self):
        frame = self.folder / "posed.pcd"
        write_pcd(frame, 160, 120, wall)
        text = frame.read_text().replace("VIEWPOINT 0 0 0 1 0 0 0",
                                         "VIEWPOINT 1 2 3 0 1 0 0")
        frame.write_text(text)
        before = hoist("info", frame).stdout.split("sensor at")[1]
        self.assertIn("1.0000 2.0000 3.0000", before)
        for name in ("a.ply", "a.pcd"):
            target = self.folder / name
            self.assertEqual(hoist("convert", frame, target).returncode, 0)
            self.assertEqual(hoist("info", target).stdout.split("sensor at")[1], before)

    def test_bad_targets(self):
        frame = self.sample("scenes/crate.pcd")
        self.assert_one_line(hoist("convert", frame, self.folder / "a.obj"), 2, ".pcd")
        self.assert_one_line(hoist("convert", frame, self.folder / "a"), 2, ".pcd")
        copy = shutil.copy(frame, self.folder)
        self.assert_one_line(hoist("convert", copy, copy), 2, "same file")
        self.assert_one_line(hoist("convert", frame, self.folder / "no" / "a.pcd"), 1,
                             "a.pcd")
        self.assertEqual([p.name for p in self.folder.iterdir()], ["crate.pcd"])

    def test_failed_conversion_leaves_the_old_file(self):
        bad = self.folder / "bad.pcd"
        bad.write_bytes(b"\0" * 1000)
        target = self.folder / "old.pts"
        target.write_text("old")
        self.assert_one_line(hoist("convert", bad, target), 1, "bad.pcd")
        self.assertEqual(target.read_text(), "old")


@unittest.skipUnless(REAL, "HOIST_REAL_DATA is not set")
class RealFrames(CommandLine):
    """PCD and the PTS that a Bumblebee would have written give the same cuboids."""

    def test_pcd_and_pts_of_one_frame(self):
        scenes = pathlib.Path(REAL) / "mosd" / "scenes"
        with_cuboids = 0
        for name in ("learn0", "learn20", "test20"):
            frame = scenes / f"{name}.pcd"
            self.assertTrue(frame.is_file(), frame)
            pts = self.folder / f"{name}.pts"
            self.assertEqual(hoist("convert", frame, pts).returncode, 0)
            columns = pts.read_text().split("\n", 1)[0].split()
            self.assertEqual(len(columns), 8)  # x y z R G B row col
            for mode in ("full", "paper"):
                from_pcd = self.recognize(frame, "--mode", mode)
                from_pts = self.recognize(pts, "--mode", mode)
                self.assertEqual(from_pcd["cuboids"], from_pts["cuboids"], name)
                with_cuboids += len(from_pcd["cuboids"]) > 0
        self.assertGreater(with_cuboids, 2)  # nothing found everywhere proves nothing


if __name__ == "__main__":
    unittest.main()
