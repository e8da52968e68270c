"""Cases of suites that are only translated and compiled: the text of a shader, or both stages of a program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from qualification.suites.compiled_texts import TARGETS, crash, judgement, translated
from qualification.suites.outcomes import ACCEPTED, FRONT, REFUSED, RIGHT, SKIPPED, Outcome, Result
from sssgen.ir.nodes import Module
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.stage.stage_interface import ENTRY, stage_kind
from sssgen.pipeline.compiler import transpile
from sssgen.pipeline.two_stages import Source, transpile_stages
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry


class TextCase(NamedTuple):
    """One text, or two."""

    name: str
    """`spirv-cross/shaders/frag/basic.frag`"""
    label: str
    """The file's name, which ends with the stage: `basic.frag`"""
    text: str
    vertex: str = ""
    """The vertex shader of a fragment shader's program; '' where the suite has none"""
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
    skipped = case.skipped
    if case.judged and (message := judgement(case.text, "compute" if case.label.endswith(".comp") else "fragment")):
        skipped = f"glslang refuses it: {message}"
    if skipped:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, skipped)})
    return Result(case.name, "builds", builds(case)) if case.valid else Result(case.name, "must fail", must_fail(case))


def builds(case: TextCase) -> dict[str, Outcome]:
    """Whether a case becomes texts of each target, which compilers accept."""
    try:
        modules = _modules(case)
    except SssgenError as error:
        return {FRONT: Outcome(REFUSED, error.diagnostics[0].message)}
    except Exception as error:  # a bug, which the table shows
        return {FRONT: crash(error)}
    is_whole = any(function.key == ENTRY for function in modules[0].functions)
    form = stage_kind(modules[0]) if is_whole else "functions"
    targets = [target for target in TARGETS if form in registry.load(target).files]
    return {target: translated(_files, modules, target) for target in targets}


def must_fail(case: TextCase, linked: bool = True) -> dict[str, Outcome]:
    """Whether the front end refuses a case, or where they are `linked`, the linker of two stages."""
    try:
        modules = _modules(case)
        if linked and len(modules) > 1:
            _files(modules, TARGETS[0])
    except SssgenError as error:
        return {FRONT: Outcome(RIGHT, error.diagnostics[0].message)}
    except Exception as error:
        return {FRONT: crash(error)}
    return {FRONT: Outcome(ACCEPTED)}


def _modules(case: TextCase) -> list[Module]:
    """The checked modules of a case. Raises SssgenError where the front end refuses one."""
    texts = {case.label: case.text}
    if case.vertex:
        texts[case.label.replace(".frag", ".vert")] = case.vertex
    return [load_glsl_text(text, label, case.folders).module for label, text in texts.items()]


def _files(modules: Sequence[Module], target: str) -> dict[str, str]:
    """The emitted files. Raises SssgenError."""
    if len(modules) == 1:
        return transpile(modules[0], target, "shader", keep=True).files
    fragment, vertex = map(Source, modules)
    return transpile_stages(vertex, fragment, target, "shader").files
