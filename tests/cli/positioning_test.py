# SPDX-License-Identifier: Apache-2.0
"""Positioning from what the instruments wrote: bad input is refused with the cure (exit code 2)."""
import json
import math
import os
import shutil
import subprocess
import sys
import unittest

from support import SOURCE, Case

JOB = """job = "stationing"
[total_station]
readings = ["readings.csv"]
control = ["control.csv"]
origin = [48.0, 11.0, 500.0]
refraction = 0.0
"""
GON = 200.0 / math.pi
HEAD = "station,point,direction_gon,zenith_gon,distance_m,face"

# Pairs on both sides of a track that bends a little: no two places of the network look alike.
CONTROL = {f"{10 + k // 2}{'LR'[k % 2]}": (60.0 * (k // 2) + 1.3 * (k // 2) ** 2, (-4.0, 5.0)[k % 2] + 2.1 * (k // 2) ** 2,
                                           1.0 + 0.13 * k * (-1) ** k) for k in range(8)}


def sighting(name, station, place, faces=(1, 2), distance_error=0.0):
    """Rows of a levelled instrument whose circle is turned by 0.4 rad."""
    n, e, u = (a - b for a, b in zip(place, station))
    distance = math.sqrt(n * n + e * e + u * u)
    direction, zenith = math.atan2(e, n) - 0.4, math.acos(u / distance)
    rows = []
    for face in faces:
        r = direction if face == 1 else direction + math.pi
        z = zenith if face == 1 else 2.0 * math.pi - zenith
        rows.append(["S1", name, GON * (r % (2.0 * math.pi)), GON * z, distance + distance_error, face])
    return rows


class TotalStation(Case):
    STATION = (75.0, 3.0, 0.4)

    def setUp(self):
        super().setUp()
        (self.folder / "job.toml").write_text(JOB)
        self.write_control(CONTROL)
        self.write_readings(self.rows())

    def rows(self, names=tuple(CONTROL), **keywords):
        return [row for name in names for row in sighting(name, self.STATION, CONTROL[name], **keywords)]

    def write_control(self, points):
        lines = ["name,north_m,east_m,up_m"] + [f"{k},{p[0]:.5f},{p[1]:.5f},{p[2]:.5f}" for k, p in points.items()]
        (self.folder / "control.csv").write_text("\n".join(lines) + "\n")

    def write_readings(self, rows):
        lines = [HEAD] + [f"{s},{p},{r:.6f},{z:.6f},{d:.5f},{f}" for s, p, r, z, d, f in rows]
        (self.folder / "readings.csv").write_text("\n".join(lines) + "\n")

    def refuses(self, *says, more=()):
        return self.refused("stationing", "job.toml", "-o", "job.result", *more, says=says)

    def test_good_readings_are_solved(self):
        summary = json.loads(self.good("stationing", "job.toml", "--json", "-o", "out"))
        self.assertEqual(summary["results"]["stations"], 1)
        self.assertTrue((self.folder / "out/landmarks.csv").exists())

    def test_fewer_than_three_usable_points(self):
        self.write_readings(self.rows(("11L", "11R")))
        self.refuses("readings.csv:2", "station S1", "2 usable of 2 targets", "at least 3 targets", "control list")

    def test_points_on_a_line(self):
        on_line = {f"L{k}": (20.0 * k - 30.0, 0.0, 1.0) for k in range(5)}
        self.write_control(on_line)
        self.write_readings([row for name, place in on_line.items() for row in sighting(name, (0.0, 2.0, 0.5), place)])
        self.refuses("targets that lie on a line", "both sides of the track")

    def test_degrees_in_columns_of_gon(self):
        both = [row[:2] + [0.9 * row[2], 0.9 * row[3]] + row[4:] for row in self.rows()]
        self.write_readings([row for row in both if row[5] == 1])
        self.refuses("direction_deg and zenith_deg", more=("--set", "total_station.one_face=true"))
        # In face II the zenith angle itself tells, or the sum of both faces.
        self.write_readings(both)
        self.refuses("zenith_deg")

    def test_gon_in_columns_of_degrees(self):
        self.edit("readings.csv", lambda text: text.replace("_gon", "_deg"))
        self.refuses("zenith_gon")

    def test_one_station_in_another_unit(self):
        second = [["S2"] + row[1:2] + [0.9 * row[2], 0.9 * row[3]] + row[4:] for row in self.rows()]
        self.write_readings(self.rows() + second)
        self.good("stationing", "job.toml", "-o", "out")
        rejected = json.loads((self.folder / "out/run.json").read_text())["rejections"]
        self.assertTrue(any("S2" in r["reason"] and "zenith_deg" in r["reason"] for r in rejected), rejected)

    def test_face_two_missing(self):
        self.write_readings(self.rows(faces=(1,)))
        self.refuses("station S1", "face I only", "collimation_arcsec", "one_face = true")
        self.good("stationing", "job.toml", "-o", "out", "--set", "total_station.one_face=true")

    def test_unknown_point_numbers(self):
        rows = [[row[0], "X" + row[1]] + row[2:] for row in self.rows()]
        self.write_readings(rows)
        self.refuses("0 usable of 8 targets", "numbers", more=("--set", "total_station.identify=false"))
        summary = json.loads(self.good("stationing", "job.toml", "--json", "-o", "out"))  # by their coordinates
        self.assertEqual(summary["results"]["stations"], 1)
        self.assertIn("'X11L' is 11L", (self.folder / "out/run.json").read_text())
        # Of another line altogether.
        self.write_control({"Y" + k: (p[0] * 1.2, p[1] * 3.0, p[2]) for k, p in CONTROL.items()})
        self.refuses("0 usable of 8 targets", "control list")

    def test_prism_constant_applied_twice(self):
        self.write_readings(self.rows(distance_error=-0.0344))
        self.refuses("all distances", "too short", "prism constant applied twice", "prism_constant_mm")

    def test_easting_and_northing_exchanged(self):
        self.write_control({k: (p[1], p[0], p[2]) for k, p in CONTROL.items()})
        self.refuses("easting and northing", more=("--set", "total_station.identify=false"))


class OneChange(Case):
    """Positions or raw readings: one table of the job, as the simulated job itself shows."""
    SHORT = ["--set", "motion.leg=[{to_m=260.0, speed_kmh=3.6, stop_s=40.0, stop_every_m=60.0, stop_each_s=40.0}]"]

    def errors(self, result):
        self.good("survey", "recording/survey.toml", "-o", result)
        told = json.loads(self.good("compare", result, "recording/truth_trajectory.csv", "--json"))
        return {name: told[name]["rms"] for name in ("along", "across", "up")}

    def test_positions_and_readings_are_one_change_in_the_job(self):
        self.good("simulate", SOURCE / "examples/scenarios/slab-1km.toml", "-o", "recording", *self.SHORT)
        readings = self.errors("by_readings")

        def to_positions(text):
            before, rest = text.split("[total_station]", 1)
            after = rest[rest.index("# [landmarks]"):].splitlines()
            return before + "\n".join(line.removeprefix("# ") for line in after) + "\n"
        self.edit("recording/survey.toml", to_positions)
        positions = self.errors("by_positions")
        for name in readings:
            self.assertLess(readings[name], 1.0, name)  # mm
            self.assertLess(positions[name], 1.0, name)  # mm
            self.assertLess(readings[name], 1.5 * positions[name] + 0.1, name)


RTKLIB = shutil.which("rnx2rtkp") is not None


@unittest.skipUnless(RTKLIB or "CI" in os.environ, "RTKLIB's rnx2rtkp is not installed")
class Gnss(Case):
    def setUp(self):
        super().setUp()
        self.assertTrue(RTKLIB, "rnx2rtkp is missing, and CI must have it")
        done = subprocess.run([sys.executable, "-B", SOURCE / "benchmarks/rinex_hour.py", self.folder, "40"], check=True,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)

    def refuses(self, *says):
        return self.refused("gnss", "job.toml", "-o", "job.result", says=says)

    def test_good_observations_are_solved(self):
        summary = json.loads(self.good("gnss", "job.toml", "--json", "-o", "out"))
        self.assertEqual(summary["results"]["epochs"], 40)
        self.assertEqual(summary["results"]["positions"], 40)

    def test_no_navigation_data(self):
        self.edit("job.toml", lambda text: text.replace('navigation = ["brdc.nav"]\n', ""))
        self.refuses("gnss.navigation", "no navigation data", "broadcast ephemerides")

    def test_navigation_data_of_another_day(self):
        self.edit("brdc.nav", lambda text: text.replace("2021 09 22", "2021 09 12"))
        self.refuses("brdc.nav", "day of the measurement")

    def test_base_without_overlap(self):
        self.edit("base.obs", lambda text: text.replace("> 2021 09 22 06", "> 2021 09 22 11"))
        self.refuses("base.obs", "a time in common with the rover")

    def test_base_a_hundred_kilometres_off(self):
        self.edit("job.toml", lambda text: text.replace("671230.477", "771230.477"))
        self.refuses("base position", "100.0 km from the base's own code solution", "coordinates of this base")


if __name__ == "__main__":
    unittest.main()
