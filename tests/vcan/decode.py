"""Frames of a recording, read by python-can and decoded by cantools, beside the log of the same run.

usage: decode.py FILE.dbc SAMPLE TICKS LOG.mcap

SAMPLE is a candump log, TICKS says in each line which tick the frame of that line belongs to (sample.awk). A value may
differ from the log's by half a unit of its signal.
"""

import sys
from collections import defaultdict

import can
import cantools
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

dbc, sample, ticks, log = sys.argv[1:]
database = cantools.database.load_file(dbc)
ticks = [int(line) for line in open(ticks)]
wanted = set(ticks)

# Signals of a joint: topic and field of the log.
OF_JOINT = {
    "target": ("joint_targets", "angle"),
    "feed": ("joint_targets", "speed"),
    "angle": ("sensors", "joint_angle"),
    "speed": ("sensors", "joint_speed"),
    "motor": ("sensors", "motor_angle"),
    "mspeed": ("sensors", "motor_speed"),
    "current": ("sensors", "motor_current"),
    "status": ("sensors", "drive_status"),
    "error": ("sensors", "drive_error"),
    "temp": ("sensors", "temperature"),
}
# Neither is in the log.
NOT_LOGGED = {"counter", "mode", "supply", "control"}
AXES = "xyzw"


def records():
    """Joint names, and by topic and tick the decoded record."""
    found, names = defaultdict(dict), None
    with open(log, "rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        decoders = {}
        for schema, channel, message in reader.iter_messages(
            topics=["/gangwerk/sensors", "/gangwerk/joint_targets", "/joint_states"]
        ):
            topic = channel.topic.removeprefix("/gangwerk/")
            if topic == "/joint_states" and names is not None:
                continue
            # Every record begins with its header, tick first; only those in the sample are decoded whole.
            if topic != "/joint_states" and int.from_bytes(message.data[4:12], "little") not in near:
                continue
            if channel.id not in decoders:
                decoders[channel.id] = DecoderFactory().decoder_for(channel.message_encoding, schema)
            record = decoders[channel.id](message.data)
            if topic == "/joint_states":
                names = list(record.name)
            else:
                found[topic][record.header.tick] = record
    return names, found


def logged(signal, names, found, tick):
    """What the log says of this signal at this tick; None if it is not logged."""
    joint, _, quantity = signal.rpartition("_")
    if signal in NOT_LOGGED or quantity in NOT_LOGGED:
        return None
    if joint in names:
        topic, field = OF_JOINT[quantity]
        record = found[topic].get(tick if topic == "joint_targets" else tick + 1)
        return record and float(getattr(record, field)[names.index(joint)])
    record = found["sensors"].get(tick + 1)
    if record is None:
        return None
    side, kind = joint.split("_") if "_" in joint else (joint, "")
    axis = AXES.index(quantity)
    if side in ("right", "left"):
        return float(getattr(record.foot_wrench[side == "left"], kind)[axis])
    field = {"quaternion": "orientation", "rate": "angular_velocity", "accel": "acceleration"}[kind]
    return float(getattr(record.imu, field)[axis])


near = wanted | {tick + 1 for tick in wanted}
names, found = records()
compared, worst, wrong = defaultdict(int), (0.0, ""), []
frames = list(can.LogReader(sample))
if len(frames) != len(ticks):
    sys.exit(f"        {len(frames)} frames in the sample, {len(ticks)} ticks")
for frame, tick in zip(frames, ticks):
    message = database.get_message_by_frame_id(frame.arbitration_id)
    for name, value in message.decode(frame.data, decode_choices=False).items():
        other = logged(name, names, found, tick)
        if other is None:
            continue
        unit = message.get_signal_by_name(name).scale
        off = abs(value - other) / unit
        compared[name.rpartition("_")[2]] += 1
        if off > worst[0]:
            worst = (off, f"{name} of tick {tick}")
        if not off <= 0.5 + 1e-6:
            wrong.append(f"{name} of tick {tick}: {value} on the line, {other} in the log, unit {unit}")
print("        compared:", ", ".join(f"{count} {name}" for name, count in sorted(compared.items())))
print(f"        largest difference {worst[0]:.3f} units, {worst[1]}; {len(wrong)} of {sum(compared.values())} above half a unit")
for line in wrong[:10]:
    print("       ", line)
missing = set(OF_JOINT) - set(compared)
if missing:
    print("        nothing compared of", ", ".join(sorted(missing)))
sys.exit(bool(wrong or missing))
