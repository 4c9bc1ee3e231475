"""What the joint loop counted in a run: nothing allocated, nothing lost on the bus. usage: counted.py LOG

Allocations are counted from cycle 100 on, frames from the first one.
"""

import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

with open(sys.argv[1], "rb") as stream:
    records = list(make_reader(stream).iter_messages(topics=["/gangwerk/cycle_stats/lowlevel"]))
schema, channel, message = records[-1]
stats = DecoderFactory().decoder_for(channel.message_encoding, schema)(message.data)
bus = {name: getattr(stats.bus, name) for name in ("lost", "late", "duplicated", "refused", "error_frames", "bus_off")}
allocations = list(stats.allocations)
print(f"        {stats.cycles} cycles: {allocations[0]} allocations, {allocations[1]} frees;", bus)
sys.exit(stats.cycles == 0 or allocations != [0, 0] or any(bus.values()))
