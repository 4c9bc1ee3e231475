#!/bin/sh
# Records our Sercos III telegrams between two network namespaces, through all phases and a broken ring, and has tshark
# decode them; fails if it does not find in them what was sent. Needs root for the namespaces, and tshark.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
leave() {
    echo "left out: $1"
    [ "${CI:-}" != true ] || exit 1
    exit 0
}
command -v tshark >/dev/null || leave "tshark is not installed (apt-get install tshark)"
[ "$(id -u)" -eq 0 ] || leave "not root: network namespaces cannot be made"
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
"$(sh "$here/example.sh" ring)" --seconds 8 --break --capture "$directory/ring.pcap" >"$directory/ring.txt" || {
    cat "$directory/ring.txt"
    exit 1
}
python3 "$here/sercos.py" "$directory/ring.pcap"
