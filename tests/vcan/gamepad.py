"""A gamepad that the kernel takes for a real one (uinput), moved by lines on standard input: `key CODE VALUE`, `abs CODE VALUE`.

Sticks, triggers, hat and buttons are those of an Xbox gamepad. Each line is one report; the end of the input unplugs it.
"""

import fcntl
import os
import struct
import sys

EV_SYN, EV_KEY, EV_ABS = 0, 1, 3
UI_DEV_CREATE, UI_DEV_DESTROY, UI_DEV_SETUP, UI_ABS_SETUP = 0x5501, 0x5502, 0x405C5503, 0x401C5504
UI_SET_EVBIT, UI_SET_KEYBIT, UI_SET_ABSBIT = 0x40045564, 0x40045565, 0x40045567
BUS_USB = 3
# Code, minimum, maximum, flat.
AXES = [(code, -32768, 32767, 128) for code in (0, 1, 3, 4)] + [(code, 0, 1023, 0) for code in (2, 5)]
AXES += [(code, -1, 1, 0) for code in (0x10, 0x11)]
BUTTONS = [0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13A, 0x13B, 0x13C, 0x13D, 0x13E]


def main(name):
    device = os.open("/dev/uinput", os.O_WRONLY)
    for kind in (EV_KEY, EV_ABS):
        fcntl.ioctl(device, UI_SET_EVBIT, kind)
    for code in BUTTONS:
        fcntl.ioctl(device, UI_SET_KEYBIT, code)
    for code, low, high, flat in AXES:
        fcntl.ioctl(device, UI_SET_ABSBIT, code)
        # struct uinput_abs_setup: code, then value, minimum, maximum, fuzz, flat, resolution.
        fcntl.ioctl(device, UI_ABS_SETUP, struct.pack("H2x6i", code, 0, low, high, 0, flat, 0))
    # struct uinput_setup: bus, vendor, product, version, name, effects.
    fcntl.ioctl(device, UI_DEV_SETUP, struct.pack("4H80sI", BUS_USB, 0x045E, 0x028E, 1, name.encode(), 0))
    fcntl.ioctl(device, UI_DEV_CREATE)
    for line in sys.stdin:
        kind, code, value = line.split()
        event = struct.pack("qqHHi", 0, 0, {"key": EV_KEY, "abs": EV_ABS}[kind], int(code, 0), int(value))
        os.write(device, event + struct.pack("qqHHi", 0, 0, EV_SYN, 0, 0))
    fcntl.ioctl(device, UI_DEV_DESTROY)


main(sys.argv[1])
