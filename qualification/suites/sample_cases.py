"""The samples of GraphicsFuzz: fragment shaders and the values of their uniforms, as their owner publishes them."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from qualification.suites import compute_runs
from qualification.suites.machines import AUTHOR, drawing_machines
from qualification.suites.outcomes import RIGHT, SKIPPED, WRONG, Outcome, Result
from qualification.suites.picture_functions import PixelFunction
from qualification.suites.picture_outcomes import NUMPY, Drawn, colors, outcomes
from qualification.suites.pictures import PictureProgram, Translations, of_fragment, places
from sssgen.run.backends import Array
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

FOLDER = "shaders/src/main/glsl/samples"
SIZE = (128, 128)
"""A quarter of the suite's picture: the uniforms are those of the whole one"""
STEP = 1
"""Of 255: the most that a channel differs"""
EDGES = 0.02
"""The share of the pixels that may differ more: where rounding decides which side of an edge a pixel is on"""


class SampleCase(NamedTuple):
    """A fragment shader, or a compute shader."""

    name: str
    text: str
    uniforms: Mapping[str, tuple[float, ...]]
    textures: tuple[str, ...] = ()
    groups: tuple[int, ...] = ()
    """Of a compute shader"""
    buffer: bytes = b""
    """What a compute shader reads and writes"""
    binding: int = 0


def cases(root: Path) -> Iterator[SampleCase]:
    """The samples of the repository in a folder."""
    folder = root / FOLDER
    for path in sorted(folder.rglob("*.frag")):
        values = json.loads(path.with_suffix(".json").read_text("utf-8"))
        yield SampleCase(
            path.relative_to(folder).as_posix(),
            path.read_text("utf-8"),
            {name: tuple(value["args"]) for name, value in values.items() if "args" in value},
            tuple(name for name, value in values.items() if "texture" in value),
        )

    for path in sorted(folder.rglob("*.comp")):
        values = json.loads(path.with_suffix(".json").read_text("utf-8"))
        run = values["$compute"]
        dtypes: dict[str, type] = {"i": np.int32, "u": np.uint32}
        parts: list[Array] = [
            np.array(field["data"], dtypes.get(field["type"][0], np.float32)) for field in run["buffer"]["fields"]
        ]
        yield SampleCase(
            path.relative_to(folder).as_posix(),
            path.read_text("utf-8"),
            {name: tuple(value["args"]) for name, value in values.items() if "args" in value},
            groups=tuple(run["num_groups"]),
            buffer=b"".join(part.tobytes() for part in parts),
            binding=run["buffer"]["binding"],
        )


def run_cases(cases: Sequence[SampleCase]) -> list[Result]:
    """The results of cases, in their order."""
    return [run_case(case) for case in cases]


def run_case(case: SampleCase) -> Result:
    """The result of one case: each translation draws what the driver makes of the author's text."""
    if case.groups:
        x, y, z = case.groups
        computed = compute_runs.ComputeProgram(case.text, (x, y, z), {case.binding: case.buffer}, case.uniforms)
        return Result(case.name, "buffers", compute_runs.outcomes(computed, difference_of_buffers))
    program = of_fragment(case.text, SIZE)._replace(
        uniforms={name: np.array(values) for name, values in case.uniforms.items()},
        textures=dict.fromkeys(case.textures, texture()),
    )
    stable = functools.cache(lambda: stable_places(program))
    results = outcomes([program], lambda drawn, expected: difference(drawn, expected, stable))
    if all(results.get(name, Outcome(RIGHT)).outcome == WRONG for name in ("webgpu", NUMPY)):
        # two that share nothing are against the driver: NumPy decides
        pixels = PixelFunction(Translations(program), drawing_machines()).picture(NUMPY)
        oracle = Drawn([pixels], places(SIZE))
        results = outcomes([program], lambda drawn, _: difference(drawn, oracle, stable))
    if results.get(AUTHOR, Outcome(WRONG)).outcome == SKIPPED:
        results = {name: Outcome(SKIPPED, "the driver is too slow to compare with") for name in results}
    unclear = {name for name, outcome in results.items() if outcome.outcome == WRONG and not stable().any()}
    results |= dict.fromkeys(unclear, Outcome(SKIPPED, "rounding, or what GLSL leaves undefined, decides its picture"))
    return Result(case.name, "pictures", results)


def difference(drawn: Drawn, expected: Drawn | None, stable: Callable[[], Array]) -> str:
    """How a picture differs from the driver's; '' where it does not, or not at stable places."""
    if expected is None:
        return ""
    apart = np.abs(colors(drawn.pictures[0]) - colors(expected.pictures[0])).max(axis=-1)
    known = drawn.known & expected.known
    for pixels, share in ((known, EDGES), (known & stable(), 0.0)):
        count = int((apart[pixels] > STEP).sum())
        if count <= share * pixels.sum():
            return ""
    return f"{count} of {pixels.sum()} stable pixels are up to {apart[pixels].max()} of 255 apart"


def difference_of_buffers(after: compute_runs.Buffers, expected: compute_runs.Buffers | None) -> str:
    """How the buffers of a compute shader differ from the driver's; '' where they do not."""
    for binding, own in after.items():
        others = own if expected is None else expected[binding]
        with np.errstate(invalid="ignore"):
            near = np.isclose(own.view(np.float32), others.view(np.float32), 1e-3, 1e-3)
        count = int((~near & (own != others)).sum())
        if count:
            return f"{count} of {own.size} numbers differ"
    return ""


def stable_places(program: PictureProgram) -> Array:
    """The places whose color follows from the text; none where this is unknown."""
    try:
        return PixelFunction(Translations(program), {}).stable()
    except SssgenError:
        return np.zeros(program.size[::-1], bool)


def texture() -> Texture:
    """A picture for the samples that read one: the suite's own is of the same size."""
    y, x = np.mgrid[:256, :256]
    return Texture(np.stack([x, x ^ y, y, 0 * x + 255], axis=-1) / 255.0, "nearest")
