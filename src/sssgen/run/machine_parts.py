"""The programs and packages of this machine, found by their files alone: nothing is started or imported.

So a part that is found may still not start; the back end or the compiler that needs it then says why.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from sssgen.support.installation import install_hint, make_hint, npm_hint
from sssgen.support.paths import folder


def chromium() -> str:
    """Chromium's program: $SSSGEN_CHROMIUM if it is set, else one that is installed; '' where there is none."""
    configured = os.environ.get("SSSGEN_CHROMIUM")
    if configured:
        return shutil.which(configured) or ""
    roots = [os.environ.get(name, "") for name in ("ProgramFiles", "ProgramFiles(x86)", "LocalAppData")]
    places = [
        *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"),
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
        "/Applications/Chromium.app/Contents/MacOS/Chromium",
        *(rf"{root}\Google\Chrome\Application\chrome.exe" for root in roots if root),
    ]
    return next((path for place in places if (path := shutil.which(place))), "")


def firefox() -> str:
    """Firefox's program: $SSSGEN_FIREFOX if it is set, else one that is installed; '' where there is none."""
    configured = os.environ.get("SSSGEN_FIREFOX")
    places = (
        [configured] if configured else ["firefox", "firefox-esr", "/Applications/Firefox.app/Contents/MacOS/firefox"]
    )
    return next((path for place in places if (path := shutil.which(place))), "")


def node() -> str:
    """The program of Node.js; '' where there is none."""
    return shutil.which("node") or shutil.which("nodejs") or ""


def node_modules() -> Path:
    """The folder that npm filled: $SSSGEN_NODE_MODULES names it, else it is build/node/node_modules."""
    configured = os.environ.get("SSSGEN_NODE_MODULES")
    return (Path(configured) if configured else folder("build") / "node" / "node_modules").resolve()


def glslang() -> str:
    """The program of glslang: $SSSGEN_GLSLANG if it is set, else one on the path; '' where there is none."""
    return shutil.which(os.environ.get("SSSGEN_GLSLANG", "glslangValidator")) or shutil.which("glslang") or ""


def c_preprocessor() -> str:
    """gcc's or clang's program; '' where there is none."""
    return next((path for name in ("gcc", "clang", "cc") if (path := shutil.which(name))), "")


def godots() -> list[tuple[str, str]]:
    """(program, root) of each Godot, the preferred one first. `root` is the folder of the system that it is in, or ''.

    Where $SSSGEN_GODOT is set, it is that program alone; else one on the path, and one in the system of
    `make engines`.
    """
    configured = os.environ.get("SSSGEN_GODOT")
    program = shutil.which(configured) if configured else shutil.which("godot") or shutil.which("godot4")
    if configured:
        return [(program, "")] if program else []
    system = folder("build") / "engines" / "godot"
    apart = (system / "usr" / "bin" / "godot").is_file() and hasattr(os, "geteuid") and os.geteuid() == 0
    return [*([(program, "")] if program else []), *([("godot", str(system.resolve()))] if apart else [])]


def _importable(modules: tuple[str, ...]) -> bool:
    try:
        return all(map(find_spec, modules))
    except ModuleNotFoundError:  # of an import hook
        return False


def _has_package(name: str) -> bool:
    return (node_modules() / name / "package.json").is_file()


def _godot_with_display() -> bool:
    return any(root or shutil.which("Xvfb") for _, root in godots())


_GODOT = make_hint("engines", "SSSGEN_GODOT=/path/to/godot", "Debian, as root")

_PARTS: Mapping[str, tuple[Callable[[], object], str]] = {
    "chromium": (chromium, "Chromium or Chrome (Debian: chromium; or SSSGEN_CHROMIUM names it)"),
    "firefox": (firefox, "Firefox (Debian: firefox-esr; or SSSGEN_FIREFOX names it)"),
    "godot": (
        _godot_with_display,
        f"Godot 4.6 and Xvfb: {_GODOT} (and Debian's xvfb)",
    ),
    "godot parser": (godots, f"Godot 4.6: {_GODOT}"),
    "glslang": (glslang, "glslangValidator (Debian: glslang-tools; elsewhere: the Vulkan SDK)"),
    "c preprocessor": (c_preprocessor, "a C preprocessor (Debian: gcc; elsewhere: clang)"),
    "g++": (lambda: shutil.which("g++"), "g++ (Debian: g++)"),
    "node": (node, "node (Debian: nodejs npm)"),
    "spirv": (
        lambda: shutil.which("spirv-val") and shutil.which("spirv-cross"),
        "spirv-val and spirv-cross (Debian: spirv-tools spirv-cross)",
    ),
    "babylon bundle": (
        lambda: (node_modules().parent / "babylon.js").is_file(),
        "the npm package @babylonjs/core, bundled: make setup, in a checkout",
    ),
    **{
        f"npm {package}": (
            partial(_has_package, package),
            f"the npm package {package}: {npm_hint(package)}",
        )
        for package in ("playcanvas", "three", "webgpu", "wesl")
    },
    **{
        f"pip {extra}": (partial(_importable, modules), install_hint(extra))
        for extra, modules in {
            "browser": ("websockets", "numpy"), "dxc": ("compushady",), "gl": ("moderngl", "numpy"),
            "numpy": ("numpy",), "webgpu": ("wgpu", "numpy"),
        }.items()
    },
}  # fmt: skip


def lacks(part: str) -> str:
    """How to get a part that this machine lacks; '' where it is there."""
    found, how = _PARTS[part]
    return "" if found() else how


def all_lacks(parts: Iterable[str]) -> str:
    """How to get those of the parts that this machine lacks; '' where all are there."""
    return "; ".join(filter(None, map(lacks, parts)))
