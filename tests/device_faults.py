#!/usr/bin/env python3
"""The table fault x (standstill, exit code, map score, re-connected) of docs/hardware.md, one drive a fault in real time.

  tests/device_faults.py [--rubble build/release/rubble] [--faults "urg-silence base-unplug ..."] [--seconds 110] [--at 14] [--jobs 1] [--keep DIR]
  tests/device_faults.py --three    three emulated robots at once: jitter of their scans, and of this machine's timer

Prints a table in Markdown, a row as soon as it is known. Ends with 1 and names what was broken:
- a drive ends with another code than 0, or a device that was lost does not come back (after a stop at the robot SIGUSR2 lets it go);
- a fault that must stop the robot: the drive's own record (devices.bytes) does not show set points of zero within the time it takes to
  notice, kept to the end of the fault, though the robot was told to drive until then; or the robot, by the emulator's own track, does not
  brake by at least 0.25 m/s2 for 0.2 s, or is not at rest when it should be. A robot that was not driving then is no proof: the fault is
  tried again at another moment;
- a fault that must be told is not, an odometry that rolls over does not, or is taken for a jump, or the map is worse by 0.05 than without a fault, or that one is bad;
- the drive without a fault is said to be in trouble (a base that answers late, or does not obey), takes more than 15 % of a core, or 99 % of its answers to a scan take longer than 30 ms and what the machine's
  own timer is late by;
- --three: scans do not come 10 times a second, or 95 % of them not within 2 ms and what the machine's own timer is late by.
"""
import argparse
import concurrent.futures
import json
import math
import os
import shutil
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import black_box

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DEVICES = ("urg", "base", "levelling")
FAULTS = [d + "-" + f for d in DEVICES for f in "lost split doubled junk sums silence unplug reset".split()]
FAULTS += ["urg-wrap", "base-wrap", "base-seto", "base-stall", "base-stuck", "base-runaway", "base-slow", "base-watchdog", "base-button",
           "base-motors", "base-encoders", "base-battery", "levelling-sensor", "levelling-slow"]
# Not a fault that strikes, but a scanner that is mounted otherwise than the robot file says: words to the emulator. Nobody lets the robot
# go, so the drive fails, by the word that it is told with. With the robot file put right (-said) the drive is as without a fault.
MOUNTS = {"urg-upside-down": (["--urg-upside-down"], "devices.urg.upside_down=true", "is upside down"),
          "urg-backwards": (["--urg-yaw", "180"], "devices.urg.yaw_deg=180", "lower devices.urg.yaw_deg by about 180 deg")}
FAULTS += [name + said for name in MOUNTS for said in ("", "-said")]
# Stopped at the robot, or switched off since it moved otherwise than told: the operator lets it go again, so long after the fault [s]
REARM = 6.0
HELD = {"base-button": REARM, "base-motors": REARM, "base-encoders": 8.0, "base-runaway": 12.0, "base-battery": 16.0}
LATER = {"base-battery": 10.0}  # so long a battery must be empty before anything is to happen [s]
STARTS = {"base-wrap": ("65,65,90",)}  # not --fault: the odometry begins just short of where it rolls over
# What a fault must do to a robot that drives, and how long it may take to be noticed [s] (safety: in the robot file, the base's own
# watchdog).
# ZEROED: set points of zero go out to the base and stay until the fault is over, so long after it began [s]. All but a base that is deaf
# meanwhile must also be seen to brake.
ZEROED = {"urg-lost": (0.3, 1.0), "urg-doubled": (0.3, 1.0), "urg-junk": (0.3, 1.0), "urg-sums": (0.3, 1.0), "urg-reset": (0.3, 0.6),
          "urg-silence": (0.3, 2.0), "urg-unplug": (0.3, 3.0), "levelling-silence": (0.5, 2.0), "levelling-unplug": (0.5, 3.0),
          "base-silence": (1.0, 2.0), "base-slow": (2.0, 6.0), "levelling-slow": (2.0, 6.0)}
