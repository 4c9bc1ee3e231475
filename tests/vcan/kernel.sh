#!/bin/sh
# Gets the kernel that the virtual machine boots, from a package of Debian's: User Mode Linux into tests/vcan/.kernel; with
# the argument `rt` the one with PREEMPT_RT, for QEMU, into tests/vcan/.kernel-rt.
# Prints that folder, which holds `linux` and, in the order of their loading, `modules/NN-NAME.ko`. Safe to run again.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
kernel="$here/.kernel${1:+-$1}"

# Each after those it needs: a writable layer above the host's files, and CAN.
modules="fs/overlayfs/overlay net/can/can net/can/can-raw net/can/can-bcm net/can/can-gw drivers/net/can/dev/can-dev
drivers/net/can/vcan"
# QEMU has the host's files as 9p over virtio, and gamepads that a program plays.
[ $# -eq 0 ] || modules="drivers/virtio/virtio_ring drivers/virtio/virtio drivers/virtio/virtio_pci_modern_dev
drivers/virtio/virtio_pci_legacy_dev drivers/virtio/virtio_pci fs/netfs/netfs fs/fscache/fscache net/9p/9pnet
net/9p/9pnet_virtio fs/9p/9p $modules drivers/input/evdev drivers/input/misc/uinput"

fail() {
    echo "kernel.sh: $*" >&2
    exit 1
}

# One with other modules is from another time.
if [ -f "$kernel/complete" ] && [ "$(cat "$kernel/complete")" = "$modules" ]; then
    echo "$kernel"
    exit
fi
for tool in apt-get apt-cache dpkg-deb; do
    command -v "$tool" >/dev/null ||
        fail "$tool is missing: the kernel comes from a Debian package. On a machine that has vcan no kernel is needed"
done

# newest: name of the package that has it now; the one with PREEMPT_RT stands behind a metapackage.
newest() {
    if [ "$kernel" = "$here/.kernel" ]; then
        apt-cache depends user-mode-linux 2>/dev/null | sed -n '1p'
    else
        apt-cache depends linux-image-rt-amd64 2>/dev/null |
            sed -n 's/^ *Depends: \(linux-image-[0-9].*-amd64\)$/\1/p' | head -n 1
    fi
}

package=$(newest)
if [ -z "$package" ] && [ "$(id -u)" -eq 0 ]; then
    apt-get update -qq >&2 || true
    package=$(newest)
fi
[ -n "$package" ] || fail "no kernel in apt's lists: run apt-get update as root; needs Debian's sources"

rm -rf "$kernel"
mkdir -p "$kernel/modules" "$kernel/package"
cd "$kernel/package"
apt-get download -qq -o APT::Sandbox::User=root "$package" >&2 || {
    # Lists older than the archive name a version that is gone.
    [ "$(id -u)" -eq 0 ] && apt-get update -qq >&2
    package=$(newest)
    apt-get download -qq -o APT::Sandbox::User=root "$package" >&2
} || fail "apt-get download $package failed: is the archive reachable?"
dpkg-deb -x ./*.deb unpacked
mv unpacked/usr/bin/linux.uml "$kernel/linux" 2>/dev/null || mv unpacked/boot/vmlinuz-* "$kernel/linux"
number=10
for module in $modules; do
    file=$(find unpacked -path "*/kernel/$module.ko*")
    [ -f "$file" ] || fail "$package has no module $module"
    case $file in
    *.xz) xz -dc "$file" ;;
    *) cat "$file" ;;
    esac >"$kernel/modules/$number-$(basename "$module").ko"
    number=$((number + 1))
done
cd "$kernel"
rm -rf package
echo "$modules" >complete
echo "$kernel"
