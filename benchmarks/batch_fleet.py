#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A fleet's journeys through `versine batch`: seconds, processor time, memory, catalogue.

    benchmarks/batch_fleet.py [--recordings 60] [--journeys 100] [--threads 2] [--build build/release]

Generates the recordings once (out/fleet-60x100, 100 Hz IMU and 5 Hz GNSS), then plans, runs, merges and asks. Needs a
build with -DVERSINE_BENCHMARKS=ON.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
parser = argparse.ArgumentParser()
parser.add_argument("--recordings", type=int, default=60)
parser.add_argument("--journeys", type=int, default=100)
parser.add_argument("--threads", type=int, default=2)
parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
arguments = parser.parse_args()
VERSINE = (arguments.build / "apps/versine/versine").resolve()
FOLDER = ROOT / "out" / f"fleet-{arguments.recordings}x{arguments.journeys}"


def must(command):
    """Runs under /usr/bin/time; gives output, wall seconds, processor seconds, MiB of the largest process."""
    begin = time.monotonic()
    done = subprocess.run(["/usr/bin/time", "-v", *map(str, command)], capture_output=True, text=True, cwd=FOLDER,
                          env={**os.environ, "VERSINE_STORE": str(FOLDER / "store")})
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    cpu = sum(float(x) for x in re.findall(r"(?:User|System) time.*: ([\d.]+)", done.stderr))
    memory = int(re.search(r"Maximum resident.*: (\d+)", done.stderr)[1]) / 1024
    return done.stdout, time.monotonic() - begin, cpu, memory


FOLDER.mkdir(parents=True, exist_ok=True)
if not (FOLDER / "made").exists():
    made, *_ = must([arguments.build.resolve() / "benchmarks/versine_fleet", FOLDER, arguments.recordings,
                     arguments.journeys])
    (FOLDER / "made").write_text(made)
    (FOLDER / "fleet.toml").write_text('[network]\nfile = "network.geojson"\n')
shutil.rmtree(FOLDER / "store", ignore_errors=True)
print((FOLDER / "made").read_text().strip())
size = sum(p.stat().st_size for p in (FOLDER / "recordings").iterdir())
print(f"{size / 2**20:.0f} MiB of recordings, {arguments.threads} worker processes\n")
print("| step | wall, s | processor, s | largest process, MiB |\n| --- | --- | --- | --- |")
steps = {
    "plan": ["plan", "--quiet", "--inputs", "recordings", "--config", "fleet.toml", "--shards", arguments.threads],
    "run": ["run", "--quiet", "--threads", arguments.threads],
    "merge": ["merge", "--quiet", "--out", "catalogue.sqlite"],
    "verify": ["verify", "--quiet"],
}
for name, command in steps.items():
    _, wall, cpu, memory = must([VERSINE, "batch", *command])
    print(f"| {name} | {wall:.1f} | {cpu:.1f} | {memory:.0f} |", flush=True)
with sqlite3.connect(FOLDER / "catalogue.sqlite") as db:
    def one(sql):
        return db.execute(sql).fetchone()

    track, low, high, count = one("SELECT name, min(low_m), max(high_m), count(*) FROM pass "
                                  "JOIN track ON track.id = track_id GROUP BY name ORDER BY count(*) DESC LIMIT 1")
    found, wall, cpu, _ = must([VERSINE, "batch", "passes", "--json", "--catalogue", "catalogue.sqlite", "--track", track,
                                "--at", (low + high) / 2])
    print(f"| passes ({len(json.loads(found))} found) | {wall:.2f} | {cpu:.2f} | |")
    journeys, hours = one("SELECT count(*), sum(to_ns - from_ns) / 3.6e12 FROM journey")
    sure = one("SELECT avg(probability > 0.9) FROM journey")[0]
    passes = one("SELECT count(*) FROM pass")[0]
driven = arguments.recordings * arguments.journeys
print(f"\n{journeys} journeys of {driven} driven, {hours:.1f} h of them; {100 * sure:.1f} % with a path of more than 0.9; {passes} passes; "
      f"catalogue {(FOLDER / 'catalogue.sqlite').stat().st_size / 2**20:.1f} MiB, store "
      f"{sum(p.stat().st_size for p in (FOLDER / 'store').rglob('*') if p.is_file()) / 2**20:.0f} MiB")
sys.exit(journeys != driven)
