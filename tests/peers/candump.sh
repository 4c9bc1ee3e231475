#!/bin/sh
# Candump logs of ours in other programs, and theirs in ours: python-can reads and writes them, can-utils' log2asc reads
# them. Every form of frame. Of python-can also ASC and TRC, and a BLF log by the command that our refusal names. can-utils' share is left out, and said so, where it is not installed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=$(sh "$here/setup.sh")
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
example=$(sh "$here/example.sh" peers_candump)
"$example" "$directory"
"$python" "$here/candump.py" "$directory"
"$example" "$directory" "$directory/theirs.log" >"$directory/theirs_by_us.txt"
cmp "$directory/ours.txt" "$directory/theirs_by_us.txt"
echo "python-can's log: read here the same"
for form in asc trc; do
    "$example" "$directory" "$directory/python.$form" >"$directory/$form.txt"
    cmp "$directory/python.$form.txt" "$directory/$form.txt"
    echo "python-can's $form: $(wc -l <"$directory/$form.txt") frames, read here the same"
done
"$python" -m can.logconvert "$directory/python.blf" "$directory/blf.log"
"$example" "$directory" "$directory/blf.log" >"$directory/blf.txt"
test "$(wc -l <"$directory/blf.txt")" -eq "$(wc -l <"$directory/ours.txt")"
echo "python-can's blf: converted, and read here"
if command -v log2asc >/dev/null; then
    # The list of interfaces numbers them from 1: both must have all their frames.
    log2asc -I "$directory/ours.log" -O "$directory/ours.asc" vcan0 vcan1
    "$python" "$here/candump.py" "$directory" "$directory/ours.asc"
elif [ "${CI:-}" = true ]; then
    echo "log2asc of can-utils is not installed" >&2
    exit 1
else
    echo "log2asc of can-utils is not installed: left out"
fi
