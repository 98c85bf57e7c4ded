# SPDX-License-Identifier: Apache-2.0
"""Georeferencing as a user runs it: a small railway, one vehicle, and every fault that files can have."""
import csv
import ctypes
import ctypes.util
import json
import math
import random
import unittest

from support import SOURCE, Case

ORIGIN = (51.5, 9.9)  # deg; metres east and north of it below
NORTH = 111250.0      # m a degree
EAST = 111320.0 * math.cos(math.radians(ORIGIN[0]))


def degrees(x, y):
    return ORIGIN[0] + y / NORTH, ORIGIN[1] + x / EAST


def straight(x0, x1, y0, y1):
    n = int((x1 - x0) / 20) + 1
    return [(x0 + (x1 - x0) * i / n, y0 + (y1 - y0) * i / n) for i in range(n + 1)]


# Two lines 8 m apart with one crossover from A to B.
TRACKS = {"A1": straight(0, 800, 0, 0), "A2": straight(800, 900, 0, 0), "A3": straight(900, 2000, 0, 0),
          "B1": straight(0, 800, 8, 8), "B2": straight(800, 900, 8, 8), "B3": straight(900, 2000, 8, 8),
          "X": straight(800, 900, 0, 8)}


def feature(name, points):
    line = [[round(c, 9) for c in reversed(degrees(x, y))] for x, y in points]
    return {"type": "Feature", "properties": {"id": name}, "geometry": {"type": "LineString", "coordinates": line}}


def network(tracks):
    return json.dumps({"type": "FeatureCollection", "features": [feature(k, v) for k, v in tracks]})


def fixes(start=1000.0, seed=1, side=lambda x: 8.0 * min(max((x - 800) / 100, 0.0), 1.0), east=0.0, sigma=0.4):
    """Standing 20 s, 0.5 m/s^2 to 15 m/s, on until 100 s, braking; 2 Hz."""
    noise = random.Random(seed)
    x, v = 60.0, 0.0
    for k in range(320):
        t = 0.5 * k
        a = 0.0 if t < 20 else (0.5 if v < 15 and t < 100 else (-0.5 if t >= 100 and v > 0 else 0.0))
        lat, lon = degrees(x + east + noise.gauss(0, sigma), side(x) + noise.gauss(0, sigma))
        yield [start + t, lat, lon, 100.0, 0.5, 0.5, 1.0]
        x, v = x + 0.5 * v + 0.125 * a, max(0.0, v + 0.5 * a)


def write_hdf5(path, journeys):
    """Groups of groups of columns, by the C library: Python has no module of its own for it."""
    name = ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5")
    if name is None:
        raise unittest.SkipTest("no HDF5 library")
    h5 = ctypes.CDLL(name)
    h5.H5open()
    double = ctypes.c_int64.in_dll(h5, "H5T_NATIVE_DOUBLE_g")
    i64, zero = ctypes.c_int64, ctypes.c_int64(0)
    for function in ("H5Fcreate", "H5Gcreate2", "H5Screate_simple", "H5Dcreate2"):
        getattr(h5, function).restype = i64
    file = i64(h5.H5Fcreate(str(path).encode(), ctypes.c_uint(2), zero, zero))
    for journey, groups in journeys.items():
        outer = i64(h5.H5Gcreate2(file, journey.encode(), zero, zero, zero))
        for group, columns in groups.items():
            inner = i64(h5.H5Gcreate2(outer, group.encode(), zero, zero, zero))
            for column, values in columns.items():
                space = i64(h5.H5Screate_simple(1, (ctypes.c_uint64 * 1)(len(values)), None))
                data = i64(h5.H5Dcreate2(inner, column.encode(), double, space, zero, zero, zero))
                h5.H5Dwrite(data, double, zero, zero, zero, (ctypes.c_double * len(values))(*values))
                h5.H5Dclose(data), h5.H5Sclose(space)
            h5.H5Gclose(inner)
        h5.H5Gclose(outer)
    h5.H5Fclose(file)


