"""Drives emulated robots as an operator does, at a terminal: rubble emulate, rubble drive on a pty, keys and signals.

usage: operator.py RUBBLE ROBOT.yaml SCENARIO.yaml keys|signals|held; run in an empty folder. Prints what happened, ends with 1 when a law is
broken. Times are printed and not judged but for a bound that no loaded machine breaks.
"""
import math
import os
import pty
import select
import signal
import subprocess
import sys
import time

RUBBLE, ROBOT, SCENARIO, PART = sys.argv[1:]
LONGEST_STOP = 6.0  # [s] 0.3 s and 0.4 m/s at 0.3 m/s2 are 1.7 s; the rest is for a machine that has other work
failures = 0


def check(law, text):
    global failures
    print(("ok      " if law else "FAILED  ") + text, flush=True)
    failures += 0 if law else 1


def truth():
    """(time, x, y, heading) of every tick so far."""
    rows = []
    for line in open("truth.tum").read().splitlines():
        field = line.split()
        if len(field) == 8:
            t, x, y, _, _, _, qz, qw = map(float, field)
            rows.append((t, x, y, 2 * math.atan2(qz, qw)))
    return rows


def moves(rows, i, span=5):
    """Whether the robot moves about row i: over 50 ms."""
    a, b = rows[max(0, i - span)], rows[i]
    dt = max(1e-3, b[0] - a[0])
    turn = (b[3] - a[3] + math.pi) % (2 * math.pi) - math.pi
    return math.hypot(b[1] - a[1], b[2] - a[2]) / dt > 0.01 or abs(turn) / dt > 0.03


def speed(rows, t):
    i = next((k for k, row in enumerate(rows) if row[0] >= t), len(rows) - 1)
    a, b = rows[max(0, i - 5)], rows[i]
    return math.hypot(b[1] - a[1], b[2] - a[2]) / max(1e-3, b[0] - a[0])


def standstill(t0, window=LONGEST_STOP):
    """Seconds from t0 until the robot rests (for half a second at least); None: it does not."""
    deadline = time.time() + window + 3
    while time.time() < deadline:
        rows = truth()
        if rows and rows[-1][0] > t0 + window:
            break
        time.sleep(0.2)
    rows = truth()
    rest_since = None
    for i, row in enumerate(rows):
        if row[0] < t0 or i < 5:
            continue
        if moves(rows, i):
            rest_since = None
        elif rest_since is None:
            rest_since = row[0]
        elif row[0] - rest_since > 0.5:
            return rest_since - t0
    return None


def check_stop(what, t0):
    took = standstill(t0)
    v = speed(truth(), t0)
    told = "never" if took is None else "%.2f s" % took
    check(took is not None and took < LONGEST_STOP, "%s at %.2f m/s: at rest after %s" % (what, v, told))


def wait_for(law, seconds=40.0):
    deadline = time.time() + seconds
    while time.time() < deadline:
        if law():
            return True
        time.sleep(0.05)
    return False


def drives_now():
    rows = truth()
    return len(rows) > 10 and speed(rows, rows[-1][0]) > 0.1


class Drive:
    """rubble drive on a terminal of its own."""

    def __init__(self, out, *words):
        self.text = ""
        self.pid, self.file = pty.fork()
        if self.pid == 0:
            os.execv(RUBBLE, [RUBBLE, "drive", ROBOT, *PORTS, "--out", out, *words])

    def look(self, seconds=0.0):
        """Takes what the drive has printed meanwhile."""
        deadline = time.time() + seconds
        while True:
            ready, _, _ = select.select([self.file], [], [], max(0.0, deadline - time.time()))
            if not ready:
                return self.text
            try:
                piece = os.read(self.file, 4096)
            except OSError:  # the other end is closed
                return self.text
            if not piece:
                return self.text
            self.text += piece.decode(errors="replace")

    def press(self, keys):
        os.write(self.file, keys.encode())

    def hold(self, key, seconds):
        """As a terminal repeats a held key: 0.3 s pause, then 20 a second."""
        self.press(key)
        end = time.time() + seconds
        time.sleep(0.3)
        while time.time() < end:
            self.press(key)
            self.look(0.05)

    def wait(self, seconds=30.0):
        """Exit code; None: it does not end."""
        deadline = time.time() + seconds
        while time.time() < deadline:
            self.look(0.1)
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                return os.waitstatus_to_exitcode(status)
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        return None


