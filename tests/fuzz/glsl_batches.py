"""Runs random programs on the targets, many in one text, and compares the results with the interpreter's."""

from __future__ import annotations

import re
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from functools import cache
from random import Random
from typing import Any, NamedTuple

import numpy as np

from glsl_interpreter import Interpreter
from glsl_programs import INPUTS
from glsl_tree import Program, source
from glsl_values import Undefined, kind, matrix_size, vector_size
from hlsl_in_vulkan import HLSLInVulkan
from sssgen.ir.nodes import Module
from sssgen.ir.types import BY_NAME
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend, Call, Text, call_program
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.glsl_reread import reread, run_reread
from sssgen.run.backends.opengl import HEADS
from sssgen.run.compilers import CompilerMissing
from sssgen.support.diagnostics import SssgenError

LANES = 16
SECONDS = 120.0
TOLERANCE = 1e-3
"""For results that may be rounded, relative to the larger of their size and 1."""
TARGETS = ("numpy", "gl", "gl-es", "webgpu", "hlsl")
"""The back ends of the five targets."""
VULKAN = "hlsl-vulkan"
"""The second way to run HLSL, where the first one computes something wrong."""
EXTREMES = {
    "int": (0, 1, -1, 2, 3, 7, -8, 31, 32, 100, 255, -256, 65535, 65536, 1 << 24, (1 << 24) + 1, -(1 << 30), 1 << 30,
            0x55555555, 2147483646, 2147483647, -2147483647, -2147483648),
    "uint": (0, 1, 2, 3, 7, 8, 31, 32, 100, 255, 65535, 65536, 1 << 30, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xAAAAAAAA,
             0xFFFFFFFE, 0xFFFFFFFF),
}  # fmt: skip

Value = Any


class Failure(NamedTuple):
    """What is wrong with one program."""

    target: str
    kind: str
    """`wrong`, `invalid` (a compiler refuses the text), `refused` (the transpiler does), `crash`; `tool`: a fault of
    what runs the text: spirv-cross ends with an assertion, or `cause`."""
    message: str
    cause: str = ""
    """Why the text is right although its results are wrong; '' where nothing shows it."""


def drawn(type_: str, random: Random) -> Value:
    """A random value of a scalar, vector or matrix type."""
    if size := matrix_size(type_):
        return tuple(tuple(random.randrange(-4, 5) / 2.0 for _ in range(size)) for _ in range(size))
    if size := vector_size(type_):
        return tuple(drawn(kind(type_), random) for _ in range(size))
    if type_ == "bool":
        return random.random() < 0.5
    if type_ == "float":
        return random.choice((random.randrange(-64, 65) / 8.0, float(random.randrange(-9, 10))))
    if random.random() < 0.5:
        return random.choice(EXTREMES[type_])
    return random.getrandbits(32) - (0x80000000 if type_ == "int" else 0)


@cache
def arguments() -> list[list[Value]]:
    """The arguments of every entry: a list of lanes for each parameter."""
    random = Random(7)
    return [[drawn(type_, random) for _ in range(LANES)] for type_ in INPUTS]


def lanes_last(type_: str, lanes: Sequence[Value]) -> np.ndarray[Any, Any]:
    """Values of lanes in the layout of the back ends."""
    dtypes = {"int": np.int32, "uint": np.uint32, "bool": np.bool_, "float": np.float64}
    return np.moveaxis(np.array(lanes, dtypes[kind(type_)]), 0, -1)


