"""Whether a target has the textures of a program; a clear error for each that it lacks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sssgen.ir.nodes import Span, Uniform
from sssgen.ir.types import Sampler, spell
from sssgen.support.diagnostics import Diagnostic, UnsupportedError
from sssgen.targets.descriptor import Target


def check_textures(target: Target, uniforms: Sequence[Uniform], source: Callable[[Span], str]) -> None:
    """Raises UnsupportedError for the textures that an engine with channels of its own cannot supply.

    `source` returns the line of source that a span begins on.
    """
    if not target.channels:
        return
    textures = [uniform for uniform in uniforms if isinstance(uniform.type, Sampler)]
    wrong: list[Diagnostic] = []

    def refuse(texture: Uniform, message: str, hint: str) -> None:
        wrong.append(Diagnostic("error", message, texture.span, hint, source(texture.span)))

    for texture in textures:
        lacks = f"{target.title} cannot supply '{texture.name}'"
        if any(name == "drawn" for name, _ in texture.hints):
            refuse(texture, f"{lacks}: no program draws it there", _INSTEAD)
        elif spell(texture.type) not in target.types:
            refuse(texture, f"{lacks}: it has no {spell(texture.type)}", _INSTEAD)
    if len(textures) > len(target.channels) and not wrong:
        names = ", ".join(texture.name for texture in textures)
        message = f"{target.title} has {len(target.channels)} textures, the material reads {len(textures)}: {names}"
        refuse(textures[len(target.channels)], message, "leave out a technique that reads a texture")
    if wrong:
        raise UnsupportedError(wrong)


_INSTEAD = "choose a technique that does not read it, or another target"
