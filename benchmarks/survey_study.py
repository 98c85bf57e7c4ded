#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error and coverage of simulated surveys over many seeds.

    benchmarks/survey_study.py SCENARIO [--seeds 1-20] [--set KEY=VALUE ...] [--simulate KEY=VALUE ...]

Simulates the scenario once for each seed (kept in out/study), runs `versine survey` on the job that comes with the
recording, compares with the truth, and prints RMS and coverage of the 95 % interval pooled over the seeds, with the
mean normalised innovation of each sensor. --set goes to the survey, --simulate to the simulation.
"""
import argparse
import hashlib
import json
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
parser = argparse.ArgumentParser()
parser.add_argument("scenario", type=pathlib.Path)
parser.add_argument("--seeds", default="1-20")
parser.add_argument("--set", action="append", default=[])
parser.add_argument("--simulate", action="append", default=[])
parser.add_argument("--program", default=str(ROOT / "build/release/apps/versine/versine"))
arguments = parser.parse_args()
first, last = (int(x) for x in (arguments.seeds + "-" + arguments.seeds).split("-")[:2])


def must(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def options(values):
    return [x for value in values for x in ("--set", value)]


def recording(seed):
    key = hashlib.sha1(" ".join(arguments.simulate).encode()).hexdigest()[:6] if arguments.simulate else "plain"
    folder = ROOT / "out" / "study" / f"{arguments.scenario.stem}-{key}-{seed}"
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        must([arguments.program, "simulate", arguments.scenario, "-o", folder, *options([f"seed={seed}"]),
              *options(arguments.simulate)])
    # The job without track geometry: only the navigation is compared.
    text = (folder / "survey.toml").read_text().split("\n[geometry]")[0] + "\n"
    (folder / "navigation.toml").write_text(text)
    return folder


squares, coverage, ratio, nis, names = {}, {}, {}, {}, ("along", "across", "up", "roll", "pitch", "heading")
for seed in range(first, last + 1):
    folder = recording(seed)
    result = folder.parent / "result"
    summary = json.loads(must([arguments.program, "survey", folder / "navigation.toml", "--json", "-o", result,
                               *options(["output.innovations=false", "output.csv=false"]),
                               *options(arguments.set)]))
    compared = json.loads(must([arguments.program, "compare", result, folder / "truth_trajectory.csv", "--json"]))
    for name in names:
        squares.setdefault(name, []).append(compared[name]["rms"] ** 2)
        ratio.setdefault(name, []).append(compared[name]["rms_in_sigmas"] ** 2)
        coverage.setdefault(name, []).append(compared[name]["coverage95"])
    for sensor in summary["innovations"]:
        nis.setdefault(sensor["sensor"], []).append(sensor["mean_nis_per_row"])

runs = last - first + 1
print(f"{arguments.scenario.stem}, seeds {arguments.seeds}{''.join(', ' + s for s in arguments.set)}")
for name in names:
    rms = math.sqrt(sum(squares[name]) / runs)
    print(f"  {name:<8} {rms:8.3f} {'mm    ' if name in names[:3] else 'arcsec'}  95 % interval covers {100 * sum(coverage[name]) / runs:6.2f} %"
          f"  error / sigma {math.sqrt(sum(ratio[name]) / runs):.2f}")
print("  innovations: " + ", ".join(f"{k} {sum(v) / len(v):.2f}" for k, v in sorted(nis.items())))
