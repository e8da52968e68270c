"""What a page shows of a flat picture (plain GLSL, a material that makes its own rays) and follows from its text.

It needs no NumPy, as `emitted_head`, so that it is made anew for each edit, also where a browser runs Python.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from sssgen.ir.nodes import Function
from sssgen.ir.types import spell
from sssgen.lang.plain_glsl import GlslFile, load_glsl_text
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled, transpile
from sssgen.preview.emitted_head import controls, slot
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix, stem
from sssgen.support.text_files import read_text
from sssgen.targets.reflection_record import Reflection, UniformRecord

TARGET = "glsl-es-300"
PLAIN = (".glsl", ".frag", ".fs")
"""The suffixes of plain GLSL."""
PAGE_INPUTS: Mapping[str, tuple[str, ...]] = {
    "time": ("time", "iTime", "u_time", "uTime", "iGlobalTime"),
    "resolution": ("resolution", "iResolution", "u_resolution", "uResolution"),
    "mouse": ("mouse", "iMouse", "u_mouse", "uMouse"),
    "frame": ("frame", "iFrame", "u_frame"),
}
"""What the page gives → the names by which shaders ask for it."""
TYPES = {"time": ("float",), "resolution": ("vec2", "vec3"), "mouse": ("vec2", "vec4"), "frame": ("int", "float")}
BACKGROUND = [[0.1, 0.1, 0.1], [0.1, 0.1, 0.1]]
_ENTRY = re.compile(r"\bvoid\s+mainImage\s*\(")
_COLORS = {"float": "vec3({})", "vec2": "vec3({}, 0.0)", "vec3": "{}", "vec4": "{}.rgb"}
"""A function's result as a colour."""
_POINTS = {"vec2": "at", "vec3": "vec3(at, 0.0)"}
"""What a function is called with, by the type of its parameter."""
_WRAPPED = """
void mainImage(out vec4 shown, in vec2 pixel) {{
    vec2 at = 4.0 * (pixel - 0.5 * iResolution.xy) / iResolution.y;
    shown = vec4({color}, 1.0);
}}
"""
_VERTEX = """#version 300 es
{outputs}
void main() {{
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
{values}
    gl_Position = vec4(corner, 0.0, 1.0);
}}
"""


def is_plain(name: str) -> bool:
    """Whether a name is that of a file of plain GLSL."""
    return name.lower().endswith(PLAIN)


def plain_head(path: str, guards: str) -> dict[str, Any]:
    """The head of plain GLSL: a fragment shader, `mainImage` as on Shadertoy, or a function of a place.

    Raises SssgenError for a faulty file, and for a kind of shader that needs more than one triangle.
    """
    file_name = posix(path)
    compiled, note = transpile_plain(path, TARGET, guards)
    reflection = compiled.reflection
    if reflection["form"] != "fragment":
        raise failure(f"this is a {reflection['form']} shader", "the page draws fragment shaders", file_name)
    for row in reflection["textures"]:
        if row["type"] != "sampler2D":
            raise failure(f"the shader reads '{row['name']}', a {row['type']}", "the page gives sampler2D only")
    head = _head(compiled, {}, ()) | {
        "name": stem(file_name),
        "title": note or os.path.basename(path),
        "saves": "the values are not part of a GLSL file: write them there as `uniform float x = 0.5;`",
    }
    head["flat"] |= {"vertex": _vertex(reflection, file_name), "start": 0.0, "plays": True}
    return head


def raymarched_head(
    material: Material, compiled: Compiled, values: Mapping[str, Sequence[float]], in_scene: Collection[str]
) -> dict[str, Any]:
    """The head of a material that makes its own rays, compiled for `TARGET`; see `emitted_head`."""
    head = _head(compiled, values, in_scene) | {"name": material.name, "title": material.title}
    head["flat"]["vertex"] = next(text for name, text in compiled.files.items() if name.endswith(".vert"))
    return head


def transpile_plain(path: str, target: str, guards: str) -> tuple[Compiled, str]:
    """A file of plain GLSL as a whole shader for a target, and what a wrapped function is. Raises SssgenError."""
    file_name = posix(path)
    loaded, note = _load(read_text(path, file_name), path, file_name)
    name = re.sub(r"\W", "_", stem(file_name), flags=re.ASCII)
    return transpile(loaded.module, target, f"file_{name}", guards, keep=True, head=loaded.head), note


