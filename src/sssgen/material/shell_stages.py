"""Materials with other stages for shells without an engine than their files have: `--shell ROLE=TECHNIQUE`."""

from __future__ import annotations

from collections.abc import Sequence

from sssgen.ir.nodes import Span
from sssgen.material import roles
from sssgen.material.library import OF_SHELLS, folder_of, index, load
from sssgen.material.model import Material, TechniqueUse
from sssgen.support.diagnostics import did_you_mean, failure

NONE = "none"
"""In place of a technique: the material's own stages of the role are left out."""


def with_shell(material: Material, options: Sequence[str]) -> Material:
    """The material whose stages of some roles are those of the options. Raises SssgenError for a wrong option.

    An option is `ROLE=TECHNIQUE`; the technique's parameters have its own defaults. A later option of the same role
    replaces an earlier one.
    """
    chosen = dict(_parse(option) for option in options)
    stages = [stage for stage in material.stages if stage.technique.role not in chosen]
    for name in chosen.values():
        if name != NONE:
            technique = load(name)
            stages.append(TechniqueUse(technique, {}, frozenset(), {}, {}, technique.function.span))
    order = {role: number for number, section in enumerate(roles.SECTIONS) for role in roles.allowed_roles(section)}
    stages.sort(key=lambda stage: order[stage.technique.role])
    links = [roles.Link(stage.technique, stage.span, stage.levels) for stage in stages]
    roles.check_levels(links, material.levels, material.shading, _refuse)
    return material._replace(stages=tuple(stages))


def choices(role: str) -> tuple[str, ...]:
    """The techniques of a role, and `NONE`."""
    return (*(technique for technique, path in index().items() if folder_of(path) == role), NONE)


def _parse(option: str) -> tuple[str, str]:
    role, _, name = option.partition("=")
    if role not in OF_SHELLS:
        raise failure(f"'{role}' is no part of a shell", did_you_mean(role, OF_SHELLS) or _choices_hint(OF_SHELLS))
    if name not in (names := choices(role)):
        hint = did_you_mean(name, names) or _choices_hint([f"{role}={choice}" for choice in names])
        raise failure(f"unknown technique '{name}' for {role}", hint)
    return role, name


def _choices_hint(words: Sequence[str]) -> str:
    return f"choose from: {', '.join(words)}"


def _refuse(_: Span, message: str, hint: str) -> None:
    raise failure(message, hint)
