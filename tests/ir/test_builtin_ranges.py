"""The `range` and `guards` of the intrinsic table: results are in the range, and guards make them finite."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

from pass_cases import module_of
from qualification.parity_inputs import DTYPES, EDGES, evaluated, inside, widened
from slow_cases import diagonal
from sssgen.ir import nodes as ir
from sssgen.ir import signatures, vector_ranges
from sssgen.ir.component_ranges import within
from sssgen.ir.contracts import INTEGERS
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import UNIT, Range, rising, rounded
from sssgen.ir.intrinsics import BUILTINS, Builtin
from sssgen.ir.types import BY_NAME, Scalar, Type, Vector, components, kind_of, spell
from sssgen.ir.vector_ranges import Value, length
from sssgen.passes.ranges.range_pass import RangeAnalysis
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Backend, Call, Text
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.targets import numpy_runtime as runtime

BOXES, LANES = 40, 48
COMPUTED = [row for row in BUILTINS.values() if row.kind not in ("fetch", "derivative")]
LARGEST = FLOAT32.largest


def called(name: str, args: tuple[Any, ...]) -> Array:
    """The results of NumPy in float32."""
    with runtime.precision("float32"), np.errstate(all="ignore"):
        return np.asarray(getattr(runtime, name + "_" * (name == "not"))(*args))


def overloads(row: Builtin) -> list[tuple[tuple[Type, ...], Type]]:
    return [(params, result) for params, (result, _) in signatures.overloads(row.name).items()]


# Ranges


def a_box(rng: np.random.Generator, row: Builtin, index: int, type_: Type) -> list[Range]:
    """A range for each component of an argument, some of them points."""
    kind = kind_of(type_)
    if kind == "bool":
        low, high = sorted(rng.integers(0, 2, 2))
        return [Range(float(low), float(high))] * components(type_)
    if kind in ("int", "uint"):
        ends = [-(2**31) + 1, 2**31 - 1, -7, 5] if kind == "int" else [0, 2**32 - 1, 7, 5]
        low, high = sorted(float(rng.choice([*ends, 0, int(rng.integers(0, 99))])) for _ in range(2))
        return [Range(low, high)] * components(type_)
    least, most = row.samples.interval(index) or (-1e3, 1e3)
    boxes = []
    for _ in range(components(type_)):
        edges = np.array([edge for edge in EDGES if least <= edge <= most and abs(edge) < 1e12])
        drawn = rng.uniform(max(least, -8.0), min(most, 8.0), 2)
        low, high = sorted(float(np.float32(rng.choice(edges) if rng.random() < 0.5 else end)) for end in drawn)
        if rng.random() < 0.4:  # narrow: cancellation is visible
            high = float(np.float32(low + abs(low) * 1e-6))
        boxes.append(Range(low, high))
    return boxes


def drawn(rng: np.random.Generator, box: list[Range], type_: Type) -> Array:
    """Members of a box, lane last: its corners first, then others, with 0 and 1 where the box has them."""
    columns = []
    for part in box:
        column = part.low + (part.high - part.low) * rng.random(LANES)
        column[: LANES // 3] = rng.choice([part.low, part.high], LANES // 3)
        column[-4:] = np.clip([0.0, 1.0, -1.0, 0.5], part.low, part.high)
        if kind_of(type_) != "float":
            column = np.round(column)
        columns.append(np.clip(column, part.low, part.high))
    shape = (*shape_of(type_), LANES)
    values: Array = np.array(columns).reshape(shape).astype(DTYPES[kind_of(type_)])
    return values


def analysed(row: Builtin, params: tuple[Type, ...], result: Type, boxes: list[list[Range]], same: bool) -> Any:
    """What the analysis makes of a call: the value, and the places where something may go wrong."""
    analysis = RangeAnalysis(ir.Module(), FLOAT32)
    values: list[Value] = []
    for box in boxes:
        numbers = values[0].numbers if same and values else tuple(analysis.numbers.fresh() for _ in box)
        values.append(analysis.value(tuple(rounded(part, FLOAT32) for part in box), numbers))
    names = [ir.Local(type_, f"x{index}", ir.NOWHERE) for index, type_ in enumerate(params)]
    node = ir.Intrinsic(result, row.name, tuple(names), ir.NOWHERE)
    return analysis.builtin(node, tuple(values), False), list(analysis.sites.values())


def assert_inside(results: Value, result: Type, built: Array, message: object) -> None:
    lanes = max(LANES, built.shape[-1])
    flat = np.broadcast_to(built, (*built.shape[:-1], lanes)).reshape(-1, lanes).astype(np.float64)
    assert len(flat) == len(results.parts), message
    for part, numbers in zip(results.parts, flat, strict=True):
        inside = (numbers >= part.low) & (numbers <= part.high) & (np.abs(numbers) >= part.gap)
        assert inside.all(), (message, part, numbers[~inside][:3])
    if isinstance(result, Vector) and result.kind == "float":
        lengths = np.sqrt((flat**2).sum(axis=0))
        assert (lengths <= results.length.high * (1.0 + 1e-12)).all(), (message, results.length, lengths.max())
        assert (lengths >= results.length.low * (1.0 - 1e-12)).all(), (message, results.length, lengths.min())


BOUNDED = [row for row in COMPUTED if not row.unbounded and not any(guard.safe is None for guard in row.guards)]
"""Those of which the range is known, without the ones that always have a guard."""


@pytest.mark.parametrize("row", BOUNDED, ids=lambda row: row.name)
def test_results_are_in_the_computed_range(row: Builtin) -> None:
    """For all members of random boxes; and finite where the table has no guard."""
    rng = np.random.default_rng(zlib.crc32(row.name.encode()))
    checked = 0
    for params, result in overloads(row):
        for number in range(BOXES):
            boxes = [a_box(rng, row, index, type_) for index, type_ in enumerate(params)]
            same = number % 4 == 0 and len(set(params)) == 1 and not row.samples.unit
            if same:
                boxes = [boxes[0]] * len(boxes)
            args = tuple(drawn(rng, box, type_) for box, type_ in zip(boxes, params, strict=True))
            args = (args[0],) * len(args) if same else args
            if isinstance(params[0], Vector):
                args = tuple(_unit(arg) if index in row.samples.unit else arg for index, arg in enumerate(args))
                boxes = [_hull(arg) if index in row.samples.unit else box
                         for index, (arg, box) in enumerate(zip(args, boxes, strict=True))]  # fmt: skip
            found, sites = analysed(row, params, result, boxes, same)
            built = called(row.name, args)
            if not all(site.proven for site in sites):
                continue
            assert_inside(found, result, built, (row.name, boxes))
            checked += 1
    assert checked > BOXES / 4, "too few boxes are within the domain"


_EXTREMES = [0.0, 1e-45, 1e-40, 1.2e-38, 1e-37, 1e-30, 1e-20, 1e-12, 1e-6, 1e-3, 0.5, 1.0, 1.0000001, 2.0, 100.0,
             1e4, 1e6, 1e10, 1e12, 1e15, 1e18, 1.8e19, 2e19, 1e20, 1e25, 1e30, 1e35, 1e37, 8e37, 1.2e38, 2e38,
             LARGEST]  # fmt: skip


def an_extreme_box(rng: np.random.Generator, type_: Type) -> list[Range]:
    """A range for each component, over all magnitudes: points, ranges around 0, and ranges of one sign."""
    numbers = np.array([sign * size for size in _EXTREMES for sign in (1.0, -1.0)], np.float32).astype(np.float64)
    most = rng.choice(np.abs(numbers))
    # sums of products overflow where all factors are of one size
    numbers = numbers[(np.abs(numbers) <= most) & (np.abs(numbers) >= most * rng.choice([0.0, 0.01]))]
    boxes = []
    for _ in range(components(type_)):
        low, high = sorted(map(float, rng.choice(numbers, 2)))
        form = rng.random()
        boxes.append(Range(low, low if form < 0.3 else high) if form < 0.8 else Range(-abs(high), abs(high)))
    return boxes


@pytest.mark.parametrize("row", [row for row in BOUNDED if row.ulp or row.guards], ids=lambda row: row.name)
def test_what_is_proven_at_extreme_arguments_is_finite_and_in_the_computed_range(row: Builtin) -> None:
    """No intermediate result of a formula overflows where its call is proven safe."""
    rng = np.random.default_rng(zlib.crc32(row.name.encode()) + 1)
    for params, result in overloads(row):
        for number in range(BOXES if all(kind_of(type_) == "float" for type_ in (*params, result)) else 0):
            same = number % 5 == 0 and len(set(params)) == 1
            boxes = [an_extreme_box(rng, type_) for type_ in params]
            boxes = [boxes[0]] * len(boxes) if same else boxes
            args = tuple(drawn(rng, box, type_) for box, type_ in zip(boxes, params, strict=True))
            args = (args[0],) * len(args) if same else args
            found, sites = analysed(row, params, result, boxes, same)
            if all(site.proven for site in sites):
                assert_inside(found, result, called(row.name, args), (row.name, boxes))


def test_the_check_at_extreme_arguments_detects_wrong_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test above fails if the range functions do not look at intermediate results."""
    monkeypatch.setattr(vector_ranges, "_overflow", lambda F, *sizes: False)
    for name in ("refract", "length", "distance"):
        with pytest.raises(AssertionError):
            test_what_is_proven_at_extreme_arguments_is_finite_and_in_the_computed_range(BUILTINS[name])