def _head(compiled: Compiled, values: Mapping[str, Sequence[float]], in_scene: Collection[str]) -> dict[str, Any]:
    """The part of the head that both kinds have."""
    reflection = compiled.reflection
    given = {uniform["name"]: what for uniform in reflection["uniforms"] if (what := _page_input(uniform))}
    fragment = next(text for name, text in compiled.files.items() if name.endswith(".frag"))
    if "uniform float time;" in fragment:  # of the shell
        given["time"] = "time"
    own = [uniform for uniform in reflection["uniforms"] if uniform["name"] not in given and _settable(uniform["type"])]
    if any(uniform["source_name"] == "aspect" and uniform["technique"] for uniform in own):  # of a camera in the chain
        given.update({row["name"]: "aspect" for row in own if row["source_name"] == "aspect"})
        own = [row for row in own if row["source_name"] != "aspect"]
    rows: list[UniformRecord] = [{**uniform, "property": uniform["name"]} for uniform in own]
    return {
        "shape": "",
        "shapes": [""],
        "mesh": "",
        "flat": {"fragment": fragment, "given": given},
        "controls": controls(rows, values, in_scene),
        "textures": [slot(texture, texture["name"]) for texture in reflection["textures"]],
        "background": BACKGROUND,
        "exposure": 1.0,
        "lights": [],
        "saves": "",
        "cost": {kind: entry["cost"] for kind, entry in reflection["entries"].items()},
    }


def _page_input(uniform: UniformRecord) -> str:
    """What the page gives for a uniform of plain GLSL; '' for nothing."""
    if uniform["technique"]:
        return ""
    return next(
        (what for what, names in PAGE_INPUTS.items() if uniform["name"] in names and uniform["type"] in TYPES[what]), ""
    )


def _settable(type_: str) -> bool:
    return type_.partition("[")[0] == type_ and not type_.startswith("mat")


def _load(text: str, path: str, file_name: str) -> tuple[GlslFile, str]:
    """The module as a whole shader, and what a wrapped function is."""
    roots = (os.path.dirname(path) or ".",)
    if _ENTRY.search(text):
        return load_glsl_text(text, file_name, roots, entry="shadertoy"), ""
    loaded = load_glsl_text(text, file_name, roots)
    if any(function.name == "main" for function in loaded.module.functions):
        return loaded, ""
    called = [(one, call) for one in loaded.module.functions if one.span.file == file_name and (call := _call(one))]
    if not called:
        hint = "write void main() or void mainImage(out vec4, in vec2), or a function such as float noise(vec2 p)"
        raise failure("nothing in the file can be shown as a picture", hint, file_name)
    function, call = called[-1]
    wrapped = text.rstrip("\n") + "\n" + _WRAPPED.format(color=_COLORS[spell(function.result)].format(call))
    note = f"{function.name}({', '.join(spell(param.type) for param in function.params)}) around 0, ±2 high"
    return load_glsl_text(wrapped, file_name, roots, entry="shadertoy"), note


def _call(function: Function) -> str:
    """The call of a function of a place, and maybe of the time; '' where it has other parameters."""
    types = [spell(param.type) for param in function.params]
    if function.body is None or spell(function.result) not in _COLORS or not types or types[0] not in _POINTS:
        return ""
    if types[1:] not in ([], ["float"]) or any(param.direction != "in" for param in function.params):
        return ""
    arguments = [_POINTS[types[0]], *(["iTime"] if types[1:] else [])]
    return f"{function.name}({', '.join(arguments)})"


def _vertex(reflection: Reflection, file_name: str) -> str:
    """A vertex shader for one triangle that gives each two-component input the place in the picture."""
    inputs = [row for row in reflection["stage_inputs"] if not row["builtin"]]
    for row in inputs:
        if row["type"] != "vec2":
            hint = "the page gives a fragment shader a vec2 with the place in the picture, 0 to 1; no mesh is drawn"
            raise failure(f"the shader reads '{row['name']}', a {row['type']}", hint, file_name)
    outputs = "\n".join(f"out vec2 {row['name']};" for row in inputs)
    values = "\n".join(f"    {row['name']} = 0.5 * corner + 0.5;" for row in inputs)
    return _VERTEX.format(outputs=outputs, values=values)
