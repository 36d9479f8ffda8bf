"""A client of ARCOS on TCP or a pty, written from the Pioneer manuals' tables and from what ARIA and Player send and demand,
not from rubble's driver: it checks an emulated Pioneer 3-AT clause by clause.

  arcos_client.py PORT [hardware]    PORT: tcp:HOST:PORT or pty:PATH; `hardware`: the base must not say it is a simulator.
Ends with 1 and one line a broken clause."""
import math
import os
import select
import struct
import sys
import time

from arcos_wire import checksum, order, packet
from device_port import DevicePort, end_with_verdict, law

hardware = len(sys.argv) > 2


class Base(DevicePort):
    def __init__(self, word):
        super().__init__(word)
        self.waiting = b""
        self.kept = []

    def send(self, *packets):
        for p in packets:
            os.write(self.file, p)
            time.sleep(0.005)

    def next(self, timeout=1.0):
        """The next packet's payload and when it came; every sum must be right and nothing may stand between packets."""
        end = time.time() + timeout
        while True:
            if len(self.waiting) >= 3:
                law(self.waiting[:2] == b"\xfa\xfb", "bytes between packets: %s" % self.waiting[:8].hex())
                size = self.waiting[2] + 3
                law(size <= 200 + 3, "a packet of %d bytes" % size)
                if len(self.waiting) >= size:
                    whole, self.waiting = self.waiting[:size], self.waiting[size:]
                    payload = whole[3:-2]
                    law(struct.unpack(">H", whole[-2:])[0] == checksum(payload), "a wrong sum")
                    return payload, time.time()
            left = end - time.time()
            if left <= 0 or not select.select([self.file], [], [], left)[0]:
                return None, time.time()
            self.waiting += os.read(self.file, 4096)

    def wait(self, kinds, timeout=1.0):
        end = time.time() + timeout
        while time.time() < end:
            payload, _ = self.next(end - time.time())
            if payload is not None and payload[0] in kinds:
                return payload
        return None

    def report(self, timeout=1.0):
        payload = self.wait((0x32, 0x33), timeout)
        return None if payload is None else Report(payload)

    def reports(self, seconds, packets=(), every=0.5):
        """All reports of so long; the packets are sent again and again, as clients do."""
        end, again, all_of_them = time.time() + seconds, 0.0, []
        while time.time() < end:
            if packets and time.time() >= again:
                self.send(*packets)
                again = time.time() + every
            got = self.report(0.3)
            if got:
                all_of_them.append(got)
        return all_of_them


class Report:
    def __init__(self, p):
        self.payload = p
        self.moving = p[0] == 0x33
        self.x, self.y, self.heading, self.left, self.right = struct.unpack("<HHhhh", p[1:11])
        self.battery = 0.1 * p[11]
        self.stall, self.control, self.flags = struct.unpack("<HhH", p[12:18])
        self.sonars = p[19]
        at = 20 + 3 * self.sonars + 5
        self.battery_fine, = struct.unpack("<H", p[at:at + 2])
        self.charge = p[at + 2]
        self.turn_rate, self.faults = struct.unpack("<hH", p[at + 3:at + 7])
        self.angle = self.heading * 360.0 / 4096

    motors = property(lambda self: self.flags & 1)
    speed = property(lambda self: 0.5 * (self.left + self.right))


def wrapped(a, b, turn):
    return (a - b + turn / 2) % turn - turn / 2


def synchronise(base):
    for n in (0, 1):
        base.send(order(n))
        got, _ = base.next()
        law(got == bytes([n]), "SYNC%d: %s" % (n, got))
    base.send(order(2))
    got, _ = base.next()
    law(got is not None and got[0] == 2 and got.count(0) == 3 and got[-1] == 0, "SYNC2: %s" % got)
    return [part.decode() for part in got[1:].split(b"\0")[:3]]


