#!/bin/sh
# A walk recorded by candump, played back into our end with nobody else at the far one: canplayer with the recorded
# timing, and our own replay as fast as it is consumed. Either way the same is sensed and commanded, bit for bit;
# and so it is with all controllers on one interface.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# What the drives said.
from_drives() {
    brief can_2kmh 2.1
    recorded walk can_2kmh --lockstep --bus can:vcan0-8 || return 1
    awk 'FNR == NR && /^BU_:/ { computer = $2 } FNR == NR && /^BO_ / && $5 != computer { theirs[sprintf("%03X", $2)] = 1 }
         FNR != NR && substr($3, 1, index($3, "#") - 1) in theirs' "$dbc" "$work/walk.log" >"$work/answers.log"
    echo "        $(wc -l <"$work/answers.log") of $(wc -l <"$work/walk.log") frames are the drives'"
    [ -s "$work/answers.log" ]
}

# answered_by NAME COMMAND...: our run without a robot; the command answers it, once it asks.
answered_by() {
    name=$1
    shift
    timeout 240 candump -n 1 vcan8,0A0:7FF >/dev/null &
    waiting=$!
    within 20 listened vcan8 || because "candump did not start" || return 1
    walk "$name" can_2kmh --lockstep --bus can:vcan0-8 --no-robot &
    running=$!
    wait "$waiting" || because "no SYNC on vcan8 within 240 s: $(tail -n 5 "$work/$name/said")" || return 1
    timeout 800 "$@" >"$work/player.said" 2>&1 || because "$1 ended with $?: $(tail -n 5 "$work/player.said")" || return 1
    wait "$running" || because "gangwerk ended with $?: $(tail -n 5 "$work/$name/said")"
}

same() {
    "$python" "$here/same.py" "$work/walk/can_2kmh.mcap" "$work/canplayer/can_2kmh.mcap" "$work/ours/can_2kmh.mcap" \
        "$work/one/can_2kmh.mcap"
}

# All controllers on one interface, and the robot itself at its far end.
one_line() {
    walk one can_2kmh --lockstep --bus can:vcan0 || because "gangwerk ended with $?: $(tail -n 5 "$work/one/said")"
}

dbc="$here/../../config/robots/lola/can/lola.dbc"
step "candump records a walk" from_drives
step "canplayer replays it into the joint loop" answered_by canplayer canplayer -I "$work/answers.log"
step "gangwerk can replay does the same" answered_by ours "$GANGWERK" can replay "$work/walk.log" --as-fast-as-consumed --robot lola
step "all controllers on one interface walk, too" one_line
step "all four logs are the same" same
