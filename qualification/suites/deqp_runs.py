"""Runs cases of VK-GL-CTS: those with values on every back end, the others through the front end and the printers."""

from __future__ import annotations

from collections.abc import Sequence

from qualification.suites.compiled_texts import crash
from qualification.suites.deqp_cases import BOTH, Case
from qualification.suites.deqp_programs import Answer, CaseProgram, stage_text
from qualification.suites.machines import AUTHOR, BACKENDS, machines
from qualification.suites.outcomes import FRONT, INVALID, REFUSED, RIGHT, SKIPPED, WRONG, Outcome, Result
from qualification.suites.text_cases import TextCase, builds, must_fail
from sssgen.support.diagnostics import SssgenError

STAGES = ({BOTH}, {"vertex", "fragment"})


def run_cases(cases: Sequence[Case]) -> list[Result]:
    """The results of cases, in their order. The back ends are started once in each process."""
    return [run_case(case) for case in cases]


def run_case(case: Case) -> Result:
    """The result of one case."""
    if set(case.stages) not in STAGES or "pipeline_program" in case.requires:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, f"it has the stages {', '.join(case.stages)}")})
    if case.expects.endswith("fail"):
        return Result(case.name, "must fail", must_fail(text_case(case), case.expects != "compile_fail"))
    if case.values and BOTH in case.stages:
        return Result(case.name, "values", run_values(case))
    return Result(case.name, "builds", builds(text_case(case)))


def run_values(case: Case) -> dict[str, Outcome]:
    """The outcomes of a case with values."""
    running = machines().running
    try:
        program = CaseProgram(case, running)
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
        if name in running:
            try:
                outcomes[name] = _outcome(program.translation(name))
            except SssgenError as error:
                outcomes[name] = Outcome(INVALID, _message(error))
            except Exception as error:
                outcomes[name] = crash(error)
    return outcomes


def text_case(case: Case) -> TextCase:
    """A case of two stages that is only translated and compiled."""
    vertex, fragment = (stage_text(case, stage) for stage in ("vertex", "fragment"))
    return TextCase(case.name, f"{case.name.rpartition('.')[2]}.frag", fragment, vertex)


def _outcome(answer: Answer) -> Outcome:
    return Outcome(RIGHT if answer.right else WRONG, answer.text)


def _message(error: SssgenError) -> str:
    return error.diagnostics[0].message
