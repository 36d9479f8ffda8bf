"""ARCOS packets as bytes, written from the Pioneer manuals' tables, not from rubble's driver."""
import struct


def checksum(payload):
    c = 0
    for i in range(0, len(payload) - 1, 2):
        c = (c + (payload[i] << 8 | payload[i + 1])) & 0xFFFF
    if len(payload) % 2:
        c ^= payload[-1]
    return c


def packet(payload):
    return b"\xfa\xfb" + bytes([len(payload) + 2]) + payload + struct.pack(">H", checksum(payload))


def order(number, value=None):
    if value is None:
        return packet(bytes([number]))
    return packet(bytes([number, 0x3B if value >= 0 else 0x1B]) + struct.pack("<H", abs(value)))


# What was seen on the wire: whoever speaks by this must be right.
assert order(1, 1) == bytes.fromhex("fafb06013b0100023b")
assert order(11, -300) == bytes.fromhex("fafb060b1b2c01371c")
assert order(29) == bytes.fromhex("fafb031d001d")
