"""The compilers that check emitted text, one record each: every list of them comes from here."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.support.installation import install_hint


class CompilerRecord(NamedTuple):
    """One compiler, whether or not this machine has it."""

    name: str
    description: str
    languages: frozenset[str]
    """The targets whose text it reads."""
    module: str
    """In `sssgen.run.compilers`; its `find()` starts the compiler."""
    install: str
    """What it needs, in Markdown."""
    apart: bool = False
    """Whether it is too large for `make setup`: then its tests are skipped where it is missing, in CI, too."""
    parts: tuple[str, ...] = ()
    """The parts of `machine_parts` without which it does not start."""


_RECORDS = (
    CompilerRecord(
        "gl", "the OpenGL driver", frozenset({"glsl-330", "glsl-es-300", "shadertoy"}), "gl_driver",
        f"`{install_hint('gl')}` and a driver (Debian, without a GPU: `libegl1 libgl1 libgl1-mesa-dri`)",
        parts=("pip gl",),
    ),
    CompilerRecord(
        "glslang", "Khronos' reference compiler", frozenset({"glsl-330", "glsl-es-300", "shadertoy", "hlsl"}),
        "glslang", "`glslangValidator` (Debian: `glslang-tools`)", parts=("glslang",),
    ),
    CompilerRecord(
        "dxc", "Microsoft's compiler", frozenset({"hlsl"}), "dxc", f"`{install_hint('dxc')}`", parts=("pip dxc",),
    ),
    CompilerRecord(
        "naga", "wgpu's compiler", frozenset({"wgsl"}), "naga",
        f"`{install_hint('webgpu')}` and Vulkan or Metal (Debian, without a GPU: `mesa-vulkan-drivers libvulkan1`)",
        parts=("pip webgpu",),
    ),
    CompilerRecord(
        "tint", "Chrome's compiler", frozenset({"wgsl"}), "tint", "node and the npm package `webgpu`",
        parts=("node", "npm webgpu"),
    ),
    CompilerRecord(
        "unity", "a C preprocessor with Unity's headers, then glslang or DXC",
        frozenset({"unity-builtin", "unity-urp", "unity-shadergraph"}), "unity_compiler",
        "`glslang`, `dxc` and a C preprocessor (Debian: `gcc`)",
        parts=("glslang", "pip dxc", "c preprocessor"),
    ),
    CompilerRecord(
        "unreal", "DXC behind a stand-in for Unreal's material shaders", frozenset({"unreal"}), "unreal_compiler",
        f"`{install_hint('dxc')}`",
        parts=("pip dxc",),
    ),
    CompilerRecord(
        "godot", "Godot's own parser", frozenset({"godot"}), "godot_parser",
        "Godot 4.6: `make engines` sets it up beside the project (1.2 GB), or SSSGEN_GODOT names the program",
        apart=True, parts=("godot parser",),
    ),
    CompilerRecord(
        "bevy", "npm wesl with a stand-in for Bevy's modules, then naga and Tint", frozenset({"bevy"}), "bevy_compiler",
        "`naga`, `tint` and the npm package `wesl`",
        parts=("pip webgpu", "node", "npm webgpu", "npm wesl"),
    ),
    CompilerRecord(
        "metal", "g++ with a stand-in for Metal's library", frozenset({"metal"}), "metal_compiler",
        "`g++` (Debian: `g++`)",
        parts=("g++",),
    ),
    CompilerRecord(
        "tsl", "three's own builders in node, then Tint and glslang", frozenset({"tsl"}), "tsl_compiler",
        "`tint`, `glslang` and the npm package `three`",
        parts=("node", "npm webgpu", "npm three", "glslang"),
    ),
    CompilerRecord("python", "Python itself", frozenset({"numpy"}), "python_syntax", "nothing"),
)  # fmt: skip

COMPILERS = {record.name: record for record in _RECORDS}


def readers(language: str) -> list[str]:
    """The names of all compilers for `language`, also of those that this machine lacks."""
    return [record.name for record in _RECORDS if language in record.languages]
