#!/bin/sh
# Compares crates/multibody with Pinocchio on random states of Lola and Talos; fails on any difference above 1e-10.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
python=$(sh tests/peers/setup.sh)
exec "$python" tests/peers/with_pinocchio.py "$(sh tests/peers/example.sh peer)" "$@"
