"""What the tests of hoist_viewer have in common: a virtual display, a user with keys and
a mouse, pictures, and the arithmetic that says where a thing must be seen.

Run by ctest with both programs, the folder of the sample scenes and, for the real frames,
HOIST_REAL_DATA in the environment. Nothing depends on timing: every wait is for something
that the program says or shows, with a limit that only a hang exceeds.
"""

import ctypes
import json
import math
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import zlib

VIEWER = os.environ["HOIST_VIEWER"]
PROGRAM = os.environ["HOIST_PROGRAM"]
SAMPLES = pathlib.Path(os.environ["HOIST_SAMPLES"])
REAL = os.environ.get("HOIST_REAL_DATA")
LIMIT = 240  # [s] for anything; a loaded machine needs a few
SIZE = (1200, 600)
# of apps/src/palette.h and viewer/layers.cpp, as RGB
PALETTE = [(225, 165, 0), (195, 0, 255), (0, 240, 255), (255, 0, 105), (135, 105, 180),
           (165, 255, 150)]
MARK = (255, 60, 60)


def environment(display=None):
    env = {key: value for key, value in os.environ.items()
           if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    if display is not None:
        env["DISPLAY"] = display
    return env


def viewer_environment(display=None):
    """With AddressSanitizer the driver of the display stays loaded to the end, see
    tests/support/lsan.supp; the sanitizer's own library has to come first."""
    env = environment(display)
    drivers = sorted(pathlib.Path("/usr/lib").glob("*/dri/swrast_dri.so"))
    if "address" in os.environ.get("HOIST_SANITIZE", "") and drivers:
        linked = subprocess.run(["ldd", VIEWER], text=True, stdout=subprocess.PIPE,
                                check=True).stdout
        runtime = re.search(r"libasan\S* => (\S+)", linked)
        if runtime:
            env["LD_PRELOAD"] = f"{runtime[1]} {drivers[0]}"
    return env


def run_viewer(*arguments, display=None, cwd=None):
    return subprocess.run([VIEWER, *map(str, arguments)], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=LIMIT, cwd=cwd,
                          env=viewer_environment(display))


def recognized(*arguments):
    result = subprocess.run([PROGRAM, "recognize", "-q", "--json", "-",
                             *map(str, arguments)],
                            capture_output=True, text=True, timeout=LIMIT, check=True)
    return json.loads(result.stdout)


class Picture:
    """Pixels as (R, G, B), row 0 on top."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    @staticmethod
    def of_png(path):
        data, position, packed = pathlib.Path(path).read_bytes(), 8, b""
        while position < len(data):
            (length,) = struct.unpack(">I", data[position:position + 4])
            kind = data[position + 4:position + 8]
            body = data[position + 8:position + 8 + length]
            if kind == b"IHDR":
                width, height, depth, color = struct.unpack(">IIBB", body[:10])
                if (depth, color) != (8, 2):
                    raise ValueError("not 8-bit RGB")
            elif kind == b"IDAT":
                packed += body
            position += 12 + length
        raw, stride, rows = zlib.decompress(packed), 3 * width, []
        before = bytes(stride)
        for y in range(height):
            start = y * (stride + 1)
            rule, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
            for i in range(stride):
                left = row[i - 3] if i >= 3 else 0
                up, corner = before[i], before[i - 3] if i >= 3 else 0
                if rule == 1:
                    row[i] = (row[i] + left) & 255
                elif rule == 2:
                    row[i] = (row[i] + up) & 255
                elif rule == 3:
                    row[i] = (row[i] + (left + up) // 2) & 255
                elif rule == 4:
                    guess = left + up - corner
                    distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
                    nearest = (left, up, corner)[distances.index(min(distances))]
                    row[i] = (row[i] + nearest) & 255
            rows.append(bytes(row))
            before = rows[-1]
        return Picture(width, height, rows)

    def pixel(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])

    def near(self, x, y, color, reach=2, tolerance=30):
        """Whether a pixel within reach of (x, y) has nearly this colour."""
        for b in range(round(y) - reach, round(y) + reach + 1):
            for a in range(round(x) - reach, round(x) + reach + 1):
                if 0 <= a < self.width and 0 <= b < self.height and all(
                        abs(p - q) <= tolerance
                        for p, q in zip(self.pixel(a, b), color)):
                    return True
        return False

    def changed(self, other, area):
        """Pixels of an area (left, top, width, height) that differ from another's."""
        left, top, width, height = area
        for y in range(top, top + height):
            a, b = self.rows[y], other.rows[y]
            if a != b:
                for x in range(left, left + width):
                    if a[3 * x:3 * x + 3] != b[3 * x:3 * x + 3]:
                        yield x, y


class Camera:
    """A .cam file and the pixels of a window that it sees points at."""

    def __init__(self, text):
        parts = [[float(number) for number in part.split(",")]
                 for part in text.strip().split("/")]
        _, self.focal, self.position, self.up, (self.angle,), _, _ = parts

    def project(self, point, area):
        """(x, y) in the window, y down; area is (left, width, height) of the view."""
        def minus(a, b):
            return [p - q for p, q in zip(a, b)]

        def cross(a, b):
            return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]]

        def dot(a, b):
            return sum(p * q for p, q in zip(a, b))

        def unit(a):
            return [p / math.sqrt(dot(a, a)) for p in a]

        forward = unit(minus(self.focal, self.position))
        right = unit(cross(forward, self.up))
        down = cross(forward, right)
        way = minus(point, self.position)
        left, width, height = area
        pixels = 0.5 * height / math.tan(0.5 * self.angle) / dot(way, forward)
        return (left + 0.5 * width + pixels * dot(way, right) - 0.5,
                0.5 * height + pixels * dot(way, down) - 0.5)


