#!/usr/bin/env python3
"""Time and memory against size: arenas, logs of hours (mapped, exported), batches, leagues, .raf files (table of docs/reliability.md).

  tests/growth.py [--rubble build/release/rubble] [--only "arenas logs batches leagues raf"] [--quick]

Each kind of work is done at several sizes; CPU time (user and system, children included) and the largest memory of a process
are printed as Markdown, and the exponents of both against size, from the size before: 1 is in proportion, and a share that
does not grow (start, libraries) makes them smaller. Ends with 1 when something fails, takes over 2 GB, or when from one size to
the next CPU time grows by more than 1.6 times what the work grows by, or memory by more than 1.1 times.
"""
import argparse
import csv
import json
import math
import os
import random
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MOST_MB = 2000
MOST_MAP_MB = 1000  # of a log of ten hours
MOST_WORK = 20     # of a scan, in millions of units of about a nanosecond
MOST_TIME = 1.6    # times what the work grows by
MOST_MEMORY = 1.1  # times what the work grows by
findings = 0
measured = 0


def run(words, folder, limit=7200):
    """CPU seconds and peak MB of a command; its output when it fails."""
    script = ("import resource,subprocess,sys;c=subprocess.run(sys.argv[1:],stdout=subprocess.PIPE,stderr=subprocess.STDOUT);"
              "r=resource.getrusage(resource.RUSAGE_CHILDREN);"
              "sys.stdout.buffer.write(c.stdout[-400:]);"
              "print('\\n#',c.returncode,r.ru_utime+r.ru_stime,r.ru_maxrss/1024)")
    done = subprocess.run([sys.executable, "-c", script, *words], cwd=folder, stdout=subprocess.PIPE, text=True,
                          timeout=limit, env={**os.environ, "RUBBLE_HOME": TOP})
    words = done.stdout.rsplit("\n#", 1)
    code, cpu, mb = words[1].split()
    return int(code), float(cpu), float(mb), words[0]


def most_work(scans):
    """Of a scan, in a run's scans.csv."""
    with open(scans, newline="") as f:
        return max(float(line["work_ms"]) for line in csv.DictReader(f))


def row(kind, size, words, folder, growing, expected=0, most_mb=MOST_MB, scans=None):
    """Measures one size and judges it against the one before, the last in `growing`; with the scans.csv of a run also
    the most work of a scan."""
    global findings, measured
    measured += 1
    code, cpu, mb, said = run(words, folder)
    notes, grown = [], "-"
    if code != expected:
        notes.append("exit code %d: %s" % (code, said.strip().splitlines()[-1] if said.strip() else ""))
    if mb > most_mb:
        notes.append("over %d MB" % most_mb)
    most = most_work(os.path.join(folder, scans)) if scans and code == expected else 0.0
    if most > MOST_WORK:
        notes.append("a scan of %.1f million units of work" % most)
    if growing:
        work, time, memory = (now / before for now, before in zip((size, cpu, mb), growing[-1]))
        grown = "%.2f, %.2f" % (math.log(time) / math.log(work), math.log(memory) / math.log(work))
        if time > MOST_TIME * work:
            notes.append("%.1f times the work took %.1f times the time" % (work, time))
        if memory > MOST_MEMORY * work:
            notes.append("%.1f times the work took %.1f times the memory" % (work, memory))
    growing.append((size, cpu, mb))
    findings += 1 if notes else 0
    if scans:
        kind += ", at most %.1f million units of work" % most
    print("| %s | %d | %.1f s | %.0f MB | %s | %s |" % (kind, size, cpu, mb, grown, "; ".join(notes) or "-"), flush=True)


def nearest_wall(walls, x, y, bearing, farthest, none=math.inf):
    """The range to the nearest of the walls (x0, y0, x1, y1)."""
    c, s = math.cos(bearing), math.sin(bearing)
    nearest = none
    for x0, y0, x1, y1 in walls:
        ex, ey = x1 - x0, y1 - y0
        d = c * ey - s * ex
        if abs(d) < 1e-12:
            continue
        t = ((x0 - x) * ey - (y0 - y) * ex) / d
        u = ((x0 - x) * s - (y0 - y) * c) / d
        if t > 0 and -1e-9 <= u <= 1 + 1e-9 and t < min(nearest, farthest):
            nearest = t
    return nearest


