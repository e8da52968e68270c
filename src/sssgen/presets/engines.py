"""The engines for which `sssgen use` writes a project; a module of its own, as errors list them."""

from __future__ import annotations

from typing import NamedTuple

_SERVE = "`python3 -m http.server` in this folder, then http://localhost:8000 in a browser"


class Engine(NamedTuple):
    """What a project of a target is."""

    title: str
    opened: str
    """How it is opened; "this folder" is that of the project, NAME the preset"""
    is_page: bool = False
    """Whether a browser opens it, which needs a server"""
    shader: str = ""
    """The target of its shaders, where it has another name"""
    shell: tuple[str, ...] = ()
    """What is added to the shell of its shaders, as for `sssgen emit --shell`"""
    package: str = ""
    """The package of npm that the page needs beside it"""
    has_folders: bool = False
    """Whether each preset has a folder of its name, beside one for what all presets share"""
    shows_rest: bool = False
    """Whether the project shows the parts of a glTF file that have other materials"""


ENGINES = {
    "threejs": Engine("three.js", f"{_SERVE}.", is_page=True, shows_rest=True),
    "babylonjs": Engine(
        "Babylon.js", f"`npm install`, then {_SERVE}.", is_page=True, package="@babylonjs/core", shows_rest=True,
    ),
    "playcanvas": Engine(
        "PlayCanvas", f"`npm install`, then {_SERVE}.", is_page=True, package="playcanvas", shows_rest=True,
    ),
    "webgpu": Engine(
        "WebGPU without an engine", f"{_SERVE} that has WebGPU.", is_page=True, shader="wgsl",
        shell=("shadow=shadow_map", "environment=prefiltered_environment", "tone_mapping=khronos_neutral"),
    ),
    "godot": Engine(
        "Godot 4", "import `project.godot` of this folder in Godot's project manager, and press F5.", shows_rest=True,
    ),
    "unity-urp": Engine(
        "Unity 2021.2 or later, with URP",
        "put the folders `Sssgen` and `NAME` into `Assets` of a project with URP, and choose the menu *Sssgen*. It was "
        "compiled and checked, but not run in the Unity editor.", has_folders=True,
    ),
    "gltf": Engine("glTF", "drag `NAME.glb` of this folder into a viewer that knows Khronos' extensions of volumes."),
}  # fmt: skip
"""Target → its project."""