def read_config(p):
    at = 1
    found = {}

    def text(name):
        nonlocal at
        end = p.index(b"\0", at)
        found[name] = p[at:end].decode()
        at = end + 1

    def byte(*names):
        nonlocal at
        for name in names:
            found[name] = p[at]
            at += 1

    def word(*names):
        nonlocal at
        for name in names:
            found[name], = struct.unpack("<H", p[at:at + 2])
            at += 2

    text("type"), text("subtype"), text("serial"), byte("four")
    word("rotVelTop", "transVelTop", "rotAccTop", "transAccTop", "pwmMax"), text("name")
    byte("sipCycle", "hostBaud", "auxBaud"), word("gripper", "frontSonar"), byte("rearSonar")
    word("lowBattery", "revCount", "watchdog"), byte("p2mpacs"), word("stallVal", "stallCount", "joyVel", "joyRotVel")
    word("rotVelMax", "transVelMax", "rotAcc", "rotDecel", "rotKp", "rotKv", "rotKi")
    word("transAcc", "transDecel", "transKp", "transKv", "transKi")
    byte("frontBumps", "rearBumps", "charger", "sonarCycle", "autobaud", "hasGyro"), word("drift"), byte("aux2", "aux3")
    word("ticksMM", "shutdown"), text("firmware"), word("gyroCW", "gyroCCW"), byte("kinematicsDelay")
    law(at <= len(p), "the configuration's packet is %d bytes short" % (at - len(p)))
    return found


def meet(base):
    """Junk, SYNCs out of their order, and those in it."""
    base.send(b"WMS2\r", order(1), order(2), order(11, 300), packet(b"\x12"))
    law(base.next(0.3)[0] is None, "an unsynchronised base answers")
    base.send(order(0))
    law(base.next()[0] == b"\0", "SYNC0 behind junk")
    base.send(order(1))
    law(base.next()[0] == b"\1", "SYNC1")
    base.send(order(1))  # out of its order: no OPEN, all begins anew
    law(base.next(0.3)[0] is None, "a second SYNC1 is answered")
    base.send(order(2))
    law(base.next(0.3)[0] is None, "SYNC2 after a start over is answered")
    broken = bytearray(order(0))
    broken[-1] ^= 1
    base.send(bytes(broken))
    law(base.next(0.3)[0] is None, "a packet with a wrong sum is obeyed")
    name, kind, subclass = synchronise(base)
    law(kind == "Pioneer" and subclass == "p3at-sh", "it calls itself %s %s" % (kind, subclass))
    law((name == "MobileSim") != hardware, "its name is " + name)
    law(base.next(0.3)[0] is None, "reports come before OPEN")
    return name


def begin(base, name):
    base.send(order(1, 1))
    first = base.report()
    law(first is not None, "no report after OPEN")
    law((first.x, first.y, first.heading) == (0, 0, 0), "OPEN sets the odometry to zero")
    law(not first.motors and not first.moving, "the motors are on after OPEN")
    law(len(first.payload) == 32 and first.sonars == 0, "a report of %d bytes" % len(first.payload))
    law(abs(first.battery - 12.8) < 0.05 and first.battery_fine == 128, "battery")
    law(first.charge == 0 and first.faults == 0 and first.stall == 0, "charge, faults, stall")
    base.send(order(18, 1))
    got = base.wait((0x20,))
    law(got is not None, "no CONFIG packet")
    c = read_config(got)
    if not hardware:
        base.send(order(237, 1))
        c["home"] = struct.unpack("<iiii", base.wait((0x62,))[13:29])
    law((c["type"], c["subtype"], c["four"]) == ("Pioneer", "p3at-sh", 1), "CONFIG: %s" % c)
    law((c["serial"] == "SIM") != hardware, "CONFIG: serial " + c["serial"])
    law(c["firmware"].startswith("S.") != hardware, "CONFIG: firmware " + c["firmware"])
    law(c["name"] == name, "CONFIG and SYNC2 differ in the name")
    law(c["sipCycle"] == 100 and c["watchdog"] == 2000, "CONFIG: cycle %(sipCycle)d, watchdog %(watchdog)d" % c)
    law(c["autobaud"] == 0 and c["kinematicsDelay"] <= 20, "CONFIG: autobaud, kinematics delay")
    for key in ("rotVelTop", "transVelTop", "rotAccTop", "transAccTop", "rotVelMax", "transVelMax", "rotAcc", "rotDecel",
                "transAcc", "transDecel", "ticksMM", "revCount", "lowBattery", "shutdown"):
        law(c[key] > 0, "CONFIG: %s is 0" % key)
    law(c["rotVelMax"] <= c["rotVelTop"] and c["transVelMax"] <= c["transVelTop"], "CONFIG: max above top")
    return c