def hall_log(path, hours):
    """A CARMEN log of any length: a lap of a hall with a block in it, driven again and again, five scans a second."""
    walls = []
    for x0, y0, x1, y1 in ((-10, -6, 10, 6), (-4, -2, 4, 2)):
        walls += [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]
    walls += [(-10, 3, -8.5, 3), (6, 6, 6, 5), (10, -2, 9, -2), (10, -3, 9, -3), (-5, -6, -5, -5.2), (-6, -6, -6, -5.2)]

    x, y, phi, lap = -6.0, -4.0, 0.0, []

    def look():
        ranges = " ".join("%.2f" % nearest_wall(walls, x, y, phi + math.radians(i - 90), 8.0, 81.91) for i in range(180))
        lap.append("FLASER 180 %s %.4f %.4f %.5f %.4f %.4f %.5f " % (ranges, x, y, phi, x, y, phi))

    for side in (10.0, 6.0, 10.0, 6.0):
        for _ in range(round(side / 0.1)):
            look()
            x, y = x + 0.1 * math.cos(phi), y + 0.1 * math.sin(phi)
        turn = math.pi / 32
        for _ in range(16):
            look()
            chord = 2.0 * math.sin(turn / 2)
            x, y = x + chord * math.cos(phi + turn / 2), y + chord * math.sin(phi + turn / 2)
            phi += turn
    with open(path, "w") as log:
        for i in range(round(hours * 18000)):
            log.write("%s%.3f hall %.3f\n" % (lap[i % len(lap)], 0.2 * i, 0.2 * i))


def own_log(path, hours, header):
    """A log of ours of any length: a lap of a small hall, driven again and again at 0.4 m/s, as the shipped robot sends it:
    50 ticks a second, ten with a scan of 682 beams and its odometry. Times within are relative, so that laps repeat byte by byte.
    `header`: the first frame of a log of that robot."""
    walls = []
    for x0, y0, x1, y1 in ((-4, -2.4, 4, 2.4), (-1.6, -0.8, 1.6, 0.8)):
        walls += [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]
    walls += [(-4, 1.2, -3.4, 1.2), (2.4, 2.4, 2.4, 2.0), (4, -0.8, 3.6, -0.8), (4, -1.2, 3.6, -1.2), (-2, -2.4, -2, -2.1)]
    step, noise = math.radians(360 / 1024), random.Random(1)

    def scan(x, y, phi):
        codes, last = bytearray(), 0
        for i in range(682):
            at = 1000 * nearest_wall(walls, x, y, phi + (i - 340) * step, 4.0)
            if at == math.inf:
                codes += b"\xf1\x00"
                continue
            mm = round(at + noise.gauss(0, 10))
            d = 2 * (mm - last) if mm >= last else 2 * (last - mm) - 1
            last = mm
            codes += bytes([d]) if d < 192 else bytes([192 + (d - 192 >> 8), d - 192 & 255])
        return bytes(codes)

    def varint(n):
        out = bytearray()
        while n > 127:
            out.append(n & 127 | 128)
            n >>= 7
        return bytes(out) + bytes([n])

    def tick(i, x, y, phi, w):
        age = varint(0)
        scans = odometry = varint(0)
        if i % 5 == 0:
            geometry = b"\x01" + struct.pack("<5d", -340 * step, step, 0, 0.02, 4) if i == 0 else b"\x00"
            scans = varint(1) + age + geometry + varint(682) + scan(x + 0.145 * math.cos(phi), y + 0.145 * math.sin(phi), phi)
            odometry = varint(1) + age + struct.pack("<5d", x, y, phi, 0.4, w) + b"\x00"
        level = varint(1) + age + struct.pack("<2d", 0, 0)
        payload = b"T" + varint(2 * 20_000_000) + scans + odometry + level + level + varint(0)
        head = struct.pack("<2I", len(payload), zlib.crc32(payload))
        return head + struct.pack("<I", zlib.crc32(head)) + payload

    x, y, phi, lap = -2.4, -1.6, 0.0, []
    for ticks in (500, 300, 500, 300):
        for _ in range(ticks):
            lap.append(tick(len(lap), x, y, phi, 0.0))
            x, y = x + 0.008 * math.cos(phi), y + 0.008 * math.sin(phi)
        turn = math.pi / 160
        for _ in range(80):
            lap.append(tick(len(lap), x, y, phi, turn / 0.02))
            chord = 0.016 / turn * math.sin(turn / 2)
            x, y = x + chord * math.cos(phi + turn / 2), y + chord * math.sin(phi + turn / 2)
            phi += turn
        phi = math.remainder(phi, 2 * math.pi)
    with open(path, "wb") as log:
        log.write(b"RUBBLE LOG 1\n" + header)
        left = round(hours * 180000)
        while left > 0:
            log.write(b"".join(lap[:left]))
            left -= len(lap)


def arenas(rubble, folder, quick):
    grown = []
    for side in (15, 30) if quick else (15, 30, 60):
        row("arena generate, pallets", side * side,
            [rubble, "arena", "generate", "--cells", "%dx%d" % (side, side), "--out", "a%d" % side], folder, grown)


def first_frame(log):
    """The bytes of the frame behind the first line of a log of ours."""
    with open(log, "rb") as f:
        f.readline()
        head = f.read(12)
        return head + f.read(struct.unpack("<I", head[:4])[0])


