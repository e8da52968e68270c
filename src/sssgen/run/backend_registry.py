"""The back ends that run emitted text, one record each: every list of them comes from here.

Nothing is imported for it, so that help texts and reports may list what this machine lacks.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.installation import install_hint


class BackendRecord(NamedTuple):
    """One back end."""

    name: str
    description: str
    target: str
    """The target whose text it runs."""
    program: str
    """`module:class` in `sssgen.run.backends`; the class is called with the name, the target and `options`."""
    install: str
    """What it needs, in Markdown."""
    options: Mapping[str, str] = {}
    bits: int = 32
    """The size of its floats."""
    half: str = ""
    """Its counterpart in half precision."""
    driver: bool = True
    """Whether a driver computes, which may crash."""
    scenes_only: bool = False
    """Whether it is an engine, which draws and lights scenes, and evaluates no functions."""
    functions_only: bool = False
    """Whether it evaluates functions, and draws no scenes."""
    parts: tuple[str, ...] = ()
    """The parts of `machine_parts` without which it does not start."""
    engine: bool = False
    """Whether it is an engine, a stand-in for one, or a browser apart: `sssgen check` tells which of them are found."""
    apart: bool = False
    """Whether `make setup` leaves it out, so that its absence in CI is no failure."""
    default: bool = False
    """Whether it runs where no back end is named: one for each compiler, and NumPy."""


_GL = f"`{install_hint('gl')}` and a driver (Debian, without a GPU: `libegl1 libgl1 libgl1-mesa-dri`)"
_SPIRV = "spirv-val and spirv-cross (Debian: `spirv-tools spirv-cross`)"
_DXC = f"as `gl`, `{install_hint('dxc')}`, {_SPIRV}"
_GLSLANG = f"as `gl`, `glslangValidator` (Debian: `glslang-tools`), {_SPIRV}"
_NUMPY = f"`{install_hint('numpy')}`"

_GODOT = "Godot 4.6 (`make engines`, or `SSSGEN_GODOT` names the program)"


def _page(
    target: str, title: str, package: str, part: str, renderers: Mapping[str, tuple[str, str]]
) -> Iterator[BackendRecord]:
    """The back ends of an engine of the web: a suffix of the name → the renderer's title and name."""
    install = f"`{install_hint('browser')}`, Chromium or Chrome (Debian: `chromium`), the npm package `{package}`"
    for suffix, (renderer, name) in renderers.items():
        yield BackendRecord(
            target + suffix,
            f"{title}: {renderer}, in a headless Chromium",
            target,
            "engine_backend:PageBackend",
            install,
            {"renderer": name},
            scenes_only=True,
            parts=("pip browser", "chromium", part),
            engine=True,
        )


