# Whether a recording holds every message of a DBC once per cycle, on its line and as long as it should be.
# usage: awk -f every_frame.awk FILE.dbc CYCLES=N LOG
# The lines are the nodes in their order, without the first, the on-board computer. A cycle ends with its SYNC.

FNR == NR && /^BU_:/ { for (i = 3; i <= NF; i++) line[$i] = i - 3; computer = $2; next }
FNR == NR && /^BO_ / { id = sprintf("%03X", $2); sub(":", "", $3); name[id] = $3; bytes[id] = $4; sender[id] = $5; next }
FNR == NR && /^ SG_ / { receiver = $NF; if (id != "") place(); next }
FNR == NR { next }

function place() {
    on[id] = line[sender[id] == computer ? receiver : sender[id]]
    if (name[id] ~ /_sync$/) sync[id] = 1
    to_drives[id] = sender[id] == computer
    id = ""
}

{
    frame = index($3, "##") ? "##" : "#"
    id = substr($3, 1, index($3, "#") - 1)
    data = substr($3, length(id) + length(frame) + 1 + (frame == "##"))
    if (!(id in name)) { wrong("no message of the DBC"); next }
    if ($2 != "vcan" (all_on_one ? 0 : on[id])) { wrong("on the wrong line"); next }
    if (length(data) != 2 * bytes[id]) { wrong(length(data) / 2 " bytes instead of " bytes[id]); next }
    seen[id]++
    if (!(id in sync)) {
        # Answers come after the SYNC of their cycle, targets before it.
        here[id]++
        next
    }
    for (other in on) {
        if (on[other] != on[id] || other in sync) continue
        if (seen[id] > 1 && here[other] != 1) wrong(name[other] " came " here[other] + 0 " times before SYNC " seen[id] - 1)
        here[other] = 0
    }
}

function wrong(why) {
    if (bad++ < 10) print "        line " FNR ": " $0 ": " why
}

END {
    for (id in name) {
        ids++
        frames += seen[id]
        cycles = CYCLES - (to_drives[id] && !(id in sync)) # the first SYNC has no targets before it
        if (seen[id] != cycles) { FNR = "all"; $0 = name[id]; wrong("seen " seen[id] + 0 " times in " cycles " cycles") }
    }
    print "        " frames " frames of " ids " messages in " CYCLES " cycles"
    exit bad > 0 || ids == 0
}
