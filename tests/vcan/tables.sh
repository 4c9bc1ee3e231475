#!/bin/sh
# Archie walks a stride that his drives play from tables; candump hears the upload, and a line that is pulled in mid-stride
# stops it. LONG=1: a replay of the drives' answers is the same walk, bit for bit.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# The walk of thesis 6.2, four times as fast, on type 1: there are 1500 cycles in it.
scene="$work/config/scenes/archie_tables.toml"
sed -i -e 's/^T_c = .*/T_c = 3.0/' -e 's/^T_d = .*/T_d = 1.2/' -e 's/^T_o = .*/T_o = 2.1/' -e 's/^T_min = .*/T_min = 0.24/' \
    -e 's/^T_max = .*/T_max = 2.1/' -e 's/^N = .*/N = 150/' "$work/config/gaits/archie_static.toml"
sed -i -e 's/^depth = .*/depth = 1/' -e 's/^duration = .*/duration = 12.0/' -e 's/^time = 4.0/time = 2.5/' \
    -e 's/^time = 20.0/time = 7.0/' -e 's/^forward = .*/forward = 0.0833/' "$scene"
dbc="$here/../../config/robots/archie/can/archie_tables.dbc"

uploaded() {
    "$python" "$here/tables.py" "$dbc" "$work/first.log" "$work/first/archie_tables.mcap"
}

# Whoever asks first starts the drives of its line, and they say in their heartbeats that they are operational.
started() {
    awk '$3 == "000#0100" { start[$2] = 1 }
         $3 ~ /^7..#/ { if (!start[$2] || $3 !~ /#05$/) { print "        " $0 " before a start, or not operational"; wrong = 1 }
                        beats[$3]++; n++ }
         END { for (id in beats) drives++
               print "        " drives + 0 " drives, " n + 0 " heartbeats"; exit wrong || drives != 12 }' "$work/first.log"
}

# What the drives answered: without counters in their frames, what they said before the first SYNC would count as answers too.
from_drives() {
    awk 'FNR == NR && /^BU_:/ { computer = $2 } FNR == NR && /^BO_ / && $5 != computer { theirs[sprintf("%03X", $2)] = 1 }
         FNR != NR && $3 == "080#00" { asked = 1 }
         FNR != NR && asked && substr($3, 1, index($3, "#") - 1) in theirs' "$dbc" "$work/first.log" >"$work/answers.log"
}

counted() {
    "$python" "$here/counted.py" "$work/first/archie_tables.mcap"
}

# answered_by NAME COMMAND...: our run without a robot; the command answers it, once it asks.
answered_by() {
    name=$1
    shift
    timeout 240 candump -n 1 vcan1,080:7FF >/dev/null &
    waiting=$!
    within 20 listened vcan1 || because "candump did not start" || return 1
    walk "$name" archie_tables --lockstep --bus can:vcan0-1 --no-robot &
    running=$!
    wait "$waiting" || because "no SYNC on vcan1: $(tail -n 5 "$work/$name/said")" || return 1
    if ! timeout 400 "$@" >"$work/player.said" 2>&1; then
        kill "$running"
        because "$1 failed: $(tail -n 5 "$work/player.said")"
        return 1
    fi
    wait "$running" || because "gangwerk ended with $?: $(tail -n 5 "$work/$name/said")" || return 1
    "$python" "$here/same.py" "$work/first/archie_tables.mcap" "$work/$name/archie_tables.mcap"
}

# disturbed NAME PATTERN COMMAND...: that is done in cycle 900, at the begin of the second step; the run tells of it, and the joints
# come to rest.
disturbed() {
    name=$1
    pattern=$2
    shift 2
    timeout 800 candump -n 900 vcan1,080:7FF >/dev/null &
    waiting=$!
    within 20 listened vcan1 || return 1
    walk "$name" archie_tables --lockstep --bus can:vcan0-1 &
    running=$!
    wait "$waiting" || because "cycle 900 was not reached: $(tail -n 5 "$work/$name/said")" || return 1
    "$@" || because "could not: $*"
    within 240 grep -E "$pattern" "$work/$name/said"
    code=$?
    ip link set vcan1 up
    wait "$running"
    [ "$code" -eq 0 ] || because "nothing like '$pattern': $(tail -n 5 "$work/$name/said")" || return 1
    "$python" "$here/at_rest.py" "$work/$name/archie_tables.mcap" Stopped
}

step "Archie walks a stride from tables over two lines" recorded first archie_tables --lockstep --bus can:vcan0-1
step "the joint loop allocated nothing and lost nothing" counted
step "the drives were started, and say that they are operational" started
step "candump heard the upload, and cantools decodes it to the counts of the log" uploaded
step "the joint loop does it again from the log, byte for byte" replayed "$work/first/archie_tables.mcap"
if [ -n "${LONG:-}" ]; then
    from_drives
    step "the drives' answers, repeated by canplayer, are the same walk, bit for bit" answered_by canplayer canplayer -I "$work/answers.log"
fi
step "a line is pulled in mid-stride: the run says which, and the joints come to rest" disturbed line \
    'lowlevel: a local controller is silent for too long: leg_left' ip link set vcan1 down
step "somebody resets a drive in mid-stride: it is named, and the joints come to rest" disturbed reset \
    'right_knee_flexion: the drive has started anew' cansend vcan0 '000#8104'
