#!/bin/sh
# Faults of real interfaces while Lola walks: a cable pulled and plugged in again, a controller that left the bus.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# told SECONDS PATTERN: waits until the run tells of it.
told() {
    within "$1" grep -qE "$2" "$work/fault/said" || because "nothing like '$2': $(tail -n 5 "$work/fault/said")" || return 1
    grep -E "$2" "$work/fault/said" | sed 's/^/        /'
}

# disturbed PATTERN COMMAND...: walks, does that at cycle 1000, in mid-step, and waits until the run tells of it.
disturbed() {
    pattern=$1
    shift
    brief can_2kmh 4.5
    timeout 800 candump -n 1000 vcan0,080:7FF >/dev/null &
    waiting=$!
    within 20 listened vcan0 || return 1
    walk fault can_2kmh --lockstep --bus can:vcan0-8 &
    running=$!
    wait "$waiting" || because "cycle 1000 was not reached: $(tail -n 5 "$work/fault/said")" || return 1
    "$@" || because "could not: $*"
    told 240 "$pattern"
}

# at_rest STATE: the end of the run, and what the joints did last.
at_rest() {
    wait "$running"
    "$python" "$here/at_rest.py" "$work/fault/can_2kmh.mcap" "$1"
}

pulled() {
    disturbed 'lowlevel: (a local controller is silent for too long: hip_left|nothing comes from the field bus)' ip link set vcan3 down
    code=$?
    ip link set vcan3 up
    return $code
}

# Frames go both ways again and are believed; the stop stays until an operator resets it.
plugged() {
    told 120 'lowlevel: a local controller is heard again: hip_left,' || return 1
    timeout 120 candump -L -n 150 vcan3 >"$work/plugged.log"
    awk 'FNR == NR && /^BO_ / { ours[sprintf("%03X", $2)] = $5 == "PC" }
         FNR != NR { n[ours[substr($3, 1, index($3, "#") - 1)]]++ }
         END { print "        heard on vcan3 after it: " n[1] + 0 " frames of ours, " n[0] + 0 " of the drives"; exit !(n[0] && n[1]) }' \
        "$here/../../config/robots/lola/can/lola.dbc" "$work/plugged.log" || because "not both ends are heard on vcan3" || return 1
    at_rest Stopped
}

bus_off() {
    disturbed 'lowlevel: the controller of a line left the field bus: line 3' "$python" -S -c "$bus_off_frame"
    code=$?
    at_rest Off && return $code
}

# CAN_ERR_FLAG with CAN_ERR_BUSOFF (linux/can/error.h), as a driver reports it.
bus_off_frame='import socket, struct
line = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
line.bind(("vcan3",))
line.send(struct.pack("=IB3x8s", 0x20000040, 8, bytes(8)))'
step "a cable is pulled: the run says which node is silent" pulled
step "it is plugged in again: frames are heard and read again, the robot stays stopped, its joints at rest" plugged
step "the joint loop does that again from the log, byte for byte" replayed "$work/fault/can_2kmh.mcap"
step "a controller leaves the bus: the run says which, and the joints come to rest" bus_off
step "and that" replayed "$work/fault/can_2kmh.mcap"
