#!/bin/sh
# Faults of real interfaces while Lola walks: a cable pulled and plugged in again, a controller that left the bus.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# said PATTERN: whether the run told of it.
said() {
    grep -qE "$1" "$work/fault/said"
}

# disturbed PATTERN COMMAND...: walks, does that at cycle 1200 and waits until the run tells of it; then to the end.
disturbed() {
    pattern=$1
    shift
    brief can_2kmh 5.0
    timeout 390 candump -n 1200 vcan0,080:7FF >/dev/null &
    waiting=$!
    within 20 listened vcan0 || return 1
    walk fault can_2kmh --lockstep --bus can:vcan0-8 &
    running=$!
    wait "$waiting" || because "cycle 1200 was not reached: $(tail -n 5 "$work/fault/said")" || return 1
    "$@" || because "could not: $*"
    within 120 said "$pattern" || because "no event like '$pattern': $(tail -n 5 "$work/fault/said")" || return 1
    grep -E "$pattern" "$work/fault/said" | sed 's/^/        /'
}

# at_rest: the end of the run, and what the joints did last.
at_rest() {
    wait "$running"
    "$python" "$here/at_rest.py" "$work/fault/can_2kmh.mcap"
}

pulled() {
    disturbed 'lowlevel: (NodeSilent|BusSilent)' ip link set vcan3 down
    code=$?
    ip link set vcan3 up
    at_rest && return $code
}

bus_off() {
    disturbed 'lowlevel: BusOff' "$python" -S -c "$bus_off_frame"
    code=$?
    at_rest && return $code
}

# CAN_ERR_FLAG with CAN_ERR_BUSOFF (linux/can/error.h), as a driver reports it.
bus_off_frame='import socket, struct
line = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
line.bind(("vcan3",))
line.send(struct.pack("=IB3x8s", 0x20000040, 8, bytes(8)))'
step "a cable is pulled: the run says which node is silent, and the joints come to rest" pulled
step "a controller leaves the bus: the run says which, and the joints come to rest" bus_off
