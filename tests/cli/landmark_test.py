# SPDX-License-Identifier: Apache-2.0
"""Landmark dead reckoning from job to result, and what it refuses."""
import csv
import json
import math
import random
import unittest

from support import IMU_HEAD, OMEGA, Case

LATITUDE = math.radians(50.0)
RADIUS = 6373000.0
GRAVITY = 9.81070  # at 50 degrees
STAND, LEG, STOP = 60.0, 60.0, 12.0  # s; 1 m/s between landmarks
ODOMETER_HEAD = ["time_s", "distance_m"]
LANDMARK_HEAD = ["time_from_s", "time_to_s", "latitude_deg", "longitude_deg", "height_m", "sigma_north_m",
                 "sigma_east_m", "sigma_down_m"]

JOB = """job = "survey"
method = "landmark"
[imu]
file = "imu.csv"
time_scale = "recorder"
grade = "rlg-jiang"
[[odometer]]
file = "odometer.csv"
time_scale = "recorder"
[wheel]
sigma_m = 0.0001
random_walk_mpsqrtm = 0.0001
scale_sigma = 0.002
[landmarks]
file = "landmarks.csv"
time_scale = "recorder"
[alignment]
heading = "given"
heading_deg = 0.0
heading_sigma_deg = 0.2
"""


def way(t):
    """Three legs of 60 m to the north with stops between them."""
    distance = 0.0
    t -= STAND
    for _ in range(3):
        if t <= 0.0:
            break
        distance += min(t, LEG)
        t -= LEG + STOP
    return distance


def imu_rows(rate=50.0, stand=STAND):
    noise = random.Random(3)
    end = STAND + 3 * (LEG + STOP)
    for k in range(1, int(end * rate) + 1):
        t = k / rate
        if t < STAND - stand:
            continue
        v = (way(t) - way(t - 1.0 / rate)) * rate
        rates = (OMEGA * math.cos(LATITUDE), -v / RADIUS, -OMEGA * math.sin(LATITUDE))
        walk = math.radians(0.005) / 60.0 * math.sqrt(rate)
        yield [t] + [x + noise.gauss(0.0, walk) for x in rates] + [0.0, 0.0, -GRAVITY]


def odometer_rows():
    for k in range(1, int((STAND + 3 * (LEG + STOP)) * 20)):
        yield [k / 20.0, way(k / 20.0) * 1.001]


def landmark_rows():
    noise = random.Random(4)
    for i in range(4):
        t = STAND - 5.0 if i == 0 else STAND + i * (LEG + STOP) - 0.5 * STOP
        north = way(t) + noise.gauss(0.0, 0.0006)
        yield [t - 3.0, t + 3.0, 50.0 + math.degrees(north / 6365710.0), 11.0, 500.0, 0.0006, 0.0006, 0.0006]


class Landmark(Case):
    def setUp(self):
        super().setUp()
        self.write_table("imu.csv", IMU_HEAD, imu_rows())
        self.write_table("odometer.csv", ODOMETER_HEAD, odometer_rows())
        self.landmarks(landmark_rows())
        (self.folder / "job.toml").write_text(JOB)

    def landmarks(self, rows):
        lines = [",".join(LANDMARK_HEAD)]
        lines += [",".join(f"{x:.13g}" for x in row) for row in rows]
        (self.folder / "landmarks.csv").write_text("\n".join(lines) + "\n")

    def test_result_is_near_the_truth_and_tells_what_it_can_see(self):
        text = self.good("survey", "job.toml")
        self.assertIn("rank 3 of 3 vertical and 5 of 5 level states", text)
        with open(self.folder / "job.result/trajectory.csv", newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        for row in rows[::100]:
            north = math.radians(float(row["latitude_deg"]) - 50.0) * 6365710.0
            east = math.radians(float(row["longitude_deg"]) - 11.0) * 6388000.0 * math.cos(LATITUDE)
            self.assertLess(abs(north - way(float(row["time_s"]))), 0.0025)
            self.assertLess(abs(east), 0.0025)
            self.assertLess(abs(float(row["height_m"]) - 500.0), 0.0025)
        run = json.loads((self.folder / "job.result/run.json").read_text())
        self.assertTrue(any(f["kind"] == "observability" and "rank 3" in f["detail"] for f in run["findings"]))

    def test_two_filters_give_the_same(self):
        self.good("survey", "job.toml", "-o", "rts")
        self.good("survey", "job.toml", "-o", "two", "--set", 'landmark_method.smoother="two-filter"')

        def heights(name):
            with open(self.folder / name / "trajectory.csv", newline="") as file:
                return [float(r["height_m"]) for r in csv.DictReader(line for line in file if not line.startswith("#"))]

        self.assertEqual(heights("rts"), heights("two"))  # printed to 0.01 mm

    def test_wrong_landmark_is_left_out(self):
        rows = list(landmark_rows())
        rows[2][4] += 0.02
        self.landmarks(rows)
        self.good("survey", "job.toml")
        run = json.loads((self.folder / "job.result/run.json").read_text())
        self.assertEqual([r["reason"] for r in run["rejections"]], ["contradicts the others"])

    def test_fewer_than_two_landmarks(self):
        self.landmarks(list(landmark_rows())[:1])
        self.refused("survey", "job.toml", says=["1 landmark", "at least two", "every 60 m"])

    def test_landmark_while_moving(self):
        rows = list(landmark_rows())
        rows[1][:2] = [STAND + 28.0, STAND + 32.0]
        self.landmarks(rows)
        self.refused("survey", "job.toml", says=["while the odometer moved 4", "skip_moving_landmarks"])
        self.good("survey", "job.toml", "--set", "landmark_method.skip_moving_landmarks=true")

    def test_no_static_start(self):
        self.write_table("imu.csv", IMU_HEAD, imu_rows(stand=10.0))
        self.refused("survey", "job.toml", says=["standing start", "let the trolley stand"])

    def test_no_odometer(self):
        self.edit("job.toml", lambda text: text.replace('[[odometer]]\nfile = "odometer.csv"\ntime_scale = "recorder"\n', ""))
        self.refused("survey", "job.toml", says=["no odometer", "name its file"])

    def test_no_landmarks_at_all(self):
        self.edit("job.toml", lambda text: text.replace('[landmarks]\nfile = "landmarks.csv"\ntime_scale = "recorder"\n', ""))
        self.refused("survey", "job.toml", says=["landmarks", "at least two"])


if __name__ == "__main__":
    unittest.main()
