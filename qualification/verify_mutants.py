"""How many single changes of a translation `sssgen transpile --verify` finds.

    python -m qualification.verify_mutants [FILE …] [--each N] [--seed N] [--gl N]

Each function of the files (by default those of `tests/transpile` and `qualification/plain_glsl`) is changed in one
place (`ir_mutations`), up to `--each` times. The original and the changed function run on the inputs that `--verify`
chooses, in float64. A change is found where a defined lane deviates by more than the goal, and by more than rounding
explains: with the errors that other drivers may have, and, in parentheses, as in the translation to GLSL.

Changes that are not found are compared again, on 100,000 other inputs: random ones of several scales, mixed with the
program's constants, their neighbours, and extremes of the types. Where no defined lane differs there by more than the
goal and what rounding explains, the change counts as equivalent. The share is that of the changes found among those
that are not equivalent. With `--gl` so many of the changes that differ are also printed as GLSL and compared by
`--verify` itself in the OpenGL driver.
"""

from __future__ import annotations

from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from random import Random
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from qualification.ir_mutations import Mutation, mutated, mutations
from sssgen.analyse.verify.inline_includes import expand
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.plain_inputs import RANGES
from sssgen.analyse.verify.plain_probes import probe_functions
from sssgen.analyse.verify.rounding_noise import is_explained, noise
from sssgen.analyse.verify.stage_variables import plain
from sssgen.analyse.verify.verification import load
from sssgen.analyse.verify.verified_function import Case, Options
from sssgen.ir.nodes import Literal, Module
from sssgen.ir.types import Sampler, Type, kind_of
from sssgen.ir.walk import all_expressions
from sssgen.run.backends import Array, get
from sssgen.run.evaluate.deviation import GOAL, errors
from sssgen.run.evaluate.evaluation import shape_of

ROOT = Path(__file__).parent.parent
FOLDERS = (ROOT / "tests/transpile", ROOT / "qualification/plain_glsl")
LANES, CHUNK = 100_000, 20_000
"""The number of inputs that decide what is equivalent, and how many run together."""
DRAWS = 32
FEW = 64
"""Of so many unexplained lanes, comparisons are tried with both outcomes."""
SAMPLES = 1000


Outputs: TypeAlias = tuple[list[Array], Array, Array]
"""All outputs, lanes first; the undefined lanes; those without an end."""


class Result(NamedTuple):
    """What became of one change."""

    file: str
    function: str
    mutation: Mutation
    detected: bool
    """By the comparison as for another driver."""
    detected_here: bool
    """By the comparison as for the same driver."""
    differs: bool
    """Whether it changes any result."""

    def __str__(self) -> str:
        return f"{self.file}:{self.mutation.line} {self.function}: {self.mutation.change}"


