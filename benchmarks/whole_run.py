#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whole runs, from text files to written results: seconds, IMU samples a second, peak memory.

    benchmarks/whole_run.py [HOURS ...] [--program build/release/apps/versine/versine] [--rate HZ]

Simulates a ride of each length once (kept in out/benchmark), then runs `versine survey` on it three times under
/usr/bin/time and prints the median. --rate is that of the written trajectory; 0 writes every IMU sample.
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
parser = argparse.ArgumentParser()
parser.add_argument("hours", nargs="*", type=float, default=[1.0])
parser.add_argument("--program", default=str(ROOT / "build/release/apps/versine/versine"))
parser.add_argument("--rate", type=float, default=10.0)
arguments = parser.parse_args()


def must(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done


def recording(hours):
    folder = ROOT / "out" / "benchmark" / f"{hours:g}h"
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        scenario = (ROOT / "benchmarks/scenarios/line.toml").read_text()
        metres = 10.0 * (3600.0 * hours - 320.0)
        path = folder.parent / f"{hours:g}h.toml"
        path.write_text(scenario.replace("to_m = 29000.0", f"to_m = {metres:.1f}"))
        must([arguments.program, "simulate", path, "-o", folder])
    return folder


print("| hours | IMU samples | seconds | samples/s | peak memory, MiB | CPU seconds |\n| --- | --- | --- | --- | --- | --- |")
for hours in arguments.hours:
    folder = recording(hours)
    seconds, memory, cpu = [], [], []
    for _ in range(3):
        done = must(["/usr/bin/time", "-v", arguments.program, "survey", folder / "survey.toml", "--json", "-o",
                     folder / "result", "--set", f"output.rate_hz={arguments.rate}"])
        wall = re.search(r"Elapsed.*: (?:(\d+):)?(\d+):([\d.]+)", done.stderr)
        seconds.append(3600 * int(wall[1] or 0) + 60 * int(wall[2]) + float(wall[3]))
        memory.append(int(re.search(r"Maximum resident.*: (\d+)", done.stderr)[1]) / 1024)
        cpu.append(sum(float(x) for x in re.findall(r"(?:User|System) time.*: ([\d.]+)", done.stderr)))
    samples = round(json.loads(done.stdout)["duration_s"] * 200)
    median = statistics.median(seconds)
    print(f"| {hours:g} | {samples:,} | {median:.2f} | {samples / median:,.0f} | {statistics.median(memory):.0f} | "
          f"{statistics.median(cpu):.2f} |", flush=True)
