#!/usr/bin/env python3
"""Errors of hoist's cuboids against distance, occlusion, tilt and noise, beside the
Cramer-Rao floor of every thing in its frame. Tables go to stdout, curves into a picture.

usage: crane_report.py PLOT.png NAME=TRUTH,EVALUATION[,NOISE] ...
       crane_report.py --check

TRUTH is a folder that `hoist simulate` wrote, EVALUATION what `hoist evaluate --json`
wrote of it, NOISE the factor on the sensor's noise (default 1). Runs of one NAME are one
suite: that of noise 1 goes against distance, occlusion and tilt, all against noise.
--check prints the floor of a box of 0.4 x 0.3 x 0.3 m for a Kinect at 1, 2 and 3 m.
Needs NumPy and OpenCV's Python module.
"""
import json
import pathlib
import sys

import cv2
import numpy as np

# Neighbouring pixels err alike: so many of them count as one. Edges in the image are
# placed to this sigma [px]: half a pixel of blur.
CORRELATED, LATERAL = 50.0, 0.5
LEAST = 8  # things in a bin, for its figures to be printed


def sigma_z(truth, z, noise):
    """Standard deviation of a depth [m], by the sensor's model."""
    if truth["sensor"] == "stereo":
        return noise * 0.2 * z**2 / (truth["intrinsics"]["fx"] * truth["baseline"])
    if truth["sensor"] == "kinect":
        return noise * (0.0012 + 0.0019 * (z - 0.4)**2)
    return noise * (0.003 + 0.0002 * z**2)


def edges_of_box():
    """Axis, and the two faces (axis, sign) that meet there, of the twelve edges."""
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sign_a in (-1, 1):
            for sign_b in (-1, 1):
                yield axis, (a, sign_a), (b, sign_b)


def visible_part(thing, truth, labels):
    """Points on the faces that are seen, by (axis, sign): N x 3, camera frame."""
    camera = truth["intrinsics"]
    v, u = np.nonzero(labels == thing["label"])
    rays = np.stack([(u - camera["cx"]) / camera["fx"], (v - camera["cy"]) / camera["fy"],
                     np.ones(u.size)], axis=1)
    turn, half = np.array(thing["rotation"]), np.array(thing["size"]) / 2
    way, start = rays @ turn, -np.array(thing["center"]) @ turn
    with np.errstate(divide="ignore", invalid="ignore"):
        enter = (-np.sign(way) * half - start) / way
    axis = np.argmax(enter, axis=1)
    depth = np.take_along_axis(enter, axis[:, None], axis=1)[:, 0]
    sign = -np.sign(np.take_along_axis(way, axis[:, None], axis=1)[:, 0])
    inside = (np.abs(start + depth[:, None] * way) < half + 0.02).all(axis=1)
    faces = {}
    for k in range(3):
        for s in (-1, 1):
            chosen = inside & (axis == k) & (sign == s)
            if chosen.sum() >= 10:
                faces[k, s] = rays[chosen] * depth[chosen][:, None]
    return faces


def edge_points(thing, truth, labels, axis, first, second):
    """Points on an edge, a pixel apart, where the image shows the thing beside it."""
    camera = truth["intrinsics"]
    turn, half = np.array(thing["rotation"]), np.array(thing["size"]) / 2
    local = np.zeros(3)
    local[first[0]], local[second[0]] = first[1] * half[first[0]], second[1] * half[second[0]]
    ends = []
    for end in (-1, 1):
        local[axis] = end * half[axis]
        ends.append(turn @ local + thing["center"])
    if min(end[2] for end in ends) < 0.05:
        return np.zeros((0, 3))
    project = np.array([[camera["fx"] * e[0] / e[2], camera["fy"] * e[1] / e[2]] for e in ends])
    count = max(2, int(np.linalg.norm(project[1] - project[0])))
    share = (np.arange(count) + 0.5)[:, None] / count
    points = ends[0] + share * (ends[1] - ends[0])
    u = np.rint(camera["fx"] * points[:, 0] / points[:, 2] + camera["cx"]).astype(int)
    v = np.rint(camera["fy"] * points[:, 1] / points[:, 2] + camera["cy"]).astype(int)
    seen = np.zeros(count, bool)
    rows, columns = labels.shape
    for dv in (-1, 0, 1):
        for du in (-1, 0, 1):
            x, y = u + du, v + dv
            good = (x >= 0) & (y >= 0) & (x < columns) & (y < rows)
            seen[good] |= labels[y[good], x[good]] == thing["label"]
    return points[seen]


