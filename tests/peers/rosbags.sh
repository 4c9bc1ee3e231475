#!/bin/sh
# Reads a log with the PyPI packages rosbags, mcap and mcap-ros2-support; fails if they do not find in it what was
# written. With an argument reads that log instead, without known values.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
if [ $# -gt 0 ]; then
    exec "$python" "$here/rosbags_read.py" "$1"
fi
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
"$(sh "$here/example.sh" peers_log)" "$directory"
"$python" "$here/rosbags_read.py" "$directory/peers.mcap" "$directory/peers.txt"
"$python" "$here/traffic_read.py" "$directory/traffic.mcap" "$directory/traffic.txt"
