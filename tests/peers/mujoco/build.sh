#!/bin/sh
# Makes in tests/peers/.venv/mujoco what the comparison with MuJoCo runs: models and the program `peer`, compiled against
# the headers and the library of the wheel. Prints that folder. Needs a C compiler.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/../setup.sh")
made="$here/../.venv/mujoco"
wheel=$("$python" -c 'import mujoco, pathlib; print(pathlib.Path(mujoco.__file__).parent)')
library=$(ls "$wheel"/libmujoco.so.*)
mkdir -p "$made"
if [ ! -x "$made/peer" ] || [ "$here/peer.c" -nt "$made/peer" ] || [ "$library" -nt "$made/peer" ]; then
    cc -std=c11 -D_GNU_SOURCE -O2 -Wall -Wextra -isystem "$wheel/include" "$here/peer.c" -o "$made/peer" "$library" \
        -Wl,-rpath,"$wheel" -lm
fi
"$python" "$here/model.py" "$here/../../../config/robots/lola" "$here/chain.urdf" "$made"
echo "$made"
