#!/bin/sh
# Our free flight ends where MuJoCo's does, to the accuracy of the integrator.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
made=$(sh "$here/mujoco/build.sh")
exec "$python" "$here/mujoco/flight.py" "$(sh "$here/example.sh" flight)" "$made"
