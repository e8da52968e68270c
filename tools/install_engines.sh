#!/bin/sh
# Sets up Godot 4.6 beside the project: Debian's, in a system of its own of 1.2 GB, in the folder that is the only
# argument. It takes about four minutes, needs root, and changes nothing else on the machine but the packages debootstrap
# and firefox-esr.
set -eu
place=$1

if [ "$(id -u)" != 0 ]; then
    echo "make engines needs root (sudo make engines); a Godot 4.6 on the path, or SSSGEN_GODOT, serves as well" >&2
    exit 1
fi
if ! command -v debootstrap >/dev/null 2>&1 || ! command -v firefox-esr >/dev/null 2>&1; then
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "not a Debian or Ubuntu machine: install Godot 4.6, and let SSSGEN_GODOT name its program" >&2
        exit 1
    fi
    apt-get -qq update
    DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends debootstrap firefox-esr >/dev/null
fi
# a run that was interrupted leaves a system that debootstrap would not continue
rm -rf "$place"
mkdir -p "$(dirname "$place")"
debootstrap --include=godot,xvfb,libgl1-mesa-dri,mesa-vulkan-drivers,libegl1,libgl1,libvulkan1 sid "$place" >"$place.log" 2>&1 || {
    tail -5 "$place.log" >&2
    rm -rf "$place"
    exit 1
}
chroot "$place" godot --headless --version
