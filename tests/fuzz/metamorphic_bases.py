"""Functions of GLSL files as a base of rewrites: their inputs, and the results that every rewrite must have.

The results are those of the interpreter of `sssgen transpile --verify`, in float64, in lanes in which no operation is
undefined, no variable is read before it is written, and rounding does not move them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from random import Random
from typing import NamedTuple

import numpy as np

from glsl_batches import LANES
from ir_rewrites import rewritten
from known_answers import SWITCHES
from metamorphic_cases import KnownCase
from qualification.ir_mutations import mutated, mutations
from sssgen.analyse.verify.inline_includes import expand
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.lane_values import DTYPES, Value, build_value
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.plain_inputs import Source, draw_inputs, select_lanes, suggest_numbers
from sssgen.analyse.verify.plain_probes import probe_functions
from sssgen.analyse.verify.rounding_noise import noise
from sssgen.analyse.verify.stage_variables import plain
from sssgen.analyse.verify.time_limit import TimeLimit, TimeOverError
from sssgen.analyse.verify.verification import load
from sssgen.ir.nodes import Module, Param
from sssgen.ir.types import Sampler, Type
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.passes.prune import prune
from sssgen.passes.reachable import drop_unused, keep_reachable
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array
from sssgen.support.diagnostics import SssgenError

DRAWN = 6 * LANES
FEWEST = 4
"""The fewest lanes that are worth a comparison."""
STEADY = 1e-5
SECONDS = 3.0
"""For the interpreter's runs of one function."""
ROUNDS = 200
"""The most rounds of loops in a lane: rewrites of long loops take long everywhere."""
LARGEST = 4000
"""The most expressions of a function with all that it calls: tables of colours take minutes to compile."""
TRIES = 3
"""How many functions of a file are tried."""


MARKS = {"float": np.nan, "int": 0x5A5A5A5A, "uint": 0xA5A5A5A5, "bool": True}
"""What a variable may have before it is written, by kind."""


class MarkedRun(Run):
    """A run that has marks, not 0, in variables that were not written: a result that they change is undefined."""

    def unwritten(self, type_: Type) -> Value:
        return build_value(type_, lambda shape, kind: np.full((*shape, self.lanes), MARKS[kind], DTYPES[kind]))


class Base(NamedTuple):
    """One function that can be run."""

    origin: str
    module: Module
    """Without uniforms and module variables, which are parameters."""
    key: str
    params: tuple[Param, ...]
    result: Type
    arguments: Mapping[str, Array]
    expected: Array
    """Lanes last."""
    valid: Array


def base_from(path: Path, root: Path, random: Random) -> Base | None:
    """A function of a file that can be run without textures; None where a few tries find none."""
    try:
        written = plain(expand(path.read_text("utf-8", errors="replace"), path, [root]))
        shown = path.relative_to(root).as_posix()
        module = load(written.text, shown, written.version)
        functions = [part for part in module.functions if part.body is not None and part.span.file == shown]
        cases = [case for case in probe_functions(module, functions, written.text) if case.probes]
        cases = random.sample(cases, min(len(cases), TRIES))
        text = written.text + "\n".join(probe.text for case in cases for probe in case.probes)
        module = load(text, shown, written.version)
    except (SssgenError, OSError):
        return None
    for case in cases:
        probe = random.choice(case.probes)
        key = next(function.key for function in module.functions if function.name == probe.name)
        sources = {leaf.name: Source(leaf.name, leaf.author_name, leaf.type) for leaf in probe.leaves}
        base = base_of(f"{shown} {case.function.key}", module, key, sources)
        if base is not None:
            return base
    return None


def base_of(origin: str, module: Module, key: str, sources: Mapping[str, Source]) -> Base | None:
    """A function with its inputs and results; None where it has textures, or few lanes are defined."""
    module = keep_reachable(module, [key])
    variables = tuple([variable._replace(value=None) for variable in module.variables])
    module = prune(module._replace(variables=variables), [key])
    bounding = loop_inputs(module, key)
    if module.variables:
        module = variables_to_parameters(module, key)
    name = key.partition("(")[0]
    module = uniforms_to_parameters(module)
    module = drop_unused(module._replace(uniforms=()), False)
    function = next(function for function in module.functions if function.name == name)
    if any(isinstance(param.type, Sampler) for param in function.params) or _size(module) > LARGEST:
        return None
    chosen = [
        sources.get(param.name, Source(param.name, param.name, param.type, uniform=True))._replace(
            bounds_loops=param.name in bounding
        )
        for param in function.params
    ]
    values = draw_inputs(chosen, DRAWN, suggest_numbers(module), 1)
    return with_results(Base(origin, module, function.key, function.params, function.result, values, np.zeros(0),
                             np.zeros(0)))  # fmt: skip


