"""Times of shaders on a GPU, in milliseconds per frame.

    result = measure([Program("new", text, {"power": 4.0}), Program("old", old_text)], size=(1920, 1080))
    result.net("new").median                                    # ms of one evaluation at every pixel
    result.ratio("new", "old")                                  # the quotient of the times, with its spread

Programs are full-screen fragment shaders, drawn by OpenGL into 32-bit floats. One timer query spans many draws of a
program. The programs alternate in a random order in every round, so that a drifting clock does not favour one.
A program may have a floor: a shader with the same reads but no computation, whose time is subtracted.

On a software rasteriser (llvmpipe, SwiftShader) the times are those of the CPU: only their ratios are meaningful.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any, NamedTuple, TypedDict, cast

import numpy as np
import numpy.typing as npt

from sssgen.run import backends
from sssgen.run.backends.backend_interface import Text, refusal
from sssgen.run.backends.opengl import OpenGL, is_loose
from sssgen.run.compilers.gl_driver import messages
from sssgen.targets.runtime.numpy_textures import Texture

SIZE = (1920, 1080)
ROUNDS = 31
SAMPLE = 2.0
"""Milliseconds of drawing in a timer query: well above the timer's resolution."""
WARM_UP = 300.0
"""Milliseconds of drawing before the first query, in which a GPU raises its clocks."""
MOST_DRAWS = 1000

_SOFTWARE = re.compile("llvmpipe|softpipe|swiftshader|software", re.IGNORECASE)
_SCREEN = """#version 330 core
out vec2 v_uv;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    v_uv = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 0.0, 1.0);
}
"""


class Program(NamedTuple):
    """A full-screen fragment shader with its uniforms and textures."""

    name: str
    fragment: str
    """GLSL 3.30 with its `#version`; it may read `in vec2 v_uv`, 0..1, and writes one vec4."""
    uniforms: Mapping[str, object] = {}
    """Numbers by name; a matrix column by column. Uniforms that the driver has removed are ignored."""
    textures: Mapping[str, Texture | backends.Array] = {}
    """By name. An array (height, width, 4) is uploaded as float32, for texelFetch."""
    floor: str = ""
    """The floor's text, which has the same uniforms and textures; '' for none."""
    evaluations: int = 1
    """Evaluations per pixel."""


class Device(NamedTuple):
    """The device of the draws."""

    renderer: str
    version: str
    software: bool
    """A rasteriser on the CPU."""


class Spread(NamedTuple):
    """The median of the rounds, and the range of the middle 80 percent."""

    median: float
    low: float
    """The 10th percentile."""
    high: float
    """The 90th percentile."""


class ProgramRecord(TypedDict):
    """The times of a program, as JSON: median, low and high, as in Spread."""

    evaluations: int
    frame_ms: dict[str, float]
    """Of a draw with its floor"""
    net_ms: dict[str, float]
    """Of one evaluation at every pixel, without the floor"""


class TimesRecord(TypedDict):
    """The times of several programs, as JSON."""

    device: str
    driver: str
    software: bool
    size: list[int]
    """Width and height, in pixels"""
    rounds: int
    programs: dict[str, ProgramRecord]


@dataclass(frozen=True)
class ProgramTimes:
    """The times of several programs."""

    device: Device
    size: tuple[int, int]
    rounds: int
    evaluations: Mapping[str, int]
    raw_times: Mapping[str, npt.NDArray[np.float64]]
    """Program → (rounds,): ms of a draw."""
    net_times: Mapping[str, npt.NDArray[np.float64]]
    """Program → (rounds,): ms of one evaluation at every pixel, without the floor."""

    def raw(self, name: str) -> Spread:
        """The time of a draw with its floor, in ms."""
        return _spread(self.raw_times[name])

    def net(self, name: str) -> Spread:
        """The time of one evaluation at every pixel, in ms: (draw − floor) / evaluations.

        In a single evaluation, arithmetic hides behind memory reads; several evaluations show its cost.
        """
        return _spread(self.net_times[name])

    def ratio(self, name: str, reference: str) -> Spread:
        """The net time of `name` divided by that of `other`, round by round."""
        # the floor's noise may exceed a cheap program's time, so that its net time is negative
        return _spread(np.maximum(self.net_times[name], 0.0) / np.maximum(self.net_times[reference], 1e-9))

    def record(self) -> TimesRecord:
        """The measurement for JSON. If `software`, only ratios of the times are meaningful."""
        return {
            "device": self.device.renderer,
            "driver": self.device.version,
            "software": self.device.software,
            "size": list(self.size),
            "rounds": self.rounds,
            "programs": {
                name: {
                    "evaluations": self.evaluations[name],
                    "frame_ms": _round(self.raw(name)),
                    "net_ms": _round(self.net(name)),
                }
                for name in self.raw_times
            },
        }


def measure(
    programs: Sequence[Program], size: tuple[int, int] = SIZE, rounds: int = ROUNDS, sample: float = SAMPLE
) -> ProgramTimes:
    """Times the programs alternately; `sample` is the least time of one timer query, in ms.

    Raises SssgenError without OpenGL, and for a program that the driver rejects.
    """
    with _TimedFrame(size) as frame:
        linked: dict[str, _LinkedProgram] = {}
        for program in programs:
            for text in filter(None, (program.fragment, program.floor)):
                key = _key(text, program)
                linked[key] = linked.get(key) or frame.prepare(program, text)
        _warm_up(frame, list(linked.values()), sample)
        times = {key: np.empty(rounds) for key in linked}
        for number in range(rounds):
            keys = list(linked)
            np.random.default_rng(number).shuffle(keys)
            for key in keys:
                times[key][number] = frame.time(linked[key])
        raw = {program.name: times[_key(program.fragment, program)] for program in programs}
        net = {
            program.name: (raw[program.name] - (times[_key(program.floor, program)] if program.floor else 0.0))
            / program.evaluations
            for program in programs
        }
        counts = {program.name: program.evaluations for program in programs}
        return ProgramTimes(frame.device, size, rounds, counts, raw, net)


