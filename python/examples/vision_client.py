"""A vision system of a page: walks the robot over UDP, and tells her of a box. Standard library only.

    gangwerk gateway                                            # beside a robot that stands
    python3 vision_client.py --forward 0.3 --seconds 10 --box 1.5 0 0.06 1.2 0.1

Each trigger of the gateway is answered with a velocity, and now and then with the box. When this program ends, hangs or is
killed, she comes to a stand within half a second and the steps that stopping takes. The datagrams: docs/vision.md.
"""

import argparse
import collections
import math
import os
import socket
import struct
import time

HEAD = struct.Struct("<4sHHQQQ")  # magic, version, kind, sender, sequence, stamp
TRIGGER = struct.Struct("<QQQ35d11Q")  # cycle, flags, gait; numbers; counts
VELOCITY, FIXATE, BOX, GONE = 1, 2, 3, 4
ROBOT, LEASE, HELD = 1, 2, 4
CAUSES = ("malformed", "version", "not_finite", "range", "sender", "age", "order", "rate", "held", "robot")

Trigger = collections.namedtuple("Trigger", "stamp cycle flags gait place place_error heading_error way poses accepted refused")


class Gateway:
    """The robot's end of the line, from which triggers come."""

    def __init__(self, port=47201, host="127.0.0.1"):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((host, port))
        self.sender, self.sequence = os.getpid(), 0
        self.address, self.stamp = None, 0

    def trigger(self, timeout=2.0):
        """The next trigger."""
        self.socket.settimeout(timeout)
        data, self.address = self.socket.recvfrom(2048)
        magic, version, kind, _, _, self.stamp = HEAD.unpack_from(data)
        if (magic, version, kind, len(data)) != (b"GWVI", 1, 0, HEAD.size + TRIGGER.size):
            raise ValueError("not a trigger of version 1")
        cycle, flags, gait, *rest = TRIGGER.unpack_from(data, HEAD.size)
        numbers, counts = rest[:35], rest[35:]
        poses = dict(zip(("camera", "torso", "right", "left"), (numbers[7 + 7 * i : 14 + 7 * i] for i in range(4))))
        refused = dict(zip(CAUSES, counts[1:]))
        return Trigger(self.stamp, cycle, flags, gait, numbers[:4], *numbers[4:7], poses, counts[0], refused)

    def send(self, kind, *numbers):
        """Answers the newest trigger."""
        self.sequence += 1
        head = HEAD.pack(b"GWVI", 1, kind, self.sender, self.sequence, self.stamp)
        self.socket.sendto(head + struct.pack(f"<{len(numbers)}d", *numbers), self.address)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--port", type=int, default=47201, help="where triggers come in")
    options.add_argument("--forward", type=float, default=0.3, help="[m/s]")
    options.add_argument("--left", type=float, default=0.0, help="[m/s]")
    options.add_argument("--turn", type=float, default=0.0, help="[rad/s]")
    options.add_argument("--seconds", type=float, default=10.0)
    options.add_argument("--box", type=float, nargs=5, metavar=("X", "Y", "LENGTH", "WIDTH", "HEIGHT"), help="[m], in I_0")
    asked = options.parse_args()
    gateway, end = Gateway(asked.port), time.monotonic() + asked.seconds
    seen = gateway.trigger()
    while time.monotonic() < end:
        if asked.box:
            x, y, *size = asked.box
            gateway.send(BOX, 1, x, y, 0.0, 0.0, *size, 60.0)
        gateway.send(VELOCITY, asked.forward, asked.left, asked.turn)
        seen = gateway.trigger()
        if seen.flags & HELD:
            print("somebody else has stopped her: not started again")
            break
    gateway.send(VELOCITY, 0.0, 0.0, 0.0)
    seen = gateway.trigger()
    x, y, _, heading = seen.place
    print(f"at {x:.2f} {y:.2f} m, {math.degrees(heading):.0f} degrees, give or take {seen.place_error:.2f} m")
    print(f"accepted {seen.accepted}, refused {({cause: n for cause, n in seen.refused.items() if n})}")


if __name__ == "__main__":
    main()
