#!/usr/bin/env python3
"""bench/changed_logs.py LOG OUT_FOLDER [--range 4] [--seed 1] [--relations FILE]: changed logs, to map them beside LOG.

LOG: CARMEN text (FLASER, ROBOTLASER1, ODOM; also .gz, .bz2), CoreSLAM (.dat) or log.rlog of a run. Written are, each in
the format of LOG:
  unchanged  what LOG says, in the form of the others: the one to compare them with
  mirrored   left and right exchanged, in scans, odometry and reference
  even, odd  only every second scan, from the first or the second one; the odometry of those left out stays
  random     a tenth of the beams of each scan hold a range between 0 and the scanner's, drawn uniformly
  cut        a scanner that sees nothing beyond --range [m]
A corrected CARMEN log, whose odometry starts anew at each corrected pose, becomes a raw one (docs/robot.md): its
increments are composed again, the corrected poses stay as reference; where its clock stands still, scans are put 1 s
apart. With --relations (two stamps, x y z roll pitch yaw a line) NAME.relations is written for each, of scans that are
left; NAME.tum where truth.tum lies beside log.rlog.
"""
import argparse
import bisect
import bz2
import gzip
import json
import math
import pathlib
import random
import struct
import sys
import zlib
from dataclasses import dataclass, replace

SHARE = 0.1  # of the beams that become random
LATEST = 0.001  # a relation is of a scan so close to its stamp [s]
SPACING = 1.0  # of scans whose clock stands still [s]
NO_RETURN = 30.0  # FLASER names no limit; ranges from here on are misses [m]
INF, NAN = math.inf, math.nan


# Planar poses, (x, y, heading)

def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], math.remainder(a[2] + b[2], 2 * math.pi)


def between(a, b):
    c, s, x, y = math.cos(a[2]), math.sin(a[2]), b[0] - a[0], b[1] - a[1]
    return c * x + s * y, c * y - s * x, math.remainder(b[2] - a[2], 2 * math.pi)


def mirror(pose):
    return pose[0], -pose[1], -pose[2]