def picture(program: Program, size: tuple[int, int]) -> npt.NDArray[np.float32]:
    """The output of a program, (height, width, 4), row 0 at the bottom. Raises SssgenError as `measure` does."""
    with _TimedFrame(size) as frame:
        frame.time(frame.prepare(program, program.fragment))
        return np.frombuffer(frame.framebuffer.read(components=4, dtype="f4"), np.float32).reshape(size[1], size[0], 4)


@dataclass
class _LinkedProgram:
    """A linked program with its textures."""

    array: Any
    textures: list[Any]
    """By texture unit."""
    draws: int = 1
    """Draws per timer query."""


class _TimedFrame:
    """The frame that all programs draw into, and the timer: a context that releases all GPU objects at its end."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.gpu = cast(OpenGL, backends.require("gl"))
        self.context: Any = self.gpu.context
        self.objects: list[Any] = []
        self.uploaded: dict[int, Any] = {}
        self.size = size
        info = self.context.info
        software = bool(_SOFTWARE.search(info["GL_RENDERER"]))
        self.device = Device(info["GL_RENDERER"], info["GL_VERSION"], software)

    def __enter__(self) -> _TimedFrame:
        self.context.__enter__()
        self.framebuffer = self._keep(
            self.context.framebuffer([self._keep(self.context.texture(self.size, 4, dtype="f4"))])
        )
        self.query = self.context.query(time=True)
        self.framebuffer.use()
        self.context.viewport = (0, 0, *self.size)
        self.context.disable(self.context.DEPTH_TEST | self.context.BLEND | self.context.CULL_FACE)
        return self

    def __exit__(self, *failed: Any) -> None:
        for gpu_object in reversed(self.objects):
            gpu_object.release()
        self.context.__exit__(*failed)

    def _keep(self, gpu_object: Any) -> Any:
        self.objects.append(gpu_object)
        return gpu_object

    def prepare(self, program: Program, text: str) -> _LinkedProgram:
        """Links a text and sets the program's uniforms and textures."""
        try:
            linked = self._keep(self.context.program(vertex_shader=_SCREEN, fragment_shader=text))
        except Exception as error:
            raise refusal(f"gl: {program.name}", Text(text), messages(str(error))) from None
        textures: list[Any] = []
        for name in (name for name in linked if is_loose(linked[name])):
            if name in program.textures:
                linked[name].value = len(textures)
                textures.append(self._texture(program.textures[name]))
            elif name in program.uniforms:
                _write(linked[name], program.uniforms[name])
        return _LinkedProgram(self._keep(self.context.vertex_array(linked, [])), textures)

    def _texture(self, data: Texture | backends.Array) -> Any:
        if id(data) not in self.uploaded:
            self.uploaded[id(data)] = self._keep(self._upload(data))
        return self.uploaded[id(data)]

    def _upload(self, data: Texture | backends.Array) -> Any:
        if isinstance(data, Texture):
            return self.gpu.upload(data)
        texels = np.ascontiguousarray(data, np.float32)
        texture = self.context.texture(texels.shape[1::-1], 4, texels.tobytes(), dtype="f4")
        texture.filter = (self.context.NEAREST, self.context.NEAREST)
        return texture

    def time(self, linked: _LinkedProgram) -> float:
        """Milliseconds of one draw."""
        for unit, texture in enumerate(linked.textures):
            texture.use(unit)
        self.context.finish()
        return (
            self._milliseconds_of(lambda: [linked.array.render(vertices=3) for _ in range(linked.draws)]) / linked.draws
        )

    def _milliseconds_of(self, work: Callable[[], object]) -> float:
        # a software rasteriser draws after the query has ended
        if self.device.software:
            start = perf_counter()
            work()
            self.context.finish()
            return 1e3 * (perf_counter() - start)
        with self.query:
            work()
        return float(self.query.elapsed) * 1e-6


def _warm_up(frame: _TimedFrame, programs: Sequence[_LinkedProgram], sample: float) -> None:
    """Draws until clocks and caches have settled, then chooses the draws per timer query."""
    for program in programs:
        frame.time(program)  # some drivers compile at the first draw
    elapsed = 0.0
    while elapsed < (0.0 if frame.device.software else WARM_UP):
        elapsed += sum(frame.time(program) for program in programs)
    for program in programs:
        once = min(frame.time(program) for _ in range(2))
        program.draws = int(np.clip(np.ceil(sample / max(once, 1e-6)), 1, MOST_DRAWS))


def _key(text: str, program: Program) -> str:
    """A key: equal for programs with equal text, numbers and textures, as floors often are."""
    values = sorted((name, str(np.asarray(value).tolist())) for name, value in program.uniforms.items())
    return repr((text, values, sorted((name, id(data)) for name, data in program.textures.items())))


def _write(member: Any, value: Any) -> None:
    kind = {"f": np.float32, "I": np.uint32}.get(member.fmt[-1], np.int32)
    size = 4 * member.dimension * member.array_length  # the driver may remove unused elements of an array
    member.write(np.ascontiguousarray(value, kind).tobytes()[:size])


def _spread(values: npt.NDArray[np.float64]) -> Spread:
    low, median, high = (float(value) for value in np.percentile(values, [10.0, 50.0, 90.0]))
    return Spread(median, low, high)


def _round(spread: Spread) -> dict[str, float]:
    return {name: float(f"{value:.5g}") for name, value in spread._asdict().items()}
