#!/usr/bin/python3
"""Accuracy and time of hoist beside PCL-only pipelines, as one Markdown table.

    peers.py PROGRAM SCENES TRUTH --evaluator evaluate.py [--rounds 5] [--out DIR]

PROGRAM is the built bench_peers, SCENES a folder of organized clouds, TRUTH a folder
with <scene>.json for each. The evaluator is run as `evaluate.py TRUTH RESULTS --json
FILE` and scores cuboids by 3D IoU. Every frame goes through every pipeline in turns in
one process; milliseconds are processor time without reading, per frame the median of
the rounds, in the table the median and the 99th percentile over the frames.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

NAMES = {
    "tutorial": "PCL tutorials' way: plane removal, Euclidean clusters, inertia OBB",
    "multi_plane": "PCL integral normals + OrganizedMultiPlaneSegmentation → boxes",
    "ransac": "PCL clusters + sequential RANSAC planes → boxes",
    "hoist": "hoist, full mode",
    "hoist_lines": "hoist, full mode, with its line segments and vertices",
}


def percentile(values, share):
    """The smallest value that at least this share of the values does not exceed."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)]


def scores(evaluator, truth, results, report):
    subprocess.run(
        [sys.executable, evaluator, truth, results, "--json", report],
        check=True, stdout=subprocess.DEVNULL)
    with open(report, encoding="utf-8") as stream:
        return json.load(stream)["results"]["overall"]


def median(errors, key, digits):
    """An error's median; a dash where no box was right."""
    return "–" if errors.get(key) is None else f"{errors[key]['median']:.{digits}f}"


def row(name, score, times):
    half, strict = score["iou0.50"], score["iou0.75"]
    every, errors = half["all"], score["tp_errors"]
    cells = [
        NAMES.get(name, name),
        f"{every['f1']:.3f}",
        f"{strict['all']['f1']:.3f}",
        f"{half['ap']:.3f}",
        f"{every['precision']:.2f} / {every['recall']:.2f}",
        f"{median(errors, 'centre_mm', 1)} / {median(errors, 'size_mm', 1)} / "
        f"{median(errors, 'rotation_deg', 1)}°",
        f"{statistics.median(times):.1f}",
        f"{percentile(times, 0.99):.1f}",
    ]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("scenes")
    parser.add_argument("truth")
    parser.add_argument("--evaluator", required=True)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", help="keeps the boxes of every pipeline here")
    args = parser.parse_args()

    for path in (args.program, args.scenes, args.truth, args.evaluator):
        if not os.path.exists(path):
            parser.error(f"{path}: there is no such file or folder")
    files = sorted(
        os.path.join(args.scenes, name)
        for name in os.listdir(args.scenes) if name.lower().endswith(".pcd"))
    if not files:
        parser.error(f"no .pcd files in {args.scenes}")
    with tempfile.TemporaryDirectory() as temporary:
        out = args.out or temporary
        # one core, whatever the libraries under it would do
        environment = dict(os.environ, OMP_NUM_THREADS="1")
        subprocess.run(
            [args.program, out, *files, "--rounds", str(args.rounds)],
            check=True, env=environment)
        with open(os.path.join(out, "times.json"), encoding="utf-8") as stream:
            times = json.load(stream)
        print("| pipeline | F1@0.5 | F1@0.75 | AP@0.5 | P / R @0.5 "
              "| centre mm / size mm / rotation, median | ms, median | ms, p99 |")
        print("|---|---|---|---|---|---|---|---|")
        for name in [n for n in NAMES if n in times]:
            score = scores(args.evaluator, args.truth, os.path.join(out, name),
                           os.path.join(temporary, name + ".report.json"))
            print(row(name, score, list(times[name].values())))


if __name__ == "__main__":
    main()
