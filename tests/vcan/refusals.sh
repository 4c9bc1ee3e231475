#!/bin/sh
# Buses that cannot be used: one error each that says what to do, and nothing moves: no frame with a target is sent.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# refused BUS PATTERN [ARGUMENTS...]: our run ends with 1 and an error like that; whatever it sent held the motors off.
refused() {
    bus=$1
    pattern=$2
    shift 2
    listen "$work/refused.log" 120 || return 1
    walk refused can_2kmh --lockstep --no-log --bus "$bus" "$@"
    code=$?
    listened_out
    error=$(grep -E "$pattern" "$work/refused/said" | head -n 1)
    [ -n "$error" ] || because "no error like '$pattern', but: $(tail -n 5 "$work/refused/said")" || return 1
    echo "        $code: $error"
    [ "$code" -eq 1 ] || because "exit code $code" || return 1
    # Byte 1 of a control message is the mode; 0 is off.
    awk 'FNR == NR && /^BO_ .*_control: / { control[sprintf("%03X", $2)] = 1 }
         FNR != NR { id = substr($3, 1, index($3, "#") - 1); if (id in control && substr($3, length(id) + 4, 2) != "00") on++ }
         END { exit on > 0 }' "$here/../../config/robots/lola/can/lola.dbc" "$work/refused.log" || because "a drive was told to move"
}

down() {
    ip link set vcan4 down
    refused can:vcan0-8 'vcan4: the interface is down; .*ip link set vcan4 up'
    code=$?
    ip link set vcan4 up
    return $code
}

no_fd() {
    ip link set vcan2 down && ip link set vcan2 mtu 16 && ip link set vcan2 up
    refused canfd:vcan0-8 'vcan2: .*mtu 72'
    code=$?
    ip link set vcan2 down && ip link set vcan2 mtu 72 && ip link set vcan2 up
    return $code
}

step "an interface that is not there" refused can:vcan0-7,vcan9 'vcan9: there is no such interface; .*ip link add dev vcan9 type vcan'
step "an interface that is down" down
step "an interface that is no CAN interface" refused can:vcan0-7,lo 'lo: is not a CAN interface'
step "an interface without CAN FD" no_fd
step "as many interfaces as lines, or one" refused can:vcan0-3 'the robot has 9 CAN lines; give 1 or 9 interfaces, not 4'
