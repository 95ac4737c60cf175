"""Every layer of hoist_viewer, switched by its key: what changes on the screen lies where
the projection says, and nowhere else. The ways to colour the cloud likewise."""

import json
import math
import re
import shutil
import struct
import unittest

from viewer_support import (ASIDE, FONT, LIMIT, PALETTE, SAMPLES, SIZE, SPACE, VIEWS,
                            Camera, OnDisplay, along, edges, hidden_edges, recognized)

BOTTOM = SIZE[1] - 2 * (FONT * 7 // 4)  # below stand words
AREA = (0, 0, VIEWS, BOTTOM)
# as the legend shows them, in RGB
COLORS = {"F2": (90, 200, 200), "F3": (255, 110, 60), "F4": (220, 110, 255),
          "F5": (255, 235, 70), "F6": (255, 255, 255), "F10": (150, 150, 170),
          "F11": (120, 220, 90), "F12": (255, 255, 255)}
SCALE = min(VIEWS / 2 / 320, SIZE[1] / 240)  # of the image of 320 x 240 in its view


class Mask:
    """Pixels of the window."""

    def __init__(self):
        self.rows = [bytearray(SIZE[0]) for _ in range(SIZE[1])]

    def stamp(self, x, y, reach_x, reach_y=None):
        reach_y = reach_x if reach_y is None else reach_y
        left, right = max(0, round(x - reach_x)), min(SIZE[0], round(x + reach_x) + 1)
        for row in self.rows[max(0, round(y - reach_y)):max(0, round(y + reach_y) + 1)]:
            row[left:right] = b"\1" * max(0, right - left)

    def __contains__(self, at):
        return bool(self.rows[at[1]][at[0]])


class Layer:
    """What a layer is to change: places that it must colour (None: change at all), and
    the only places where it may change anything."""

    def __init__(self):
        self.must, self.may = [], Mask()

    def point(self, x, y, color, reach):
        inside = 4 < x < VIEWS - 4 and 4 < y < BOTTOM - 4
        if inside and abs(x - SPACE[0]) > 4:
            self.must.append((x, y, color))
        self.may.stamp(x, y, reach)


def in_image(u, v):
    return (VIEWS / 4 + (u - 159.5) * SCALE - 0.5, SIZE[1] / 2 + (v - 119.5) * SCALE - 0.5)


def read_points():
    """Of the sample in PTS: x y z of every pixel, None where nothing was measured."""
    points = {}
    for line in (SAMPLES / "scenes" / "blocks.pts").read_text().splitlines():
        words = line.split()
        if len(words) == 8:
            xyz = [float(word) for word in words[:3]]
            points[int(words[7]), int(words[6])] = xyz if xyz[2] > 0 else None
    return points


class Layers(OnDisplay):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = SAMPLES / "scenes" / "blocks.pcd"
        cls.result = recognized(cls.file)
        cls.points = read_points()

    def project(self, point):
        return self.camera.project(point, SPACE)

    def pixel_of(self, point):
        """Column and row at which the sensor sees a point."""
        k = self.result["intrinsics"]
        return (k["fx"] * point[0] / point[2] + k["cx"],
                k["fy"] * point[1] / point[2] + k["cy"])

    def start(self, camera, *arguments):
        """A viewer that shows nothing at all, and what that looks like."""
        file = self.folder / "start.cam"
        file.write_text(camera, encoding="ascii")
        self.camera = Camera(camera)
        self.program = self.viewer(self.file, "--camera", file, "--layers", "cuboids",
                                   *arguments)

        def bright(picture):
            return any(max(picture.rows[y][:3 * VIEWS]) > 60 for y in range(BOTTOM))

        self.program.wait_until(bright, "no cuboids are shown")
        self.program.key("d")  # no sizes: lines only
        self.program.key("F7")
        self.program.wait_until(lambda picture: not bright(picture),
                                "something is shown without any layer")
        return self.program.picture()

    def switch(self, key, layer, empty, share=0.85, tolerance=40, reach=2, other=0.02):
        """Presses a layer's key, looks whether it shows what it must and no more, and
        presses it again."""
        self.assertGreater(len(layer.must), 20, key)
        seen = {}

        def shown(picture):
            hits = 0
            for x, y, color in layer.must:
                if color is not None:
                    hits += picture.near(x, y, color, reach, tolerance)
                else:
                    hits += (picture.pixel(round(x), round(y)) !=
                             empty.pixel(round(x), round(y)))
            changes = list(picture.changed(empty, AREA))
            outside = sum(at not in layer.may for at in changes)
            seen.update(hits=hits, changes=len(changes), outside=outside)
            return hits >= share * len(layer.must) and outside <= other * len(changes)

        self.program.key(key)
        try:
            self.program.wait_until(shown, key)
        except AssertionError:
            self.fail(f"{key}: {seen} of {len(layer.must)}")
        self.program.key(key)
        self.program.wait_until(
            lambda picture: next(picture.changed(empty, AREA), None) is None,
            f"{key} does not hide all of it")

    def frame_pixels(self, picture, empty, color):
        """Pixels of the frame that the image shows in a colour."""
        return [(u, v) for v in range(240) for u in range(320)
                if in_image(u, v)[1] < BOTTOM - 4
                and picture.near(*in_image(u, v), color, 0, 25)
                and picture.pixel(*map(round, in_image(u, v))) !=
                empty.pixel(*map(round, in_image(u, v)))]

    # the layers

    def test_cloud(self):
        empty = self.start(ASIDE)
        layer = Layer()
        for v in range(240):
            for u in range(320):
                layer.may.stamp(*in_image(u, v), 2)
                point = self.points.get((u, v))
                if point:
                    layer.point(*self.project(point), None, 3)
        self.switch("F1", layer, empty)

    def test_edge_pixels_by_kind(self):
        empty = self.start(ASIDE)
        for key in ("F2", "F3", "F4"):
            self.program.key(key)
            self.program.wait_until(
                lambda picture, color=COLORS[key]: any(
                    picture.near(x, y, color, 0, 25) for y in range(0, BOTTOM)
                    for x in range(int(VIEWS / 2))), f"{key} shows nothing")
            picture = self.settled(empty)
            pixels = self.frame_pixels(picture, empty, COLORS[key])
            self.program.key(key)
            self.program.wait_until(
                lambda picture: next(picture.changed(empty, AREA), None) is None,
                f"{key} does not hide all of it")
            layer = Layer()
            steps = 0
            for u, v in pixels:
                layer.point(*in_image(u, v), COLORS[key], 2)
                point = self.points.get((u, v))
                if point:
                    layer.point(*self.project(point), COLORS[key], 4)
                around = [self.points.get((u + a, v + b))
                          for a in (-2, -1, 0, 1, 2) for b in (-2, -1, 0, 1, 2)]
                depths = [p[2] for p in around if p]
                steps += None in around or max(depths) > 1.02 * min(depths)
            self.switch(key, layer, empty)
            if key == "F3":  # occlusions are where the depth jumps or ends
                self.assertGreater(steps, 0.95 * len(pixels))

    def settled(self, empty):
        """The screen once nothing changes any more, and something is shown."""
        before = self.program.picture()
        for _ in range(20 * LIMIT):
            now = self.program.picture()
            same = next(now.changed(before, AREA), None) is None
            if same and next(now.changed(empty, AREA), None) is not None:
                return now
            before = now
        self.fail("the picture never rests")
        return None

    def test_segments_and_vertices(self):
        """Seen from the sensor, space and image must agree."""
        k = self.result["intrinsics"]
        angle = 2 * math.atan(SIZE[1] / 2 / (k["fy"] * SCALE))
        empty = self.start(f"0.1,9/0,0,1/0,0,0/0,-1,0/{angle!r}/1200,600/0,0\n")

        def in_space(u, v):  # with a square pixel and the image's own scale
            return (SPACE[0] + SPACE[1] / 2 + (u - k["cx"]) * SCALE - 0.5,
                    SIZE[1] / 2 + (v - k["cy"]) * SCALE - 0.5)

        # half the line's width, or what a vertex of eight segments has beyond its ring,
        # and a pixel or two for the line in space, which is fitted to all its support
        for key, reach in (("F5", 5), ("F6", 8)):
            self.program.key(key)
            self.program.wait_until(
                lambda picture, color=COLORS[key]: any(
                    picture.near(x, y, color, 0, 25) for y in range(0, BOTTOM)
                    for x in range(int(VIEWS / 2))), f"{key} shows nothing")
            picture = self.settled(empty)
            pixels = self.frame_pixels(picture, empty, COLORS[key])
            self.program.key(key)
            self.program.wait_until(
                lambda picture: next(picture.changed(empty, AREA), None) is None,
                f"{key} does not hide all of it")
            layer = Layer()
            for u, v in pixels:
                layer.point(*in_image(u, v), COLORS[key], 4)
                layer.point(*in_space(u, v), COLORS[key], reach)
            # a segment without depth at one end has no line in space
            self.switch(key, layer, empty, share=0.8, reach=reach)

    def test_cuboids(self):
        empty = self.start(ASIDE)
        layer = Layer()
        for number, cuboid in enumerate(self.result["cuboids"]):
            for edge, hidden in zip(edges(cuboid),
                                    hidden_edges(cuboid, self.camera.position)):
                for point in along(edge, 60):
                    layer.may.stamp(*self.project(point), 4)
                    layer.may.stamp(*in_image(*self.pixel_of(point)), 5)
                for point in [] if hidden else along(edge):
                    layer.point(*self.project(point), PALETTE[number], 4)
            for edge, hidden in zip(edges(cuboid), hidden_edges(cuboid, [0, 0, 0])):
                for point in [] if hidden else along(edge):
                    layer.point(*in_image(*self.pixel_of(point)), PALETTE[number], 5)
        self.switch("F7", layer, empty)

    def test_hidden_edges_are_dashed(self):
        self.start(ASIDE)
        self.program.key("F7")

        def share(picture, hidden):
            return self.share_of_wireframe(picture, self.result, self.camera,
                                           hidden=hidden, reach=1)

        self.program.wait_until(lambda picture: share(picture, False) > 0.85
                                and 0.3 < share(picture, True) < 0.85,
                                "hidden edges are not dashed")

    def test_observed_faces(self):
        empty = self.start(ASIDE)
        layer = Layer()
        for cuboid in self.result["cuboids"]:
            center, size, axes = (cuboid[key] for key in ("center", "size", "rotation"))
            for face, observed in enumerate(cuboid["observed_faces"]):
                if not observed:
                    continue
                out, sign = face // 2, 1 if face % 2 == 0 else -1
                a, b = (out + 1) % 3, (out + 2) % 3
                for i in range(41):
                    for j in range(41):
                        offset = [0, 0, 0]
                        offset[out] = sign * (size[out] / 2 + 0.002)
                        offset[a] = (i / 40 - 0.5) * size[a]
                        offset[b] = (j / 40 - 0.5) * size[b]
                        point = [center[k] + sum(axes[k][n] * offset[n] for n in range(3))
                                 for k in range(3)]
                        inside = 0 < i < 40 and 0 < j < 40 and i % 4 == j % 4 == 0
                        for at in (self.project(point), in_image(*self.pixel_of(point))):
                            layer.may.stamp(*at, 5)
                            if inside:
                                layer.point(*at, None, 5)
        self.switch("F8", layer, empty)

    def test_uncertainty(self):
        """Ellipsoids of thirty sigma about the centres, in space only."""
        empty = self.start(ASIDE)
        layer = Layer()
        for cuboid in self.result["cuboids"]:
            for i in range(-10, 11):
                for j in range(-10, 11):
                    for k in range(-10, 11):
                        radius = math.sqrt(i * i + j * j + k * k) / 10
                        if radius > 1:
                            continue
                        point = [c + 30 * s * n / 10 for c, s, n in
                                 zip(cuboid["center"], cuboid["center_sigma"], (i, j, k))]
                        layer.may.stamp(*self.project(point), 3)
                        if radius < 0.9:
                            layer.point(*self.project(point), None, 3)
        self.switch("F9", layer, empty)

    def test_rejected_boxes_and_why(self):
        empty = self.start(ASIDE)
        self.program.key("F10")
        cards = []
        while True:  # until it begins again with the first cuboid
            since = len(self.program.lines)
            self.program.key("k")
            self.program.wait_for(r"^(trust|points) ", since)
            card = "\n".join(self.program.lines[since:])
            if cards and card.startswith("#1 "):
                break
            cards.append(card)
        n = len(self.result["cuboids"])
        self.assertEqual([card.startswith("#") for card in cards],
                         [i < n for i in range(len(cards))])
        self.assertLessEqual(len(cards) - n, 25)
        boxes = []
        for text in cards[n:]:
            numbers = {word: [float(x) for x in re.findall(r"-?\d+\.\d+", line)]
                       for word, line in re.findall(r"^(size|centre|turn) +(.*)$", text,
                                                    re.M)}
            reason = re.search(r"not reported:\n +(.*)", text)[1]
            boxes.append((numbers["centre"], [0.01 * s for s in numbers["size"]],
                          rotation(*numbers["turn"]), reason))
        self.assertGreater(len(boxes), 0)
        # the reasons are those that the recognition counts
        counted = json.dumps(self.result["rejected"])
        for box in boxes:
            self.assertIn(box[3], counted)
        self.program.key("Escape")
        self.program.key("F10")
        self.program.wait_until(
            lambda picture: next(picture.changed(empty, AREA), None) is None,
            "F10 does not hide all of it")
        layer, labels, named = Layer(), [], []
        for center, size, axes, reason in boxes:
            box = {"center": center, "size": size, "rotation": axes}
            for edge in edges(box):
                for point in along(edge, 80):
                    # sizes of whole millimetres and turns of three digits are off by as
                    # much as three pixels at the corners of a large box
                    layer.may.stamp(*in_image(*self.pixel_of(point)), 5)
                    layer.point(*self.project(point), COLORS["F10"], 5)
            if reason not in named:  # once stands why, in rows 0, 1, -1, 2, ...
                x, y = self.project(center)
                n = len(named)
                y -= 18 * (-n // 2 if n % 2 == 0 else (n + 1) // 2)
                labels.append((x, y))
                named.append(reason)
                layer.may.stamp(x, y, 5 * len(reason), 10)
        self.switch("F10", layer, empty, tolerance=70, reach=4)
        self.program.key("F10")
        shade = tuple(0.35 * c for c in COLORS["F10"])
        inside = [at for at in labels if SPACE[0] < at[0] < VIEWS and 0 < at[1] < BOTTOM]
        self.assertGreater(len(inside), 0)
        self.program.wait_until(
            lambda picture: sum(picture.near(*at, shade, 6, 12) and
                                picture.near(*at, (255, 255, 255), 8, 90)
                                for at in inside) > 0.6 * len(inside),
            "no reason can be read")

    def test_detector_boxes(self):
        boxes = self.folder / "boxes.json"
        left, top, width, height = 100, 60, 80, 50
        boxes.write_text(json.dumps([{"box": [left, top, width, height]}]))
        empty = self.start(ASIDE, "--detections", boxes)
        depths = sorted(point[2] for (u, v), point in self.points.items()
                        if point and left <= u < left + width and top <= v < top + height)
        z = depths[len(depths) // 2]
        k = self.result["intrinsics"]
        layer = Layer()
        for step in range(101):
            for u, v in ((left + width * step / 100, top),
                         (left + width * step / 100, top + height),
                         (left, top + height * step / 100),
                         (left + width, top + height * step / 100)):
                u, v = u - 0.5, v - 0.5  # between the pixels
                layer.point(*in_image(u, v), COLORS["F11"], 4)
                layer.point(*self.project([(u - k["cx"]) / k["fx"] * z,
                                           (v - k["cy"]) / k["fy"] * z, z]),
                            COLORS["F11"], 4)
        self.switch("F11", layer, empty, tolerance=60)

    def test_ground_truth(self):
        empty = self.start(ASIDE)
        truth = json.loads((SAMPLES / "truth" / "blocks.json").read_text())
        layer = Layer()
        for cuboid in truth["cuboids"]:
            for edge in edges(cuboid):
                for point in along(edge, 80):
                    layer.point(*self.project(point), COLORS["F12"], 4)
                    layer.may.stamp(*in_image(*self.pixel_of(point)), 5)
        self.switch("F12", layer, empty, tolerance=90)


def rotation(w, x, y, z):
    """Of a unit quaternion, a list of rows."""
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


class Colours(OnDisplay):
    """The keys 1 to 9."""

    def colors_in_space(self, picture):
        return {picture.pixel(x, y) for y in range(60, BOTTOM - 60, 2)
                for x in range(int(SPACE[0]) + 60, VIEWS - 60, 2)}

    def test_by_object(self):
        viewer = self.viewer(self.scene(), "--layers", "cloud")
        viewer.key("ctrl+s", answer="saved")
        camera = Camera(self.out("hoist_viewer.cam").read_text())
        viewer.key("6")
        for number, cuboid in enumerate(recognized(self.scene())["cuboids"]):
            x, y = camera.project(cuboid["center"], SPACE)
            viewer.wait_until(lambda picture, at=(x, y), color=PALETTE[number]:
                              picture.near(*at, color, 2, 4), "no colour of the object")

    def test_one_colour_and_coordinates(self):
        viewer = self.viewer(self.scene(), "--layers", "cloud")
        background = (10, 10, 13)
        viewer.key("1")
        viewer.wait_until(
            lambda picture: self.colors_in_space(picture) <= {background, (200, 200, 200)},
            "1 is not one colour")
        seen = []
        for key in ("2", "3", "4", "5"):
            viewer.key(key)
            viewer.wait_until(
                lambda picture: len(self.colors_in_space(picture)) > 20
                and all(self.colors_in_space(picture) != other for other in seen),
                f"{key} shows nothing new")
            seen.append(self.colors_in_space(viewer.picture()))

    def test_fields_of_the_file(self):
        """Keys 7 and on, in the order of the file; they stay when stepping."""
        folder = self.folder / "clouds"
        folder.mkdir()
        width, height, half = 64, 48, 32
        points = []
        for v in range(height):
            for u in range(width):
                z = 1 + 0.001 * u
                points.append((z * (u - 31.5) / 60, z * (v - 23.5) / 60, z,
                               float(u >= half), 1 + 2 * (u >= half)))
        header = ("VERSION 0.7\nFIELDS x y z curvature label\nSIZE 4 4 4 4 4\n"
                  f"TYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH {width}\nHEIGHT {height}\n"
                  f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {width * height}\nDATA binary\n")
        data = header.encode() + b"".join(struct.pack("<ffffI", *p) for p in points)
        for name in ("a.pcd", "b.pcd"):
            (folder / name).write_bytes(data)
        shutil.copy(self.scene(), folder / "c.pcd")  # without such fields
        viewer = self.viewer(folder, "--layers", "cloud")
        background = (10, 10, 13)

        def halves(left, right):
            def check(picture):
                y = SIZE[1] // 2
                quarter = SPACE[1] / 4
                return (picture.near(SPACE[0] + quarter, y, left, 3, 6)
                        and picture.near(SPACE[0] + 3 * quarter, y, right, 3, 6))
            return check

        viewer.key("8")  # labels 1 and 3: the first and the third colour
        viewer.wait_until(halves(PALETTE[0], PALETTE[2]), "labels have no colours")
        viewer.key("n", answer=r"^\[2/3\]")
        viewer.wait_until(halves(PALETTE[0], PALETTE[2]), "the labels' colours are gone")
        viewer.key("7")
        viewer.wait_until(lambda picture: len(self.colors_in_space(picture) -
                                              {background}) == 2,
                          "the curvature has no two colours")
        viewer.key("n", answer=r"^\[3/3\]")
        viewer.wait_until(lambda picture: len(self.colors_in_space(picture)) > 50,
                          "a file without the field is not shown in its colours")
        viewer.key("q")
        self.assertEqual(viewer.ends(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