HEAD = ["time_s", "latitude_deg", "longitude_deg", "height_m", "sigma_north_m", "sigma_east_m", "sigma_up_m"]
JOB = """job = "georef"
recordings = ["ride.csv"]
[network]
file = "network.geojson"
"""


class Railway(Case):
    def setUp(self):
        super().setUp()
        (self.folder / "network.geojson").write_text(network(TRACKS.items()))
        self.ride("ride.csv", fixes())
        (self.folder / "job.toml").write_text(JOB)

    def ride(self, name, rows):
        self.write_table(name, HEAD, ([*r] for r in rows))

    def write_table(self, name, head, rows):
        lines = [",".join(head)] + [",".join(f"{x:.14g}" for x in row) for row in rows]
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def index(self):
        return json.loads((self.folder / "job.result/georef.json").read_text())

    def georef(self, *arguments, code=0):
        done = self.versine("georef", "job.toml", *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stderr

    def tracks(self, recording=0, journey=0):
        return [t["id"] for t in self.index()["recordings"][recording]["journeys"][journey]["paths"][0]["tracks"]]


class Result(Railway):
    def test_folder_is_whole_and_path_is_right(self):
        self.georef()
        result = self.folder / "job.result"
        for name in ("georef.json", "network.geojson", "positions.csv", "fixes.csv", "paths.csv", "switches.csv",
                     "georef.h5", "result.gpkg", "run.json"):
            self.assertTrue((result / name).exists(), name)
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])
        self.assertEqual(self.index()["format"], "versine-georef 1")
        with open(result / "positions.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        distance = [float(r["path_distance_m"]) for r in rows]
        self.assertEqual(distance, sorted(distance))
        # 20 s of standing, 30 s to 15 m/s (225 m), then steady: at 80 s 60 + 225 + 450 m.
        at = [r for r in rows if abs(float(r["time_s"]) - 1080.0) < 0.3][0]
        self.assertLess(abs(float(at["path_distance_m"]) - 735.0), 8.0)
        run = json.loads((result / "run.json").read_text())
        self.assertEqual([len(f["sha256"]) for f in run["inputs"]], [64, 64, 64])

    def test_recording_in_two_files_with_other_columns(self):
        self.write_table("gps.csv", ["t", "y", "x", "h"], (r[:4] for r in fixes()))
        self.write_table("speed.csv", ["time_s", "speed_mps"],
                         ([1000.0 + t, 0.0 if t < 20 else min(15.0, 0.5 * (t - 20))] for t in range(0, 100)))
        (self.folder / "job.toml").write_text(JOB.replace('recordings = ["ride.csv"]\n', "") + """
[[recording]]
name = "both"
[recording.gnss]
file = "gps.csv"
columns = { time_s = "t", latitude_deg = "y", longitude_deg = "x", height_m = "h" }
sigma_horizontal_m = 0.5
sigma_vertical_m = 1.0
[recording.speed]
file = "speed.csv"
""")
        self.georef()
        self.assertEqual(self.index()["recordings"][0]["name"], "both")
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])
        self.assertIn("100 speeds", self.good("check", "job.toml"))

    def test_threads_give_the_same(self):
        self.ride("other.csv", fixes(seed=2, side=lambda x: 0.0))
        for n in ("1", "2"):
            self.georef("--threads", n, "-o", f"r{n}", "--set", 'recordings=["ride.csv", "other.csv"]')
        self.assertEqual((self.folder / "r1/georef.json").read_bytes(), (self.folder / "r2/georef.json").read_bytes())

    def test_gap_splits_and_says_so(self):
        self.ride("ride.csv", list(fixes()) + list(fixes(start=3000.0, seed=3)))
        self.georef()
        recording = self.index()["recordings"][0]
        self.assertEqual(len(recording["journeys"]), 2)

    def test_halt_is_a_journey_s_end_only_when_asked_for(self):
        """A halt of 20 s, then on in the same direction; a reversal always ends a journey."""
        first = list(fixes(sigma=0.1))
        shift = first[-1][2] - first[0][2]
        onward = [[r[0], r[1], r[2] + shift, *r[3:]]
                  for r in fixes(start=1160.0, seed=5, side=lambda x: 8.0, sigma=0.1)]
        (self.folder / "network.geojson").write_text(network([("L", straight(0, 6000, 4, 4))]))
        self.ride("ride.csv", first + onward)
        self.georef()
        self.assertEqual(len(self.index()["recordings"][0]["journeys"]), 1)
        self.georef("--set", "journeys.every_stop=true")
        self.assertEqual(len(self.index()["recordings"][0]["journeys"]), 2)
        back = [[1160.0 + 0.5 * k, *r[1:]] for k, r in enumerate(reversed(first))]
        self.ride("ride.csv", first + back)
        self.georef()
        self.assertEqual(len(self.index()["recordings"][0]["journeys"]), 2)

    def test_hole_in_the_map_splits_and_says_so(self):
        cut = dict(TRACKS, A1=straight(0, 330, 0, 0), B1=straight(0, 330, 8, 8))
        (self.folder / "network.geojson").write_text(network(cut.items()))
        self.ride("ride.csv", fixes(side=lambda x: 8.0))
        self.georef()
        kinds = [f["kind"] for f in self.index()["recordings"][0]["findings"]]
        self.assertIn("no way on the map", kinds)
        self.assertGreaterEqual(len(self.index()["recordings"][0]["journeys"]), 1)


