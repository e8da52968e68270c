"""`sssgen transpile --verify`: a file's functions as the driver reads them, compared with their translations.

Each function runs on random inputs (`plain_inputs`): the author's own text in OpenGL's driver, and its translations to
GLSL, HLSL, WGSL and NumPy in float64, the oracle. A deviation is the difference from the author's text, relative to the
larger of the value's size and 1. Ill-conditioned lanes, where the result depends on the last bits of the inputs (at the
edge of a cell, in a hash), are excluded and counted: `evaluate.deviation` describes the measurement, but inputs move by
up to `STEPS` units in the last place here, as nothing is known of the functions. Lanes where the author's text or the
oracle gives infinity or NaN are excluded, too: the languages guarantee nothing there.

WGSL and the oracle do not run in the driver that runs the author's text. Where a function calls builtins whose
precision differs between drivers, these two may deviate by the error that the table of builtins grants; the report
says so. A uniform has one value in each of a few rounds. Functions that cannot be run are listed with the reason.
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
from sssgen.harness.verify.verification_report import BACKENDS, Comparison, Report, Row
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.nodes import Function, Intrinsic, Module, Param
from sssgen.ir.types import Sampler
from sssgen.ir.walk import all_expressions
from sssgen.lang import shadertoy
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.reachable import only
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

SAMPLES = 1000
ROUNDS = 4
"""How many values a uniform has."""
STEPS = 8
"""How far inputs move, in units in the last place."""
OTHER_DRIVERS = {"wgsl", "oracle"}
"""The translations that do not run in the driver that runs the author's text."""
SECONDS = 30.0
"""The time limit of one function on one back end, and of measuring how ill-conditioned it is."""
_SCREEN = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }"
VERSIONS = ("450 core", "330 core", "300 es")
"""The versions to try, where the text has no `#version` or one before 3.30."""


def load(text: str, shown: str, version: str = "") -> Module:
    """The module of a text of plain GLSL, whose `#version` is passed separately: `330`, `300 es`."""
    number = version.split(" ")[0]
    defines = {"__VERSION__": number} if number else {}
    if number == "100" or version.endswith("es"):
        defines["GL_ES"] = "1"
    return load_glsl_text(text, shown, defines=defines).module


def verify(
    text: str, shown: str, samples: int = SAMPLES, seed: int = 0, entry: str = "",
    read: Callable[[str, str], Module] | None = None,
) -> Report:  # fmt: skip
    """Runs every function of a text without `#include` (see `inline_includes`) on `samples` random inputs.

    `shown` is the text's name in messages; `entry` as in `load_glsl`; `read(text, shown)` parses it. Raises SssgenError
    where the front end refuses the text, and without OpenGL, which runs the reference.
    """
    written = plain(_scene(text) if entry == "shadertoy" else text)
    read = read or partial(load, version=written.version)
    module = read(written.text, shown)
    functions = [part for part in module.functions if part.body is not None and part.span.file == shown]
    cases = probed(module, functions)
    probes = "\n".join(probe.text for case in cases for probe in case.probes)
    with_probes = read(written.text + probes, shown)
    with _machines() as (machines, missing):
        rows = [_Case(case, written, with_probes, machines, samples, seed).row() for case in cases]
    return Report(rows, missing)


def _scene(text: str) -> str:
    """A Shadertoy scene; the uniforms that it uses without a declaration are declared on its first line."""
    named = [line for name, line in shadertoy.UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split("//")[0] for line in named if not re.search(rf"\buniform\s+{line.split(maxsplit=1)[1]}", text)]
    version = re.match(r"\s*#\s*version[^\n]*\n", text)
    start = version.end() if version is not None else 0
    return text[:start] + " ".join(lines) + "\n" + text[start:]


@contextmanager
def _machines() -> Iterator[tuple[dict[str, Isolated], dict[str, str]]]:
    """The back ends, each in its own process; and why the others are missing, by name."""
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
            raise failure("OpenGL is missing: it runs the text as written", missing["gl"])
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
    """A translated text, and the probes in it."""

    probes: tuple[Probe, ...]
    text: Text
    names: Mapping[str, str]
    """Old name → name in the text."""


