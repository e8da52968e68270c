"""Whether a target can carry the parameters and textures of a program; a clear error for each that it cannot."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from sssgen.ir.nodes import Span, Uniform
from sssgen.ir.types import Sampler, spell
from sssgen.support.diagnostics import Diagnostic, UnsupportedError
from sssgen.targets.descriptor import Target


def check_uniforms(
    target: Target,
    form: str,
    uniforms: Sequence[Uniform],
    names: Mapping[str, str],
    source: Callable[[Span], str],
    plain: bool = False,
) -> None:
    """Raises UnsupportedError for the parameters and textures that the target cannot supply to a program of this form.

    `names` has the author's name of each uniform; `source` returns the line of source that a span begins on; `plain`
    is whether the program is plain GLSL, which has no techniques.
    """
    wrong: list[Diagnostic] = []

    def refuse(uniform: Uniform, message: str, hint: str = _PLAIN if plain else _INSTEAD) -> None:
        wrong.append(Diagnostic("error", message, uniform.span, hint, source(uniform.span)))

    textures = [uniform for uniform in uniforms if isinstance(uniform.type, Sampler)]
    for texture in textures:
        lacks = f"{target.title} cannot supply '{names.get(texture.name, texture.name)}'"
        if target.channels and any(name == "drawn" for name, _ in texture.hints):
            refuse(texture, f"{lacks}: no program draws it there")
        elif spell(texture.type) not in target.types:
            refuse(texture, f"{lacks}: it has no {spell(texture.type)}")
        elif form == "shader" and target.texture_types and spell(texture.type) not in target.texture_types:
            refuse(texture, f"{lacks}: its materials set no {spell(texture.type)}", f"{_INSTEAD}, or --form functions")
    if target.channels and len(textures) > len(target.channels) and not wrong:
        read = ", ".join(names.get(texture.name, texture.name) for texture in textures)
        message = f"{target.title} has {len(target.channels)} textures, the material reads {len(textures)}: {read}"
        refuse(textures[len(target.channels)], message, "leave out a technique that reads a texture")
    if form == "shader" and target.parameter_types:
        for uniform in uniforms:
            if uniform not in textures and spell(uniform.type) not in target.parameter_types:
                name = names.get(uniform.name, uniform.name)
                refuse(
                    uniform,
                    f"'{name}' cannot be a parameter in {target.title}: its type is {spell(uniform.type)}",
                    _CONSTANT,
                )
    if wrong:
        raise UnsupportedError(wrong)


_INSTEAD = "choose a technique that does not read it, or another target"
_PLAIN = "read a texture of another type, or choose another target"
_CONSTANT = "make it a constant of the technique, split it into several parameters, or choose --form functions"
