#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Accuracy on real recordings: runs the jobs of examples/real and prints the tables of docs/accuracy.md.

    VERSINE_DATA=... benchmarks/accuracy_real.py build/release/apps/versine/versine

A GNSS fix inside a window is withheld from the filter and compared with the smoothed position at the antenna.
"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
JOBS = ROOT / "examples" / "real"
VERSINE = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/apps/versine/versine")
HEAD = ("| configuration | windows | fixes | horizontal RMS, m | 95 %, m | maximum, m | vertical RMS, m | "
        "coverage of 95 % |\n| --- | --- | --- | --- | --- | --- | --- | --- |")


def run(job, folder, *settings):
    """Runs a job with overrides and returns its summary."""
    command = [VERSINE, "survey", str(job), "--json", "-o", str(folder)]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads(done.stdout)


def row(label, summary):
    w = summary["withheld"]
    print(f"| {label} | {w['windows']} | {w['epochs']} | {w['rms_horizontal_m']:.3f} | {w['p95_horizontal_m']:.3f} | "
          f"{w['max_horizontal_m']:.3f} | {w['rms_vertical_m']:.3f} | {100 * w['coverage95']:.1f} % |")


def rtk_drive(folder):
    print("### Car with RTK and MEMS IMU: fixes withheld\n\n" + HEAD)
    for window in (10, 30, 60):
        for on, label in (("true", "with"), ("false", "without")):
            row(f"{window} s, {label} constraint",
                run(JOBS / "car-rtk-drive.toml", folder, f"withhold.window_s={window}", f"constraint.on={on}"))


def horizontal_drift(folder):
    with open(folder / "trajectory.csv", newline="") as file:
        rows = [(float(r["easting_m"]), float(r["northing_m"])) for r in csv.DictReader(line for line in file if line[0] != "#")]
    return max(math.dist(rows[0], r) for r in rows)


def ring_laser(folder):
    print("\n### Ring-laser IMU, standing for half an hour\n\n| quantity | value |\n| --- | --- |")
    job = JOBS / "ring-laser-static.toml"
    summary = run(job, folder)
    start = summary["segments"][0]
    for name in ("roll", "pitch", "heading"):
        print(f"| {name} | {start[name + '_deg']:.4f} deg |")
    print(f"| sigma of level, of heading | {start['sigma_level_deg']:.5f} deg, {start['sigma_heading_deg']:.4f} deg |")
    rate = summary["earth_rate"]
    print(f"| Earth rate recovered, total (15.041) | {rate['total_degph']:.3f} deg/h |")
    print(f"| Earth rate recovered, horizontal (12.434), vertical (8.464) | {rate['horizontal_degph']:.3f} deg/h, "
          f"{rate['vertical_degph']:.3f} deg/h |")
    print(f"| sigma of each | {rate['sigma_degph']:.3f} deg/h |")
    print(f"| largest horizontal drift with zero-velocity updates | {1000 * horizontal_drift(folder):.3f} mm |")
    used = {i["sensor"]: i for i in summary["innovations"]}["zero velocity"]
    print(f"| zero velocities used, rejected, mean NIS per row | {used['used']}, {used['rejected']}, "
          f"{used['mean_nis_per_row']:.2f} |")
    run(job, folder, "standstill.after_alignment=false")
    print(f"| largest horizontal drift, aligned for 300 s, then 1547 s of the IMU alone | {horizontal_drift(folder):.1f} m |")


def speedometer(folder):
    print("\n### Car with speedometer: 60 s of GNSS withheld\n\n" + HEAD)
    text = (JOBS / "car-speedometer.toml").read_text()
    alone = folder.parent / "without-speedometer.toml"
    alone.write_text(re.sub(r"\[speed\]\n(?:[^\[\n].*\n)*", "", text))
    windows = ("withhold.window_s=60", "withhold.every_s=80", "withhold.start_s=60")
    with_speed = run(JOBS / "car-speedometer.toml", folder, *windows)
    row("with speedometer and constraint", with_speed)
    row("with constraint only", run(alone, folder, *windows))
    scale = with_speed["sensor_errors_at_end"]["odometer_scale"]
    print(f"\nScale factor error of the speedometer: {scale['value']:+.4f}, sigma {scale['sigma']:.4f}.")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        result = pathlib.Path(scratch) / "result"
        rtk_drive(result)
        ring_laser(result)
        speedometer(result)