class CarmenLog:
    """Scans are written as ROBOTLASER1, which names its first beam: 180 beams from -90 deg mirrored end at +90 deg."""
    suffix = ".log"

    @dataclass
    class Record:
        pose: tuple  # T_odom_base, or the corrected one
        speed: tuple  # ahead [m/s], turn rate [rad/s]
        times: tuple  # sender's stamp, host, logger's stamp, as they stand
        laser: tuple = None  # T_map_laser; scans only, like the rest
        ranges: list = None
        start: float = 0.0  # bearing of the first beam [rad]
        step: float = 0.0  # [rad]
        limit: float = NO_RETURN  # ranges from here on are misses [m]

    def __init__(self, head, records):
        self.head, self.records = head, records

    @property
    def scans(self):
        return [record for record in self.records if record.ranges]

    @classmethod
    def read(cls, data):
        head, records, scan_word = [], [], None
        for number, line in enumerate(data.decode("latin-1").splitlines(), 1):
            words = line.split()
            word = words[0] if words else ""
            if word == "PARAM":
                head.append(line)
            if word in ("FLASER", "ROBOTLASER1"):
                scan_word = scan_word or word  # a log may hold each scan in both forms
            if word != "ODOM" and word != scan_word:
                continue
            try:
                records.append(cls.record(word, words))
            except (ValueError, IndexError):
                sys.exit(f"line {number}: is no whole {word} line")
        if scan_word is None:
            sys.exit("the CARMEN log holds no FLASER or ROBOTLASER1 line")
        log = cls(head, records)
        log.undo_reanchoring()
        return log

    @classmethod
    def record(cls, word, words):
        def numbers(begin, count):
            values = tuple(map(float, words[begin:begin + count]))
            if len(values) != count:
                raise ValueError
            return values

        def times(begin):
            float(words[begin]), float(words[begin + 2])
            return tuple(words[begin:begin + 3])

        if word == "ODOM":
            return cls.Record(numbers(1, 3), numbers(4, 2), times(7))
        if word == "FLASER":
            count = int(words[1])
            last = 2 + count
            step = math.pi / (count - 1 if count % 2 else count)
            return cls.Record(numbers(last + 3, 3), (0.0, 0.0), times(last + 6), numbers(last, 3),
                              list(numbers(2, count)), round(-math.pi / 2, 9), step)
        start, _, step, limit = numbers(2, 4)
        count = int(words[8])
        last = 9 + count
        last += 1 + int(words[last])  # remissions are left out
        return cls.Record(numbers(last + 3, 3), numbers(last + 6, 2), times(last + 11), numbers(last, 3),
                          list(numbers(9, count)), round(start, 9), step, limit)

    def undo_reanchoring(self):
        """As read_carmen() does: increments from ODOM to ODOM, none from ODOM to scan, the repeated line dropped."""
        marks = [i for i, (a, b) in enumerate(zip(self.records, self.records[1:]), 1)
                 if a.ranges and not b.ranges and a.pose == b.pose]
        back = [i for i in marks if float(self.records[i].times[0]) < float(self.records[i - 1].times[0])]
        if not marks or 20 * (len(self.scans) - len(marks)) > len(self.scans) or 2 * len(back) <= len(marks):
            return
        offsets = [float(line.split()[2]) for line in self.head if line.split()[1] == "robot_frontlaser_offset"]
        mount = (offsets[-1], 0.0, 0.0) if offsets else between(self.scans[0].pose, self.scans[0].laser)
        if not offsets:  # the laser's pose will not keep its place on the robot, so the log must say it
            self.head.append(f"PARAM robot_frontlaser_offset {mount[0]!r} nohost 0")
        raw, anchor, marks, kept = (0.0, 0.0, 0.0), self.records[0].pose, set(marks), []
        for i, record in enumerate(self.records):
            if i in marks:
                continue
            corrected = record.pose
            if record.ranges:
                record.laser = compose(corrected, (mount[0], 0.0, 0.0))
            else:
                raw = compose(raw, between(anchor, corrected))
            anchor = corrected
            record.pose = raw
            kept.append(record)
        self.records = kept
        stamps = self.stamps()
        if 2 * sum(a == b for a, b in zip(stamps, stamps[1:])) > len(stamps):
            self.space_evenly()

    def space_evenly(self):
        """Stamps of six digits keep the order and tell no time."""
        waiting, scans = [], 0
        for record in self.records + [None]:
            waiting.append(record)
            if record and not record.ranges:
                continue
            odometry = waiting[:-1]  # the last one with its scan
            for i, line in enumerate(odometry, 1):
                line.times = (f"{SPACING * (scans + i / len(odometry)):.6f}",) + line.times[1:]
            scans += 1
            if record:
                record.times = (f"{SPACING * scans:.6f}",) + record.times[1:]
            waiting = []

    def stamps(self):
        return [float(scan.times[0]) for scan in self.scans]

    def reach(self):
        return max((r for scan in self.scans for r in scan.ranges if r < scan.limit), default=NO_RETURN)

    def mirrored(self):
        def changed(record):
            new = replace(record, pose=mirror(record.pose), speed=(record.speed[0], -record.speed[1]))
            if record.ranges:
                new.laser = mirror(record.laser)
                new.ranges = record.ranges[::-1]
                new.start = round(-(record.start + (len(record.ranges) - 1) * record.step), 9)
            return new

        return CarmenLog(self.head, [changed(record) for record in self.records])

    def with_scans(self, is_kept):
        """Where scans alone tell the odometry, one that is left out becomes an ODOM line."""
        no_odometry = all(record.ranges for record in self.records)
        kept, number = [], 0
        for record in self.records:
            left_out = record.ranges and not is_kept(number)
            number += bool(record.ranges)
            if not left_out:
                kept.append(record)
            elif no_odometry:
                kept.append(replace(record, ranges=None))
        return CarmenLog(self.head, kept)

    def with_ranges(self, change):
        return CarmenLog(self.head, [replace(record, ranges=change(record.ranges)) if record.ranges else record
                                     for record in self.records])

    def cut(self, reach):
        log = self.with_ranges(lambda ranges: [min(r, reach) for r in ranges])
        log.records = [replace(record, limit=min(record.limit, reach)) for record in log.records]
        return log

    def data(self):
        def text(values):
            return " ".join(map(repr, values))

        lines = self.head[:]
        for r in self.records:
            if r.ranges:
                count = len(r.ranges)
                lines.append(f"ROBOTLASER1 0 {text((r.start, (count - 1) * r.step, r.step, r.limit))} 0.01 0 {count} "
                             f"{text(r.ranges)} 0 {text(r.laser + r.pose + r.speed)} 0 0 0 {' '.join(r.times)}")
            else:
                lines.append(f"ODOM {text(r.pose + r.speed)} 0 {' '.join(r.times)}")
        return ("\n".join(lines) + "\n").encode("latin-1")