class Constraints(Railway):
    def constrain(self, text):
        (self.folder / "review.toml").write_text(text)
        return self.versine("georef", "job.toml", "--set", 'constraints="review.toml"')

    def test_chosen_and_forbidden(self):
        done = self.constrain('[[constraint]]\nfrom_s = 990\nto_s = 1200\ntracks = ["X"]\nexcluded = true\n')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("X", self.tracks())
        done = self.constrain('[[constraint]]\nrecording = "ride.csv"\nfrom_s = 990\nto_s = 1200\n'
                              'tracks = ["A1", "A2", "A3"]\n')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.tracks(), ["A1", "A2", "A3"])
        done = self.constrain('[[constraint]]\nrecording = "another.csv"\nfrom_s = 990\nto_s = 1200\ntracks = ["A1"]\n')
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])

    def test_unknown_track_is_refused(self):
        done = self.constrain('[[constraint]]\nfrom_s = 990\nto_s = 1200\ntracks = ["A9"]\n')
        self.assertEqual(done.returncode, 2)
        for text in ("review.toml", "A9", "not on the map"):
            self.assertIn(text, done.stderr)


class BadInput(Railway):
    def two(self):
        return self.versine("georef", "job.toml", "--set", 'recordings=["bad.csv", "ride.csv"]')

    def rest_is_there(self, done, *says):
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        recordings = self.index()["recordings"]
        self.assertIn("error", recordings[0])
        self.assertEqual(self.tracks(recording=1), ["A1", "X", "B3"])

    def test_outside_the_map(self):
        self.ride("bad.csv", fixes(east=30000.0))
        self.rest_is_there(self.two(), "bad.csv", "no track")

    def test_swapped_coordinates(self):
        self.ride("bad.csv", ([r[0], r[2], r[1]] + r[3:] for r in fixes()))
        self.rest_is_there(self.two(), "bad.csv", "exchanged")

    def test_letters_in_a_number(self):
        self.ride("bad.csv", fixes())
        self.edit("bad.csv", lambda text: text.replace("\n1005,", "\n10o5,"))
        self.rest_is_there(self.two(), "bad.csv:12")

    def test_absent_file(self):
        self.rest_is_there(self.two(), "bad.csv")

    def findings(self):
        self.georef()
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])
        return self.index()["recordings"][0]["findings"]

    def test_standing_clock(self):
        rows = list(fixes())
        for r in rows[100:110]:
            r[0] = rows[99][0]
        self.ride("ride.csv", rows)
        found = [f for f in self.findings() if f["kind"] == "standing clock"]
        self.assertEqual([f["count"] for f in found], [10])
        self.assertIn("record 101", found[0]["detail"])

    def test_time_running_backwards(self):
        rows = list(fixes())
        for r in rows[150:156]:
            r[0] -= 50.0
        self.ride("ride.csv", rows)
        found = [f for f in self.findings() if f["kind"] == "time running backwards"]
        self.assertEqual([f["count"] for f in found], [6])
        self.assertIn("record 151", found[0]["detail"])

    def test_hdf5_with_missing_groups(self):
        good = [[r[k] for r in fixes()] for k in (0, 2, 1, 4)]
        gnss = dict(zip(("times", "lon", "lat", "accuracy_horizontal"), good))
        short = {**gnss, "lat": gnss["lat"][:-7]}
        imu = {"times": gnss["times"], "acc_x": gnss["lat"]}
        write_hdf5(self.folder / "bad.h5", {"journey_01": {"IMU": imu}, "journey_02": {"GNSS": gnss},
                                            "journey_03": {"GNSS": gnss, "IMU": imu}, "journey_04": {"GNSS": short}})
        done = self.versine("georef", "job.toml", "--set", 'recordings=["bad.h5", "ride.csv"]')
        self.assertEqual(done.returncode, 1, done.stderr)
        for text in ("bad.h5", "journey_01/GNSS", "journey_03/IMU/acc_y", "journey_04/GNSS/lat"):
            self.assertIn(text, done.stderr)
        self.assertEqual([r["name"] for r in self.index()["recordings"]], ["bad.h5:journey_02", "ride.csv"])
        self.assertEqual([self.tracks(recording=k) for k in (0, 1)], 2 * [["A1", "X", "B3"]])

    def test_degrees_without_crs(self):
        text = "".join("{},\"LINESTRING({})\"\n".format(k, ",".join("{1:.9f} {0:.9f}".format(*degrees(*p)) for p in v))
                       for k, v in TRACKS.items())
        (self.folder / "network.csv").write_text("id,WKT\n" + text)
        self.refused("georef", "job.toml", "--set", 'network.file="network.csv"',
                     says=["network.csv", "degrees", "source_crs"])
        self.georef("--set", 'network.file="network.csv"', "--set", 'network.source_crs="EPSG:4326"')
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])

    def test_zero_length_and_duplicate_tracks(self):
        tracks = list(TRACKS.items()) + [("N", [(500, 50), (500, 50)]), ("B1", TRACKS["B1"]), ("A1", straight(0, 99, 90, 90))]
        (self.folder / "network.geojson").write_text(network(tracks))
        self.georef()
        self.assertEqual(self.tracks(), ["A1", "X", "B3"])
        warnings = " ".join(self.index()["network"]["warnings"])
        for text in ("record 8 ('N')", "zero length", "record 9 ('B1')", "repeats", "record 10 ('A1')", "renamed"):
            self.assertIn(text, warnings)

    def test_broken_network(self):
        (self.folder / "network.geojson").write_text('{"type": "FeatureCollection", "features": [{"type": "Feature", ')
        self.refused("georef", "job.toml", says=["network.geojson", "JSON"])