class Case:
    """A program with its expected results."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.text = source(program)
        random = Random(11)
        self.uniforms = {
            variable.name: [drawn(variable.type, random) for _ in range(LANES)]
            for variable in program.variables
            if variable.qualifier == "uniform"
        }
        self.valid = np.zeros(LANES, np.bool_)
        self.expected = np.zeros((LANES, 4), np.float64)
        self.reasons: Counter[str] = Counter()
        interpreter = Interpreter(program)
        for lane in range(LANES):
            values = {name: lanes[lane] for name, lanes in self.uniforms.items()}
            try:
                self.expected[lane] = interpreter.run([argument[lane] for argument in arguments()], values)
                self.valid[lane] = True
            except Undefined as reason:
                self.reasons[str(reason)] += 1

    @property
    def is_useful(self) -> bool:
        """Whether most lanes are defined."""
        return int(self.valid.sum()) >= LANES // 2

    def wrong_lanes(self, result: np.ndarray[Any, Any]) -> list[int]:
        """The lanes whose result is not the expected one."""
        result = np.moveaxis(result, -1, 0).astype(np.float64)
        if result.shape != self.expected.shape:
            return [0]
        limit = TOLERANCE * np.maximum(1.0, np.abs(self.expected)) if self.program.smooth else 0.0
        wrong = ~(np.abs(result - self.expected) <= limit) & self.valid[:, None]
        return [int(lane) for lane in np.flatnonzero(wrong.any(axis=1))]

    def difference(self, result: np.ndarray[Any, Any], lane: int) -> str:
        """The result of a lane, and the expected one."""
        result = np.moveaxis(result, -1, 0).astype(np.float64)
        if result.shape != self.expected.shape:
            return f"a result of the shape {result.shape}"
        values = [argument[lane] for argument in arguments()]
        return f"lane {lane} {values}: {result[lane].tolist()}, expected {self.expected[lane].tolist()}"


class Runner:
    """The back ends, each in its own process."""

    def __init__(self, targets: Sequence[str] = TARGETS) -> None:
        self.backends: dict[str, Backend] = {}
        self.targets = targets
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self.head = ""
        """Declarations that all programs share."""
        self.running: tuple[str, Sequence[Case]] | None = None
        """The target and the programs that ran last."""

    def backend(self, name: str) -> Backend:
        if name not in self.backends:
            self.backends[name] = HLSLInVulkan(name) if name == VULKAN else BackendProcess(name, SECONDS)
        return self.backends[name]

    def close(self) -> None:
        for backend in self.backends.values():
            backend.close()

    def timed(self, stage: str, function: Callable[..., Any], *args: Any) -> Any:
        start = time.perf_counter()
        try:
            return function(*args)
        finally:
            self.seconds[stage] += time.perf_counter() - start

    def failures(self, cases: Sequence[Case]) -> list[tuple[Case, Failure]]:
        """What is wrong with programs that can stand in one text."""
        failures: list[tuple[Case, Failure]] = []
        try:
            text = self.head + "".join(case.text for case in cases)
            module = self.timed("parse", load_glsl_text, text, "fuzzed.glsl").module
        except Exception as error:
            if len(cases) == 1:
                return [(cases[0], self.failure("front end", error))]
            half = (len(cases) + 1) // 2
            return self.failures(cases[:half]) + self.failures(cases[half:])
        for target in self.targets:
            failures += self.of_target(target, module, cases)
        return failures

    def failure(self, target: str, error: Exception) -> Failure:
        if isinstance(error, SssgenError):
            message = "; ".join(diagnostic.message for diagnostic in error.diagnostics[:2])
            if re.search(r"did not finish within \d", message):
                return Failure(target, "tool", message, "timeout")
            if "Assertion `" in message or "spirv-val: error" in message:
                # the compiler accepted the text, and failed itself, or made SPIR-V that breaks its rules
                return Failure(target, "tool", message)
            if re.fullmatch(r"nested more than \d+ levels deep", message):
                return Failure(target, "limit", message)  # macros nest more than the brackets of the text show
            driver = re.match(r"(?:gl|gl-es|webgpu|hlsl|browser)\S*: ", message)
            return Failure(target, "invalid" if driver else "refused", message)
        return Failure(target, "crash", f"{type(error).__name__}: {error}")

    def of_target(self, target: str, module: Module, cases: Sequence[Case]) -> list[tuple[Case, Failure]]:
        self.running = target, cases
        try:
            results = self.results(target, module, cases)
        except Exception as error:
            if len(cases) == 1:
                return [(cases[0], self.failure(target, error))]
            half = (len(cases) + 1) // 2
            return [
                failure for part in (cases[:half], cases[half:]) for failure in self.of_target(target, module, part)
            ]
        failures = []
        for index, (case, result) in enumerate(zip(cases, results, strict=True)):
            lanes = case.wrong_lanes(result)
            if lanes:
                cause = self.fault_of_tools(target, module, cases, index, lanes)
                message = case.difference(result, lanes[0])
                failures.append((case, Failure(target, "tool" if cause else "wrong", message, cause)))
        return failures

    def fault_of_tools(
        self, target: str, module: Module, cases: Sequence[Case], index: int, lanes: Sequence[int]
    ) -> str:
        """What shows that wrong results of a case are no fault of the text; '' if nothing does.

        - A driver computes each lane right where all lanes have its arguments (llvmpipe's control flow).
        - Vulkan computes all lanes right from the SPIR-V that the same compiler makes of the same HLSL. So the compiler
          reads the text as it is meant, and what remains of the first way is at fault: spirv-cross, or OpenGL's GLSL.
          Another compiler of HLSL would show less: where the language leaves an order open, each may take its own.
        - GLSL is right in the same driver, or in NumPy, as glslang reads it: from what spirv-cross makes of its SPIR-V.
        - GLSL is right in that way, and wrong in OpenGL, in the same lanes: a driver compiles all texts alike. It
          moves the terms of a sum, such as `1.0 - x + 1.0e-10`.
        """
        if target == "numpy":
            return ""
        if not any(self.is_wrong_alone(target, module, cases, index, lane) for lane in lanes):
            return "divergent lanes"
        if target == "hlsl" and self.is_right_in_vulkan(module, cases, index):
            return "right in Vulkan"
        if target in ("gl", "gl-es") and self.is_right_reread(target, module, cases, index):
            return "right as glslang reads it"
        if target in ("webgpu", "hlsl") and self.is_wrong_in_opengl(module, cases, index, lanes):
            return "as in OpenGL"
        return ""

    def is_wrong_in_opengl(self, module: Module, cases: Sequence[Case], index: int, lanes: Sequence[int]) -> bool:
        """Whether a driver computes these lanes wrong of a text of GLSL, too, that is right as glslang reads it."""
        try:
            wrong = cases[index].wrong_lanes(self.results("gl", module, cases)[index])
        except (SssgenError, CompilerMissing):
            return False
        return set(lanes) <= set(wrong) and self.is_right_reread("gl", module, cases, index)

    def is_right_in_vulkan(self, module: Module, cases: Sequence[Case], index: int) -> bool:
        """Whether Vulkan computes all lanes of a case right; not where Vulkan is missing or fails."""
        try:
            return not cases[index].wrong_lanes(self.results(VULKAN, module, cases)[index])
        except (SssgenError, CompilerMissing):
            return False

    def is_right_reread(self, target: str, module: Module, cases: Sequence[Case], index: int) -> bool:
        """Whether a text of GLSL is right as glslang reads it: in OpenGL, or for NumPy."""
        case = cases[index]
        text, calls = self.emitted(target, module, [case])
        backend = self.backend(target)
        assert isinstance(backend, BackendProcess)
        try:
            if not case.wrong_lanes(backend.apply(run_reread, text, calls)[0]):
                return True
            drawing, _ = call_program.drawing(backend.target, text, calls, {})
            again = load_glsl_text(reread(HEADS[backend.target.name] + drawing.fragment.text.text), "reread.glsl")
            return not case.wrong_lanes(self.results("numpy", again.module, [case])[0])
        except (SssgenError, CompilerMissing, ValueError, KeyError):
            return False

    def is_wrong_alone(self, target: str, module: Module, cases: Sequence[Case], index: int, lane: int) -> bool:
        """Whether a lane of a case is wrong, too, where all lanes have its arguments."""
        return lane in cases[index].wrong_lanes(self.results(target, module, cases, lane)[index])

    def results(
        self, target: str, module: Module, cases: Sequence[Case], lane: int | None = None
    ) -> list[np.ndarray[Any, Any]]:
        """The results of the cases in one text; with `lane`, all lanes have its arguments."""
        if target == "numpy" and any(case.program.has_state for case in cases) and len(cases) > 1:
            return [self.results(target, module, [case])[0] for case in cases]
        text, calls = self.emitted(target, module, cases)
        if lane is not None:
            calls = [call._replace(args=tuple([_of_lane(arg, lane) for arg in call.args])) for call in calls]
        results: list[np.ndarray[Any, Any]] = self.timed(f"run {target}", self.backend(target).run, text, calls)
        return results

    def emitted(self, target: str, module: Module, cases: Sequence[Case]) -> tuple[Text, list[Call]]:
        """The text of a target, and the calls of its functions."""
        backend = self.backend(target)
        keys = {function.name: function.key for function in module.functions}
        called = [keys[case.program.entry] for case in cases]
        module = keep_reachable(module, called)
        if target == "numpy" and module.variables:
            module = variables_to_parameters(module, called[0])
        closed = {function.name: function.params for function in uniforms_to_parameters(module).functions}
        compiled = self.timed(
            f"transpile {target}", lambda: transpile(module, backend.target.name, "fuzzed", keep=True, called=called)
        )
        text = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
        renames = compiled.reflection["renames"]
        return Text(text), [self.call(case, closed[case.program.entry], renames) for case in cases]

    def call(self, case: Case, params: Sequence[Any], renames: dict[str, str]) -> Call:
        args = [lanes_last(type_, lanes) for type_, lanes in zip(INPUTS, arguments(), strict=True)]
        for param in params[len(INPUTS) :]:
            type_ = next(variable.type for variable in case.program.variables if variable.name == param.name)
            args.append(lanes_last(type_, case.uniforms[param.name]))
        entry = case.program.entry
        result = BY_NAME["vec4" if case.program.smooth else "ivec4"]
        return Call(renames.get(entry, entry), tuple(param.type for param in params), result, tuple(args))


def _of_lane(arg: Any, lane: int) -> Any:
    """An argument whose lanes all have the value of one."""
    return np.repeat(arg[..., lane : lane + 1], LANES, axis=-1)