class _Case:
    """One function on all back ends."""

    def __init__(
        self, case: Probed, written: Plain, module: Module, machines: Mapping[str, Isolated], samples: int, seed: int
    ) -> None:
        self.case, self.written, self.machines, self.seed = case, written, machines, seed
        self.texts: dict[str, list[_Emitted]] = {}
        names = {probe.name for probe in case.probes}
        self.keys = {function.name: function.key for function in module.functions if function.name in names}
        module = only(module, list(self.keys.values()))
        # probes set the variables that are read; their initial values might need a main() that is not there
        variables = tuple([variable._replace(value=None) for variable in module.variables])
        self.module = module._replace(variables=variables)
        closed = {function.name: function.params for function in uniforms_to_parameters(self.module).functions}
        self.params: dict[str, tuple[Param, ...]] = {name: closed[name] for name in names if name in closed}
        rounds = ROUNDS if self.uniforms() else 1
        lanes = -(-samples // rounds // 4) * 4  # derivatives need whole quads
        self.inputs = [self.draw(lanes, number) for number in range(rounds)] if case.probes else []

    def uniforms(self) -> dict[str, Param]:
        """The uniforms of the text that the function reads."""
        own = {leaf.name for probe in self.case.probes for leaf in probe.leaves}
        return {param.name: param for params in self.params.values() for param in params if param.name not in own}

    def draw(self, lanes: int, number: int) -> _Inputs:
        """The random inputs of one round."""
        seed = self.seed * ROUNDS + number
        values, textures = {}, {}
        leaves = [leaf for probe in self.case.probes[:1] for leaf in probe.leaves]
        uniforms = [Leaf(name, name, param.type) for name, param in self.uniforms().items()]
        for leaf in [*leaves, *uniforms]:
            if isinstance(leaf.type, Sampler):
                if leaf.type in TEXTURES:
                    textures[leaf.name] = picture(leaf.path, leaf.type, seed)
                continue
            count = 1 if leaf in uniforms else lanes
            drawn = numbers(leaf.path.removeprefix("local_"), leaf.type, count, seed)
            values[leaf.name] = np.broadcast_to(drawn, (*drawn.shape[:-1], lanes))
        return _Inputs(values, textures)

    def row(self) -> Row:
        """The comparison of all translations."""
        function = self.case.function
        row = Row(_title(function), function.span.line, reason=self.case.reason)
        for name, param in self.uniforms().items():
            if isinstance(param.type, Sampler) and param.type not in TEXTURES:
                row = row._replace(reason=f"it reads {name}, a texture of a type that is not supported here")
        if row.reason:
            return row
        try:
            original = self.all_rounds(self.original)
        except SssgenError as error:
            return row._replace(reason=f"the driver refuses it as written: {error.diagnostics[0].message}")
        return self.compared(row, original)

    def compared(self, row: Row, original: Mapping[str, Array]) -> Row:
        """The row with the deviation of each translation from the original."""
        names = [name for name, backend in BACKENDS.items() if backend in self.machines]
        with ThreadPoolExecutor(len(names)) as pool:  # each waits for its own process
            results = dict(zip(names, pool.map(self.result, names), strict=True))
        oracle = results.get("oracle")
        finite = _finite(original)
        if isinstance(oracle, dict):
            finite &= _finite(oracle)
        noise = cache(lambda: self.noise(oracle) if isinstance(oracle, dict) else dict[str, Array]())
        comparisons = {
            name: Comparison(None, error=outputs)
            if isinstance(outputs, str)
            else _comparison(outputs, original, finite, noise)
            for name, outputs in results.items()
        }
        inexact, granted = _inexact(self.module)
        for name in OTHER_DRIVERS & comparisons.keys():
            comparisons[name] = comparisons[name]._replace(inexact=inexact, limit=max(GOAL, MARGIN * granted))
        reason = ""
        if not finite.any():
            reason = "every result is infinity or NaN"
        elif all(comparison.deviation is None and not comparison.error for comparison in comparisons.values()):
            reason = "every result is ill-conditioned: it depends on rounding"
        return row._replace(lanes=len(finite), undefined=int((~finite).sum()), comparisons=comparisons, reason=reason)

    def result(self, name: str) -> dict[str, Array] | str:
        """The outputs of one translation, or why it does not run."""
        try:
            return self.all_rounds(partial(self.transpiled, BACKENDS[name]))
        except SssgenError as error:
            return error.diagnostics[0].message

    def all_rounds(self, run: Callable[[_Inputs], list[Array]], rounds: Sequence[_Inputs] = ()) -> dict[str, Array]:
        """Each output of all rounds, lanes first."""
        results = [run(inputs) for inputs in rounds or self.inputs]
        return {
            probe.output: np.concatenate([np.moveaxis(result[index], -1, 0) for result in results])
            for index, probe in enumerate(self.case.probes)
        }

    def original(self, inputs: _Inputs) -> list[Array]:
        """The outputs of the author's text, in the first version that the driver accepts."""
        number = self.written.version.split(" ")[0]
        versions = [self.written.version] if number and (int(number) >= 330 or self.written.is_es) else VERSIONS
        refusals: list[SssgenError] = []
        for version in versions:
            try:
                return self.draw_original(version, inputs)
            except SssgenError as error:
                refusals.append(error)
        raise refusals[0]

    def draw_original(self, version: str, inputs: _Inputs) -> list[Array]:
        """The outputs of the author's text, followed by the probes. Its uniforms are bound by their names."""
        probes = "\n".join(probe.text for probe in self.case.probes)
        text = Text(f"{self.written.for_driver(version)}\n{probes}")
        probe_calls = [
            self.call(probe, probe.name, [leaf.name for leaf in probe.leaves], inputs) for probe in self.case.probes
        ]
        target = registry.load("glsl-es-300" if version.endswith("es") else "glsl-330")
        drawing, layout = calls.drawing(target, text, probe_calls, inputs.textures)
        uniforms = self.uniforms()
        bound = {name: Bound(inputs.textures[name], Place(0, 0)) for name in uniforms if name in inputs.textures}
        values = {name: inputs.values[name][..., 0] for name in uniforms if name in inputs.values}
        vertex = Stage(Text(f"#version {version}\n{_SCREEN}"))
        drawing = drawing._replace(vertex=vertex, textures={**drawing.textures, **bound}, values=values)
        return calls.results(probe_calls, layout, self.machines["gl"].draw(drawing))

    def transpiled(self, backend: str, inputs: _Inputs) -> list[Array]:
        """The outputs of the translation for a back end."""
        machine = self.machines[backend]
        outputs: list[Array] = []
        for probes, text, names in self.emitted(machine.target.name):
            probe_calls = [
                self.call(probe, names.get(probe.name, probe.name), [p.name for p in self.params[probe.name]], inputs)
                for probe in probes
            ]
            outputs += machine.run(text, probe_calls, inputs.textures)
        return outputs

    def emitted(self, target: str) -> list[_Emitted]:
        """The texts for a target, cached."""
        if target not in self.texts:
            probes = self.case.probes
            separate = bool(self.module.variables) and target == "numpy"
            groups = [[probe] for probe in probes] if separate else [probes]
            self.texts[target] = [self.translation(target, group) for group in groups]
        return self.texts[target]

    def translation(self, target: str, probes: Sequence[Probe]) -> _Emitted:
        """One text with these probes. With module variables NumPy takes one probe only: they become its parameters."""
        keys = [self.keys[probe.name] for probe in probes]
        module = only(self.module, keys)
        if target == "numpy" and module.variables:
            module = variables_to_parameters(module, keys[0]).module
        compiled = transpile(module, target, "verified", "none", keys, keep=True)
        text = "\n".join([text for name, text in compiled.files.items() if not name.endswith(".json")])
        return _Emitted(tuple(probes), Text(text), compiled.reflection["renames"])

    def call(self, probe: Probe, name: str, params: Sequence[str], inputs: _Inputs) -> Call:
        """The call of a probe, called `name` in the text."""
        types = {param.name: param.type for param in self.params[probe.name]}
        args = tuple([inputs.values.get(param, param) for param in params])
        return Call(name, tuple([types[param] for param in params]), probe.result, args)

    def noise(self, oracle: Mapping[str, Array]) -> dict[str, Array]:
        """The largest error that rounding explains, of each lane of each output: (lanes,)."""
        rounded = self.all_rounds(partial(self.transpiled, "numpy-f32"))
        largest = {name: errors(value, oracle[name]) for name, value in rounded.items()}
        rng = np.random.default_rng(0)
        end = monotonic() + SECONDS
        for _ in range(DRAWS):
            if monotonic() > end:
                break
            near = [_near(inputs, rng) for inputs in self.inputs]
            exact = self.all_rounds(partial(self.transpiled, "numpy"), near)
            rounded = self.all_rounds(partial(self.transpiled, "numpy-f32"), near)
            for name, value in exact.items():
                error = np.maximum(errors(value, oracle[name]), errors(rounded[name], value))
                largest[name] = np.maximum(largest[name], error)
        return largest


def _near(inputs: _Inputs, rng: np.random.Generator) -> _Inputs:
    return inputs._replace(values={name: _moved(value, rng) for name, value in inputs.values.items()})


def _moved(value: Array, rng: np.random.Generator) -> Array:
    """Numbers moved up or down by up to `STEPS` units in float32's last place; whole numbers stay, and 0."""
    if value.dtype.kind != "f":
        return value
    moved: Array = value + rng.integers(-STEPS, STEPS + 1, value.shape) * np.spacing(np.abs(value).astype(np.float32))
    return moved


def _comparison(
    got: Mapping[str, Array], wanted: Mapping[str, Array], counted: Array, noise: Callable[[], dict[str, Array]]
) -> Comparison:
    """The largest deviation of the `counted` lanes, without those whose deviation is explained by noise."""
    each = {name: np.where(counted, errors(got[name], right), 0.0) for name, right in wanted.items()}
    beyond = np.any([error > GOAL for error in each.values()], axis=0)
    limit = noise() if beyond.any() else {}
    wrong = [(error > GOAL) & ~(error <= MARGIN * limit.get(name, 0.0)) for name, error in each.items()]
    excluded = beyond & ~np.any(wrong, axis=0)
    left = counted & ~excluded
    if not left.any():
        return Comparison(None, int(excluded.sum()))
    comparison = Comparison(0.0, int(excluded.sum()))
    for name, error in each.items():
        lane = int(np.argmax(np.where(left, error, 0.0)))
        if left[lane] and error[lane] > (comparison.deviation or 0.0):
            at = f"{name}[{lane}]: {_shown(got[name][lane])}, the author's text gives {_shown(wanted[name][lane])}"
            comparison = comparison._replace(deviation=float(error[lane]), at=at)
    return comparison


def _shown(value: Array) -> str:
    return str(np.asarray(value).tolist())


def _finite(outputs: Mapping[str, Array]) -> Array:
    """The lanes in which every output is finite."""
    each = [np.isfinite(value).reshape(len(value), -1).all(axis=1) for value in outputs.values()]
    finite: Array = np.all(each, axis=0)
    return finite


def _inexact(module: Module) -> tuple[tuple[str, ...], float]:
    """The builtins in a module whose granted error is above the goal, and the largest of these errors."""
    used = {
        part.name: BUILTINS[part.name].absolute
        for function in module.functions
        for part in all_expressions(function.body or ())
        if isinstance(part, Intrinsic) and BUILTINS[part.name].absolute > GOAL
    }
    return tuple(sorted(used)), max(used.values(), default=0.0)


def _title(function: Function) -> str:
    return function.key.replace(MAIN, "main")
