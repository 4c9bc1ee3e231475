#!/bin/sh
# Times the dynamics of Lola beside Pinocchio's C++ in the same run, with the differences of the results beside the times.
# Compiles the C++ with optimisation for this machine's processor; the Rust side is a plain release build. Needs g++.
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
exec cargo bench --quiet --package multibody --bench dynamics -- --peer "$PWD/$program" "$@"
