"""The parameters and textures of a program as templates see them, and their names as an engine's properties."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from sssgen.ir.frame_passes import FRAME_PASSES, VOLUMES, passes_of
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, spell
from sssgen.support.diagnostics import failure
from sssgen.targets.descriptor import Target
from sssgen.targets.printers.printer import Printer

_DEFAULTS = {"default_white": "white", "default_black": "black", "default_gray": "gray", "default_bump": "bump"}


def uniform_variables(printer: Printer, uniform: Uniform, source: str) -> dict[str, Any]:
    """The facts about a parameter; `source` is its technique's own name for it."""
    _, limits = hint_of(uniform, "hint_range")
    return {
        "name": uniform.name,
        "source_name": source,
        "type": printer.type(uniform.type),
        "base": spell(uniform.type),
        "property": property_name(printer.target, source),
        "default": list(uniform.default),
        "range": (*limits, None)[:3] if limits else None,
        "placed": any(name == "placed" for name, _ in uniform.hints),
        "unit": (hint_of(uniform, "unit")[1] or ("",))[0],
        "hint": hint_of(uniform, "source_color")[0],
        "doc": " ".join(uniform.doc.split()),
        "label": source.replace("_", " ").capitalize(),
    }


def texture_variables(printer: Printer, uniform: Uniform, type_: Sampler, source: str, index: int) -> dict[str, Any]:
    """The facts about a texture, the `index`-th one; `source` is its technique's own name for it."""
    return {
        "name": uniform.name,
        "source_name": source,
        "property": property_name(printer.target, source),
        "sampler": printer.sampler(uniform.name),
        "type": printer.type(type_),
        "sampler_type": printer.sampler_type(type_),
        "dim": type_.dim + "Array" * type_.array,
        "default": _DEFAULTS.get(hint_of(uniform, *_DEFAULTS)[0], "white"),
        "hint": hint_of(uniform, "normal_map")[0] or hint_of(uniform, "source_color")[0],
        "wrap": "clamp" if hint_of(uniform, "repeat_disable")[0] else "repeat",
        "doc": " ".join(uniform.doc.split()),
        "label": source.replace("_", " ").capitalize(),
        "holds": uniform.quantity,
        "drawn": (hint_of(uniform, "drawn")[1] or ("",))[0],
        "binding": 1 + 2 * index,
        "sampler_binding": 2 + 2 * index,
    }


def pass_variables(target: Target, uniforms: Iterable[Uniform], sources: Mapping[str, str]) -> list[dict[str, Any]]:
    """The passes that the engine's runtime runs, with the engine's properties and the names in its text.

    `sources` are the techniques' own names.
    """

    def of(uniform: Uniform) -> str:
        return property_name(target, sources.get(uniform.name, uniform.name))

    return [
        {
            "name": use.name, "seen_from": drawn.seen_from, "layers": list(drawn.layers), "empty": drawn.empty,
            "texture": of(use.texture), "views": [of(view) for view in use.views],
            "texture_uniform": use.texture.name, "view_uniforms": [view.name for view in use.views],
            "lights_uniform": use.lights.name if use.lights else None,
            "size": of(use.size) if use.size else None,
        }
        for use in passes_of(uniforms)
        for drawn in [FRAME_PASSES[use.name]]
        if (drawn.of != "surroundings" and use.name not in VOLUMES) or target.drawer(use.name)
    ]  # fmt: skip


def check_properties(target: Target, names: Iterable[str]) -> None:
    """Raises SssgenError for names of parameters that would be one property of the engine's object."""
    if target.properties.style == "plain" and not target.properties.taken:
        return
    sources: dict[str, str] = {}
    for source in names:
        name = property_name(target, source)
        if name in sources:
            message = f"'{sources[name]}' and '{source}' would both be the property '{name}' in {target.title}"
            raise failure(message, "rename one of them in its technique")
        sources[name] = source


def property_name(target: Target, name: str) -> str:
    """The name of a parameter as a property of the engine's object."""
    if target.properties.style == "plain":
        return f"sss_{name}" if name in target.properties.taken else name
    name = _camel(name)
    return _camel(f"sss_{name}") if name in target.properties.taken else name


def _camel(name: str) -> str:
    """`cellCount` for `cell_count`."""
    first, *others = name.split("_")
    return first + "".join([word[:1].upper() + word[1:] for word in others])


def hint_of(uniform: Uniform, *names: str) -> tuple[str, tuple[Any, ...]]:
    """The first hint of these names, and its arguments; '' where a uniform has none of them."""
    for name, args in uniform.hints:
        if name in names:
            return name, args
    return "", ()
