"""The text of a material's file, from its stages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from numbers import Integral, Real
from typing import Any, NamedTuple


class MaterialSection(NamedTuple):
    """A stage of a chain, as a section of a material file."""

    section: str
    technique: str
    values: tuple[tuple[str, object], ...] = ()
    """Its parameters"""
    fixed: tuple[str, ...] = ()
    """The parameters that are constants in the emitted text"""
    bind: tuple[tuple[str, str], ...] = ()
    """Slot → function"""
    comment: str = ""
    """A line above the section"""
    levels: tuple[int, ...] = ()
    """The levels of detail that it belongs to; () for all of them"""


def material_text(
    name: str,
    stages: Sequence[MaterialSection],
    title: str = "",
    doc: str = "",
    settings: Mapping[str, object] | None = None,
) -> str:
    """The material file of a chain; `settings` are further keys of its section [material]."""
    keys = {"name": name, "title": title, "doc": doc, **(settings or {})}
    lines = ["[material]", *(f"{key} = {toml_value(value)}" for key, value in keys.items() if value != "")]
    for stage in stages:
        lines += ["", *stage_lines(stage)]
    return "\n".join(lines) + "\n"


def stage_lines(stage: MaterialSection) -> list[str]:
    """The lines of a stage in a material file."""
    lines = [f"# {stage.comment}"] if stage.comment else []
    lines += [f"[[{stage.section}]]", f"technique = {toml_value(stage.technique)}"]
    if stage.levels:
        lines.append(f"level = {toml_value(stage.levels if len(stage.levels) > 1 else stage.levels[0])}")
    if stage.bind:
        lines.append(f"bind = {{ {', '.join(f'{slot} = {toml_value(to)}' for slot, to in stage.bind)} }}")
    for key, value in stage.values:
        text = toml_value(value)
        lines.append(f"{key} = {{ value = {text}, fixed = true }}" if key in stage.fixed else f"{key} = {text}")
    return lines


def toml_value(value: Any) -> str:
    """A value in TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", " ")
        return f'"{escaped}"'
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        text = f"{float(value):.6g}"
        return text if any(mark in text for mark in ".en") else f"{text}.0"
    return f"[{', '.join(toml_value(part) for part in value)}]"