def information(thing, faces, edges, truth, noise):
    """Fisher information of centre, rotation vector and sides, 9 x 9."""
    turn, center = np.array(thing["rotation"]), np.array(thing["center"])
    total = np.zeros((9, 9))
    for (k, sign), points in faces.items():
        # a depth tells where the face is along its normal
        normal = sign * turn[:, k]
        rays = points / points[:, 2:]
        rows = np.zeros((len(points), 9))
        rows[:, :3] = normal
        rows[:, 3:6] = np.cross(points - center, normal)
        rows[:, 6 + k] = 0.5
        rows /= (rays @ normal)[:, None]
        rows /= sigma_z(truth, points[:, 2], noise)[:, None]
        total += rows.T @ rows / CORRELATED
    for axis, first, second, points in edges:
        # an edge pixel tells where the edge is, across it and across the view
        across = np.cross(turn[:, axis], points)
        across /= np.linalg.norm(across, axis=1)[:, None]
        rows = np.zeros((len(points), 9))
        rows[:, :3] = across
        rows[:, 3:6] = np.cross(points - center, across)
        for k, sign in (first, second):
            rows[:, 6 + k] = 0.5 * sign * (across @ turn[:, k])
        rows /= (LATERAL * points[:, 2] / truth["intrinsics"]["fx"])[:, None]
        total += rows.T @ rows / CORRELATED
    return total


def floor_of(thing, truth, labels, noise):
    """Least 1 sigma: centre (root of the summed variances) [m], a side (root of their
    mean) [m], rotation [rad]; NaN where the frame does not determine the box."""
    faces = visible_part(thing, truth, labels)
    edges = []
    for axis, first, second in edges_of_box():
        if first in faces or second in faces:
            points = edge_points(thing, truth, labels, axis, first, second)
            if len(points):
                edges.append((axis, first, second, points))
    fisher = information(thing, faces, edges, truth, max(noise, 0.05))
    if np.linalg.eigvalsh(fisher)[0] < 1 / 0.5**2:  # something is only known to 0.5 m
        return np.full(3, np.nan)
    variance = np.diag(np.linalg.inv(fisher))
    return np.sqrt([variance[:3].sum(), variance[6:].mean(), variance[3:6].sum()])


def tilt_of(thing):
    """Angle between the view and the normal of the face seen best [degrees]."""
    way = np.array(thing["center"]) / np.linalg.norm(thing["center"])
    return np.degrees(np.arccos(np.abs(way @ np.array(thing["rotation"])).max()))


def read_run(folder, evaluation, noise):
    """The rows of all things that count, and the run's F1."""
    with open(evaluation, encoding="utf-8") as file:
        figures = json.load(file)
    rows = []
    for scene in figures["details"]:
        base = pathlib.Path(folder) / scene["scene"]
        with open(f"{base}.json", encoding="utf-8") as file:
            truth = json.load(file)
        labels = cv2.imread(f"{base}.instances.png", cv2.IMREAD_UNCHANGED)
        hits = {p["label"]: p for p in scene["predictions"] if p["verdict"] == "hit"}
        for thing in truth["cuboids"]:
            if thing["difficult"]:
                continue
            row = {"distance": float(np.linalg.norm(thing["center"])),
                   "visible": thing["visible_fraction"], "tilt": tilt_of(thing),
                   "hit": thing["label"] in hits,
                   "floor": floor_of(thing, truth, labels, noise)}
            if row["hit"]:
                hit = hits[thing["label"]]
                row["error"] = np.array([np.linalg.norm(hit["center"]),
                                         np.median(np.abs(hit["size"])), hit["rotation"]])
            rows.append(row)
    return rows, figures


def summary(rows):
    """Count, recall, median errors of the hits, median floors of the same things; in mm,
    mm and degrees."""
    hits = [row for row in rows if row["hit"]]
    unit = np.array([1000, 1000, np.degrees(1)])
    empty = np.full(3, np.nan)
    errors = np.median([row["error"] for row in hits], axis=0) * unit if hits else empty
    floors = [row["floor"] for row in hits if np.isfinite(row["floor"]).all()]
    floors = np.median(floors, axis=0) * unit if floors else empty
    return len(rows), len(hits) / max(1, len(rows)), errors, floors