def _size(module: Module) -> int:
    """The number of expressions of a module."""
    values = [part for constant in module.constants for part in subexpressions(constant.value)]
    bodies = [part for function in module.functions for part in all_expressions(function.body or ())]
    return len(values) + len(bodies)


def with_results(base: Base) -> Base | None:
    """The base with the lanes of its arguments that are defined and steady, and their results; None for few lanes."""
    limit = TimeLimit(each=SECONDS)
    limit.start_function()
    program = Program(base.module, limit.check)
    if program.neighbours:
        return None
    lanes = next(iter(base.arguments.values())).shape[-1]
    runs = [kind(program, lanes, base.arguments, limit=ROUNDS) for kind in (Run, MarkedRun)]
    try:
        expected, marked = [np.asarray(run.result(base.key, base.arguments)) for run in runs]
        good = (expected == marked).reshape(-1, lanes).all(axis=0)
        for run in runs:
            good &= ~(run.undefined | run.endless)
        places = np.flatnonzero(good)[: 3 * LANES]
        if len(places) < FEWEST:
            return None
        moved = noise(program, [base.key], dict(base.arguments), {}, places, 4, True)[0]
    except (TimeOverError, MemoryError):
        return None
    places = places[moved <= STEADY][:LANES]
    if len(places) < FEWEST:
        return None
    padded = np.resize(places, LANES)
    return base._replace(
        arguments=select_lanes(dict(base.arguments), padded), expected=expected[..., padded], valid=np.ones(LANES, bool)
    )


def steady_lanes(base: Base) -> Array:
    """The lanes that rounding does not move, of more runs with errors, and with any outcome of near comparisons."""
    program, lanes = Program(base.module), np.arange(LANES)
    arguments = program, [base.key], dict(base.arguments), {}, lanes, 64, True
    moved = [noise(*arguments, seed=1, at_edges=at_edges)[0] for at_edges in (False, True)]
    steady: Array = np.fmax(*moved) <= STEADY
    return steady


def text_of(base: Base, module: Module, suffix: str) -> tuple[str, str]:
    """The name of the entry and the text of a rewritten base, whose names at file scope get a suffix."""
    compiled = transpile(module, "glsl-330", "rewritten", "none", [base.key], keep=True)
    text = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    text = re.sub(rf"^\s*uniform\s+ivec4\s+{SWITCHES};\s*$", "", text, flags=re.MULTILINE)
    fields = {field.name for struct in module.structs for field in getattr(struct.type, "fields", ())}
    names = set(re.findall(r"^(?:const )?\w+(?:\[\d+\])* (\w+)\s*[(\[=]|^struct (\w+)", text, re.MULTILINE))
    names = {name for pair in names for name in pair if name}
    entry = compiled.reflection["renames"].get(base.key.partition("(")[0], base.key.partition("(")[0])
    for before, chosen in ((r"(?<![\w.])", names - fields), (r"\b", names & fields)):
        if chosen:
            text = re.sub(rf"{before}({'|'.join(map(re.escape, sorted(chosen)))})\b", rf"\1{suffix}", text)
    return f"{entry}{suffix}", text


def rewritten_case(base: Base, random: Random, number: int) -> KnownCase:
    """The base with some of its code rewritten, which keeps its results."""
    entry, text = text_of(base, rewritten(base.module, random), f"_r{number}")
    return case_of("rewrite", base, entry, text)


def case_of(kind: str, base: Base, entry: str, text: str) -> KnownCase:
    """A program with the results of a base."""
    case = KnownCase(kind, text, entry, base.result, base.arguments, base.expected, base.valid, base.origin)
    case.steady = partial(steady_lanes, base)
    return case


def same_case(base: Base, number: int) -> KnownCase:
    """The base as it is."""
    entry, text = text_of(base, base.module, f"_r{number}")
    return case_of("base", base, entry, text)


def mutated_case(base: Base, random: Random, number: int) -> KnownCase | None:
    """The base with a few of its nodes changed, and the interpreter's results of that; None where few are defined."""
    module = base.module
    for _ in range(random.choice((1, 2, 3, 5))):
        function = random.choice(module.functions)
        changes = mutations(function)
        if changes:
            new = mutated(function, random.choice(changes))
            functions = tuple([new if part is function else part for part in module.functions])
            module = module._replace(functions=functions)
    changed = with_results(base._replace(module=module))
    if changed is None:
        return None
    entry, text = text_of(changed, changed.module, f"_r{number}")
    return case_of("mutation", changed, entry, text)
