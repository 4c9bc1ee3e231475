# Walks over the lines. After step.sh.
# shellcheck shell=sh

# The shipped configuration, but patient, virtual machines are slow, and without TCP, which nobody uses here.
if [ ! -d "$work/config" ]; then
    cp -r "$here/../../config" "$work/config"
    sed -i -e 's/^peer_timeout = .*/peer_timeout = 60.0/' "$work/config/system.toml"
fi

# brief SCENE SECONDS: from now on it walks at once, and only so long.
brief() {
    file="$work/config/scenes/$1.toml"
    cp "$here/../../config/scenes/$1.toml" "$file"
    sed -i -e "s/^duration = .*/duration = $2/" -e 's/^time = 3.0$/time = 0.6/' "$file"
    # Without the last command, the stop.
    awk '{ line[NR] = $0 } /^\[\[command\]\]/ { last = NR } END { for (i = 1; i < last; i++) print line[i] }' "$file" >"$file.new"
    mv "$file.new" "$file"
}

# walk NAME SCENE ARGUMENTS...: our run; its log in $work/NAME, what it said in $work/NAME/said.
walk() {
    place="$work/$1"
    scene=$2
    shift 2
    mkdir -p "$place"
    timeout 900 "$GANGWERK" run "$scene" --config "$work/config" --dir "$place/run" --out "$place" --no-plots "$@" >"$place/said" 2>&1
}

# recorded NAME SCENE ARGUMENTS...: the same, and the traffic of all lines in $work/NAME.log.
recorded() {
    listen "$work/$1.log" 1000 || return 1
    walk "$@" || because "gangwerk ended with $?: $(tail -n 5 "$work/$1/said")"
    code=$?
    listened_out
    return $code
}

# replayed LOG: what the joint loop read and wrote over the lines, done again from the log by its real step.
replayed() {
    said=$("$GANGWERK" replay "$1" --process lowlevel 2>&1) || because "$said" || return 1
    echo "        $said"
}
