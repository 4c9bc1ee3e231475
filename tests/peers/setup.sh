#!/bin/sh
# Makes tests/peers/.venv with the programs that results are compared with. Safe to run again; needs python3 and PyPI.
# Prints the path of its Python.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
venv="$here/.venv"
wanted="pin==4.1.0 cmeel-eigen==3.4.1 example-robot-data==6.0.0 mujoco==4.0.0 scipy==1.17.1 rosbags mcap mcap-ros2-support numpy python-can==4.6.1 cantools==45.1 matplotlib maturin dask[distributed]==2026.8.0 pyarrow==26.0.1"

[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
stamp="$venv/installed"
if [ ! -f "$stamp" ] || [ "$(cat "$stamp")" != "$wanted" ]; then
    # shellcheck disable=SC2086
    "$venv/bin/pip" install --quiet --disable-pip-version-check $wanted >&2
    printf '%s' "$wanted" > "$stamp"
fi
echo "$venv/bin/python"
