#!/bin/sh
# Loads every robot's URDF in Pinocchio and in MuJoCo; fails if the two do not understand the same robot.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
exec "$python" "$here/urdf.py" "$here"/../../config/robots/*/
