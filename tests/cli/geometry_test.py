# SPDX-License-Identifier: Apache-2.0
"""Track geometry as a user runs it: a simulated trolley, and what is wrong with its inputs."""
import csv
import json
import pathlib
import re
import tempfile
import unittest

from support import Case

SCENARIO = """job = "simulate"
title = "a trolley on a bend"
seed = 3
[track]
crs = "EPSG:25832"
easting_m = 510000.0
northing_m = 5600000.0
heading_deg = 35.0
mileage_m = 12000.0
height_m = 280.0
spectrum = "china-ballastless"
sleeper_spacing_m = 0.65
[[track.horizontal]]
type = "line"
length_m = 80.0
[[track.horizontal]]
type = "clothoid"
length_m = 60.0
[[track.horizontal]]
type = "arc"
length_m = 100.0
radius_m = 900.0
turn = "right"
[[track.cant]]
distance_m = 80.0
cant_mm = 0.0
[[track.cant]]
distance_m = 140.0
cant_mm = 60.0
[motion]
start_m = 20.0
stand_s = 60.0
[[motion.leg]]
to_m = 220.0
speed_kmh = 8.0
stop_s = 10.0
[imu]
grade = "navigation-rlg"
rate_hz = 100.0
[[odometer]]
rate_hz = 50.0
[gauge]
rate_hz = 20.0
[total_station]
output = "positions"
every_m = 100.0
[truth]
rate_hz = 10.0
"""

JOB = """job = "geometry"
[trajectory]
file = "truth_trajectory.csv"
[geometry]
crs = "EPSG:25832"
design = "design.xml"
height_reference = "axis"
write = { gpkg = false, xlsx = false }
[geometry.gauge]
file = "gauge.csv"
"""


class Geometry(Case):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        case = cls()
        case.folder = pathlib.Path(cls.made.name)
        (case.folder / "scenario.toml").write_text(SCENARIO)
        case.good("simulate", "scenario.toml", "-o", "recording", "--quiet")

    @classmethod
    def tearDownClass(cls):
        cls.made.cleanup()

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)
        for name in ("truth_trajectory.csv", "gauge.csv", "design.xml"):
            (self.folder / name).write_bytes((pathlib.Path(self.made.name) / "recording" / name).read_bytes())
        # Where the sensors sit is what the survey job of the recording says.
        survey = (pathlib.Path(self.made.name) / "recording/survey.toml").read_text()
        trolley = survey[survey.index("[geometry.trolley]"):survey.index("[geometry.gauge]")]
        (self.folder / "job.toml").write_text(JOB + trolley)

    def points(self):
        with open(self.folder / "job.result/geometry.csv", newline="") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def test_good_run(self):
        self.good("geometry", "job.toml")
        rows = self.points()
        self.assertGreater(len(rows), 780)
        self.assertAlmostEqual(float(rows[-40]["cross_level_mm"]), 60.0, delta=4.0)
        self.assertLess(max(abs(float(r["deviation_lateral_axis_mm"])) for r in rows[40:-40]), 15.0)

    def test_design_elsewhere(self):
        def shift(text):
            return re.sub(r"<(Start|End|Center|PI)>([\d.]+) ", lambda m: f"<{m[1]}>{float(m[2]) + 5000:.9f} ", text)

        self.edit("design.xml", shift)
        self.refused("geometry", "job.toml", says=["design", "contains the run", "0 of"])

    def test_design_with_a_gap(self):
        self.edit("design.xml", lambda text: re.sub(r"(?s)<Spiral.*?</Spiral>", "", text))
        self.refused("geometry", "job.toml", says=["Curve 2", "gap"])
        audit = json.loads(self.versine("info", "design.xml", "--json").stdout)
        self.assertFalse(audit["alignments"][0]["usable"])

    def test_gauge_missing_for_a_part(self):
        def cut(text):
            lines = text.split("\n")
            return "\n".join(lines[: len(lines) // 2] + lines[len(lines) * 5 // 8:])

        self.edit("gauge.csv", cut)
        self.good("geometry", "job.toml")
        rows = self.points()
        without = [r for r in rows if int(r["flags"]) & 1]
        self.assertGreater(len(without), 100)
        self.assertLess(len(without), 400)
        for r in without:
            self.assertEqual(r["gauge_mm"], "")
            self.assertNotEqual(r["cross_level_mm"], "")
        self.assertTrue(any(r["gauge_mm"] for r in rows[-50:]))

    def test_one_common_point(self):
        (self.folder / "points.csv").write_text(
            "name,easting_m,northing_m,height_m,project_easting_m,project_northing_m,project_height_m\n"
            "A,510000,5600000,280,1000,2000,240\n")
        self.edit("job.toml", lambda text: text + '[geometry.coordinates]\npoints = "points.csv"\nsimilarity = "plane"\n')
        self.refused("geometry", "job.toml", says=["common points", "found 1", "at least 2"])

    def test_mileage_backwards(self):
        with open(self.folder / "truth_trajectory.csv", newline="") as file:
            times = [float(r["time_s"]) for r in csv.DictReader(x for x in file if not x.startswith("#"))]
        marks = "".join(f"[[geometry.mark]]\ntime_s = {t:.3f}\nmileage_m = {m}\n"
                        for t, m in ((times[-60], 500.0), (times[len(times) // 2 + 100], 600.0), (times[-600], 400.0)))
        self.edit("job.toml", lambda text: text.replace('design = "design.xml"\nheight_reference = "axis"\n', "") + marks)
        self.refused("geometry", "job.toml", says=["mark"])


if __name__ == "__main__":
    unittest.main()