class Check(Railway):
    def test_network_check_as_table_and_geojson(self):
        tracks = list(TRACKS.items()) + [("twin", [(x, y + 0.2) for x, y in TRACKS["B3"]])]
        (self.folder / "network.geojson").write_text(network(tracks))
        text = self.good("network", "check", "network.geojson", "--geojson", "check.geojson")
        self.assertIn("duplicated track", text)
        features = json.loads((self.folder / "check.geojson").read_text())["features"]
        self.assertIn("dead end", {f["properties"]["kind"] for f in features})

    def test_keys_page_is_what_the_program_says(self):
        page = SOURCE / "docs" / "job-georef.md"
        self.assertEqual(page.read_text(), self.good("init", "georef", "--keys"),
                         "run: versine init georef --keys > docs/job-georef.md")

    def test_template_and_check(self):
        (self.folder / "new.toml").write_text(self.good("init", "georef"))
        self.assertIn("recordings: found nothing", self.versine("check", "new.toml").stderr)  # all else is right
        self.assertIn("320 fixes", self.good("check", "job.toml"))

    def test_no_recording(self):
        self.edit("job.toml", lambda text: text.replace('["ride.csv"]', "[]"))
        self.refused("georef", "job.toml", says=["recordings", "[[recording]]"])


if __name__ == "__main__":
    unittest.main()
