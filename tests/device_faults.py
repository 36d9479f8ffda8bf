#!/usr/bin/env python3
"""The table fault x (standstill, exit code, map score, re-connected) of docs/hardware.md, one drive a fault in real time.

  tests/device_faults.py [--rubble build/release/rubble] [--faults "urg-silence base-unplug ..."] [--seconds 110] [--at 14] [--jobs 1]
  tests/device_faults.py --three    three emulated robots at once: jitter of their scans, and of this machine's timer

Prints a table in Markdown, a row as soon as it is known. Ends with 1 and names what was broken:
- a drive ends with another code than 0, or a device that was lost does not come back (after a stop at the robot SIGUSR2 lets it go);
- a fault that must stop the robot does not bring it to rest, or slow it down, within the time it takes to notice plus that of braking;
  by the emulator's own clock, so that only what a busy machine keeps the driver waiting counts against it;
- a fault that must be told is not, or the map is worse by 0.05 than without a fault, or that one is bad;
- the drive without a fault takes more than 15 % of a core, or 99 % of its answers to a scan take longer than 30 ms and what the machine's
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

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DEVICES = ("urg", "base", "levelling")
FAULTS = [d + "-" + f for d in DEVICES for f in "lost split doubled junk sums silence unplug reset".split()]
FAULTS += ["urg-wrap", "base-seto", "base-stall", "base-watchdog", "base-button", "base-motors", "levelling-sensor"]
HELD = ("base-button", "base-motors")  # stopped at the robot: the operator lets it go again, so long after the fault [s]
REARM = 6.0
# What a fault must do to a robot that drives, and how long it may take to be noticed [s] (safety: in the robot file, the base's own
# watchdog). REST: it stands. SLOW: it brakes, but the fault is over before it stands. Others may pass unnoticed.
REST = {"urg-silence": 0.3, "urg-unplug": 0.3, "base-unplug": 0.1, "base-reset": 0.1, "levelling-unplug": 0.5}
HARD = {"base-button": 0.1, "base-motors": 0.1}  # at once, without a ramp
SLOW = {"urg-lost": 0.3, "urg-doubled": 0.3, "urg-junk": 0.3, "urg-sums": 0.3, "urg-reset": 0.3, "levelling-silence": 0.5,
        "base-watchdog": 2.0}
# A base that is silent for 2 s cannot be told to stop, and its watchdog needs as long: it must only be told. A deaf one reports.
NAMED = {"levelling-sensor", "base-silence", *REST, *HARD, *SLOW} - {"base-watchdog"}
RAMP = 0.3          # the firmware's deceleration [m/s^2]
LATE = 0.35         # a scan's period, the driver's turns, the wheels' lag, the window of a speed [s]
SLOWED = 0.08       # so much slower counts as braking [m/s]
DRIVES = 0.15       # slower than this says nothing of a stop: the fault is tried again later [m/s]
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
    for 0.3 s, `slow` to be slower than `top` by SLOWED; None: it did not within 6 s."""

    def __init__(self, rows, t0, notice, within=6.0):
        self.v, self.top, self.rest, self.slow = 0.0, 0.0, None, None
        begun = None
        for i, row in enumerate(rows):
            after = row[0] - t0
            if after < 0 or self.rest is not None:
                continue
            if after > within:
                break
            v, w = motion(rows, i)
            if self.top == 0.0:
                self.v = v
            if after <= notice + LATE:
                self.top = max(self.top, v)
            if self.slow is None and after > 0.05 and v < self.top - SLOWED:
                self.slow = after
            if v > 0.01 or w > 0.03:
                begun = None
            elif begun is None:
                begun = after
            elif after - begun > 0.3:
                self.rest = begun


def broken_law(fault, stop):
    """What the stop should have been, or None."""
    if fault in REST:
        most = REST[fault] + stop.top / RAMP + LATE
        if stop.rest is None or stop.rest > most:
            return "at rest after %s, not %.1f s" % ("more than 6 s" if stop.rest is None else "%.1f s" % stop.rest, most)
    if fault in HARD:
        most = HARD[fault] + LATE
        if stop.rest is None or stop.rest > most:
            return "no hard stop"
    if fault in SLOW:
        most = SLOW[fault] + SLOWED / RAMP + LATE
        if stop.slow is None or stop.slow > most:
            return "does not brake within %.1f s" % most
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
        if time.time() - emulator.faults.get(fault, 1e18) > REARM:
            process.send_signal(signal.SIGUSR2)
            return
        time.sleep(0.1)


