#!/bin/sh
# What scipy's LSODA needs for dry friction and for touchdown, against exact solutions; fails if a prediction is missed.
# With --all also tolerances that take minutes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
exec "$python" "$here/lsoda.py" "$@"