DEAF = ("base-silence",)
SWINGS = ("levelling-slow",)
# BRAKES: by the base's own doing, which nobody can tell anything: how long after the fault it begins to [s], and how long it is at it.
BRAKES = {"base-watchdog": (2.0, 3.0)}
# REST: the robot stands.
REST = {"urg-silence": 0.3, "urg-unplug": 0.3, "base-unplug": 0.1, "base-reset": 0.1, "levelling-unplug": 0.5}
# At once, without a ramp. A base that runs away is found out when what it is told has differed for long enough, and then has its motors off;
# so has one whose encoders are dead, when scans have shown twice that it moves.
HARD = {"base-button": 0.1, "base-motors": 0.1, "base-runaway": 5.0, "base-encoders": 3.5, "base-battery": 0.3}
JUDGED = {*ZEROED, *BRAKES, *REST, *HARD}
# A base that is silent must be told; a deaf one reports.
NAMED = {"levelling-sensor", "base-stuck", "base-runaway", "base-watchdog", *ZEROED, *REST, *HARD}
RAMP = 0.3          # the firmware's deceleration [m/s^2]
BRAKING, BRAKED = 0.25, 0.2  # so hard [m/s^2] and so long [s] is braking
LATE = 0.35         # a scan's period, the driver's turns, the wheels' lag, the window of a speed [s]
NOTICED = 0.15      # the driver's turn and what a busy machine adds, from when it must notice to set points of zero [s]
MOUNT_WAY, MOUNT_TURN = 2.0, 12.0  # so far an explorer gets before a wrong mount is found out, at most [m], [rad]
DRIVES = 0.15       # slower than this says nothing of a stop: the fault is tried again at another moment [m/s]
TRIES = 8
WORST_MAP = 0.05    # a map may be so much worse than without a fault
PLAIN_MAP = 0.9     # and without one it is at least so good
MOST_CPU, MOST_ANSWER_MS = 0.15, 30.0
MOST_JITTER = 0.002  # [s], 95 %
SCENARIO = """name: small
arena: {generate: {columns: 3, rows: 3, ramps: 0.2, paper: 0.2, loops: 0.3, victims: 1}}
seed: 3
"""


def load():
    return open("/proc/loadavg").read().split()[0]


class Emulator:
    def __init__(self, rubble, *words):
        self.process = subprocess.Popen(
            [rubble, "emulate", "small.yaml", *words] + [w for d in DEVICES for w in ("--" + d, "tcp:127.0.0.1:0")],
            stdout=subprocess.PIPE, text=True)
        self.ports, self.lines, self.faults = {}, [], {}
        for line in self.process.stdout:
            if line.strip() == "ready":
                break
            device, port = line.split()
            self.ports[device] = port
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            self.lines.append(line.strip())
            if line.startswith("fault "):
                self.faults[line.split()[1]] = time.time()

    def words(self):
        return [w for device, port in self.ports.items() for w in ("--" + device, port)]

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(20)


def read_truth(path):
    rows = []
    for line in open(path).read().splitlines():
        f = line.split()
        if len(f) == 8:
            t, x, y, _, _, _, qz, qw = map(float, f)
            rows.append((t, x, y, 2 * math.atan2(qz, qw)))
    return rows


def motion(rows, i):
    """Speed [m/s] and turn rate [rad/s] over 50 ms."""
    a, b = rows[max(0, i - 5)], rows[i]
    dt = max(1e-3, b[0] - a[0])
    turn = (b[3] - a[3] + math.pi) % (2 * math.pi) - math.pi
    return math.hypot(b[1] - a[1], b[2] - a[2]) / dt, abs(turn) / dt


