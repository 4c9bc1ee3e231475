"""Checks a recording of our Sercos III telegrams: tshark's numbers, and the checksums, which tshark does not verify.

Numbers are compared, never tshark's labels: version 4.0 prints some of them inverted (docs/sercos.md).
"""

import struct
import subprocess
import sys
import zlib
from collections import Counter

ADDRESSES = [11, 12, 13, 21, 22, 23, 31, 32, 40]  # crates/sercos/tests/veth/mod.rs
PARAMETERS = {1040, 1002, 1006, 1003, 1009, 1010, 1011, 1012, 1013, 1014, 127, 128} | {
    i << 24 | element << 16 | 1050 for i in (0, 1) for element in (1, 2, 3, 5, 10, 11)
}
MALFORMED = "_ws.malformed"


def frames(path):
    """All frames of a pcap file."""
    data = open(path, "rb").read()
    order = {b"\xd4\xc3\xb2\xa1": "<", b"\x4d\x3c\xb2\xa1": "<", b"\xa1\xb2\xc3\xd4": ">"}[data[:4]]
    at = 24
    while at < len(data):
        length = struct.unpack_from(order + "I", data, at + 8)[0]
        yield data[at + 16 : at + 16 + length]
        at += 16 + length


def tshark(path, fields, only=""):
    """Rows of fields; each field is the list of its values in the frame."""
    command = ["tshark", "-r", path, "-T", "fields", "-E", "aggregator=;"]
    for field in fields:
        command += ["-e", field]
    command += ["-Y", only] if only else []
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [[column.split(";") if column else [] for column in line.split("\t")] for line in done.stdout.splitlines()]


def number(text):
    return {"True": 1, "False": 0}[text] if text in ("True", "False") else int(text, 0)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")
    print(f"ok: {what}")


def main(path):
    all_frames = list(frames(path))
    heads = [f for f in all_frames if f[12:14] == b"\x88\xcd"]
    check(len(all_frames) > 5000 and heads == all_frames, f"{len(heads)} frames, all with EtherType 0x88cd")
    wrong = sum(zlib.crc32(f[:16]) != struct.unpack_from("<I", f, 16)[0] for f in heads)
    check(wrong == 0, "checksums of all heads are zlib's")

    rows = tshark(path, ["siii.mst.phase", "siii.channel", "siii.type", "siii.telno", "siii.mst.crc32", MALFORMED])
    check(len(rows) == len(heads), "tshark sees every frame as Sercos III")
    check(not any(row[5] for row in rows), "tshark finds no malformed frame")
    decoded = [tuple(number(value[0]) for value in row[:4]) for row in rows]
    raw = [(f[15] & 0x8F, f[14] >> 7, f[14] >> 6 & 1, f[14] & 0xF) for f in heads]
    check(decoded == raw, "phase, channel, kind and number of every frame as sent")
    check([number(row[4][0]) for row in rows] == [struct.unpack_from("<I", f, 16)[0] for f in heads], "checksums as sent")

    order = []
    for phase, *_ in decoded:
        if phase < 0x80 and (not order or order[-1] != phase):
            order.append(phase)
    check(order == [0, 1, 2, 3, 4], "phases CP0 to CP4, each once, in this order")
    check({p for p, *_ in decoded if p >= 0x80} == {0x81, 0x82, 0x83, 0x84}, "each switch of the phase is announced")
    early = Counter((kind, telno) for phase, _, kind, telno in decoded if phase in (1, 2))
    check(set(early) == {(0, 0), (0, 1), (1, 0), (1, 1)}, "CP1 and CP2: MDT0, MDT1, AT0 and AT1")

    versions = {tuple(row[0]) for row in tshark(path, ["siii.mdt.version"], "siii.mst.phase==0 && siii.type==0")}
    check({number(v[0]) for v in versions} == {0x200001}, "communication version: two telegrams of each kind, fast switch")

    fields = ["siii.channel", "siii.at.cp0.num_devices", "siii.at.cp0.sercos_address"]
    found = {tuple(number(v) for v in row[0]): (row[1], [number(a) for a in row[2]][: len(ADDRESSES)]) for row in
             tshark(path, fields, "siii.mst.phase==0 && siii.type==1 && siii.at.cp0.num_devices>0")}
    count, addresses = found[(1,)]
    check([number(c) for c in count] == [len(ADDRESSES)], f"CP0: {len(ADDRESSES)} devices")
    check(addresses == ADDRESSES[::-1], "CP0: their addresses, in the order in which S telegrams come to port 1")

    valid = tshark(path, ["siii.at.devstatus.slavevalid"],
                   "siii.mst.phase==2 && siii.type==1 && siii.telno==0 && siii.channel==1")
    wanted = [0] + [1] * len(ADDRESSES) + [0] * (127 - len(ADDRESSES))
    check(len(valid) > 50 and all([number(v) for v in row[0]] == wanted for row in valid),
          "CP2: exactly these devices are valid, at the places 1 to 9, in every returned AT0")

    services = tshark(path, ["siii.mdt.svch.dbe", "siii.idn_code", "siii.mdt.svch.mhs"],
                      "siii.mst.phase==2 && siii.type==0 && siii.telno==0 && siii.channel==0")
    written = {number(v) for row in services for v in row[1]} - {0}
    check(written == PARAMETERS - {128}, f"CP2: the {len(written)} parameters of a start are opened")
    elements = {number(v) for row in services for v in row[0]}
    check(elements == {0, 1, 3, 7}, "CP2: elements 1, 3 and 7 are used, and 0 by those who are not there")
    toggles = [number(row[2][1]) for row in services]
    changes = sum(a != b for a, b in zip(toggles, toggles[1:]))
    # Per parameter: open, attribute, data; lists of lengths are three steps; each command three, and two for its end.
    check(changes >= 3 * len(written), f"CP2: {changes} steps with the first device")

    looped = tshark(path, ["siii.channel"], "siii.mst.phase==4 && siii.type==1")
    back = Counter(number(row[0][0]) for row in looped)
    check(back[0] > back[1] > 1000, "CP4: S telegrams at port 1 while the ring is closed, P telegrams while it is broken")


if __name__ == "__main__":
    main(sys.argv[1])
