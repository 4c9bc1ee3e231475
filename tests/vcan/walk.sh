#!/bin/sh
# Lola walks at 2 km/h over nine lines, in lockstep; candump hears everything, and python-can and cantools find in it what
# our log says. For 4.2 s, or with LONG set for the 20 s of the scene.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

duration=20.0
if [ -z "${LONG:-}" ]; then
    duration=4.2
    brief can_2kmh $duration
fi

walks() {
    recorded walk can_2kmh --lockstep --bus can:vcan0-8 || return 1
    grep -E '^(fell|duration|walking speed)' "$work/walk/said" | sed 's/^/        /'
    grep -qE '^fell +no' "$work/walk/said" || because "fell"
}

every_frame() {
    cycles=$(awk -v duration=$duration 'BEGIN { print int(duration / 0.0035) }')
    awk -v CYCLES="$cycles" -v PREFIX=vcan -f "$here/every_frame.awk" "$dbc" "$work/walk.log"
}

decode() {
    awk -v TICKS="$work/sample.ticks" -f "$here/sample.awk" "$dbc" "$work/walk.log" >"$work/sample.log"
    "$python" "$here/decode.py" "$dbc" "$work/sample.log" "$work/sample.ticks" "$work/walk/can_2kmh.mcap"
}

counted() {
    "$python" "$here/counted.py" "$work/walk/can_2kmh.mcap"
}

dbc="$here/../../config/robots/lola/can/lola.dbc"
step "Lola walks 2 km/h over nine lines" walks
step "the joint loop allocated nothing and lost nothing" counted
step "candump heard each message of the DBC once per cycle, on its line" every_frame
step "cantools decodes to the values of the log" decode
step "the joint loop does it again from the log, byte for byte" replayed "$work/walk/can_2kmh.mcap"