class Stop:
    """What the robot did after t0: `v` its speed then, `top` the most until it was to be noticed, `rest` how long it took to stand
    for 0.3 s; None: it did not within 6 s."""

    def __init__(self, rows, t0, notice, within=6.0):
        self.rows, self.t0 = rows, t0
        self.v, self.top, self.rest = 0.0, 0.0, None
        self.zero = None    # how long it took until set points of zero were kept
        self.told = 0.0     # the speed that the base was told to keep as the fault struck [m/s]
        self.orders = None
        begun, first = None, True
        for i, row in enumerate(rows):
            after = row[0] - t0
            if after < 0 or self.rest is not None:
                continue
            if after > within:
                break
            v, w = motion(rows, i)
            if first:
                self.v, first = v, False
            if after <= notice + LATE:
                self.top = max(self.top, v)
            if v > 0.01 or w > 0.03:
                begun = None
            elif begun is None:
                begun = after
            elif after - begun > 0.3:
                self.rest = begun

    def follow(self, orders, fault):
        """`orders`: black_box.SetPoints of the drive."""
        self.orders = orders
        notice, over = ZEROED.get(fault, BRAKES.get(fault, (0.1, 0.1)))
        # As the fault strikes, and until shortly before it must be noticed: a robot that was stopping anyway proves nothing.
        # (A base that does not hear is found out before its own watchdog is.)
        # (A laser that swings shows an explorer walls that are none, and it stops for them sooner.)
        later = 0.2 if fault in SWINGS else min(0.8, 0.6 * notice)
        self.told = 1e-3 * min(orders.at(self.t0)[0], orders.at(self.t0 + later)[0])
        since = orders.zero_since(self.t0 + over - 0.05)
        self.zero = max(0.0, since - self.t0) if since is not None else None

    def drove(self):
        return self.v >= DRIVES and self.told >= DRIVES

    def brakes_between(self, begin, end):
        """Whether it was slower by BRAKING for BRAKED somewhere in that time after the fault, or came to stand."""
        i = 0
        for j, row in enumerate(self.rows):
            if row[0] - self.t0 < begin + BRAKED:
                continue
            if row[0] - self.t0 > end:
                return False
            while self.rows[i][0] < row[0] - BRAKED:
                i += 1
            v = motion(self.rows, j)[0]
            if motion(self.rows, i)[0] - v >= BRAKING * BRAKED or v < 0.01:
                return True
        return False


def broken_law(fault, stop):
    """What the stop should have been, or None."""
    if fault in ZEROED:
        notice, over = ZEROED[fault]
        if stop.zero is None or stop.zero > notice + NOTICED:
            return "set points of zero %s, not within %.2f s" % (
                "were not kept" if stop.zero is None else "after %.2f s" % stop.zero, notice + NOTICED)
        if fault not in DEAF and not stop.brakes_between(notice - 0.1, over + LATE):
            return "set points of zero, but the robot does not brake"
    if fault in BRAKES and not stop.brakes_between(BRAKES[fault][0] - 0.2, BRAKES[fault][1] + LATE):
        return "does not brake"
    if fault in REST:
        most = REST[fault] + stop.top / RAMP + LATE
        if stop.rest is None or stop.rest > most:
            return "at rest after %s, not %.1f s" % ("more than 6 s" if stop.rest is None else "%.1f s" % stop.rest, most)
    if fault in HARD:
        most = HARD[fault] + LATE
        if stop.rest is None or stop.rest > most:
            return "no hard stop"
        again = [t for t in stop.orders.enabled if HARD[fault] + NOTICED < t - stop.t0 < HELD[fault] - LATER.get(fault, 0) - 0.1]
        if again:
            return "motors on again after %.1f s, though nobody let it go" % (again[0] - stop.t0)
    return None


def told_while_driving(lines):
    """What was said of devices once the motors were on: before, all are waited for."""
    told, driving = [], False
    for line in lines:
        driving = driving or "motors on" in line
        if driving and line.startswith("rubble: "):
            told.append(line[8:].strip())
    return told


def rearm(process, emulator, fault):
    while process.poll() is None:
        if time.time() - emulator.faults.get(fault, 1e18) > HELD[fault]:
            process.send_signal(signal.SIGUSR2)
            return
        time.sleep(0.1)


