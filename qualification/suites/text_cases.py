"""Cases of suites that are only translated and compiled: one shader text, or one part of a library."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from qualification.suites.compiled_texts import TARGETS, crash, judgement, translated
from qualification.suites.outcomes import ACCEPTED, FRONT, REFUSED, RIGHT, SKIPPED, Outcome, Result
from sssgen.ir.nodes import Module
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.stage.stage_interface import ENTRY, stage_kind
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry


class TextCase(NamedTuple):
    """One text."""

    name: str
    """`spirv-cross/shaders/frag/basic.frag`"""
    label: str
    """The file's name, which ends with the stage: `basic.frag`"""
    text: str
    folders: tuple[str, ...] = ()
    """The folders of included files"""
    valid: bool = True
    """Whether compilers accept it"""
    judged: bool = False
    """Whether glslang decides if it counts: the suite does not say which of its texts are whole"""
    skipped: str = ""
    """Why no target can express it; '' where some can"""


def run_cases(cases: Sequence[TextCase]) -> list[Result]:
    """The results of cases, in their order."""
    return [run_case(case) for case in cases]


def run_case(case: TextCase) -> Result:
    """The result of one case."""
    if case.skipped:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, case.skipped)})
    if case.judged and (message := judgement(case.text)):
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, f"glslang refuses it: {message}")})
    kind = "builds" if case.valid else "must fail"
    try:
        module = load_glsl_text(case.text, case.label, case.folders).module
    except SssgenError as error:
        outcome = Outcome(REFUSED if case.valid else RIGHT, error.diagnostics[0].message)
        return Result(case.name, kind, {FRONT: outcome})
    except Exception as error:
        return Result(case.name, kind, {FRONT: crash(error)})
    if not case.valid:
        return Result(case.name, kind, {FRONT: Outcome(ACCEPTED)})
    form = stage_kind(module) if any(function.key == ENTRY for function in module.functions) else "functions"
    targets = [target for target in TARGETS if form in registry.load(target).files]
    return Result(case.name, kind, {target: translated(_files, module, target) for target in targets})


def _files(module: Module, target: str) -> dict[str, str]:
    """The emitted files."""
    return transpile(module, target, "shader", keep=True).files
