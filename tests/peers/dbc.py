"""Random frames decoded by `gangwerk can dump --dbc` and by cantools.

usage: dbc.py GANGWERK DIRECTORY FILE.dbc...

Each file, and one that is written here: both byte orders, 64 bits, floating point, multiplexed signals, identifiers of 29
bits. Ends with status 1 at the first difference.
"""

import random
import subprocess
import sys
from pathlib import Path

import cantools

OTHER = """VERSION ""

NS_ :

BS_:

BU_: A B

BO_ 100 Mixed: 8 A
 SG_ switch M : 7|4@0+ (1,0) [0|15] "" B
 SG_ intel m0 : 8|12@1- (0.5,10) [0|0] "rpm" B
 SG_ motorola m1 : 13|23@0- (0.001,-5) [0|0] "V" B
 SG_ both m2 : 55|16@0+ (3,0) [0|0] "" B
 SG_ always : 47|8@0- (1,0) [0|0] "" B

BO_ 2566844926 Wide: 24 B
 SG_ single : 0|32@1- (2,1) [0|0] "" A
 SG_ double : 71|64@0- (1,0) [0|0] "" A
 SG_ all : 128|64@1- (1,0) [0|0] "" A

VAL_ 100 always 1 "one" -1 "minus one" ;
SIG_VALTYPE_ 2566844926 single : 1;
SIG_VALTYPE_ 2566844926 double : 2;
"""

random.seed(1)
gangwerk, directory, *files = sys.argv[1:]
other = Path(directory) / "other.dbc"
other.write_text(OTHER)


def dumped(dbc, log):
    """By `gangwerk can dump`: of each frame its signals."""
    command = [gangwerk, "can", "dump", log, "--dbc", dbc]
    frames = []
    for line in subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines():
        if line.startswith("("):
            frames.append({})
        else:
            name, value = line.split(" = ")
            number, _, word = value.partition(" (")
            frames[-1][name.strip()] = float(number.split()[0]), word.rstrip(")")
    return frames


def differs(a, b):
    return not (a == b or (a != a and b != b) or abs(a - b) <= 1e-9 * max(abs(a), abs(b)))


for dbc in [other, *files]:
    database = cantools.database.load_file(dbc)
    log, sent = Path(directory) / "frames.log", []
    with open(log, "w") as text:
        for k in range(40 * len(database.messages)):
            message = database.messages[k % len(database.messages)]
            data = random.randbytes(message.length)
            if message.name == "Mixed":
                data = bytes([16 * (k // len(database.messages) % 3)]) + data[1:]
            number = f"{message.frame_id:0{8 if message.is_extended_frame else 3}X}"
            text.write(f"({k:010}.000000) can0 {number}##0{data.hex().upper()}\n")
            sent.append((message, data))
    count = 0
    for (message, data), found in zip(sent, dumped(dbc, log), strict=True):
        values = message.decode(data, decode_choices=False)
        if values.keys() != found.keys():
            sys.exit(f"{dbc}: {message.name}: {sorted(found)}, but cantools has {sorted(values)}")
        for name, value in values.items():
            number, word = found[name]
            choices = message.get_signal_by_name(name).choices or {}
            if differs(number, float(value)) or word != str(choices.get(value, "")):
                sys.exit(f"{dbc}: {message.name}.{name}: {found[name]}, but cantools says {value}")
            count += 1
    print(f"{Path(dbc).name}: {count} signals of {len(sent)} frames as cantools decodes them")
