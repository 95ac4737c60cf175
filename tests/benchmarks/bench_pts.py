#!/usr/bin/python3
"""PTS readers side by side: hoist, Open3D, VTK, one core each, taken in turns.

    bench_pts.py PROGRAM [--megabytes 60] [--rounds 5]

PROGRAM is the built bench_pts. Packages: python3-open3d, python3-vtk9; a reader that is
not installed is left out and said so. The file lies in memory (page cache): what is
measured is parsing. VTK and Open3D know no Bumblebee records, so the three are compared
on x y z R G B (with a count line, which Open3D demands) and hoist alone on Bumblebee
ones. Only reading is timed, not the start of the programs; seconds are the process's
processor time, so that other work on the machine counts little.
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile

os.environ["OMP_NUM_THREADS"] = "1"


def timed_child(code, file):
    """Runs one reader in a process of its own on one core; its seconds and points."""
    done = subprocess.run(
        ["taskset", "-c", "0", sys.executable, "-c", code, file],
        capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip().splitlines()[-1:]
    seconds, points = done.stdout.split()[-2:]
    return float(seconds), int(points)


OPEN3D = """
import sys, time
import open3d
open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
start = time.process_time()
cloud = open3d.io.read_point_cloud(sys.argv[1], format="pts")
print(time.process_time() - start, len(cloud.points))
"""

VTK = """
import sys, time
from vtkmodules.vtkIOGeometry import vtkPTSReader
reader = vtkPTSReader()
reader.SetFileName(sys.argv[1])
start = time.process_time()
reader.Update()
print(time.process_time() - start, reader.GetOutput().GetNumberOfPoints())
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--megabytes", type=int, default=60)
    parser.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()

    def hoist(file):
        done = subprocess.run(
            ["taskset", "-c", "0", args.program, "read", file],
            capture_output=True, text=True, check=True)
        seconds, points = done.stdout.split()
        return float(seconds), int(points)

    readers = {
        "hoist": hoist,
        "Open3D": lambda file: timed_child(OPEN3D, file),
        "VTK": lambda file: timed_child(VTK, file),
    }
    with tempfile.TemporaryDirectory() as folder:
        for dialect, names in (("xyzrgb", list(readers)), ("bumblebee", ["hoist"])):
            file = os.path.join(folder, dialect + ".pts")
            subprocess.run(
                [args.program, "make", file, dialect, str(args.megabytes)], check=True)
            if dialect == "xyzrgb":
                with open(file, "rb") as stream:
                    body = stream.read()
                with open(file, "wb") as stream:
                    stream.write(b"%d\n" % body.count(b"\n") + body)
            megabytes = os.path.getsize(file) / 1e6
            times = {name: [] for name in names}
            missing = {}
            for _ in range(args.rounds):
                for name in names:
                    if name in missing:
                        continue
                    seconds, points = readers[name](file)
                    if seconds is None:
                        missing[name] = points
                    else:
                        times[name].append((seconds, points))
            print(f"{dialect}, {megabytes:.0f} MB, median of {args.rounds}")
            base = statistics.median(t for t, _ in times["hoist"])
            for name in names:
                if name in missing:
                    print(f"  {name:8} not measured: {missing[name]}")
                    continue
                median = statistics.median(t for t, _ in times[name])
                print(f"  {name:8} {median:7.3f} s {megabytes / median:7.1f} MB/s "
                      f"{times[name][0][1]:9} points, {median / base:5.1f} x hoist's time")


if __name__ == "__main__":
    main()
