"""What the clients that check emulated devices have in common: the line to the device, and the clauses that it broke."""
import os
import socket
import sys

failures = []


def law(holds, what):
    if not holds:
        failures.append(what)
        print("BROKEN: " + what)


def end_with_verdict(word):
    print("%s: %d clauses broken" % (word.split(":")[0], len(failures)))
    sys.exit(1 if failures else 0)


class DevicePort:
    """An open line, `file`; word: tcp:HOST:PORT or pty:PATH."""

    def __init__(self, word):
        kind, rest = word.split(":", 1)
        if kind == "tcp":
            host, port = rest.rsplit(":", 1)
            self.socket = socket.create_connection((host, int(port)))
            self.file = self.socket.fileno()
        else:
            self.file = os.open(rest, os.O_RDWR | os.O_NOCTTY)

    def close(self):
        if hasattr(self, "socket"):
            self.socket.close()
        else:
            os.close(self.file)