def _unit(arg: Array) -> Array:
    length = np.linalg.norm(arg.astype(np.float64), axis=0)
    result: Array = np.where(length > 1e-6, arg / np.maximum(length, 1e-6), np.eye(len(arg))[:, :1]).astype(np.float32)
    return result


def _hull(arg: Array) -> list[Range]:
    return [Range(float(part.min()), float(part.max())) for part in arg]


def test_the_check_of_ranges_detects_wrong_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test above fails for a wrong row."""
    for name, wrong in (
        ("cos", within(0.0, 1.0)),
        ("mix", lambda F, x, y, z: x),
        ("exp2", lambda F, x: rising(math.exp, x)),
        ("dot", lambda F, x, y: length(F, x)),
    ):
        with monkeypatch.context() as patch:
            patch.setitem(BUILTINS, name, BUILTINS[name]._replace(range=wrong))
            with pytest.raises(AssertionError):
                test_results_are_in_the_computed_range(BUILTINS[name])


def test_results_of_vectors_differ_from_those_of_components() -> None:
    """Value numbers: a difference in any component may change the result; components of one result differ."""
    analysis = RangeAnalysis(ir.Module(), FLOAT32)
    x, y, z = (analysis.numbers.fresh() for _ in range(3))
    for name, type_, result in (("any", "bvec2", "bool"), ("packSnorm2x16", "vec2", "uint")):
        node = ir.Intrinsic(BY_NAME[result], name, (ir.Local(BY_NAME[type_], "v", ir.NOWHERE),), ir.NOWHERE)
        one, other = (analysis.value((UNIT, UNIT), numbers) for numbers in ((x, y), (x, z)))
        assert analysis.builtin(node, (one,), False).numbers != analysis.builtin(node, (other,), False).numbers
    node = ir.Intrinsic(BY_NAME["vec2"], "unpackSnorm2x16", (ir.Local(BY_NAME["uint"], "u", ir.NOWHERE),), ir.NOWHERE)
    numbers = analysis.builtin(node, (analysis.value((UNIT,), (x,)),), False).numbers
    assert len(set(numbers)) == 2


# Guards


class Guarded(NamedTuple):
    """One overload of a builtin with guards, as a function of hostile arguments."""

    row: Builtin
    params: tuple[Type, ...]
    result: Type
    args: tuple[Array, ...]

    @property
    def title(self) -> str:
        return f"{self.row.name}({', '.join(map(spell, self.params))})"


_SIZES = [0.0, 1e-45, 1e-40, 1e-30, 1e-12, 1e-3, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 8.0, 64.0, 87.0, 130.0, 1e4, 1e6]
HOSTILE = np.array([sign * size for size in _SIZES for sign in (1.0, -1.0)], np.float32)
"""Within what a parameter may be."""
BITS = [0, 1, 0x7F800000, 0x7FC00000, 0x7F800001, 0x3F800000, 0x7F7FFFFF, 0x7C007C00, 0x7E01FC00, 0x3C00, 0x007FFFFF]


@cache
def guarded_cases() -> tuple[Guarded, ...]:
    results = []
    for row in COMPUTED:
        for params, result in overloads(row) if row.guards else ():
            if kind_of(result) == "float":
                rng = np.random.default_rng(zlib.crc32(row.name.encode()))
                args = tuple(_hostile(rng, type_) for type_ in params)
                results.append(Guarded(row, params, result, args))
    return tuple(results)


def _hostile(rng: np.random.Generator, type_: Type) -> Array:
    """Every pair of the first two arguments comes by chance; 600 lanes."""
    shape = (*shape_of(type_), 600)
    kind = kind_of(type_)
    if kind != "float":
        choices = np.array([*BITS, *(bits | 0x80000000 for bits in BITS)], np.uint32)
        return rng.choice(choices.view(DTYPES[kind]), shape)
    values = rng.choice(HOSTILE, shape)
    values[..., :100] = values[(0,) * (len(shape) - 1)][:100]  # all components alike
    values[..., 100:200] = rng.uniform(-4.0, 4.0, (*shape[:-1], 100))
    return values.astype(np.float32)


def run(backend: Backend, mode: str, chosen: tuple[Guarded, ...]) -> list[Array]:
    """The results, all functions in one program."""
    lines = []
    for number, case in enumerate(chosen):
        params = ", ".join(f"{spell(type_)} {name}" for type_, name in zip(case.params, "abc", strict=False))
        names = ", ".join("abc"[: len(case.params)])
        lines.append(f"{spell(case.result)} case_{number}({params}) {{ return {case.row.name}({names}); }}")
    compiled = transpile(module_of("\n".join(lines)), backend.target.name, "cases", guards=mode)
    text = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    names = compiled.reflection["renames"]
    calls = [
        Call(names.get(f"case_{number}", f"case_{number}"), case.params, case.result, case.args)
        for number, case in enumerate(chosen)
    ]
    return backend.run(Text(text), calls)


def safe_lanes(case: Guarded) -> Array:
    """Lanes whose arguments keep to the domain, by `safe` of the table's guards, and where parity is measured."""
    whole = not case.row.componentwise
    lanes = case.args[0].shape[-1]
    flat = [arg.reshape(-1, lanes).astype(np.float64) for arg in case.args]
    count = 1 if whole else max(len(arg) for arg in flat)
    good = np.ones(lanes, bool)
    guards = [guard for guard in case.row.guards if guard.replaces != "y" or len(flat) > 1]
    for lane in range(lanes):
        for at in range(count):
            points = [_point(arg[:, lane] if whole else arg[at % len(arg), lane : lane + 1]) for arg in flat]
            good[lane] &= all(one.safe is not None and one.safe(FLOAT32, *points) for one in guards)
    good &= inside(case.row, case.args)
    tiny = [((np.abs(arg) > 0.0) & (np.abs(arg) < 1e-30)).any(axis=0) for arg in flat]
    return good & ~np.any(tiny, axis=0)


