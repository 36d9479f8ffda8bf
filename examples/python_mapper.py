#!/usr/bin/env python3
"""A mapper of one file, standard library only:  rubble run --mapper-command "python3 examples/python_mapper.py"

Dead reckoning leads from scan to scan. After each 0.15 m or 8 deg the scan is fitted to the map (hill climbing on a
blurred picture of the walls) and entered into it. docs/mapper_protocol.md describes what goes over stdin and stdout;
print to stderr, it ends up in mapper.log of the run folder.
"""
import math
import sys

RESOLUTION = 0.05  # [m]
SIDE = 1200  # cells; the map covers SIDE * RESOLUTION metres around the start
MIDDLE = SIDE // 2
STEP_M, STEP_RAD = 0.15, math.radians(8.0)  # motion after which a scan is mapped
MATCHED_BEAMS = 110  # of a scan, for the fit
FREE_EVERY = 2  # every so many beams clear the cells they cross


def compose(a, b):
    """Pose b, given in the frame of pose a, in the frame of a's parent."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], wrap(a[2] + b[2]))


def between(a, b):
    """Pose b as seen from pose a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    return (c * dx + s * dy, c * dy - s * dx, wrap(b[2] - a[2]))


def axes_from_above(roll, pitch, yaw):
    """Where a laser mounted so looks ahead and to its left, seen from above: two directions (x, y) of the base frame."""
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    c, s = math.cos(yaw), math.sin(yaw)
    return (c * cp, s * cp), (c * sp * sr - s * cr, s * sp * sr + c * cr)


def wrap(angle):
    return math.remainder(angle, 2.0 * math.pi)


class Grid:
    """Counts of hits and of sightings a cell, what they mean (? . #), and a blurred picture of the hits to fit scans to."""

    def __init__(self):
        self.hits = bytearray(SIDE * SIDE)
        self.seen = bytearray(SIDE * SIDE)
        self.drawn = bytearray(b"?" * (SIDE * SIDE))
        self.blurred = bytearray(SIDE * SIDE)
        self.low_x = self.low_y = SIDE
        self.high_x = self.high_y = 0

    def count(self, cell, hit):
        if self.seen[cell] == 255:
            self.seen[cell] //= 2
            self.hits[cell] //= 2
        self.seen[cell] += 1
        if hit:
            self.hits[cell] += 1
        occupied = 5 * self.hits[cell] >= 2 * self.seen[cell]
        self.drawn[cell] = 35 if occupied else 46  # '#', '.'
        if hit:
            blurred = self.blurred
            blurred[cell] = 4
            for near in (cell - 1, cell + 1, cell - SIDE, cell + SIDE):
                if blurred[near] < 2:
                    blurred[near] = 2
            for near in (cell - SIDE - 1, cell - SIDE + 1, cell + SIDE - 1, cell + SIDE + 1):
                if blurred[near] < 1:
                    blurred[near] = 1

    def fit(self, points, pose):
        """Points of the base frame on the walls: how well does the pose lay them there?"""
        c, s = math.cos(pose[2]) / RESOLUTION, math.sin(pose[2]) / RESOLUTION
        x0, y0 = pose[0] / RESOLUTION + MIDDLE, pose[1] / RESOLUTION + MIDDLE
        blurred = self.blurred
        return sum([blurred[int(y0 + s * x + c * y) * SIDE + int(x0 + c * x - s * y)] for x, y in points])

    def add(self, points, laser, pose):
        """Points (x, y) of the base frame, seen from `laser`: hit cells, and free cells on the way to some of them."""
        c, s = math.cos(pose[2]) / RESOLUTION, math.sin(pose[2]) / RESOLUTION
        x0, y0 = pose[0] / RESOLUTION + MIDDLE, pose[1] / RESOLUTION + MIDDLE
        from_x, from_y = x0 + c * laser[0] - s * laser[1], y0 + s * laser[0] + c * laser[1]
        hit, free = set(), set()
        for i, (x, y) in enumerate(points):
            to_x, to_y = x0 + c * x - s * y, y0 + s * x + c * y
            if not (3 < to_x < SIDE - 3 and 3 < to_y < SIDE - 3):
                continue
            self.low_x, self.high_x = min(self.low_x, int(to_x)), max(self.high_x, int(to_x))
            self.low_y, self.high_y = min(self.low_y, int(to_y)), max(self.high_y, int(to_y))
            hit.add(int(to_y) * SIDE + int(to_x))
            if i % FREE_EVERY:
                continue
            length = math.hypot(to_x - from_x, to_y - from_y)
            steps = int(length - 1.0)
            if steps < 1:
                continue
            dx, dy = (to_x - from_x) / length, (to_y - from_y) / length
            for k in range(steps):
                free.add(int(from_y + k * dy) * SIDE + int(from_x + k * dx))
        free -= hit
        for cell in sorted(free):
            self.count(cell, False)
        for cell in sorted(hit):
            self.count(cell, True)

    def lines(self):
        """The known part, as the protocol wants it: the southernmost row first."""
        if self.high_x < self.low_x:
            return []
        x0, x1 = self.low_x - 1, self.high_x + 2
        y0, y1 = self.low_y - 1, self.high_y + 2
        head = "map %d %d %r %r %r" % (
            x1 - x0, y1 - y0, RESOLUTION, (x0 - MIDDLE) * RESOLUTION, (y0 - MIDDLE) * RESOLUTION)
        rows = [self.drawn[y * SIDE + x0 : y * SIDE + x1].decode("ascii") for y in range(y0, y1)]
        return [head] + rows