FONT = min(max(SIZE[1] // 58, 10), 24)
VIEWS = SIZE[0] - 26 * FONT  # the rest is the column of words
SPACE = (VIEWS / 2, VIEWS / 2, SIZE[1])  # where the view in space is
# A camera beside and above the sensor, so that nothing passes by chance.
ASIDE = "0.1,9/0.05,0.0,1.4/-0.35,-0.45,0.1/0.1,-1,0.1/0.75/1200,600/0,0\n"


def edges(cuboid):
    """The twelve edges as pairs of points, in the camera's frame."""
    center, size, axes = (cuboid[key] for key in ("center", "size", "rotation"))
    corners = []
    for i in range(8):
        signs = [0.5 if i >> axis & 1 else -0.5 for axis in range(3)]
        corners.append([center[k] + sum(signs[axis] * size[axis] * axes[k][axis]
                                        for axis in range(3)) for k in range(3)])
    return [(corners[i], corners[i | 1 << axis])
            for i in range(8) for axis in range(3) if not i >> axis & 1]


def hidden_edges(cuboid, eye):
    """Which of edges() the cuboid itself hides from there: the two faces that meet in
    such an edge both look away."""
    center, size, axes = (cuboid[key] for key in ("center", "size", "rotation"))
    to = [sum((eye[k] - center[k]) * axes[k][axis] for k in range(3)) for axis in range(3)]
    hidden = []
    for i in range(8):
        for axis in range(3):
            if not i >> axis & 1:
                hidden.append(not any((to[a] if i >> a & 1 else -to[a]) > size[a] / 2
                                      for a in range(3) if a != axis))
    return hidden


def along(edge, steps=12):
    a, b = edge
    for step in range(1, steps):
        yield [p + (q - p) * step / steps for p, q in zip(a, b)]


class Base(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="hoist-viewer-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def scene(self, name="blocks"):
        path = SAMPLES / "scenes" / f"{name}.pcd"
        self.assertTrue(path.is_file(), path)
        return path

    def camera_file(self):
        path = self.folder / "aside.cam"
        path.write_text(ASIDE, encoding="ascii")
        return path

    def share_of_wireframe(self, picture, result, camera, color=None, hidden=False,
                           reach=2):
        """How much of the projected edges of all cuboids has its colour: of those that
        are seen, or of those that their own cuboid hides."""
        hits = total = 0
        for number, cuboid in enumerate(result["cuboids"]):
            for edge, away in zip(edges(cuboid), hidden_edges(cuboid, camera.position)):
                if away != hidden:
                    continue
                for point in along(edge, 60 if hidden else 12):
                    x, y = camera.project(point, SPACE)
                    if not SPACE[0] + 4 < x < VIEWS - 4 or not 4 < y < SIZE[1] - 40:
                        continue  # outside, or below the words
                    total += 1
                    hits += picture.near(x, y, color or PALETTE[number], reach)
        self.assertGreater(total, 50)
        return hits / total


class Display:
    """A virtual display whose pixels lie in a file."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="hoist-xvfb-")
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1024x24", "-noreset",
             "-nolisten", "tcp", "-fbdir", self.folder,
             "-r"],  # keys must not repeat where the machine is too slow to lift them
            pass_fds=[write], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        if self.name == ":":
            raise RuntimeError("Xvfb did not start")

    def close(self):
        self.process.terminate()
        self.process.wait(LIMIT)
        shutil.rmtree(self.folder, ignore_errors=True)

    def picture(self, left, top, width, height):
        data = pathlib.Path(self.folder, "Xvfb_screen0").read_bytes()
        header = struct.unpack(">25I", data[:100])
        start, stride = header[0] + 12 * header[19], header[12]
        if header[11] != 32 or header[7] != 0:
            raise RuntimeError("an unexpected kind of screen")

        rows = []
        for y in range(top, top + height):
            at = start + y * stride + 4 * left
            row = bytearray(3 * width)
            for c in range(3):  # blue, green, red, nothing
                row[c::3] = data[at + 2 - c:at + 4 * width:4]
            rows.append(bytes(row))
        return Picture(width, height, rows)

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], check=True, text=True,
                              stdout=subprocess.PIPE, timeout=LIMIT,
                              env=environment(self.name)).stdout

    def press_close_button(self, window):
        """What a window manager sends when its button is pressed."""
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        x11.XInternAtom.restype = ctypes.c_ulong
        x11.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
        x11.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int,
                                   ctypes.c_long, ctypes.c_void_p]
        x11.XCloseDisplay.argtypes = [ctypes.c_void_p]

        class ClientMessage(ctypes.Structure):
            _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong),
                        ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                        ("window", ctypes.c_ulong), ("message", ctypes.c_ulong),
                        ("format", ctypes.c_int), ("data", ctypes.c_long * 5),
                        ("room", ctypes.c_long * 24)]

        display = x11.XOpenDisplay(self.name.encode())
        event = ClientMessage(type=33, display=display, window=window, format=32)
        event.message = x11.XInternAtom(display, b"WM_PROTOCOLS", 0)
        event.data[0] = x11.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
        x11.XSendEvent(display, window, 0, 0, ctypes.byref(event))
        x11.XCloseDisplay(display)


class Program:
    """A viewer on a display, and the user in front of it."""

    def __init__(self, test, display, *arguments, size=SIZE, cwd=None, ready=True):
        self.test, self.display, self.size = test, display, size
        self.lines = []
        self.changed = threading.Condition()
        self.process = subprocess.Popen(
            [VIEWER, *map(str, arguments), "--size", f"{size[0]}x{size[1]}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, cwd=cwd, env=viewer_environment(display.name))
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        test.addCleanup(self._kill)
        if ready:
            self.wait_for(r"^\[1/")
        self.find_window()

    def find_window(self):
        display, size = self.display, self.size
        end = time.monotonic() + LIMIT
        while not self._windows():
            if self.process.poll() is not None or time.monotonic() > end:
                self.test.fail(f"no window: {self.lines}")
            time.sleep(0.05)
        self.window = self._windows()[-1]
        shape = display.xdotool("getwindowgeometry", "--shell", self.window)
        self.left, self.top = (int(re.search(rf"^{name}=(-?\d+)", shape, re.M).group(1))
                               for name in "XY")
        self.point(size[0] // 2, size[1] - 5)  # keys go where the pointer is

    def _windows(self):
        words = ["xdotool", "search", "--onlyvisible", "--name", "^hoist_viewer"]
        found = subprocess.run(words, text=True, stdout=subprocess.PIPE, timeout=LIMIT,
                               env=environment(self.display.name), check=False)
        return [int(word) for word in found.stdout.split()]

    def _read(self):
        for line in self.process.stdout:
            with self.changed:
                self.lines.append(line.rstrip("\n"))
                self.changed.notify_all()

    def _kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(LIMIT)
        self.reader.join(LIMIT)
        self.process.stdout.close()

    def wait_for(self, pattern, since=0):
        """The first line from there on that matches."""
        end = time.monotonic() + LIMIT
        with self.changed:
            while True:
                for line in self.lines[since:]:
                    match = re.search(pattern, line)
                    if match:
                        return match
                if self.process.poll() is not None or time.monotonic() > end:
                    self.test.fail(f"no line {pattern!r} but {self.lines[since:]}")
                self.changed.wait(0.1)

    def point(self, x, y):
        self.display.xdotool("mousemove", self.left + round(x), self.top + round(y))

    def key(self, *names, answer=None):
        since = len(self.lines)
        self.display.xdotool("key", *names)
        return self.wait_for(answer, since) if answer else None

    def click(self, x, y, shift=False, answer=None):
        since = len(self.lines)
        self.point(x, y)
        if shift:
            self.display.xdotool("keydown", "shift", "click", 1, "keyup", "shift")
        else:
            self.display.xdotool("click", 1)
        return self.wait_for(answer, since) if answer else None

    def picture(self):
        return self.display.picture(self.left, self.top, *self.size)

    def wait_until(self, condition, what):
        """Until the screen shows it."""
        end = time.monotonic() + LIMIT
        while not condition(self.picture()):
            if self.process.poll() is not None or time.monotonic() > end:
                self.test.fail(what)
            time.sleep(0.05)

    def in_image(self, u, v, width=320, height=240):
        """Where a pixel of the frame is in the window."""
        scale = min(VIEWS / 2 / width, self.size[1] / height)
        return (VIEWS / 4 + (u - (width - 1) / 2) * scale - 0.5,
                self.size[1] / 2 + (v - (height - 1) / 2) * scale - 0.5)

    def ends(self):
        return self.process.wait(LIMIT)


class OnDisplay(Base):
    @classmethod
    def setUpClass(cls):
        for tool in ("Xvfb", "xdotool"):
            if shutil.which(tool) is None:
                raise unittest.SkipTest(f"{tool} is not installed")
        cls.display = Display()

    @classmethod
    def tearDownClass(cls):
        cls.display.close()

    def viewer(self, *arguments, **options):
        return Program(self, self.display, *arguments, "-o", self.folder / "out", **options)

    def out(self, name):
        return self.folder / "out" / name
