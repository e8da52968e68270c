"""Random programs compute the same before and after a pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ir_interpreter import BUILTINS, Discarded, Interpreter, componentwise, flat
from name_rules import rules_of
from pass_cases import key
from shaded_programs import module_for
from sssgen.ir.nodes import Module, Return
from sssgen.ir.verify import verify
from sssgen.ir.walk import statements
from sssgen.lang.polyfills import polyfill
from sssgen.passes.conversions import drop_conversions
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.legal.legalise import legalise
from sssgen.passes.legal.plain_loops import plain_loops
from sssgen.passes.legal.result_structs import result_structs
from sssgen.passes.legal.single_exit import single_exits
from sssgen.passes.names import rename
from sssgen.passes.prune import prune
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.targets import registry

SEEDS = st.integers(0, 1 << 32)
VALUES = {"map": None, "level": 2.0, "mode": 1, "tint": (0.5, 1.0, 2.0)}
ARGUMENTS = [(0.5, 1.5, 1, 0.0), (-2.0, 5.0, 2, 3.0), (4.5, -0.5, 0, 1.0), (0.0, 0.0, 3, -4.0)]


def texel(map_: None, at: Any, *rest: Any) -> Any:
    """The value of a texture at a place, the same for all levels."""
    total = sum(part if math.isfinite(part) else 0.0 for part in at)
    return tuple(math.fmod(total * scale, 4.0) for scale in (1.0, -0.5, 0.25, 2.0))


READS: dict[str, Callable[..., Any]] = {
    "texture": texel, "textureLod": texel, "textureGrad": texel, "exp2": lambda x: 1.0,
    "dFdx": lambda x: componentwise(lambda part: part, x), "dFdy": lambda x: componentwise(lambda part: -part, x),
}  # fmt: skip


@pytest.fixture(autouse=True, scope="module")
def _reads() -> Any:
    """The interpreter's builtins, with texture reads."""
    BUILTINS.update(READS)
    yield
    for name in READS:
        del BUILTINS[name]


def outcomes(module: Module, name: str = "f", extra: tuple[Any, ...] = ()) -> list[str]:
    """The results of `f` for each set of arguments; NaN equals NaN, and 0 equals -0."""
    results = []
    for arguments in ARGUMENTS:
        machine = Interpreter(module, VALUES)
        try:
            given_back = machine.call(key(module, name), *arguments, *extra)
            numbers = [round(number, 9) + 0.0 for number in flat(given_back)]
            results.append(" ".join(map(str, numbers)))
        except Discarded:
            results.append("discard")
        except OverflowError:
            results.append("overflow")
    return results


def same(seed: int, discards: bool, change: Callable[[Module], Module], linked: bool = False) -> None:
    module = module_for(seed, discards)
    changed = change(module)
    assert verify(changed, linked=linked) == []
    assert outcomes(changed) == outcomes(module)


@given(SEEDS, st.booleans())
def test_prune(seed: int, discards: bool) -> None:
    same(seed, discards, lambda module: prune(module, [key(module, "f")]), linked=True)


@given(SEEDS, st.booleans())
def test_fold(seed: int, discards: bool) -> None:
    fixed: dict[str, tuple[float, ...]] = {"level": (2.0,), "mode": (1,), "tint": (0.5, 1.0, 2.0)}
    same(seed, discards, lambda module: fold(module, fixed))
    same(seed, discards, fold)


@given(SEEDS, st.booleans())
def test_conversions(seed: int, discards: bool) -> None:
    same(seed, discards, drop_conversions)


@given(SEEDS, st.booleans())
def test_names(seed: int, discards: bool) -> None:
    module = module_for(seed, discards)
    reserved = {"a", "v", "x1", "x2", "x3", "i1", "i2", "k", "pair", "first", "look", "Pair", "split", "d"}
    changed, names = rename(module, rules_of(reserved, False, ("two", "list")))
    assert verify(changed) == []
    assert outcomes(changed) == outcomes(module)
    declared = {param.name for function in changed.functions for param in function.params}
    assert not declared & reserved and names["f.a"] == "a_"


@given(SEEDS, st.booleans())
def test_parameters(seed: int, discards: bool) -> None:
    module = module_for(seed, discards)
    changed = uniforms_to_parameters(module)
    assert verify(changed) == []
    added = [param.name for param in changed.functions[-1].params[len(module.functions[-1].params) :]]
    assert outcomes(changed, extra=tuple(VALUES[name] for name in added)) == outcomes(module)


@given(SEEDS, st.booleans())
def test_hoist(seed: int, discards: bool) -> None:
    def change(module: Module) -> Module:
        return hoist(module, [key(module, "f")])[0]

    same(seed, discards, change)


@given(SEEDS, st.booleans())
def test_plain_loops(seed: int, discards: bool) -> None:
    same(seed, discards, plain_loops)


@given(SEEDS, st.booleans())
def test_single_exits(seed: int, discards: bool) -> None:
    def change(module: Module) -> Module:
        module = single_exits(module)
        for function in module.functions:
            returns = [stmt for stmt in statements(function.body or ()) if isinstance(stmt, Return)]
            assert returns == list((function.body or ())[-1:])
        return module

    same(seed, discards, change)


@given(SEEDS, st.booleans())
def test_functions_without_references(seed: int, discards: bool) -> None:
    """All that is rewritten for a language whose functions only return."""

    def change(module: Module) -> Module:
        target = registry.load("tsl")
        module = result_structs(legalise(module, target.dialect, target.capabilities, polyfill))
        assert all(param.direction == "in" for function in module.functions for param in function.params)
        return single_exits(plain_loops(module))

    same(seed, discards, change)


@given(SEEDS, st.booleans())
def test_all_passes_in_sequence(seed: int, discards: bool) -> None:
    def change(module: Module) -> Module:
        module = prune(fold(module, {"mode": (1,)}), [key(module, "f")])
        module = hoist(module, [key(module, "f")])[0]
        module = prune(drop_conversions(module), [key(module, "f")])
        return rename(module, rules_of("ab", False))[0]

    same(seed, discards, change, linked=True)
