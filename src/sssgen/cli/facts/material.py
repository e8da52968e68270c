"""`sssgen show MATERIAL`: its chain with all parameters, what it requires and costs, the targets that refuse it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.cli.layout import wrap
from sssgen.ir.types import Sampler
from sssgen.material.material_loading import examples, load_material
from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import DESCRIPTIONS, read_uniforms, requirements
from sssgen.material.technique_facts import uniform_facts, uniform_text, value_text
from sssgen.passes.cost import Cost
from sssgen.pipeline.compiler import all_targets, compile
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import posix
from sssgen.targets.reflection_record import PassRecord, Reflection

names = examples
"""The example materials."""


def describe(name: str) -> dict[str, Any]:
    """Everything about an example material, or about that of a .toml file. Raises SssgenError."""
    material = load_material(name)
    refused, reflection = _compile_for_all(material)
    uniforms, entries = (reflection["uniforms"], reflection["entries"]) if reflection else ([], {})
    values = {uniform["source_name"]: uniform["default"] for uniform in uniforms}
    costs = {entry["function"]: _cost(Cost(**entry["cost"])) for entry in entries.values()}
    return {
        "name": material.name,
        "title": material.title,
        "summary": material.doc,
        "shading": material.shading,
        "alpha_mode": material.alpha_mode,
        "two_sided": material.two_sided,
        "levels": material.levels,
        "stages": [_stage(use, values) for use in material.stages],
        "requires": list(requirements(material.stages)),
        "passes": reflection["passes"] if reflection else [],
        "cost": costs,
        "refused": refused,
        "file": posix(material.file),
    }


def _stage(use: TechniqueUse, values: Mapping[str, Any]) -> dict[str, Any]:
    """A stage; `values` are those of the shader's parameters, which stages share by their names."""
    uniforms = list(read_uniforms(use))
    parameters = []
    for uniform in uniforms:
        if not isinstance(uniform.type, Sampler):
            own = uniform_facts(uniform._replace(default=use.values.get(uniform.name, uniform.default)))
            own["value"] = values.get(uniform.name, own.pop("default"))
            parameters.append({**own, "fixed": uniform.name in use.fixed})
    textures = [
        {**uniform_facts(uniform), "picture": use.textures.get(uniform.name, "")}
        for uniform in uniforms
        if isinstance(uniform.type, Sampler)
    ]
    return {
        "role": use.technique.role,
        "technique": use.technique.name,
        "summary": use.technique.doc.get("summary", ""),
        "uv": use.uv,
        "levels": list(use.levels),
        "parameters": parameters,
        "textures": textures,
        "slots": {slot: binding.function.name for slot, binding in use.bindings.items()},
    }


def _compile_for_all(material: Material) -> tuple[dict[str, dict[str, str]], Reflection | None]:
    """The targets that refuse the material, with the reason and the hint; and the reflection of the first other target.

    The values and the cost in it are the same for all: they are counted before the program is rewritten for one target.
    """
    refused: dict[str, dict[str, str]] = {}
    reflection: Reflection | None = None
    for target in all_targets():
        try:
            compiled = compile(material, target)
        except SssgenError as error:
            first = error.diagnostics[0]
            refused[target] = {"message": first.message, "help": first.hint}
        else:
            reflection = reflection or compiled.reflection
    return refused, reflection


def _cost(cost: Cost) -> dict[str, int]:
    return {**cost._asdict(), "weight": cost.weight}


def lines(facts: Mapping[str, Any], width: int) -> list[str]:
    """The facts as text."""
    sides = "front and back faces" if facts["two_sided"] else "front faces"
    text = [
        f"{facts['name']} (material): {facts['title']}",
        *wrap(facts["summary"], width, "  ", "  "),
        "",
        f"  {facts['shading']}, alpha: {facts['alpha_mode']}, {sides}",
        "",
        "chain, in the order it runs:",
    ]
    column = max(len(stage["role"]) for stage in facts["stages"])
    for stage in facts["stages"]:
        uv = "" if stage["uv"] == "uv" else f", with {stage['uv']}"
        level = f", level {', '.join(map(str, stage['levels']))}" if stage["levels"] else ""
        text.append(f"  {stage['role']:{column}}  {stage['technique']}{uv}{level}")
        for row in (*map(_parameter, stage["parameters"]), *map(_texture, stage["textures"])):
            text += wrap(row, width, "      ", "          ")
        text += [f"      {slot} = {function}" for slot, function in stage["slots"].items()]
    needed = [f"{name} ({DESCRIPTIONS[name]})" for name in facts["requires"]]
    text += ["", *wrap(f"requires: {', '.join(needed) or 'nothing besides its parameters'}", width, "", "  ")]
    if facts["passes"]:
        text += ["", "passes, which the engine's runtime or the program runs before it draws the material:"]
        for row in map(_pass, facts["passes"]):
            text += wrap(row, width, "  ", "      ")
    if facts["cost"]:
        text += ["", "cost, in operations, counted before the target's compiler optimises:"]
        longest = max(map(len, facts["cost"]))
        text += [
            f"  {function:{longest}}  {Cost(*[cost[kind] for kind in Cost._fields]).text}"
            for function, cost in facts["cost"].items()
        ]
    count = len(all_targets()) - len(facts["refused"])
    text += ["", f"targets: {count}" + (", all but:" if facts["refused"] else ", which are all")]
    for target, why in facts["refused"].items():
        reason = why["message"] + (f" ({why['help']})" if why["help"] else "")
        text += wrap(f"{target}: {reason}", width, "  ", "      ")
    return [*text, "", f"file: {facts['file']}", "a technique in detail: sssgen show TECHNIQUE"]


def _pass(record: PassRecord) -> str:
    layers = f", {', '.join(record['layers'])}" if record["layers"] else ""
    views = f", in the view {', '.join(record['views'])}" if record["views"] else ""
    return f"{record['name']}: the {record['of']} from {record['seen_from']}{layers}; to {record['texture']}{views}"


def _parameter(parameter: Mapping[str, Any]) -> str:
    about = uniform_text({**parameter, "aliases": ()})
    fixed = ", fixed" if parameter["fixed"] else ""
    return f"{parameter['name']} = {value_text(parameter['value'])}: {about}{fixed}"


def _texture(texture: Mapping[str, Any]) -> str:
    about = uniform_text({**texture, "aliases": ()})
    return f"{texture['name']}: {about}" + (f", {texture['picture']}" if texture["picture"] else "")
