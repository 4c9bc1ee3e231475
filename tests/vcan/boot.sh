#!/bin/sh
# Runs a command in a virtual machine that has CAN: tests/vcan/boot.sh [-t SECONDS] [-k DIR] [-r] [-i] COMMAND...
#
# The machine is User Mode Linux, a kernel of Debian's that is an ordinary process, and sees all files of this one at their
# places; what it writes stays in its memory and is gone at the end. The command runs as root in this folder, its output is
# shown as it comes, its exit code is returned. 124: the time limit (-t, 600 s) was reached; 125: the machine itself failed.
# -k: what is written to /run/kept is kept in that folder. -i: with the keyboard, for a shell: tests/vcan/boot.sh -i bash
# -r: a kernel with PREEMPT_RT on two cores that QEMU emulates (KVM is neither needed nor used), about fifty times slower
# where numbers are crunched.
set -u
limit=600
keyboard=
kept=
flavour=
while getopts t:k:ri option; do
    case $option in
    t) limit=$OPTARG ;;
    k) kept=$OPTARG ;;
    r) flavour=rt ;;
    i) keyboard=yes ;;
    *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))
here=$(cd "$(dirname "$0")" && pwd)

fail() {
    echo "boot.sh: $*" >&2
    exit 125
}

[ $# -gt 0 ] || fail "no command; usage: boot.sh [-t SECONDS] [-k DIR] [-r] [-i] COMMAND..."
for tool in ${flavour:+qemu-system-x86_64:qemu-system-x86} cc:build-essential busybox:busybox-static cpio:cpio; do
    command -v "${tool%%:*}" >/dev/null || fail "${tool%%:*} is missing: apt-get install ${tool##*:}"
done
[ -z "$kept" ] || mkdir -p "$kept" || fail "no folder $kept"
# shellcheck disable=SC2086
kernel=$("$here/kernel.sh" $flavour) || exit 125
work=$(mktemp -d) || exit 125
trap 'rm -rf "$work"' EXIT

# quoted WORD...: as a shell reads it again.
quoted() {
    for word; do
        printf "'%s' " "$(printf %s "$word" | sed "s/'/'\\\\''/g")"
    done
}

# The first files: busybox, modules, and what is to be done.
mkdir -p "$work/first/bin"
cp "$(command -v busybox)" "$work/first/bin/busybox"
"$work/first/bin/busybox" --list 2>/dev/null | grep -qx insmod || fail "busybox cannot load modules: apt-get install busybox-static"
cp -r "$kernel/modules" "$work/first/modules"
cp "$here/init" "$work/first/init"
chmod +x "$work/first/init"
[ -z "$keyboard" ] || : >"$work/first/keyboard"
[ -z "$kept" ] || : >"$work/first/kept"
{
    echo "cd $(quoted "$PWD") || exit 125"
    for name in HOME PATH LANG TERM GANGWERK CI LONG; do
        value=$(printenv "$name") && echo "export $name=$(quoted "$value")"
    done
    echo "export VCAN_GUEST=1"
    echo "exec $(quoted "$@")"
} >"$work/first/order"
(cd "$work/first" && find . | cpio --quiet -o -H newc) >"$work/initramfs"

# Without the keyboard Ctrl-C ends the machine, with it what runs in it.
signal=off
[ -n "$keyboard" ] || { exec </dev/null; signal=on; }

# A process that is a kernel; those that it runs are processes, too. It has one core.
machine_of_a_process() {
    cc -O2 -shared -fPIC -o "$work/xstate.so" "$here/xstate.c" -ldl || fail "xstate.c does not compile"
    LD_PRELOAD="$work/xstate.so" timeout --foreground "$limit" "$kernel/linux" mem=2G initrd="$work/initramfs" quiet panic=-1 \
        ${kept:+kept="$kept"} con=null con0=null,fd:7 ssl=null ssl1=fd:0,fd:1 ssl2=null,fd:8 7>"$work/console" 8>"$work/code" 2>&7
}

# All files of the host at their places: one tree, whatever is mounted in it.
emulated_machine() {
    set --
    [ -z "$kept" ] || set -- -virtfs "local,path=$kept,mount_tag=kept,security_model=none"
    timeout --foreground "$limit" qemu-system-x86_64 \
        -accel tcg,thread=multi -cpu max -smp 2 -m 2G -no-reboot -nodefaults -display none \
        -kernel "$kernel/linux" -initrd "$work/initramfs" \
        -append "console=ttyS0 quiet panic=-1 mitigations=off random.trust_cpu=on tsc=reliable" \
        -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap "$@" \
        -serial "file:$work/console" -chardev "stdio,id=out,signal=$signal" -serial chardev:out -serial "file:$work/code"
}

if [ -n "$flavour" ]; then emulated_machine; else machine_of_a_process; fi
code=$?
[ "$code" -ne 124 ] || { echo "boot.sh: not finished within $limit s (-t)" >&2; exit 124; }
if [ ! -s "$work/code" ]; then
    echo "boot.sh: the virtual machine ended without a result (exit code $code); its console:" >&2
    tail -n 20 "$work/console" >&2
    exit 125
fi
exit "$(cat "$work/code")"