def emulate(*words):
    """The emulator, and where its devices are as words for a drive."""
    process = subprocess.Popen(
        [RUBBLE, "emulate", SCENARIO, "--urg", "tcp:127.0.0.1:0", "--base", "tcp:127.0.0.1:0", "--levelling",
         "tcp:127.0.0.1:0", "--truth", "truth.tum", *words], stdout=subprocess.PIPE, text=True)
    ports = []
    for line in process.stdout:
        if line.strip() == "ready":
            break
        device, port = line.split()
        ports += ["--" + device, port]
    return process, ports


def keys():
    """What is pressed or typed at the terminal."""
    # Teleoperation: a held key drives, letting go stops, space stops, Q ends.
    drive = Drive("teleop", "--teleop")
    check(wait_for(lambda: "motors on" in drive.look()), "teleoperation: ready, motors on")
    drive.hold("w", 2.5)
    let_go = time.time()
    check_stop("teleoperation: key let go", let_go)
    rows = truth()
    check(math.hypot(rows[-1][1] - rows[0][1], rows[-1][2] - rows[0][2]) > 0.3, "teleoperation: the robot drove")
    before = truth()[-1][3]
    drive.hold("\x1b[D", 1.5)
    drive.press(" ")
    check_stop("teleoperation: arrow held, then space", time.time())
    turned = (truth()[-1][3] - before + math.pi) % (2 * math.pi) - math.pi
    check(turned > 0.3, "teleoperation: arrow left turned it left by %.0f deg" % math.degrees(turned))
    before = truth()[-1][3]
    drive.hold("\x1bOC", 1.5)  # as a terminal in application mode sends it
    drive.press(" ")
    check_stop("teleoperation: the other kind of arrow", time.time())
    turned = (truth()[-1][3] - before + math.pi) % (2 * math.pi) - math.pi
    check(turned < -0.3, "teleoperation: arrow right turned it right by %.0f deg" % -math.degrees(turned))
    drive.hold("w", 1.5)
    drive.press("\x1b")
    check_stop("teleoperation: W held, then ESC", time.time())
    # However long after an ESC, the next key is one of its own.
    drive.press("q")
    check(drive.wait() == 130, "teleoperation: Q ends the drive with 130, also after ESC")
    check("no terminal" not in drive.text, "teleoperation: there is a terminal")
    check(os.path.getsize("teleop/score.json") > 0, "teleoperation: its folder is complete")

    # Any key is the emergency stop.
    drive = Drive("key")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "exploring: it drives")
    pressed = time.time()
    drive.press("x")
    code = drive.wait()
    check(code == 130 and "emergency stop" in drive.text, "a key ends the drive with 130 (%s)" % code)
    check_stop("a key", pressed)

    # Keys are heard while devices are waited for.
    drive = Drive("waiting", "--teleop", "--heartbeat", "nobody_touches_this")
    check(wait_for(lambda: "heartbeat: has not reported" in drive.look()), "waiting: it waits for the heartbeat")
    drive.press("wwwq")
    check(drive.wait(15) == 130, "waiting: Q ends a drive that waits")

    # Ctrl-C at the terminal.
    drive = Drive("interrupt")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "exploring: it drives")
    sent = time.time()
    drive.press("\x03")
    check(drive.wait() == 130, "Ctrl-C ends the drive with 130")
    check_stop("Ctrl-C", sent)
    check(os.path.getsize("interrupt/score.json") > 0, "Ctrl-C: its folder is complete")

    # An operator who falls silent, and comes back.
    def touch():
        open("beat", "a").close()
        os.utime("beat")

    drive = Drive("heartbeat", "--heartbeat", "beat", "--set", "safety.operator_silence_s=0.3")

    def beat_until_driving():
        touch()
        drive.look()
        return drives_now()

    check(wait_for(beat_until_driving, 60.0), "heartbeat: it drives while the file is touched")
    touch()
    last = time.time()
    check_stop("heartbeat: silent", last)
    check("heartbeat: silent" in drive.look() and "must be touched" in drive.text, "heartbeat: its silence is told")
    check(wait_for(beat_until_driving, 60.0), "heartbeat: it drives on when the file is touched again")
    check("heartbeat: reports" in drive.look(), "heartbeat: its return is told")
    drive.press("x")
    check(drive.wait() is not None, "heartbeat: a key ends the drive")


