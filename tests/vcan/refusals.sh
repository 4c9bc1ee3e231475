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

# forbidden: under rules that forbid sockets of CAN, as a container's may.
forbidden() {
    allowed=$GANGWERK
    printf '#!/bin/sh\nexec "%s" -S "%s/forbidden.py" "%s" "$@"\n' "$python" "$here" "$allowed" >"$work/forbidden"
    chmod +x "$work/forbidden"
    GANGWERK="$work/forbidden"
    refused can:vcan0-8 'vcan0: not permitted; .*seccomp'
    code=$?
    GANGWERK=$allowed
    return $code
}

# ordinary: who has no capability at all may use the lines; what is missing for real time is said.
ordinary() {
    prlimit --rtprio=0:0 --memlock=65536:65536 setpriv --bounding-set=-all --inh-caps=-all \
        "$GANGWERK" study lines --config "$here/../../config" --bus can:vcan0-8 --cycle 224 --seconds 2 \
        >"$work/lines" 2>&1 || because "gangwerk ended with $?: $(tail -n 5 "$work/lines")" || return 1
    grep -E 'frames lost|^degraded' "$work/lines" | sed 's/^/        /'
    grep -q '^degraded: .*SCHED_FIFO' "$work/lines" || because "no word of the priority" || return 1
}

step "an interface that is not there" refused can:vcan0-7,vcan9 'vcan9: there is no such interface; .*ip link add dev vcan9 type vcan'
step "an interface that is down" down
step "an interface that is no CAN interface" refused can:vcan0-7,lo 'lo: is not a CAN interface'
step "an interface without CAN FD" no_fd
step "as many interfaces as lines, or one" refused can:vcan0-3 'the robot has 9 CAN lines; give 1 or 9 interfaces, not 4'
step "sockets that are forbidden" forbidden
step "no right is needed for the lines: an ordinary user" ordinary
