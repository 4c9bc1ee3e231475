#!/bin/sh
# Builds the wheel of the Python package, installs it with pip into an empty venv, runs its tests there and, beside Pinocchio,
# in the venv of the peers; with LONG=1 its notebooks, too. GANGWERK: the executable it is compared with; default: that of the release build.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
python=$(sh tests/peers/setup.sh)
release="${CARGO_TARGET_DIR:-target}/release"
if [ -z "${GANGWERK:-}" ]; then
    # Together, so that both are made of the same libraries.
    cargo build --quiet --locked --release -p cli -p python >&2
    GANGWERK=$(cd "$release" && pwd)/gangwerk
fi
export GANGWERK
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT

"$python" -m maturin build --quiet --release --locked -m python/Cargo.toml --out "$directory" >&2
wheel=$(ls "$directory"/gangwerk-*.whl)
echo "$(basename "$wheel"): $(du -k "$wheel" | cut -f 1) kB"
python3 -m venv "$directory/empty"
"$directory/empty/bin/pip" install --quiet --disable-pip-version-check "$wheel"
# From elsewhere: the package brings its scenes.
(cd "$directory" && "$directory/empty/bin/python" -c 'import gangwerk
chain = gangwerk.Chain("walk_1kmh")
print(chain.run()["mean_speed_m_s"], "m/s")')
"$directory/empty/bin/python" -m unittest discover -s python/tests
"$directory/empty/bin/python" python/tests/speed.py

"$python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall "$wheel"
"$python" -m unittest discover -s python/tests -p test_model.py
[ -z "${LONG:-}" ] || "$python" tests/peers/python_notebooks.py python/notebooks/*.ipynb
