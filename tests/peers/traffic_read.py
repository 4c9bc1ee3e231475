"""Reads a log of CAN frames with two independent readers of ROS 2 logs and compares every message with what was written.

usage: traffic_read.py LOG EXPECTED

EXPECTED holds per line a channel and all scalars of one message. Ends with status 1 at the first difference.
"""

import sys
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore


def row(channel, m):
    """A message as a line of EXPECTED."""
    nanoseconds = getattr(m.stamp, "nanosec", None)
    head = [channel, m.stamp.sec, nanoseconds, m.line, m.id, m.form, m.flags, m.way, m.len]
    return " ".join(str(word) for word in [*head, *map(int, m.data)])


def with_mcap(path):
    with open(path, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        if reader.get_header().profile != "ros2":
            sys.exit(f"profile is {reader.get_header().profile!r}, not 'ros2'")
        return [row(channel.topic, m) for _, channel, _, m in reader.iter_decoded_messages()]


def with_rosbags(path):
    with AnyReader([path], default_typestore=get_typestore(Stores.LATEST)) as reader:
        rows = []
        for connection, _, raw in reader.messages():
            rows.append(row(connection.topic, reader.deserialize(raw, connection.msgtype)))
        return rows


if __name__ == "__main__":
    log, expected = Path(sys.argv[1]), Path(sys.argv[2]).read_text().splitlines()
    for name, read in (("mcap_ros2", with_mcap), ("rosbags", with_rosbags)):
        found = read(log)
        for a, b in zip(found, expected):
            if a != b:
                sys.exit(f"{name} reads\n{a}\nwritten was\n{b}")
        if len(found) != len(expected):
            sys.exit(f"{name} reads {len(found)} messages, written were {len(expected)}")
        print(f"{name}: {len(found)} CAN frames as written")