def _point(numbers: Array) -> Range:
    size = float(np.sqrt((numbers**2).sum())) if len(numbers) > 1 else float(numbers[0])
    return rounded(Range(size, size), FLOAT32)


def assert_safe(case: Guarded, actual: Array) -> int:
    """All lanes are finite, those in the domain as the builtin has them; how many of these there are."""
    finite = np.isfinite(actual).reshape(-1, actual.shape[-1]).all(axis=0)
    messages = [[arg[..., lane].tolist() for arg in case.args] for lane in np.flatnonzero(~finite)[:3]]
    assert finite.all(), f"{case.title} at {messages}: {actual[..., ~finite][..., :3].tolist()}"
    good = safe_lanes(case)
    with np.errstate(all="ignore"), runtime.precision("float64"):
        expected = np.asarray(getattr(runtime, case.row.name)(*widened(case.args)))[..., good]
        size = np.abs(expected)
        if case.row.size:
            size = np.maximum(size, evaluated(case.row.size, widened(case.args))[good])
    inner = tuple(range(expected.ndim - 1))
    size = np.broadcast_to(size.max(axis=inner) if inner else size, expected.shape)
    allowed = np.maximum(2.0 * max(case.row.ulp, 4.0) * 2.0**-23 * size, max(case.row.absolute, 1e-30))
    off = np.abs(actual[..., good] - expected) - allowed
    worst = int(np.argmax(off.reshape(-1, off.shape[-1]).max(axis=0))) if off.size else 0
    at = [arg[..., good][..., worst].tolist() for arg in case.args] if off.size else []
    assert not (off > 0.0).any(), f"{case.title} at {at}: {actual[..., good][..., worst]} is not {expected[..., worst]}"
    return int(good.sum())


