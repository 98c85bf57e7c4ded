# SPDX-License-Identifier: Apache-2.0
"""versine batch: every failure of docs/batch.md ends with the catalogue of a serial run, an empty tmp/ after gc, and a
verify that finds nothing."""
import json
import math
import os
import pathlib
import random
import resource
import signal
import sqlite3
import subprocess
import tempfile
import time
import unittest

from support import VERSINE

EAST = 111320.0 * math.cos(math.radians(48.0))
LENGTH = 9000.0  # of the track, m
SPEED = 20.0


def write_recording(path, seed, start, seconds=150):
    """20 m/s eastwards from metre 500 + 10 seed, after 10 s of standing; GNSS at 1 Hz with 0.5 m of noise."""
    noise = random.Random(seed)
    rows = ["time_s,latitude_deg,longitude_deg,height_m,sigma_north_m,sigma_east_m,sigma_down_m"]
    for k in range(seconds):
        t = max(0.0, k - 10.0)
        x = 500.0 + 10.0 * seed + (0.5 * t * t if t < SPEED else 0.5 * SPEED * SPEED + SPEED * (t - SPEED))
        rows.append(f"{start + k:.1f},{48.0 + noise.gauss(0, 0.3) / 111200.0:.9f},"
                    f"{11.0 + (x + noise.gauss(0, 0.3)) / EAST:.9f},300,0.5,0.5,1")
    path.write_text("\n".join(rows) + "\n")


def make_fleet(folder, count):
    lines = [[[11.0, 48.0], [11.0 + LENGTH / EAST, 48.0]], [[11.0, 48.0005], [11.0 + LENGTH / EAST, 48.0005]]]
    features = [{"type": "Feature", "properties": {"id": f"T{i + 1}"},
                 "geometry": {"type": "LineString", "coordinates": line}} for i, line in enumerate(lines)]
    (folder / "network.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    (folder / "fleet.toml").write_text('[network]\nfile = "network.geojson"\n')
    (folder / "recordings").mkdir()
    for i in range(count):
        write_recording(folder / "recordings" / f"vehicle_{i:02}.csv", i, 1000.0 + 1000.0 * i, 140 + i)
    (folder / "recordings" / "broken.csv").write_text("time_s,latitude_deg,longitude_deg\n1,here,there\n")


class Store(unittest.TestCase):
    COUNT = 40

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        make_fleet(cls.folder, cls.COUNT)
        cls.serial = cls.catalogue_of(cls.folder / "serial", "--threads", "1")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def call(cls, store, verb, *arguments, **environment):
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("VERSINE_S", "VERSINE_M", "SLURM_"))}
        clean.update(environment, VERSINE_STORE=str(store))
        return subprocess.run([VERSINE, "batch", verb, *map(str, arguments)], cwd=cls.folder, env=clean,
                              capture_output=True, text=True, timeout=120)

    @classmethod
    def plan(cls, store, shards=1):
        done = cls.call(store, "plan", "--inputs", "recordings", "--config", "fleet.toml", "--shards", shards)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    @classmethod
    def start(cls, store, *arguments, **keywords):
        return subprocess.Popen([VERSINE, "batch", "run", "--store", str(store), *arguments], cwd=cls.folder,
                                stderr=subprocess.DEVNULL, **keywords)

    @classmethod
    def catalogue_of(cls, store, *arguments):
        cls.plan(store)
        done = cls.call(store, "run", *arguments)
        assert done.returncode == 0, done.stderr
        return cls.merged(store)

    @classmethod
    def merged(cls, store):
        out = store.parent / (store.name + ".sqlite")
        done = cls.call(store, "merge", "--out", out)
        assert done.returncode == 0, done.stderr
        return out.read_bytes()

    def receipts(self, store):
        return len(list((store / "receipts").glob("*/*.json")))

    def wait_for(self, store, count, process):
        for _ in range(2000):
            if self.receipts(store) >= count or process.poll() is not None:
                return
            time.sleep(0.002)

    def assert_as_serial(self, store):
        """What every failure must end with."""
        self.assertEqual(self.call(store, "run", "--missing").returncode, 0)
        self.assertEqual(self.call(store, "gc", "--older", "0").returncode, 0)
        self.assertEqual(list((store / "tmp").iterdir()), [])
        done = self.call(store, "verify")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(self.merged(store) == self.serial, "the catalogue differs from the serial run's")

    def store(self, plan=True):
        store = self.folder / self.id().rsplit(".", 1)[-1]
        if plan:
            self.plan(store)
        return store


