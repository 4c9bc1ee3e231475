#!/bin/sh
# Lola walks in MuJoCo, behind the socket of docs/external_plant.md: standing, leaning, 2 km/h (a minute). With --all every
# walk that docs/accuracy.md tells of; with --markdown its table. GANGWERK: the executable, target/release/gangwerk if not given.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
exec "$python" "$here/mujoco/walk.py" "${GANGWERK:-$here/../../target/release/gangwerk}" "$@"
