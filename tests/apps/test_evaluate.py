"""hoist evaluate and hoist coco, as a user types them.

Run by ctest with the program and the folder of the sample scenes in the environment. The
reference script is evaluate.py, in the folder tools beside that of HOIST_REAL_DATA; it
needs numpy.
"""

import json
import math
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM = os.environ["HOIST_PROGRAM"]
SAMPLES = pathlib.Path(os.environ["HOIST_SAMPLES"])
REAL = os.environ.get("HOIST_REAL_DATA")
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def hoist(*arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
    )


def strict_json(text):
    def refuse(constant):
        raise ValueError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def box(x, **more):
    return {"center": [x, 0, 2], "size": [1, 1, 1], "rotation": IDENTITY, **more}


def frame(*boxes, **more):
    return {"cuboids": list(boxes), **more}


class Evaluate(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-evaluate-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.truth = self.folder / "truth"
        self.found = self.folder / "found"

    def write(self, path, content):
        path = self.folder / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def figures(self, *arguments):
        result = hoist("evaluate", "--json", "-", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return strict_json(result.stdout), result.stderr

    def assert_one_line(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)


class Usage(Evaluate):
    def test_help_names_every_option_and_the_exit_codes(self):
        result = hoist("evaluate", "--help")
        self.assertEqual(result.returncode, 0)
        for word in ("TRUTH", "RESULTS", "--of", "--iou", "--min-score", "--ignore-iou",
                     "--ignore-share", "--color-tolerance", "--json", "--plots",
                     "--list", "Exit codes"):
            self.assertIn(word, result.stdout)
        for line in result.stdout.splitlines():
            self.assertLessEqual(len(line), 92, line)

    def test_what_is_missing_or_does_not_fit_is_exit_2(self):
        truth = self.write("truth/a.json", frame(box(0)))
        found = self.write("found/b.json", frame(box(0)))
        self.assert_one_line(hoist("evaluate"), 2, "TRUTH")
        self.assert_one_line(hoist("evaluate", self.truth), 2, "RESULTS")
        self.assert_one_line(hoist("evaluate", self.truth, self.folder / "no"), 2,
                             str(self.folder / "no"))
        self.assert_one_line(hoist("evaluate", self.folder / "no", self.found), 2,
                             str(self.folder / "no"))
        self.assert_one_line(hoist("evaluate", self.truth, self.found), 2,
                             "no results in", "(a)")
        self.write("empty/readme.txt", "nothing")
        self.assert_one_line(hoist("evaluate", self.folder / "empty", self.found), 2,
                             "no annotation in", "empty")
        self.write("truth/c.json", frame(box(0)))
        self.assert_one_line(hoist("evaluate", self.truth, found), 2, "named b",
                             str(found))
        for words in (["--iou", "0"], ["--iou", "0.5,x"], ["--iou", "1.5"],
                      ["--of", "boxes"], ["--min-score", "nan"], ["--unknown"],
                      ["--color-tolerance", "-1"]):
            self.assert_one_line(hoist("evaluate", truth, truth, *words), 2, words[0])

    def test_broken_files_are_exit_1_with_place_and_reason(self):
        self.write("truth/a.json", frame(box(0)))
        whole = json.dumps(frame(box(0)))
        for text, words in ((whole[:-5], ["byte", "not JSON"]), ("", ["byte"]),
                            ("3", ["an object, found 3"]),
                            ('{"cuboids": {}}', ["cuboids", "an array"])):
            self.write("found/a.json", text)
            self.assert_one_line(hoist("evaluate", self.truth, self.found), 1,
                                 "found/a.json", *words)
        self.write("found/a.json", whole)
        for text, words in ((whole[:40], ["byte"]),
                            (json.dumps(frame({**box(0), "size": [1, 2]})),
                             ["cuboids[0].size", "three numbers"])):
            self.write("truth/a.json", text)
            self.assert_one_line(hoist("evaluate", self.truth, self.found), 1,
                                 "truth/a.json", *words)

    def test_places_that_cannot_be_written_are_exit_1(self):
        truth = self.write("truth/a.json", frame(box(0)))
        for option in ("--json", "--plots"):
            result = hoist("evaluate", truth, truth, option, truth / "x")
            self.assertEqual(result.returncode, 1)
            self.assertIn(str(truth), result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1)

    def test_iou_list_may_stand_before_the_files(self):
        truth = self.write("truth/a.json", frame(box(0)))
        figures, _ = self.figures("--iou", "0.25,0.9", truth, truth)
        self.assertEqual([level["iou"] for level in figures["overall"]["levels"]],
                         [0.25, 0.9])


class Figures(Evaluate):
    def test_truth_against_itself_is_perfect(self):
        figures, notes = self.figures(SAMPLES / "truth", SAMPLES / "truth")
        self.assertEqual(notes, "")
        self.assertEqual(figures["scenes"], 6)
        for level in figures["overall"]["levels"]:
            self.assertEqual((level["wrong"], level["missed"]), (0, 0))
            self.assertEqual((level["f1"], level["ap"]), (1, 1))
        self.assertLess(figures["overall"]["errors"]["center"]["max"], 1e-9)
        self.assertLess(figures["overall"]["errors"]["rotation"]["max"], 1e-9)
        color = figures["overall"]["attributes"]["color"]
        self.assertEqual(color["right"], color["truths"])

    def test_what_hoist_recognizes_in_the_samples(self):
        result = hoist("recognize", "--quiet", SAMPLES / "scenes" / "blocks.pcd",
                       SAMPLES / "scenes" / "crate.pcd", "-o", self.found, "--formats",
                       "json")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = hoist("evaluate", SAMPLES / "truth", self.found, "--list", "--plots",
                       self.folder / "plots")
        self.assertEqual(result.returncode, 0, result.stderr)
        # four scenes were not tried: one note, and they count as not found
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("4 scenes without results", result.stderr)
        for word in ("precision", "centre [mm]", "By distance", "sigma", "missed",
                     "cartons"):
            self.assertIn(word, result.stdout)
        for name in ("precision_recall", "errors", "distance", "scores", "sigmas",
                     "visible_fraction", "faces_visible"):
            data = (self.folder / "plots" / f"{name}.png").read_bytes()
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n", name)
            width, height = struct.unpack(">II", data[16:24])
            self.assertGreaterEqual(width, 500)
            self.assertGreaterEqual(height, 300)
        # one result alone is compared with its own annotation alone
        figures, notes = self.figures(SAMPLES / "truth", self.found / "blocks.json")
        self.assertEqual((figures["scenes"], notes), (1, ""))
        # and so is an array of all, by name
        result = hoist("recognize", "--quiet", SAMPLES / "scenes" / "blocks.pcd",
                       SAMPLES / "scenes" / "crate.pcd", "--json",
                       self.folder / "all.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        many, notes = self.figures(SAMPLES / "truth", self.folder / "all.json")
        again, _ = self.figures(SAMPLES / "truth", self.found)
        self.assertEqual(many, again)
        self.assertIn("4 scenes without results", notes)

    def test_json_has_no_surprises(self):
        self.write("truth/a.json", frame(box(0, label=3), box(3, difficult=True),
                                         box(6)))
        self.write("found/a.json", frame(box(0.1, score=0.9), box(3, score=0.8),
                                         box(9, score=0.3)))
        figures, _ = self.figures(self.truth, self.found)
        overall = figures["overall"]
        self.assertEqual((overall["truths"], overall["difficult"],
                          overall["predictions"]), (2, 1, 3))
        level = overall["levels"][0]
        self.assertEqual((level["hits"], level["wrong"], level["missed"],
                          level["ignored"]), (1, 1, 1, 1))
        self.assertAlmostEqual(level["ap"], 6 / 11)
        self.assertAlmostEqual(overall["errors"]["center"]["median"], 0.1)
        detail = figures["details"][0]
        self.assertEqual(detail["scene"], "a")
        self.assertEqual([p["verdict"] for p in detail["predictions"]],
                         ["hit", "ignored", "wrong"])
        self.assertEqual(detail["predictions"][0]["label"], 3)
        self.assertAlmostEqual(detail["predictions"][0]["iou"], 0.9 / 1.1)
        self.assertEqual(detail["missed"], [{"truth": 2}])
        path = self.folder / "figures.json"
        result = hoist("evaluate", self.truth, self.found, "--json", path)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(strict_json(path.read_text()), figures)
        self.assertIn("Found at a 3D IoU", result.stdout)

    def test_folders_in_folders(self):
        for visit in (1, 2):
            self.write(f"truth/visit{visit}/0.json", frame(box(visit)))
            self.write(f"found/visit{visit}/0.json", frame(box(visit)))
        figures, _ = self.figures(self.truth, self.found)
        self.assertEqual(figures["overall"]["levels"][0]["hits"], 2)
        # flat results of scenes that share a name cannot be told apart
        flat = self.write("flat/0.json", frame(box(1)))
        self.assert_one_line(hoist("evaluate", self.truth, flat.parent), 2, "named 0")
        # names that are unique may lie anywhere, with what a batch keeps of them
        self.write("one/x/y/s1.json", frame(box(1)))
        for ending in ("pcd", "pts", "ply", "xyz", "asc"):
            with self.subTest(ending=ending):
                self.write(f"other-{ending}/deep/s1.{ending}.json", frame(box(1)))
                figures, _ = self.figures(
                    self.folder / "one", self.folder / f"other-{ending}")
                self.assertEqual(figures["overall"]["levels"][0]["hits"], 1)

    def test_files_that_are_no_annotations_or_results_are_told(self):
        self.write("truth/a.json", frame(box(0)))
        self.write("truth/camera.json", {"fx": 1})
        self.write("found/a.json", frame(box(0), box(3, size=[1, 1, 0])))
        self.write("found/z.json", frame(box(0)))
        figures, notes = self.figures(self.truth, self.found)
        self.assertEqual(notes.count("\n"), 3)
        for word in ("camera.json", "cuboids[1].size", "1 result without annotation",
                     "z"):
            self.assertIn(word, notes)
        self.assertEqual(figures["overall"]["predictions"], 1)

    def test_cuboids_objects_and_all(self):
        self.write("truth/a.json", {"cuboids": [box(0)],
                                    "objects": [box(3, **{"class": "bucket"})]})
        self.write("found/a.json", {"cuboids": [box(0), box(3)],
                                    "objects": [box(3, **{"class": "bucket"})]})
        for of, hits, wrong in (("cuboids", 1, 1), ("objects", 1, 0), ("all", 2, 1)):
            figures, _ = self.figures(self.truth, self.found, "--of", of)
            level = figures["overall"]["levels"][0]
            self.assertEqual((level["hits"], level["wrong"]), (hits, wrong), of)

    def test_scores_below_the_least_are_left_out(self):
        self.write("truth/a.json", frame(box(0)))
        self.write("found/a.json", frame(box(0, score=0.5), box(3, score=0.49)))
        figures, _ = self.figures(self.truth, self.found, "--min-score", "0.5")
        self.assertEqual(figures["overall"]["levels"][0]["wrong"], 0)

    def test_nothing_found_and_nothing_to_find(self):
        self.write("truth/a.json", frame())
        self.write("found/a.json", frame())
        result = hoist("evaluate", self.truth, self.found, "--list", "--plots",
                       self.folder / "plots")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("nan", result.stdout)
        figures, _ = self.figures(self.truth, self.found)
        self.assertIsNone(figures["overall"]["levels"][0]["ap"])


def reference():
    """Command of the reference script, or why there is none."""
    if not REAL:
        return None, "HOIST_REAL_DATA is not set"
    script = pathlib.Path(REAL).resolve().parent / "tools" / "evaluate.py"
    if not script.is_file():
        return None, f"no {script}"
    for python in (sys.executable, "/usr/bin/python3", "python3"):
        try:
            if subprocess.run([python, "-c", "import numpy"], capture_output=True,
                              check=False).returncode == 0:
                return [python, str(script)], ""
        except OSError:
            pass
    return None, "the reference script needs numpy"


class Compared(Evaluate):
    """Figures side by side with those of the reference script."""

    def compare(self, truth, found):
        command, reason = reference()
        if command is None:
            self.skipTest(reason)
        path = self.folder / "reference.json"
        result = subprocess.run([*command, str(truth), str(found), "--json", str(path)],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        expected = json.loads(path.read_text())
        figures, _ = self.figures(truth, found)
        self.assert_close(figures["overall"], expected["results"]["overall"])
        for detail in figures["details"]:
            self.assert_same_scene(detail, expected["scenes"][detail["scene"]])
        return figures

    def assert_close(self, ours, theirs):
        def near(a, b):
            self.assertEqual(a is None, b is None)
            if a is not None:
                self.assertLess(abs(a - b), 1e-6 * max(1, abs(b)), (a, b))

        self.assertEqual(ours["truths"], theirs["gt"])
        self.assertEqual(ours["difficult"], theirs["gt_difficult"])
        self.assertEqual(ours["predictions"], theirs["predictions"])
        for level in ours["levels"]:
            other = theirs["iou%.2f" % level["iou"]]
            self.assertEqual(level["ignored"], other["ignored"])
            near(level["ap"], other["ap"])
            for mine, name in ((level, "all"), (level["best"], "best_f1")):
                self.assertEqual((mine["hits"], mine["wrong"], mine["missed"]),
                                 tuple(other[name][k] for k in ("tp", "fp", "fn")))
                for key in ("precision", "recall", "f1"):
                    near(mine[key], other[name][key])
            near(level["best"]["score"], other["best_f1"]["score_threshold"])
        errors, others = ours["errors"], theirs["tp_errors"]
        self.assertEqual(errors["n"], others["n"])
        for key, other, scale in (("iou", "iou", 1), ("center", "centre_mm", 1e3),
                                  ("size", "size_mm", 1e3),
                                  ("rotation", "rotation_deg", 180 / math.pi)):
            for q in ("median", "p90"):
                near(scale * errors[key][q], others[other][q])
        for rank in ("largest", "middle", "smallest"):
            near(1e3 * errors["size_" + rank]["median"],
                 others["size_by_gt_rank_mm"][rank]["median"])

    def assert_same_scene(self, ours, theirs):
        self.assertEqual(len(ours["predictions"]), len(theirs["matches"]))
        for mine, other in zip(ours["predictions"], theirs["matches"]):
            kind = {"hit": "tp", "wrong": "fp", "ignored": "ignored"}[mine["verdict"]]
            self.assertEqual(kind, other["kind"])
            self.assertEqual(mine["score"], other["score"])
            self.assertEqual(mine.get("label"), other["label"])
            self.assertLess(abs(mine.get("iou", mine["best_iou"]) - other["iou"]), 1e-6)
        self.assertEqual([m["label"] for m in ours["missed"]], theirs["missed"])


def turned(rng, angle):
    """A rotation by the angle about a random axis."""
    axis = [rng.gauss(0, 1) for _ in range(3)]
    length = math.sqrt(sum(a * a for a in axis))
    x, y, z = (a / length for a in axis)
    c, s = math.cos(angle), math.sin(angle)
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)]
            for i in range(3)]


class Reference(Compared):
    def test_random_boxes(self):
        rng = random.Random(1)
        for scene in range(120):
            truths, found = [], []
            for label in range(1, 1 + rng.randrange(5)):
                rotation = turned(rng, rng.uniform(0, 3))
                center = [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(1, 4)]
                size = [rng.uniform(0.1, 0.5) for _ in range(3)]
                truths.append({"label": label, "center": center, "size": size,
                               "rotation": rotation, "difficult": rng.random() < 0.25})
                for _ in range(rng.randrange(3)):
                    order = rng.choice([(0, 1, 2), (1, 2, 0), (2, 0, 1)])
                    other = product(rotation, turned(rng, rng.uniform(0, 0.3)))
                    found.append({
                        "center": [c + rng.gauss(0, 0.02) for c in center],
                        "size": [size[k] * rng.uniform(0.85, 1.2) for k in order],
                        "rotation": [[row[k] for k in order] for row in other],
                        "score": round(rng.random(), 1)})  # many are equal
            if rng.random() < 0.5:
                found.append({"center": [rng.uniform(-1, 1), 0, 2],
                              "size": [0.3, 0.3, 0.3], "rotation": turned(rng, 1)})
            self.write(f"truth/test{scene}.json", frame(*truths))
            if scene != 7:  # a result is missing
                self.write(f"found/test{scene}.json", frame(*found))
        figures = self.compare(self.truth, self.found)
        self.assertGreater(figures["overall"]["levels"][0]["hits"], 50)
        self.assertGreater(figures["overall"]["levels"][0]["ignored"], 10)


class RealScenes(Compared):
    def test_truth_and_results_of_real_scenes(self):
        if not REAL:
            self.skipTest("HOIST_REAL_DATA is not set")
        mosd = pathlib.Path(REAL) / "mosd"
        scenes = sorted((mosd / "scenes").glob("*.pcd"))
        result = hoist("recognize", "--quiet", *scenes, "-o", self.found, "--formats",
                       "json")
        self.assertEqual(result.returncode, 0, result.stderr)
        figures = self.compare(mosd / "gt", self.found)
        self.assertEqual(figures["scenes"], 78)
        self.assertGreater(figures["overall"]["levels"][0]["hits"], 60)


def write_png16(path, rows):
    """A 16-bit grey PNG."""
    height, width = len(rows), len(rows[0])
    raw = b"".join(b"\0" + struct.pack(f">{width}H", *row) for row in rows)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0,
                                                0)) +
                     chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def read_png16(path):
    data, position, packed = path.read_bytes(), 8, b""
    width, height, depth, color = struct.unpack(">IIBB", data[16:26])
    if (depth, color) != (16, 0):
        raise ValueError(f"{path}: no 16-bit grey PNG")
    while position < len(data):
        (length,) = struct.unpack(">I", data[position:position + 4])
        if data[position + 4:position + 8] == b"IDAT":
            packed += data[position + 8:position + 8 + length]
        position += 12 + length
    raw, stride, before, rows = zlib.decompress(packed), 2 * width, None, []
    for v in range(height):
        kind, *line = raw[v * (stride + 1):(v + 1) * (stride + 1)]
        before = before or [0] * stride
        for i in range(stride):
            a = line[i - 2] if i >= 2 else 0
            b = before[i]
            c = before[i - 2] if i >= 2 else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) % 256
        rows.append(struct.unpack(f">{width}H", bytes(line)))
        before = line
    return rows


