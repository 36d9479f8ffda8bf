"""Somebody else who drives the base in circles, by ARCOS over TCP, while others only map.

  foreign_driver.py HOST:PORT SECONDS    Prints `tee PORT`: there whoever comes is handed what the base says, as a serial server with
several connections does. Ends with `heard N bytes, motors on B of N reports, turned R deg`: N bytes came from those who listened."""
import math
import select
import socket
import struct
import sys
import time

from arcos_wire import order

host, port = sys.argv[1].rsplit(":", 1)
seconds = float(sys.argv[2])


base = socket.create_connection((host, int(port)))
tee = socket.socket()
tee.bind(("127.0.0.1", 0))
tee.listen()
listeners = []
heard = reports = on = 0
turned, last = 0.0, None
waiting = b""
for hello in (order(0), order(1), order(2), order(1, 1), order(4, 1)):
    base.sendall(hello)
    time.sleep(0.2)
print("tee 127.0.0.1:%d" % tee.getsockname()[1], flush=True)
end, say = time.time() + seconds, 0.0
while time.time() < end:
    if time.time() >= say:
        say = time.time() + 0.3
        base.sendall(order(11, 200))
        time.sleep(0.005)
        base.sendall(order(21, 25))
    ready = select.select([base, tee, *listeners], [], [], 0.05)[0]
    for one in ready:
        if one is tee:
            listeners.append(tee.accept()[0])
        elif one is base:
            data = base.recv(4096)
            if not data:
                sys.exit("the base hung up")
            for listener in list(listeners):
                try:
                    listener.sendall(data)
                except OSError:
                    listeners.remove(listener)
            waiting += data
            while len(waiting) > 3 and len(waiting) >= waiting[2] + 3:
                payload, waiting = waiting[3:waiting[2] + 1], waiting[waiting[2] + 3:]
                if payload[0] not in (0x32, 0x33):
                    continue
                heading = struct.unpack_from("<h", payload, 5)[0] * 2 * math.pi / 4096
                if last is not None:
                    turned += (heading - last + math.pi) % (2 * math.pi) - math.pi
                last = heading
                reports += 1
                on += struct.unpack_from("<H", payload, 16)[0] & 1
        else:
            data = b""
            try:
                data = one.recv(4096)
            except OSError:
                pass
            heard += len(data)
            if not data:
                listeners.remove(one)
base.sendall(order(29, 0) + order(2, 1))
print("heard %d bytes, motors on %d of %d reports, turned %.0f deg" % (heard, on, reports, math.degrees(turned)))
