#!/bin/sh
# Installs what the compilers need and this machine lacks: Debian and Ubuntu packages. Elsewhere it says what is needed.
# The only argument is the Python that will make the environment. Nothing is installed where nothing is missing.
set -eu
python=${1:-python3}

have() { command -v "$1" >/dev/null 2>&1; }

# What comes from outside Python, and what for.
needed="glslangValidator (GLSL and HLSL), spirv-val and spirv-cross (HLSL that runs), node with npm (Tint), gcc and g++
with the headers of Python, Vulkan and X11 (DXC's package, the preprocessing of Unity's shaders), drivers for OpenGL and
Vulkan (Mesa's software drivers do), mcs and mono (the tests of the renderer feature for Unity), and Chromium or Chrome
(WebGPU in a browser)"

if ! have dpkg-query || ! have apt-get; then
    echo "not a Debian or Ubuntu machine: please see that these are there: $needed"
    exit 0
fi

missing=""
want_command() { have "$1" || missing="$missing $2"; }
want_package() { dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'ok installed' || missing="$missing $1"; }

want_command glslangValidator glslang-tools
want_command spirv-val spirv-tools
want_command spirv-cross spirv-cross
have chromium || have google-chrome || want_command chromium-browser chromium
want_command gcc gcc
want_command g++ g++
want_command mcs mono-mcs
want_command node nodejs
want_command npm npm
for package in libegl1 libgl1 libgl1-mesa-dri mesa-vulkan-drivers libvulkan1 libvulkan-dev libx11-dev; do
    want_package "$package"
done

# Debian's Python comes without what makes environments and without what extensions are built with.
version=$("$python" -c 'import sys; print("python%d.%d" % sys.version_info[:2])')
"$python" -c 'import ensurepip, venv' 2>/dev/null || missing="$missing $version-venv"
"$python" -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' ||
    missing="$missing $version-dev"

[ -n "$missing" ] || exit 0
as_root=""
if [ "$(id -u)" != 0 ]; then
    if ! have sudo; then
        echo "please install as root:$missing" >&2
        exit 1
    fi
    as_root="sudo"
fi
echo "installing:$missing"
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq update
# shellcheck disable=SC2086  # a list of names
$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends $missing >/dev/null
