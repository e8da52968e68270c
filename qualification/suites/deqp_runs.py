"""Runs cases of VK-GL-CTS: those with values on every back end, the others through the front end and the printers."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from contextlib import ExitStack

from qualification.suites.compiled_texts import TARGETS, crash, translated
from qualification.suites.deqp_cases import BOTH, Case
from qualification.suites.deqp_programs import Answer, CaseProgram, load_stage
from qualification.suites.outcomes import ACCEPTED, FRONT, INVALID, REFUSED, RIGHT, SKIPPED, WRONG, Outcome, Result
from sssgen.analyse.verify.machines import Machines, start_machines
from sssgen.ir.nodes import Module
from sssgen.pipeline.two_stages import Source, transpile_stages
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry

BACKENDS = {"numpy": "NumPy", "gl": "GLSL 3.30", "webgpu": "WGSL", "hlsl": "HLSL"}
"""The back ends that run values, and their titles."""
AUTHOR = "driver"
"""The driver with the author's own text: what it does wrong, no translation is blamed for."""
STAGES = ({BOTH}, {"vertex", "fragment"})


def run_cases(cases: Sequence[Case]) -> list[Result]:
    """The results of cases, in their order. The back ends are started once in each process."""
    return [run_case(case) for case in cases]


def run_case(case: Case) -> Result:
    """The result of one case."""
    if set(case.stages) not in STAGES or "pipeline_program" in case.requires:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, f"it has the stages {', '.join(case.stages)}")})
    if case.expects.endswith("fail"):
        return Result(case.name, "must fail", {FRONT: must_fail(case)})
    if case.values and BOTH in case.stages:
        return Result(case.name, "values", run_values(case))
    return Result(case.name, "builds", builds(case))


def run_values(case: Case) -> dict[str, Outcome]:
    """The outcomes of a case with values."""
    machines = _machines().running
    try:
        program = CaseProgram(case, machines)
    except SssgenError as error:
        return dict.fromkeys(BACKENDS, Outcome(REFUSED, _message(error)))
    except Exception as error:  # a bug, which the table shows
        return dict.fromkeys(BACKENDS, crash(error))
    if program.skipped:
        return dict.fromkeys(BACKENDS, Outcome(SKIPPED, program.skipped))
    outcomes = {}
    try:
        outcomes[AUTHOR] = _outcome(program.original())
    except SssgenError as error:
        outcomes[AUTHOR] = Outcome(REFUSED, _message(error))
    for name in BACKENDS:
        if name in machines:
            try:
                outcomes[name] = _outcome(program.translation(name))
            except SssgenError as error:
                outcomes[name] = Outcome(INVALID, _message(error))
            except Exception as error:
                outcomes[name] = crash(error)
    return outcomes


def must_fail(case: Case) -> Outcome:
    """Whether the front end, or the linker of two stages, refuses a case."""
    try:
        vertex, fragment = (load_stage(case, stage) for stage in ("vertex", "fragment"))
        if case.expects != "compile_fail":
            transpile_stages(Source(vertex), Source(fragment), "wgsl", "case")
    except SssgenError as error:
        return Outcome(RIGHT, _message(error))
    except Exception as error:
        return crash(error)
    return Outcome(ACCEPTED)


def builds(case: Case) -> dict[str, Outcome]:
    """Whether the stages of a case become texts of each target, which compilers accept."""
    try:
        vertex, fragment = (load_stage(case, stage) for stage in ("vertex", "fragment"))
    except SssgenError as error:
        return {FRONT: Outcome(REFUSED, _message(error))}
    except Exception as error:
        return {FRONT: crash(error)}
    targets = [target for target in TARGETS if "vertex" in registry.load(target).files]
    return {target: translated(_files, vertex, fragment, target) for target in targets}


def _files(vertex: Module, fragment: Module, target: str) -> dict[str, str]:
    """The emitted files of two stages."""
    return transpile_stages(Source(vertex), Source(fragment), target, "case").files


def _outcome(answer: Answer) -> Outcome:
    return Outcome(RIGHT if answer.right else WRONG, answer.text)


def _message(error: SssgenError) -> str:
    return error.diagnostics[0].message


_open = ExitStack()


@functools.cache
def _machines() -> Machines:
    """The back ends of this process, which end with it."""
    return _open.enter_context(start_machines(tuple(BACKENDS)))
