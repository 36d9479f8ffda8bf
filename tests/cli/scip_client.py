"""A client of SCIP 1.1 and 2.0 on TCP or a pty, written from Hokuyo's specification (C-42-03320B) and from what its users'
libraries demand, not from rubble's driver: it checks an emulated URG-04LX clause by clause.

  scip_client.py PORT    PORT: tcp:HOST:PORT or pty:PATH; ends with 1 and one line a broken clause."""
import os
import select
import sys
import time

from device_port import DevicePort, end_with_verdict, law


class Line(DevicePort):
    def __init__(self, word):
        super().__init__(word)
        self.got = b""

    def send(self, text, end="\n"):
        os.write(self.file, (text + end).encode())

    def pull(self, timeout):
        if not select.select([self.file], [], [], max(0.0, timeout))[0]:
            return False
        part = os.read(self.file, 65536)
        self.got += part
        return bool(part)

    def reply(self, timeout=1.0):
        """Up to and with the empty line; None when none came."""
        end = time.time() + timeout
        while b"\n\n" not in self.got:
            if time.time() > end or not self.pull(end - time.time()) and time.time() > end:
                return None
        text, self.got = self.got.split(b"\n\n", 1)
        return text.decode("latin1").split("\n")

    def ask(self, text, timeout=1.0, end="\n"):
        self.send(text, end)
        return self.reply(timeout)

    def quiet(self, seconds):
        end = time.time() + seconds
        while time.time() < end:
            self.pull(end - time.time())
        rest, self.got = self.got, b""
        return rest


def check(text):
    return chr((sum(text.encode("latin1")) & 0x3F) + 0x30)


def value(text):
    number = 0
    for c in text:
        number = number * 64 + ord(c) - 0x30
    return number


def summed(line):
    return len(line) > 1 and check(line[:-1]) == line[-1]


def status(line, text, expected, timeout=1.0):
    """Asks, and the status must be the expected one with its sum, after the echo, and nothing else."""
    got = line.ask(text, timeout)
    law(got is not None, "'%s' gets no answer" % text)
    if got is None:
        return
    law(got[0] == text, "'%s' is echoed as '%s'" % (text, got[0]))
    law(got[1:] == [expected + check(expected)], "'%s' is answered by %s, not %s" % (text, got[1:], expected))


def entries(line, text, keys):
    got = line.ask(text)
    law(got is not None and got[:2] == [text, "00P"], "'%s': %s" % (text, got and got[:2]))
    if got is None:
        return {}
    found = {}
    for row in got[2:]:
        law(row[-2] == ";" and check(row[:-2]) == row[-1], "%s: wrong sum in '%s' (the ';' does not count)" % (text, row))
        key, rest = row[:-2].split(":", 1)
        found[key] = rest
    law(list(found) == keys, "%s tells %s, not %s" % (text, list(found), keys))
    return found


def scan(reply, size, characters, what):
    """The time and the values of a reply with data."""
    law(summed(reply[2]) and len(reply[2]) == 5, what + ": the time's line")
    data = ""
    for i, row in enumerate(reply[3:]):
        law(summed(row), what + ": sum of a data line")
        law(len(row) == 65 or i == len(reply) - 4 and len(row) <= 65, what + ": a data line of %d" % len(row))
        data += row[:-1]
    law(len(data) == size * characters, "%s: %d characters, not %d" % (what, len(data), size * characters))
    return value(reply[2][:4]), [value(data[i:i + characters]) for i in range(0, len(data), characters)]


def old_protocol(line):
    for text in ("QT", "VV", "PP", "MD0044072501000", "XY"):
        got = line.ask(text)
        law(got == [text, "E"], "SCIP 1.1 answers '%s' by %s, not E" % (text, got))
    version = line.ask("V")
    law(version is not None and version[:2] == ["V", "0"] and len(version) == 7, "V: %s" % version)
    keys = [row.split(":")[0] for row in version[2:]]
    law(keys == ["VEND", "PROD", "FIRM", "PROT", "SERI"], "V tells %s" % keys)
    firmware = version[4]
    law("-4095[mm]" in firmware and firmware.count(",") >= 2 and "44-725[step]" in firmware,
        "the firmware line cannot be taken apart as Player does: " + firmware)
    law(line.ask("L0") == ["L0", "0"] and line.ask("L1") == ["L1", "0"], "L0 and L1")
    for rate in ("S1152007654321", "S0192000000000"):
        law(line.ask(rate) == [rate, "0"], rate)
    began = time.time()
    for i in range(5):
        got = line.ask("G00076801")
        law(got is not None and got[:2] == ["G00076801", "0"], "G: %s" % (got and got[:2]))
        data = got[2:]
        law(all(len(row) == 64 for row in data[:-1]), "G: lines of 64 characters without sums")
        values = [value("".join(data)[k:k + 2]) for k in range(0, 2 * 769, 2)]
        law(len("".join(data)) == 2 * 769, "G: 769 values of two characters")
        law(values[:44] == [19] * 44, "G: the steps that do not measure give code 19")
        law(max(values) <= 4095, "G: two characters end at 4095")
    law(time.time() - began > 0.3, "G is answered once a turn")
    clusters = line.ask("G04472504")
    law(len("".join(clusters[2:])) == 2 * 171, "G: clusters of 4")
    law(line.ask("SCIP2.0") == ["SCIP2.0", "0"], "the switch to SCIP 2.0 is answered in the old form")


