#!/bin/sh
# CAN FD in a cycle of 1 ms walks as shared memory does.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# The bus must not be seen in what is walked: shared memory carries the same frames as CAN FD.
fd() {
    brief walk_2kmh 3.5
    recorded fd walk_2kmh --lockstep --bus canfd:vcan0-8 || return 1
    "$GANGWERK" sim walk_2kmh --config "$work/config" --log "$work/fd/shm.mcap" --json >/dev/null || return 1
    awk -v CYCLES=3500 -v PREFIX=vcan -f "$here/every_frame.awk" "$robots/lola/can/lola_fd.dbc" "$work/fd.log" || return 1
    "$python" "$here/same.py" "$work/fd/shm.mcap" "$work/fd/walk_2kmh.mcap"
}

robots="$here/../../config/robots"
step "CAN FD on nine lines, 1 ms: walks as over shared memory" fd
