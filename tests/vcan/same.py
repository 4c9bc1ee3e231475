"""Whether two logs hold the same records, byte by byte, on the topics that the frames of a bus decide.

usage: same.py LOG LOG...    (the first one is what the others are held against)
"""

import hashlib
import sys

from mcap.reader import make_reader

TOPICS = ["/gangwerk/" + name for name in ("sensors", "joint_targets", "controller_state", "plan")]


def hashes(path):
    """By topic: number of records and hash of all of them."""
    found = {topic: [0, hashlib.sha256()] for topic in TOPICS}
    with open(path, "rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages(topics=TOPICS, log_time_order=False):
            found[channel.topic][0] += 1
            found[channel.topic][1].update(message.data)
    return {topic: (count, digest.hexdigest()) for topic, (count, digest) in found.items()}


first, *others = sys.argv[1:]
wanted, bad = hashes(first), False
for topic, (count, digest) in wanted.items():
    print(f"        {topic}: {count} records, {digest[:16]}")
    if count < (1 if topic.endswith("plan") else 100):
        print(f"        {topic}: nothing to compare")
        bad = True
for path in others:
    for topic, found in hashes(path).items():
        if found != wanted[topic]:
            print(f"        {path}: {topic}: {found[0]} records, {found[1][:16]}")
            bad = True
sys.exit(bad)
