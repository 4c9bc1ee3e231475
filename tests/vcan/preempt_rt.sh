#!/bin/sh
# All processes on a kernel with PREEMPT_RT: what it grants them and that they do the same. How fast an emulated machine is
# says nothing.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

if [ -z "${VCAN_GUEST:-}" ] && [ "$(cat /sys/kernel/realtime 2>/dev/null)" != 1 ]; then
    echo "left out: this kernel is without PREEMPT_RT, and the virtual machine is only for kernels without CAN"
    exit
fi
# Two cores: one for the cycles, one for everything else, or nobody else gets to run. The scene waits for commands until it is
# stopped; its cycle is the longest there is: one that an emulated machine cannot keep leaves no time to start in.
sed -i -e 's/^core = .*/core = 0/' "$work/config/system.toml"
awk '/^\[\[command\]\]/ { exit } { sub(/^duration = .*/, "duration = 1000.0"); sub(/^cycle = .*/, "cycle = 0.02"); print }' \
    "$here/../../config/scenes/demo.toml" >"$work/config/scenes/demo.toml"

doctor() {
    "$GANGWERK" doctor >"$work/doctor"
    sed 's/^/        /' "$work/doctor"
    [ "$(cat /sys/kernel/realtime)" = 1 ] || because "this kernel is $(uname -v)" || return 1
    grep -q '^good     kernel .*PREEMPT_RT' "$work/doctor"
}

# granted: priority, core and locked memory of each process while it runs are those of the table.
granted() {
    for process in watchdog lowlevel sim-backend controller planner; do
        pid=$(cat "$work/rt/run/$process.lock" 2>/dev/null) ||
            because "$process is not there: $(tail -n 20 "$work/rt/said")" || return 1
        wanted=$(awk -v row="[process.$process]" '$0 == row { on = 1 } on && /^priority/ { print $3; exit }' "$work/config/system.toml")
        [ -d "/proc/$pid" ] || because "$process has ended: $(tail -n 20 "$work/rt/said")" || return 1
        has=$(chrt -p "$pid" | sed -n 's/.*priority: //p')
        locked=$(awk '/^VmLck/ { print $2 }' "/proc/$pid/status")
        echo "        $process: SCHED_FIFO $has, $locked kB locked"
        [ "$has" = "$wanted" ] && [ "${locked:-0}" -gt 1000 ] || because "$process is to have $wanted" || return 1
    done
}

# With --rt required the run ends at once if anything is not granted.
real_time() {
    walk rt demo --rt required --no-log &
    within 200 grep -qE 'motor supply on' "$work/rt/said" || because "no start: $(tail -n 5 "$work/rt/said")" || return 1
    granted || return 1
    "$GANGWERK" estop --dir "$work/rt/run" >"$work/estop" 2>&1 || because "$(cat "$work/estop"): $(tail -n 20 "$work/rt/said")" || return 1
    sed 's/^/        /' "$work/estop"
    pkill -INT -f -- '--rt required'
    sleep 1
    pkill -INT -f -- '--rt required'
    wait
}

lockstep() {
    brief walk_1kmh 1.0
    walk lockstep walk_1kmh --lockstep || because "gangwerk ended with $?: $(tail -n 5 "$work/lockstep/said")" || return 1
    "$GANGWERK" sim walk_1kmh --config "$work/config" --log "$work/lockstep/alone.mcap" --json >/dev/null || return 1
    "$python" "$here/same.py" "$work/lockstep/alone.mcap" "$work/lockstep/walk_1kmh.mcap"
}

step "the kernel is one for real time, and doctor says so" doctor
step "each process gets its priority and locked memory, and the emergency stop is answered" real_time
step "all processes do what one process does, bit by bit" lockstep
