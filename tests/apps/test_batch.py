"""hoist batch: what comes out, what is kept, and what no crash can take.

Run by ctest with the program and the folder of the sample scenes in the environment;
HOIST_KILLS says how often the run is killed, HOIST_SANITIZE whether the program is
sanitized.
"""

import csv
import json
import os
import pathlib
import pty
import random
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["HOIST_PROGRAM"]
SAMPLES = pathlib.Path(os.environ["HOIST_SAMPLES"])
KILLS = int(os.environ.get("HOIST_KILLS", "12"))
SANITIZED = bool(os.environ.get("HOIST_SANITIZE"))
MERGED = ["cuboids.csv", "files.csv", "report.html", "summary.sqlite"]


def hoist(*arguments, cwd=None, stdin="", env=None):
    return subprocess.run([PROGRAM, *map(str, arguments)], input=stdin,
                          capture_output=True, text=True, cwd=cwd, timeout=300,
                          env={**os.environ, **(env or {})})


def tree(folder):
    """Every file below a folder, with its bytes."""
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(pathlib.Path(folder).rglob("*")) if path.is_file()}


def smaller(source, target, step):
    """Every step-th pixel of an ascii PCD, in both directions."""
    lines = source.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("DATA")) + 1
    head = dict(line.split(" ", 1) for line in lines[:start] if line[0] != "#")
    width, height = int(head["WIDTH"]), int(head["HEIGHT"])
    rows = [lines[start + v * width + u]
            for v in range(0, height, step) for u in range(0, width, step)]
    head.update(WIDTH=str((width + step - 1) // step),
                HEIGHT=str((height + step - 1) // step), POINTS=str(len(rows)))
    target.write_text("".join(f"{key} {value}\n" for key, value in head.items()) +
                      "\n".join(rows) + "\n")


class TinyFrames:
    """160 x 120 pixels of the sample scenes, made once."""

    folder = None

    @classmethod
    def get(cls):
        if cls.folder is None:
            cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-tiny-"))
            for name, step in (("crate", 2), ("blocks", 2), ("stacked", 4)):
                big = cls.folder / "big.pcd"
                done = hoist("convert", SAMPLES / f"scenes/{name}.pcd", big, "--ascii")
                if done.returncode != 0:
                    raise RuntimeError(done.stderr)
                small = cls.folder / "small.pcd"
                smaller(big, small, step)
                done = hoist("convert", small, cls.folder / f"{name}.pcd")
                if done.returncode != 0:
                    raise RuntimeError(done.stderr)
                big.unlink()
                small.unlink()
        return sorted(cls.folder.glob("*.pcd"))


def tearDownModule():
    if TinyFrames.folder is not None:
        shutil.rmtree(TinyFrames.folder)


def children(pid):
    """Processes whose parent this is."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and int(
                    (entry / "stat").read_text().rsplit(")", 1)[1].split()[1]) == pid:
                found.append(int(entry.name))
        except (OSError, IndexError):
            pass
    return found


def alive(pid):
    try:
        state = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        return state not in "ZX"
    except OSError:
        return False


def at_work(pid):
    """A worker that has started has turned its messages off."""
    try:
        return os.readlink(f"/proc/{pid}/fd/2") == "/dev/null"
    except OSError:
        return False


class BatchTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-batch-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.out = self.folder / "out"

    def frames(self, number, folder="in"):
        """Copies of the tiny frames: <folder>/f000.pcd and so on, some in a subfolder.
        Their times are those of the originals."""
        sources = TinyFrames.get()
        (self.folder / folder / "sub").mkdir(parents=True, exist_ok=True)
        for i in range(number):
            name = f"sub/f{i:03}.pcd" if i % 3 == 2 else f"f{i:03}.pcd"
            shutil.copy2(sources[i % len(sources)], self.folder / folder / name)

    def batch(self, *arguments, code=0, stdin=""):
        result = hoist("batch", *arguments, cwd=self.folder, stdin=stdin)
        self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result

    def record(self, name, out="out"):
        return json.loads((self.folder / out / "results" / f"{name}.json").read_text())

    def assert_one_line(self, result, *words):
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def assert_same(self, found, expected):
        self.assertEqual(sorted(found), sorted(expected))
        for name, data in expected.items():
            self.assertEqual(found[name], data, name)


class Usage(BatchTest):
    def test_help(self):
        result = hoist("batch", "--help")
        self.assertEqual(result.returncode, 0)
        for word in ("--shard", "--memory", "--jobs", "--manifest", "--timeout", "75"):
            self.assertIn(word, result.stdout)
        self.assertNotIn("batch-worker", hoist("--help").stdout)

    def test_bad_values(self):
        self.frames(1)
        for option, *values in (("--shard", "0/3", "4/3", "1", "a/b", "1/", "-1/2"),
                                ("--memory", "4X", "0", "-1G", "G", "nan", "inf", "10M"),
                                ("--jobs", "-1", "x", "1.5"),
                                ("--timeout", "0", "nan", "-3"),
                                ("--formats", "gif"),
                                ("--thumbnail", "-1"),
                                ("--mode", "fast")):
            for value in values:
                with self.subTest(option=option, value=value):
                    result = self.batch("in", "-o", "out", f"{option}={value}", code=2)
                    self.assert_one_line(result)

    def test_inputs_that_are_none(self):
        (self.folder / "empty").mkdir()
        for name in ("empty", "nowhere.pcd", "nothing*.pcd"):
            self.assert_one_line(self.batch(name, "-o", "out", code=2), )
        self.assert_one_line(self.batch("-o", "out", code=2), "INPUT")
        self.assert_one_line(self.batch("-", "-o", "out", code=2), "inputs")
        self.frames(1)
        self.assert_one_line(self.batch("in", code=2), "--out")
        self.assertFalse(self.out.exists())

    def test_output_that_cannot_be(self):
        self.frames(1)
        (self.folder / "file").write_text("mine")
        for out in ("file", "file/out", "/proc/none/out"):
            self.assert_one_line(self.batch("in", "-o", out, code=2), out)
        self.assertEqual((self.folder / "file").read_text(), "mine")


class Results(BatchTest):
    def test_every_kind_of_input_gives_the_same(self):
        self.frames(7)
        (self.folder / "in" / "notes.txt").write_text("not a cloud\n")
        self.batch("in", "-o", "out", "-q")
        expected = tree(self.out)
        names = sorted(name for name in expected if name.startswith("results/"))
        self.assertEqual(len(names), 7)
        self.assertIn("results/in/sub/f002.pcd.json", names)
        self.assertEqual(sorted(set(expected) - set(names)), MERGED)

        files = [str(path.relative_to(self.folder))
                 for path in (self.folder / "in").rglob("*.pcd")]
        random.Random(1).shuffle(files)
        (self.folder / "list").write_text("\n".join(files) + "\r\n\n")
        for i, arguments in enumerate((files, ["in/*.pcd", "in/s?b"], ["in/./f*", "in"],
                                       ["--manifest", "list"], ["-"])):
            stdin = "\0".join(files) if arguments == ["-"] else ""
            self.batch(*arguments, "-o", f"out{i}", "-q", stdin=stdin)
            self.assert_same(tree(self.folder / f"out{i}"), expected)

    def test_results_in_the_folder_of_inputs_are_no_inputs(self):
        self.frames(2)
        self.batch("in", "-o", "in/out", "-q", "--formats", "json,pcd")
        result = self.batch("in", "-o", "in/out", "-q", "--formats", "json,pcd")
        self.assertIn("2 files, 2 of them done before", result.stdout)

    def test_workers_and_shards_do_not_matter(self):
        self.frames(23)
        (self.folder / "in" / "bad.pcd").write_text("VERSION 0.7\nFIELDS x\nnonsense\n")
        self.batch("in", "-o", "out", "-q", "-j", 1, "--formats", "json,png", code=3)
        expected = tree(self.out)
        self.batch("in", "-o", "eight", "-q", "-j", 8, "--formats", "json,png", code=3)
        self.assert_same(tree(self.folder / "eight"), expected)
        codes, done = [], 0
        for k in range(1, 8):
            result = hoist("batch", "in", "-o", "shards", "-q", "-j", 2, "--formats",
                           "json,png", "--shard", f"{k}/7", cwd=self.folder)
            codes.append(result.returncode)
            done += int(result.stdout.split(": ")[1].split()[0])
            self.assertFalse((self.folder / "shards" / "cuboids.csv").exists())
        self.assertEqual(sorted(codes), [0] * 6 + [3])
        self.assertEqual(done, 24)
        self.batch("in", "-o", "shards", "-q", "--merge", "--formats", "json,png", code=3)
        self.assert_same(tree(self.folder / "shards"), expected)

    def test_a_record_is_what_recognize_writes(self):
        frame = SAMPLES / "scenes" / "stacked.pcd"
        formats = "json,csv,ply,png,pcd"
        for command, out in (("recognize", "one"), ("batch", "out")):
            result = hoist(command, frame, "-o", out, "-q", "--formats", formats,
                           cwd=self.folder)
            self.assertEqual(result.returncode, 0, result.stderr)
        base = self.out / "results" / str(frame.resolve())[1:]
        record = json.loads(pathlib.Path(f"{base}.json").read_text())
        for key in ("batch", "thumbnail", "check"):
            record.pop(key)
        one = self.folder / "one"
        self.assertGreater(len(record["cuboids"]), 1)
        self.assertEqual(record, json.loads((one / "stacked.json").read_text()))
        for suffix in (".csv", ".ply", ".png"):
            self.assertEqual(pathlib.Path(f"{base}{suffix}").read_bytes(),
                             (one / f"stacked{suffix}").read_bytes(), suffix)
        self.assertEqual(hoist("info", f"{base}.labels.pcd").stdout.split("\n", 1)[1],
                         hoist("info", one / "stacked_labels.pcd").stdout.split("\n", 1)[1])

    def test_summaries_agree_with_the_records(self):
        self.frames(5)
        (self.folder / "in" / "bad,\"1\".pcd").write_bytes(b"")
        self.batch("in", "-o", "out", "-q", "--material", "steel", code=3)
        records = [json.loads(path.read_text())
                   for path in sorted((self.out / "results").rglob("*.json"))]
        cuboids = [(r["batch"]["path"], c) for r in records for c in r["cuboids"]]
        self.assertGreater(len(cuboids), 3)

        with open(self.out / "files.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sorted(row["path"] for row in rows),
                         sorted(r["batch"]["path"] for r in records))
        for row in rows:
            record = json.loads((self.out / row["record"]).read_text())
            self.assertEqual(row["status"], record["batch"]["status"])
            self.assertEqual(row["reason"], record["batch"].get("reason", ""))
            if row["status"] == "done":
                self.assertEqual(int(row["cuboids"]), len(record["cuboids"]))
        with open(self.out / "cuboids.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sorted((row["scene"], float(row["length"])) for row in rows),
                         sorted((path, c["size"][0]) for path, c in cuboids))

        base = sqlite3.connect(self.out / "summary.sqlite")
        self.addCleanup(base.close)
        self.assertEqual(base.execute("PRAGMA integrity_check").fetchone(), ("ok",))
        found = base.execute("SELECT path, number, score, length, weight FROM cuboids "
                             "JOIN files ON files.id = cuboids.file "
                             "ORDER BY path, number").fetchall()
        expected = sorted((path, r["cuboids"].index(c) + 1, c["score"], c["size"][0],
                           c["features"]["weight"])
                          for r in records for path in [r["batch"]["path"]]
                          for c in r["cuboids"])
        self.assertEqual(found, expected)
        ((bad, reason),) = base.execute(
            "SELECT path, reason FROM files WHERE status = 'quarantined'").fetchall()
        self.assertEqual(bad, "in/bad,\"1\".pcd")
        self.assertTrue(reason)
        self.assertGreater(base.execute(
            "SELECT sum(count) FROM counts WHERE kind = 'made'").fetchone()[0], 0)

    def test_report_is_one_file_and_tells_all(self):
        self.frames(4)
        (self.folder / "in" / "<b>&.pcd").write_bytes(b"\0" * 100)
        self.batch("in", "-o", "out", "-q", code=3)
        page = (self.out / "report.html").read_text()
        self.assertNotIn("http", page)  # nothing from elsewhere
        for source in page.split("src=\"")[1:]:
            self.assertTrue(source.startswith("data:image/jpeg;base64,"), source[:40])
        self.assertEqual(page.count("src=\""), 4)
        self.assertEqual(page.count("<svg"), 4)
        self.assertIn("&lt;b&gt;&amp;.pcd", page)
        self.assertNotIn("<b>&.pcd", page)
        reason = self.record("in/<b>&.pcd")["batch"]["reason"]
        self.assertIn(reason.replace("&", "&amp;").replace("<", "&lt;")
                      .replace(">", "&gt;").replace('"', "&quot;"), page)
        self.batch("in", "-o", "out", "-q", "--report-rows", 2, code=3)
        short = (self.out / "report.html").read_text()
        self.assertEqual(short.count("src=\""), 1)
        self.assertIn("first 2 of 5", short)

    def test_progress_in_lines(self):
        self.frames(3)
        result = self.batch("in", "-o", "out")
        self.assertNotIn("\r", result.stderr)
        self.assertIn("3 files in", result.stderr)
        self.assertEqual(self.batch("in", "-o", "out", "-q").stderr, "")

    def test_progress_on_a_terminal(self):
        self.frames(12)
        master, slave = pty.openpty()
        process = subprocess.Popen([PROGRAM, "batch", "in", "-o", "out", "-j", "1"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=slave)
        os.close(slave)
        shown = b""
        while True:
            try:
                part = os.read(master, 4096)
            except OSError:  # the other end is closed
                break
            shown += part
        os.close(master)
        self.assertEqual(process.wait(timeout=60), 0)
        self.assertRegex(shown, rb"\r\x1b\[K\[=* *\] \d+/12 files, [\d.]+/s, \d:\d\d left")
        self.assertIn(b"12 files in", shown)

    def test_names_that_are_hard(self):
        frame = TinyFrames.get()[0]
        names = ["with space.pcd", "new\nline.pcd", "-dash.pcd", "[x].pcd", "ü.pcd",
                 "n" * 240 + ".PCD", os.fsdecode(b"\xff.pcd")]
        (self.folder / "in").mkdir()
        for name in names:
            shutil.copy2(frame, self.folder / "in" / name)
        self.batch("in", "-o", "out", "-q")
        result = self.batch("in", "-o", "out", "-q", "in/[x].pcd", "in/../in/ü.pcd")
        self.assertIn("7 files, 7 of them done before", result.stdout)

    def test_inputs_outside_the_working_folder(self):
        self.frames(2)
        (self.folder / "here").mkdir()
        result = hoist("batch", "../in", "-o", "out", "-q", cwd=self.folder / "here")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "here/out/results/_parent/in/f000.pcd.json")
                        .is_file())


class Resume(BatchTest):
    def times(self):
        return {path: path.stat().st_mtime_ns
                for path in (self.out / "results").rglob("*") if path.is_file()}

    def changed_by(self, *arguments, code=0):
        """Names of the records that a further run writes again."""
        before = self.times()
        self.batch("in", "-o", "out", "-q", *arguments, code=code)
        after = self.times()
        return sorted(path.name for path in after if after[path] != before.get(path))

    def setUp(self):
        super().setUp()
        self.frames(4)
        self.batch("in", "-o", "out", "-q")

    def test_nothing_to_do(self):
        before = tree(self.out)
        self.assertEqual(self.changed_by(), [])
        self.assert_same(tree(self.out), before)

    def test_changed_and_new_inputs(self):
        os.utime(self.folder / "in/f000.pcd")
        shutil.copy2(TinyFrames.get()[1], self.folder / "in/new.pcd")
        self.assertEqual(self.changed_by(), ["f000.pcd.json", "new.pcd.json"])

    def test_input_that_changed_in_size_only(self):
        frame = self.folder / "in/f001.pcd"
        before = frame.stat()
        frame.write_bytes(b"")
        os.utime(frame, ns=(before.st_atime_ns, before.st_mtime_ns))
        self.assertEqual(self.changed_by(code=3), ["f001.pcd.json"])

    def test_changed_settings(self):
        self.assertEqual(len(self.changed_by("--min-side", "0.02")), 4)
        config = self.folder / "settings.yaml"
        config.write_text("min-side: 0.02\n")
        self.assertEqual(self.changed_by("-c", config), [])  # the same, said otherwise
        config.write_text("keep-texture: true\nformats: [json, csv]\n")
        self.assertEqual(len(self.changed_by("-c", config)), 8)
        self.assertEqual(self.changed_by("--keep-texture", "--formats", "json,csv"), [])
        self.assertEqual(len(self.changed_by()), 4)
        self.assertEqual(list((self.out / "results").rglob("*.csv")), [])  # stale

    def test_what_does_not_change_results(self):
        self.assertEqual(self.changed_by("-j", 1, "--timeout", 77, "--memory", "3G"), [])

    def test_damaged_records(self):
        results = self.out / "results/in"
        expected = tree(self.out)
        whole = (results / "f000.pcd.json").read_bytes()
        for i, damage in enumerate((b"", whole[:-1], whole[:100], whole[1:],
                                    whole.replace(b"scene", b"scenf", 1),
                                    whole.replace(b"done", b"dome", 1),
                                    b"{}\n", b"\0" * len(whole), whole + b"\n")):
            with self.subTest(i=i):
                (results / "f000.pcd.json").write_bytes(damage)
                self.assertEqual(self.changed_by(), ["f000.pcd.json"])
                self.assert_same(tree(self.out), expected)

    def test_missing_overlay(self):
        self.changed_by("--formats", "json,png")
        (self.out / "results/in/f000.pcd.png").unlink()
        (self.out / "results/in/f001.pcd.png").write_bytes(b"short")
        self.assertEqual(self.changed_by("--formats", "json,png"),
                         ["f000.pcd.json", "f000.pcd.png", "f001.pcd.json",
                          "f001.pcd.png"])

    def test_quarantine_stands_until_retry(self):
        (self.folder / "in/bad.pcd").write_bytes(b"")
        self.assertEqual(self.changed_by(code=3), ["bad.pcd.json"])
        self.assertEqual(self.changed_by(code=3), [])
        self.assertEqual(self.changed_by("--retry", code=3), ["bad.pcd.json"])
        (self.folder / "in/bad.pcd").unlink()
        self.batch("in", "-o", "out", "-q")

    def test_merge_wants_all(self):
        before = tree(self.out)
        (self.out / "results/in/f000.pcd.json").unlink()
        result = self.batch("in", "-o", "out", "--merge", code=75)
        self.assert_one_line(result, "1 of 4", "f000.pcd")
        for name in MERGED:  # the old ones
            self.assertEqual((self.out / name).read_bytes(), before[name])

    def test_listed_file_that_is_missing(self):
        self.batch("-", "-o", "out", "-q", stdin="in/f000.pcd\nin/gone.pcd\n", code=3)
        self.assertEqual(self.record("in/gone.pcd")["batch"]["cause"], "input")
        shutil.copy2(TinyFrames.get()[1], self.folder / "in/gone.pcd")
        self.batch("-", "-o", "out", "-q", stdin="in/f000.pcd\nin/gone.pcd\n")


class Isolation(BatchTest):
    def start(self, *arguments):
        process = subprocess.Popen([PROGRAM, "batch", *map(str, arguments)],
                                   cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def slow_frame(self):
        """Takes long enough to be caught at."""
        (self.folder / "in").mkdir(exist_ok=True)
        shutil.copy2(SAMPLES / "scenes/stacked.pcd", self.folder / "in/slow.pcd")
        return ["in/slow.pcd", "--mode", "paper", "--all-rounds", "-j", 1]

    def strike(self, process, sent, times):
        """Sends a signal to so many workers that have a file in hand."""
        struck = set()
        limit = time.monotonic() + 120
        while len(struck) < times and process.poll() is None:
            self.assertLess(time.monotonic(), limit)
            for worker in children(process.pid):
                if worker not in struck and at_work(worker):
                    time.sleep(0.05)  # it gets its file at once
                    os.kill(worker, sent)
                    struck.add(worker)
            time.sleep(0.005)
        self.assertEqual(len(struck), times)
        return process.wait(timeout=120)

    def test_hostile_files(self):
        self.frames(6)
        folder = self.folder / "in"
        head = ("VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"
                "COUNT 1 1 1 1\nWIDTH {0}\nHEIGHT {1}\nVIEWPOINT 0 0 0 1 0 0 0\n"
                "POINTS {2}\nDATA {3}\n")
        hostile = {
            "empty.pcd": b"",
            "zeros.pcd": b"\0" * 4096,
            "text.ply": b"just words\n",
            "fields.pcd": b"VERSION 0.7\nFIELDS" + b" x" * 5000000 + b"\n",
            "wide.pcd": head.format(10**12, 10**12, 10**24, "binary").encode(),
            "packed.pcd": head.format(100, 100, 10000, "binary_compressed").encode() +
                          b"\0" * 8,
            "short.pcd": head.format(640, 480, 307200, "binary").encode() + b"1234",
            "short.pts": b"307200\n1 2 3\n",
        }
        for name, data in hostile.items():
            (folder / name).write_bytes(data)
        os.mkfifo(folder / "fifo.pcd")  # who opens it waits for ever
        (folder / "folder.pcd").mkdir()
        (folder / "link.pcd").symlink_to("nowhere")
        result = self.batch("in", "-o", "out", "-j", 2, "--timeout", 60, code=3)
        bad = sorted([*hostile, "fifo.pcd", "link.pcd"])
        for name in bad:
            head = self.record(f"in/{name}")["batch"]
            self.assertEqual(head["status"], "quarantined", name)
            self.assertEqual(head["cause"], "input", name)
            self.assertTrue(head["reason"])
            self.assertIn(f"quarantined in/{name}: {head['reason']}", result.stderr)
        self.assertIn(f"{len(bad)} quarantined", result.stdout)
        for i in range(6):
            name = f"in/sub/f{i:03}.pcd" if i % 3 == 2 else f"in/f{i:03}.pcd"
            self.assertEqual(self.record(name)["batch"]["status"], "done")

    @unittest.skipIf(SANITIZED, "a sanitizer's own memory has no limit")
    def test_memory_limit(self):
        self.frames(4)
        side = 5000  # 400 MB that take no place on the disk
        with open(self.folder / "in/huge.pcd", "wb") as file:
            file.write(b"VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"
                       b"COUNT 1 1 1 1\nWIDTH %d\nHEIGHT %d\nVIEWPOINT 0 0 0 1 0 0 0\n"
                       b"POINTS %d\nDATA binary\n" % (side, side, side * side))
            file.truncate(file.tell() + 16 * side * side)
        for jobs in (1, 2):
            out = f"out{jobs}"
            process = self.start("in", "-o", out, "-j", jobs, "--memory", "700M")
            highest = 0
            while process.poll() is None:
                highest = max(highest, sum(map(resident, [process.pid,
                                                          *children(process.pid)])))
                time.sleep(0.005)
            self.assertEqual(process.returncode, 3, process.stderr.read())
            self.assertLess(highest, 700 << 20)
            head = self.record("in/huge.pcd", out)["batch"]
            self.assertEqual(head["cause"], "memory")
            self.assertIn("700 MB", head["reason"])
            self.assertEqual(self.record("in/f000.pcd", out)["batch"]["status"], "done")
        self.assert_same(tree(self.folder / "out2"), tree(self.folder / "out1"))
        # it stands under the same limit, and is tried again under another
        result = self.batch("in", "-o", "out1", "--memory", "700M", code=3)
        self.assertIn("5 of them done before", result.stdout)
        result = self.batch("in", "-o", "out1", "--memory", "720M", code=3)
        self.assertIn("4 of them done before", result.stdout)

    def test_too_many_workers_for_the_memory(self):
        self.frames(2)
        result = self.batch("in", "-o", "out", "-j", 16, "--memory", "1G")
        self.assertIn("instead of 16 workers", result.stderr)

    def test_one_crash_costs_nothing(self):
        arguments = self.slow_frame()
        self.batch(*arguments, "-o", "out", "-q")
        process = self.start(*arguments, "-o", "again", "-q")
        self.assertEqual(self.strike(process, signal.SIGSEGV, 1), 0)
        self.assert_same(tree(self.folder / "again"), tree(self.out))

    def test_crash_after_crash_is_quarantined(self):
        arguments = self.slow_frame()
        process = self.start(*arguments, "-o", "out")
        self.assertEqual(self.strike(process, signal.SIGSEGV, 2), 3)
        head = self.record("in/slow.pcd")["batch"]
        self.assertEqual(head["cause"], "crash")
        if not SANITIZED:  # which catches the signal and ends with a code of its own
            self.assertIn("signal 11", head["reason"])
        self.batch(*arguments, "-o", "out", "-q", code=3)  # stands
        self.batch(*arguments, "-o", "out", "-q", "--retry")  # and is forgiven
        self.assertEqual(self.record("in/slow.pcd")["batch"]["status"], "done")

    def test_worker_that_hangs(self):
        arguments = self.slow_frame()
        process = self.start(*arguments, "-o", "out", "-q", "--timeout", 30)
        workers = []
        while not workers and process.poll() is None:
            workers = [w for w in children(process.pid) if at_work(w)]
        os.kill(workers[0], signal.SIGSTOP)
        process.send_signal(signal.SIGTERM)  # stops at once all the same
        self.assertEqual(process.wait(timeout=20), 75)
        self.assertFalse(alive(workers[0]))

        process = self.start(*arguments, "-o", "out", "--timeout", 5)
        self.assertEqual(self.strike(process, signal.SIGSTOP, 2), 3)
        head = self.record("in/slow.pcd")["batch"]
        self.assertEqual(head["cause"], "hang")
        self.assertIn("5 s", head["reason"])

    def test_time_limit(self):
        self.frames(2)
        self.batch("in", "-o", "out", "-q", "--timeout", 0.001, code=3)
        for name in ("in/f000.pcd", "in/f001.pcd"):
            self.assertEqual(self.record(name)["batch"]["cause"], "hang")
        self.batch("in", "-o", "out", "-q", "--timeout", 0.001, code=3)
        self.batch("in", "-o", "out", "-q")  # another limit, another chance


def resident(pid):
    """Bytes of memory, those shared with others counted in part."""
    try:
        for line in pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return 0


class Safety(BatchTest):
    FILES = 240

    def undisturbed(self, *arguments):
        self.frames(self.FILES)
        start = time.monotonic()
        self.batch("in", "-o", "calm", "-q", *arguments)
        self.calm_time = time.monotonic() - start
        return tree(self.folder / "calm")

    def records(self):
        return len(list((self.out / "results").rglob("*.json")))

    def run_and_strike(self, sent, delay, *arguments):
        """Exit code; negative where the signal ended it. Without a delay: strikes when
        a few more results are there."""
        process = subprocess.Popen(
            [PROGRAM, "batch", "in", "-o", "out", "-q", *map(str, arguments)],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True)
        goal = self.records() + 5
        limit = time.monotonic() + (60 if delay is None else delay)
        while time.monotonic() < limit and process.poll() is None:
            time.sleep(0.002)
            if delay is None and self.records() >= goal:
                break
        if process.poll() is not None:
            return process.returncode
        workers = children(process.pid)
        if sent == signal.SIGINT:  # a terminal sends it to the workers too
            os.killpg(process.pid, sent)
        else:
            process.send_signal(sent)
        code = process.wait(timeout=60)
        limit = time.monotonic() + 10  # nobody outlives the batch
        while any(map(alive, workers)) and time.monotonic() < limit:
            time.sleep(0.002)
        self.assertFalse(any(map(alive, workers)))
        return code

    def assert_part(self, expected):
        """What is there is whole."""
        for name, data in tree(self.out).items():
            if not name.startswith(".run-"):
                self.assertEqual(data, expected[name], name)

    def test_stop_signals(self):
        expected = self.undisturbed()
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.assertEqual(self.run_and_strike(sent, None), 75, sent)
            self.assert_part(expected)
            self.assertEqual(list(self.out.glob(".run-*")), [])
        self.assertGreater(self.records(), 14)
        self.assertLess(self.records(), self.FILES)
        self.batch("in", "-o", "out", "-q")
        self.assert_same(tree(self.out), expected)

    def test_killed_at_any_moment(self):
        expected = self.undisturbed("--formats", "json,csv")
        rng = random.Random(7)
        # from the first instruction to beyond a few results and, as the work grows
        # less, to the merge
        longest = 0.5 + self.calm_time / 2
        kills, partial, complete = 0, 0, 0
        while kills < KILLS:
            code = self.run_and_strike(signal.SIGKILL, rng.uniform(0, longest),
                                       "--formats", "json,csv", "-j",
                                       rng.choice((1, 2, 3)))
            self.assertIn(code, (0, -signal.SIGKILL))
            self.assert_part(expected)
            if code == 0:
                complete += 1
                self.assert_same(tree(self.out), expected)
                shutil.rmtree(self.out)
            else:
                kills += 1
                partial += 0 < self.records() < self.FILES
        self.assertGreater(partial, KILLS // 3)
        self.batch("in", "-o", "out", "-q", "--formats", "json,csv")
        self.assert_same(tree(self.out), expected)
        print(f"{kills} kills, {partial} of them with some results there, {complete} "
              f"complete runs; undisturbed {self.calm_time:.1f} s")

    def test_two_runs_at_once(self):
        """A scheduler may start a task twice."""
        expected = self.undisturbed()
        runs = [subprocess.Popen([PROGRAM, "batch", "in", "-o", "out", "-q"],
                                 cwd=self.folder, stdout=subprocess.DEVNULL)
                for _ in range(3)]
        self.assertEqual([run.wait(timeout=300) for run in runs], [0, 0, 0])
        self.assert_same(tree(self.out), expected)

    def test_disk_full(self):
        expected = self.undisturbed()
        self.out.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=800k", "none",
                                  self.out], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest("a small disk cannot be mounted: " + mounted.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", self.out], check=True)
        result = self.batch("in", "-o", "out", "-q", code=75)
        self.assertIn("out/results/", result.stderr)
        self.assertIn("No space left", result.stderr)
        kept = tree(self.out)
        self.assertGreater(len(kept), 10)
        self.assert_part(expected)
        self.assertEqual(list(self.out.glob(".run-*")), [])
        # room again: what was done is not done again
        subprocess.run(["mount", "-o", "remount,size=64m", self.out], check=True)
        result = self.batch("in", "-o", "out", "-q")
        self.assertIn(f"{len(kept)} of them done before", result.stdout)
        self.assert_same(tree(self.out), expected)

    def test_output_that_becomes_unwritable(self):
        self.frames(3)
        self.out.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "none",
                                  self.out], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest("a small disk cannot be mounted: " + mounted.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", self.out], check=True)
        self.batch("in", "-o", "out", "-q")
        before = tree(self.out)
        subprocess.run(["mount", "-o", "remount,ro", self.out], check=True)
        result = self.batch("in", "-o", "out", "-q", "--min-side", "0.03", code=2)
        self.assert_one_line(result, "Read-only")
        self.assert_same(tree(self.out), before)


if __name__ == "__main__":
    unittest.main()
