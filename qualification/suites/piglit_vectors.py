"""Piglit's vectors: arguments of builtins and operators, with results and tolerances, run on every back end.

Piglit computes them with NumPy in a module of its own, which is loaded from its folder. A case is one overload; each of
its vectors has a result.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np

from qualification.suites.compiled_texts import crash
from qualification.suites.deqp_cases import Value
from qualification.suites.deqp_programs import numbers
from qualification.suites.machines import AUTHOR, BACKENDS, machines
from qualification.suites.outcomes import FRONT, INVALID, REFUSED, RIGHT, SKIPPED, WRONG, Outcome, Result
from sssgen.analyse.verify.driven_function import DrivenFunction, Inputs
from sssgen.analyse.verify.plain_probes import probe_functions
from sssgen.analyse.verify.stage_variables import Plain
from sssgen.analyse.verify.verification import load
from sssgen.ir.types import kind_of
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.support.diagnostics import SssgenError

MODULE = "generated_tests/builtin_function.py"
VERSION = "450"
_KIND = "values"


class Vector(NamedTuple):
    """One set of arguments; a matrix is its numbers column by column."""

    arguments: tuple[tuple[float, ...], ...]
    result: tuple[float, ...]
    tolerance: float
    """The largest distance of a result"""


class VectorCase(NamedTuple):
    """One overload of a builtin or operator."""

    name: str
    """`piglit-vectors/step(float, vec3)`"""
    expression: str
    """`step(a0, a1)`"""
    result: str
    arguments: tuple[str, ...]
    vectors: tuple[Vector, ...]
    extension: str = ""
    """What it needs beyond GLSL"""


def cases(root: Path) -> Iterator[VectorCase]:
    """The overloads of piglit's module in a folder."""
    module = _module(root / MODULE)
    for signature, vectors in module.test_suite.items():
        arguments = tuple(map(str, signature.argtypes))
        names = [f"a{number}" for number in range(len(arguments))]
        yield VectorCase(
            f"piglit-vectors/{signature.name}({', '.join(arguments)})",
            signature.template.format(*names),
            str(signature.rettype),
            arguments,
            tuple(
                Vector(tuple(map(_numbers, vector.arguments)), _numbers(vector.result), float(vector.tolerance))
                for vector in vectors
            ),
            signature.extension or "",
        )


def _module(path: Path) -> ModuleType:
    """The module of a file. It is outside of every package."""
    specification = importlib.util.spec_from_file_location("piglit_builtin_function", path)
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")  # it computes what overflows, too
        specification.loader.exec_module(module)
    return module


def _numbers(value: object) -> tuple[float, ...]:
    return tuple(map(float, np.reshape(np.array(value), -1, "F")))


def run_cases(cases: Sequence[VectorCase]) -> list[Result]:
    """The results of each vector of the cases."""
    return [result for case in cases for result in run_case(case)]


def run_case(case: VectorCase) -> list[Result]:
    """The results of the vectors of one overload."""
    names = [f"{case.name}[{number}]" for number in range(len(case.vectors))]
    if case.extension:
        outcome = Outcome(SKIPPED, f"it needs {case.extension}")
        return [Result(name, "skipped", {FRONT: outcome}) for name in names]
    running = machines().running
    try:
        program = _Program(case, running)
    except SssgenError as error:
        outcome = Outcome(REFUSED, error.diagnostics[0].message)
        return [Result(name, _KIND, dict.fromkeys(BACKENDS, outcome)) for name in names]
    except Exception as error:  # a bug, which the table shows
        return [Result(name, _KIND, dict.fromkeys(BACKENDS, crash(error))) for name in names]
    columns = {AUTHOR: program.outcomes(program.function.original)}
    for backend in BACKENDS:
        if backend in running:
            columns[backend] = program.outcomes(partial(program.function.run_translation, backend))
    rows = [{title: column[number] for title, column in columns.items()} for number in range(len(names))]
    return [Result(name, _KIND, row) for name, row in zip(names, rows, strict=True)]


class _Program:
    """An overload as a function of its arguments. Raises SssgenError where the front end refuses it."""

    def __init__(self, case: VectorCase, running: Mapping[str, BackendProcess]) -> None:
        self.case = case
        params = ", ".join(f"{type_} a{number}" for number, type_ in enumerate(case.arguments))
        # piglit's text for `+=` is `a0; result += a1`
        text = f"{case.result} evaluated({params}) {{ {case.result} result = {case.expression}; return result; }}\n"
        module = load(text, "vectors.glsl", VERSION)
        (probes,) = probe_functions(module, list(module.functions), text)
        (self.probe,) = probes.probes
        self.function = DrivenFunction(
            probes, Plain(VERSION, text), load(text + self.probe.text, "vectors.glsl", VERSION), running
        )
        lanes = range(len(case.vectors))
        values = {}
        for leaf, number in zip(self.probe.leaves, range(len(case.arguments)), strict=True):
            rows = tuple(vector.arguments[number] for vector in case.vectors)
            values[leaf.name] = numbers(leaf.type, Value("input", "", leaf.name, rows), lanes)
        self.inputs = Inputs(values, {})
        expected = Value("output", "", "result", tuple(vector.result for vector in case.vectors))
        self.expected = numbers(self.probe.result, expected, lanes).astype(np.float64)

    def outcomes(self, run: Callable[[Inputs], list[Array]]) -> list[Outcome]:
        """The outcome of each vector."""
        count = len(self.case.vectors)
        try:
            (actual,) = run(self.inputs)
        except SssgenError as error:
            return [Outcome(INVALID, error.diagnostics[0].message)] * count
        except Exception as error:
            return [crash(error)] * count
        lanes = actual.astype(np.float64).reshape(-1, count).T
        expected = self.expected.reshape(-1, count).T
        is_float = kind_of(self.probe.result) == "float"
        outcomes = []
        for lane, right, vector in zip(lanes, expected, self.case.vectors, strict=True):
            limit = vector.tolerance if is_float else 0.0
            if np.linalg.norm(lane - right) <= limit:
                outcomes.append(Outcome(RIGHT))
            else:
                outcomes.append(Outcome(WRONG, f"{vector.arguments} is {lane.tolist()}, {right.tolist()} is expected"))
        return outcomes