class Coco(Evaluate):
    """A bucket before a wall, seen level and turned by 30 degrees, outlined exactly."""

    WIDTH, HEIGHT, F = 160, 120, 150.0
    CENTER, SIZE = (0.1, 0.05, 2.0), (0.6, 0.4, 0.5)  # along its axes 0, up, 2

    def setUp(self):
        super().setUp()
        c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
        axes = ((c, 0, s), (0, -1, 0), (s, 0, -c))
        depth, inside = [], []
        for v in range(self.HEIGHT):
            depth.append([])
            for u in range(self.WIDTH):
                z = self.cast(axes, (u - 79.5) / self.F, (v - 59.5) / self.F)
                if z is not None:
                    inside.append((u, v))
                depth[-1].append(round(10000 * (3.0 if z is None else z)))
        self.write_depth = lambda: write_png16(self.folder / "depth/img.png", depth)
        self.write_depth()
        self.inside = set(inside)
        self.truth_box = {"center": list(self.CENTER), "size": list(self.SIZE),
                          "rotation": [[a[i] for a in axes] for i in range(3)]}
        self.coco = {
            "images": [{"id": 1, "file_name": "img.jpg", "width": self.WIDTH,
                        "height": self.HEIGHT},
                       {"id": 2, "file_name": "flat.jpg", "width": 8, "height": 8}],
            "categories": [{"id": 1, "name": "bucket"}],
            "annotations": [{"id": 1, "image_id": 1, "category_id": 1,
                             "segmentation": {"size": [self.HEIGHT, self.WIDTH],
                                              "counts": self.runs()},
                             "material": "plastic", "color": [200, 30, 30],
                             "attributes": {"fullness": True}}]}

    def cast(self, axes, x, y):
        """Depth at which the ray (x, y, 1) meets the box."""
        near, far = 0, math.inf
        for axis, size in zip(axes, self.SIZE):
            speed = axis[0] * x + axis[1] * y + axis[2]
            start = -sum(a * c for a, c in zip(axis, self.CENTER))
            if abs(speed) < 1e-12:
                if abs(start) > size / 2:
                    return None
                continue
            hits = sorted(((-size / 2 - start) / speed, (size / 2 - start) / speed))
            near, far = max(near, hits[0]), min(far, hits[1])
        return near if near < far else None

    def runs(self):
        runs, value, length = [], False, 0
        for u in range(self.WIDTH):
            for v in range(self.HEIGHT):
                if ((u, v) in self.inside) != value:
                    runs.append(length)
                    value, length = not value, 0
                length += 1
        return [*runs, length]

    def convert(self, *arguments, camera=f"{F},{F},79.5,59.5"):
        path = self.write("coco.json", self.coco)
        return hoist("coco", path, self.folder / "depth", "-o", self.found, "--camera",
                     camera, "--depth-scale", "0.0001", *arguments)

    def test_help(self):
        result = hoist("coco", "--help")
        for word in ("ANNOTATIONS", "DEPTH_DIR", "--camera", "--depth-scale", "--up",
                     "--images", "--min-pixels", "Exit codes"):
            self.assertIn(word, result.stdout)

    def test_box_attributes_and_mask(self):
        result = self.convert()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 frame with 1 thing", result.stdout)
        self.assertIn("1 image without depth", result.stdout)
        found = strict_json((self.found / "img.json").read_text())
        self.assertEqual(found["files"]["depth"], "../depth/img.png")
        (thing,) = found["objects"]
        self.assertEqual(thing["visible_pixels"], len(self.inside))
        self.assertEqual(thing["class"], "bucket")
        rows = read_png16(self.found / found["files"]["instances"])
        self.assertEqual({(u, v) for v, row in enumerate(rows)
                          for u, value in enumerate(row) if value == 1}, self.inside)
        # two sides and the height are seen whole, so the box is nearly the true one
        truth = {"objects": [{**self.truth_box, "class": "bucket", "fullness": True,
                              "material": "plastic", "base_rgb": [200, 30, 30]}]}
        path = self.write("truth/img.json", truth)
        figures, _ = self.figures(path, self.found, "--of", "objects", "--iou", "0.8")
        overall = figures["overall"]
        self.assertEqual(overall["levels"][0]["hits"], 1)
        # a pixel is 13 mm there, and one in a hundred points is cut at each end
        self.assertLess(overall["errors"]["size"]["max"], 0.04)
        self.assertLess(overall["errors"]["rotation"]["max"], math.radians(3))
        for attribute in ("color", "material", "fullness"):
            self.assertEqual(overall["attributes"][attribute],
                             {"truths": 1, "said": 1, "right": 1})
        self.assertEqual(figures["mean_ap"], 1)

    def test_without_depth_there_is_no_box(self):
        write_png16(self.folder / "depth/img.png", [[0] * self.WIDTH] * self.HEIGHT)
        result = self.convert()
        self.assertEqual(result.returncode, 0, result.stderr)
        found = strict_json((self.found / "img.json").read_text())
        self.assertEqual(found["objects"], [])
        self.assertEqual(found["other_objects"], [{"label": 1, "kind": "bucket"}])

    def test_what_is_wrong_is_told(self):
        self.assert_one_line(self.convert("--up", "0,0,0"), 2, "--up")
        self.assert_one_line(self.convert(camera="0,1,2,3"), 2, "--camera")
        self.assert_one_line(self.convert(camera="1,2,3"), 2, "--camera")
        write_png16(self.folder / "depth/img.png", [[5] * 8] * 8)
        self.assert_one_line(self.convert(), 1, "img.png", "160 x 120")
        (self.folder / "depth/img.png").write_bytes(b"no picture")
        self.assert_one_line(self.convert(), 1, "img.png", "16 bits")
        self.write_depth()
        self.coco["annotations"][0]["category_id"] = 7
        self.assert_one_line(self.convert(), 1, "coco.json",
                             "annotations[0].category_id")
        os.remove(self.folder / "depth/img.png")
        self.coco["annotations"][0]["category_id"] = 1
        self.assert_one_line(self.convert(), 2, "no image of")


if __name__ == "__main__":
    unittest.main()
