#!/bin/sh
# example.sh NAME: builds an example as the tests do (so nothing is built twice) and prints the file.
set -eu
cd "$(dirname "$0")/../.."
cargo build --quiet --release --workspace --example "$1" >&2
echo "$(cd "${CARGO_TARGET_DIR:-target}" && pwd)/release/examples/$1"