def drive(rubble, robot, fault, at, seconds):
    name = fault or "none"
    shutil.rmtree(name, ignore_errors=True)  # of an attempt before
    mount = MOUNTS.get(name.removesuffix("-said"))
    words = (["--odometry-start", *STARTS[fault]] if fault in STARTS else mount[0] if mount else
             ["--fault", "%s@%g" % (fault, at)] if fault else [])
    said = ["--set", mount[1] if name.endswith("-said") else "safety.give_up_s=5"] if mount else []
    emulator = Emulator(rubble, "--truth", name + ".tum", *words)
    errors = open(name + ".err", "w+")
    process = subprocess.Popen(
        [rubble, "drive", robot, *emulator.words(), "--time-limit", str(seconds), "--out", name, "--set",
         "explorer.victims.search=true", *said], stdout=subprocess.DEVNULL, stderr=errors)
    if fault in HELD:
        threading.Thread(target=rearm, args=(process, emulator, fault), daemon=True).start()
    process.wait()
    emulator.end()
    errors.seek(0)
    told = told_while_driving(errors)
    device = name.split("-")[0]
    over = [device + ": " + word for word in ("reports", "is in time again", "is let go", "obeys again", "works again")]
    lost = [i for i, line in enumerate(told) if line.startswith(device + ": ") and line not in over and "battery is low" not in line]
    back = lost and any(line in over for line in told[lost[-1]:])
    score = subprocess.run([rubble, "score", name + "/map.tif", "truth/truth.tif", "--json"], capture_output=True, text=True)
    score = json.loads(score.stdout)["score"] if score.returncode == 0 else 0.0
    rows = read_truth(name + ".tum")
    notice = ZEROED.get(fault, BRAKES.get(fault, ({**REST, **HARD}.get(fault, 0.3), 0)))[0]
    if fault in ("base-runaway", "base-encoders"):
        notice = 0.3  # what it is told just after is what it goes on with
    stop = Stop(rows, rows[0][0] + at + LATER.get(fault, 0), notice) if fault and not mount else None
    refused = refusal(rows, name + "/devices.bytes") if mount and not said[-1].startswith("devices") else None
    if stop and os.path.exists(name + "/devices.bytes"):
        stop.follow(black_box.SetPoints(name + "/devices.bytes"), fault)
    own = json.load(open(name + "/score.json")) if os.path.exists(name + "/score.json") else {}
    wraps = black_box.rolled_over(name + "/devices.bytes") if fault == "base-wrap" else None
    return dict(name=name, wraps=wraps, refused=refused, word=mount[2] if mount else "", code=process.returncode, score=score, stop=stop, lost=lost, back=back, told=told, at=at, figures=own, rows=rows)


def refusal(rows, path):
    """How far the robot went and turned until its motors were switched off, and whether it stood from then on: (m, rad, s, bool)."""
    orders = [(t, value) for t, number, value in black_box.orders(path) if number == black_box.ENABLE]
    begun = next((t for t, value in orders if value), 0.0)
    stopped = [t for t, value in orders if not value and t > begun > 0.0]
    if not stopped:
        return None
    way = turn = 0.0
    begun = None
    stood = True
    for i in range(10, len(rows), 10):
        a, b = rows[i - 10], rows[i]
        if b[0] < stopped[0]:
            way += math.hypot(b[1] - a[1], b[2] - a[2])
            turn += abs((b[3] - a[3] + math.pi) % (2 * math.pi) - math.pi)
            if begun is None and (way > 0.01 or turn > 0.02):
                begun = b[0]
        elif a[0] > stopped[0] + LATE:
            v, w = motion(rows, i)
            stood = stood and v < 0.01 and w < 0.03
    return way, turn, stopped[0] - (begun or stopped[0]), stood


