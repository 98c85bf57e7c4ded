# SPDX-License-Identifier: Apache-2.0
import csv
import gzip
import json
import math
import os
import random
import unittest

from support import (GNSS_HEAD, GRAVITY, IMU_HEAD, JOB, OMEGA, SOURCE, Case, distance_at, gnss_rows, imu_rows)


class Survey(Case):
    def test_result_is_whole_and_close_to_the_truth(self):
        summary = json.loads(self.good("survey", "job.toml", "--json"))
        self.assertGreater(summary["length_m"], 500)
        result = self.folder / "job.result"
        for name in ("trajectory.csv", "trajectory.h5", "run.json", "innovations.csv", "rejections.csv"):
            self.assertTrue((result / name).exists(), name)
        with open(result / "trajectory.csv", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        last = [r for r in rows if abs(float(r["time_s"]) - 80.0) < 0.01][0]
        self.assertAlmostEqual(float(last["latitude_deg"]), 48.0 + 500.0 / 6367000.0 * 180 / 3.14159265358979, delta=2e-6)
        run = json.loads((result / "run.json").read_text())
        self.assertEqual([len(f["sha256"]) for f in run["inputs"]], [64, 64, 64])

    def test_two_runs_give_the_same(self):
        self.good("survey", "job.toml", "-o", "a")
        self.good("survey", "job.toml", "-o", "b")
        self.assertEqual((self.folder / "a/trajectory.csv").read_bytes(), (self.folder / "b/trajectory.csv").read_bytes())

    def test_gzip_is_read_as_it_is(self):
        (self.folder / "imu.csv.gz").write_bytes(gzip.compress((self.folder / "imu.csv").read_bytes()))
        self.good("survey", "job.toml", "--set", 'imu.file="imu.csv.gz"')

    def test_failure_keeps_the_old_result(self):
        self.good("survey", "job.toml")
        before = (self.folder / "job.result/run.json").read_bytes()
        self.edit("imu.csv", lambda text: "")
        self.assertEqual(self.versine("survey", "job.toml").returncode, 2)
        self.assertEqual((self.folder / "job.result/run.json").read_bytes(), before)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])

    def test_check_and_info(self):
        self.assertIn("imu: 4500 samples", self.good("check", "job.toml"))
        self.assertIn("50", self.good("info", "imu.csv"))
        json.loads(self.good("info", "imu.csv", "--json"))