_RECORDS = (
    BackendRecord(
        "numpy", "the oracle: NumPy in float64", "numpy", "numpy_reference:Reference", _NUMPY, {"dtype": "float64"},
        bits=64, half="numpy-f16", driver=False, parts=("pip numpy",),
    ),
    BackendRecord(
        "numpy-f32", "the same in float32", "numpy", "numpy_reference:Reference", _NUMPY, {"dtype": "float32"},
        driver=False, default=True, parts=("pip numpy",),
    ),
    BackendRecord(
        "numpy-f16", "the same in float16", "numpy-f16", "numpy_reference:Reference", _NUMPY, {"dtype": "float16"},
        bits=16, driver=False, parts=("pip numpy",),
    ),
    BackendRecord("gl", "GLSL 3.30 in OpenGL", "glsl-330", "opengl:OpenGL", _GL, default=True, parts=("pip gl",)),
    BackendRecord("gl-es", "GLSL ES 3.00 in OpenGL", "glsl-es-300", "opengl:OpenGL", _GL, parts=("pip gl",)),
    BackendRecord(
        "webgpu", "WGSL through naga, in wgpu", "wgsl", "webgpu:WebGPU",
        f"`{install_hint('webgpu')}` and Vulkan or Metal (Debian, without a GPU: `mesa-vulkan-drivers libvulkan1`)",
        half="webgpu-f16", default=True, parts=("pip webgpu",),
    ),
    BackendRecord(
        "webgpu-f16", "the same in half precision", "wgsl-f16", "webgpu:WebGPU",
        "as `webgpu`, and an adapter with the feature shader-f16, which Mesa's lavapipe has", bits=16,
        functions_only=True, parts=("pip webgpu",),
    ),
    BackendRecord(
        "browser", "WGSL through Tint, in a headless Chromium", "wgsl", "browser:Browser",
        f"`{install_hint('browser')}` and Chromium or Chrome (Debian: `chromium`)", default=True,
        parts=("pip browser", "chromium"),
    ),
    BackendRecord(
        "firefox", "WGSL through naga, in a headless Firefox", "wgsl", "browser:Browser",
        f"`{install_hint('browser')}`, Firefox (Debian: `firefox-esr`) and Vulkan", {"program": "firefox"},
        parts=("pip browser", "firefox"), engine=True, apart=True,
    ),
    BackendRecord(
        "hlsl", "HLSL through DXC and SPIR-V, in OpenGL", "hlsl", "hlsl_spirv:HLSL", _DXC, {"compiler": "dxc"},
        default=True, parts=("pip gl", "pip dxc", "spirv"),
    ),
    BackendRecord(
        "hlsl-glslang", "HLSL through glslang and SPIR-V, in OpenGL", "hlsl", "hlsl_spirv:HLSL", _GLSLANG,
        {"compiler": "glslang"}, parts=("pip gl", "glslang", "spirv"),
    ),
    BackendRecord(
        "unity", "Unity's built-in pipeline: preprocessed, through glslang and SPIR-V, in OpenGL", "unity-builtin",
        "unity_backend:UnityHLSL", "as `hlsl-glslang`, and a C preprocessor (Debian: `gcc`)", {"compiler": "dx9"},
        parts=("pip gl", "glslang", "spirv", "c preprocessor"),
    ),
    BackendRecord(
        "unity-urp", "Unity's URP: preprocessed, through DXC and SPIR-V, in OpenGL", "unity-urp",
        "unity_backend:UnityHLSL", "as `hlsl`, and a C preprocessor (Debian: `gcc`)", {"compiler": "dxc"},
        parts=("pip gl", "pip dxc", "spirv", "c preprocessor"),
    ),
    BackendRecord(
        "bevy", "functions for Bevy: WESL, linked by npm wesl, then through naga, in wgpu", "bevy",
        "bevy_backend:BevyWGSL", "as `webgpu`, node and the npm packages `webgpu` and `wesl`",
        functions_only=True, parts=("pip webgpu", "node", "npm webgpu", "npm wesl"), engine=True,
    ),
    BackendRecord(
        "unreal", "functions for Unreal: behind a stand-in for the engine, through DXC and SPIR-V, in OpenGL", "unreal",
        "unreal_backend:UnrealHLSL", "as `hlsl`", {"compiler": "dxc"}, functions_only=True,
        parts=("pip gl", "pip dxc", "spirv"), engine=True,
    ),
    BackendRecord(
        "metal", "Metal on the processor: g++ with a stand-in for Metal's library", "metal", "metal_backend:MetalOnCpu",
        "`g++` (Debian: `g++`)", driver=False, parts=("pip numpy", "g++"), engine=True,
    ),
    *_page("threejs", "three.js", "three", "npm three", {
        "": ("WebGPURenderer", "webgpu"), "-webgl": ("WebGLRenderer", "webgl"),
        "-webgl2": ("WebGPURenderer on WebGL 2", "webgl2"),
    }),
    *(
        BackendRecord(
            f"tsl{suffix}", f"TSL: three.js, {title}, in a headless Chromium", "tsl", "tsl_backend:TslBackend",
            f"`{install_hint('browser')}`, Chromium or Chrome (Debian: `chromium`), the npm package `three`",
            {"renderer": renderer}, functions_only=True, parts=("pip browser", "chromium", "npm three"), engine=True,
        )
        for suffix, title, renderer in (
            ("", "WebGPURenderer", "webgpu"), ("-webgl2", "WebGPURenderer on WebGL 2", "webgl2"),
        )
    ),
    *_page("babylonjs", "Babylon.js", "@babylonjs/core", "babylon bundle", {
        "": ("WebGPU", "webgpu"), "-webgl": ("WebGL 2", "webgl"),
    }),
    *_page("playcanvas", "PlayCanvas", "playcanvas", "npm playcanvas", {
        "": ("WebGPU", "webgpu"), "-webgl2": ("WebGL 2", "webgl2"),
    }),
    *(
        BackendRecord(
            f"godot{suffix}", f"Godot, {title}", "godot", "engine_backend:GodotBackend", _GODOT,
            {"renderer": renderer}, scenes_only=True, parts=("pip numpy", "godot"), engine=True, apart=True,
        )
        for suffix, title, renderer in (
            ("", "Forward+", "forward_plus"), ("-mobile", "Mobile", "mobile"),
            ("-compatibility", "Compatibility", "gl_compatibility"),
        )
    ),
)  # fmt: skip

