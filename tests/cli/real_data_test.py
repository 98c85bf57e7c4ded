# SPDX-License-Identifier: Apache-2.0
"""Recordings that are not in the repository: ../shared/data beside it. Skipped by name without them, never in CI."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from support import SOURCE, VERSINE

DATA = SOURCE.resolve().parent / "shared" / "data"


class RealData(unittest.TestCase):
    def setUp(self):
        if DATA.is_dir():
            return
        if os.environ.get("CI"):
            self.fail(f"{DATA} is missing")
        self.skipTest(f"{DATA} is missing")

    def survey(self, job, *settings):
        with tempfile.TemporaryDirectory() as folder:
            command = [VERSINE, "survey", str(SOURCE / "examples" / "real" / job), "--json", "-o", f"{folder}/result"]
            for setting in settings:
                command += ["--set", setting]
            done = subprocess.run(command, capture_output=True, text=True, timeout=300,
                                  env={**os.environ, "VERSINE_DATA": str(DATA)})
            self.assertEqual(done.returncode, 0, done.stderr)
            trajectory = pathlib.Path(folder, "result", "trajectory.csv")
            lines = trajectory.read_text().split("\n") if trajectory.exists() else []
            return json.loads(done.stdout), lines

    def test_car_bridges_ten_seconds(self):
        # A filter that doubts itself too soon, or never, shows here first: 0.165 m and 96 % when this was written.
        summary, _ = self.survey("car-rtk-drive.toml", "withhold.window_s=10")
        withheld = summary["withheld"]
        self.assertEqual(withheld["windows"], 16)
        self.assertLess(withheld["rms_horizontal_m"], 0.25)
        self.assertGreaterEqual(withheld["coverage95"], 0.90)
        self.assertLessEqual(withheld["coverage95"], 0.99)

    def test_ring_laser_stands(self):
        summary, lines = self.survey("ring-laser-static.toml")
        rows = [line.split(",") for line in lines if line and not line.startswith("#")]
        east, north = rows[0].index("easting_m"), rows[0].index("northing_m")
        places = [(float(r[east]), float(r[north])) for r in rows[1:]]
        drift = max(max(abs(p[k] - places[0][k]) for p in places) for k in (0, 1))
        self.assertLess(drift, 1e-3)
        rate = summary["earth_rate"]
        for name, truth in (("total", 15.0411), ("horizontal", 12.4333), ("vertical", 8.4643)):
            self.assertLess(abs(rate[f"{name}_degph"] - truth), 0.1)
            self.assertLess(abs(rate[f"{name}_degph"] - truth), 3.0 * rate["sigma_degph"])
        self.assertLess(abs(summary["segments"][0]["heading_deg"] - 90.6), 0.1)
        zero = {i["sensor"]: i for i in summary["innovations"]}["zero velocity"]
        self.assertLess(zero["rejected"], 0.01 * zero["used"])


if __name__ == "__main__":
    unittest.main()
