#!/bin/sh
# Times the dynamics of Lola beside Pinocchio's C++ in the same run, with the differences of the results beside the times.
# First our plain release build, then ours optimised for this machine's processor, as the C++ always is: only the second
# compares like with like. Both are pinned to one core. Needs g++.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
python=$(sh tests/peers/setup.sh)
prefix=$("$python" -c 'import pinocchio, pathlib; print(pathlib.Path(pinocchio.__file__).parents[4])')
source=tests/peers/pinocchio_bench/main.cpp
program=tests/peers/.venv/pinocchio_bench
if [ ! -x "$program" ] || [ "$source" -nt "$program" ]; then
    echo "compiling $source (a minute or two)" >&2
    g++ -std=c++17 -O3 -march=native -DNDEBUG -w -DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS \
        -isystem "$prefix/include" -isystem "$prefix/include/eigen3" "$source" -o "$program"
fi
run() {
    echo "$1"
    taskset -c 1 cargo bench --quiet --package multibody --bench dynamics -- --peer "$PWD/$program"
}
run "plain release build"
export RUSTFLAGS="-C target-cpu=native" CARGO_TARGET_DIR=target/native
run "the same flags as the peer: optimised for this processor"