class CoreSlamLog:
    """Beams 62 to 641 are useful; those whose mirror image is not are left out of all variants. The format has no sweep
    that runs clockwise: map the mirrored log, and the one beside it, with mapper.deskew=false."""
    suffix = ".dat"
    first_range, beams = 24, 683
    useful = range(62, 621)
    no_measurement, smallest = "7", 20

    @dataclass
    class Scan:
        head: list  # the numbers before the ranges
        ranges: list  # of the useful beams [m]; 0: no echo

    def __init__(self, scans):
        self.scans = scans

    @classmethod
    def read(cls, data):
        scans = []
        for number, line in enumerate(data.decode("latin-1").splitlines(), 1):
            words = line.split()
            if not words:
                continue
            if len(words) != cls.first_range + cls.beams:
                sys.exit(f"line {number}: holds {len(words)} numbers, not {cls.first_range + cls.beams}")
            ranges = words[cls.first_range:]
            scans.append(cls.Scan(words[:cls.first_range], [int(ranges[beam]) / 1000 for beam in cls.useful]))
        return cls(scans)

    def stamps(self):
        return [int(scan.head[0]) * 1e-6 for scan in self.scans]

    def reach(self):
        return max(r for scan in self.scans for r in scan.ranges)

    def mirrored(self):
        return CoreSlamLog([self.Scan(scan.head[:2] + scan.head[3:1:-1] + scan.head[4:], scan.ranges[::-1])
                            for scan in self.scans])

    def with_scans(self, is_kept):
        return CoreSlamLog([scan for number, scan in enumerate(self.scans) if is_kept(number)])  # ticks are totals

    def with_ranges(self, change):
        return CoreSlamLog([replace(scan, ranges=change(scan.ranges)) for scan in self.scans])

    def cut(self, reach):
        return self.with_ranges(lambda ranges: [r if r <= reach else 0.0 for r in ranges])

    def data(self):
        lines = []
        for scan in self.scans:
            ranges = [self.no_measurement] * self.beams
            ranges[self.useful.start:self.useful.stop] = [str(round(1000 * r)) for r in scan.ranges]
            lines.append(" ".join(scan.head + ranges))
        return ("\n".join(lines) + "\n").encode()


