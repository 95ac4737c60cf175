#!/usr/bin/env python3
"""Compares the simulated Kinect's noise with real frames: residuals of planes against
distance, and how wide the holes beside jumps of depth are.

usage: kinect_noise.py HOIST REAL_FOLDER SIMULATED_FOLDER PLOT.png

HOIST is the program, which turns every PCD into text; the folders hold organized
640x480 PCD files. Needs numpy and OpenCV's Python module.
"""
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

WIDTH, HEIGHT = 640, 480
WINDOW = 15  # [px]: small enough to lie on one face
BINS = np.arange(0.6, 2.01, 0.1)  # [m]


def read_depth(hoist, path, folder):
    """z of an organized frame as a HEIGHT x WIDTH array, NaN for holes; None if the
    frame has no grid."""
    text = pathlib.Path(folder) / "frame.pcd"
    subprocess.run([hoist, "convert", str(path), str(text), "--ascii"], check=True)
    with open(text, encoding="ascii") as lines:
        for line in lines:
            words = line.split()
            if words[0] == "FIELDS":
                column = words.index("z") - 1
            if words[0] == "DATA":
                break
        z = np.array([float(line.split(maxsplit=column + 2)[column]) for line in lines])
    return z.reshape(HEIGHT, WIDTH) if z.size == WIDTH * HEIGHT else None


def plane_residuals(depth):
    """(distance, standard deviation) of windows that are planes: 1/z is linear there."""
    v, u = np.mgrid[0:WINDOW, 0:WINDOW]
    design = np.stack([u.ravel(), v.ravel(), np.ones(WINDOW * WINDOW)], axis=1)
    project = design @ np.linalg.pinv(design)
    found = []
    for top in range(0, HEIGHT - WINDOW, WINDOW):
        for left in range(0, WIDTH - WINDOW, WINDOW):
            z = depth[top:top + WINDOW, left:left + WINDOW].ravel()
            if not np.isfinite(z).all():
                continue
            residual = (1 / z - project @ (1 / z)) * z * z
            # a crease or a curve leaves a residual that changes slowly: its halves agree
            grid = residual.reshape(WINDOW, WINDOW)
            blocks = [grid[:7, :7], grid[:7, 8:], grid[8:, :7], grid[8:, 8:]]
            sigma = residual.std() * np.sqrt(residual.size / (residual.size - 3))
            if max(abs(block.mean()) for block in blocks) < 0.5 * sigma:
                found.append((z.mean(), sigma))
    return found


def gap_widths(depth):
    """Widths of holes [px] at jumps of more than 5 %, from far to near and from near to
    far, going right along rows; 0 where the jump has no hole."""
    to_near, to_far = [], []
    for row in depth:
        columns = np.flatnonzero(np.isfinite(row))
        gap = np.diff(columns) - 1
        z = row[columns]
        step = np.diff(z) / z[:-1]
        near = gap <= 40  # wider ones are no edge's
        to_near.extend(gap[near & (step < -0.05)])
        to_far.extend(gap[near & (step > 0.05)])
    return to_near, to_far


def measure(hoist, folder):
    residuals, to_near, to_far = [], [], []
    paths = sorted(pathlib.Path(folder).glob("*.pcd"))
    with tempfile.TemporaryDirectory() as scratch:
        for path in paths:
            depth = read_depth(hoist, path, scratch)
            if depth is None:
                continue
            residuals.extend(plane_residuals(depth))
            for list_, found in zip((to_near, to_far), gap_widths(depth)):
                list_.extend(found)
    distance, sigma = np.array(residuals).T
    medians = []
    for low, high in zip(BINS[:-1], BINS[1:]):
        inside = sigma[(distance >= low) & (distance < high)]
        medians.append(np.median(inside) if inside.size >= 30 else np.nan)
    return np.array(medians), np.array(to_near), np.array(to_far), len(paths)


def draw(curves, path):
    """Curves of mm against metres: name, colour (BGR), values at the bins' middles."""
    width, height, left, bottom = 720, 420, 70, 50
    top_value = 1.15 * np.nanmax([np.nanmax(values) for _, _, values in curves]) * 1000
    image = np.full((height, width, 3), 255, np.uint8)
    font = cv2.FONT_HERSHEY_SIMPLEX

    def at(x, y):
        return (int(left + (x - BINS[0]) / (BINS[-1] - BINS[0]) * (width - left - 20)),
                int(height - bottom - y / top_value * (height - bottom - 20)))

    for x in BINS[::2]:
        cv2.line(image, at(x, 0), at(x, top_value), (230, 230, 230), 1)
        cv2.putText(image, f"{x:.1f}", (at(x, 0)[0] - 12, height - bottom + 18), font, 0.42,
                    (0, 0, 0), 1, cv2.LINE_AA)
    for y in np.arange(0, top_value, 1):
        cv2.line(image, at(BINS[0], y), at(BINS[-1], y), (230, 230, 230), 1)
        cv2.putText(image, f"{y:.0f}", (left - 24, at(0, y)[1] + 4), font, 0.42, (0, 0, 0), 1,
                    cv2.LINE_AA)
    cv2.putText(image, "distance [m]", (width // 2 - 40, height - 12), font, 0.5, (0, 0, 0), 1,
                cv2.LINE_AA)
    cv2.putText(image, "sigma [mm]", (6, 14), font, 0.45, (0, 0, 0), 1, cv2.LINE_AA)
    middles = (BINS[:-1] + BINS[1:]) / 2
    for i, (name, color, values) in enumerate(curves):
        points = [at(x, y * 1000) for x, y in zip(middles, values) if np.isfinite(y)]
        for a, b in zip(points[:-1], points[1:]):
            cv2.line(image, a, b, color, 2, cv2.LINE_AA)
        for point in points:
            cv2.circle(image, point, 3, color, -1, cv2.LINE_AA)
        cv2.putText(image, name, (left + 20, 40 + 20 * i), font, 0.5, color, 1, cv2.LINE_AA)
    cv2.imwrite(path, image)


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    hoist, real, simulated, plot = sys.argv[1:]
    results = {name: measure(hoist, folder)
               for name, folder in (("real", real), ("simulated", simulated))}
    middles = (BINS[:-1] + BINS[1:]) / 2
    model = 0.0012 + 0.0019 * (middles - 0.4) ** 2
    print("distance  model  real  simulated   [m, mm, mm, mm]")
    for x, m, r, s in zip(middles, model, results["real"][0], results["simulated"][0]):
        print(f"{x:8.2f} {m * 1000:6.2f} {r * 1000:5.2f} {s * 1000:6.2f}")
    for name, (_, to_near, to_far, frames) in results.items():
        for edge, gaps in (("far to near", to_near), ("near to far", to_far)):
            print(f"{name} ({frames} frames), {edge}: {gaps.size} jumps, "
                  f"{np.mean(gaps > 0):.0%} with a hole, mean {gaps.mean():.1f} px, "
                  f"median {np.median(gaps):.0f} px")
    draw([("model (Nguyen 2012)", (150, 150, 150), model),
          ("real, mOSD", (40, 40, 200), results["real"][0]),
          ("simulated, table-kinect", (200, 90, 20), results["simulated"][0])], plot)


if __name__ == "__main__":
    main()
