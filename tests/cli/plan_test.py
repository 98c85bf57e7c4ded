# SPDX-License-Identifier: Apache-2.0
import csv
import json
import time
import unittest
import xml.etree.ElementTree

from support import SOURCE, Case

EXAMPLES = SOURCE / "examples" / "plan"

PLAN = """job = "plan"
required_sigma_mm = 0.67
[sensors]
grade = "rlg-jiang"
gyro_bias_instability_deg_per_h = 0.0
[survey]
intervals = 1
"""


class Plan(Case):
    def setUp(self):
        super().setUp()
        (self.folder / "job.toml").write_text(PLAN)

    def test_answers_in_a_second(self):
        began = time.monotonic()
        answer = json.loads(self.good("plan", "job.toml", "--json"))
        self.assertLess(time.monotonic() - began, 5.0)  # a shared machine; alone it is 0.1 s (docs/planning.md)
        self.assertLess(answer["planning_s"], 1.0)
        self.assertTrue(answer["met"])
        self.assertAlmostEqual(answer["interval_middle"]["lateral_mm"], 0.440, delta=0.001)
        self.assertGreater(answer["largest_spacing_m"], 60.0)
        self.assertLess(answer["largest_spacing_m"], 200.0)
        self.assertEqual(len(answer["methods"]), 3)

    def test_reverse_questions_lie_on_the_edge(self):
        answer = json.loads(self.good("plan", "job.toml", "--json"))
        spacing = answer["largest_spacing_m"]
        self.good("plan", "job.toml", "-o", "near", "--set", f"survey.spacing_m={spacing}")
        done = self.versine("plan", "job.toml", "-o", "far", "--set", f"survey.spacing_m={spacing + 1.0}")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("NOT met", done.stdout)

    def test_result_folder_is_complete(self):
        self.good("plan", "job.toml", "--monte-carlo", "20")
        result = self.folder / "job.result"
        for name in ("sigma.svg", "maps.svg", "methods.svg", "monte_carlo.svg"):
            xml.etree.ElementTree.parse(result / name)
        with open(result / "map_vertical.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 61 * 61)
        self.assertEqual(len((result / "monte_carlo.csv").read_text().splitlines()), 21)
        run = json.loads((result / "run.json").read_text())
        self.assertEqual(run["results"]["monte_carlo"]["runs"], 20)
        self.assertEqual(run["settings"]["sensors"]["grade"], "rlg-jiang")

    def test_runs_do_not_depend_on_threads(self):
        for threads in ("1", "3"):
            self.good("plan", "job.toml", "-o", threads, "--monte-carlo", "30", "--threads", threads)
        for name in ("monte_carlo.csv", "monte_carlo_profile.csv", "monte_carlo.svg"):
            self.assertEqual((self.folder / "1" / name).read_bytes(), (self.folder / "3" / name).read_bytes())

    def test_examples_run(self):
        for job in sorted(EXAMPLES.glob("*.toml")):
            done = self.versine("plan", job, "-o", "example", "--monte-carlo", "5")
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertRegex(done.stdout, r"Required 0\.67 mm")

    def test_keys_page_is_what_the_program_says(self):
        page = SOURCE / "docs" / "job-plan.md"
        self.assertEqual(page.read_text(), self.good("init", "plan", "--keys"),
                         "run: versine init plan --keys > docs/job-plan.md")

    def test_bad_input(self):
        self.refused("plan", "job.toml", "--set", 'sensors.grade="rlg-jiangg"', says=["sensors.grade", "rlg-jiang"])
        self.refused("plan", "job.toml", "--set", "survey.spacing_m=0.0", says=["spacing_m", "at least 1"])
        self.refused("plan", "job.toml", "--set", "survey.landmark_sigma_mm=0.0", says=["landmark_sigma_mm"])
        self.refused("plan", "job.toml", "--set", "chord_m=100.0", says=["chord_m", "60 m"])
        self.refused("plan", "job.toml", "--set", "survey.speed_kmh=nan", says=["speed_kmh"])
        self.edit("job.toml", lambda text: text.replace("intervals", "intervalls"))
        self.refused("plan", "job.toml", says=["job.toml:7", "did you mean 'intervals'"])


if __name__ == "__main__":
    unittest.main()