class Bytes:
    """Takes the numbers of a frame of our log (docs/robot.md) one by one."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values

    def varint(self):
        value = shift = 0
        while True:
            byte = self.data[self.at]
            self.at += 1
            value |= (byte & 0x7f) << shift
            shift += 7
            if byte < 0x80:
                return value

    def svarint(self):
        return unzigzag(self.varint())


def unzigzag(value):
    return value >> 1 ^ -(value & 1)


def varint(value):
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7f | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def svarint(value):
    return varint(value << 1 if value >= 0 else -2 * value - 1)


class RunLog:
    """Our own log, format version 1. Frames that are not changed keep their bytes."""
    suffix = ".rlog"
    magic = b"RUBBLE LOG 1\n"
    metres = [struct.unpack("<f", struct.pack("<f", mm * 0.001))[0] for mm in range(1 << 16)]
    millimetres = {value: mm for mm, value in enumerate(metres)}
    lists = ("5dB", "2d", "2d", "B3d")  # odometry, accelerations, aims, cues

    @dataclass
    class Scan:
        stamp: int  # of beam 0 [ns]
        geometry: tuple  # angle_min, angle_step, beam_period, range_min, range_max
        ranges: list  # [m]
        codes: bytes = b""
        packed: bytes = None  # the ranges as they were read, while they are the same

    @dataclass
    class Tick:
        now: int  # [ns]
        scans: list
        entries: list  # of each of the lists: age [ns] and values
        has_codes: bool

    def __init__(self, model, note, frames):
        self.model, self.note, self.frames = model, note, frames  # frames: a Tick, or (kind, payload)

    @property
    def ticks(self):
        return [frame for frame in self.frames if isinstance(frame, self.Tick)]

    @property
    def scans(self):
        return [scan for tick in self.ticks for scan in tick.scans]

    @classmethod
    def read(cls, data):
        at, frames, codes = len(cls.magic), [], None
        now, geometry, header = 0, [None], None
        while at + 12 <= len(data):
            size, check, _ = struct.unpack_from("<3I", data, at)
            payload = data[at + 12:at + 12 + size]
            if len(payload) < size or zlib.crc32(payload) != check:
                break  # torn
            at += 12 + size
            kind = payload[:1]
            bytes_ = Bytes(payload)
            bytes_.at = 1
            if kind == b"H":
                size = bytes_.varint()
                model = json.loads(payload[bytes_.at:bytes_.at + size])
                header = model, payload[bytes_.at + size:]
            elif kind == b"K":
                codes = cls.take_codes(bytes_)
            elif kind == b"T":
                now += bytes_.svarint()
                frames.append(cls.take_tick(bytes_, now, geometry, codes))
                codes = None
            else:
                frames.append((kind, payload))
        if header is None:
            sys.exit("the log has no whole header")
        return cls(*header, frames)

    @staticmethod
    def take_codes(bytes_):
        scans = []
        for _ in range(bytes_.varint()):
            beams, codes = bytes_.varint(), bytearray()
            while len(codes) < beams:
                code, = bytes_.take("B")
                codes += bytes([code]) * bytes_.varint()
            scans.append(bytes(codes))
        return scans

    @classmethod
    def take_tick(cls, bytes_, now, geometry, codes):
        scans = []
        for number in range(bytes_.varint()):
            stamp = now - bytes_.svarint()
            if bytes_.take("B")[0]:
                geometry[0] = bytes_.take("5d")
            beams = bytes_.varint()
            begin = bytes_.at
            scan = cls.Scan(stamp, geometry[0], cls.take_ranges(bytes_, beams), codes[number] if codes else b"")
            scan.packed = bytes_.data[begin:bytes_.at]
            scans.append(scan)
        entries = [[(bytes_.svarint(), bytes_.take(form)) for _ in range(bytes_.varint())] for form in cls.lists]
        return cls.Tick(now, scans, entries, codes is not None)

    @classmethod
    def take_ranges(cls, bytes_, beams):
        ranges, mm, data, at, metres = [], 0, bytes_.data, bytes_.at, cls.metres
        while len(ranges) < beams:
            code = data[at]
            at += 1
            if code == 0xF3:
                ranges += struct.unpack_from("<f", data, at)
                at += 4
                continue
            if code in (0xF1, 0xF2):
                ranges += [INF if code == 0xF1 else NAN] * (data[at] + 1)
                at += 1
                continue
            if code == 0xF0:
                bytes_.at = at
                code = bytes_.varint()
                at = bytes_.at
            elif code >= 0xC0:
                code = 192 + 256 * (code - 0xC0) + data[at]
                at += 1
            mm += unzigzag(code)
            ranges.append(metres[mm])
        bytes_.at = at
        return ranges

    @classmethod
    def put_ranges(cls, ranges):
        out, mm, at, millimetres = bytearray(), 0, 0, cls.millimetres
        while at < len(ranges):
            here = ranges[at]
            at += 1
            new = millimetres.get(here)
            if new is not None:
                code = 2 * (new - mm) if new >= mm else 2 * (mm - new) - 1
                mm = new
                if code < 0xC0:
                    out.append(code)
                elif code < 0xC0 + 0x30 * 256:
                    out += bytes((0xC0 + (code - 0xC0 >> 8), code - 0xC0 & 0xFF))
                else:
                    out += b"\xF0" + varint(code)
            elif abs(here) < INF:
                out += b"\xF3" + struct.pack("<f", here)
            else:
                first, missed = at, here == INF
                for here in ranges[first:first + 255]:
                    if abs(here) < INF or (here == INF) != missed:
                        break
                    at += 1
                out += bytes((0xF1 if missed else 0xF2, at - first))
        return bytes(out)

    def stamps(self):
        return [scan.stamp * 1e-9 for scan in self.scans]

    def reach(self):
        return self.model["laser_range_max"]

    def mirrored(self):
        """A sweep that ran counter-clockwise runs clockwise: its first beam is the last one now."""
        def changed(frame):
            if not isinstance(frame, self.Tick):
                return frame if frame[0] != b"C" else (b"C", mirrored_command(frame[1]))
            odometry, accelerations, aims, cues = frame.entries
            return replace(frame, scans=[mirrored_scan(scan) for scan in frame.scans], entries=[
                [(age, (x, -y, -phi, v, -w, stalled)) for age, (x, y, phi, v, w, stalled) in odometry],
                [(age, (x, -y)) for age, (x, y) in accelerations],
                [(age, (pitch, -roll)) for age, (pitch, roll) in aims],
                [(age, (kind, -bearing, *rest)) for age, (kind, bearing, *rest) in cues]])

        def mirrored_scan(scan):
            start, step, period, *reach = scan.geometry
            last = len(scan.ranges) - 1
            return self.Scan(scan.stamp + round(last * period * 1e9), (-(start + last * step), step, -period, *reach),
                             scan.ranges[::-1], scan.codes[::-1])

        def mirrored_command(payload):
            v, w, pitch, roll = struct.unpack_from("<4d", payload, 1)
            return payload[:1] + struct.pack("<4d", v, -w, pitch, -roll) + payload[33:]

        turned = ("base_laser_y", "base_laser_yaw", "base_laser_roll")
        model = {**self.model, **{key: -self.model[key] for key in turned}}
        model["laser_angle_min"] = -(model["laser_angle_min"] + (model["laser_beams"] - 1) * model["laser_angle_step"])
        return RunLog(model, self.note, [changed(frame) for frame in self.frames])

    def with_scans(self, is_kept):
        number, frames = 0, []
        for frame in self.frames:
            if isinstance(frame, self.Tick):
                kept = [scan for i, scan in enumerate(frame.scans, number) if is_kept(i)]
                number += len(frame.scans)
                frame = replace(frame, scans=kept)
            frames.append(frame)
        return RunLog(self.model, self.note, frames)

    def with_ranges(self, change):
        def changed(scan):
            ranges = change(scan.ranges)
            kept = [new is old for new, old in zip(ranges, scan.ranges)]
            ranges = [r if same or r == INF else self.metres[round(1000 * r)] for r, same in zip(ranges, kept)]
            codes = bytes(code if same else 0 for code, same in zip(scan.codes, kept))
            return replace(scan, ranges=ranges, codes=codes, packed=None)

        return RunLog(self.model, self.note, [
            replace(frame, scans=[changed(scan) for scan in frame.scans]) if isinstance(frame, self.Tick) else frame
            for frame in self.frames])

    def cut(self, reach):
        log = self.with_ranges(lambda ranges: [INF if r > reach else r for r in ranges])
        for scan in log.scans:
            scan.geometry = scan.geometry[:4] + (min(scan.geometry[4], reach),)
        log.model = {**log.model, "laser_range_max": min(log.model["laser_range_max"], reach)}
        return log

    def data(self):
        out, now, geometry = bytearray(self.magic), 0, None

        def frame(payload):
            sizes = struct.pack("<2I", len(payload), zlib.crc32(payload))
            out.extend(sizes + struct.pack("<I", zlib.crc32(sizes)) + payload)

        model = json.dumps(self.model, separators=(",", ":")).encode()
        frame(b"H" + varint(len(model)) + model + self.note)
        for entry in self.frames:
            if not isinstance(entry, self.Tick):
                frame(entry[1])
                continue
            if entry.has_codes and entry.scans:
                frame(b"K" + varint(len(entry.scans)) + b"".join(self.put_codes(scan.codes) for scan in entry.scans))
            parts = [b"T", svarint(entry.now - now), varint(len(entry.scans))]
            now = entry.now
            for scan in entry.scans:
                parts.append(svarint(now - scan.stamp) + (b"\0" if scan.geometry == geometry else
                                                          b"\1" + struct.pack("<5d", *scan.geometry)))
                geometry = scan.geometry
                parts.append(varint(len(scan.ranges)) + (scan.packed or self.put_ranges(scan.ranges)))
            for form, entries in zip(self.lists, entry.entries):
                parts.append(varint(len(entries)))
                parts += [svarint(age) + struct.pack("<" + form, *values) for age, values in entries]
            frame(b"".join(parts))
        return bytes(out)

    @staticmethod
    def put_codes(codes):
        out, at = varint(len(codes)), 0
        while at < len(codes):
            run = len(codes[at:]) - len(codes[at:].lstrip(codes[at:at + 1]))
            out += codes[at:at + 1] + varint(run)
            at += run
        return out


def read_log(path):
    data = path.read_bytes()
    if data[:2] == b"\x1f\x8b":
        data = gzip.decompress(data)
    if data[:3] == b"BZh":
        data = bz2.decompress(data)
    if data.startswith(RunLog.magic):
        return RunLog.read(data)
    if data.startswith(b"RUBBLE LOG"):
        sys.exit(f"{path}: is a log of another version")
    return (CoreSlamLog if data.lstrip()[:1].isdigit() else CarmenLog).read(data)


def randomised(log, seed):
    draw, reach = random.Random(seed), log.reach()

    def change(ranges):
        ranges = ranges[:]
        for beam in draw.sample(range(len(ranges)), round(SHARE * len(ranges))):
            ranges[beam] = round(draw.uniform(0.0, reach), 3)
        return ranges

    return log.with_ranges(change)


def write_relations(path, text, stamps, is_mirrored):
    """Those whose ends are both stamps of scans of the log."""
    stamps = sorted(stamps)

    def is_of_scan(stamp):
        first = bisect.bisect_left(stamps, stamp - LATEST)
        return first < len(stamps) and stamps[first] <= stamp + LATEST

    with path.open("w") as out:
        for line in filter(str.split, text.splitlines()):
            words = line.split()
            if not (is_of_scan(float(words[0])) and is_of_scan(float(words[1]))):
                continue
            if is_mirrored:  # y, roll and yaw
                for i in (3, 5, 7):
                    words[i] = repr(-float(words[i]))
            out.write(" ".join(words) + "\n")


def write_truth(path, text, is_mirrored):
    with path.open("w") as out:
        for line in filter(str.split, text.splitlines()):
            words = line.split()
            if is_mirrored and words[0] != "#":  # y, and the turns about x and z
                for i in (2, 4, 6):
                    words[i] = repr(-float(words[i]))
            out.write(" ".join(words) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT_FOLDER")
    parser.add_argument("--range", type=float, default=4.0, help="of the scanner of 'cut' [m]")
    parser.add_argument("--seed", type=int, default=1, help="of 'random'")
    parser.add_argument("--relations", type=pathlib.Path, help="of LOG")
    arguments = parser.parse_args()
    if not arguments.range > 0:
        parser.error("--range: give metres above 0")
    try:
        log = read_log(arguments.log)
    except (OSError, EOFError, zlib.error) as error:
        sys.exit(f"{arguments.log}: cannot be read whole: {error}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    truth = arguments.log.parent / "truth.tum"
    variants = {"unchanged": lambda: log, "mirrored": log.mirrored,
                "even": lambda: log.with_scans(lambda i: i % 2 == 0),
                "odd": lambda: log.with_scans(lambda i: i % 2 == 1), "random": lambda: randomised(log, arguments.seed),
                "cut": lambda: log.cut(arguments.range)}
    for name, make in variants.items():
        changed = make()
        path = arguments.out / (name + log.suffix)
        path.write_bytes(changed.data())
        if arguments.relations:
            relations = arguments.relations.read_text()
            write_relations(path.with_suffix(".relations"), relations, changed.stamps(), name == "mirrored")
        if isinstance(log, RunLog) and truth.exists():
            write_truth(path.with_suffix(".tum"), truth.read_text(), name == "mirrored")
        print(f"{path}: {len(changed.scans)} scans")


if __name__ == "__main__":
    main()