def binned(rows, key, limits):
    for low, high in zip(limits[:-1], limits[1:]):
        inside = [row for row in rows if low <= row[key] < high]
        if len(inside) >= LEAST:
            yield (low, high), summary(inside)


QUANTITIES = (
    ("distance", "distance [m]", (2, 3, 4, 5, 6, 7, 8, 10, 12, 16)),
    ("visible", "visible fraction", (0.4, 0.6, 0.8, 0.95, 1.001)),
    ("tilt", "tilt [degrees]", (0, 15, 25, 35, 45, 55)),
)
HEAD = ("| things | recall | centre [mm] (floor) | side [mm] (floor) "
        "| rotation [degrees] (floor) |")


def line(name, figures):
    count, recall, errors, floors = figures
    cells = [f"{e:.1f} ({f:.1f})" for e, f in zip(errors[:2], floors[:2])]
    cells.append(f"{errors[2]:.2f} ({floors[2]:.2f})")
    return f"| {name} | {count} | {recall:.2f} | " + " | ".join(cells) + " |"


class Panel:
    """One diagram of the picture: curves over a common x, errors on a logarithmic y."""

    WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 360, 250, 48, 36, 22

    def __init__(self, image, column, row, title, x_range, y_range, logarithmic):
        self.image, self.corner = image, (column * self.WIDTH, row * self.HEIGHT)
        self.x, self.y, self.logarithmic = x_range, y_range, logarithmic
        self.text(title, (self.LEFT, 14), 0.44)
        ticks = ([t for t in (0.01, 0.1, 1, 10, 100, 1000) if y_range[0] <= t <= y_range[1]]
                 if logarithmic else np.arange(0, 1.01, 0.25))
        for y in ticks:
            cv2.line(image, self.at(x_range[0], y), self.at(x_range[1], y), (225,) * 3, 1)
            self.text(f"{y:g}", (4, self.at(x_range[0], y)[1] - self.corner[1] + 4), 0.36)
        for x in np.linspace(*x_range, 5):
            cv2.line(image, self.at(x, y_range[0]), self.at(x, y_range[1]), (225,) * 3, 1)
            self.text(f"{x:.3g}", (self.at(x, y_range[0])[0] - self.corner[0] - 10,
                                   self.HEIGHT - self.BOTTOM + 16), 0.36)

    def text(self, text, place, size, color=(0, 0, 0)):
        cv2.putText(self.image, text, (self.corner[0] + place[0], self.corner[1] + place[1]),
                    cv2.FONT_HERSHEY_SIMPLEX, size, color, 1, cv2.LINE_AA)

    def at(self, x, y):
        low, high = self.y
        share = ((np.log(max(y, low)) - np.log(low)) / (np.log(high) - np.log(low))
                 if self.logarithmic else (y - low) / (high - low))
        across = (x - self.x[0]) / (self.x[1] - self.x[0])
        return (int(self.corner[0] + self.LEFT + across * (self.WIDTH - self.LEFT - 16)),
                int(self.corner[1] + self.HEIGHT - self.BOTTOM -
                    np.clip(share, 0, 1) * (self.HEIGHT - self.BOTTOM - self.TOP)))

    def curve(self, points, color, dashed):
        points = [self.at(x, y) for x, y in points if np.isfinite(y)]
        for a, b in zip(points[:-1], points[1:]):
            if not dashed:
                cv2.line(self.image, a, b, color, 2, cv2.LINE_AA)
                continue
            steps = max(2, int(np.hypot(b[0] - a[0], b[1] - a[1]) / 5))
            ways = [np.add(a, np.subtract(b, a) * t / steps).astype(int)
                    for t in range(steps + 1)]
            for k in range(0, steps, 2):
                cv2.line(self.image, tuple(map(int, ways[k])), tuple(map(int, ways[k + 1])),
                         color, 1, cv2.LINE_AA)
        for point in points:
            cv2.circle(self.image, point, 2 if dashed else 3, color, -1, cv2.LINE_AA)


