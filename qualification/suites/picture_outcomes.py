"""The outcomes of cases whose result is a picture, on the driver and on each back end."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from qualification.suites.compiled_texts import crash
from qualification.suites.machines import AUTHOR, drawing_machines
from qualification.suites.outcomes import INVALID, REFUSED, RIGHT, SKIPPED, WRONG, Outcome
from qualification.suites.picture_functions import PixelFunction
from qualification.suites.pictures import Mesh, PictureProgram, Translations, draw_written, places
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.support.diagnostics import SssgenError

TARGETS = {
    "gl": "glsl-330", "gl-es": "glsl-es-300", "webgpu": "wgsl", "browser": "wgsl", "hlsl": "hlsl",
}  # fmt: skip
"""The back ends that draw, and the target of each."""
NUMPY = "numpy"
"""The back end that computes pixels."""
_SAME_DRIVER = ("gl", "gl-es", "hlsl")
"""Those that draw with the driver of the author's text."""
_DEPTH = re.compile(r"\bgl_FragCoord\s*\.\s*[xyrg]*[zwba]")
_OPAQUE_BLACK = np.array([0, 0, 0, 255])
_SLOW = "did not finish within"
"""In the message of a back end that was ended."""


class Drawn(NamedTuple):
    """The pictures of a case's programs."""

    pictures: list[Array]
    """(height, width, 4) of float32"""
    known: Array
    """(height, width): whether a pixel was drawn"""


Judge: TypeAlias = Callable[[Drawn, Drawn | None], str]
"""What is wrong with pictures, beside those of the driver; '' where nothing is."""


def outcomes(programs: Sequence[PictureProgram], judge: Judge) -> dict[str, Outcome]:
    """The outcomes of a case's programs, on the driver as written and on each back end as translated."""
    running = drawing_machines()
    try:
        translations = [Translations(program) for program in programs]
    except SssgenError as error:
        return dict.fromkeys(TARGETS, Outcome(REFUSED, _message(error)))
    except Exception as error:  # a bug, which the table shows
        return dict.fromkeys(TARGETS, crash(error))
    results, expected, few = {}, None, False
    try:
        expected = _draw(
            programs, lambda number, mesh: draw_written(programs[number]._replace(mesh=mesh), running["gl"])
        )
        few = not expected.known.all()
        results[AUTHOR] = _judged(judge(expected, None))
    except SssgenError as error:
        results[AUTHOR] = _failed(error, REFUSED)
    is_slow = results[AUTHOR].outcome == SKIPPED
    for name, target in TARGETS.items():
        if is_slow and name in _SAME_DRIVER:
            results[name] = results[AUTHOR]
        elif name in running:
            results[name] = _outcome(translations, target, running[name], few, lambda drawn: judge(drawn, expected))
    for name in _SAME_DRIVER:
        if name in results and results[name].outcome == WRONG == results[AUTHOR].outcome:
            results[name] = Outcome(SKIPPED, f"the driver is wrong on the author's text, too: {results[name].why}")
    if "hlsl" in results and any(_DEPTH.search(program.fragment) for program in programs):
        results["hlsl"] = Outcome(
            SKIPPED, "its z and w of gl_FragCoord are those of Direct3D, and it is drawn in OpenGL"
        )
    if NUMPY in running and all(program.few for program in programs):
        results[NUMPY] = _computed(translations, running, lambda drawn: judge(drawn, expected))
    return results


def _computed(
    programs: Sequence[Translations], running: Mapping[str, BackendProcess], judge: Callable[[Drawn], str]
) -> Outcome:
    """The outcome of the pixels at `places`, which NumPy computes."""
    try:
        functions = [PixelFunction(program, running) for program in programs]
    except SssgenError as error:
        return Outcome(SKIPPED, _message(error))
    try:
        pictures = [function.picture(NUMPY) for function in functions]
        wrong = judge(Drawn(pictures, places(programs[0].program.size)))
        if wrong:  # it computes in float64: an equality that holds in float32 is no fault
            stable = np.logical_and.reduce([function.stable() for function in functions])
            if not stable.any():
                return Outcome(SKIPPED, "rounding, or what GLSL leaves undefined, decides its picture")
            wrong = judge(Drawn(pictures, stable))
        return _judged(wrong)
    except SssgenError as error:
        return _failed(error, REFUSED)
    except Exception as error:
        return crash(error)


def colors(picture: Array, discards: bool = False) -> Array:
    """A picture in 8 bits; where nothing was drawn, opaque black, which is the clear color."""
    with np.errstate(invalid="ignore"):
        result: Array = np.rint(255.0 * np.clip(np.nan_to_num(picture), 0.0, 1.0)).astype(np.int64)
    empty = discards & (picture == 0.0).all(axis=-1, keepdims=True)
    return np.where(empty, _OPAQUE_BLACK, result)


def _outcome(
    programs: Sequence[Translations], target: str, machine: DrawingBackend, few: bool, judge: Callable[[Drawn], str]
) -> Outcome:
    """The outcome of the translations for a target on a back end."""
    try:
        for program in programs:
            program.translation(target)
    except SssgenError as error:
        return Outcome(REFUSED, _message(error))
    except Exception as error:
        return crash(error)
    try:
        drawn = _draw(
            [program.program for program in programs],
            lambda number, mesh: programs[number].draw(target, machine, mesh),
            few,
        )
        return _judged(judge(drawn))
    except SssgenError as error:
        return _failed(error, INVALID)


def _draw(programs: Sequence[PictureProgram], draw: Callable[[int, Mesh], Array], few: bool = False) -> Drawn:
    """The pictures, or a few places of them, as where the whole ones take too long. `draw` takes a program's number."""
    size = programs[0].size
    sparse = [program.few for program in programs]
    if not few:
        try:
            pictures = [draw(number, program.mesh) for number, program in enumerate(programs)]
            return Drawn(pictures, np.ones(size[::-1], bool))
        except SssgenError as error:
            if _SLOW not in _message(error) or None in sparse:
                raise
    pictures = [draw(number, program.mesh) for number, program in enumerate(sparse) if program is not None]
    return Drawn(pictures, places(size))


def _judged(wrong: str) -> Outcome:
    return Outcome(WRONG if wrong else RIGHT, wrong)


def _failed(error: SssgenError, outcome: str) -> Outcome:
    """The outcome of a drawing that failed: a driver on a processor may be too slow."""
    return Outcome(SKIPPED if _SLOW in _message(error) else outcome, _message(error))


def _message(error: SssgenError) -> str:
    return error.diagnostics[0].message
