"""Random plain GLSL on every target, against the interpreter of `glsl_interpreter.py`; by hand: `random_glsl.py`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

import random_glsl
from glsl_batches import TARGETS, VULKAN, Case, Failure, Runner
from glsl_programs import INPUTS
from glsl_reduction import reduced, size
from glsl_tree import Function, Node, Parameter, Program, source
from hlsl_in_vulkan import HLSLInVulkan
from skips import or_skip
from slow_cases import some_slow
from sssgen.run.backends import Backend
from sssgen.support import diagnostics

FEW, MANY = 4, 140
"""Batches in a test run, and in a long one: 64 and 2,240 programs."""


@pytest.fixture(scope="module")
def runners() -> Iterator[dict[str, Runner]]:
    """One runner per target; its back ends end with the tests."""
    runners = {target: Runner((target,)) for target in TARGETS}
    yield runners
    for runner in runners.values():
        runner.close()


def failures(runner: Runner, seed: int, batches: int) -> list[str]:
    messages = []
    for number in range(batches):
        cases = [case for case in random_glsl.batch(seed, number) if case.is_useful]
        assert len(cases) > random_glsl.BATCH // 2
        for case, failure in runner.failures(cases):
            if failure.kind != "tool":
                messages.append(
                    f"{random_glsl.title(failure)}, batch {number} of seed {seed}\n{failure.message}\n{case.text}"
                )
    return messages


@pytest.mark.parametrize("target", some_slow(TARGETS, "numpy", "webgpu"))
def test_random_programs(backend: Callable[[str], Backend], runners: dict[str, Runner], target: str) -> None:
    backend(target)  # skips where it is missing
    messages = failures(runners[target], 20, FEW)
    assert not messages, "\n\n".join(messages[:3])


@pytest.mark.slow
@pytest.mark.parametrize("target", TARGETS)
def test_many_random_programs(backend: Callable[[str], Backend], runners: dict[str, Runner], target: str) -> None:
    backend(target)
    messages = failures(runners[target], 21, MANY)
    assert not messages, "\n\n".join(messages[:3])


def program_of(value: Node) -> Program:
    """A program that returns the value in the first of its four numbers; its inputs are a, b, c and so on."""
    zero = Node("literal", "int", [], (0, "0"))
    result = Node("return", "ivec4", [Node("construct", "ivec4", [value, zero, zero, zero], "ivec4")])
    params = [Parameter(type_, letter) for type_, letter in zip(INPUTS, "abcdefghi", strict=True)]
    return Program(functions=[Function("entry", "ivec4", params, Node("block", parts=[result]))], entry="entry")


A, B = (Node("name", "int", [], name) for name in "ab")
SUM = Node("binary", "int", [Node("binary", "int", [A, B], "*"), B], "+")


def test_the_interpreter_wraps_integers() -> None:
    case = Case(program_of(SUM))
    assert case.valid.all()
    assert any(abs(number) > 2**30 for number in case.expected[:, 0])
    assert all(-(2**31) <= number < 2**31 for number in case.expected[:, 0])


def test_a_wrong_program_is_found(runners: dict[str, Runner]) -> None:
    """The text says `*` where the tree that is interpreted says `+`."""
    case = Case(program_of(SUM))
    assert runners["numpy"].failures([case]) == []
    case.text = source(program_of(Node("binary", "int", [Node("binary", "int", [A, B], "*"), B], "*")))
    (failure,) = runners["numpy"].failures([case])
    assert failure[1].kind == "wrong"


class WrongNumbers:
    """A back end that adds 1 to every result of another one."""

    def __init__(self, backend: Backend) -> None:
        self.backend = backend
        self.target = backend.target

    def run(self, *args: Any) -> list[Any]:
        return [result + 1 for result in self.backend.run(*args)]


@pytest.fixture
def in_vulkan() -> Iterator[HLSLInVulkan]:
    backend = or_skip(HLSLInVulkan, VULKAN)
    yield backend
    backend.close()


def hlsl_failure(case: Case, first: object, second: object) -> Failure:
    """The only failure of a case, with these two ways to run HLSL."""
    runner = Runner(("hlsl",))
    runner.backends.update({"hlsl": first, VULKAN: second})
    ((_, failure),) = runner.failures([case])
    return failure


def test_hlsl_that_vulkan_computes_right_is_right(backend: Callable[[str], Backend], in_vulkan: HLSLInVulkan) -> None:
    """So a fault of spirv-cross or OpenGL is not counted as one of the text."""
    failure = hlsl_failure(Case(program_of(SUM)), WrongNumbers(backend("hlsl")), in_vulkan)
    assert (failure.kind, failure.cause) == ("tool", "right in Vulkan")


def test_hlsl_that_both_compute_wrong_is_wrong(backend: Callable[[str], Backend], in_vulkan: HLSLInVulkan) -> None:
    case = Case(program_of(SUM))
    case.text = source(program_of(Node("binary", "int", [Node("binary", "int", [A, B], "*"), B], "*")))
    assert hlsl_failure(case, backend("hlsl"), in_vulkan).kind == "wrong"


def test_hlsl_is_wrong_where_vulkan_shows_nothing(backend: Callable[[str], Backend]) -> None:
    class Failing(WrongNumbers):
        def run(self, *args: Any) -> list[Any]:
            raise diagnostics.failure("the device was lost")

    first = WrongNumbers(backend("hlsl"))
    assert hlsl_failure(Case(program_of(SUM)), first, Failing(first.backend)).kind == "wrong"


def test_an_invalid_program_is_found_in_its_batch(runners: dict[str, Runner]) -> None:
    cases = [case for case in random_glsl.batch(22, 0) if case.is_useful]
    cases[3].text = cases[3].text.replace("return ", "return undeclared + ", 1)
    (failure,) = runners["numpy"].failures(cases)
    assert failure[0] is cases[3]
    assert failure[1].kind == "refused"


def test_a_program_is_reduced() -> None:
    """To the operation that fails."""
    program = random_glsl.batch(23, 1)[0].program
    program.functions[-1].body.parts.insert(0, Node("do_expression", parts=[Node("assign", "int", [A, SUM], "=")]))

    def fails(candidate: Program) -> bool:
        return "a * b" in source(candidate)

    small = reduced(program, fails)
    assert fails(small)
    assert size(small) < 20 < size(program)
