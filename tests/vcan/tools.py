"""Frames there and back between two sockets of python-can, classic and CAN FD, their values packed by cantools."""

import sys

import can
import cantools

DBC = """VERSION ""
NS_ :
BS_:
BU_: near far
BO_ 291 classic: 8 near
 SG_ angle : 0|20@1- (0.001,0) [-500|500] "rad" far
 SG_ counter : 56|8@1+ (1,0) [0|255] "" far
BO_ 292 long: 64 near
 SG_ force : 480|32@1- (0.25,0) [-500|500] "N" far
"""

lines = cantools.database.load_string(DBC, "dbc")
cases = [("classic", {"angle": -12.345, "counter": 200}, False), ("long", {"force": -321.75}, True)]
with can.Bus("vcan0", interface="socketcan", fd=True) as near, can.Bus("vcan0", interface="socketcan", fd=True) as far:
    for name, values, fd in cases:
        message = lines.get_message_by_name(name)
        data = message.encode(values)
        near.send(can.Message(arbitration_id=message.frame_id, data=data, is_extended_id=False, is_fd=fd, bitrate_switch=fd))
        back = far.recv(20.0)
        if back is None:
            sys.exit(f"        {name}: not received within 20 s")
        found = message.decode(back.data)
        print(f"        {name}: {len(back.data)} bytes, {found}")
        if (back.is_fd, back.bitrate_switch, len(back.data)) != (fd, fd, message.length):
            sys.exit(f"        {name}: came back as {back}")
        for key, value in values.items():
            if abs(found[key] - value) > 1e-9:
                sys.exit(f"        {name}: {key} is {found[key]}, sent was {value}")
