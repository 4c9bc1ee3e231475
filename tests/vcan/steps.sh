#!/bin/sh
# Runs the checks in a place of their own, with the lines vcan0 to vcan8, and counts their steps; `run` starts it.
set -u
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d /dev/shm/gangwerk-vcan-XXXXXX) || exit 1
# What they wrote: gone, or kept where the virtual machine can (boot.sh -k).
trap '[ ! -d /run/kept ] || cp -r "$work/." /run/kept/; rm -rf "$work"' EXIT

ip link set lo up
for line in 0 1 2 3 4 5 6 7 8; do
    ip link add dev "vcan$line" type vcan && ip link set "vcan$line" mtu 72 up || exit 1
done

[ $# -gt 0 ] || set -- $(sed 's/^-[lr] //' "$here/checks")
: >"$work/steps"
for check; do
    printf '\n-- vcan %s\n' "$check"
    begun=$(date +%s)
    sh "$here/$check.sh" "$work" || echo "failed $check" >>"$work/steps"
    printf -- '-- vcan %s: %d s\n' "$check" "$(($(date +%s) - begun))"
done
failed=$(grep -c '^failed' "$work/steps")
printf '\n%d passed, %d failed\n' "$(grep -c '^passed' "$work/steps")" "$failed"
[ "$failed" -eq 0 ]