class Original:
    """A function with verify's inputs."""

    def __init__(self, path: Path, case: Case, seed: int) -> None:
        self.path, self.case, self.seed = path, case, seed
        self.program = case.program
        self.keys = [case.keys[probe.name] for probe in case.case.probes]
        self.function = self.program.functions[case.case.function.key]
        self.rounds = [(dict(inputs.values), dict(inputs.textures)) for inputs in case.inputs]
        self.expected = [self.results(self.program, *inputs) for inputs in self.rounds]

    def results(
        self, program: Program, values: dict[str, Array], textures: dict[str, Any]
    ) -> tuple[list[Array], Array, Array]:
        """All outputs, and the lanes that are undefined, and those without an end."""
        outputs = []
        undefined = endless = np.zeros(1, bool)
        for key in self.keys:
            lanes = next(iter(values.values())).shape[-1]
            run = Run(program, lanes, {**textures, **values})
            outputs.append(np.moveaxis(run.result(key, {**textures, **values}), -1, 0))
            undefined, endless = undefined | run.undefined, endless | run.endless
        return outputs, undefined, endless

    @cached_property
    def limits(self) -> list[tuple[list[Array], list[Array]]]:
        """For each round and output what rounding explains: here, and in another driver."""
        limits = []
        for values, textures in self.rounds:
            lanes = np.arange(next(iter(values.values())).shape[-1])
            arguments = self.program, self.keys, values, textures, lanes, DRAWS
            limits.append((noise(*arguments, granted=False), noise(*arguments, granted=True)))
        return limits

    def detection(self, program: Program) -> tuple[bool, bool]:
        """Whether verify finds the change: in another driver, and here."""
        detected = [False, False]
        for (values, textures), outputs, limits in zip(self.rounds, self.expected, self.limits, strict=True):
            expected, undefined, endless = outputs
            actual, _, hangs = self.results(program, values, textures)
            defined = ~(undefined | endless)
            if (defined & hangs).any():
                return True, True
            for index, (left, right) in enumerate(zip(actual, expected, strict=True)):
                error = np.where(defined, errors(left, right), 0.0)
                for place, kind in enumerate((1, 0)):
                    lanes = np.flatnonzero(~is_explained(error, limits[kind][index]))[:FEW]
                    if len(lanes) and not detected[place]:
                        detected[place] = not self.decided_by_edges(values, index, error[lanes], lanes, kind == 1)
        return detected[0], detected[1]

    def decided_by_edges(self, values: dict[str, Array], index: int, error: Array, lanes: Array, granted: bool) -> bool:
        """Whether comparisons that rounding decides explain all of these deviations."""
        keys = [self.keys[index]]
        textures = self.rounds[0][1]
        (limit,) = noise(self.program, keys, values, textures, lanes, DRAWS, granted, at_edges=True)
        return bool(is_explained(error, limit).all())

    # Independently of verify's inputs

    @cached_property
    def dense(self) -> list[tuple[dict[str, Array], Outputs]]:
        """Many other inputs, and the results."""
        textures = self.rounds[0][1]
        types = {name: (shown, type_) for name, shown, type_ in _inputs(self.case)}
        bounding = loop_inputs(self.program.module, self.keys[0])
        parts = []
        for number in range(LANES // CHUNK):
            rng = np.random.default_rng([self.seed, 77, number])
            values = {
                name: _dense(shown, type_, rng, self.constants, name in bounding)
                for name, (shown, type_) in types.items()
            }
            parts.append((values, self.results(self.program, values, textures)))
        return parts

    @cached_property
    def constants(self) -> tuple[Array, Array]:
        """The literals of the program and their neighbours: floats, integers."""
        literals = [
            part.value
            for function in self.program.module.functions
            for part in all_expressions(function.body or ())
            if isinstance(part, Literal) and not isinstance(part.value, bool)
        ]
        floats = np.array([*literals, 0.0, 1.0, -1.0], np.float64)
        near = [floats, -floats, floats * (1.0 + 2.0**-23), floats * (1.0 - 2.0**-23), floats + 1.0, floats - 1.0]
        whole = np.array([int(value) for value in floats if abs(value) < 2.0**33], np.int64)
        extremes = np.array([0, 1, -1, 2**31 - 1, -(2**31), 2**31, 2**32 - 1])
        return np.concatenate(near), np.concatenate([whole, -whole, whole + 1, whole - 1, extremes])

    def differs(self, program: Program) -> bool:
        """Whether a defined lane of many others differs by more than rounding."""
        textures = self.rounds[0][1]
        for values, (expected, undefined, endless) in self.dense:
            actual, _, hangs = self.results(program, values, textures)
            defined = ~(undefined | endless)
            if (defined & hangs).any():
                return True
            for index, (left, right) in enumerate(zip(actual, expected, strict=True)):
                error = np.where(defined, errors(left, right), 0.0)
                lanes = np.flatnonzero(error > GOAL)[:256]
                if len(lanes):
                    limit = noise(self.program, [self.keys[index]], values, textures, lanes, DRAWS, granted=True)[0]
                    left_over = lanes[~is_explained(error[lanes], limit)]
                    if len(left_over) and not self.decided_by_edges(values, index, error[left_over], left_over, True):
                        return True
        return False


def _inputs(case: Case) -> Iterator[tuple[str, str, Type]]:
    for leaf in case.case.probes[0].leaves:
        if not isinstance(leaf.type, Sampler):
            yield leaf.name, leaf.path.removeprefix("local_"), leaf.type
    for name, param in case.uniforms().items():
        if not isinstance(param.type, Sampler):
            yield name, name, param.type


def _dense(
    shown: str, type_: Type, rng: np.random.Generator, constants: tuple[Array, Array], bounds_loops: bool
) -> Array:
    shape, kind = (*shape_of(type_), CHUNK), kind_of(type_)
    if kind == "bool":
        return rng.random(shape) < 0.5
    mode = rng.integers(0, 6, shape)
    if kind == "float":
        if shown in RANGES:
            return rng.uniform(*RANGES[shown], shape).astype(np.float32).astype(np.float64)
        sign = rng.choice([-1.0, 1.0], shape)
        choices = [
            rng.choice(constants[0], shape), rng.uniform(-1.0, 1.0, shape), rng.uniform(-3.0, 3.0, shape),
            rng.uniform(-100.0, 100.0, shape), sign * 10.0 ** rng.uniform(-6.0, 6.0, shape),
            rng.integers(-8, 9, shape).astype(np.float64),
        ]  # fmt: skip
        value = np.choose(mode, choices)
        if bounds_loops:
            value = rng.uniform(-2.0, 20.0, shape)
        with np.errstate(all="ignore"):
            rounded: Array = np.clip(value, -3e38, 3e38).astype(np.float32).astype(np.float64)
        return np.where(np.abs(rounded) < 2.0**-126, 0.0, rounded)
    choices = [
        rng.choice(constants[1], shape), rng.integers(-10, 11, shape), rng.integers(0, 300, shape),
        rng.integers(-3000, 3000, shape), rng.integers(0, 2**32, shape),
        rng.integers(0, 2**32, shape) >> rng.integers(0, 32, shape),
    ]  # fmt: skip
    whole = np.choose(mode, choices)
    if bounds_loops:
        whole = rng.integers(0, 40, shape)
    low = (whole & 0xFFFFFFFF).astype(np.uint32)
    return low if kind == "uint" else low.view(np.int32)


def originals(path: Path, seed: int) -> Iterator[Original]:
    """The functions of a file that verify runs."""
    written = plain(expand(path.read_text(), path, [path.parent / "include"]))
    shown = path.name
    module = load(written.text, shown, written.version)
    functions = [part for part in module.functions if part.body is not None and part.span.file == shown]
    cases = [case for case in probe_functions(module, functions, written.text) if case.probes]
    probes = "\n".join(probe.text for case in cases for probe in case.probes)
    with_probes = load(written.text + probes, shown, written.version)
    for number in range(len(cases)):
        case = Case(cases[number], written, with_probes, {}, Options(SAMPLES, seed))
        if case.inputs:
            yield Original(path, case, seed)


def changed(original: Original, mutation: Mutation) -> Module:
    """The program with one change."""
    module = original.program.module
    functions = tuple(
        [mutated(function, mutation) if function is original.function else function for function in module.functions]
    )
    return module._replace(functions=functions)


def results(original: Original, each: int, random: Random) -> Iterator[Result]:
    """Some changes of a function."""
    every = mutations(original.function)
    for mutation in random.sample(every, min(each, len(every))):
        program = Program(changed(original, mutation))
        detected, detected_here = original.detection(program)
        differs = detected or detected_here or original.differs(program)
        yield Result(original.path.name, original.function.key, mutation, detected, detected_here, differs)


def in_driver(original: Original, mutation: Mutation, gl: Any) -> bool:
    """Whether verify finds the change in the text that is printed as GLSL."""
    case = original.case
    case.machines = {"gl": gl}
    module = case.module
    expected, _ = case.outputs([])
    undefined, _ = case.analysis()
    finite = [np.isfinite(value).reshape(len(value), -1).all(axis=1) for value in expected.values()]
    try:
        case.module, case.texts = changed(original, mutation), {}
        actual = case.outputs(["glsl"])[1]["glsl"]
    finally:
        case.module, case.texts = module, {}
    if isinstance(actual, str):
        return True
    return bool(case.deviations("glsl", actual, expected, np.all(finite, axis=0) & ~undefined).unexplained.any())


def main(arguments: Sequence[str] | None = None) -> int:
    parser = ArgumentParser(prog="python -m qualification.verify_mutants", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--each", type=int, default=20, help="the most changes of a function (default: 20)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--gl", type=int, default=0, metavar="N", help="also so many changes in the OpenGL driver")
    options = parser.parse_args(arguments)
    files = options.files or sorted(
        path for folder in FOLDERS for path in folder.glob("*.glsl") if "shadertoy" not in path.name
    )
    if not files:
        parser.error("name a FILE: those of tests/transpile are not here")
    if missing := [str(path) for path in files if not path.is_file()]:
        parser.error(f"there is no file {missing[0]}")
    random = Random(options.seed)
    total: list[Result] = []
    sample: list[tuple[Original, Result]] = []
    for path in files:
        part: list[Result] = []
        for original in originals(path, options.seed):
            for result in results(original, options.each, random):
                part.append(result)
                if result.differs:
                    sample.append((original, result))
            original.__dict__.pop("dense", None)
        total += part
        print(_line(path.name, part), flush=True)
        for result in part:
            if result.differs and not result.detected:
                print(f"    not found: {result}{' (found in the same driver)' if result.detected_here else ''}")
    print(_line("total", total))
    if options.gl and sample:
        gl = get("gl")
        chosen = random.sample(sample, min(options.gl, len(sample)))
        counts = Counter(in_driver(original, result.mutation, gl) for original, result in chosen)
        print(f"in the OpenGL driver: {counts[True]} of {len(chosen)} found ({counts[True] / len(chosen):.2%})")
    return 0


def _is_plain(path: Path) -> bool:
    return path.suffix in (".glsl", ".frag", ".vert") and "shadertoy" not in path.name


def _line(title: str, part: list[Result]) -> str:
    differing = [result for result in part if result.differs]
    detected, here = sum(result.detected for result in differing), sum(result.detected_here for result in differing)
    share = f"{detected / len(differing):.2%} ({here / len(differing):.2%} in the same driver)" if differing else "–"
    equivalent = len(part) - len(differing)
    return f"{title:24} {len(part)} changes, {equivalent} equivalent, {detected} of {len(differing)} found: {share}"


if __name__ == "__main__":
    raise SystemExit(main())
