"""Tables that drives were told to play, read by python-can and decoded by cantools, beside those of the log.

usage: tables.py FILE.dbc CANDUMP.log LOG.mcap

A drive's points are what its interpreter was last told (QP, from MP[1] to MP[2]) when all were told to begin (BG).
"""

import sys

import can
import cantools
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

dbc, candump, log = sys.argv[1:]
database = cantools.database.load_file(dbc)
# Of each interpreter, by the identifier of its commands: the prefix of its signals.
drives = {
    m.frame_id: m.name.removesuffix("_rpdo2") for m in database.messages if m.name.endswith("_rpdo2")
}
ids = sorted(drives)


def telegram(frame):
    """Letters, index and number of a telegram; None if it asks for something."""
    name = drives[frame.arbitration_id]
    values = database.decode_message(frame.arbitration_id, frame.data, decode_choices=False)
    letters = values[f"{name}_letters"].to_bytes(2, "little").decode()
    return letters, values[f"{name}_index"], values[f"{name}_value"]


memory = {i: {} for i in ids}
begins = {i: [] for i in ids}
telegrams = 0
for frame in can.LogReader(candump):
    if frame.arbitration_id in drives:
        telegrams += 1
        letters, index, value = telegram(frame)
        told = memory[frame.arbitration_id]
        told[letters, index] = value
        if letters == "BG":
            first, last = told["MP", 1], told["MP", 2]
            begins[frame.arbitration_id].append([told["QP", i] for i in range(first, last + 1)])

with open(log, "rb") as stream:
    reader = make_reader(stream, decoder_factories=[DecoderFactory()])
    records = [record for *_, record in reader.iter_decoded_messages(topics=["/gangwerk/joint_tables"])]
wanted = {i: [] for i in ids}
for record in records:
    room = len(record.counts) // len(record.unit)
    for j, i in enumerate(ids):
        wanted[i].append(list(record.counts[j * room : j * room + record.points]))
for n, record in enumerate(records):
    print(f"        plan {record.plan}: {record.points} points, from cycle {record.start_tick}: right ankle {wanted[ids[4]][n][:3]} ...")
same = begins == wanted
print(f"        {telegrams} telegrams, {sum(map(len, begins.values()))} tables in {len(ids)} drives:", "those of the log" if same else "not those of the log")
sys.exit(not same or len(records) < 3)