@pytest.mark.parametrize(("name", "mode"), diagonal(["numpy-f32", "gl", "webgpu", "hlsl"], ["auto", "all"]))
def test_guarded_builtins_are_finite_and_exact_in_the_domain(
    name: str, mode: str, backend: Callable[[str], Backend]
) -> None:
    chosen = guarded_cases()
    inside: dict[str, int] = {}
    for case, got in zip(chosen, run(backend(name), mode, chosen), strict=True):
        inside[case.row.name] = inside.get(case.row.name, 0) + assert_safe(case, got)
    never = {row.name for row in COMPUTED for guard in row.guards if guard.safe is None}
    few = {name: count for name, count in inside.items() if count < 20 and name not in never}
    assert not few, few


def test_guarded_results_are_in_the_computed_range(backend: Callable[[str], Backend]) -> None:
    """What follows after a guard relies on it: the guard of unpackHalf2x16 keeps to the halves."""
    chosen = [case for case in guarded_cases() if not case.row.unbounded]
    for case, got in zip(chosen, run(backend("numpy-f32"), "auto", tuple(chosen)), strict=True):
        limits = {"float": (-HOSTILE.max(), HOSTILE.max()), **INTEGERS}
        boxes = [[Range(*limits[kind_of(type_)])] * components(type_) for type_ in case.params]
        found, _ = analysed(case.row, case.params, case.result, boxes, False)
        assert_inside(found, case.result, got, case.title)