def moments(rows, first):
    """When a drive without a fault went straight on at a good speed, so that one that strikes then meets a robot that drives [s]."""
    found = []
    for steps in (15, 8, 4):  # of 0.2 s each: a drive that does little else than turn has few long ways
        found, last = [], -1e9
        for i in range(0, len(rows), 5):
            t = rows[i][0] - rows[0][0]
            if t < first or t - last < 0.7:
                continue
            ahead = [motion(rows, j) for j in range(i, min(len(rows), i + 10 * steps), 10)]
            if len(ahead) == steps and all(v > 0.3 and w < 0.3 for v, w in ahead):
                found.append(round(t, 1))
                last = t
        if len(found) >= TRIES:
            break
    return found


def driven(rubble, robot, fault, ats, seconds):
    """Tried again at another moment when the robot did not drive as the fault struck: that says nothing of a stop."""
    for at in (ats * TRIES)[:TRIES]:
        d = drive(rubble, robot, fault, max(1.0, at - LATER.get(fault, 0)), seconds)
        if d["stop"] is None or d["stop"].drove():
            break
    return d


class Timer(threading.Thread):
    """How late this machine wakes a program that sleeps: what a busy one takes from every answer."""

    def __init__(self):
        super().__init__(daemon=True)
        self.late, self.ending = [], False
        self.start()

    def run(self):
        while not self.ending:
            begin = time.monotonic()
            time.sleep(0.02)
            self.late.append(time.monotonic() - begin - 0.02)

    def end(self, part):
        self.ending = True
        self.join()
        return share(self.late, part)


def findings_of(fault, d, plain, late_ms=0.0):
    found = []
    if fault and fault in MOUNTS:
        if d["code"] != 4 or not any(d["word"] in line for line in d["told"]):
            found.append("exit code %d, told: %s" % (d["code"], "; ".join(d["told"])))
        if d["refused"] is None or not d["refused"][3]:
            found.append("was not stopped for good")
        elif d["refused"][0] > MOUNT_WAY or d["refused"][1] > MOUNT_TURN:
            found.append("stopped after %.2f m and %.1f rad" % d["refused"][:2])
        return found
    if d["code"] != 0:
        found.append("exit code %d" % d["code"])
    if fault is None:
        found += ["trouble: " + line for line in d["told"] if " does not obey" in line or "answer" in line or " do not come on" in line]
        if d["score"] < PLAIN_MAP:
            found.append("map %.3f" % d["score"])
        share, answer = d["figures"].get("cpu_share", 1.0), d["figures"].get("answer_ms_99", 1e9)
        if share > MOST_CPU:
            found.append("takes %.1f %% of a core" % (100 * share))
        if answer > MOST_ANSWER_MS + late_ms:
            found.append("answers within %.1f ms, not %.1f" % (answer, MOST_ANSWER_MS + late_ms))
        return found
    if d["lost"] and not d["back"]:
        found.append("not re-connected")
    if d["wraps"] is not None and (d["wraps"] == 0 or d["figures"].get("base_jumps", 1) != 0):
        found.append("rolled over %d times, %s jumps" % (d["wraps"], d["figures"].get("base_jumps")))
    if fault in NAMED and not d["lost"]:
        found.append("not named")
    if d["score"] < plain - WORST_MAP:
        found.append("map %.3f" % d["score"])
    if fault in JUDGED and not d["stop"].drove():
        found.append("was not driving, %d times" % TRIES)
    elif broken_law(fault, d["stop"]):
        found.append(broken_law(fault, d["stop"]))
    return found


