"""hoist ifc, as a user types it. Run by ctest with the program in the
environment.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["HOIST_PROGRAM"]
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


def hoist(*arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
    )


def crate(label, x, **more):
    return {
        "label": label,
        "class": "crate",
        "center": [x, 0, 1],
        "size": [0.6, 0.4, 0.3],
        "rotation": IDENTITY,
        "material": "wood",
        "weight": 12.5,
        "base_rgb": [200, 150, 90],
        **more,
    }


def annotation(*things, removed=(), **more):
    return {
        "format": "hoist annotation",
        "version": 1,
        "scene": "yard-1",
        "sequence": "yard",
        "pose": {"rotation": IDENTITY, "translation": [10, 0, 0]},
        "cuboids": list(things),
        "removed": list(removed),
        **more,
    }


class Ifc(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-ifc-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.model = self.folder / "m.ifc"

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def run_ok(self, *arguments):
        result = hoist("ifc", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def assert_one_line(self, code, arguments, *words):
        result = hoist("ifc", *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def elements(self):
        return json.loads(self.run_ok("info", self.model, "--json"))["elements"]


class Usage(Ifc):
    def test_help_names_every_verb_and_option(self):
        text = self.run_ok("--help")
        for word in ("info", "create", "update", "undo"):
            self.assertIn(word, text)
        text = self.run_ok("update", "--help")
        for word in ("--dry-run", "--move-others", "--storey", "Exit codes"):
            self.assertIn(word, text)

    def test_wrong_words_are_one_line(self):
        self.run_ok("create", "-o", self.model)
        self.assert_one_line(2, ["dance"], "unknown command 'dance'")
        self.assert_one_line(2, ["info", self.model, "--dance"], "unknown option --dance")
        self.assert_one_line(2, ["info", self.folder / "none.ifc"], "none.ifc", "hoist ifc info")
        self.assert_one_line(2, ["create", "-o", self.model], "there already")
        self.assert_one_line(2, ["create", "-o", "x.ifc", "--unit", "yd"], "yd")
        self.assert_one_line(1, ["info", self.write("junk.ifc", "junk")], "junk.ifc:1:")
        truth = self.write("a.json", annotation(crate(1, 0)))
        self.assert_one_line(2, ["update", self.model, truth, "--min-overlap", "nan"], "nan")
        self.assert_one_line(1, ["update", self.model, truth, "--storey", "attic"], "attic")
        nowhere = annotation(crate(1, 0))
        del nowhere["pose"]
        self.assert_one_line(1, ["update", self.model, self.write("n.json", nowhere)], "--camera-frame")

    def test_a_broken_model_is_left_as_it_is(self):
        self.run_ok("create", "-o", self.model)
        cut = self.model.read_bytes()[:-10]
        self.model.write_bytes(cut)
        truth = self.write("a.json", annotation(crate(1, 0)))
        self.assert_one_line(1, ["update", self.model, truth], "END-ISO-10303-21")
        self.assertEqual(self.model.read_bytes(), cut)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a.json", "m.ifc"])


class Update(Ifc):
    def test_from_nothing_to_undone(self):
        first = self.write("1.json", annotation(crate(1, 0), crate(2, 3)))
        self.assertIn("2 added", self.run_ok("create", "-o", self.model, first, "--unit", "mm"))
        created = self.model.read_bytes()
        one, two = self.elements()
        self.assertEqual(one["class"], "IfcBuildingElementProxy")
        self.assertEqual(one["object_type"], "crate")
        for found, expected in zip(one["center"], (10, 0, 1)):
            self.assertAlmostEqual(found, expected, places=4)
        self.assertEqual(one["material"], "wood")
        self.assertEqual(one["weight"], 12.5)
        self.assertEqual(one["properties"]["Hoist_Recognition"]["Status"], "new")
        self.assertEqual(one["properties"]["Hoist_Recognition"]["Frame"], "yard-1")

        # the first moved, the second gone, a third came
        second = self.write(
            "2.json", annotation(crate(1, 0.5), crate(3, 7), removed=[crate(2, 3)])
        )
        dry = self.run_ok("update", self.model, second, "--dry-run")
        self.assertIn("nothing is written", dry)
        self.assertIn("by 0.5 m", dry)
        self.assertRegex(dry, r"(?m)^-#\d+=IFCCARTESIANPOINT")
        self.assertRegex(dry, r"(?m)^\+#\d+=IFCBUILDINGELEMENTPROXY")
        self.assertEqual(self.model.read_bytes(), created)
        self.assertIn("1 added, 1 missing, 1 moved", self.run_ok("update", self.model, second))
        updated = self.model.read_bytes()
        status = [e["properties"]["Hoist_Recognition"]["Status"] for e in self.elements()]
        self.assertEqual(status, ["moved", "missing", "new"])
        self.assertAlmostEqual(self.elements()[0]["center"][0], 10.5, places=4)
        self.assertIn(one["global_id"], self.run_ok("info", self.model))

        self.assertIn("as it was", self.run_ok("update", self.model, second))
        self.assertEqual(self.model.read_bytes(), updated)
        self.assertIn("before the last update", self.run_ok("undo", self.model))
        self.assertEqual(self.model.read_bytes(), created)
        self.assertIn("no update to undo", self.run_ok("undo", self.model))
        self.assertEqual(self.model.read_bytes(), created)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