def signals():
    """What the system sends."""
    # So is SIGUSR1.
    drive = Drive("signal")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "exploring: it drives")
    sent = time.time()
    os.kill(drive.pid, signal.SIGUSR1)
    code = drive.wait()
    check(code == 130 and "emergency stop" in drive.text, "SIGUSR1 ends the drive with 130 (%s)" % code)
    check_stop("SIGUSR1", sent)

    # What else a terminal can send stops too, and leaves a whole folder: no drive is ended or suspended on the spot.
    for name, strike in (
            ("Ctrl-Z", lambda: drive.press("\x1a")), ("Ctrl-backslash", lambda: drive.press("\x1c")),
            # What a terminal keeps for itself unless it is told not to, and a byte of zero.
            ("Ctrl-S", lambda: drive.press("\x13")), ("Ctrl-Q", lambda: drive.press("\x11")),
            ("Ctrl-Space", lambda: drive.press("\0")),
            # A terminal that is closed sends it twice: its shell and the system do.
            ("SIGHUP", lambda: [os.kill(drive.pid, signal.SIGHUP) or time.sleep(0.1) for _ in range(2)]),
            ("SIGQUIT", lambda: os.kill(drive.pid, signal.SIGQUIT)),
            ("SIGTSTP", lambda: os.kill(drive.pid, signal.SIGTSTP)),
            ("SIGALRM", lambda: os.kill(drive.pid, signal.SIGALRM)),
            ("SIGXCPU", lambda: [os.kill(drive.pid, signal.SIGXCPU) for _ in range(3)]),
            ("SIGRTMIN", lambda: os.kill(drive.pid, signal.SIGRTMIN))):
        drive = Drive(name)
        check(wait_for(lambda: "motors on" in drive.look()), name + ": motors on")
        sent = time.time()
        strike()
        code = drive.wait()
        check(code == 130, "%s ends the drive with 130 (%s)" % (name, code))
        check_stop(name, sent)
        check(os.path.exists(name + "/score.json"), name + ": its folder is complete")

    # A second Ctrl-C is in a hurry: the base is told to stop, whatever else is left undone.
    drive = Drive("hurry")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "exploring: it drives")
    sent = time.time()
    os.kill(drive.pid, signal.SIGINT)
    time.sleep(0.002)
    os.kill(drive.pid, signal.SIGINT)
    check(drive.wait() == 130, "two Ctrl-C end the drive with 130")
    check_stop("two Ctrl-C", sent)

    # Who reads what the drive prints may go: the drive does not end of it.
    piped = subprocess.Popen([RUBBLE, "drive", ROBOT, *PORTS, "--out", "piped"], stdin=subprocess.DEVNULL,
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    for line in piped.stderr:
        if "motors on" in line:
            break
    piped.stderr.close()
    time.sleep(3.0)
    check(piped.poll() is None, "a broken pipe does not end the drive (%s)" % piped.poll())
    sent = time.time()
    piped.send_signal(signal.SIGINT)
    check(piped.wait(30) == 130, "after a broken pipe Ctrl-C ends it with 130 (%s)" % piped.returncode)
    check_stop("Ctrl-C after a broken pipe", sent)


def held():
    """Who stopped the robot at the robot, twice."""
    # Whoever stopped the robot at the robot is obeyed, whatever the operator had said before; R, also as a capital, lets it go.
    drive = Drive("held")
    check(wait_for(lambda: "motors on" in drive.look()), "held: motors on")
    os.kill(drive.pid, signal.SIGUSR2)  # too early: nothing is held
    check(wait_for(lambda: "base: held" in drive.look()), "held: it is told")
    held = time.time()
    check_stop("held", held)
    time.sleep(2.0)
    rows = truth()
    check(not moves(rows, len(rows) - 1), "held: it stays, though SIGUSR2 came before")
    check("base: is let go" not in drive.look().split("base: held")[1], "held: no word of its return")
    drive.press("R")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "held: R lets it go")
    check("base: is let go" in drive.look().split("base: held")[1], "held: its return is told")
    # The second time somebody at another terminal lets it go.
    check(wait_for(lambda: drive.look().count("base: held") == 2), "held again: it is told")
    check_stop("held again", time.time())
    os.kill(drive.pid, signal.SIGUSR2)
    check(wait_for(lambda: drive.look().count("base: is let go") == 2), "held again: SIGUSR2 lets it go")
    check(wait_for(lambda: drive.look() is not None and drives_now()), "held again: it drives")
    drive.press("x")
    check(drive.wait() == 130, "held: a key ends the drive")


parts = {"keys": keys, "signals": signals, "held": held}
emulator, PORTS = emulate(*(["--fault", "base-motors@15", "--fault", "base-motors@45"] if PART == "held" else []))
try:
    parts[PART]()
finally:
    emulator.send_signal(signal.SIGINT)
    emulator.wait(20)

print("load of the machine:", open("/proc/loadavg").read().split()[0])
sys.exit(1 if failures else 0)
