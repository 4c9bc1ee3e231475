# Whether a recording holds every message of a DBC once per cycle, on its line and as long as it should be.
# usage: awk -v CYCLES=N -v PREFIX=vcan -f every_frame.awk FILE.dbc LOG
# Lines are the nodes in their order, without the first one, the on-board computer; PREFIX with SHARED=1: all on one
# interface. A cycle ends with its SYNC. What was said before cycle 1 is not looked at: our end asks until it is answered.

FNR == NR && /^BU_:/ { computer = $2; for (i = 3; i <= NF; i++) line[$i] = i - 3 }
FNR == NR && /^BO_ / { id = sprintf("%03X", $2); sub(":", "", $3); name[id] = $3; bytes[id] = $4; sender = $5 }
FNR == NR && /^ SG_ / && !(id in on) {
    ours[id] = sender == computer
    on[id] = line[ours[id] ? $NF : sender]
    if (name[id] ~ /_sync$/) sync[id] = 1
}
FNR == NR { next }

{
    id = substr($3, 1, index($3, "#") - 1)
    data = substr($3, length(id) + 2)
    if (data ~ /^#/) data = substr(data, 3) # CAN FD: flags
    if (!(id in name)) { wrong("no message of the DBC"); next }
    if ($2 != (SHARED ? PREFIX : PREFIX on[id])) { wrong("on the wrong line"); next }
    if (length(data) != 2 * bytes[id]) { wrong(length(data) / 2 " bytes instead of " bytes[id]); next }
    here = on[id]
    if (!begun[here]) {
        if (!ours[id] || data ~ /^00/) next
        begun[here] = 1
    }
    seen[id]++
    if (!(id in sync)) { since[id]++; next }
    for (other in on) {
        if (on[other] != here || other in sync) continue
        # Targets come before the SYNC of their cycle, answers after it.
        if (since[other] + 0 != (ours[other] || seen[id] > 1)) wrong(name[other] " came " since[other] + 0 " times before it")
        since[other] = 0
    }
}

function wrong(why) {
    if (bad++ < 10) print "        " $0 ": " why
}

END {
    for (id in name) {
        ids++
        frames += seen[id]
        $0 = name[id]
        if (seen[id] != CYCLES) wrong("seen " seen[id] + 0 " times in " CYCLES " cycles")
    }
    print "        " frames + 0 " frames of " ids + 0 " messages in " CYCLES " cycles"
    exit bad > 0 || ids == 0
}
