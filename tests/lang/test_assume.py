"""`assume`: its syntax, its use in the passes, and that the assumptions of the library hold."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from name_rules import rules_of
from pass_cases import assert_is, key, module_of
from sssgen.ir import nodes as ir
from sssgen.ir.text import print_module
from sssgen.ir.text_reader import read_module
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import BOOL, FLOAT, Matrix, Sampler
from sssgen.ir.verify import verify
from sssgen.ir.walk import statements
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse
from sssgen.material import library
from sssgen.passes.conversions import drop_conversions
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.names import rename
from sssgen.passes.prune import prune
from sssgen.pipeline.compiler import GUARDS, transpile
from sssgen.run.backends import Array
from sssgen.run.backends import call_program as calls
from sssgen.run.backends.numpy_reference import namespace
from sssgen.run.evaluate.evaluation import Inputs, fit_inputs
from sssgen.run.evaluate.probes import Subject, subject
from sssgen.run.evaluate.random_inputs import samples
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_values import grid, precision

SOURCE = """
float f(float x, float y) {
    float a = abs(x);
    assume(a < y);
    return a / y;
}
"""


def assumptions(module: ir.Module) -> list[ir.Assume]:
    return [stmt for function in module.functions for stmt in statements(function.body or ())
            if isinstance(stmt, ir.Assume)]  # fmt: skip


# Read


def test_an_assumption_is_a_statement() -> None:
    (stmt,) = assumptions(module_of(SOURCE))
    assert stmt.condition.type == BOOL and stmt.span.line == 4


@pytest.mark.parametrize(
    ("statement", "message", "at"),
    [
        ("assume(x > 0.0, x);", "assume takes one condition", 1),
        ("assume();", "assume takes one condition", 1),
        ("assume(x);", "bool", 8),
        ("assume(g(x) > 0.0);", "an assumption cannot call a function", 1),
        ("assume(unknown > 0.0);", "unknown", 8),
    ],
)  # fmt: skip
def test_errors(statement: str, message: str, at: int) -> None:
    source = f"float g(float x) {{ return x; }}\nfloat f(float x) {{\n{statement}\nreturn x;\n}}"
    with pytest.raises(SssgenError) as wrong:
        check(parse(source, "test.sss"), source)
    (result,) = wrong.value.diagnostics
    assert message in result.message and result.span.line == 3 and result.span.column == at, result


def test_a_function_of_that_name_is_a_function() -> None:
    module = module_of("float assume(out float x) { x = 1.0; return x; }\nfloat f(float x) { assume(x); return x; }")
    assert not assumptions(module)


def test_the_text_of_the_ir_is_read_back() -> None:
    module = module_of(SOURCE)
    assert read_module(print_module(module)) == module
    assert "assume" in print_module(module, spans=False)


def test_the_verifier_wants_a_condition() -> None:
    module = module_of(SOURCE)
    (stmt,) = assumptions(module)
    local = ir.Local(FLOAT, "a", stmt.span)
    wrong = rewrite_module(
        module, lambda expr: expr, lambda one: (ir.Assume(local, one.span),) if one is stmt else None
    )
    assert verify(wrong)


# The passes


def test_fold_removes_decided_assumptions() -> None:
    head = "uniform float s = 1.0;\n"
    source = head + "float f(float x) { assume(1.0 < 2.0); assume(x < 1.0 + 2.0); assume(s > 0.5); return x; }"
    assert_is(
        fold(module_of(source)),
        "uniform float s = 1.0;\nfloat f(float x) { assume(x < 3.0); assume(s > 0.5); return x; }",
    )
    assert len(assumptions(fold(module_of(source), {"s": (2.0,)}))) == 1


def test_prune_keeps_no_variable_for_it() -> None:
    module = module_of(
        "float f(float x) { float a = x * 2.0; float b = x + 1.0; assume(a < 1.0); assume(b > 0.0); return b; }"
    )
    pruned = prune(module, [key(module, "f")])
    assert_is(pruned, "float f(float x) { float b = x + 1.0; assume(b > 0.0); return b; }")


def test_conversions_hoist_and_names_keep_it() -> None:
    source = "float g(float x) { assume(x > 0.0); float r = sqrt(x); return r; }\n"
    source += "float f(float v) { float a = v; return g(a); }"
    module = module_of(source)
    for result in (
        drop_conversions(module), hoist(module, [key(module, "f")])[0],
        rename(module, rules_of("xva", False))[0],
    ):  # fmt: skip
        assert verify(result) == [] and assumptions(result), print_module(result, spans=False)


@pytest.mark.parametrize("target", registry.names())
def test_no_target_prints_assumptions(target: str) -> None:
    for mode in GUARDS:
        compiled = transpile(module_of(SOURCE), target, "case", guards=mode)
        shown = "".join(text for name, text in compiled.files.items() if not name.endswith(".json"))
        assert "assume" not in shown and "abs" in shown


# The library's assumptions hold


class Checked(NamedTuple):
    """A technique that discards the fragment where an assumption does not hold."""

    subject: Subject
    count: int


def checked(chosen: Subject) -> Checked:
    """Puts `if (!condition) discard;` in the place of each assumption."""
    count = 0
    functions = []
    for function in chosen.module.functions:

        def restate(stmt: ir.Stmt) -> ir.Block | None:
            nonlocal count
            if not isinstance(stmt, ir.Assume):
                return None
            count += 1
            wrong = ir.Unary(BOOL, "!", stmt.condition, stmt.span)
            return (ir.If(wrong, (ir.Discard(stmt.span),), (), stmt.span),)

        module = rewrite_module(chosen.module._replace(functions=(function,)), lambda expr: expr, restate)
        functions += list(module.functions)
    return Checked(chosen._replace(module=chosen.module._replace(functions=tuple(functions))), count)


@cache
def assuming() -> tuple[str, ...]:
    """The techniques that assume something, through what they call too."""
    return tuple(name for name in sorted(library.index()) if assumptions(subject(name).module))


def broken(name: str, count: int, seed: int) -> int:
    """How many of that many random inputs, and of degenerate ones, break an assumption."""
    chosen = checked(subject(name))
    assert chosen.count
    inputs = samples(chosen.subject, count, seed)
    for param in chosen.subject.params.values():
        if param.quantity.endswith("_direction") or param.name in ("N", "V", "L"):
            inputs[param.name][:20] = 0.0
            inputs[param.name][20:40] *= 1e-20
        elif not isinstance(param.type, Sampler | Matrix) and param.name not in chosen.subject.uniforms:
            inputs[param.name][40:60] = 0
    return int(dropped(chosen.subject, fit_inputs(chosen.subject, inputs)).sum())


def dropped(chosen: Subject, inputs: Inputs) -> Array:
    """The lanes that some probe drops, in float32."""
    compiled = transpile(chosen.module, "numpy", "case", "auto", chosen.called)
    functions = namespace(next(text for name, text in compiled.files.items() if not name.endswith(".json")))
    names, shape = compiled.reflection["renames"], calls.grid(inputs.lanes)
    filled = shape.rows * shape.width
    result = np.zeros(filled, bool)
    for probe in chosen.probes:
        args = [
            inputs.textures[param.name]
            if isinstance(param.type, Sampler)
            else _filled(inputs.values[param.name], filled)
            for param in probe.params
        ]
        with precision("float32"), grid(shape.rows, shape.width):
            _, gone = functions[names.get(probe.function, probe.function)](*args)
        result |= gone
    return result[: inputs.lanes]


def _filled(value: Array, lanes: int) -> Array:
    """An argument in float32, for the whole grid: its first lane again behind the last."""
    value = value.astype(np.float32) if value.dtype.kind == "f" else value
    rest = np.repeat(value[..., :1], lanes - value.shape[-1], axis=-1)
    return np.concatenate([value, rest], axis=-1)


@pytest.mark.parametrize("name", ["thinness_uniform", "march_distance_texture"])
def test_an_assumption_that_does_not_hold_is_seen(name: str) -> None:
    """The check of the library, of assumptions turned round."""
    chosen = subject(name)

    def turned(stmt: ir.Stmt) -> ir.Block | None:
        return (
            (ir.Assume(ir.Unary(BOOL, "!", stmt.condition, stmt.span), stmt.span),)
            if isinstance(stmt, ir.Assume)
            else None
        )

    wrong = checked(chosen._replace(module=rewrite_module(chosen.module, lambda expr: expr, turned)))
    assert dropped(wrong.subject, fit_inputs(chosen, samples(chosen, 400, 1))).mean() > 0.2


def test_the_library_has_assumptions() -> None:
    assert len(assuming()) >= 7 and {"thinness_hemisphere", "march_distance_texture"} <= {*assuming()}


@pytest.mark.parametrize("name", assuming())
def test_assumptions_of_the_library_hold(name: str) -> None:
    assert broken(name, 2_000, 11) == 0


@pytest.mark.slow
@pytest.mark.parametrize("name", assuming())
def test_assumptions_of_the_library_hold_on_many_inputs(name: str) -> None:
    assert sum(broken(name, 20_000, seed) for seed in range(5)) == 0