def table(arguments):
    rubble = os.path.abspath(arguments.rubble)
    robot = os.path.join(TOP, "robots", "pioneer_urg.yaml")
    open("small.yaml", "w").write(SCENARIO)
    subprocess.run([rubble, "run", "small.yaml", "--set", "time_limit_s=240", "--out", "truth"], check=True,
                   stdout=subprocess.DEVNULL)
    print("load average %s before; the fault strikes %g s after the emulator's start or later, drives of %g s at most" %
          (load(), arguments.at, arguments.seconds))
    print("\n| fault | speed then | set points zero after | at rest after | exit code | named | re-connected | map score |\n"
          "|---|---|---|---|---|---|---|---|")
    bad, notes, faults = {}, [], arguments.faults.split()
    timer = Timer()
    d = drive(rubble, robot, None, arguments.at, arguments.seconds)
    d0 = d["figures"]
    late_ms = 1e3 * timer.end(0.99)
    plain, found = d["score"], findings_of(None, d, None, late_ms)
    if found:
        bad["none"] = found
    print("| none | | | | %d | | | %.3f |" % (d["code"], plain), flush=True)
    ats = moments(d["rows"], arguments.at)[:arguments.moments] or [arguments.at]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        drives = [pool.submit(driven, rubble, robot, fault, ats, arguments.seconds) for fault in faults]
        for fault, one in zip(faults, drives):
            d = one.result()
            stop = d["stop"]
            notice = ZEROED.get(fault, (0, 0))[0]
            if stop is None:  # a mount
                rest = "after %.2f m, %.0f deg, %.1f s" % (d["refused"][0], math.degrees(d["refused"][1]), d["refused"][2]) if d["refused"] else "drives on"
                print("| `%s` | | | %s | %d | %s | | %s |" % (fault, rest, d["code"], "yes" if d["lost"] else "no", "" if d["refused"] else "%.3f" % d["score"]), flush=True)
                found = findings_of(fault, d, plain)
                if found:
                    bad[fault] = found
                continue
            zero = "%.2f s" % stop.zero if fault in ZEROED and stop.zero is not None else "NOT" if fault in ZEROED else ""
            slowest = notice + stop.top / RAMP + LATE
            rest = ("%.1f s" % stop.rest if stop.rest is not None and (fault in JUDGED or stop.rest < slowest) else
                    "told, but deaf" if fault in DEAF else
                    "brakes until it is over" if (fault in ZEROED or fault in BRAKES) and broken_law(fault, stop) is None else "drives on")
            named = "yes" if d["lost"] else "no"
            back = "yes" if d["back"] else ("NO" if d["lost"] else "was not lost")
            print("| `%s` | %.2f m/s | %s | %s | %d | %s | %s | %.3f |" %
                  (fault, stop.v, zero, rest, d["code"], named, back, d["score"]), flush=True)
            if d["wraps"] is not None:
                notes.append("%s: rolled over %d times, %s jumps" % (fault, d["wraps"], d["figures"].get("base_jumps")))
            found = findings_of(fault, d, plain)
            if found:
                bad[fault] = found
    print("\nload average %s after; without a fault %.1f %% of a core, answers within %.1f ms (99 %%), this machine's timer late by %.1f ms (99 %%)" %
          (load(), 100 * d0.get("cpu_share", 1.0), d0.get("answer_ms_99", 1e9), late_ms))
    for note in notes:
        print(note)
    for fault, found in bad.items():
        print("%s: %s" % (fault, "; ".join(found)))
    print("faults: %d, findings: %d" % (len(faults), len(bad)))
    return 1 if bad else 0


def share(values, part):
    values = sorted(values)
    return values[int(part * (len(values) - 1))] if values else 0.0


class ScanClient(threading.Thread):
    """Reads scans by SCIP 2.0 and notes when each began to arrive."""

    def __init__(self, port, seconds):
        super().__init__()
        host, number = port[4:].rsplit(":", 1)
        self.line = socket.create_connection((host, int(number)))
        self.seconds, self.arrivals = seconds, []

    def run(self):
        for command in (b"SCIP2.0\n", b"BM\n", b"MD0044072501000\n"):
            self.line.sendall(command)
            time.sleep(0.2)
            self.line.recv(65536)
        end, silent_since = time.time() + self.seconds, 0.0
        while time.time() < end:
            select.select([self.line], [], [], 1.0)
            now = time.monotonic()
            if now - silent_since > 0.03:  # the pieces of one scan follow each other at once
                self.arrivals.append(now)
            silent_since = now
            if not self.line.recv(65536):
                break


