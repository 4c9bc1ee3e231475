#!/bin/sh
# Times a leg in closed form beside Pinocchio's iterative inverse kinematics in C++, with the errors of the angles beside
# the times. Both optimised for this machine's processor and pinned to one core. Needs g++.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
python=$(sh tests/peers/setup.sh)
prefix=$("$python" -c 'import pinocchio, pathlib; print(pathlib.Path(pinocchio.__file__).parents[4])')
source=tests/peers/pinocchio_bench/legs.cpp
program=tests/peers/.venv/pinocchio_legs
if [ ! -x "$program" ] || [ "$source" -nt "$program" ]; then
    echo "compiling $source (a minute or two)" >&2
    g++ -std=c++17 -O3 -march=native -DNDEBUG -w -DBOOST_MPL_LIMIT_LIST_SIZE=30 -DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS \
        -isystem "$prefix/include" -isystem "$prefix/include/eigen3" "$source" -o "$program"
fi
export RUSTFLAGS="-C target-cpu=native" CARGO_TARGET_DIR=target/native
taskset -c 1 cargo bench --quiet --package multibody --bench legs -- --peer "$PWD/$program"
