# What the checks share; each begins with `. step.sh` and is started with the folder that it may write.
# shellcheck shell=sh disable=SC2034
here=$(cd "$(dirname "$0")" && pwd)
work=$1
python="$here/../peers/.venv/bin/python"
lines="vcan0 vcan1 vcan2 vcan3 vcan4 vcan5 vcan6 vcan7 vcan8"

# step NAME COMMAND...: one asserted step, counted. What it measures stands on its output; a failure says why.
step() {
    step_name=$1
    shift
    step_began=$(date +%s)
    if "$@"; then
        echo "passed $step_name" >>"$work/steps"
        echo "ok      $step_name ($(($(date +%s) - step_began)) s)"
    else
        echo "failed $step_name" >>"$work/steps"
        echo "FAILED  $step_name"
    fi
}

# because WORD...: the reason of a failure.
because() {
    echo "        $*"
    return 1
}

# within SECONDS COMMAND...: waits until it succeeds; fails when the time is over.
within() {
    end=$(($(date +%s) + $1))
    shift
    until "$@"; do
        [ "$(date +%s)" -lt "$end" ] || return 1
        sleep 0.05
    done
}

# listened LINE [COUNT]: whether that many sockets hear this line (any: every line).
listened() {
    [ "$(awk -v line="$1" '$1 == line { n++ } END { print n + 0 }' /proc/net/can/rcvlist_*)" -ge "${2:-1}" ]
}

# listen FILE SECONDS: candump of all lines into this file, from now on; its process is $listener.
listen() {
    timeout "$2" candump -L -r 200000000 any >"$1" 2>"$1.said" &
    listener=$!
    traffic=$1
    within 20 listened any || because "candump did not start: $(cat "$1.said")"
}

# listened_out: the end of `listen`, after everything sent was written: it may be behind, and asked to end it reads no more.
listened_out() {
    written=
    until [ "$written" = "$(stat -c %s "$traffic")" ]; do
        written=$(stat -c %s "$traffic")
        sleep 0.5
    done
    kill -INT "$listener" 2>/dev/null
    wait "$listener"
    :
}
