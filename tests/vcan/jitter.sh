#!/bin/sh
# A bus cycle in real time over nine lines, both ends, beside cyclictest: the shortest one that this machine keeps. How
# punctual it is depends on the machine and is shown; that all is answered and nothing allocated does not.
. "$(dirname "$0")/step.sh"

# Cycles [ms], from that of Lola's classic lines on: an emulated processor needs more.
cycles="3.5 7 14 28 56 112 224"

# kept CYCLE SECONDS: whether at most one frame in a hundred is not there by the next cycle.
kept() {
    timeout 120 "$GANGWERK" study lines --config "$here/../../config" --bus can:vcan0-8 --cycle "$1" --seconds "$2" \
        >"$work/lines" 2>&1 || because "gangwerk ended with $?: $(tail -n 5 "$work/lines")" || return 1
    awk '/frames lost/ { for (i = 4; i <= NF; i++) if ($i == "frames") { lost = $(i - 3); all = $(i - 1) } }
         END { exit !(all > 0 && lost <= all / 100) }' "$work/lines"
}

punctual() {
    for cycle in $cycles; do
        if kept "$cycle" 1 && kept "$cycle" 5; then
            sed 's/^/        /' "$work/lines"
            return 0
        fi
        head -n 1 "$work/lines" | sed 's/^/        not kept: /'
    done
    because "no cycle is kept"
}

# With real-time rights cyclictest has run, alone and beside.
compared() {
    [ "$(grep -cE '^cyclictest (beside it|alone) +([0-9]+\.[0-9] *){4}$' "$work/lines")" -eq 2 ] ||
        grep '^degraded: ' "$work/lines" || because "cyclictest did not run"
}

allocated() {
    grep -x 'allocations and frees: near end 0, 0; far end 0, 0' "$work/lines" | sed 's/^/        /' | grep . ||
        because "$(grep allocations "$work/lines")"
}

step "a cycle in real time over nine lines: all frames are answered" punctual
step "cyclictest at the same priority, before it and beside it" compared
step "neither end allocates in a cycle" allocated
