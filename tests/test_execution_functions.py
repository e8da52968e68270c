"""Every technique of the library, and random programs, run on real back ends against the numpy target's text."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any

import numpy as np
import pytest

from against_numpy import DTYPES, Array, Draw, arguments, differences, drawn, pixels, shape, textures
from random_programs import HELPERS, Programs
from sssgen import library, slots
from sssgen.harness.backends import Backend, Call
from sssgen.ir.nodes import Call as CallNode
from sssgen.ir.nodes import Declare, Evaluate, Function, Local, Module, Param, Return, Stmt, Uniform
from sssgen.ir.types import VOID, kind_of
from sssgen.lang.loader import load_text
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.link import LinkStage, link
from sssgen.passes.parameters import uniforms_to_parameters
from sssgen.passes.prune import prune

LANES = 48
LOOSE = {"raymarch_shows_N": 0.05}
"""What float32 alone blurs: a normal from differences of distances a thousandth apart."""


def bound(technique: library.Technique) -> dict[str, tuple[Module, Function]]:
    """Each slot of a technique, and of what is bound to its slots, with the first function of the library that fits."""
    found: dict[str, tuple[Module, Function]] = {}
    waiting = list(slots.needs(technique.module, technique.function)[1])
    while waiting:
        slot = waiting.pop()
        if slot.name not in found:
            found[slot.name] = slots.find(slots.candidates(slot)[0], slot, library.TECHNIQUES)
            waiting += slots.needs(*found[slot.name])[1]
    return found


def probes(function: Function) -> list[Function]:
    """Functions without out parameters, one for each thing that a technique gives."""
    span = function.span
    outs = [param for param in function.params if param.direction != "in"]
    made = []
    for shown in [None, *outs]:
        if shown is None and function.result == VOID:
            continue
        start: list[Stmt] = []
        args: list[Any] = []
        for param in function.params:
            name = param.name if param.direction == "in" else f"{param.name}_given"
            if param.direction != "in":
                value = Local(param.type, param.name, span) if param.direction == "inout" else None
                start.append(Declare(name, param.type, value, span))
            args.append(Local(param.type, name, span))
        call = CallNode(function.result, function.key, tuple(args), span)
        if shown is None:
            result = f"{function.name}_value"
            body = (
                *start,
                Declare(result, function.result, call, span),
                Return(Local(function.result, result, span), span),
            )
        else:
            value = Local(shown.type, f"{shown.name}_given", span)
            ignored: Stmt = Evaluate(call, span)
            if function.result != VOID:
                ignored = Declare(f"{function.name}_value", function.result, call, span)
            body = (*start, ignored, Return(value, span))
        params = tuple(param._replace(direction="in") for param in function.params if param.direction != "out")
        name = f"{function.name}_shows_{shown.name if shown is not None else 'result'}"
        made.append(
            function._replace(name=name, params=params, result=shown.type if shown else function.result, body=body)
        )
    return made


@cache
def program() -> tuple[Module, tuple[tuple[str, Function], ...]]:
    """All techniques in one module, and their probes with the parameters that uniforms bring."""
    techniques = list(library.load_all())
    stages = [
        LinkStage(one.name, one.role, one.module, one.function, bound(one), {}, frozenset()) for one in techniques
    ]
    linked = link(stages)
    made = [probe for function in linked.functions for probe in probes(function)]
    module = linked.module._replace(functions=(*linked.module.functions, *made))
    roots = [probe.key for probe in made]
    module, _ = hoist(prune(fold(module), roots), roots)
    closed = {function.name: function for function in uniforms_to_parameters(module).functions}
    return module, tuple((probe.name, closed[probe.name]) for probe in made)


def drawn_for_technique(param: Param, rng: np.random.Generator, lanes: int) -> Array:
    """An argument in the range of its quantity, the same in a quad but for what is linear over the image."""
    uniform = next((one for one in program()[0].uniforms if one.name == param.name), None)
    if uniform is not None:
        return drawn_uniform(uniform, rng, lanes)
    x, y = pixels(lanes)
    if kind_of(param.type) != "float":
        return drawn(param, rng, lanes)
    size = (*shape(param.type), lanes)
    value = rng.uniform(-1.0, 1.0, size)[..., x // 2]
    if param.quantity.endswith("_direction") or param.name in ("V", "L", "N"):
        value /= np.sqrt((value * value).sum(axis=0))
    elif param.quantity.endswith("_position"):
        value += 0.01 * np.stack([x, y, x - y][: len(value)])
    else:
        value = 0.5 + 0.45 * value
    return value.astype(np.float32)


def drawn_uniform(uniform: Uniform, rng: np.random.Generator, lanes: int) -> Array:
    """Something near the default."""
    size = shape(uniform.type)
    value = np.array(uniform.default).reshape(*size, 1)
    if kind_of(uniform.type) != "float":
        return np.repeat(value, lanes, axis=-1).astype(DTYPES[kind_of(uniform.type)])
    value = value * rng.uniform(0.8, 1.2, lanes)[pixels(lanes)[0] // 2]
    low, high = map(float, dict(uniform.hints).get("hint_range", (0.0, 0.0))[:2])
    if low < high:
        value = np.clip(value + 0.1 * (high - low), low, high)
    return np.asarray(value, np.float32)


@pytest.fixture(params=["gl", "webgpu", "hlsl"])
def gpu(request: pytest.FixtureRequest, backend: Callable[[str], Backend]) -> Backend:
    """A back end for each language."""
    return backend(request.param)


def called(title: str, function: Function, draw: Draw, lanes: int) -> tuple[str, Call]:
    params = tuple(param.type for param in function.params)
    return title, Call(function.name, params, function.result, arguments(function, draw, lanes))


def test_techniques(gpu: Backend) -> None:
    module, found = program()
    calls = [called(title, function, drawn_for_technique, LANES) for title, function in found]
    wrong = differences(gpu, module, calls, textures(mipmaps=False), "float32", 1e-4, LOOSE)
    assert not wrong, "\n\n".join([f"{len(wrong)} of {len(calls)}", *wrong])


# Random programs


class ProgramsInBounds(Programs):
    """Random programs that stay inside their array."""

    def number(self, depth: int = 2) -> str:
        return self.inside(super().number(depth))

    def place(self) -> str:
        return self.inside(super().place())

    def inside(self, text: str) -> str:
        return f"list[abs({text[5:-1]}) % 3]" if text.startswith("list[") else text


@cache
def random_module() -> tuple[Module, tuple[Function, ...]]:
    """A module of random functions, and their probes."""
    functions = []
    for seed in range(24):
        source = ProgramsInBounds(Random(seed), size=3).program()
        functions.append(source[source.index("float f(") :].replace("float f(", f"float random_{seed}(", 1))
    module = load_text("\n".join([HELPERS, *functions]), "random")
    made = [probe for function in module.functions if function.name.startswith("random_") for probe in probes(function)]
    return module._replace(functions=(*module.functions, *made)), tuple(made)


def drawn_exactly(param: Param, rng: np.random.Generator, lanes: int) -> Array:
    """Numbers with which float32 computes exactly, so that no condition differs."""
    if kind_of(param.type) == "int":
        return rng.integers(0, 4, lanes).astype(np.int32)
    return (rng.integers(-8, 9, lanes) / 2).astype(np.float32)


def test_random_programs(gpu: Backend) -> None:
    """Control flow that differs from lane to lane, out parameters, choices, loops."""
    module, made = random_module()
    calls = [called(function.name, function, drawn_exactly, LANES) for function in made]
    wrong = differences(gpu, module, calls, {}, "float32", 1e-4)
    assert not wrong, "\n\n".join([f"{len(wrong)} of {len(calls)}", *wrong])
