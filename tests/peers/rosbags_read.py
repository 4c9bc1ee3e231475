"""Reads a log as other people's tools do and compares what they find with what was written.

usage: rosbags_read.py LOG [EXPECTED]

EXPECTED holds per line a channel and all scalars of one message. Checks that every channel decodes with two
independent readers, that both find the same numbers, that standard messages are those of a ROS 2 distribution, and
that the frames of /tf and /tf_static are one tree. Ends with status 1 at the first difference.
"""

import sys
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

STANDARD = {
    "/joint_states": "sensor_msgs/msg/JointState",
    "/imu/data": "sensor_msgs/msg/Imu",
    "/foot/right/wrench": "geometry_msgs/msg/WrenchStamped",
    "/foot/left/wrench": "geometry_msgs/msg/WrenchStamped",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/truth/tf": "tf2_msgs/msg/TFMessage",
    "/truth/markers": "visualization_msgs/msg/MarkerArray",
    "/rosout": "rcl_interfaces/msg/Log",
    "/markers": "visualization_msgs/msg/MarkerArray",
    "/robot_description": "std_msgs/msg/String",
}


def scalars(value, out):
    """All scalars of a message in the order of its fields, whichever library made it."""
    if isinstance(value, (int, float, str, bool, np.generic)):
        out.append(value.item() if isinstance(value, np.generic) else value)
    elif isinstance(value, (bytes, bytearray)):
        out.extend(value)
    elif isinstance(value, (list, tuple, np.ndarray)):
        for item in value:
            scalars(item, out)
    else:
        for name in getattr(value, "__dataclass_fields__", None) or value.__slots__:
            # Constants of a definition, in capitals, are no part of a message.
            if name != "__msgtype__" and not name.isupper():
                scalars(getattr(value, name), out)
    return out


def same(a, b):
    return len(a) == len(b) and all(x == y or (x != x and y != y) for x, y in zip(a, b))


def with_mcap(path):
    """Every message by the reader of the format's authors: (channel, time, scalars)."""
    with open(path, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        if reader.get_header().profile != "ros2":
            sys.exit(f"profile is {reader.get_header().profile!r}, not 'ros2'")
        metadata = {m.name for m in reader.iter_metadata()}
        if "gangwerk" not in metadata:
            sys.exit(f"no metadata record 'gangwerk', only {metadata}")
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            if (schema.encoding, channel.message_encoding) != ("ros2msg", "cdr"):
                sys.exit(f"{channel.topic}: {schema.encoding}, {channel.message_encoding}")
            yield channel.topic, message.log_time, scalars(decoded, [])


def with_rosbags(path):
    """Every message by rosbags, which knows ROS 2 bags: (channel, time, scalars), and the frames of /tf."""
    frames = defaultdict(set)
    with AnyReader([Path(path)]) as reader:
        check_types(reader)
        for connection, time, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic in ("/tf", "/tf_static", "/truth/tf"):
                for t in message.transforms:
                    frames[t.child_frame_id].add(t.header.frame_id)
            yield connection.topic, time, scalars(message, [])
    check_tree(frames)


def check_types(reader):
    """Our copies of the standard definitions hash like those of the distribution."""
    humble = get_typestore(Stores.ROS2_HUMBLE)
    for connection in reader.connections:
        wanted = STANDARD.get(connection.topic)
        if wanted is None:
            if not connection.topic.startswith("/gangwerk/"):
                sys.exit(f"{connection.topic}: unknown channel")
            continue
        if connection.msgtype != wanted:
            sys.exit(f"{connection.topic}: {connection.msgtype}, not {wanted}")
        ours = get_typestore(Stores.EMPTY)
        ours.register(get_types_from_msg(connection.msgdef.data, wanted))
        if ours.hash_rihs01(wanted) != humble.hash_rihs01(wanted):
            sys.exit(f"{wanted}: definition differs from the distribution's")


def check_tree(frames):
    for child, parents in frames.items():
        if len(parents) != 1:
            sys.exit(f"/tf: {child} has parents {sorted(parents)}")
    for child in frames:
        seen = []
        while child != "world":
            if child in seen or child not in frames:
                sys.exit(f"/tf: {child} does not lead to world, after {seen}")
            seen.append(child)
            (child,) = frames[child]
    print(f"/tf: {len(frames)} frames, one tree")


def by_channel(messages):
    found = defaultdict(list)
    for channel, time, values in messages:
        found[channel].append((time, values))
    return found


def main():
    log = sys.argv[1]
    first, second = by_channel(with_mcap(log)), by_channel(with_rosbags(log))
    if set(first) != set(second):
        sys.exit(f"channels differ: {sorted(set(first) ^ set(second))}")
    for channel, messages in first.items():
        if len(messages) != len(second[channel]):
            sys.exit(f"{channel}: {len(messages)} messages, rosbags finds {len(second[channel])}")
        for (time, values), (other_time, others) in zip(messages, second[channel]):
            if time != other_time or not same(values, others):
                sys.exit(f"{channel} at {time}: readers differ")
    if len(sys.argv) > 2:
        compare(first, Path(sys.argv[2]).read_text().splitlines())
    total = sum(map(len, first.values()))
    print(f"{total} messages in {len(first)} channels: both readers agree")


def compare(found, lines):
    """Every message of ours, value by value."""
    position, numbers = Counter(), 0
    for line in lines:
        channel, *texts = line.split()
        _, values = found[channel][position[channel]]
        position[channel] += 1
        wanted = [float(text) if "." in text or "e" in text else int(text) for text in texts]
        if not same(values, wanted):
            sys.exit(f"{channel}, message {position[channel]}: not the values that were written")
        numbers += len(wanted)
    for channel in (c for c in found if c.startswith("/gangwerk/")):
        if position[channel] != len(found[channel]):
            sys.exit(f"{channel}: {len(found[channel])} messages found, {position[channel]} written")
    for channel in STANDARD:
        if not found[channel]:
            sys.exit(f"{channel}: empty")
    print(f"{numbers} numbers in {len(lines)} messages are those that were written")


main()
