#!/usr/bin/env python3
"""`rubble calibrate` on an emulated robot in real time, told wrong numbers at the start: the true ones must come back.

  tests/device_calibration.py [--rubble build/release/rubble] [--seed 2]    about two and a half minutes

The truth is the simulator's own: its track, what its firmware reckoned on the way, what its accelerometer said at rest on the level
floor. Prints a table in Markdown and ends with 1 when one of them is off by more than its bound.
"""
import argparse
import math
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile

import black_box

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIRMWARE_TRACK = 0.55  # [m]
X, Y = 0.12, 0.03      # of the laser [m]
STEP = 0.01            # the simulated body follows its wheels half a step of the physics late [s]
SCENARIO = """name: flat
arena: {file: %s/arenas/shipped/flat_room.yaml}
robot: {effective_track_m: %g, laser: {x_m: %g, y_m: %g}}
sim: {physics_step_s: %g}
"""
WRONG = ["devices.urg.yaw_deg=2.5", "devices.urg.delay_s=0.03", "devices.base.distance_scale=1.03",
         "devices.levelling.x.zero_duty=0.51", "devices.levelling.y.zero_duty=0.49"]


def difference(a, b):
    return (a - b + math.pi) % (2 * math.pi) - math.pi


def truth_of(path):
    """(time, speed over 0.1 s [m/s], heading)."""
    rows = [list(map(float, l.split())) for l in open(path)]
    rows = [(r[0], r[1], r[2], 2 * math.atan2(r[6], r[7])) for r in rows if len(r) == 8]
    return [(b[0], math.hypot(b[1] - a[1], b[2] - a[2]) / 0.1, b[3]) for a, b in zip(rows, rows[10:])]


def turned(headings):
    return sum(abs(difference(b, a)) for a, b in zip(headings, headings[1:]))


def reports(path):
    """(time, heading) of the base's reports."""
    waiting = b""
    for device, direction, stamp, data in black_box.entries(path):
        if device != "base" or direction != black_box.FROM_DEVICE:
            continue
        waiting += data
        while len(waiting) > 3 and len(waiting) >= waiting[2] + 3:
            payload, waiting = waiting[3:waiting[2] + 1], waiting[waiting[2] + 3:]
            if payload and payload[0] in (0x32, 0x33):
                yield stamp, struct.unpack_from("<h", payload, 5)[0] * 2 * math.pi / 4096


def duties(path, rests):
    """Mean duty cycle of either axis while the robot rests."""
    text, sums, count, rest = "", [0.0, 0.0], 0, 0
    for device, direction, stamp, data in black_box.entries(path):
        if device != "levelling" or direction != black_box.FROM_DEVICE:
            continue
        text += data.decode("ascii", "replace")
        *lines, text = text.split("\n")
        while rest < len(rests) and rests[rest][1] < stamp:
            rest += 1
        if rest == len(rests) or not rests[rest][0] + 0.5 < stamp < rests[rest][1]:
            continue
        for line in lines:
            f = line.strip()[1:-3].split(",")
            if f[0] == "L" and len(f) == 10:
                sums[0] += int(f[4]) / int(f[6])
                sums[1] += int(f[5]) / int(f[6])
                count += 1
    return sums[0] / count, sums[1] / count


def rests_of(truth):
    rests, begun = [], None
    for (t, v, heading), (_, _, before) in zip(truth[10:], truth):
        still = v < 1e-3 and abs(difference(heading, before)) < 1e-4
        if still and begun is None:
            begun = t
        if not still and begun is not None:
            if t - begun > 1.0:
                rests.append((begun, t))
            begun = None
    return rests



def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rubble", default=os.path.join(TOP, "build", "release", "rubble"))
    parser.add_argument("--seed", default="2")
    arguments = parser.parse_args()
    rubble = os.path.abspath(arguments.rubble)
    os.environ.setdefault("RUBBLE_HOME", TOP)
    folder = tempfile.TemporaryDirectory()
    os.chdir(folder.name)
    open("flat.yaml", "w").write(SCENARIO % (TOP, FIRMWARE_TRACK, X, Y, STEP))
    emulator = subprocess.Popen([rubble, "emulate", "flat.yaml", "--seed", arguments.seed, "--truth", "true.tum", "--urg",
                                 "tcp:127.0.0.1:0", "--base", "tcp:127.0.0.1:0", "--levelling", "tcp:127.0.0.1:0"],
                                stdout=subprocess.PIPE, text=True)
    words = []
    for line in emulator.stdout:
        if line.strip() == "ready":
            break
        device, port = line.split()
        words += ["--" + device, port]
    done = subprocess.run([rubble, "calibrate", os.path.join(TOP, "robots", "pioneer_urg.yaml"), *words, "--folder", "drive",
                           "--out", "found.yaml", *[w for key in WRONG for w in ("--set", key)]], capture_output=True, text=True)
    emulator.send_signal(signal.SIGINT)
    emulator.wait(20)
    if done.returncode != 0:
        print(done.stdout + done.stderr[-600:])
        print("calibration: 1, findings: 1")
        sys.exit(1)
    print(done.stdout)
    truth = truth_of("true.tum")
    bytes_of = "drive/devices.bytes"
    headings = list(reports(bytes_of))
    begin, end = headings[0][0], headings[-1][0]
    true_turn = turned([h for t, _, h in truth if begin <= t <= end][::10])
    track = FIRMWARE_TRACK * turned([h for _, h in headings]) / true_turn
    duty = duties(bytes_of, rests_of(truth))
    text = open("found.yaml").read()
    printed = float(re.search(r"effective track +([0-9.]+)", done.stdout).group(1))
    base = text[text.index("  base:"):]
    levelling = text[text.index("  levelling:"):]
    number = lambda part, key: float(re.search(r"\b%s: *([-0-9.e]+)" % key, part).group(1))
    zeros = [float(z) for z in re.findall(r"zero_duty: *([-0-9.e]+)", levelling)[:2]]
    per_degree = 0.125 * math.sin(math.radians(1.0))
    rows = [
        ("effective track, over the true one", printed / track, 1.0, 0.01, ""),
        ("distance scale", number(base, "distance_scale"), 1.0, 0.01, ""),
        ("laser x", number(text, "x_m"), X, 0.005, "m"),
        ("laser y", number(text, "y_m"), Y, 0.005, "m"),
        ("laser yaw", number(text, "yaw_deg"), 0.0, 0.3, "deg"),
        ("delay", 1e3 * number(text, "delay_s"), 1e3 * STEP / 2, 5.0, "ms"),
        ("accelerometer, pitch off by", (zeros[0] - duty[0]) / per_degree, 0.0, 0.2, "deg"),
        ("accelerometer, roll off by", (zeros[1] - duty[1]) / per_degree, 0.0, 0.2, "deg"),
    ]
    print("load average %s; effective track in truth %.4f m\n" % (open("/proc/loadavg").read().split()[0], track))
    print("| number | found | true | bound |\n|---|---|---|---|")
    bad = 0
    for name, found, true, bound, unit in rows:
        bad += abs(found - true) > bound
        print("| %s | %.4f %s | %.4f | %g%s |" % (name, found, unit, true, bound, "" if abs(found - true) <= bound else " BROKEN"))
    print("calibration: %d, findings: %d" % (len(rows), bad))
    folder.cleanup()
    sys.exit(1 if bad else 0)


main()
