#!/usr/bin/env python3
"""The table fault x (standstill, exit code, map score, re-connected) of docs/hardware.md, one drive a fault in real time.

  tests/device_faults.py [--rubble build/release/rubble] [--faults "urg-silence base-unplug ..."] [--seconds 110] [--at 14]
  tests/device_faults.py --three    three emulated robots at once: jitter of their scans, and of this machine's timer

Prints a table in Markdown, a row as soon as it is known. Ends with 1 when a drive did not end well: a crash, a device that
did not come back (after a stop at the robot it is let go again by SIGUSR2), or a map worse by 0.05 than that of a drive without a fault.
"""
import argparse
import json
import math
import os
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


def speed_and_rest(rows, t0, within=6.0):
    """Speed at t0, and how long after it the robot came to rest for 0.3 s; None: it did not within that time."""
    first = next((i for i, row in enumerate(rows) if row[0] >= t0), None)
    if first is None:
        return 0.0, None
    rest = None
    for i in range(first, len(rows)):
        if rows[i][0] > t0 + within:
            break
        v, w = motion(rows, i)
        if v > 0.01 or w > 0.03:
            rest = None
        elif rest is None:
            rest = rows[i][0]
        elif rows[i][0] - rest > 0.3:
            return motion(rows, first)[0], rest - t0
    return motion(rows, first)[0], None


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
    v, rest = speed_and_rest(read_truth(name + ".tum"), emulator.faults.get(fault, 1e18))
    return dict(name=name, code=process.returncode, score=score, v=v, rest=rest, lost=lost, back=back)


def table(arguments):
    rubble = os.path.abspath(arguments.rubble)
    robot = os.path.join(TOP, "robots", "pioneer_urg.yaml")
    open("small.yaml", "w").write(SCENARIO)
    subprocess.run([rubble, "run", "small.yaml", "--set", "time_limit_s=240", "--out", "truth"], check=True,
                   stdout=subprocess.DEVNULL)
    print("load average %s before; the fault strikes %g s after the emulator's start, drives of %g s at most" %
          (load(), arguments.at, arguments.seconds))
    print("\n| fault | speed then | at rest after | exit code | named | re-connected | map score |\n|---|---|---|---|---|---|---|")
    bad, plain = [], None
    for fault in [None] + arguments.faults.split():
        d = drive(rubble, robot, fault, arguments.at, arguments.seconds)
        if fault is None:
            plain = d["score"]
            print("| none | | | %d | | | %.3f |" % (d["code"], d["score"]), flush=True)
            continue
        rest = "does not rest" if d["rest"] is None else "%.1f s" % d["rest"]
        named = "yes" if d["lost"] else "no"
        back = "yes" if d["back"] else ("NO" if d["lost"] else "was not lost")
        print("| `%s` | %.2f m/s | %s | %d | %s | %s | %.3f |" % (fault, d["v"], rest, d["code"], named, back, d["score"]),
              flush=True)
        if d["code"] != 0 or back == "NO" or d["score"] < plain - 0.05:
            bad.append(fault)
    print("\nload average %s after" % load())
    print("faults: %d, findings: %d%s" % (len(arguments.faults.split()), len(bad), " (%s)" % ", ".join(bad) if bad else ""))
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
    for number, client in enumerate(clients, 1):
        a = client.arrivals
        rate = (len(a) - 1) / (a[-1] - a[0])
        # Lateness against the scanner's own clock: the line under the arrivals, 0.1 s a scan.
        base = min(t - 0.1 * i for i, t in enumerate(a))
        late = [t - 0.1 * i - base for i, t in enumerate(a)] if abs(rate - 10) < 0.05 else []
        gaps = [abs(y - x - 0.1) for x, y in zip(a, a[1:])]
        print("| robot %d, from scan to scan | %d | %.2f | %.2f ms | %.2f ms |" %
              (number, len(a), rate, 1e3 * share(gaps, 0.95), 1e3 * max(gaps)))
        if late:
            print("| robot %d, late | | | %.2f ms | %.2f ms |" % (number, 1e3 * share(late, 0.95), 1e3 * max(late)))
    print("| this machine's timer, late | | | %.2f ms | %.2f ms |" % (1e3 * share(timer, 0.95), 1e3 * max(timer)))
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rubble", default=os.path.join(TOP, "build", "release", "rubble"))
    parser.add_argument("--faults", default=" ".join(FAULTS))
    parser.add_argument("--seconds", type=float, default=110.0)
    parser.add_argument("--at", type=float, default=14.0)
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
