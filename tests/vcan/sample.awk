# Some cycles of a recording: every 71st, but for the first half second, when the joint loop is on its way from rest to the
# targets of the log, and ten in a row while the robot walks. usage:
# awk -v TICKS=FILE -f sample.awk FILE.dbc LOG >SAMPLE; TICKS gets, line by line, which cycle a frame is of.

FNR == NR && /^BU_:/ { computer = $2 }
FNR == NR && /^BO_ / { ours[sprintf("%03X", $2)] = $5 == computer }
FNR == NR { next }
{
    # The first byte of every frame counts cycles. Ours lead, the drives answer.
    id = substr($3, 1, index($3, "#") - 1)
    count = substr($3, length(id) + 2, 2)
    if (ours[id] && $2 in last && count != last[$2]) tick[$2]++
    if (ours[id]) last[$2] = count
    if (tick[$2] > 142 && (tick[$2] % 71 == 0 || (tick[$2] >= 1000 && tick[$2] < 1010))) {
        print
        print tick[$2] >TICKS
    }
}