class Faults(Case):
    """Faults inside a recording: found, told, and survived."""

    def survey(self):
        summary = json.loads(self.good("survey", "job.toml", "--json"))
        text = (self.folder / "job.result/trajectory.csv").read_text().lower()
        self.assertNotIn("nan", text)
        self.assertNotIn("inf", text)
        return summary, json.loads((self.folder / "job.result/run.json").read_text())

    def within_three_sigma(self, after):
        """Position from the fault on against the truth: the vehicle drives due north."""
        with open(self.folder / "job.result/trajectory.csv", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        looked, beyond = 0, 0
        for row in rows:
            t = float(row["time_s"])
            if t < after or t > 88.0:
                continue
            north = math.radians(float(row["latitude_deg"]) - 48.0) * 6367000.0 - distance_at(t)[0]
            east = math.radians(float(row["longitude_deg"]) - 11.0) * 6388000.0 * math.cos(math.radians(48.0))
            up = float(row["height_m"]) - 500.0
            for error, sigma in ((north, "north"), (east, "east"), (up, "down")):
                looked += 1
                beyond += not abs(error) <= 3.0 * float(row[f"sigma_{sigma}_m"])
        self.assertGreater(looked, 800)
        self.assertLessEqual(beyond, 0.01 * looked)

    def test_gnss_stamps_half_a_sample_off(self):
        rows = [[r[0] + 0.01, r[1] + math.degrees(0.01 * distance_at(r[0])[1] / 6367000.0), *r[2:]] for r in gnss_rows()]
        self.write_table("gnss.csv", GNSS_HEAD, rows)
        self.survey()
        self.within_three_sigma(after=20.0)

    def test_nan_field_and_duplicated_line(self):
        def spoil(text):
            lines = text.split("\n")
            lines[1000] = ",".join(lines[1000].split(",")[:3] + ["nan"] + lines[1000].split(",")[4:])
            lines.insert(2000, lines[2000])
            return "\n".join(lines)

        self.edit("imu.csv", spoil)
        _, run = self.survey()
        self.assertGreaterEqual(len(run["findings"]), 2)
        self.within_three_sigma(after=20.0)

    def test_gap_of_two_seconds(self):
        rows = [r for r in imu_rows() if not 50.0 < r[0] <= 52.0]
        self.write_table("imu.csv", IMU_HEAD, rows)
        summary, run = self.survey()
        self.assertEqual(len(summary["segments"]), 2)
        self.assertTrue(any("gap" in f["kind"] for f in run["findings"]))
        self.within_three_sigma(after=52.0)

    def test_outlying_fixes_are_rejected(self):
        rows = [[r[0], r[1] + (2e-5 if 60 <= r[0] < 65 else 0.0), r[2], r[3]] for r in gnss_rows()]
        self.write_table("gnss.csv", GNSS_HEAD, rows)
        summary, _ = self.survey()
        gnss = [s for s in summary["innovations"] if "gnss" in s["sensor"]][0]
        self.assertGreaterEqual(gnss["rejected"], 5)
        self.within_three_sigma(after=60.0)


class BadInput(Case):
    def test_empty_file(self):
        self.edit("imu.csv", lambda text: "")
        self.refused("survey", "job.toml", says=["imu.csv", "empty"])

    def test_missing_column(self):
        self.edit("imu.csv", lambda text: text.replace("gyro_z_radps", "spin"))
        self.refused("survey", "job.toml", says=["imu.csv", "gyro_z"])

    def test_letters_in_a_number(self):
        self.edit("imu.csv", lambda text: "\n".join(line if i != 41 else line[:8] + "x" + line[9:]
                                                    for i, line in enumerate(text.split("\n"))))
        self.refused("survey", "job.toml", says=["imu.csv:42"])

    def test_degrees_declared_as_radians(self):
        rows = ([r[0]] + [57.29578 * x + (20.0 if r[0] > 60 else 0.0) * (i == 2) for i, x in enumerate(r[1:4])] + r[4:]
                for r in imu_rows())
        self.write_table("imu.csv", IMU_HEAD, rows)
        self.refused("survey", "job.toml", says=["imu.csv", "deg"])

    def test_latitude_and_longitude_swapped(self):
        rows = [[r[0], 11.0 + r[1] - 48.0, 122.0 + 5e-5 * r[0], r[3]] for r in gnss_rows()]
        self.write_table("gnss.csv", ["time_s", "longitude_deg", "latitude_deg", "height_m"], rows)
        self.refused("survey", "job.toml", says=["gnss.csv", "latitude"])

    def trolley(self, degrees=False, swapped=False):
        """A trolley with navigation-grade gyros: stands for 130 s, then creeps 4 m straight on."""
        noise = random.Random(3)
        lat, unit = math.radians(48.0), 57.29578 if degrees else 1.0
        omega = (OMEGA * math.cos(lat), 0.0, -OMEGA * math.sin(lat))
        self.write_table("imu.csv", IMU_HEAD, ([k / 50] + [unit * (w + noise.gauss(0, 1e-6)) for w in omega] +
                                               [noise.gauss(0, 2e-3), noise.gauss(0, 2e-3), -GRAVITY]
                                               for k in range(1, 150 * 50)))
        head = ["time_s", "longitude_deg", "latitude_deg", "height_m"] if swapped else GNSS_HEAD
        self.write_table("gnss.csv", head, ([float(k), 48.0 + math.degrees(max(0, k - 130) * 0.2 / 6367000), 11.0, 500.0]
                                            for k in range(1, 150)))
        self.edit("job.toml", lambda text: text.replace("mems", "navigation-rlg"))

    def test_slow_trolley_passes(self):
        self.trolley()
        self.good("survey", "job.toml")

    def test_degrees_declared_as_radians_on_a_slow_trolley(self):
        self.trolley(degrees=True)
        self.refused("survey", "job.toml", says=["imu.csv", "degrees declared as radians"])

    def test_latitude_and_longitude_swapped_on_a_short_straight_run(self):
        self.trolley(swapped=True)
        self.refused("survey", "job.toml", says=["gnss.csv", "swapped"])

    def test_latitude_and_longitude_swapped_told_by_the_odometer(self):
        # A consumer IMU sees no Earth rate, and a straight way no turn. Eastwards the way is longer when swapped.
        self.write_table("odometer.csv", ["time_s", "distance_m"], ([0.5 * k, distance_at(0.5 * k)[0]] for k in range(180)))
        rows = [[r[0], 48.0, 11.0 + (r[1] - 48.0) / math.cos(math.radians(48.0)), r[3]] for r in gnss_rows()]
        self.edit("job.toml", lambda text: text.replace("heading_deg = 0.0", "heading_deg = 90.0") +
                  '[[odometer]]\nfile = "odometer.csv"\ntime_scale = "recorder"\n')
        self.write_table("gnss.csv", GNSS_HEAD, rows)
        self.good("check", "job.toml")
        self.write_table("gnss.csv", ["time_s", "longitude_deg", "latitude_deg", "height_m"], rows)
        self.refused("survey", "job.toml", says=["gnss.csv", "swapped"])

    def test_no_overlap_in_time(self):
        self.write_table("gnss.csv", GNSS_HEAD, ([r[0] + 5000.0] + r[1:] for r in gnss_rows()))
        self.refused("survey", "job.toml", says=["gnss.csv"])

    def test_wrong_axes(self):
        self.refused("survey", "job.toml", "--set", 'imu.axes="forward-left-up"', says=["axes"])

    def test_sigma_zero_or_negative(self):
        for sigma in (0.0, -1.0):
            rows = [r + [sigma] * 3 for r in gnss_rows()]
            self.write_table("gnss.csv", GNSS_HEAD + ["sigma_north_m", "sigma_east_m", "sigma_up_m"], rows)
            self.refused("survey", "job.toml", says=["gnss.csv", "sigma"])

    def test_unknown_key_names_the_nearest(self):
        self.edit("job.toml", lambda text: text.replace("grade", "gade"))
        self.refused("survey", "job.toml", says=["job.toml:5", "gade", "did you mean 'grade'"])

    def test_unreadable_and_unwritable_paths(self):
        self.refused("survey", "nowhere.toml", says=["nowhere.toml"])
        self.edit("job.toml", lambda text: text.replace("imu.csv", "absent.csv"))
        self.refused("survey", "job.toml", says=["absent.csv"])
        (self.folder / "job.toml").write_text(JOB)
        (self.folder / "taken").write_text("a file, no folder")
        self.refused("survey", "job.toml", "-o", "taken", says=["taken"])


class Documentation(Case):
    def test_keys_page_is_what_the_program_says(self):
        page = SOURCE / "docs" / "job-survey.md"
        self.assertEqual(page.read_text(), self.good("init", "survey", "--keys"),
                         "run: versine init survey --keys > docs/job-survey.md")

    def test_template_is_a_valid_job(self):
        (self.folder / "new.toml").write_text(self.good("init", "survey"))
        done = self.versine("check", "new.toml")
        self.assertIn("recording.csv", done.stderr)  # everything is right but the file that is not there

    def test_no_template_is_called_good_that_cannot_run(self):
        for kind in ("survey", "geometry", "calibrate", "gnss", "stationing", "georef"):
            (self.folder / f"{kind}.toml").write_text(self.good("init", kind))
            checked, run = self.versine("check", f"{kind}.toml"), self.versine(kind, f"{kind}.toml")
            self.assertEqual((checked.returncode, run.returncode), (2, 2), kind)
            self.assertEqual(checked.stderr, run.stderr)  # what would be found later is found by 'check'

    def test_a_job_of_another_kind_is_told_which_command_runs_it(self):
        (self.folder / "line.toml").write_text(self.good("init", "simulate"))
        done = self.versine("georef", "line.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("versine simulate line.toml", done.stderr)

    def test_template_of_a_simulation_runs_and_its_job_too(self):
        (self.folder / "line.toml").write_text(self.good("init", "simulate"))
        self.assertIn("390", self.good("simulate", "line.toml"))
        self.good("check", "line.recording/survey.toml")

    def test_help_teaches(self):
        text = self.good("--help")
        for word in ("survey", "init", "check", "info"):
            self.assertIn(word, text)
        self.assertRegex(self.good("--version"), r"versine \d+\.\d+\.\d+")


if __name__ == "__main__":
    unittest.main()