def cadence(base):
    times = []
    while len(times) < 25:
        payload, when = base.next()
        if payload is None:
            law(False, "the reports stop")
            return
        times.append(when)
        if len(times) % 5 == 0:
            base.send(order(0))
    steps = [b - a for a, b in zip(times, times[1:])]
    mean = sum(steps) / len(steps)
    print("reports every %.2f ms, %.1f to %.1f ms" % (1e3 * mean, 1e3 * min(steps), 1e3 * max(steps)))
    law(abs(mean - 0.1) < 0.003, "reports every %.1f ms" % (1e3 * mean))


def silent_numbers(base, config):
    """What the base may not know must be passed over without a word."""
    for number in list(range(14, 19)) + [26, 30, 33, 34, 40, 41, 42, 43, 45, 50, 51, 58, 62, 65, 66, 90, 200, 245]:
        if number == 18:
            continue
        base.send(order(number), order(number, 1), packet(bytes([number, 0x2B, 3]) + b"abc"))
    end = time.time() + 0.5
    while time.time() < end:
        payload, _ = base.next(0.3)
        law(payload is None or payload[0] in (0x32, 0x33), "an unknown number is answered by %s" % payload)
    base.send(order(44, 3), order(28, 1), order(28, 0))
    for number, value in ((82, 40), (83, 20), (84, 0), (85, 40), (86, 20), (87, 0), (88, 22500), (89, 0), (93, 138)):
        base.send(order(number, value))
    law(base.report() is not None, "the reports stop")