class Mapper:
    def __init__(self, header):
        self.laser = (float(header["laser.x_m"]), float(header["laser.y_m"]))
        # A laser that hangs upside down sees left and right exchanged.
        self.ahead, self.left = axes_from_above(*(float(header["laser.%s_rad" % turn]) for turn in ("roll", "pitch", "yaw")))
        self.grid = Grid()
        self.odometry = []  # (stamp [ns], pose, v, w), the last second
        self.T_map_odom = (0.0, 0.0, 0.0)
        self.mapped_at = None  # pose of the last mapping step
        self.mapped = 0

    def odometry_at(self, stamp):
        """(pose, v, w) interpolated at a stamp."""
        if not self.odometry:
            return (0.0, 0.0, 0.0), 0.0, 0.0
        before = after = self.odometry[-1]
        for entry in reversed(self.odometry):
            before = entry
            if entry[0] <= stamp:
                break
            after = entry
        if before[0] >= after[0] or stamp <= before[0]:
            return before[1], before[2], before[3]
        share = min(1.0, (stamp - before[0]) / (after[0] - before[0]))
        x, y, phi = between(before[1], after[1])
        return compose(before[1], (share * x, share * y, share * phi)), after[2], after[3]

    def pose(self):
        return compose(self.T_map_odom, self.odometry[-1][1] if self.odometry else (0.0, 0.0, 0.0))

    def points(self, scan, v, w):
        """End points in the base frame at the middle of the sweep: each beam is placed by its own time."""
        _, angle_min, angle_step, beam_period, range_min, range_max = scan[:6]
        ranges = scan[6]
        found = []
        for i, r in enumerate(ranges):
            if not range_min <= r <= range_max:  # also what is inf or nan
                continue
            bearing = angle_min + i * angle_step
            c, s = r * math.cos(bearing), r * math.sin(bearing)
            x = self.laser[0] + c * self.ahead[0] + s * self.left[0]
            y = self.laser[1] + c * self.ahead[1] + s * self.left[1]
            late = (i - len(ranges) // 2) * beam_period
            turn = w * late
            found.append((x - turn * y + v * late, y + turn * x))
        return found

    def matched(self, points, pose):
        """The pose near `pose` that lays the scan on the walls best; ever smaller steps around the best so far."""
        sample = points[:: max(1, len(points) // MATCHED_BEAMS)]
        if len(sample) < 30 or self.mapped < 3:
            return pose
        reach = max(math.hypot(x, y) for x, y in sample) + 1.0
        if max(abs(pose[0]), abs(pose[1])) + reach > (MIDDLE - 3) * RESOLUTION:
            return pose
        best, best_fit = pose, self.grid.fit(sample, pose)
        step, turn = 0.06, math.radians(2.0)
        while step > 0.01:
            start = best
            for dx, dy, dphi in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)):
                tried = (start[0] + dx * step, start[1] + dy * step, start[2] + dphi * turn)
                fit = self.grid.fit(sample, tried)
                if fit > best_fit:
                    best, best_fit = tried, fit
            off = between(pose, best)
            if best == start or math.hypot(off[0], off[1]) > 0.25:
                step, turn = 0.5 * step, 0.5 * turn
        return best

    def take_scan(self, scan):
        """Returns (stamp of the scan's middle, pose there, whether the map changed)."""
        middle = scan[0] + int(round(len(scan[6]) // 2 * scan[3] * 1e9))
        T_odom_base, v, w = self.odometry_at(middle)
        pose = compose(self.T_map_odom, T_odom_base)
        if self.mapped_at is not None and self.mapped >= 5:
            off = between(self.mapped_at, pose)
            if math.hypot(off[0], off[1]) < STEP_M and abs(off[2]) < STEP_RAD:
                return middle, pose, False
        points = self.points(scan, v, w)
        pose = self.matched(points, pose)
        inverse = between(T_odom_base, (0.0, 0.0, 0.0))
        self.T_map_odom = compose(pose, inverse)
        self.grid.add(points, self.laser, pose)
        self.mapped_at = pose
        self.mapped += 1
        return middle, pose, True


def read_header(lines):
    first = next(lines).split()
    if first[:2] != ["rubble-mapper", "1"]:
        sys.exit("this mapper speaks version 1 of rubble-mapper, not %s" % " ".join(first))
    header = {}
    for line in lines:
        key, _, value = line.rstrip("\n").partition(" ")
        if key == "start":
            return header
        if key == "parameters":
            for _ in range(int(value)):
                next(lines)
        else:
            header[key] = value
    sys.exit("the header has no end")


def main():
    lines = iter(sys.stdin)
    mapper = Mapper(read_header(lines))
    sys.stdout.write("ready 1\n")
    sys.stdout.flush()
    scans, last_scan, T_first = [], 0, None
    for line in lines:
        words = line.split()
        if words[0] == "odometry":
            pose = tuple(float(word) for word in words[2:5])
            if T_first is None:
                T_first = pose
                mapper.T_map_odom = between(pose, (0.0, 0.0, 0.0))
            mapper.odometry.append((int(words[1]), pose, float(words[5]), float(words[6])))
            del mapper.odometry[:-20]
        elif words[0] == "scan":
            numbers = [float(word) for word in words[2:7]]
            scans.append([int(words[1])] + numbers + [[float(word) for word in words[8:]]])
        elif words[0] == "end":
            answer, changed = [], False
            for scan in scans:
                if not scan[6] or scan[0] <= last_scan and mapper.mapped:
                    continue
                last_scan = scan[0]
                stamp, pose, in_map = mapper.take_scan(scan)
                changed = changed or in_map
                answer.append("at %d %r %r %r" % ((stamp,) + pose))
            scans = []
            answer.append("pose %r %r %r" % mapper.pose())
            if changed:
                answer.append("mapped %d" % mapper.mapped)
                answer += mapper.grid.lines()
            answer.append("end\n")
            sys.stdout.write("\n".join(answer))
            sys.stdout.flush()


if __name__ == "__main__":
    main()