def three(arguments):
    """Scans come every 100 ms from each of three robots, each driven by the explorer; told by what clients see."""
    rubble = os.path.abspath(arguments.rubble)
    open("small.yaml", "w").write(SCENARIO)
    before = load()
    emulators = [Emulator(rubble, "--seed", str(i + 1)) for i in range(3)]
    clients = [ScanClient(e.ports["urg"], arguments.seconds) for e in emulators]
    timer = []

    def tick():
        begin = time.monotonic()
        for i in range(1, int(10 * arguments.seconds)):
            time.sleep(max(0.0, begin + 0.1 * i - time.monotonic()))
            timer.append(time.monotonic() - begin - 0.1 * i)

    clock = threading.Thread(target=tick)
    for thread in [*clients, clock]:
        thread.start()
    for thread in [*clients, clock]:
        thread.join()
    for emulator in emulators:
        emulator.end()
    print("three emulated robots at once, %g s, load average %s before, %s after (%d cores)" %
          (arguments.seconds, before, load(), os.cpu_count()))
    print("\n| | scans | a second | jitter 95 % | worst |\n|---|---|---|---|---|")
    allowed = MOST_JITTER + share(timer, 0.95)
    bad = []
    for number, client in enumerate(clients, 1):
        a = client.arrivals
        if len(a) < 2:
            bad.append("robot %d: no scans" % number)
            continue
        rate = (len(a) - 1) / (a[-1] - a[0])
        # Lateness against the scanner's own clock: the line under the arrivals, 0.1 s a scan.
        base = min(t - 0.1 * i for i, t in enumerate(a))
        late = [t - 0.1 * i - base for i, t in enumerate(a)] if abs(rate - 10) < 0.05 else []
        gaps = [abs(y - x - 0.1) for x, y in zip(a, a[1:])]
        print("| robot %d, from scan to scan | %d | %.2f | %.2f ms | %.2f ms |" %
              (number, len(a), rate, 1e3 * share(gaps, 0.95), 1e3 * max(gaps)))
        if late:
            print("| robot %d, late | | | %.2f ms | %.2f ms |" % (number, 1e3 * share(late, 0.95), 1e3 * max(late)))
        if abs(rate - 10) > 0.05:
            bad.append("robot %d: %.2f scans a second" % (number, rate))
        if share(gaps, 0.95) > allowed:
            bad.append("robot %d: jitter of %.2f ms, not %.2f" % (number, 1e3 * share(gaps, 0.95), 1e3 * allowed))
    print("| this machine's timer, late | | | %.2f ms | %.2f ms |" % (1e3 * share(timer, 0.95), 1e3 * max(timer)))
    for finding in bad:
        print(finding)
    print("robots: 3, findings: %d" % len(bad))
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rubble", default=os.path.join(TOP, "build", "release", "rubble"))
    parser.add_argument("--faults", default=" ".join(FAULTS))
    parser.add_argument("--seconds", type=float, default=110.0)
    parser.add_argument("--at", type=float, default=14.0)
    parser.add_argument("--moments", type=int, default=TRIES, help="of so many the first that meets a robot that drives counts")
    parser.add_argument("--jobs", type=int, default=1, help="so many drives side by side")
    parser.add_argument("--keep", metavar="DIR", help="run folders, true tracks and what was told are left there")
    parser.add_argument("--three", action="store_true")
    arguments = parser.parse_args()
    arguments.rubble = os.path.abspath(arguments.rubble)
    os.environ.setdefault("RUBBLE_HOME", TOP)
    with tempfile.TemporaryDirectory() as folder:
        if arguments.keep:
            os.makedirs(arguments.keep, exist_ok=True)
        os.chdir(arguments.keep or folder)
        code = three(arguments) if arguments.three else table(arguments)
        os.chdir(TOP)
    sys.exit(code)


main()