def test_without_guards_they_are_not(backend: Callable[[str], Backend]) -> None:
    """The arguments are hostile to every one of these builtins but clamp and atan, which NumPy defines."""
    chosen = guarded_cases()
    bad = {
        case.row.name
        for case, got in zip(chosen, run(backend("numpy-f32"), "none", chosen), strict=True)
        if not np.isfinite(got).all()
    }
    assert {case.row.name for case in chosen} - bad <= {"clamp", "atan", "tan", "tanh", "cosh", "sinh", "asinh"}


HUGE = np.array([sign * size for size in [*_SIZES, 1e10, 1e19, 1e20, 1e30, 1e38] for sign in (1.0, -1.0)], np.float32)


@pytest.mark.parametrize("name", ["numpy-f32", "gl"])
def test_guarded_builtins_of_huge_numbers(name: str, backend: Callable[[str], Backend]) -> None:
    """A thickness from outside may be any finite number; of those whose differences are, too."""
    rows = [row for row in COMPUTED if not row.unbounded]
    lines, calls, chosen = [], [], []
    rng = np.random.default_rng(5)
    for row in rows:
        for params, result in overloads(row):
            if set(params) != {Scalar("float")} or result != Scalar("float"):
                continue
            letters = "abc"[: len(params)]
            inputs = ", ".join(f"thickness {letter}" for letter in letters)
            passed = ", ".join(f"float({letter})" for letter in letters)
            lines.append(f"float case_{len(calls)}({inputs}) {{ return {row.name}({passed}); }}")
            calls.append(Call(f"case_{len(calls)}", params, result, tuple(rng.choice(HUGE, 600) for _ in params)))
            chosen.append(row.name)
    gpu = backend(name)
    compiled = transpile(module_of("\n".join(lines)), gpu.target.name, "cases", guards="auto")
    text = next(text for file, text in compiled.files.items() if not file.endswith(".json"))
    for title, call, got in zip(chosen, calls, gpu.run(Text(text), calls), strict=True):
        wrong = np.flatnonzero(~np.isfinite(got))
        assert not len(wrong), (title, [arg[wrong[0]] for arg in call.args], got[wrong[0]])


def test_guards_are_needed_somewhere_and_superfluous_somewhere() -> None:
    wide, narrow = Range(-LARGEST, LARGEST), Range(1.25, 1.25)
    for row in COMPUTED:
        for guard in row.guards:
            if guard.safe is None:
                continue
            count = max(len(params) for params, _ in overloads(row))
            fixed = [Range(0.5, 0.5), Range(1.5, 1.5), Range(2.0, 2.0)][:count]
            assert not guard.safe(FLOAT32, *[wide] * count), (row.name, guard.problem)
            assert guard.safe(FLOAT32, *[narrow] * count) or guard.safe(FLOAT32, *fixed), (row.name, guard.problem)
