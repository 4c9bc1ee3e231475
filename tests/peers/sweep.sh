#!/bin/sh
# A sweep on a Dask cluster whose workers are killed, beside the same sweep on one core: the same table, which PyArrow reads.
# KILLS: workers that are killed (default 5), SEED: of the instants. GANGWERK: the executable; default: that of the release build.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
python=$(sh tests/peers/setup.sh)
if [ -z "${GANGWERK:-}" ]; then
    cargo build --quiet --locked --release -p cli >&2
    GANGWERK=$(cd "${CARGO_TARGET_DIR:-target}/release" && pwd)/gangwerk
fi
export GANGWERK
exec "$python" tests/peers/sweep.py "${KILLS:-5}" "${SEED:-20261128}"