def drive(base):
    base.send(order(11, 200))
    law(all(not r.moving for r in base.reports(0.6)), "it moves with its motors off")
    base.send(order(4, 1), order(6, 400), order(5, 300), order(5, -300), order(10, 90), order(23, 100), order(23, -100))
    on = base.reports(0.4, [order(0)])
    law(on and on[-1].motors, "ENABLE 1")
    # VEL, and its ramp.
    seen = base.reports(2.0, [order(11, 200)])
    law(abs(seen[-1].speed - 200) < 25, "VEL 200: %g" % seen[-1].speed)
    law(seen[-1].moving and seen[-1].payload[0] == 0x33, "0x33 while it moves")
    steps = [wrapped(b.x, a.x, 65536) for a, b in zip(seen, seen[1:])]
    law(max(steps) <= 100, "no step of more than 100 mm a report")
    law(any(20 < r.speed < 180 for r in seen), "the ramp")
    # SETV bounds VEL.
    base.send(order(6, 150))
    law(abs(base.reports(1.5, [order(11, 700)])[-1].speed - 150) < 25, "SETV 150")
    base.send(order(6, 400))
    # STOP.
    base.send(order(29))
    law(abs(base.reports(2.0, [order(0)])[-1].speed) < 5, "STOP")
    # RVEL, the sign of left and right, and the turn rate's field.
    seen = base.reports(2.0, [order(21, 20)])
    last = seen[-1]
    law(last.right > 50 and last.left < -50, "RVEL 20: wheels %d %d" % (last.left, last.right))
    law(abs((last.right - last.left) / 2 * 0.0034 * 180 / math.pi - 20) < 4, "wheels tell %d %d at 20 deg/s" % (last.left, last.right))
    law(abs(0.1 * last.turn_rate - 20) < 4, "the turn rate's field: %g deg/s" % (0.1 * last.turn_rate))
    law(sum(wrapped(b.heading, a.heading, 4096) for a, b in zip(seen, seen[1:])) > 100, "the heading grows to the left")
    law(abs(base.reports(2.0, [order(21, -20)])[-1].turn_rate + 200) < 40, "RVEL -20")
    # VEL2 in both clients' forms, and VEL ends it.
    base.send(order(29))
    base.reports(1.0, [order(0)])
    for name, form in (("ARIA's", bytes.fromhex("fafb06201bfb091b24")), ("Player's", bytes.fromhex("fafb06203b0af62b31"))):
        last = base.reports(2.0, [form])[-1]
        law(last.right > 50 > -50 > last.left, "VEL2 in %s form: %d %d" % (name, last.left, last.right))
    last = base.reports(2.5, [order(11, 100)])[-1]
    law(abs(last.speed - 100) < 25 and abs(last.turn_rate) < 30, "VEL after VEL2: %g mm/s, %g" % (last.speed, last.turn_rate))
    # HEAD, DHEAD, MOVE.
    base.send(order(29))
    base.reports(1.0, [order(0)])
    base.send(order(12, -45))
    last = base.reports(6.0, [order(0)])[-1]
    law(abs(wrapped(last.angle, -45, 360)) < 4, "HEAD -45 ends at %.1f" % last.angle)
    base.send(order(13, 90))
    last = base.reports(4.0, [order(0)])[-1]
    law(abs(wrapped(last.angle, 45, 360)) < 5, "DHEAD 90 ends at %.1f" % last.angle)
    base.send(order(8, 300))
    moved = base.reports(5.0, [order(0)])[-1]
    way = math.hypot(wrapped(moved.x, last.x, 65536), wrapped(moved.y, last.y, 65536))
    law(abs(way - 300) < 40, "MOVE 300 goes %.0f mm" % way)
    # SETO, bare and in Player's form.
    for form in (order(7), bytes.fromhex("fafb04073b073b")):
        base.send(form)
        zero = base.reports(0.4, [order(0)])[-1]
        law(all(abs(wrapped(v, 0, 65536)) <= 5 for v in (zero.x, zero.y, zero.heading)),
            "SETO: %d %d %d" % (zero.x, zero.y, zero.heading))
    # Encoders.
    base.send(order(19, 1))
    law(base.wait((0x90,)) is not None and base.wait((0x90,), 0.4) is None, "ENCODER 1 is answered once")
    base.send(order(19, 2))
    a, b = base.wait((0x90,)), base.wait((0x90,))
    law(a is not None and b is not None and len(a) == 9, "ENCODER 2 goes on")
    base.send(order(19, 0))


def watchdog(base):
    seen = base.reports(2.0, [order(11, 150)])
    law(abs(seen[-1].speed - 150) < 25, "VEL 150")
    quiet = base.reports(3.6)
    law(abs(quiet[-1].speed) < 10, "2 s without a command: %g mm/s" % quiet[-1].speed)
    law(abs(quiet[10].speed - 150) < 25, "the watchdog waits 2 s")
    law(abs(base.reports(1.5, [order(0)])[-1].speed - 150) < 25, "it goes on when a command comes")
    base.send(order(55))
    law(abs(base.reports(0.5, [order(0)])[-1].speed) < 10, "ESTOP stops at once")
    base.reports(1.0, [order(11, 150)])
    base.send(order(4, 0))
    last = base.reports(0.6, [order(0)])[-1]
    law(not last.motors and abs(last.speed) < 10, "ENABLE 0 stops")


