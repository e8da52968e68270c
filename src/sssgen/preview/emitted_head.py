"""What a page shows of a material and that follows from its text alone: the module, the parameters, the texture slots.

It needs no NumPy, so that it is made anew for each edit, also where a browser runs Python.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, NotRequired, TypedDict

from sssgen.ir.frame_passes import FRAME_PASSES
from sssgen.material.medium_look import REPLACED
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled
from sssgen.targets.reflection_record import TextureRecord, UniformRecord

TARGET = "threejs"
DRAWN_BY_PAGE = tuple(name for name, drawn in FRAME_PASSES.items() if drawn.of == "body")
"""The passes that the material's own runtime runs; other textures are made once, for the scene's own light."""
PARTS = ("name", "title", "module", "controls", "textures", "two_sided", "lamp_passes", "cost")
"""The parts of a head that `emitted_head` makes."""


class Control(TypedDict):
    """A parameter that a person may change, with what a control needs to know; it is JSON for the page."""

    property: str
    technique: str
    name: str
    label: str
    doc: str
    type: str
    range: list[float] | None
    unit: str | None
    color: bool
    channels: str
    """The names of its components, a letter each; '' for a number and a matrix"""
    look: str
    """The key of the medium's look that it follows from, or ''"""
    default: list[float]
    value: list[float]
    drawn: str | None
    placed: bool
    """Whether the object places it, so that a person need not set it"""
    in_scene: bool


class Slot(TypedDict):
    """A texture that a person may replace; it is JSON for the page."""

    property: str
    source_name: str
    technique: str
    name: str
    type: str
    color: bool
    doc: str
    drawn: str
    page_draws: bool
    """Whether the page draws it for each frame"""
    chosen: NotRequired[str]
    """The name of the file that a person chose, or ''"""
    texels: NotRequired[dict[str, Any]]
    """The levels, as `picture.texels_of` gives them"""


def emitted_head(
    material: Material, compiled: Compiled, values: Mapping[str, Sequence[float]], in_scene: Collection[str]
) -> dict[str, Any]:
    """The part of a picture's head for a material that is compiled for `TARGET`.

    `values` are the parameters that the scene gives, baked files among them; `in_scene` are those that a scene's file
    sets.
    """
    reflection = compiled.reflection
    return {
        "name": material.name,
        "title": material.title,
        "module": next(text for name, text in compiled.files.items() if name.endswith(".js")),
        "controls": controls(reflection["uniforms"], values, in_scene),
        "textures": [slot(texture, texture["property"], texture["drawn"] or "") for texture in reflection["textures"]],
        "two_sided": reflection["two_sided"],
        "lamp_passes": [
            {"seen_from": drawn["seen_from"], "views": len(drawn["views"])}
            for drawn in reflection["passes"]
            if drawn["of"] == "body" and drawn["views"] and drawn["seen_from"] != "eye"
        ],
        "cost": {kind: entry["cost"] for kind, entry in reflection["entries"].items()},
    }


def slot(texture: TextureRecord, name: str, drawn: str = "") -> Slot:
    """A texture of a reflection, without its texels; `name` is its property on the page."""
    return {
        "property": name,
        "source_name": texture["source_name"],
        "technique": texture["technique"],
        "name": texture["technique_name"],
        "type": texture["type"],
        "color": texture["color"],
        "doc": texture["doc"],
        "drawn": drawn,
        "page_draws": drawn in DRAWN_BY_PAGE,
    }


def controls(
    uniforms: Sequence[UniformRecord], values: Mapping[str, Sequence[float]], in_scene: Collection[str]
) -> list[Control]:
    """The parameters that a person may change."""
    return [
        {
            "property": uniform["property"],
            "technique": uniform["technique"],
            "name": uniform["technique_name"],
            "label": uniform["source_name"],
            "doc": uniform["doc"],
            "type": uniform["type"],
            "range": uniform["range"],
            "unit": uniform["unit"],
            "color": uniform["color"],
            "channels": channels(uniform),
            "look": look_of(uniform, uniforms),
            "default": [float(number) for number in uniform["default"]],
            "value": [float(number) for number in values.get(uniform["source_name"], uniform["default"])],
            "drawn": uniform["drawn"],
            "placed": uniform["placed"],
            "in_scene": uniform["source_name"] in in_scene,
        }
        for uniform in uniforms
    ]


def channels(uniform: UniformRecord) -> str:
    """The names of a vector's components: those of a colour, of a place, or of texture coordinates.

    Three numbers in world units are a place, unless they are a length for each channel of the light.
    """
    count = {"vec2": 2, "vec3": 3, "vec4": 4}.get(uniform["type"], 0)
    if uniform["color"]:
        return "RGBA"[:count]
    if count == 2:
        return "uv" if uniform["technique_name"].startswith("uv") else "xy"
    place = uniform["unit"] in ("m", "") or uniform["unit"] is None
    if count == 3:
        return "xyz" if place and "channel" not in uniform["doc"] else "RGB"
    return "1234"[:count]


def look_of(uniform: UniformRecord, uniforms: Sequence[UniformRecord]) -> str:
    """The key of the medium's look that a parameter follows from, in a technique that takes it; or ''."""
    own = {other["technique_name"] for other in uniforms if other["technique"] == uniform["technique"]}
    return next((key for key, names in REPLACED.items() if uniform["technique_name"] in names and key not in own), "")


def follows(control: Control) -> bool:
    """Whether a parameter follows from a key of the medium's look that stands for another one."""
    return bool(control["look"]) and REPLACED[control["look"]][0] != control["name"]
