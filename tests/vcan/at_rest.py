"""Whether a robot was stopped at the end of a run: its joints at rest that had moved before. usage: at_rest.py LOG STATE

A broken line does not say how its joints move, so that is taken from the simulation. STATE is lowlevel's, as in
crates/messages/src/start_up.rs. Where a joint is, lowlevel must know at the end: every line is read.
"""

import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

LAST = 20  # cycles
REST = 1e-3  # rad/s
UNIT = 1e-3  # rad, more than the resolution of a frame
STATES = ["Off", "NotHomed", "Homing", "Enabling", "Hanging", "Zeroed", "Standing", "Stopped"]


def decoder(record):
    return DecoderFactory().decoder_for(record[1].message_encoding, record[0])


with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream)
    records = list(reader.iter_messages(topics=["/gangwerk/sim_state"]))
    read = list(reader.iter_messages(topics=["/gangwerk/sensors"]))[-1]
    sensors = decoder(read)(read[2].data)
    decode = decoder(records[0])
    states = [decode(message.data) for _, _, message in records[::10] + records[-LAST:]]


def speed(a, b):
    """Of the fastest joint between two states."""
    return max(abs(x - y) for x, y in zip(a.joint_angle, b.joint_angle)) / max(b.time - a.time, 1e-9)


way, end = states[:-LAST], states[-LAST:]
moved = max(speed(a, b) for a, b in zip(way, way[1:]))
last = max(speed(a, b) for a, b in zip(end, end[1:]))
print(f"        fastest joint: {moved:.3f} rad/s on the way, {last:.2e} rad/s in the last {LAST} of {len(records)} cycles")
off = max(abs(x - y) for x, y in zip(sensors.joint_angle, end[-1].joint_angle))
print(f"        at the end: {STATES[sensors.start_up]}, no joint read more than {off:.1e} rad from where it is")
sys.exit(moved < 0.5 or last > REST or STATES[sensors.start_up] != sys.argv[2] or off > UNIT)