def drive(rubble, robot, fault, at, seconds):
    name = fault or "none"
    shutil.rmtree(name, ignore_errors=True)  # of an attempt before
    emulator = Emulator(rubble, "--truth", name + ".tum", *(["--fault", "%s@%g" % (fault, at)] if fault else []))
    errors = open(name + ".err", "w+")
    process = subprocess.Popen(
        [rubble, "drive", robot, *emulator.words(), "--time-limit", str(seconds), "--out", name, "--set",
         "explorer.victims.search=true"], stdout=subprocess.DEVNULL, stderr=errors)
    if fault in HELD:
        threading.Thread(target=rearm, args=(process, emulator, fault), daemon=True).start()
    process.wait()
    emulator.end()
    errors.seek(0)
    told = told_while_driving(errors)
    device = name.split("-")[0]
    lost = [i for i, line in enumerate(told) if line.startswith(device + ": ") and not line.endswith(": reports")]
    back = lost and device + ": reports" in told[lost[-1]:]
    score = subprocess.run([rubble, "score", name + "/map.tif", "truth/truth.tif", "--json"], capture_output=True, text=True)
    score = json.loads(score.stdout)["score"] if score.returncode == 0 else 0.0
    rows = read_truth(name + ".tum")
    notice = {**REST, **HARD, **SLOW}.get(fault, 0.3)
    stop = Stop(rows, rows[0][0] + at, notice) if fault else None
    own = json.load(open(name + "/score.json")) if os.path.exists(name + "/score.json") else {}
    return dict(name=name, code=process.returncode, score=score, stop=stop, lost=lost, back=back, at=at, figures=own)


def driven(rubble, robot, fault, at, seconds):
    """Tried again a little later when the robot hardly drove as the fault struck: that says nothing of a stop."""
    d = drive(rubble, robot, fault, at, seconds)
    judged = fault in {**REST, **HARD, **SLOW}
    for _ in range(2):
        if not judged or d["stop"].v >= DRIVES:
            break
        at += 2.3
        d = drive(rubble, robot, fault, at, seconds)
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
    if d["code"] != 0:
        found.append("exit code %d" % d["code"])
    if fault is None:
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
    if fault in NAMED and not d["lost"]:
        found.append("not named")
    if d["score"] < plain - WORST_MAP:
        found.append("map %.3f" % d["score"])
    judged = fault in {**REST, **HARD, **SLOW}
    if judged and d["stop"].v < DRIVES:
        found.append("was not driving, three times")
    elif broken_law(fault, d["stop"]):
        found.append(broken_law(fault, d["stop"]))
    return found


def table(arguments):
    rubble = os.path.abspath(arguments.rubble)
    robot = os.path.join(TOP, "robots", "pioneer_urg.yaml")
    open("small.yaml", "w").write(SCENARIO)
    subprocess.run([rubble, "run", "small.yaml", "--set", "time_limit_s=240", "--out", "truth"], check=True,
                   stdout=subprocess.DEVNULL)
    print("load average %s before; the fault strikes %g s after the emulator's start, drives of %g s at most" %
          (load(), arguments.at, arguments.seconds))
    print("\n| fault | speed then | at rest after | exit code | named | re-connected | map score |\n|---|---|---|---|---|---|---|")
    bad, faults = {}, arguments.faults.split()
    timer = Timer()
    d = drive(rubble, robot, None, arguments.at, arguments.seconds)
    d0 = d["figures"]
    late_ms = 1e3 * timer.end(0.99)
    plain, found = d["score"], findings_of(None, d, None, late_ms)
    if found:
        bad["none"] = found
    print("| none | | | %d | | | %.3f |" % (d["code"], plain), flush=True)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        drives = [pool.submit(driven, rubble, robot, fault, arguments.at, arguments.seconds) for fault in faults]
        for fault, one in zip(faults, drives):
            d = one.result()
            stop = d["stop"]
            rest = ("%.1f s" % stop.rest if stop.rest is not None else
                    "slower after %.1f s" % stop.slow if fault in SLOW and stop.slow is not None else "does not rest")
            named = "yes" if d["lost"] else "no"
            back = "yes" if d["back"] else ("NO" if d["lost"] else "was not lost")
            print("| `%s` | %.2f m/s | %s | %d | %s | %s | %.3f |" %
                  (fault, stop.v, rest, d["code"], named, back, d["score"]), flush=True)
            found = findings_of(fault, d, plain)
            if found:
                bad[fault] = found
    print("\nload average %s after; without a fault %.1f %% of a core, answers within %.1f ms (99 %%), this machine's timer late by %.1f ms (99 %%)" %
          (load(), 100 * d0.get("cpu_share", 1.0), d0.get("answer_ms_99", 1e9), late_ms))
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
    parser.add_argument("--jobs", type=int, default=1, help="so many drives side by side")
    parser.add_argument("--three", action="store_true")
    arguments = parser.parse_args()
    arguments.rubble = os.path.abspath(arguments.rubble)
    os.environ.setdefault("RUBBLE_HOME", TOP)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        code = three(arguments) if arguments.three else table(arguments)
        os.chdir(TOP)
    sys.exit(code)


main()
