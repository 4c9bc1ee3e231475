#!/bin/sh
# Simulates our robot and scenes in MuJoCo; fails if it is not the same robot, or does not move as predicted.
# With --points FILE.json instead runs integrators and steps on every scene (two minutes) and writes what each cost and
# where it ended, for `gangwerk study accuracy --peers FILE.json`.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
made=$(sh "$here/mujoco/build.sh")
if [ "${1:-}" = --points ]; then
    exec "$python" "$here/mujoco/sweep.py" "$made" "${2:?FILE.json}"
fi
exec "$python" "$here/mujoco/check.py" "$(sh "$here/example.sh" peer)" "$made"
