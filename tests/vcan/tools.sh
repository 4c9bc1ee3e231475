#!/bin/sh
# What the other checks stand on, without a line of ours: nine lines that carry frames between can-utils and python-can.
. "$(dirname "$0")/step.sh"

# A frame sent on each line is seen on that line and on no other.
every_line() {
    listen "$work/lines.log" 60 || return 1
    for line in $lines; do
        cansend "$line" "10${line#vcan}#0${line#vcan}" || because "cansend on $line" || return 1
    done
    within 20 whole "$work/lines.log" 9
    listened_out
    for line in $lines; do
        echo "$line 10${line#vcan}#0${line#vcan}"
    done >"$work/lines.wanted"
    cut -d ' ' -f 2,3 "$work/lines.log" | diff "$work/lines.wanted" - || because "not what was sent"
}

# whole FILE COUNT: whether it has that many lines.
whole() {
    [ "$(wc -l <"$1")" -ge "$2" ]
}

step "cansend on nine lines, seen by candump" every_line
step "python-can and cantools: classic frames and CAN FD there and back" "$python" "$here/tools.py"
