"""hoist_viewer without a display: how it is called, and the pictures it makes then."""

import json
import re
import shutil
import unittest

from viewer_support import (ASIDE, SAMPLES, SIZE, VIEWS, Base, Camera, Picture, edges,
                            recognized, run_viewer)


class Usage(Base):
    def test_help(self):
        result = run_viewer("--help")
        self.assertEqual(result.returncode, 0, result.stderr)
        for word in ("--screenshot", "--camera", "--config", "F7", "Exit codes", "n, space"):
            self.assertIn(word, result.stdout)

    def test_no_display_is_one_line_and_2(self):
        for display, word in ((None, "DISPLAY is not set"), (":7654", ":7654")):
            result = run_viewer(self.scene(), display=display)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn(word, result.stderr)
            self.assertIn("--screenshot", result.stderr)

    def test_wrong_use_is_one_line_and_2(self):
        broken = self.folder / "broken.yaml"
        broken.write_text("no-such-setting: 3\n", encoding="ascii")
        empty = self.folder / "empty"
        empty.mkdir()
        for arguments, word in (
                ([self.scene(), "--colour"], "--colour"),
                ([self.folder / "missing.pcd"], "missing.pcd"),
                ([empty], "empty"),
                ([self.scene(), "--frames", "2"], "--screenshot"),
                ([self.scene(), "--size", "9"], "9"),
                ([self.scene(), "--layers", "clouds"], "clouds"),
                ([self.scene(), "--config", broken], "no-such-setting")):
            result = run_viewer(*arguments)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn(word, result.stderr)


class Headless(Base):
    """Pictures without any display."""

    def screenshot(self, *arguments, code=0):
        path = self.folder / "shot.png"
        result = run_viewer(*arguments, "--screenshot", path, "--size",
                            f"{SIZE[0]}x{SIZE[1]}")
        self.assertEqual(result.returncode, code, result.stderr)
        return Picture.of_png(path) if path.exists() else None

    def test_wireframes_are_where_the_projection_says(self):
        picture = self.screenshot(self.scene(), "--camera", self.camera_file(),
                                  "--layers", "cuboids")
        self.assertEqual((picture.width, picture.height), SIZE)
        letters = sum(max(picture.pixel(x, y)) > 100 for y in range(SIZE[1] // 2)
                      for x in range(VIEWS, SIZE[0]))
        self.assertGreater(letters, 500, "no legend")
        result = recognized(self.scene())
        self.assertGreater(self.share_of_wireframe(picture, result, Camera(ASIDE)), 0.85)
        # and nowhere else: without the layer nothing has these colours there
        without = self.screenshot(self.scene(), "--camera", self.camera_file(),
                                  "--layers", "cloud")
        self.assertLess(self.share_of_wireframe(without, result, Camera(ASIDE)), 0.1)

    def test_world_frame(self):
        """With a sensor pose in the file the view is in the world, as pcl_viewer's."""
        data = self.scene().read_bytes()
        moved = self.folder / "moved.pcd"
        # half a turn about the sensor's z, one metre along x
        data = re.sub(rb"VIEWPOINT [^\n]*", b"VIEWPOINT 1 0 0 0 0 0 1", data, count=1)
        moved.write_bytes(data)
        numbers = [[float(n) for n in part.split(",")] for part in ASIDE.split("/")]
        for i in (1, 2):
            numbers[i] = [1 - numbers[i][0], -numbers[i][1], numbers[i][2]]
        numbers[3] = [-numbers[3][0], -numbers[3][1], numbers[3][2]]
        camera = self.folder / "world.cam"
        camera.write_text("/".join(",".join(map(repr, part)) for part in numbers) + "\n",
                          encoding="ascii")
        picture = self.screenshot(moved, "--camera", camera, "--layers", "cuboids")
        result = recognized(moved)
        # seen from the same place relative to the sensor, it is the same picture
        self.assertGreater(self.share_of_wireframe(picture, result, Camera(ASIDE)), 0.85)

    def test_truth_beside(self):
        picture = self.screenshot(self.scene(), "--camera", self.camera_file(),
                                  "--layers", "truth")
        truth = json.loads((SAMPLES / "truth" / "blocks.json").read_text())
        share = self.share_of_wireframe(picture, truth, Camera(ASIDE), (255, 255, 255))
        self.assertGreater(share, 0.85)

    def test_detector_boxes(self):
        boxes = self.folder / "boxes.json"
        boxes.write_text('[{"box": [100, 60, 80, 50], "class": "block", "score": 0.9}]')
        picture = self.screenshot(self.scene(), "--layers", "detections", "--detections",
                                  boxes)
        scale = min(VIEWS / 2 / 320, SIZE[1] / 240)
        for u, v in ((140, 60), (140, 110), (100, 85), (180, 85)):
            x = VIEWS / 4 + (u - 0.5 - 159.5) * scale
            y = SIZE[1] / 2 + (v - 0.5 - 119.5) * scale
            self.assertTrue(picture.near(x, y, (120, 220, 90), tolerance=60), (u, v))

    def test_several_files_and_a_bad_one(self):
        clouds = self.folder / "clouds"
        clouds.mkdir()
        shutil.copy(self.scene(), clouds / "a.pcd")
        (clouds / "b.pcd").write_bytes(b"no cloud at all\n")
        shutil.copy(self.scene("slab"), clouds / "c.pcd")
        result = run_viewer(clouds, "--screenshot", self.folder / "x.png", "--frames", "9",
                            "--size", "400x300")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("b.pcd", result.stderr)
        self.assertEqual(sorted(path.name for path in self.folder.glob("*.png")),
                         ["x-1.png", "x-2.png", "x-3.png"])

    def test_junk_is_told_in_one_line_and_shown(self):
        junk = self.folder / "junk.pcd"
        for data in (b"", b"no cloud at all\n", bytes(3000)):
            junk.write_bytes(data)
            result = run_viewer(junk, "--screenshot", self.folder / "x.png", "--size",
                                "400x300")
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn("junk.pcd", result.stderr)
            picture = Picture.of_png(self.folder / "x.png")
            self.assertTrue(any(picture.near(x, 150, (255, 160, 120), 5, 60)
                                for x in range(0, 140, 4)), "no reason in the picture")

    def test_unwritable_and_bad_camera(self):
        result = run_viewer(self.scene(), "--screenshot", self.folder / "no" / "x.png")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("no/x.png", result.stderr)
        bad = self.folder / "bad.cam"
        bad.write_text("0,1/2\n", encoding="ascii")
        result = run_viewer(self.scene(), "--screenshot", self.folder / "x.png",
                            "--camera", bad)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("bad.cam", result.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
