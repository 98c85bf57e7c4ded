# SPDX-License-Identifier: Apache-2.0
import csv
import gzip
import json
import os
import unittest

from support import GNSS_HEAD, IMU_HEAD, JOB, SOURCE, Case, gnss_rows, imu_rows


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

    def test_nan_field_and_duplicated_line(self):
        def spoil(text):
            lines = text.split("\n")
            lines[1000] = ",".join(lines[1000].split(",")[:3] + ["nan"] + lines[1000].split(",")[4:])
            lines.insert(2000, lines[2000])
            return "\n".join(lines)

        self.edit("imu.csv", spoil)
        _, run = self.survey()
        self.assertGreaterEqual(len(run["findings"]), 2)

    def test_gap_of_two_seconds(self):
        rows = [r for r in imu_rows() if not 50.0 < r[0] <= 52.0]
        self.write_table("imu.csv", IMU_HEAD, rows)
        summary, run = self.survey()
        self.assertEqual(len(summary["segments"]), 2)
        self.assertTrue(any("gap" in f["kind"] for f in run["findings"]))

    def test_outlying_fixes_are_rejected(self):
        rows = [[r[0], r[1] + (2e-5 if 60 <= r[0] < 65 else 0.0), r[2], r[3]] for r in gnss_rows()]
        self.write_table("gnss.csv", GNSS_HEAD, rows)
        summary, _ = self.survey()
        gnss = [s for s in summary["innovations"] if "gnss" in s["sensor"]][0]
        self.assertGreaterEqual(gnss["rejected"], 5)


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

    def test_help_teaches(self):
        text = self.good("--help")
        for word in ("survey", "init", "check", "info"):
            self.assertIn(word, text)
        self.assertRegex(self.good("--version"), r"versine \d+\.\d+\.\d+")


if __name__ == "__main__":
    unittest.main()
