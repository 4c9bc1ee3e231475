#!/bin/sh
# `gangwerk can dump --dbc` beside cantools: the same signals with the same values, of our files and of one with everything
# that ours do not have.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
gangwerk=${GANGWERK:-$here/../../target/release/gangwerk}
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
"$python" "$here/dbc.py" "$gangwerk" "$directory" "$here"/../../config/robots/*/can/*.dbc
