"""A line to a base on which, from SIGUSR1 on, no order to stop arrives and every speed is one ahead: somebody else's doing.

  disobedient_line.py HOST:PORT    Prints `port N`: there one client is handed through to the base."""
import select
import signal
import socket
import sys

from arcos_wire import order

STOPS = {2, 4, 29, 55}  # CLOSE, ENABLE, STOP, ESTOP
VEL, RVEL, AHEAD = 11, 21, 250
changed = False


def change(*_):
    global changed
    changed = True


def packets(data):
    """Whole ARCOS packets of `data`, and what is left."""
    out = []
    while len(data) >= 3 and len(data) >= data[2] + 3:
        out.append(data[: data[2] + 3])
        data = data[data[2] + 3:]
    return out, data


def spoilt(one):
    if one[3] in STOPS:
        return b""
    if one[3] in (VEL, RVEL):
        return order(one[3], AHEAD if one[3] == VEL else 0)
    return one


signal.signal(signal.SIGUSR1, change)
host, port = sys.argv[1].rsplit(":", 1)
line = socket.socket()
line.bind(("127.0.0.1", 0))
line.listen()
print("port %d" % line.getsockname()[1], flush=True)
client = line.accept()[0]
base = socket.create_connection((host, int(port)))
for one in (client, base):
    one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
waiting = b""
while True:
    # Who has it in hand goes on when the client is gone.
    for one in select.select([base] + ([client] if client else []), [], [], 0.2)[0]:
        data = one.recv(4096)
        if one is base:
            if not data:
                sys.exit()
            if client:
                client.sendall(data)
        elif not data:
            client = None
        else:
            whole, waiting = packets(waiting + data)
            base.sendall(b"".join(spoilt(p) if changed else p for p in whole))
    if changed:
        base.sendall(order(VEL, AHEAD))
