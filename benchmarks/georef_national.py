#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a journey costs on a national network, against a small one: georef_national.py VERSINE DATA [FOLDER].

Ten minutes of GNSS at 5 Hz along a chain of branches near Utrecht, forty recordings of it with noise of their own, on
the Utrecht subset and on the whole Dutch network. The time of forty recordings less that of one, over 39, has the map's
loading out; processor time of one thread, tables only.
"""
import json
import math
import pathlib
import random
import resource
import subprocess
import sys

COUNT, RATE, SECONDS, NOISE = 40, 5, 600, 1.5


def metres(a, b):
    return ((b[0] - a[0]) * 111320 * math.cos(math.radians(a[1])), (b[1] - a[1]) * 111260)


def longest_chain(lines):
    """Branches that follow one another without a kink, as one line: the longest found from any end."""
    key = lambda p: (round(p[0], 5), round(p[1], 5))
    starts = {}
    for line in lines:
        for way in (line, line[::-1]):
            starts.setdefault(key(way[0]), []).append(way)
    length = lambda way: sum(math.hypot(*metres(a, b)) for a, b in zip(way, way[1:]))
    best = (0.0, [])
    for first in (way for ways in starts.values() for way in ways):
        chain, total, seen = list(first), length(first), {key(first[0]), key(first[-1])}
        while True:
            u = metres(chain[-2], chain[-1])
            def turn(way):
                v = metres(way[0], way[1])
                return abs(math.atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]))
            on = [w for w in starts.get(key(chain[-1]), []) if key(w[-1]) not in seen and turn(w) < 0.1]
            if not on:
                break
            straight = min(on, key=turn)
            chain += straight[1:]
            total += length(straight)
            seen.add(key(straight[-1]))
        best = max(best, (total, chain), key=lambda x: x[0])
    return best


def positions(total, chain):
    """The middle of the chain at constant speed, standing at both ends for 20 s."""
    span, stand = 0.9 * total, 20.0
    speed = span / (SECONDS - 2 * stand)
    at, k, done = 0.05 * total, 0, 0.0
    for i in range(SECONDS * RATE):
        s = at + speed * min(max(i / RATE - stand, 0.0), SECONDS - 2 * stand)
        while True:
            step = math.hypot(*metres(chain[k], chain[k + 1]))
            if done + step >= s or k + 2 >= len(chain):
                break
            done, k = done + step, k + 1
        w = (s - done) / step
        yield i / RATE, [a + w * (b - a) for a, b in zip(chain[k], chain[k + 1])]


def user_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    versine, data = sys.argv[1], pathlib.Path(sys.argv[2]).resolve() / "dutch-network"
    folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else "out/national")
    folder.mkdir(parents=True, exist_ok=True)
    small, national = data / "subset_utrecht.geojson.zst", data / "netherlands.geojson.zst"
    source = json.loads(subprocess.run(["zstd", "-dc", small], check=True, capture_output=True).stdout)
    total, chain = longest_chain([f["geometry"]["coordinates"] for f in source["features"] if f["geometry"]])
    track = list(positions(total, chain))
    noise = random.Random(1)
    for n in range(COUNT):
        with open(folder / f"r{n}.csv", "w") as out:
            out.write("time_s,latitude_deg,longitude_deg,sigma_north_m,sigma_east_m,sigma_down_m,height_m\n")
            for t, (lon, lat) in track:
                out.write(f"{t:.1f},{lat + noise.gauss(0, NOISE) / 111260:.9f},"
                          f"{lon + noise.gauss(0, NOISE) / 68700:.9f},{NOISE},{NOISE},3,5\n")
    print(f"{total / 1000:.1f} km of chain, {SECONDS} s at {RATE} Hz, {COUNT} recordings\n")
    print("| network | one recording | forty | a journey | found |\n| --- | --- | --- | --- | --- |")
    for name, network in (("Utrecht subset", small), ("Netherlands", national)):
        times, found = [], 0
        for count in (1, COUNT):
            job, result = folder / f"job{count}.toml", folder / "result"
            files = ", ".join(f'"r{n}.csv"' for n in range(count))
            job.write_text(f'job = "georef"\nrecordings = [{files}]\n[network]\nfile = "{network}"\n'
                           "[output]\nhdf5 = false\ngpkg = false\n")
            runs = []
            for _ in range(3):
                subprocess.run(["rm", "-rf", result], check=True)
                runs.append(user_seconds([versine, "georef", job, "-o", result, "--threads", "1", "--quiet"]))
            times.append(min(runs))
            recordings = json.loads((result / "run.json").read_text())["results"]["recordings"]
            found = sum(len(r.get("journeys", [])) for r in recordings)
        each = (times[1] - times[0]) / (COUNT - 1)
        print(f"| {name} | {times[0]:.2f} s | {times[1]:.2f} s | {1000 * each:.1f} ms | {found} of {COUNT} |")


if __name__ == "__main__":
    main()
