#!/bin/sh
# Lola walks at 2 km/h for 20 s over nine lines, in lockstep, and candump hears everything.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

walks() {
    recorded_walk || return 1
    grep -E 'steps|speed|fell' "$work/walk/said"
}

# The log of the run says how many cycles there were.
every_frame() {
    awk -f "$here/every_frame.awk" "$here/../../config/robots/lola/can/lola.dbc" CYCLES=$((20000 * 2 / 7)) "$work/walk.log"
}

step "Lola walks 2 km/h over nine lines" walks
step "candump heard each message of the DBC once per cycle, on its line" every_frame
