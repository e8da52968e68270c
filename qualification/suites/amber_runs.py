"""Runs the GraphicsFuzz cases of VK-GL-CTS: their pictures have the colors, or the histograms, that they expect."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from qualification.suites import compute_runs
from qualification.suites.amber_cases import ASSEMBLY, PUSH, Case, Expectation, Pipeline
from qualification.suites.compiled_texts import judgement
from qualification.suites.machines import drawing_machines
from qualification.suites.outcomes import FRONT, SKIPPED, Outcome, Result
from qualification.suites.picture_outcomes import Drawn, colors, outcomes
from qualification.suites.pictures import Mesh, PictureProgram, draw_written, of_fragment
from sssgen.run.backends import Array
from sssgen.targets.runtime.numpy_textures import Texture

_BOUND = re.compile(r"layout\s*\(([^()]*)\)\s*uniform\s+(?:(?:lowp|mediump|highp)\s+)?(\w+)\s*(\{|\w+)")
_NUMBER = re.compile(r"\b(set|binding)\s*=\s*(\d+)")
_INPUT = re.compile(r"\bin\s+vec4\s+(\w+)\s*;")


def run_cases(cases: Sequence[Case]) -> list[Result]:
    """The results of cases, in their order."""
    return [run_case(case) for case in cases]


def run_case(case: Case) -> Result:
    """The result of one case."""
    if any("compute" in pipeline.stages for pipeline in case.pipelines):
        return Result(case.name, "buffers", run_compute(case))
    try:
        case = case._replace(pipelines=tuple(map(with_glsl, case.pipelines)))
    except (OSError, ValueError) as error:
        return Result(case.name, "skipped", {FRONT: Outcome(SKIPPED, f"its SPIR-V does not become GLSL: {error}")})
    bound = {buffer for pipeline in case.pipelines for buffer in pipeline.bound.values()}
    textures: dict[str, Texture] = {}
    programs: dict[str, PictureProgram] = {}
    for pipeline in case.pipelines:
        program = program_of(pipeline, case.buffers, textures)
        if pipeline.target in bound:
            picture = draw_written(program, drawing_machines()["gl"])
            textures[pipeline.target] = Texture(colors(picture) / 255.0, "nearest")
        else:
            programs[pipeline.target] = program

    def judge(drawn: Drawn, _: Drawn | None) -> str:
        pictures = {
            target: colors(picture, "discard" in program.fragment)
            for (target, program), picture in zip(programs.items(), drawn.pictures, strict=True)
        }
        return next((text for expect in case.expects if (text := mismatch(expect, pictures, drawn.known))), "")

    return Result(case.name, "pictures", outcomes([*programs.values()], judge))


def with_glsl(pipeline: Pipeline) -> Pipeline:
    """A pipeline whose programs are GLSL, by spirv-cross where the file has none. Raises OSError, ValueError."""
    texts = {stage: glsl(text) if text.startswith(ASSEMBLY) else text for stage, text in pipeline.stages.items()}
    return pipeline._replace(stages=texts)


def glsl(assembly: str) -> str:
    """The GLSL of SPIR-V. Raises OSError, ValueError."""
    with tempfile.TemporaryDirectory() as folder:
        source, module = f"{folder}/a.spvasm", f"{folder}/a.spv"
        Path(source).write_text(assembly, "utf-8")
        _output("spirv-as", "--target-env", "spv1.3", source, "-o", module)
        text = _output("spirv-cross", "--version", "310", "--es", module)
    if wrong := judgement(text, "fragment"):
        raise ValueError(f"glslang refuses what spirv-cross writes: {wrong}")
    return text


def _output(*command: str) -> str:
    completed = subprocess.run(command, capture_output=True, text=True, check=False)
    if completed.returncode:
        raise ValueError(completed.stderr.strip())
    return completed.stdout


def run_compute(case: Case) -> dict[str, Outcome]:
    """The outcomes of a case with a compute shader."""
    (pipeline,) = case.pipelines
    text = pipeline.stages["compute"]
    x, y, z = map(int, pipeline.run)
    names = {place: int(place.partition(":")[2]) for place in pipeline.bound}
    stored = compute_runs.declared(text).values()
    buffers = {names[place]: case.buffers[buffer] for place, buffer in pipeline.bound.items() if names[place] in stored}
    program = compute_runs.ComputeProgram(text, (x, y, z), buffers, blocks=bound_to(pipeline, text, case.buffers)[0])

    def judge(after: compute_runs.Buffers, _: compute_runs.Buffers | None) -> str:
        for expect in case.expects:
            place = next(place for place, buffer in pipeline.bound.items() if buffer == expect.buffer)
            word = after[names[place]][expect.place[0] // 4]
            number = word.view(np.float32) if "float" in case.types.get(expect.buffer, "") else word.view(np.int32)
            if number != expect.values[0]:
                return f"the number at byte {expect.place[0]} is {number}, {expect.values[0]:g} is expected"
        return ""

    return compute_runs.outcomes(program, judge)


def program_of(pipeline: Pipeline, buffers: Mapping[str, bytes], textures: Mapping[str, Texture]) -> PictureProgram:
    """The program of a pipeline with what is bound to it."""
    vertex, fragment = pipeline.stages["vertex"], pipeline.stages["fragment"]
    program = of_fragment(fragment, pipeline.size)
    if vertex:
        match = _INPUT.search(vertex)
        name = match[1] if match else ""
        program = program._replace(vertex=vertex, mesh=grid(name, *map(int, pipeline.run[-2:])))
    blocks, images = bound_to(pipeline, vertex + fragment, buffers)
    return program._replace(blocks=blocks, textures={name: textures[image] for name, image in images.items()})


def bound_to(pipeline: Pipeline, text: str, buffers: Mapping[str, bytes]) -> tuple[dict[str, bytes], dict[str, str]]:
    """The uniform blocks of a text, and its textures with the buffers that are their pictures."""
    blocks, images = {}, {}
    for layout, name, after in _BOUND.findall(text):
        numbers = dict(_NUMBER.findall(layout))
        place = PUSH if PUSH in layout else f"{numbers.get('set', 0)}:{numbers.get('binding', 0)}"
        buffer = pipeline.bound[place]
        if after == "{":
            blocks[name] = buffers[buffer]
        else:
            images[after] = buffer
    return blocks, images


def grid(attribute: str, columns: int, rows: int) -> Mesh:
    """A grid that covers the picture."""
    y, x = np.mgrid[: rows + 1, : columns + 1]
    corners = np.stack([2.0 * x / columns - 1.0, 2.0 * y / rows - 1.0, 0.0 * x, 0.0 * x + 1.0], axis=-1)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1, 1)
    below = np.concatenate([first, first + 1, first + columns + 1], axis=1)
    above = np.concatenate([first + 1, first + columns + 2, first + columns + 1], axis=1)
    return Mesh({attribute: corners.reshape(-1, 4).astype(np.float32)}, np.concatenate([below, above]))


def mismatch(expect: Expectation, pictures: Mapping[str, Array], known: Array) -> str:
    """What is not as expected of the pixels that are known; '' where all is."""
    picture = pictures[expect.buffer]
    if expect.other:
        apart = histogram_distance(picture[known], pictures[expect.other][known])
        return "" if apart <= expect.values[0] else f"the histograms are {apart:.3g} apart"
    x, y, width, height = expect.place
    region = (slice(y, y + height), slice(x, x + width))
    pixels = picture[region][known[region]][:, : len(expect.values)]
    wrong = pixels[(pixels != np.array(expect.values)).any(axis=-1)]
    return f"{len(wrong)} of {len(pixels)} pixels; the first is {wrong[0].tolist()}" if len(wrong) else ""


def histogram_distance(first: Array, second: Array) -> float:
    """The largest distance of the histograms of two lists of colors: the work of moving one onto the other."""
    distances = []
    for channel in range(4):
        parts = [np.bincount(colors[:, channel], minlength=256) / len(colors) for colors in (first, second)]
        distances.append(float(np.abs(np.cumsum(parts[0] - parts[1])).sum() / 256.0))
    return max(distances)