BACKENDS = {record.name: record for record in _RECORDS}
ENGINES = tuple(record.name for record in _RECORDS if record.engine)
"""Engines, the stand-ins for engines, and a browser that is found apart."""
FUNCTIONS = tuple(record.name for record in _RECORDS if not record.scenes_only)
"""Those that evaluate functions."""
SCENES = tuple(record.name for record in _RECORDS if not record.functions_only)
"""Those that draw scenes."""
SINGLE = tuple(name for name in FUNCTIONS if BACKENDS[name].bits == 32)
"""Those that compute in float32."""
HALF = tuple(record.name for record in _RECORDS if record.bits == 16)
DRIVERS = tuple(name for name in SINGLE if BACKENDS[name].driver)
"""Those that compute in float32 in a driver."""
DEFAULT = tuple(record.name for record in _RECORDS if record.default)
PREFERRED = "gl"
"""The one where a single back end is needed and none is named."""


def backend_names(text: str, scenes: bool = False) -> list[str]:
    """The back ends that `NAME,NAME` names, each once: of those that draw scenes, or of those that evaluate functions.

    Raises SssgenError for others.
    """
    names = list(dict.fromkeys(name.strip() for name in text.split(",")))
    possible = SCENES if scenes else FUNCTIONS
    for name in names:
        if name not in BACKENDS:
            raise unknown(name, possible)
        if scenes:
            check_draws(name)
        if BACKENDS[name].scenes_only and not scenes:
            raise failure(f"{name} draws scenes and evaluates no functions", f"choose from: {', '.join(FUNCTIONS)}")
    return names


def unknown(name: str, possible: Collection[str]) -> SssgenError:
    """The error for a name that no back end has; the hint names those that are possible."""
    hint = did_you_mean(name, possible) or f"choose from: {', '.join(possible)}"
    return failure(f"unknown back end '{name}'", hint)


def check_draws(name: str) -> None:
    """Raises SssgenError for a back end that draws no scenes."""
    if name in BACKENDS and BACKENDS[name].functions_only:
        raise failure(f"{name} evaluates functions and draws no scenes", f"choose from: {', '.join(SCENES)}")


def half_counterparts(names: list[str]) -> list[str]:
    """The counterparts of those back ends in half precision. Raises SssgenError for one that has none."""
    for name in names:
        if name not in HALF and not BACKENDS[name].half:
            counterparts = " or ".join(record.name for record in _RECORDS if record.half)
            raise failure(f"{name} does not compute in half precision", f"--backend {counterparts}")
    return list(dict.fromkeys(BACKENDS[name].half or name for name in names))
