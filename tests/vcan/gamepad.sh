#!/bin/sh
# `gangwerk joystick` with gamepads of the kernel's (uinput): found, refused, walked with, unplugged. With LONG=1 only.
. "$(dirname "$0")/step.sh"
. "$here/walking.sh"

[ "${LONG:-}" = 1 ] || exit 0
[ -w /dev/uinput ] || { echo "no /dev/uinput on this machine: nothing is checked"; exit 0; }
dir="$work/gamepad/run"
said="$work/gamepad/joystick"
mkdir -p "$work/gamepad"
cat >"$work/config/scenes/wait.toml" <<'SCENE'
about = "She stands up and waits."
robot = "lola"
gait = "lola"
depth = 1
integrator = "euler"
substeps = 4
cycle = 0.001
start_pose = "stand"
duration = 100000.0
seed = 1
[[command]]
time = 0.2
topic = "walk/stand"
SCENE

# plugged NAME: the kernel has a gamepad of this name.
plugged() {
    grep -qs "^$1$" /sys/class/input/event*/device/name
}

# plug NUMBER NAME: a gamepad that lines to the descriptor NUMBER, 3 or 4, move.
plug() {
    pipe="$work/gamepad/pipe$1"
    [ -p "$pipe" ] || mkfifo "$pipe"
    # Both ways, so that it waits for nobody; without descriptors of others: only its own end unplugs it.
    eval "exec $1<>\"$pipe\""
    python3 -S "$here/gamepad.py" "$2" <"$pipe" 3>&- 4>&- &
    within 60 plugged "$2" || because "the kernel has no gamepad $2"
}

joystick() {
    "$GANGWERK" joystick --config "$work/config" --dir "$dir" "$@"
}

# refused PATTERN COMMAND...: it ends with 1 and such a line.
refused() {
    pattern=$1
    shift
    error=$("$@" 2>&1)
    code=$?
    echo "$error" | sed 's/^/        /'
    [ "$code" -eq 1 ] && echo "$error" | grep -q "$pattern" || because "$code, and no line like '$pattern'"
}

# hears PATTERN [COUNT]: the joystick says so, for the COUNT-th time.
hears() {
    heard() { [ "$(grep -c "$1" "$said")" -ge "$2" ]; }
    within 60 heard "$1" "${2:-1}" || because "not said: $1; but: $(cat "$said")"
}

# comes STATE COUNT: the run says that she came to this state of the walk, for the COUNT-th time.
comes() {
    came() { [ "$(grep -c " s  $1\$" "$work/gamepad/said")" -ge "$2" ]; }
    within 90 came "$1" "$2" || because "not $1 for the $2. time: $(tail -n 3 "$work/gamepad/said")"
}

several() {
    plug 4 "Second Pad" || return 1
    refused "2 gamepads are plugged in" joystick
    code=$?
    exec 4>&-
    gone() { ! plugged "Second Pad"; }
    within 60 gone && return $code
}

without_right() {
    chmod 600 /dev/input/event*
    refused "may not read it: .*usermod -aG input" setpriv --reuid 65534 --regid 65534 --clear-groups "$GANGWERK" joystick --config "$here/../../config" --dir "$dir"
}

walked() {
    joystick >"$said" 2>&1 3>&- 4>&- &
    program=$!
    hears "gamepad: Test Pad (/dev/input/event" && hears "robot: lola" || return 1
    # A button that is held when a gamepad is plugged in is no press.
    sleep 1
    printf 'key 0x136 1\nabs 1 -20000\n' >&3
    hears "walk/velocity accepted by planner" && comes Walking 1 || return 1
    echo "key 0x136 0" >&3
    hears "walk/stop accepted by planner" && comes Standing 2
}

unplugged() {
    printf 'key 0x136 1\nabs 1 -30000\n' >&3
    comes Walking 2 || return 1
    exec 3>&-
    hears "is gone" && comes Standing 3 || return 1
    plug 3 "Test Pad" && hears "gamepad: Test Pad (/dev/input/event" 2
}

stopped() {
    printf 'key 0x131 1\nkey 0x131 0\n' >&3
    hears "emergency stop: power off at tick"
}

step "no gamepad" refused "no gamepad is plugged in" joystick
step "one is plugged in" plug 3 "Test Pad"
step "of two one must be chosen" several
step "a user without the right is told how to get it" without_right
timeout 300 "$GANGWERK" run wait --config "$work/config" --dir "$dir" --out "$work/gamepad" --lockstep --no-log --no-plots >"$work/gamepad/said" 2>&1 3>&- 4>&- &
robot=$!
step "she stands" comes Standing 1
step "walked while the button is held, and stopped by its release" walked
step "unplugged in mid-walk, and plugged in again" unplugged
step "emergency stop without the dead-man button" stopped
kill -INT "$program"
step "ends in order" wait "$program"
kill -INT "$robot"
wait "$robot"
exec 3>&-
