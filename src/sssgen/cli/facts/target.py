"""`sssgen show TARGET`: its language, the files it writes, and what it lacks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.ir import signatures
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.surface_fields import OPTIONAL
from sssgen.material.library import OF_SHELLS
from sssgen.run.backend_registry import BACKENDS
from sssgen.run.compiler_registry import readers
from sssgen.targets import registry
from sssgen.targets.chain_inputs import CHAIN_INPUTS
from sssgen.targets.descriptor import OutputFile, Target

FORMS = {
    "shader": "files",
    "functions": "files of --form functions",
    "vertex": "file of a vertex shader from transpile",
    "fragment": "file of a fragment shader from transpile",
}
"""The forms in which a target is emitted, for people."""


names = registry.names
"""All targets, with those of plug-ins."""


def describe(name: str) -> dict[str, Any]:
    """Everything about a target. Raises SssgenError."""
    target = registry.load(name)
    return {
        "name": target.name,
        "title": target.title,
        "language": target.language,
        "dialect": target.dialect,
        "version": target.version,
        "files": {form: [_file(output) for output in files] for form, files in target.files.items()},
        "lighting": target.lighting,
        "shell": list(target.shell),
        "prefix": target.prefix,
        "lacks": _lacks(target),
        "compilers": _compilers(target),
        "backends": [backend.name for backend in BACKENDS.values() if backend.target == name],
        "also": list(target.also),
    }


def _compilers(target: Target) -> list[str]:
    """The compilers that read its files, or the text in them."""
    held = {inner for files in target.files.values() for output in files for inner in output.holds.values()}
    return list(dict.fromkeys(name for language in (target.name, *sorted(held)) for name in readers(language)))


def _file(output: OutputFile) -> dict[str, Any]:
    return {"name": output.name, "stages": list(output.stages), "holds": sorted(set(output.holds.values()))}


def _lacks(target: Target) -> dict[str, Any]:
    """What a material may have and the target does not: an error names the place, or the emitted text leaves it out."""
    missing = [name for name in CHAIN_INPUTS if name not in target.inputs and name not in ("surface", "color")]
    refused = [
        row.name
        for row in BUILTINS.values()
        if not row.polyfill and "" in signatures.texts(row.name, target.dialect).values()
    ]
    return {
        "values": {name: target.lacks[name] for name in OPTIONAL if name in target.lacks},
        "inputs": [name for name in missing if name not in target.light_inputs],
        "roles": [role for role in OF_SHELLS if role not in target.shell],
        "parameter_types": _others(target.types, target.parameter_types, texture=False),
        "texture_types": _others(target.types, target.texture_types, texture=True),
        "functions": refused,
    }


def _others(types: Collection[str], allowed: Collection[str], texture: bool) -> list[str]:
    """The types of the language that a parameter or a texture of a whole shader cannot have."""
    kind = [
        name for name in types if ("sampler" in name) == texture and name not in ("void", "sampler", "samplerShadow")
    ]
    return [name for name in kind if allowed and name not in allowed]


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    language = facts["language"] + (f", {facts['version']}" if facts["version"] else "")
    text = [*wrap(f"{facts['name']} (target): {facts['title']}", width, "", "  "), "", f"language: {language}"]
    for form, files in facts["files"].items():
        listed = ", ".join(_file_text(file) for file in files)
        text += wrap(f"{FORMS.get(form, form)}: {listed}", width, "", "  ")
    lighting = f"the technique {facts['lighting']}" if facts["lighting"] else "the engine's own"
    text.append(f"light of lit materials: {lighting}")
    if facts["prefix"]:
        text.append(f"names begin with: {facts['prefix']}")
    for title, key in (("compilers that read it", "compilers"), ("back ends that run it", "backends")):
        text += wrap(f"{title}: {', '.join(facts[key]) or 'none'}", width, "", "  ")
    return [
        *text,
        "",
        *_lacks_lines(facts["lacks"], width),
        "",
        f"emit for it: sssgen emit ice --target {facts['name']} -o out",
    ]


def _file_text(file: Mapping[str, Any]) -> str:
    inside = [*file["stages"], *file["holds"]]
    name: str = file["name"]
    return name.replace("{material}", "NAME").replace("{module}", "NAME") + (
        f" ({', '.join(inside)})" if inside else ""
    )


def _lacks_lines(lacks: Mapping[str, Any], width: int) -> list[str]:
    titles = {
        "inputs": "inputs of techniques",
        "roles": "roles that add to the shell",
        "parameter_types": "types of parameters",
        "texture_types": "types of textures",
        "functions": "builtins",
    }
    rows = [(f"{name}: {hint}") for name, hint in lacks["values"].items()]
    rows += [f"{title}: {', '.join(lacks[key])}" for key, title in titles.items() if lacks[key]]
    if not rows:
        return ["lacks: nothing that a material may have"]
    return ["lacks:", *(line for row in rows for line in wrap(row, width, "  ", "      "))]
