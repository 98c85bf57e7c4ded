# SPDX-License-Identifier: Apache-2.0
"""versine georef with monitoring files and --online, as a user runs it."""
import csv
import pathlib
import subprocess
import tempfile
import unittest

from batch_test import make_fleet
from support import VERSINE

JOB = 'recordings = ["recordings/vehicle_00.csv"]\n[network]\nfile = "network.geojson"\n'
MONITORING = '[[monitoring]]\nfile = "axlebox.csv"\nchannels = ["left"]\ntimes = "t"\nposition_rate_hz = 50.0\n'


class Stream(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        make_fleet(self.folder, 1)

    def tearDown(self):
        self.scratch.cleanup()

    def georef(self, job, *arguments):
        (self.folder / "job.toml").write_text(job)
        return subprocess.run([VERSINE, "georef", "job.toml", "-o", "result", *arguments], cwd=self.folder,
                              capture_output=True, text=True, timeout=120)

    def axlebox(self, start):
        rows = [f"{start + k / 200.0:.3f},{(k % 10) - 4.5}" for k in range(200 * 60)]
        (self.folder / "axlebox.csv").write_text("t,left\n" + "\n".join(rows) + "\n")

    def test_monitoring_file(self):
        self.axlebox(1030.0)
        before = (self.folder / "axlebox.csv").read_bytes()
        done = self.georef(JOB + MONITORING)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater((self.folder / "result" / "monitoring_1.h5").stat().st_size, 20000)
        self.assertEqual((self.folder / "axlebox.csv").read_bytes(), before)

    def test_bad_monitoring_files_are_named(self):
        self.axlebox(5000.0)  # another clock
        done = self.georef(JOB + MONITORING)
        self.assertEqual(done.returncode, 2)
        for text in ("axlebox.csv", "5000.0 to 5060.0 s", "offset_s"):
            self.assertIn(text, done.stderr)
        self.assertFalse((self.folder / "result").exists())
        done = self.georef(JOB + MONITORING.replace("left", "right"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("columns t, left", done.stderr)

    def test_online(self):
        done = self.georef(JOB, "--online")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("positions online", done.stdout)
        with open(self.folder / "result" / "online.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with open(self.folder / "result" / "positions.csv", encoding="utf-8") as file:
            offline = {float(r["time_s"]): float(r["track_distance_m"]) for r in csv.DictReader(file)}
        self.assertGreater(len(rows), 100)
        for row in rows[30:]:
            self.assertEqual(row["track"], "T1")
            if float(row["time_s"]) in offline:
                self.assertLess(abs(float(row["track_distance_m"]) - offline[float(row["time_s"])]), 3.0)


if __name__ == "__main__":
    unittest.main()
