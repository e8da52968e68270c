"""The samples of GraphicsFuzz: fragment shaders and the values of their uniforms, as their owner publishes them."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from qualification.suites.machines import AUTHOR
from qualification.suites.outcomes import SKIPPED, WRONG, Outcome, Result
from qualification.suites.picture_functions import PixelFunction
from qualification.suites.picture_outcomes import Drawn, colors, outcomes
from qualification.suites.pictures import PictureProgram, Translations, of_fragment
from sssgen.run.backends import Array
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

FOLDER = "shaders/src/main/glsl/samples"
SIZE = (256, 256)
STEP = 1
"""Of 255: the most that a channel differs"""
EDGES = 0.02
"""The share of the pixels that may differ more: where rounding decides which side of an edge a pixel is on"""


class SampleCase(NamedTuple):
    """A fragment shader."""

    name: str
    text: str
    uniforms: Mapping[str, tuple[float, ...]]
    textures: tuple[str, ...]


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


def run_cases(cases: Sequence[SampleCase]) -> list[Result]:
    """The results of cases, in their order."""
    return [run_case(case) for case in cases]


def run_case(case: SampleCase) -> Result:
    """The result of one case: each translation draws what the driver makes of the author's text."""
    program = of_fragment(case.text, SIZE)._replace(
        uniforms={name: np.array(values) for name, values in case.uniforms.items()},
        textures=dict.fromkeys(case.textures, texture()),
    )
    stable = functools.cache(lambda: stable_places(program))
    results = outcomes([program], lambda drawn, expected: difference(drawn, expected, stable))
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
