#!/bin/sh
# Frames of a simulated walk with motors against Pinocchio, or with an argument those of that log.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
if [ $# -gt 0 ]; then
    exec "$python" "$here/frames.py" "$1"
fi
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
"${GANGWERK:-$here/../../target/release/gangwerk}" sim walk_type3 --json --log "$directory/walk.mcap" >"$directory/figures.json"
exec "$python" "$here/frames.py" "$directory/walk.mcap"
