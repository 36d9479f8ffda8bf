"""What a drive said to its base, from the black box that it wrote (devices.bytes; docs/hardware.md)."""
import bisect
import struct

MAGIC = b"RUBBLE BYTES 1\n"
FROM_DEVICE, TO_DEVICE, OPENED, LOST, BIT_RATE = range(5)
ENABLE, VEL, RVEL, STOP, ESTOP = 4, 11, 21, 29, 55  # orders of ARCOS


def entries(path):
    """(device, direction, time [s], bytes), in their order; a torn last one is dropped."""
    data = open(path, "rb").read()
    if not data.startswith(MAGIC):
        raise ValueError(path + " is no black box")
    at = len(MAGIC)
    while at < len(data):
        size = data[at]
        head = at + 1 + size
        if head + 13 > len(data):
            return
        stamp, count = struct.unpack_from("<qI", data, head + 1)
        if head + 13 + count > len(data):
            return
        yield data[at + 1:head].decode(), data[head], 1e-9 * stamp, data[head + 13:head + 13 + count]
        at = head + 13 + count


def orders(path):
    """(time [s], number, value or None) of all packets to the base whose sums are right."""
    for device, direction, stamp, data in entries(path):
        if device != "base" or direction != TO_DEVICE:
            continue
        while len(data) >= 6 and data[:2] == b"\xfa\xfb":
            payload = data[3:1 + data[2]]
            data = data[3 + data[2]:]
            value = None
            if len(payload) >= 4 and payload[1] in (0x1B, 0x3B):
                value = struct.unpack_from("<H", payload, 2)[0] * (-1 if payload[1] == 0x1B else 1)
            yield stamp, payload[0], value


def rolled_over(path):
    """How often a coordinate in the base's reports went past 65.535 m or back."""
    waiting, last, count = b"", None, 0
    for device, direction, _, data in entries(path):
        if device != "base" or direction != FROM_DEVICE:
            continue
        waiting += data
        while True:
            at = waiting.find(b"\xfa\xfb")
            if at < 0 or len(waiting) < at + 3 or len(waiting) < at + 3 + waiting[at + 2]:
                break
            payload = waiting[at + 3:at + 1 + waiting[at + 2]]
            waiting = waiting[at + 3 + waiting[at + 2]:]
            if len(payload) < 18 or payload[0] not in (0x32, 0x33):
                continue
            here = struct.unpack_from("<HH", payload, 1)
            if last is not None:
                count += sum(abs(a - b) > 32768 for a, b in zip(here, last))
            last = here
    return count


class SetPoints:
    """Speed [mm/s] and turn rate [deg/s] that the base was told to keep, over time."""

    def __init__(self, path):
        self.times, self.states, self.enabled = [0.0], [(0, 0)], []
        v = w = 0
        for stamp, number, value in orders(path):
            if number == VEL:
                v = value or 0
            elif number == RVEL:
                w = value or 0
            elif number in (STOP, ESTOP) or (number == ENABLE and not value):
                v = w = 0
            if number == ENABLE and value:
                self.enabled.append(stamp)
            self.times.append(stamp)
            self.states.append((v, w))

    def at(self, time):
        return self.states[bisect.bisect_right(self.times, time) - 1]

    def zero_since(self, end):
        """Since when both were zero without a break up to `end`; None: they were not at `end`."""
        i = bisect.bisect_right(self.times, end) - 1
        if self.states[i] != (0, 0):
            return None
        while i > 0 and self.states[i - 1] == (0, 0):
            i -= 1
        return self.times[i]
