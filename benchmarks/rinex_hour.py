#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An hour of carrier phase at 1 Hz, GPS, Galileo and GLONASS on two frequencies, with known truth.

    benchmarks/rinex_hour.py FOLDER [SECONDS]     writes rover.obs, base.obs, brdc.nav, truth.csv, job.toml
    versine gnss FOLDER/job.toml -o RESULT
    benchmarks/rinex_hour.py --compare FOLDER RESULT

A trolley at 1.5 m/s on a circle of 500 m, 2 km from its base; nominal constellations with ephemerides of their own,
white noise of 0.3 m (code) and 2 mm (phase), a mask of 10 degrees, no atmosphere (over 2 km it cancels), five losses
of lock of 10 s. The real recordings at hand are shorter: this one is for the time that an hour takes.
"""
import csv
import math
import pathlib
import random
import sys

C = 299792458.0
OMEGA = 7.2921151467e-5  # of the Earth as broadcast ephemerides take it, rad/s
OMEGA_GLONASS = 7.292115e-5
MU_GPS, MU_GALILEO, MU_GLONASS = 3.9860050e14, 3.986004418e14, 3.9860044e14
J2, RADIUS = 1.0826257e-3, 6378136.0
WEEK, DAY, SECOND_OF_DAY = 2176, 3, 6 * 3600  # 2021-09-22 06:00:00 GPS time
TOW = DAY * 86400 + SECOND_OF_DAY
LEAP = 18
BASE = (4157177.066, 671230.477, 4774767.031)
CHANNELS = [1, -4, 5, 6, 1, -4, 5, 6, -2, -7, 0, -1, -2, -7, 0, -1, 4, -3, 3, 2, 4, -3, 3, 2]


class Kepler:
    """A circular orbit, as its ephemeris says it."""

    def __init__(self, name, mu, a, inclination, node, anomaly, toe):
        self.name, self.mu, self.a, self.i, self.node, self.m0, self.toe = name, mu, a, inclination, node, anomaly, toe
        self.n = math.sqrt(mu / a**3)

    def at(self, tow):
        tk = tow - self.toe
        u = self.m0 + self.n * tk
        o = self.node - OMEGA * tk - OMEGA * self.toe
        x, y = self.a * math.cos(u), self.a * math.sin(u)
        return (x * math.cos(o) - y * math.cos(self.i) * math.sin(o), x * math.sin(o) + y * math.cos(self.i) * math.cos(o),
                y * math.sin(self.i))

    def text(self):
        week_toe = (WEEK, self.toe)
        galileo = self.name[0] == "E"
        rows = [(1.0, 0.0, 0.0, self.m0), (0.0, 0.0, 0.0, math.sqrt(self.a)), (week_toe[1], 0.0, self.node, 0.0),
                (self.i, 0.0, 0.0, 0.0), (0.0, 517.0 if galileo else 1.0, float(WEEK), 0.0),
                (3.12 if galileo else 2.0, 0.0, 0.0, 0.0 if galileo else 1.0), (self.toe - 60.0, 0.0 if galileo else 4.0)]
        return head(self.name, self.toe, (0.0, 0.0, 0.0)) + body(rows)


class Glonass:
    """Integrated in the Earth-fixed frame as RTKLIB and the interface document do."""

    def __init__(self, name, channel, inclination, node, anomaly, begin, seconds):
        self.name, self.channel = name, channel
        a = 25508.0e3
        n = math.sqrt(MU_GLONASS / a**3)
        x, y, vx, vy = a * math.cos(anomaly), a * math.sin(anomaly), -a * n * math.sin(anomaly), a * n * math.cos(anomaly)
        ci, si, co, so = math.cos(inclination), math.sin(inclination), math.cos(node), math.sin(node)
        r = [x * co - y * ci * so, x * so + y * ci * co, y * si]
        v = [vx * co - vy * ci * so + OMEGA_GLONASS * r[1], vx * so + vy * ci * co - OMEGA_GLONASS * r[0], vy * si]
        self.begin, self.states = begin, [r + v]
        for _ in range(seconds + 4000):
            self.states.append(self.step(self.states[-1], 1.0))

    @staticmethod
    def rate(s):
        r2 = s[0]**2 + s[1]**2 + s[2]**2
        r3 = r2 * math.sqrt(r2)
        a = 1.5 * J2 * MU_GLONASS * RADIUS**2 / r2 / r3
        b = 5.0 * s[2]**2 / r2
        c = -MU_GLONASS / r3 - a * (1.0 - b)
        w2 = OMEGA_GLONASS**2
        return [s[3], s[4], s[5], (c + w2) * s[0] + 2.0 * OMEGA_GLONASS * s[4], (c + w2) * s[1] - 2.0 * OMEGA_GLONASS * s[3],
                (c - 2.0 * a) * s[2]]

    @classmethod
    def step(cls, s, h):
        k1 = cls.rate(s)
        k2 = cls.rate([x + 0.5 * h * k for x, k in zip(s, k1)])
        k3 = cls.rate([x + 0.5 * h * k for x, k in zip(s, k2)])
        k4 = cls.rate([x + h * k for x, k in zip(s, k3)])
        return [x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d) for x, a, b, c, d in zip(s, k1, k2, k3, k4)]

    def at(self, tow):
        k = min(len(self.states) - 1, max(0, round(tow - self.begin)))
        s, h = self.states[k], tow - self.begin - k
        a = self.rate(s)
        return tuple(s[i] + h * s[3 + i] + 0.5 * h * h * a[3 + i] for i in range(3))

    def text(self, toe):
        s = [x * 1e-3 for x in self.states[round(toe - self.begin)]]
        rows = [(s[0], s[3], 0.0, 0.0), (s[1], s[4], 0.0, float(self.channel)), (s[2], s[5], 0.0, 0.0)]
        return head(self.name, toe - LEAP, (0.0, 0.0, toe - LEAP)) + body(rows)


def number(x):
    return f"{x:19.12E}"


def head(name, tow, values):
    s = round(tow - DAY * 86400)
    return (f"{name} 2021 09 22 {s // 3600:02d} {s // 60 % 60:02d} {s % 60:02d}" + "".join(number(x) for x in values) + "\n")


def body(rows):
    return "".join("    " + "".join(number(x) for x in row) + "\n" for row in rows)


def label(text, name):
    return f"{text:<60}{name:<20}\n"


def constellation(seconds):
    middle = TOW + 7200 * round(seconds / 14400)
    satellites = []
    for k in range(24):
        satellites.append(Kepler(f"G{k + 1:02d}", MU_GPS, 26559.8e3, math.radians(55.0), math.radians(60.0 * (k // 4) + 20.0),
                                 math.radians(90.0 * (k % 4) + 15.0 * (k // 4)), middle))
        satellites.append(Kepler(f"E{k + 1:02d}", MU_GALILEO, 29599.8e3, math.radians(56.0), math.radians(120.0 * (k // 8) + 40.0),
                                 math.radians(45.0 * (k % 8) + 15.0 * (k // 8)), middle))
        satellites.append(Glonass(f"R{k + 1:02d}", CHANNELS[k], math.radians(64.8), math.radians(120.0 * (k // 8) + 70.0),
                                  math.radians(45.0 * (k % 8) + 15.0 * (k // 8)), TOW - 900 + LEAP, seconds))
    return satellites


def write_navigation(path, satellites, seconds):
    text = label("     3.03           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE")
    text += label(f"{LEAP:6d}", "LEAP SECONDS") + label("", "END OF HEADER")
    for s in satellites:
        if isinstance(s, Kepler):
            text += s.text()
        else:
            text += "".join(s.text(TOW + LEAP + toe) for toe in range(-900, seconds + 1800, 1800))
    path.write_text(text)


def frequencies(s):
    if s.name[0] == "R":
        return 1602.0e6 + 562500.0 * s.channel, 1246.0e6 + 437500.0 * s.channel
    return 1575.42e6, 1227.60e6 if s.name[0] == "G" else 1207.14e6


def observation_header(place):
    x, y, z = place
    text = label("     3.03           OBSERVATION DATA    M: MIXED", "RINEX VERSION / TYPE")
    text += label("MADE", "MARKER NAME") + label(f"{x:14.4f}{y:14.4f}{z:14.4f}", "APPROX POSITION XYZ")
    text += label(f"{0.0:14.4f}{0.0:14.4f}{0.0:14.4f}", "ANTENNA: DELTA H/E/N")
    for codes in ("G    4 C1C L1C C2W L2W", "E    4 C1C L1C C7Q L7Q", "R    4 C1C L1C C2C L2C"):
        text += label(codes, "SYS / # / OBS TYPES")
    slots = [f"R{k + 1:02d} {c:2d}" for k, c in enumerate(CHANNELS)]
    for k in range(0, 24, 8):
        text += label(("24 " if k == 0 else "   ").rjust(4) + " ".join(slots[k:k + 8]), "GLONASS SLOT / FRQ #")
    text += label("     1.000", "INTERVAL")
    text += label(f"  2021     9    22    {SECOND_OF_DAY // 3600:2d}     0    0.0000000     GPS", "TIME OF FIRST OBS")
    return text + label("", "END OF HEADER")


class Receiver:
    def __init__(self, path, place, seed):
        self.file = open(path, "w", encoding="ascii")
        self.file.write(observation_header(place))
        self.random, self.ambiguity = random.Random(seed), {}

    def write(self, epoch, satellites, place, locked):
        if not locked:
            self.ambiguity.clear()
        rows = []
        r = math.sqrt(sum(x * x for x in place))
        for s in satellites if locked else []:
            tau = 0.075
            for _ in range(3):
                p = s.at(TOW + epoch - tau)
                d = math.dist(p, place)
                d += OMEGA * (p[0] * place[1] - p[1] * place[0]) / C
                tau = d / C
            sine = sum((a - b) * b for a, b in zip(p, place)) / (d * r)
            if sine < math.sin(math.radians(10.0)):
                self.ambiguity.pop(s.name, None)
                continue
            row = s.name
            n = self.ambiguity.setdefault(s.name, [self.random.randrange(-10**5, 10**5) for _ in range(2)])
            for f, ambiguity in zip(frequencies(s), n):
                code = d + 0.3 * self.random.gauss(0.0, 1.0)
                phase = (d + 0.002 * self.random.gauss(0.0, 1.0)) * f / C + ambiguity
                row += f"{code:14.3f}  {phase:14.3f}  "
            rows.append(row + "\n")
        t = SECOND_OF_DAY + epoch
        self.file.write(f"> 2021 09 22 {t // 3600:02d} {t // 60 % 60:02d} {t % 60:2d}.0000000  0{len(rows):3d}\n")
        self.file.writelines(rows)


def rover_at(t):
    """On a level circle beside the base; axes east, north, up at the base."""
    x, y, z = BASE
    lon, lat = math.atan2(y, x), math.atan2(z, math.hypot(x, y))  # of a sphere: good enough for a level
    angle = 1.5 * t / 500.0
    e, n = 2000.0 + 500.0 * math.sin(angle), 500.0 * (math.cos(angle) - 1.0)
    east = (-math.sin(lon), math.cos(lon), 0.0)
    north = (-math.sin(lat) * math.cos(lon), -math.sin(lat) * math.sin(lon), math.cos(lat))
    return tuple(b + e * u + n * v for b, u, v in zip(BASE, east, north))


def axes(place):
    """Rows north, east, down on the ellipsoid at an ECEF place."""
    x, y, z = place
    p, e2 = math.hypot(x, y), 0.00669437999014
    lat = math.atan2(z, p * (1.0 - e2))
    for _ in range(5):
        n = 6378137.0 / math.sqrt(1.0 - e2 * math.sin(lat)**2)
        lat = math.atan2(z + e2 * n * math.sin(lat), p)
    lon = math.atan2(y, x)
    s, c, sl, cl = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    return (-s * cl, -s * sl, c), (-sl, cl, 0.0), (-c * cl, -c * sl, -s)


def ecef(lat, lon, height):
    e2, lat, lon = 0.00669437999014, math.radians(lat), math.radians(lon)
    n = 6378137.0 / math.sqrt(1.0 - e2 * math.sin(lat)**2)
    return ((n + height) * math.cos(lat) * math.cos(lon), (n + height) * math.cos(lat) * math.sin(lon),
            (n * (1.0 - e2) + height) * math.sin(lat))


def compare(folder, result):
    with open(folder / "truth.csv", newline="") as file:
        truth = {round(float(r["time_gps_s"])): [float(r[k]) for k in ("x_m", "y_m", "z_m")] for r in csv.DictReader(file)}
    groups = {}
    with open(result / "gnss.csv", newline="") as file:
        for r in csv.DictReader(line for line in file if not line.startswith("#")):
            place = truth[round(float(r["time_s"]))]
            d = [a - b for a, b in zip(ecef(*(float(r[k]) for k in ("latitude_deg", "longitude_deg", "height_m"))), place)]
            error = [sum(a * b for a, b in zip(axis, d)) for axis in axes(place)]
            sigma = [float(r[f"sigma_{k}_m"]) for k in ("north", "east", "down")]
            fix = {"1": "fixed", "2": "float"}.get(r["fix_rtklib"], "other")
            groups.setdefault(fix, []).append((error, sigma))
    print("| fix | epochs | RMS north, east, down, mm | own sigma, mm | in 1.96 sigma | largest, mm |\n|---|---|---|---|---|---|")
    for fix, rows in sorted(groups.items()):
        n = len(rows)
        rms = [1e3 * math.sqrt(sum(e[k]**2 for e, _ in rows) / n) for k in range(3)]
        own = [1e3 * math.sqrt(sum(s[k]**2 for _, s in rows) / n) for k in range(3)]
        inside = sum(abs(e[k]) < 1.96 * s[k] for e, s in rows for k in range(3)) / (3.0 * n)
        largest = max(1e3 * math.hypot(*e) for e, _ in rows)
        print(f"| {fix} | {n} | {rms[0]:.1f}, {rms[1]:.1f}, {rms[2]:.1f} | {own[0]:.1f}, {own[1]:.1f}, {own[2]:.1f} | "
              f"{100.0 * inside:.1f} % | {largest:.1f} |")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--compare":
        compare(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
        return
    folder = pathlib.Path(sys.argv[1])
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 3600
    folder.mkdir(parents=True, exist_ok=True)
    satellites = constellation(seconds)
    write_navigation(folder / "brdc.nav", satellites, seconds)
    base, rover = Receiver(folder / "base.obs", BASE, 1), Receiver(folder / "rover.obs", rover_at(0), 2)
    with open(folder / "truth.csv", "w", encoding="ascii") as truth:
        truth.write("time_gps_s,x_m,y_m,z_m\n")
        for t in range(seconds):
            place = rover_at(t)
            base.write(t, satellites, BASE, True)
            rover.write(t, satellites, place, not any(600 * k <= t < 600 * k + 10 for k in range(1, 6)))
            truth.write(f"{WEEK * 604800 + TOW + t},{place[0]:.4f},{place[1]:.4f},{place[2]:.4f}\n")
    (folder / "job.toml").write_text(
        'job = "gnss"\n[gnss]\nrover = ["rover.obs"]\nbase = ["base.obs"]\nnavigation = ["brdc.nav"]\n'
        f'base_ecef_m = [{BASE[0]}, {BASE[1]}, {BASE[2]}]\n')


if __name__ == "__main__":
    main()
