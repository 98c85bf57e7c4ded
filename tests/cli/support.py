# SPDX-License-Identifier: Apache-2.0
"""Runs the program as a user does, and makes small recordings for it."""
import math
import os
import pathlib
import random
import subprocess
import tempfile
import unittest

VERSINE = os.environ.get("VERSINE", "versine")
SOURCE = pathlib.Path(os.environ.get("VERSINE_SOURCE_DIR", "../.."))

OMEGA = 7.292115e-5
LATITUDE = math.radians(48.0)
RADIUS = 6362000.0  # of the meridian at 48 degrees, to a few kilometres: enough for a recording of a minute
GRAVITY = 9.8085


def distance_at(t):
    """Standing for 20 s, 0.5 m/s^2 to 10 m/s, then steady."""
    t = t - 20.0
    if t <= 0.0:
        return 0.0, 0.0, 0.0
    if t < 20.0:
        return 0.25 * t * t, 0.5 * t, 0.5
    return 100.0 + 10.0 * (t - 20.0), 10.0, 0.0


def imu_rows(duration=90.0, rate=50.0):
    """A vehicle that drives north: time, rates in rad/s, specific force in m/s^2 (forward-right-down)."""
    noise = random.Random(1)
    for k in range(1, int(duration * rate) + 1):
        t = k / rate
        _, v, a = distance_at(t - 0.5 / rate)
        rates = (OMEGA * math.cos(LATITUDE), -v / RADIUS, -OMEGA * math.sin(LATITUDE))
        force = (a, 2.0 * OMEGA * math.sin(LATITUDE) * v, -GRAVITY)
        yield [t] + [x + noise.gauss(0.0, 2e-4) for x in rates] + [x + noise.gauss(0.0, 5e-3) for x in force]


def gnss_rows(duration=90.0):
    noise = random.Random(2)
    for k in range(1, int(duration)):
        s, _, _ = distance_at(float(k))
        yield [float(k), 48.0 + math.degrees((s + noise.gauss(0.0, 0.02)) / 6367000.0), 11.0, 500.0 + noise.gauss(0, 0.03)]


IMU_HEAD = ["time_s", "gyro_x_radps", "gyro_y_radps", "gyro_z_radps", "accel_x_mps2", "accel_y_mps2", "accel_z_mps2"]
GNSS_HEAD = ["time_s", "latitude_deg", "longitude_deg", "height_m"]

JOB = """job = "survey"
[imu]
file = "imu.csv"
time_scale = "recorder"
grade = "mems"
[gnss]
file = "gnss.csv"
time_scale = "recorder"
sigma_horizontal_m = 0.03
sigma_vertical_m = 0.05
[alignment]
heading = "given"
heading_deg = 0.0
"""


class Case(unittest.TestCase):
    """A folder of its own with a small good recording in it."""

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        self.write_table("imu.csv", IMU_HEAD, imu_rows())
        self.write_table("gnss.csv", GNSS_HEAD, gnss_rows())
        (self.folder / "job.toml").write_text(JOB)

    def tearDown(self):
        self.scratch.cleanup()

    def write_table(self, name, head, rows):
        lines = [",".join(head)] + [",".join(f"{x:.11g}" for x in row) for row in rows]
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def edit(self, name, change):
        path = self.folder / name
        path.write_text(change(path.read_text()))

    def versine(self, *arguments, **keywords):
        return subprocess.run([VERSINE, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, **keywords)

    def good(self, *arguments):
        done = self.versine(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def refused(self, *arguments, says):
        """Exit code 2, each of `says` in the message, and no result left behind."""
        done = self.versine(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertFalse((self.folder / "job.result").exists())
        return done.stderr
