"""Whether the joints of the simulated robot were at rest at the end of a run, and had moved before. usage: at_rest.py LOG

A broken line does not say how its joints move, so that is taken from the simulation.
"""

import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

LAST = 20  # cycles
REST = 1e-3  # rad/s

with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, decoder_factories=[DecoderFactory()])
    records = list(reader.iter_messages(topics=["/gangwerk/sim_state"]))
    decode = DecoderFactory().decoder_for(records[0][1].message_encoding, records[0][0])
    states = [decode(message.data) for _, _, message in records[::10] + records[-LAST:]]


def speed(a, b):
    """Of the fastest joint between two states."""
    return max(abs(x - y) for x, y in zip(a.joint_angle, b.joint_angle)) / max(b.time - a.time, 1e-9)


way, end = states[:-LAST], states[-LAST:]
moved = max(speed(a, b) for a, b in zip(way, way[1:]))
last = max(speed(a, b) for a, b in zip(end, end[1:]))
print(f"        fastest joint: {moved:.3f} rad/s on the way, {last:.2e} rad/s in the last {LAST} of {len(records)} cycles")
sys.exit(moved < 0.5 or last > REST)
