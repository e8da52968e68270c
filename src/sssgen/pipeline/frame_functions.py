"""The functions that a target's frame calls: those of `shells/`, and `safe_normalize`, the guard of `normalize`."""

from __future__ import annotations

import os

from sssgen.ir.formats import Format
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Function, Module, Uniform
from sssgen.ir.surface_fields import NAMES
from sssgen.ir.types import VEC3
from sssgen.lang.loader import load_file
from sssgen.lang.polyfills import guard as guard_source
from sssgen.lang.polyfills import polyfill
from sssgen.material.shell_assembly import SHELLS
from sssgen.passes.guards import guard
from sssgen.pipeline.state import State
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import stem
from sssgen.targets.descriptor import Target
from sssgen.targets.used_frame import named, used_frame

_NORMALIZE = "safe_normalize"


def add_frame_functions(state: State) -> Module:
    """The module with the functions that the target's frame names, where it does not have them already."""
    fields = [field.name for field in state.surface.fields] if state.surface is not None else []
    inputs = {kind: entry.inputs for kind, entry in state.entries.items()}
    shell = state.shell.inputs if state.shell else None
    left_out = dict.fromkeys(file.without for file in state.target.files[state.form])
    frames = [
        used_frame(state.target, {kind: names for kind, names in inputs.items() if kind not in kinds}, shell, fields)
        for kinds in left_out
    ]
    own = {function.key for function in state.module.functions}
    added: dict[str, Function] = {}
    uniforms: dict[str, Uniform] = {}
    whole = state.form == "shader"
    for name in dict.fromkeys(name for used in frames for name in named(used, whole)):
        if name in NAMES or name in state.target.spelling:
            continue
        check_word(state.target, name)
        module = _function(name, state.format, state.guards)
        if module.functions[-1].key not in own:  # with those that it calls before it
            added |= {function.key: function for function in module.functions}
            uniforms |= {uniform.name: uniform for uniform in module.uniforms}
        state.frame_functions[name] = module.functions[-1]
    others = tuple(function for function in state.module.functions if function.key not in added)
    return state.module._replace(
        functions=(*added.values(), *others), uniforms=(*state.module.uniforms, *uniforms.values())
    )


def check_word(target: Target, name: str) -> None:
    """Raises SssgenError where a text of a frame has a word in braces that is no function."""
    if name != _NORMALIZE and not os.path.isfile(_path(name)):
        words = [_NORMALIZE, *NAMES, *target.spelling, *(stem(file) for file in os.listdir(SHELLS))]
        hint = "in braces are a function of src/sssgen/shells/, a value of the surface, or a word of [spelling]"
        message = f"the descriptor of {target.title} names {{{name}}}, which does not exist"
        raise failure(message, did_you_mean(name, words) or hint, f"{target.name}.toml")


def _path(name: str) -> str:
    return os.path.join(SHELLS, f"{name}.sss")


def _function(name: str, format: Format, guards: str) -> Module:
    """The module whose last function is the one of this name, with its guards."""
    if name == _NORMALIZE:
        row = BUILTINS["normalize"].guards[0]
        return guard_source(row, name, (VEC3,), VEC3, format, (0.0, 0.0))[0]
    module = load_file(_path(name), (SHELLS,))
    return guard(module, [module.functions[-1].key], guards, guard_source, polyfill, format).module