def new_protocol(line):
    status(line, "SCIP2.0", "0E")
    status(line, "QT", "00")
    law(line.quiet(0.3) == b"", "something is sent though the laser is off")
    version = entries(line, "VV", ["VEND", "PROD", "FIRM", "PROT", "SERI"])
    law(version.get("PROT") == "SCIP 2.0", "VV: PROT")
    sensor = entries(line, "PP", ["MODL", "DMIN", "DMAX", "ARES", "AMIN", "AMAX", "AFRT", "SCAN"])
    law([sensor.get(k) for k in ("MODL", "DMIN", "DMAX", "ARES", "AMIN", "AMAX", "AFRT", "SCAN")] ==
        ["URG-04LX(Hokuyo Automatic Co.,Ltd.)", "20", "5600", "1024", "44", "725", "384", "600"], "PP: %s" % sensor)
    state = entries(line, "II", ["MODL", "LASR", "SCSP", "MESM", "SBPS", "TIME", "STAT"])
    law(state.get("LASR") == "OFF" and state.get("MESM") == "IDLE", "II: %s" % state)
    law(len(state.get("TIME", "")) == 6 and int(state["TIME"], 16) >= 0, "II: TIME")
    law(state.get("STAT") == "Sensor works well.", "II: STAT")

    # Line ends, empty lines, strings of the client's own.
    line.send("", "\n\r\n\r")
    law(line.quiet(0.2) == b"", "an empty line is answered")
    for end in ("\r", "\r\n", "\n"):
        law(line.ask("BM" if end == "\r" else "QT", end=end) is not None, "a line ended by %r" % end)
    got = line.ask("PP;abc 1._+@Z")
    law(got is not None and got[0] == "PP;abc 1._+@Z" and got[1] == "00P", "a string of one's own comes back")
    status(line, "QT;12345678901234567", "0G")
    status(line, "QT;a!b", "0H")

    # Statuses.
    status(line, "GD0044072501", "10")
    status(line, "GS0044072501", "10")
    for first, end, cluster, code in (("00x4", "0725", "01", "01"), ("0044", "07x5", "01", "02"), ("0044", "0725", "x1", "03"),
                                      ("0044", "0769", "01", "04"), ("0100", "0099", "01", "05")):
        for name in ("GD", "GS"):
            status(line, name + first + end + cluster, code)
        for name in ("MD", "MS"):
            status(line, name + first + end + cluster + "000", code)
    status(line, "MD004407250" + "1x00", "06")
    status(line, "MD00440725010x0", "07")
    status(line, "GD00440725", "0C")
    status(line, "MD0044072501", "0C")
    for text in ("XX", "ME0044072501000", "ND0044072501000", "Q", "bm"):
        status(line, text, "0E")
    for text, code in (("CR00", "03"), ("CR05", "00"), ("CR05", "03"), ("CR11", "02"), ("CRx1", "01"), ("CR99", "00"),
                       ("HS0", "02"), ("HS1", "00"), ("HS1", "02"), ("HS0", "00"), ("HS2", "01"),
                       ("SS038400", "04"), ("SS0x9200", "01"), ("SS012345", "02"), ("SS115200", "00"), ("SS115200", "03"),
                       ("SS019200", "00"), ("BM", "00"), ("BM", "02"), ("QT", "00"), ("QT", "00")):
        status(line, text, code)

    # The clock.
    status(line, "TM1", "04")
    status(line, "TM2", "03")
    status(line, "TM3", "01")
    status(line, "BM", "00")
    status(line, "TM0", "00")
    status(line, "TM0", "02")
    for text in ("VV", "BM", "QT", "MD0044072501000", "II"):
        status(line, text, "0E")
    times = []
    for _ in range(5):
        sent = time.time()
        got = line.ask("TM1")
        law(got[:2] == ["TM1", "00P"] and summed(got[2]) and len(got[2]) == 5 and len(got) == 3, "TM1: %s" % got)
        times.append((0.5 * (sent + time.time()), value(got[2][:4])))
        time.sleep(0.1)
    gone = times[-1][0] - times[0][0]
    law(abs((times[-1][1] - times[0][1]) - 1000 * gone) < 60, "the clock counts milliseconds")
    status(line, "TM2", "00")
    status(line, "GD0044072501", "10")  # asking the clock has switched the laser off

    # Single scans: right after BM a fresh one, three and two characters, clusters.
    status(line, "BM", "00")
    first = line.ask("GD0044072501", 2.0)
    law(first is not None and first[:2] == ["GD0044072501", "00P"], "GD right after BM: %s" % (first and first[:2]))
    stamp, ranges = scan(first, 682, 3, "GD")
    law(all(v < 20 or v <= 5600 for v in ranges) and any(v >= 20 for v in ranges), "GD: ranges")
    second_stamp, short = scan(line.ask("GS0044072501", 2.0), 682, 2, "GS")
    law((second_stamp - stamp) % (1 << 24) in range(90, 1000), "the second answer is another turn")
    law(max(short) <= 4095, "GS ends at 4095")
    _, groups = scan(line.ask("GD0044072507", 2.0), 98, 3, "GD with clusters of 7")
    _, one = scan(line.ask("GD0384038401", 2.0), 1, 3, "GD of one step")
    law(len(one) == 1, "one step")
    _, full = scan(line.ask("GD0000076800", 2.0), 769, 3, "GD of all steps, cluster 00")
    law(full[:44] == [19] * 44 and full[726:] == [19] * 43, "steps outside the field of view are 19")
    status(line, "QT", "00")

    # Streams: the answer to the command, then the echo with what is left; the end switches the laser off.
    status(line, "MD0044072501003", "00")
    stamps = []
    for left in (2, 1, 0):
        got = line.reply(2.0)
        law(got is not None and got[0][:13] == "MD00440725010", "MD: echo %s" % (got and got[0]))
        law(got[0][13:] == "%02d" % left, "MD: %s scans left in the echo, not %02d" % (got[0][13:], left))
        law(got[1] == "99b", "MD: status %s" % got[1])
        stamps.append(scan(got, 682, 3, "MD")[0])
    law(all((b - a) % (1 << 24) in range(98, 103) for a, b in zip(stamps, stamps[1:])), "MD: stamps a turn apart: %s" % stamps)
    law(line.quiet(0.3) == b"", "a counted stream goes on")
    status(line, "GD0044072501", "10")
    status(line, "MS0100020002200", "00")  # skips two turns between two, clusters of 2
    skipped = []
    for _ in range(3):
        got = line.reply(2.0)
        law(got[0] == "MS0100020002200" and got[1] == "99b", "MS: %s" % got[:2])
        skipped.append(scan(got, 51, 2, "MS")[0])
    law(all((b - a) % (1 << 24) in range(295, 306) for a, b in zip(skipped, skipped[1:])), "MS skips two: %s" % skipped)
    line.send("MD0044072501000")  # a new one takes the old one's place
    got = line.reply(2.0)
    while got is not None and got[0][:2] == "MS":
        got = line.reply(2.0)
    law(got == ["MD0044072501000", "00P"], "a new stream: %s" % got)
    for _ in range(3):
        got = line.reply(1.0)
        law(got[0] == "MD0044072501000" and got[1] == "99b", "MD until QT keeps 00: %s" % got[:2])
        size = sum(len(row) + 1 for row in got) + 1
        law(size == 2137, "a block of MD has 2137 bytes, not %d" % size)
    line.send("QT")
    got = line.reply(1.0)
    while got is not None and got[0][:2] == "MD":
        got = line.reply(1.0)
    law(got == ["QT", "00P"], "QT in a stream: %s" % got)
    law(line.quiet(0.4) == b"", "a block is sent after QT was answered")
    status(line, "RS", "00")
    status(line, "GD0044072501", "10")


def main():
    line = Line(sys.argv[1])
    line.quiet(0.2)
    old_protocol(line)
    new_protocol(line)
    end_with_verdict(sys.argv[1])


if __name__ == "__main__":
    main()