def simulator(base, config):
    base.send(order(237))
    got = base.wait((0x62,))
    if hardware:
        law(got is None, "SIM_STAT is answered by hardware")
        return
    law(got is not None and len(got) == 1 + 2 + 4 + 6 + 16 + 16 + 12, "SIMSTAT: %s" % (got and len(got)))
    law(base.wait((0x62,), 0.4) is None, "SIM_STAT without argument is answered once")
    start = struct.unpack("<iiii", got[13:29])
    base.send(packet(bytes([224, 0x3B]) + struct.pack("<iii", start[0] + 100, start[1] + 50, start[3] + 30)))
    before = base.report()
    base.reports(0.3, [order(0)])
    base.send(order(237, 1))
    moved = struct.unpack("<iiii", base.wait((0x62,))[13:29])
    law(abs(moved[0] - start[0] - 100) <= 2 and abs(moved[1] - start[1] - 50) <= 2, "SIM_SET_POSE: %s" % (moved,))
    law(abs(wrapped(moved[3], start[3] + 30, 360)) <= 1, "SIM_SET_POSE: heading")
    after = base.report()
    law(abs(wrapped(after.x, before.x, 65536)) <= 3 and abs(wrapped(after.y, before.y, 65536)) <= 3,
        "SIM_SET_POSE moves the odometry")
    base.send(order(225))
    base.reports(0.3, [order(0)])
    base.send(order(237, 2))
    status = base.wait((0x62,))
    law(base.next()[0][0] in (0x32, 0x33), "the status comes before the report")
    back = struct.unpack("<iiii", status[13:29])
    law(all(abs(a - b) <= 2 for a, b in zip(back[:3], config["home"])), "SIM_RESET: %s, not %s" % (back, config["home"]))
    base.send(order(237, 0))
    zero = base.report()
    law(abs(wrapped(zero.x, 0, 65536)) <= 3 and abs(wrapped(zero.y, 0, 65536)) <= 3, "SIM_RESET leaves the odometry")
    base.reports(0.2, [order(0)])
    for numbers, mode, kind in (((230, 231, 232, 233), 1, 0x60), ((35, 36, 37, 38), 2, 0x61)):
        base.send(order(numbers[1], -90), order(numbers[2], 90), order(numbers[3], 100), order(numbers[0], mode))
        readings, total, end = {}, 0, time.time() + 2.0
        while time.time() < end and len(readings) < 181:
            p = base.wait((kind,), 1.0)
            if p is None:
                break
            at = 7 if kind == 0x60 else 1
            total, first, count = struct.unpack("<HHB", p[at:at + 5])
            size = 2 if kind == 0x60 else 5
            law(len(p) == at + 5 + size * count + (2 if kind == 0x61 else 0), "a laser packet's length")
            for i in range(count):
                readings[first + i], = struct.unpack("<H", p[at + 5 + size * i:at + 7 + size * i])
            base.send(order(0))
        law(total == 181 and sorted(readings) == list(range(181)), "laser 0x%x: %d of %d" % (kind, len(readings), total))
        law(any(100 < r < 4100 for r in readings.values()), "laser 0x%x sees nothing" % kind)
        base.send(order(numbers[0], 0))
    base.reports(0.3, [order(0)])
    law(base.wait((0x60, 0x61), 0.4) is None, "the laser goes on")
    base.send(order(236, 6))
    got = base.wait((0x63,))
    law(got is not None and got[1:].split(b"\0")[0] == b"MobileSim", "SIMINFO: %s" % got)
    base.send(order(250, 105))
    law(abs(base.reports(0.3, [order(0)])[-1].battery - 10.5) < 0.05, "BATTEST 105")
    base.send(order(250, 0))


def leave(base, word):
    base.send(order(4, 1), order(11, 100))
    base.reports(0.5)
    base.send(order(2, 1))
    end = time.time() + 0.3
    while base.next(end - time.time())[0] is not None:
        pass
    law(base.next(0.4)[0] is None, "reports after CLOSE")
    synchronise(base)
    base.send(order(1))
    first = base.report()
    law(first is not None and not first.motors, "bare OPEN after CLOSE; the motors are off")
    # A client that dies without CLOSE: on TCP that is one; on a line the next one's SYNC0 is answered by reports.
    base.close()
    time.sleep(0.3)
    again = Base(word)
    again.send(order(0))
    got, _ = again.next()
    if word.startswith("tcp"):
        law(got == b"\0", "a new client on TCP finds a closed base")
    else:
        law(got is not None and got[0] in (0x32, 0x33), "an open base answers SYNC0 by reports")
        again.send(order(2, 1))
        while again.next(0.3)[0] is not None:
            pass
        synchronise(again)
    again.close()


def main():
    word = sys.argv[1]
    base = Base(word)
    name = meet(base)
    config = begin(base, name)
    cadence(base)
    silent_numbers(base, config)
    drive(base)
    watchdog(base)
    simulator(base, config)
    leave(base, word)
    end_with_verdict(word)


if __name__ == "__main__":
    main()
