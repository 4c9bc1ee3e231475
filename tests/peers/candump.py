"""Reads a candump log of ours with python-can and writes it again with python-can; or holds what can-utils' log2asc made
of it against what was written.

usage: candump.py DIRECTORY [ASC]

DIRECTORY holds ours.log and ours.txt: microseconds, interface, identifier, extended, remote, error, FD, bit rate switch,
error state, length, data of every frame. Ends with status 1 at the first difference.
"""

import sys
from pathlib import Path

import can


def listed(message):
    """A message of python-can as a row of ours.txt."""
    data = "" if message.is_remote_frame else bytes(message.data).hex()
    flags = [message.is_extended_id and not message.is_error_frame, message.is_remote_frame]
    flags += [message.is_error_frame, message.is_fd, message.bitrate_switch, message.error_state_indicator]
    # python-can keeps no class of an error frame.
    number = 0 if message.is_error_frame else message.arbitration_id
    row = [round(message.timestamp * 1e6), message.channel, f"{number:x}", *map(int, flags)]
    return [str(word) for word in [*row, message.dlc, data]]


def written(directory):
    """Rows of ours.txt."""
    return [line.split(" ") for line in (directory / "ours.txt").read_text().splitlines()]


def by_python_can(directory):
    rows = written(directory)
    messages = list(can.CanutilsLogReader(directory / "ours.log"))
    if len(messages) != len(rows):
        sys.exit(f"python-can reads {len(messages)} frames, written were {len(rows)}")
    for message, row in zip(messages, rows):
        found = listed(message)
        if row[5] == "1":  # python-can knows error frames of the class "bus error" only: when and where
            row, found = row[:2], found[:2]
        if found != row:
            sys.exit(f"python-can reads {found}, written was {row}")
    print(f"python-can: {len(messages)} frames as written")
    other_forms(directory, messages)
    # Once more by their writer; it writes no class of error frames and no length of remote ones, so these stay ours.
    ours = (directory / "ours.log").read_text().splitlines(keepends=True)
    with can.CanutilsLogWriter(directory / "python.log") as writer:
        for message in messages:
            writer.on_message_received(message)
    theirs = (directory / "python.log").read_text().splitlines(keepends=True)
    merged = [o if "1" in row[4:6] else t for row, o, t in zip(rows, ours, theirs)]
    (directory / "theirs.log").write_text("".join(merged))


def other_forms(directory, messages):
    """The same frames as python-can's ASC, TRC and BLF logs, and the rows that are in them: times from 0, channels by
    number. Its TRC holds classic frames with data only; of error frames it keeps when and where."""
    with can.BLFWriter(directory / "python.blf") as blf:
        for message in messages:
            message.channel = int(message.channel.removeprefix("vcan"))
            blf.on_message_received(message)
    plain = [m for m in messages if not (m.is_fd or m.is_remote_frame or m.is_error_frame)]
    for form, writer, kept in [("asc", can.ASCWriter, messages), ("trc", can.TRCWriter, plain)]:
        rows = []
        with writer(directory / f"python.{form}") as log:
            for message in kept:
                log.on_message_received(message)
                row = listed(message)
                row[:2] = [str(round((message.timestamp - kept[0].timestamp) * 1e6)), f"can{message.channel}"]
                if message.is_error_frame:
                    row[-2:] = ["8", "0" * 16]
                rows.append(" ".join(row) + "\n")
        (directory / f"python.{form}.txt").write_text("".join(rows))
    for message in messages:
        message.channel = f"vcan{message.channel}"


def by_log2asc(directory, asc):
    """Lines of frames as log2asc writes them: time channel id Rx d length data, or CANFD channel dir id ..."""
    rows = written(directory)
    lines = [line.split() for line in asc.read_text().splitlines()]
    lines = [w for w in lines if len(w) > 2 and w[0].replace(".", "").isdigit()]
    if len(lines) != len(rows):
        sys.exit(f"log2asc reads {len(lines)} frames, written were {len(rows)}")
    for words, row in zip(lines, rows):
        check_asc(words, row)
    print(f"log2asc: {len(lines)} frames as written")


def check_asc(words, row):
    _, name, number, extended, remote, error, fd, brs, esi, length, data = row
    channel = str(1 + int(name[-1]))
    shown = number.upper() + ("x" if extended == "1" else "")
    wanted = [f"{data[i:i+2]}".upper() for i in range(0, len(data), 2)]
    if error == "1":
        good = words[1] == channel and words[2] == "ErrorFrame"
    elif fd == "1":
        code = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64].index(int(length))
        # CANFD channel direction id brs esi code length data ...
        good = words[1:3] == ["CANFD", channel] and words[4].upper() == shown.upper()
        good &= words[5:9] == [brs, esi, f"{code:x}", length]
        good &= [w.upper() for w in words[9 : 9 + len(wanted)]] == wanted
    elif remote == "1":
        good = words[1] == channel and words[2].upper() == shown.upper() and words[4] == "r"
    else:
        good = words[1] == channel and words[2].upper() == shown.upper() and words[4:6] == ["d", length]
        good &= [w.upper() for w in words[6:]] == wanted
    if not good:
        sys.exit(f"log2asc writes {words}, written was {row}")


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if len(sys.argv) > 2:
        by_log2asc(place, Path(sys.argv[2]))
    else:
        by_python_can(place)
