# A walk that several checks look at; done once. After step.sh.
# shellcheck shell=sh

# walk NAME SCENE ARGUMENTS...: our run, its log in $work/NAME, what it said in $work/NAME/said. Patient: emulation is slow.
walk() {
    place="$work/$1"
    scene=$2
    shift 2
    mkdir -p "$place"
    cp -r "$here/../../config" "$place/config"
    sed -i 's/^peer_timeout = .*/peer_timeout = 30.0/' "$place/config/system.toml"
    "$GANGWERK" run "$scene" --config "$place/config" --dir "$place/run" --out "$place" --no-plots "$@" >"$place/said" 2>&1
}

# recorded_walk: log in $work/walk, traffic of all lines in $work/walk.log.
recorded_walk() {
    [ ! -f "$work/walk.done" ] || return 0
    listen "$work/walk.log" 400 || return 1
    walk walk can_2kmh --lockstep --bus can:vcan0-8
    code=$?
    listened_out
    [ "$code" -eq 0 ] || because "gangwerk ended with $code: $(tail -n 5 "$work/walk/said")" || return 1
    touch "$work/walk.done"
}
