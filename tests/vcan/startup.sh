#!/bin/sh
# Lola is led from her crane onto the ground over nine lines: homing, drives on, force sensors zeroed, lowered, standing.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

# The shipped scene in the cycle of the lines of classic CAN, with less waiting, and without the walk.
shorter() {
    awk -v RS= -v ORS='\n\n' '
        BEGIN { at["system/reset"] = 0.1; at["system/enable"] = 0.2; at["joint/home"] = 0.3; at["joint/zero_force"] = 2.0
                at["sim/lower"] = 2.4; at["walk/stand"] = 5.2 }
        /^\[\[command\]\]/ { match($0, /topic = "[^"]*/); topic = substr($0, RSTART + 9, RLENGTH - 9)
                             if (!(topic in at)) next
                             sub(/time = [0-9.]+/, "time = " at[topic]) }
        { sub(/\ncycle = [0-9.]+/, "\ncycle = 0.0035"); sub(/\nsubsteps = [0-9]+/, "\nsubsteps = 14")
          sub(/\nduration = 30[0-9.]*/, "\nduration = 7.7"); print }' \
        "$here/../../config/scenes/startup.toml" >"$work/config/scenes/startup.toml"
}

led() {
    shorter
    walk startup startup --lockstep --bus canfd:vcan0-8 || because "gangwerk ended with $?: $(tail -n 5 "$work/startup/said")" || return 1
    grep -oE 'lowlevel: (a joint does not know|all joints know|the force sensors read zero)|standing: ready|^fell +[a-z]+' "$work/startup/said" >"$work/led"
    sed 's/^/        /' "$work/led"
    wanted='a joint does not know, all joints know, the force sensors read zero, standing: ready, fell no, '
    found=$(sed -E -e 's/^lowlevel: //' -e 's/^fell +/fell /' -e 's/$/,/' "$work/led" | tr '\n' ' ')
    [ "$found" = "$wanted" ] || because "not $wanted, but $found"
}

same() {
    "$GANGWERK" sim startup --config "$work/config" --log "$work/startup/shm.mcap" --json >/dev/null || return 1
    "$python" "$here/same.py" "$work/startup/shm.mcap" "$work/startup/startup.mcap"
}

step "from the crane to standing over nine lines" led
step "each state as over shared memory" same