COLORS = ((178, 114, 0), (0, 94, 213), (115, 158, 0))
MEASURES = ((None, "recall (noise: F1)", (0, 1)), (0, "centre [mm]", (0.3, 300)),
            (1, "side [mm]", (0.3, 300)), (2, "rotation [degrees]", (0.01, 30)))


def draw(path, columns, names):
    """columns: title, x range and, per name, a list of (x, recall or F1, errors, floors)."""
    image = np.full((4 * Panel.HEIGHT + 24, len(columns) * Panel.WIDTH, 3), 255, np.uint8)
    for c, (title, x_range, curves) in enumerate(columns):
        for r, (index, label, y_range) in enumerate(MEASURES):
            panel = Panel(image, c, r, f"{label} against {title}", x_range, y_range,
                          index is not None)
            for k, name in enumerate(names):
                color, points = COLORS[k], curves.get(name, [])
                if index is None:
                    panel.curve([(x, share) for x, share, _, _ in points], color, False)
                    continue
                panel.curve([(x, errors[index]) for x, _, errors, _ in points], color, False)
                panel.curve([(x, floors[index]) for x, _, _, floors in points], color, True)
    for k, name in enumerate(names):
        cv2.putText(image, f"{name}: median of the hits (dashed: Cramer-Rao floor)",
                    (48 + 560 * k, image.shape[0] - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.46,
                    COLORS[k], 1, cv2.LINE_AA)
    cv2.imwrite(path, image, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def check():
    for z in (1.0, 2.0, 3.0):
        turn = cv2.Rodrigues(np.array([0.5, 0.0, 0.0]))[0] @ cv2.Rodrigues(
            np.array([0.0, 0.7, 0.0]))[0]
        thing = {"label": 1, "center": [0, 0, z], "size": [0.4, 0.3, 0.3],
                 "rotation": turn.tolist()}
        truth = {"sensor": "kinect",
                 "intrinsics": {"fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5}}
        corners = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
        corners = corners * [0.2, 0.15, 0.15] @ turn.T + [0, 0, z]
        pixels = np.rint(525 * corners[:, :2] / corners[:, 2:] + [319.5, 239.5])
        labels = np.zeros((480, 640), np.uint16)
        cv2.fillConvexPoly(labels, cv2.convexHull(pixels.astype(np.int32)), 1)
        center, side, rotation = floor_of(thing, truth, labels, 1) * [1000, 1000, 57.2958]
        print(f"{z:.0f} m: side {side:.1f} mm, centre {center:.1f} mm, {rotation:.2f} degrees")


def main():
    if sys.argv[1:] == ["--check"]:
        check()
        return
    if len(sys.argv) < 3 or not all("=" in run for run in sys.argv[2:]):
        sys.exit(__doc__)
    runs = {}
    for run in sys.argv[2:]:
        name, parts = run.split("=", 1)
        folder, evaluation, *noise = parts.split(",")
        factor = float(noise[0]) if noise else 1.0
        runs.setdefault(name, {})[factor] = read_run(folder, evaluation, factor)
    columns = []
    for key, title, limits in QUANTITIES:
        curves = {}
        for name, by_noise in runs.items():
            print(f"\n{name}, by {title}\n\n| {title} {HEAD}\n|---|---|---|---|---|---|")
            points = curves.setdefault(name, [])
            for (low, high), figures in binned(by_noise[1.0][0], key, limits):
                print(line(f"{low:g} to {min(high, 1) if key == 'visible' else high:g}",
                           figures))
                points.append(((low + high) / 2, *figures[1:]))
        columns.append((title, (limits[0], limits[-1]), curves))
    curves = {}
    print(f"\nby the factor on the noise\n\n| suite | F1 {HEAD}\n|---|---|---|---|---|---|---|")
    for name, by_noise in runs.items():
        for factor, (rows, figures) in sorted(by_noise.items()):
            f1 = figures["overall"]["levels"][0]["f1"]
            print(line(f"{name}, x {factor:g} | {f1:.2f}", summary(rows)))
            curves.setdefault(name, []).append((factor, f1, *summary(rows)[2:]))
    most = max(max(by_noise) for by_noise in runs.values())
    columns.append(("noise (factor)", (0, max(most, 2)), curves))
    draw(sys.argv[1], columns, list(runs))


if __name__ == "__main__":
    main()
