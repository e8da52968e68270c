"""Reduces a failing input to the simplest that still fails, and prints the `sssgen eval` command that shows it.

Greedy and deterministic: for each input it tries the candidates, the simplest first, until nothing gets simpler.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator

import numpy as np

from sssgen.analyse.stress.contract_inputs import clamp_alpha, contract, fixed_value, whole_range
from sssgen.analyse.stress.subject import Specimen
from sssgen.ir.types import kind_of, spell
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import Inputs, default_of, default_texture
from sssgen.targets.runtime.numpy_textures import Texture
from sssgen.targets.texture_import import default_color

Fails = Callable[[Inputs], Array]
"""Whether inputs fail: (lanes,) bool."""

ROUNDS = 4
DIGITS = (1, 2, 3, 5)
_SIMPLE = (0.0, 1.0, 0.5, 2.0, -1.0, 10.0)
_TEXELS = (0.25, 2.0, -1.0, 65504.0, -65504.0, np.nan, np.inf, -np.inf)
_COLORS = ("white", "black", "gray")
_AXES = ((0, 0, 1), (0, 0, -1), (0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0))


def lane(inputs: Inputs, index: int) -> Inputs:
    """One lane of the inputs, as arrays of one."""
    values = {
        name: value[..., index : index + 1] if value.shape[-1] > 1 else value for name, value in inputs.values.items()
    }
    return Inputs(values, inputs.textures, 1)


def shrink(specimen: Specimen, failing: Inputs, fails: Fails) -> Inputs:
    """The simplest inputs found that still fail, one lane; `failing` itself if it does not fail when run alone."""
    simplest = failing
    if not fails(simplest).all():
        return failing
    simplest = _plainer_textures(specimen, simplest, fails)
    for _ in range(ROUNDS):
        before = simplest
        for name in simplest.values:
            simplest = _simpler(specimen, simplest, name, fails)
        if all(np.array_equal(simplest.values[name], value) for name, value in before.values.items()):
            break
    return simplest


def _plainer_textures(specimen: Specimen, simplest: Inputs, fails: Fails) -> Inputs:
    for name, uniform in specimen.subject.uniforms.items():
        if name not in simplest.textures:
            continue
        plain = [default_texture(spell(uniform.type), color) for color in (default_color(uniform), *_COLORS)]
        values = (0.25,) if contract(specimen, name).finite else _TEXELS
        plain += [_one_texel(simplest.textures[name], value) for value in values]
        for texture in plain:
            simpler = simplest._replace(textures={**simplest.textures, name: texture})
            if fails(simpler).all():
                simplest = simpler
                break
    return simplest


def _one_texel(texture: Texture, value: float) -> Texture:
    size = (*((6,) if texture.dim == "Cube" else ()), *(1,) * {"2D": 2, "3D": 3, "Cube": 2}[texture.dim], 4)
    return Texture(np.full(size, value, np.float16), dim=texture.dim)


def _simpler(specimen: Specimen, inputs: Inputs, name: str, fails: Fails) -> Inputs:
    """The inputs with one of them simplified as far as possible; the others are unchanged."""
    value = inputs.values[name]
    if name in specimen.settings:
        return inputs
    candidates = list(_candidates(specimen, name, value))
    candidates = candidates[: _index(candidates, value)]
    if _is_allowed(specimen, name, value):  # a value in the contract stays in it
        candidates = [candidate for candidate in candidates if _is_allowed(specimen, name, candidate)]
    if not candidates:
        return inputs
    lanes = np.concatenate(candidates, axis=-1)
    values = {
        other: np.broadcast_to(array, (*array.shape[:-1], lanes.shape[-1])) for other, array in inputs.values.items()
    }
    failing = np.flatnonzero(fails(Inputs({**values, name: lanes}, inputs.textures, lanes.shape[-1])))
    return inputs._replace(values={**inputs.values, name: candidates[int(failing[0])]}) if len(failing) else inputs


def _index(candidates: list[Array], value: Array) -> int:
    """The index of the value among the candidates; their number where it is not among them."""
    same = (i for i, candidate in enumerate(candidates) if np.array_equal(candidate, value))
    return next(same, len(candidates))


def _is_allowed(specimen: Specimen, name: str, value: Array) -> bool:
    if value.dtype.kind != "f":
        low, high = whole_range(specimen.subject.params[name], specimen.subject.uniforms.get(name))
        return bool(((value >= low) & (value <= high)).all())
    ends = contract(specimen, name)
    within = ((value >= np.float32(ends.low)) & (value <= np.float32(ends.high))).all()
    if not np.array_equal(clamp_alpha(specimen.subject.uniforms.get(name), value.copy()), value):
        return False
    return bool(within) and not float(np.linalg.norm(value.astype(np.float64))) > ends.length * (1.0 + 1e-6)


def _candidates(specimen: Specimen, name: str, value: Array) -> Iterator[Array]:
    """Values to try, the simplest first: the default, axes, simple numbers, single components, fewer digits."""
    if name in specimen.subject.uniforms:
        yield fixed_value(specimen, name)
    kind = kind_of(specimen.subject.params[name].type)
    if kind == "bool":
        yield np.zeros_like(value)
        return
    if value.shape[:-1] == (3,) and kind == "float":
        for axis in _AXES:
            yield np.array(axis, value.dtype)[:, None]
    for number in _SIMPLE:
        if kind == "float" or (number == int(number) and number >= 0):
            yield np.full_like(value, number)
    if kind != "float":
        return
    for index in np.ndindex(value.shape[:-1] if value.ndim > 1 else (0,)):
        for number in _SIMPLE[:2]:
            changed = value.copy()
            changed[index] = number
            yield changed
    for digits in DIGITS:
        yield np.array([np.float32(f"{number:.{digits - 1}e}") for number in value.ravel()], np.float32).reshape(
            value.shape
        )


def line(specimen: Specimen, inputs: Inputs, backend: str, guards: str = "auto") -> str:
    """The command that evaluates these inputs on a back end."""
    arguments = {name: _plain(value) for name, value in inputs.values.items() if not _is_default(specimen, name, value)}
    before, omitted = "", []
    for name, texture in inputs.textures.items():
        texels = texture.levels[0]
        same = np.array_equal(texels, np.broadcast_to(texels.reshape(-1, 4)[0], texels.shape), equal_nan=True)
        if _is_plain_default(specimen, name, texture):
            continue
        if same and np.isfinite(texels).all():
            shape = (*(1,) * (texels.ndim - 1), 4)
            values = [float(component) for component in texels.reshape(-1, 4)[0]]
            before += f"python -c 'import numpy; numpy.save(\"{name}.npy\", numpy.full({shape}, {values}))' && "
            arguments[name] = f"{name}.npy"
        else:
            description = f"texels of {texels.flat[0]}, which eval does not take," if same else "random texels"
            omitted.append(f"{description} in {name}")
    command = f"sssgen eval {shlex.quote(specimen.technique)} --inputs - --backend {_backend(backend)}"
    command += f" --guards {guards}" * (guards != "auto")
    command += "".join(f" --bind {shlex.quote(f'{slot}={function}')}" for slot, function in specimen.bind.items())
    note = f"  # and {' and '.join(omitted)}" if omitted else ""
    return f"{before}echo {shlex.quote(json.dumps(arguments))} | {command}{note}"


def _backend(name: str) -> str:
    """A back end in half precision is named by its plain name and the precision."""
    plain, _, precision = name.rpartition("-")
    return f"{plain} --precision {precision}" if precision in ("f16", "f32") else name


def _is_default(specimen: Specimen, name: str, value: Array) -> bool:
    uniform = specimen.subject.uniforms.get(name)
    plain = specimen._replace(settings={})
    return uniform is not None and name not in specimen.settings and np.array_equal(fixed_value(plain, name), value)


def _is_plain_default(specimen: Specimen, name: str, texture: Texture) -> bool:
    return np.array_equal(default_of(specimen.subject.uniforms[name]).levels[0], texture.levels[0])


def _plain(value: Array) -> object:
    """Numbers for JSON, each in the shortest form that reads back the same; a matrix in columns."""
    lanes = np.moveaxis(value, -1, 0)
    numbers = np.array([json.loads(_number(number)) for number in lanes.ravel()], dtype=object).reshape(lanes.shape)
    return numbers.tolist()[0] if len(lanes) == 1 else numbers.tolist()


def _number(value: object) -> str:
    if isinstance(value, np.bool_):
        return "true" if value else "false"
    if isinstance(value, np.floating):
        text = str(np.float32(value))
        return {"inf": "1e999", "-inf": "-1e999", "nan": "null"}.get(text, text)
    return str(value)
