#!/bin/sh
# Times plans beside placo's walk pattern generator in the same run, on a comparable walk, and says how the problems differ.
# Needs python3 and PyPI; says so and ends without an error if placo cannot be installed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
venv="$here/.placo" # its own: it needs another Pinocchio than the other peers
cd "$here/../.."
if ! "$venv/bin/python" -c 'import placo' 2> /dev/null; then
    { [ -x "$venv/bin/python" ] || python3 -m venv "$venv"; } &&
        "$venv/bin/pip" install --quiet --disable-pip-version-check placo==0.10.2 >&2 || {
        echo "left out: placo cannot be installed here"
        [ "${CI:-}" != true ] || exit 1
        exit 0
    }
fi
"$(sh "$here/example.sh" plan_time)"
echo
exec "$venv/bin/python" "$here/placo_walk.py"
