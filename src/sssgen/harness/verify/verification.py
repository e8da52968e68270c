"""`sssgen transpile --verify`: a file's functions as the driver reads them, against what is made of them.

Each function runs on random inputs (`written_inputs`): the author's own text in OpenGL's driver; the GLSL, HLSL and
WGSL made of it; and the oracle, NumPy in float64, made of it too. Each deviation is from the author's text, over the
larger of the value's size and 1. Where a value hangs on the last bits of its inputs, as at the edge of a cell or in a
hash, the lane is left out and counted: `deviation` says how that is measured, but here inputs move by up to `STEPS`
units in the last place, for nothing is known of the functions. Left out, too, are lanes where the author's text or the
oracle gives infinity or NaN: there the languages promise nothing.

WGSL and the oracle are not computed by the driver that has the author's text. Where a function has builtins that
drivers give only roughly, these two may deviate by what the table of builtins grants, and it is told. A uniform has one
value in each of a few rounds. What cannot be run is in the list, with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache, partial
from time import monotonic
from typing import NamedTuple

import numpy as np

from sssgen.harness.backends import Array, Bound, Call, CompilerMissing, Place, Stage, Text
from sssgen.harness.backends import call_program as calls
from sssgen.harness.backends.isolated import Isolated, isolated
from sssgen.harness.evaluate.deviation import DRAWS, GOAL, MARGIN, errors
from sssgen.harness.verify.plain_inputs import numbers, picture
from sssgen.harness.verify.plain_probes import TEXTURES, Leaf, Probe, Probed, probed
from sssgen.harness.verify.stage_variables import MAIN, Plain, plain
from sssgen.harness.verify.verification_report import BACKENDS, Found, Report, Row
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Function, Intrinsic, Module, Param
from sssgen.ir.types import Sampler
from sssgen.ir.walk import all_expressions
from sssgen.lang import shadertoy
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.prune import only
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.targets import registry
from sssgen.targets.numpy_textures import Texture

SAMPLES = 1000
ROUNDS = 4
"""How many values a uniform has."""
STEPS = 8
"""How far inputs move, in units in the last place."""
ELSEWHERE = {"wgsl", "oracle"}
"""What another driver computes than the one that has the author's text."""
SECONDS = 30.0
"""How long one function may take on one back end, and how long it is asked how far rounding takes it."""
_SCREEN = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }"
VERSIONS = ("450 core", "330 core", "300 es")
"""What the driver is offered a text as, where the text does not say or says a version before 3.30."""


def load(text: str, shown: str, version: str = "") -> Module:
    """The module of a text of plain GLSL without its `#version`, which is given: `330`, `300 es`."""
    number = version.split(" ")[0]
    defines = {"__VERSION__": number} if number else {}
    if number == "100" or version.endswith("es"):
        defines["GL_ES"] = "1"
    return load_glsl_text(text, shown, defines=defines).module


def verify(
    text: str, shown: str, samples: int = SAMPLES, seed: int = 0, entry: str = "",
    read: Callable[[str, str], Module] | None = None,
) -> Report:  # fmt: skip
    """Every function of a text with its includes in it (`includes.expanded`), on `samples` random inputs.

    `shown` is its name in messages; `entry` as in `load_glsl`; `read` makes a module of a text and that name.
    Raises SssgenError where the front end refuses the text, and where OpenGL is not here: there is nothing to compare
    with.
    """
    written = plain(_scene(text) if entry == "shadertoy" else text)
    read = read or partial(load, version=written.version)
    module = read(written.text, shown)
    functions = [one for one in module.functions if one.body is not None and one.span.file == shown]
    cases = probed(module, functions)
    probes = "\n".join(probe.text for case in cases for probe in case.probes)
    whole = read(written.text + probes, shown)
    with _machines() as (machines, missing):
        rows = [_Case(case, written, whole, machines, samples, seed).row() for case in cases]
    return Report(rows, missing)


def _scene(text: str) -> str:
    """A Shadertoy scene with the uniforms that it names and does not declare, on its first line."""
    named = [line for name, line in shadertoy.UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split("//")[0] for line in named if not re.search(rf"\buniform\s+{line.split(maxsplit=1)[1]}", text)]
    version = re.match(r"\s*#\s*version[^\n]*\n", text)
    start = version.end() if version is not None else 0
    return text[:start] + " ".join(lines) + "\n" + text[start:]