def logs(rubble, folder, quick):
    # The robust mapper solves the whole graph until it has 4,000 key frames, within the first hour or so: until then time
    # grows by the square (docs/robust_mapper.md), and what is asked is what comes after. No scan waits for that.
    lengths = (0.1, 0.2) if quick else (1, 3, 10)
    grown = []
    for hours in lengths:
        hall_log(os.path.join(folder, "hall.log"), hours)
        row("map a CARMEN log, scans", round(18000 * hours), [rubble, "map", "hall.log", "--out", "hall", "--force"], folder, grown,
            most_mb=MOST_MAP_MB, scans="hall/scans.csv")
    os.remove(os.path.join(folder, "hall.log"))
    run([rubble, "run", "--set", "time_limit_s=1", "--out", "header"], folder)
    mapped, exported = [], []
    for hours in lengths:
        scans = round(36000 * hours)
        own_log(os.path.join(folder, "own.rlog"), hours, first_frame(os.path.join(folder, "header", "log.rlog")))
        row("map a log of ours, scans", scans, [rubble, "map", "own.rlog", "--out", "own", "--force"], folder, mapped,
            most_mb=MOST_MAP_MB, scans="own/scans.csv")
        row("export it as .rawlog, scans", scans, [rubble, "export", "own.rlog", "own.rawlog"], folder, exported)


def batches(rubble, folder, quick):
    with open(os.path.join(folder, "tiny.yaml"), "w") as f:
        f.write("arena: {generate: {columns: 2, rows: 2, ramps: 0, paper: 0, loops: 0, victims: 0}}\ntime_limit_s: 1\n")
    grown = []
    for runs in (50, 100) if quick else (100, 400, 1600):
        with open(os.path.join(folder, "tiny_sweep.yaml"), "w") as f:
            f.write("scenarios: [tiny.yaml]\nseeds: 1-%d\n" % runs)
        shutil.rmtree(os.path.join(folder, "many"), ignore_errors=True)
        row("batch, runs of 1 s", runs, [rubble, "batch", "tiny_sweep.yaml", "--out", "many"], folder, grown)
    # A hundred thousand runs as far as they concern the batch: their lines, not their maps.
    lines = open(os.path.join(folder, "many", "results.jsonl")).read().splitlines()
    grown = []
    for runs in (1000,) if quick else (1000, 10000, 100000):
        path = os.path.join(folder, "lines")
        shutil.rmtree(path, ignore_errors=True)
        os.makedirs(path)
        with open(os.path.join(path, "results.jsonl"), "w") as f:
            for i in range(runs):
                record = json.loads(lines[i % len(lines)])
                record["seed"] = i + 1
                record["run_id"] = "%016x" % (i + 1)
                f.write(json.dumps(record, separators=(",", ":")) + "\n")
        row("merge results, runs", runs, [rubble, "batch", "merge", "lines", "--out", "lines%d.sqlite" % runs], folder, grown)


def leagues(rubble, folder, quick):
    run([rubble, "run", "--set", "arena.generate.columns=4", "--set", "arena.generate.rows=4", "--out", "one"], folder)
    grown = []
    for maps in (10, 20) if quick else (25, 100, 500):
        shutil.rmtree(os.path.join(folder, "maps"), ignore_errors=True)
        os.makedirs(os.path.join(folder, "maps"))
        for i in range(maps):
            for ending in ("tif", "tfw"):
                os.link(os.path.join(folder, "one", "map." + ending), os.path.join(folder, "maps", "team%d.%s" % (i, ending)))
        row("league, maps", maps, [rubble, "score", "--league", "maps", "one/truth.tif", "--out", "judged%d" % maps], folder, grown)


def raf(rubble, folder, quick):
    grown = []
    for elements in (200, 1000) if quick else (500, 1500, 5000):
        many_elements(os.path.join(folder, "many.raf"), elements)
        row("arena from .raf, elements", elements, [rubble, "arena", "many.raf", "--out", "raf"], folder, grown)
    # More are refused, and before anything is made of them: in proportion to the file at the most.
    many_elements(os.path.join(folder, "many.raf"), 60000)
    row("refusal of a .raf, elements", 60000, [rubble, "arena", "many.raf", "--out", "raf"], folder, grown, expected=3)


def many_elements(path, elements):
    side = round(math.sqrt(elements))
    with open(path, "w") as f:
        f.write('<?xml version="1.0" encoding="UTF-8"?>\n<elements>\n')
        for i in range(elements):
            f.write('    <element type="tall_wall" rotation="%d" x="%d" y="%d"/>\n' % (90 * (i * 7 % 4), i % side, i // side))
        f.write("</elements>\n")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--rubble", default=os.path.join(TOP, "build/release/rubble"))
    words.add_argument("--only", default="arenas logs batches leagues raf")
    words.add_argument("--quick", action="store_true")
    given = words.parse_args()
    rubble = os.path.abspath(given.rubble)
    print("| work | size | CPU | largest memory | exponents of both | finding |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="growth") as folder:
        for name in given.only.split():
            {"arenas": arenas, "logs": logs, "batches": batches, "leagues": leagues, "raf": raf}[name](rubble, folder, given.quick)
    print("growth: %d measured, findings: %d" % (measured, findings))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