class Batch(Store):
    def test_any_number_of_processes_and_shards(self):
        store = self.store(plan=False)
        self.plan(store, shards=3)
        for shard in (2, 0):
            done = self.call(store, "run", VERSINE_SHARD=str(shard))
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.call(store, "status").returncode, 2)
        self.assertEqual(self.call(store, "merge", "--out", store / "x.sqlite").returncode, 2)
        self.assertFalse((store / "x.sqlite").exists())
        self.assertEqual(self.call(store, "merge", "--partial", "--out", store / "x.sqlite").returncode, 0)
        self.assertEqual(self.call(store, "run", SLURM_ARRAY_TASK_ID="1").returncode, 0)
        status = self.call(store, "status", "--json")
        self.assertEqual(status.returncode, 3)  # complete, with the broken one rejected
        told = json.loads(status.stdout)
        self.assertEqual((told["done"], told["rejected"], told["open"]), (self.COUNT, 1, 0))
        self.assertEqual(self.call(store, "run", "--strict").returncode, 3)
        other = self.folder / "two"
        self.assertTrue(self.catalogue_of(other, "--threads", "2") == self.serial)

    def test_killed_ten_times(self):
        store = self.store()
        chance = random.Random(6)
        kills = 0
        while kills < 10:
            done = sorted((store / "receipts").glob("*/*.json"))
            if len(done) > self.COUNT - 6:  # a fast machine: open some of them again
                for path in chance.sample(done, 30):
                    path.unlink()
            before = self.receipts(store)
            process = self.start(store, "--threads", "2", start_new_session=True)
            if kills % 2 == 0:
                self.wait_for(store, before + 1, process)
            time.sleep(chance.uniform(0.0, 0.03 if kills % 2 == 0 else 0.1))
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
        self.assert_as_serial(store)

    def test_worker_killed_alone(self):
        """A killed worker's unit is left open; the run says 75 and the next one does it."""
        store = self.store()
        process = self.start(store, "--threads", "2")
        self.wait_for(store, 2, process)
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(int(children[0]), signal.SIGKILL)
        self.assertEqual(process.wait(), 75)
        self.assert_as_serial(store)

    def test_store_full(self):
        store = self.store()

        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

        process = self.start(store, preexec_fn=small_files)
        self.assertEqual(process.wait(), 75)
        process = self.start(store, preexec_fn=small_files, env={**os.environ, "VERSINE_ATTEMPT": "5"})
        self.assertEqual(process.wait(), 1)
        self.assert_as_serial(store)

    def test_disk_full(self):
        """A real file system of 600 kB, then a larger one."""
        store = self.store()
        script = ('mount -t tmpfs -o size=600k none "$1" && cp -a "$2/." "$1/" || exit 99; '
                  '"$0" batch run --store "$1" --threads 2; a=$?; mount -o remount,size=50m "$1" || exit 99; '
                  '"$0" batch run --store "$1"; b=$?; cp -a "$1/." "$2/"; echo "$a $b"')
        mount = self.folder / "mount"
        mount.mkdir()
        done = subprocess.run(["unshare", "-Urm", "sh", "-c", script, VERSINE, mount, store], capture_output=True,
                              text=True)
        if done.returncode != 0:
            self.skipTest("no user namespaces here: " + done.stderr)
        self.assertEqual(done.stdout.split(), ["75", "0"], done.stderr)
        self.assert_as_serial(store)

    def test_duplicate_worker(self):
        store = self.store()
        pair = [self.start(store, "--threads", "1") for _ in range(2)]
        self.assertEqual([p.wait() for p in pair], [0, 0])
        self.assert_as_serial(store)

    def test_straggler_beside_a_sweep(self):
        store = self.store()
        slow = self.start(store, "--threads", "1")
        self.wait_for(store, 3, slow)
        slow.send_signal(signal.SIGSTOP)  # in the middle of a unit
        self.assertLess(self.receipts(store), self.COUNT)
        self.assertEqual(self.call(store, "run", "--missing", "--shards", 2, "--shard", 0).returncode, 0)
        self.assertEqual(self.call(store, "run", "--missing", "--shards", 2, "--shard", 1).returncode, 0)
        self.assertNotEqual(self.call(store, "status").returncode, 2)
        slow.send_signal(signal.SIGCONT)
        self.assertEqual(slow.wait(), 0)
        self.assert_as_serial(store)

    def test_flipped_byte(self):
        store = self.store()
        self.assertEqual(self.call(store, "run").returncode, 0)

        def flip(path):
            data = bytearray(path.read_bytes())
            data[len(data) // 2] ^= 1
            path.write_bytes(data)

        flip(sorted((store / "objects").glob("*/*"))[3])
        flip(sorted((store / "receipts").glob("*/*"))[5])
        done = self.call(store, "verify")
        self.assertEqual(done.returncode, 2)
        self.assertIn("withdrawn", done.stdout)
        self.assertEqual(self.call(store, "status").returncode, 2)
        self.assert_as_serial(store)

    def test_changed_input(self):
        store = self.store()
        path = self.folder / "recordings" / "vehicle_07.csv"
        good = path.read_text()
        try:
            path.write_text(good.replace("300", "301"))
            done = self.call(store, "run")
            self.assertEqual(done.returncode, 65)
            self.assertIn("vehicle_07.csv", done.stderr)
            self.assertEqual(self.receipts(store), self.COUNT)  # the rest is done
        finally:
            path.write_text(good)
        self.assert_as_serial(store)

    def test_changed_map_and_manifest(self):
        store = self.store()
        path = self.folder / "network.geojson"
        good = path.read_text()
        try:
            path.write_text(good.replace("T1", "T9"))
            self.assertEqual(self.call(store, "run").returncode, 78)
        finally:
            path.write_text(good)
        self.assert_as_serial(store)
        units = next((store / "manifests").glob("*/units.jsonl"))
        units.write_text(units.read_text().replace('"shard":0', '"shard":1', 1))
        self.assertEqual(self.call(store, "run").returncode, 65)

    def test_sigterm(self):
        store = self.store()
        for threads in ("1", "2"):
            before = self.receipts(store)
            process = self.start(store, "--threads", threads)
            self.wait_for(store, before + 2, process)
            process.terminate()
            self.assertEqual(process.wait(), 75)
        self.assertLess(self.receipts(store), self.COUNT)
        self.assert_as_serial(store)

    def test_usage(self):
        store = self.store()
        self.assertEqual(self.call(store, "run", "--shard", 1, "--shards", 2).returncode, 64)
        self.assertEqual(self.call(store, "run", "--bogus").returncode, 64)
        done = self.call(store, "run", VERSINE_SHARD="two")
        self.assertEqual(done.returncode, 64)
        self.assertIn("VERSINE_SHARD: found 'two'", done.stderr)
        self.assertEqual(self.receipts(store), 0)
        self.assertEqual(self.call(store, "run", "--manifest", "ffff").returncode, 64)
        self.assertEqual(self.call(self.folder / "nowhere", "status").returncode, 64)
        self.assertEqual(self.call(store, "plan", "--inputs", "network.geojson", "--config", "none.toml").returncode, 64)

    def test_catalogue_and_passes(self):
        path = self.folder / "serial.sqlite"
        with sqlite3.connect(path) as db:
            self.assertEqual(db.execute("SELECT count(*) FROM journey").fetchone()[0], self.COUNT)
            found, uri = db.execute("SELECT found, uri FROM failure JOIN file USING(unit_id)").fetchone()
            self.assertTrue(found and uri.endswith("broken.csv"))
            self.assertNotIn(str(self.folder), found)
        done = self.call(self.folder / "serial", "passes", "--catalogue", path, "--track", "T1", "--at", "2000", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        passes = json.loads(done.stdout)
        self.assertEqual(len(passes), self.COUNT)
        for i, p in enumerate(passes):
            # Truth: standing until 10 s, 20 s of 1 m/s^2, then 20 m/s; the track's metres are those of the ground.
            metre = 2000.0 / (LENGTH_ON_GROUND / LENGTH)
            t = 1000.0 + 1000.0 * i + 30.0 + (metre - 500.0 - 10.0 * i - 200.0) / SPEED
            self.assertLess(abs(p["time_ns"] * 1e-9 - t), 0.15)
            self.assertLess(abs(p["speed_mps"] - SPEED), 0.3)
        late = self.call(self.folder / "serial", "passes", "--catalogue", path, "--track", "T1", "--at", "2000",
                         "--from", 20000)
        self.assertEqual(len(late.stdout.splitlines()), 1 + sum(p["time_ns"] > 20000e9 for p in passes))
        self.assertEqual(self.call(self.folder, "passes", "--catalogue", path, "--track", "T7", "--at", 1).returncode, 64)


class Companions(Store):
    """Constraints and monitoring files of single recordings: a file beside each, its name and .toml."""
    COUNT = 3

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        network = cls.folder / "network.geojson"
        network.write_text(network.read_text().replace("48.0005", "48.00004"))  # 4.4 m apart: either may be
        rows = [f"{1030 + k / 200.0:.3f},{(k % 10) - 4.5}" for k in range(200 * 60)]
        (cls.folder / "recordings" / "axlebox.csv").write_text("t,left\n" + "\n".join(rows) + "\n")
        monitoring = '[[monitoring]]\nfile = "axlebox.csv"\nchannels = ["left"]\ntimes = "t"\n'
        (cls.folder / "recordings" / "vehicle_00.csv.toml").write_text(monitoring)
        (cls.folder / "recordings" / "vehicle_01.csv.toml").write_text(
            '[[constraint]]\nfrom_s = 0\nto_s = 1e6\ntracks = ["T2"]\n')
        (cls.folder / "recordings" / "vehicle_02.csv.toml").write_text(monitoring)  # of another time
        cls.serial = cls.catalogue_of(cls.folder / "again", "--threads", "1")

    def test_each_is_used_for_its_recording_only(self):
        with sqlite3.connect(self.folder / "again.sqlite") as db:
            path = dict(db.execute("SELECT uri, path FROM journey JOIN file USING(unit_id) WHERE uri LIKE '%vehicle%csv'"))
            tracks = {pathlib.Path(uri).name: tracks for uri, tracks in path.items()}
            self.assertEqual(tracks, {"vehicle_00.csv": "+T1", "vehicle_01.csv": "+T2", "vehicle_02.csv": "+T1"})
            uris = [pathlib.Path(u).name for u, in db.execute("SELECT uri FROM file WHERE unit_id IN (SELECT unit_id "
                                                              "FROM output WHERE name = 'monitoring_1')")]
            self.assertEqual(sorted(uris), ["axlebox.csv", "vehicle_00.csv", "vehicle_00.csv.toml"])
            digest, = db.execute("SELECT sha256 FROM output WHERE name = 'monitoring_1'").fetchone()
            recording, found = db.execute("SELECT recording, found FROM failure WHERE field = 'times'").fetchone()
            self.assertEqual((recording, found), ("axlebox.csv", "samples from 1030.0 to 1090.0 s"))
        stamped = (self.folder / "again" / "objects" / digest[:2] / digest).read_bytes()
        self.assertTrue(stamped.startswith(b"\x89HDF"))

    def test_done_again_it_is_the_same(self):
        store = self.store()
        self.assertEqual(self.call(store, "run").returncode, 0)
        for path in (store / "receipts").glob("*/*.json"):
            path.unlink()
        time.sleep(1.1)  # another second: no time is in a result
        self.assert_as_serial(store)

    def test_another_companion_is_another_unit(self):
        store = self.store()
        path = self.folder / "recordings" / "vehicle_01.csv.toml"
        good = path.read_text()
        try:
            path.write_text(good.replace("T2", "T1"))
            self.assertEqual(self.call(store, "run").returncode, 65)
        finally:
            path.write_text(good)
        self.assert_as_serial(store)

    def test_unknown_track_is_told(self):
        store = self.store(plan=False)
        path = self.folder / "recordings" / "vehicle_01.csv.toml"
        good = path.read_text()
        try:
            path.write_text(good.replace("T2", "T9"))
            self.plan(store)
            self.assertEqual(self.call(store, "run").returncode, 0)
            self.merged(store)
            with sqlite3.connect(self.folder / "test_unknown_track_is_told.sqlite") as db:
                self.assertIn("'T9'", str(db.execute("SELECT found FROM failure").fetchall()))
        finally:
            path.write_text(good)

    def test_for_the_whole_fleet(self):
        job = self.folder / "closed.toml"
        text = '[network]\nfile = "network.geojson"\n[[constraint]]\nfrom_s = 0\nto_s = 1e6\ntracks = ["T1"]\nexcluded = true\n'
        job.write_text(text)
        store = self.store(plan=False)
        plan = ("plan", "--inputs", "recordings", "--config", "closed.toml")
        self.assertEqual(self.call(store, *plan).returncode, 0)
        self.assertEqual(self.call(store, "run").returncode, 0)
        self.merged(store)
        with sqlite3.connect(self.folder / "test_for_the_whole_fleet.sqlite") as db:
            self.assertEqual(db.execute("SELECT DISTINCT path FROM journey").fetchall(), [("+T2",)])
        job.write_text(text + 'recording = "vehicle_01.csv"\n')
        done = self.call(store, *plan)
        self.assertEqual(done.returncode, 64)
        self.assertIn("beside the recording", done.stderr)


# A degree of longitude at 48 degrees on WGS84: a cos(lat) / sqrt(1 - e^2 sin^2(lat)).
LENGTH_ON_GROUND = LENGTH / EAST * math.radians(1.0) * 6378137.0 * math.cos(math.radians(48.0)) / math.sqrt(
    1.0 - 0.00669437999 * math.sin(math.radians(48.0)) ** 2)

if __name__ == "__main__":
    unittest.main()