@contextmanager
def _machines() -> Iterator[tuple[dict[str, Isolated], dict[str, str]]]:
    """The back ends, each in a process of its own, and what is missing."""
    machines: dict[str, Isolated] = {}
    missing: dict[str, str] = {}

    def start(name: str) -> None:
        try:
            machines[name] = isolated(name, SECONDS)
        except CompilerMissing as reason:
            missing[name] = str(reason)

    names = ("numpy-f32", *BACKENDS.values())
    try:
        with ThreadPoolExecutor(len(names)) as pool:
            list(pool.map(start, names))
        if "gl" in missing:
            raise failure("OpenGL is missing, which runs the text as it is written", missing["gl"])
        yield machines, missing
    finally:
        for machine in machines.values():
            machine.close()


class _Inputs(NamedTuple):
    """One round."""

    values: dict[str, Array]
    """By the probe's parameter or the uniform's name, lanes last."""
    textures: dict[str, Texture]


class _Emitted(NamedTuple):
    """A text that was made, and the probes in it."""

    probes: tuple[Probe, ...]
    text: Text
    names: Mapping[str, str]
    """What is renamed in it."""


class _Case:
    """One function on all back ends."""

    def __init__(
        self, case: Probed, written: Plain, whole: Module, machines: Mapping[str, Isolated], samples: int, seed: int
    ) -> None:
        self.case, self.written, self.machines, self.seed = case, written, machines, seed
        self.texts: dict[str, list[_Emitted]] = {}
        names = {probe.name for probe in case.probes}
        self.keys = {function.name: function.key for function in whole.functions if function.name in names}
        module = only(whole, list(self.keys.values()))
        # probes set what is read: what variables begin with may need a main() that is not there
        self.module = module._replace(variables=tuple([one._replace(value=None) for one in module.variables]))
        closed = {function.name: function.params for function in uniforms_to_parameters(self.module).functions}
        self.params: dict[str, tuple[Param, ...]] = {name: closed[name] for name in names if name in closed}
        rounds = ROUNDS if self.uniforms() else 1
        lanes = -(-samples // rounds // 4) * 4  # derivatives are of whole quads
        self.inputs = [self.draw(lanes, number) for number in range(rounds)] if case.probes else []

    def uniforms(self) -> dict[str, Param]:
        """What the function reads of the text's uniforms."""
        own = {leaf.name for probe in self.case.probes for leaf in probe.leaves}
        return {param.name: param for params in self.params.values() for param in params if param.name not in own}

    def draw(self, lanes: int, number: int) -> _Inputs:
        seed = self.seed * ROUNDS + number
        values, textures = {}, {}
        leaves = [leaf for probe in self.case.probes[:1] for leaf in probe.leaves]
        uniforms = [Leaf(name, name, param.type) for name, param in self.uniforms().items()]
        for leaf in [*leaves, *uniforms]:
            if isinstance(leaf.type, Sampler):
                if leaf.type in TEXTURES:
                    textures[leaf.name] = picture(leaf.path, leaf.type, seed)
                continue
            one = leaf in uniforms
            drawn = numbers(leaf.path.removeprefix("local_"), leaf.type, 1 if one else lanes, seed)
            values[leaf.name] = np.broadcast_to(drawn, (*drawn.shape[:-1], lanes))
        return _Inputs(values, textures)

    def row(self) -> Row:
        function = self.case.function
        row = Row(_title(function), function.span.line, reason=self.case.reason)
        for name, param in self.uniforms().items():
            if isinstance(param.type, Sampler) and param.type not in TEXTURES:
                row = row._replace(reason=f"it reads {name}, a texture that cannot be given")
        if row.reason:
            return row
        try:
            original = self.all_rounds(self.original)
        except SssgenError as error:
            return row._replace(reason=f"the driver does not take it as it is written: {error.diagnostics[0].message}")
        return self.compared(row, original)

    def compared(self, row: Row, original: Mapping[str, Array]) -> Row:
        """The row with what each text gives, against the original."""
        names = [name for name, backend in BACKENDS.items() if backend in self.machines]
        with ThreadPoolExecutor(len(names)) as pool:  # each waits for a process of its own
            given = dict(zip(names, pool.map(self.given, names), strict=True))
        oracle = given.get("oracle")
        finite = _finite(original)
        if isinstance(oracle, dict):
            finite &= _finite(oracle)
        blur = cache(lambda: self.blur(oracle) if isinstance(oracle, dict) else dict[str, Array]())
        found = {
            name: Found(None, error=outputs) if isinstance(outputs, str) else _judged(outputs, original, finite, blur)
            for name, outputs in given.items()
        }
        inexact, granted = _inexact(self.module)
        for name in ELSEWHERE & found.keys():
            found[name] = found[name]._replace(inexact=inexact, limit=max(GOAL, MARGIN * granted))
        reason = ""
        if not finite.any():
            reason = "every result is infinity or NaN"
        elif all(one.deviation is None and not one.error for one in found.values()):
            reason = "rounding decides every result"
        return row._replace(lanes=len(finite), undefined=int((~finite).sum()), found=found, reason=reason)

    def given(self, name: str) -> dict[str, Array] | str:
        """What one text gives, or why it does not run."""
        try:
            return self.all_rounds(partial(self.transpiled, BACKENDS[name]))
        except SssgenError as error:
            return error.diagnostics[0].message

    def all_rounds(self, run: Callable[[_Inputs], list[Array]], rounds: Sequence[_Inputs] = ()) -> dict[str, Array]:
        """Each output of all rounds (or of those given), lanes first."""
        found = [run(inputs) for inputs in rounds or self.inputs]
        return {
            probe.output: np.concatenate([np.moveaxis(one[index], -1, 0) for one in found])
            for index, probe in enumerate(self.case.probes)
        }

    def original(self, inputs: _Inputs) -> list[Array]:
        """The author's text, in the first of the versions that the driver takes it as."""
        number = self.written.version.split(" ")[0]
        versions = [self.written.version] if number and (int(number) >= 330 or self.written.is_es) else VERSIONS
        errors_: list[SssgenError] = []
        for version in versions:
            try:
                return self.draw_original(version, inputs)
            except SssgenError as error:
                errors_.append(error)
        raise errors_[0]

    def draw_original(self, version: str, inputs: _Inputs) -> list[Array]:
        """A draw of the author's text with the probes behind it. Its uniforms are bound by their names."""
        probes = "\n".join(probe.text for probe in self.case.probes)
        text = Text(f"{self.written.for_driver(version)}\n{probes}")
        made = [
            self.call(probe, probe.name, [leaf.name for leaf in probe.leaves], inputs) for probe in self.case.probes
        ]
        target = registry.load("glsl-es-300" if version.endswith("es") else "glsl-330")
        drawing, layout = calls.drawing(target, text, made, inputs.textures)
        uniforms = self.uniforms()
        bound = {name: Bound(inputs.textures[name], Place(0, 0)) for name in uniforms if name in inputs.textures}
        values = {name: inputs.values[name][..., 0] for name in uniforms if name in inputs.values}
        vertex = Stage(Text(f"#version {version}\n{_SCREEN}"))
        drawing = drawing._replace(vertex=vertex, textures={**drawing.textures, **bound}, values=values)
        return calls.results(made, layout, self.machines["gl"].draw(drawing))

    def transpiled(self, backend: str, inputs: _Inputs) -> list[Array]:
        """What is made of the text for a back end."""
        machine = self.machines[backend]
        found: list[Array] = []
        for probes, text, names in self.emitted(machine.target.name):
            made = [
                self.call(probe, names.get(probe.name, probe.name), [p.name for p in self.params[probe.name]], inputs)
                for probe in probes
            ]
            found += machine.run(text, made, inputs.textures)
        return found

    def emitted(self, target: str) -> list[_Emitted]:
        """The texts for a target, made once."""
        if target not in self.texts:
            probes = self.case.probes
            alone = bool(self.module.variables) and target == "numpy"
            self.texts[target] = [self.made(target, [one]) for one in probes] if alone else [self.made(target, probes)]
        return self.texts[target]

    def made(self, target: str, probes: Sequence[Probe]) -> _Emitted:
        """One text with these probes. In NumPy module variables are a probe's own: it is alone in its text then."""
        keys = [self.keys[probe.name] for probe in probes]
        module = only(self.module, keys)
        if target == "numpy" and module.variables:
            module = variables_to_parameters(module, keys[0]).module
        compiled = transpile(module, target, "verified", "none", keys, keep=True)
        text = "\n".join([text for name, text in compiled.files.items() if not name.endswith(".json")])
        return _Emitted(tuple(probes), Text(text), compiled.reflection["renames"])

    def call(self, probe: Probe, name: str, params: Sequence[str], inputs: _Inputs) -> Call:
        types = {param.name: param.type for param in self.params[probe.name]}
        args = tuple([inputs.values.get(param, param) for param in params])
        return Call(name, tuple([types[param] for param in params]), probe.result, args)

    def blur(self, oracle: Mapping[str, Array]) -> dict[str, Array]:
        """How far rounding may take each lane of each output from the oracle, (lanes,)."""
        rounded = self.all_rounds(partial(self.transpiled, "numpy-f32"))
        found = {name: errors(value, oracle[name]) for name, value in rounded.items()}
        rng = np.random.default_rng(0)
        end = monotonic() + SECONDS
        for _ in range(DRAWS):
            if monotonic() > end:
                break
            near = [_near(inputs, rng) for inputs in self.inputs]
            right = self.all_rounds(partial(self.transpiled, "numpy"), near)
            got = self.all_rounds(partial(self.transpiled, "numpy-f32"), near)
            for name, value in right.items():
                apart = np.maximum(errors(value, oracle[name]), errors(got[name], value))
                found[name] = np.maximum(found[name], apart)
        return found


def _near(inputs: _Inputs, rng: np.random.Generator) -> _Inputs:
    return inputs._replace(values={name: _moved(value, rng) for name, value in inputs.values.items()})


def _moved(value: Array, rng: np.random.Generator) -> Array:
    """Numbers moved up or down by up to `STEPS` units in float32's last place; whole numbers stay, and 0."""
    if value.dtype.kind != "f":
        return value
    moved: Array = value + rng.integers(-STEPS, STEPS + 1, value.shape) * np.spacing(np.abs(value).astype(np.float32))
    return moved


def _judged(
    got: Mapping[str, Array], wanted: Mapping[str, Array], counted: Array, blur: Callable[[], dict[str, Array]]
) -> Found:
    """The largest deviation of the lanes that count, but for those that the blur excuses."""
    each = {name: np.where(counted, errors(got[name], right), 0.0) for name, right in wanted.items()}
    beyond = np.any([apart > GOAL for apart in each.values()], axis=0)
    limit = blur() if beyond.any() else {}
    wrong = [(apart > GOAL) & ~(apart <= MARGIN * limit.get(name, 0.0)) for name, apart in each.items()]
    excused = beyond & ~np.any(wrong, axis=0)
    left = counted & ~excused
    if not left.any():
        return Found(None, int(excused.sum()))
    found = Found(0.0, int(excused.sum()))
    for name, apart in each.items():
        lane = int(np.argmax(np.where(left, apart, 0.0)))
        if left[lane] and apart[lane] > (found.deviation or 0.0):
            at = f"{name}[{lane}]: {_shown(got[name][lane])}, the author's text gives {_shown(wanted[name][lane])}"
            found = found._replace(deviation=float(apart[lane]), at=at)
    return found


def _shown(value: Array) -> str:
    return str(np.asarray(value).tolist())


def _finite(outputs: Mapping[str, Array]) -> Array:
    """The lanes in which every output is finite."""
    each = [np.isfinite(value).reshape(len(value), -1).all(axis=1) for value in outputs.values()]
    found: Array = np.all(each, axis=0)
    return found


def _inexact(module: Module) -> tuple[tuple[str, ...], float]:
    """The builtins in a module that drivers may give with larger errors than the goal, and the largest of these."""
    used = {
        part.name: BUILTINS[part.name].absolute
        for function in module.functions
        for part in all_expressions(function.body or ())
        if isinstance(part, Intrinsic) and BUILTINS[part.name].absolute > GOAL
    }
    return tuple(sorted(used)), max(used.values(), default=0.0)


def _title(function: Function) -> str:
    return function.key.replace(MAIN, "main")
