#!/bin/sh
# Our free flight ends where MuJoCo's does, to the accuracy of the integrator.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
made=$(sh "$here/mujoco/build.sh")
cd "$here/../.."
cargo build --quiet --package multibody --example flight
exec "$python" "$here/mujoco/flight.py" "${CARGO_TARGET_DIR:-target}/debug/examples/flight" "$made"
