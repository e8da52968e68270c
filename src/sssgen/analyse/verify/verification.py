"""`sssgen transpile --verify`: a file's functions as the driver reads them, compared with their translations.

Each function runs on inputs that reach its branches (`input_search`): the author's own text in OpenGL's driver, and its
translations to GLSL, HLSL, WGSL and NumPy in float64, the oracle, or to the target that is named. A deviation is the
difference from the author's text, relative to the larger of the value's size and 1. Two kinds of lanes are excluded
and counted:

- undefined ones, where the function meets an operation that GLSL leaves undefined (`lane_interpreter`), or where the
  author's text gives infinity or NaN: the languages guarantee nothing there;
- ill-conditioned ones, where rounding explains the deviation (`rounding_noise`): at the edge of a cell, in a hash; or
  where a device takes the derivative of the other row or column of a quad of pixels, which GLSL leaves to it. The
  translation to GLSL runs in the driver that runs the author's text, so its builtins have the same errors; for the
  others, builtins have the errors that their rows grant.

A uniform has one value in each of several rounds. Functions that cannot be run are listed with the reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from functools import partial
from typing import NamedTuple

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes, branches
from sssgen.analyse.verify.input_search import Search
from sssgen.analyse.verify.lane_interpreter import Program, Run
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.machines import Machines, backends_of, start_machines
from sssgen.analyse.verify.plain_inputs import Source, join, picture
from sssgen.analyse.verify.plain_probes import TEXTURES, FunctionProbes, Leaf, Probe, probe_functions
from sssgen.analyse.verify.rounding_noise import is_explained, noise
from sssgen.analyse.verify.stage_variables import MAIN, Plain, plain, without_functions
from sssgen.analyse.verify.verification_report import (
    EVERY,
    Comparison,
    Coverage,
    Report,
    Row,
)
from sssgen.ir.nodes import Function, Module, Param, Span
from sssgen.ir.types import Sampler, spell, with_article
from sssgen.lang import shadertoy
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.prune import prune
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Bound, Call, Place, Stage, Text
from sssgen.run.backends import call_program as calls
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.evaluate.deviation import GOAL, errors
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.progress import Progress, silent
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

SAMPLES = 1000
ROUNDS = 16
"""How many values a uniform has."""
SAME_TEXT = {"glsl"}
"""The translations whose builtins are those of the author's text."""
DRAWS_EACH = (4, 16, 128)
"""How many runs with errors a deviation is compared with; each further number for what those before do not explain."""
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


class Options(NamedTuple):
    """What to run, and how often."""

    samples: int = SAMPLES
    """Inputs of a function."""
    seed: int = 0
    entry: str = ""
    """As in `load_glsl`."""
    function: str = ""
    """The name of the only function to run; '' for all."""
    target: str = ""
    """The target whose text runs; '' for all that `verify` knows."""


DEFAULTS = Options()


def verify(
    text: str, shown: str, options: Options = DEFAULTS, read: Callable[[str, str], Module] | None = None,
    machines: Machines | None = None, progress: Progress = silent,
) -> Report:  # fmt: skip
    """Runs the functions of a text without `#include` (see `inline_includes`).

    `shown` is the text's name in messages; `read(text, shown)` parses it; without `machines` the back ends are started
    here. Raises SssgenError where the front end refuses the text, where no function has the name, where no back end
    runs the target here, and without OpenGL, which runs the reference.
    """
    written = plain(_scene(text) if options.entry == "shadertoy" else text)
    read = read or partial(load, version=written.version)
    module = read(written.text, shown)
    functions = [part for part in module.functions if part.body is not None and part.span.file == shown]
    if options.function:
        functions = _functions_named(options.function, functions, shown)
    cases = probe_functions(module, functions, written.text)
    probes = "\n".join(probe.text for case in cases for probe in case.probes)
    with_probes = read(written.text + probes, shown)
    with nullcontext(machines) if machines else start_machines(backends_of(options.target)) as (running, missing):
        rows = []
        for index, case in enumerate(cases):
            progress(index, len(cases), case.function.name)
            rows.append(Case(case, written, with_probes, running, options).row())
    return Report(rows, missing, (*running, *missing))


def _functions_named(name: str, functions: list[Function], shown: str) -> list[Function]:
    """The functions of this name, which may be overloads. Raises SssgenError where there is none."""
    names = {part.name.replace(MAIN, "main") for part in functions}
    if name not in names:
        raise failure(f"the file has no function '{name}'", did_you_mean(name, sorted(names)), shown)
    return [part for part in functions if part.name.replace(MAIN, "main") == name]


def _scene(text: str) -> str:
    """A Shadertoy scene; the uniforms that it uses without a declaration are declared on its first line."""
    named = [line for name, line in shadertoy.UNIFORMS.items() if re.search(rf"\b{name}\b", text)]
    lines = [line.split("//")[0] for line in named if not re.search(rf"\buniform\s+{line.split(maxsplit=1)[1]}", text)]
    version = re.match(r"\s*#\s*version[^\n]*\n", text)
    start = version.end() if version is not None else 0
    return text[:start] + " ".join(lines) + "\n" + text[start:]


class Inputs(NamedTuple):
    """One round."""

    values: dict[str, Array]
    """By the probe's parameter or the uniform's name, lanes last."""
    textures: dict[str, Texture]


class _Translation(NamedTuple):
    """A translated text, and the probes in it."""

    probes: tuple[Probe, ...]
    text: Text
    names: Mapping[str, str]
    """Old name → name in the text."""


class Case:
    """One function on all back ends."""

    def __init__(
        self,
        case: FunctionProbes,
        written: Plain,
        module: Module,
        machines: Mapping[str, BackendProcess],
        options: Options,
    ) -> None:
        self.case, self.written, self.machines, self.seed = case, written, machines, options.seed
        self.texts: dict[str, list[_Translation]] = {}
        names = {probe.name for probe in case.probes}
        self.keys = {function.name: function.key for function in module.functions if function.name in names}
        self.written_names = {function.name for function in module.functions if function.name not in names}
        module = keep_reachable(module, list(self.keys.values()))
        # probes set the variables that are read; their initial values might need a main() that is not there
        variables = tuple([variable._replace(value=None) for variable in module.variables])
        self.module = module._replace(variables=variables)
        closed = {function.name: function.params for function in uniforms_to_parameters(self.module).functions}
        self.params: dict[str, tuple[Param, ...]] = {name: closed[name] for name in names if name in closed}
        self.inputs: list[Inputs] = []
        self.unread = ""
        """Why its textures cannot be drawn; '' where they can."""
        if case.probes:
            samplers = [param for param in self.uniforms().values() if isinstance(param.type, Sampler)]
            lacking = [param for param in samplers if param.type not in TEXTURES]
            if lacking:
                kind = with_article(spell(lacking[0].type))
                self.unread = f"it reads '{lacking[0].name}', {kind}, which is not supported here"
        if case.probes and not self.unread:
            # without what has no effect: an undefined value there does no harm
            self.program = Program(prune(self.module, list(self.keys.values())))
            self.key = self.keys[case.probes[0].name]
            self.textures = self.pictures()
            self.inputs = self.search(options.samples)

    def uniforms(self) -> dict[str, Param]:
        """The uniforms of the text that the function reads."""
        own = {leaf.name for probe in self.case.probes for leaf in probe.leaves}
        return {param.name: param for params in self.params.values() for param in params if param.name not in own}

    def pictures(self) -> dict[str, Texture]:
        """A picture for each texture."""
        leaves = [leaf for probe in self.case.probes[:1] for leaf in probe.leaves]
        leaves += [Leaf(name, name, param.type, name) for name, param in self.uniforms().items()]
        return {
            leaf.name: picture(leaf.author_name, leaf.type, self.seed)
            for leaf in leaves
            if isinstance(leaf.type, Sampler) and leaf.type in TEXTURES
        }

    def search(self, samples: int) -> list[Inputs]:
        """The inputs of all rounds."""
        bounding = loop_inputs(self.program.module, self.key)
        leaves = [leaf for leaf in self.case.probes[0].leaves if not isinstance(leaf.type, Sampler)]
        sources = [Source(leaf.name, leaf.author_name, leaf.type, leaf.name in bounding) for leaf in leaves]
        uniforms = [
            Source(name, name, param.type, name in bounding, True)
            for name, param in self.uniforms().items()
            if not isinstance(param.type, Sampler)
        ]
        search = Search(self.program, self.key, [*sources, *uniforms], self.textures, self.seed)
        sampled = search.inputs(samples)
        rounds = ROUNDS if uniforms else 1
        lanes = -(-samples // rounds // 4) * 4  # derivatives need whole quads
        picked = search.rounds(sampled, rounds, lanes)
        if rounds > 1 and picked:
            picked = search.best_of_rounds(picked, lanes)
        return [Inputs(values, self.textures) for values in picked if next(iter(values.values())).shape[-1]]

    def interpreted(self) -> list[Inputs]:
        """The rounds as the interpreter runs them: all at once, unless lanes read their neighbours in the picture."""
        if self.program.neighbours or len(self.inputs) < 2:
            return self.inputs
        return [Inputs(join([inputs.values for inputs in self.inputs]), self.textures)]

    def row(self) -> Row:
        """The comparison of all translations."""
        row = Row(_title(self.case.function), self.case.function.span.line)
        if self.case.reason or not self.case.probes:
            return row._replace(reason=self.case.reason)
        if self.unread:
            return row._replace(reason=self.unread)
        if not self.inputs:
            return row._replace(reason="its loops do not end")
        undefined, coverage = self.analysis()
        row = row._replace(branches=coverage)
        try:
            original = self.all_rounds(self.original)
        except SssgenError as error:
            return row._replace(reason=f"the driver refuses it as written: {error.diagnostics[0].message}")
        names = [name for name, backend in EVERY.items() if backend in self.machines]
        with ThreadPoolExecutor(len(names)) as pool:  # each waits for its own process
            results = dict(zip(names, pool.map(self.result, names), strict=True))
        defined = _finite(original) & ~undefined
        comparisons = {
            name: Comparison(None, error=outputs)
            if isinstance(outputs, str)
            else self.comparison(name, outputs, original, defined)
            for name, outputs in results.items()
        }
        reason = ""
        if not defined.any():
            reason = "GLSL leaves every result undefined"
        elif all(comparison.deviation is None and not comparison.error for comparison in comparisons.values()):
            reason = "every result is ill-conditioned: it depends on rounding"
        return row._replace(lanes=len(defined), undefined=int((~defined).sum()), comparisons=comparisons, reason=reason)

    def analysis(self) -> tuple[Array, Coverage]:
        """The undefined lanes of all rounds, and which branches the function's own text takes."""
        undefined: list[Array] = []
        reached: set[tuple[int, bool]] = set()
        for inputs in self.interpreted():
            lanes = next(iter(inputs.values.values())).shape[-1]
            outcomes = Outcomes(lanes)
            everything = {**inputs.values, **inputs.textures}
            run = Run(self.program, lanes, everything, outcomes)
            run.result(self.key, everything)
            undefined.append(run.undefined | run.endless)
            reached |= {key for key, mask in outcomes.branches.items() if mask.any()}
        own = branches(self.program.module, self.case.function.key)
        never = tuple([f"line {branch.line} ({branch.outcome})" for branch in own if branch.key not in reached])
        return np.concatenate(undefined), Coverage(len(own) - len(never), len(own), never)

    def comparison(
        self, name: str, actual: Mapping[str, Array], expected: Mapping[str, Array], defined: Array
    ) -> Comparison:
        """The largest deviation of the defined lanes, without those whose deviation is explained by rounding."""
        for output, right in expected.items():
            if actual[output].shape != right.shape:
                return Comparison(None, error=f"{output} has the shape {actual[output].shape}, not {right.shape}")
        each = {output: np.where(defined, errors(actual[output], right), 0.0) for output, right in expected.items()}
        beyond = np.any([error > GOAL for error in each.values()], axis=0)
        unexplained = beyond.copy()
        for draws in DRAWS_EACH:
            if not unexplained.any():
                break
            lanes = np.flatnonzero(unexplained)
            limits = self.noise(lanes, draws, name not in SAME_TEXT)
            wrong = [~is_explained(error[lanes], limits[output]) for output, error in each.items()]
            unexplained[lanes] = np.any(wrong, axis=0)
        excluded = beyond & ~unexplained
        left = defined & ~excluded
        if not left.any():
            return Comparison(None, int(excluded.sum()))
        comparison = Comparison(0.0, int(excluded.sum()))
        for output, error in each.items():
            lane = int(np.argmax(np.where(left, error, 0.0)))
            if left[lane] and error[lane] > (comparison.deviation or 0.0):
                shown = f"{_text(actual[output][lane])}, the author's text gives {_text(expected[output][lane])}"
                at = f"{output}[{lane}]: {shown}{self.inputs_text(lane)}"
                comparison = comparison._replace(deviation=float(error[lane]), at=at)
        return comparison

    def inputs_text(self, lane: int) -> str:
        """The inputs of a lane."""
        for inputs in self.inputs:
            count = next(iter(inputs.values.values())).shape[-1]
            if lane < count:
                names = {leaf.name: leaf.author_name for leaf in self.case.probes[0].leaves}
                shown = [
                    f"{names.get(name, name)} = {_text(value[..., lane])}"
                    for name, value in inputs.values.items()
                    if names.get(name, name)
                ]
                return f" for {', '.join(shown)}" if shown else ""
            lane -= count
        return ""

    def noise(self, lanes: Array, draws: int, granted: bool) -> dict[str, Array]:
        """The largest movement that rounding explains, of each output in these lanes."""
        keys = [self.keys[probe.name] for probe in self.case.probes]
        parts: list[list[Array]] = []
        start = 0
        for inputs in self.interpreted():
            count = next(iter(inputs.values.values())).shape[-1]
            own = lanes[(lanes >= start) & (lanes < start + count)] - start
            if len(own):
                parts.append(noise(self.program, keys, inputs.values, inputs.textures, own, draws, granted, draws))
            start += count
        return {
            probe.output: np.concatenate([part[index] for part in parts])
            for index, probe in enumerate(self.case.probes)
        }

    def result(self, name: str) -> dict[str, Array] | str:
        """The outputs of one translation, or why it does not run."""
        try:
            return self.all_rounds(partial(self.run_translation, EVERY[name]))
        except SssgenError as error:
            return error.diagnostics[0].message

    def all_rounds(self, run: Callable[[Inputs], list[Array]], rounds: Sequence[Inputs] = ()) -> dict[str, Array]:
        """Each output of all rounds, lanes first."""
        results = [run(inputs) for inputs in rounds or self.inputs]
        return {
            probe.output: np.concatenate([np.moveaxis(result[index], -1, 0) for result in results])
            for index, probe in enumerate(self.case.probes)
        }

    def original(self, inputs: Inputs) -> list[Array]:
        """The outputs of the author's text, in the first version that the driver accepts.

        Where it accepts none, functions that this one does not call are removed: the driver may refuse only those.
        """
        try:
            return self.original_of(self.written, inputs)
        except SssgenError:
            called = {function.name for function in self.module.functions}
            others = {name for name in self.written_names if name not in called}
            if not others:
                raise
            alone = self.written._replace(text=without_functions(self.written.text, others))
            outputs = self.original_of(alone, inputs)
            self.written = alone  # for the next rounds
            return outputs

    def original_of(self, written: Plain, inputs: Inputs) -> list[Array]:
        """The outputs of a text of the author, in the first version that the driver accepts."""
        number = written.version.split(" ")[0]
        versions = [written.version] if number and (int(number) >= 330 or written.is_es) else VERSIONS
        refusals: list[SssgenError] = []
        for version in versions:
            try:
                return self.draw_original(written, version, inputs)
            except SssgenError as error:
                refusals.append(error)
        raise refusals[0]

    def draw_original(self, written: Plain, version: str, inputs: Inputs) -> list[Array]:
        """The outputs of the author's text, followed by the probes. Its uniforms are bound by their names."""
        probes = "\n".join(probe.text for probe in self.case.probes)
        text = Text(f"{written.for_driver(version)}\n{probes}")
        probe_calls = [
            self.call(probe, probe.name, [leaf.name for leaf in probe.leaves], inputs) for probe in self.case.probes
        ]
        target = registry.load("glsl-es-300" if version.endswith("es") else "glsl-330")
        drawing, layout = calls.drawing(target, text, probe_calls, inputs.textures)
        uniforms = self.uniforms()
        bound = {name: Bound(inputs.textures[name], Place(0, 0)) for name in uniforms if name in inputs.textures}
        bound |= {shown: bound[name] for name, shown in _elements(self.module).items() if name in bound}
        values = {name: inputs.values[name][..., 0] for name in uniforms if name in inputs.values}
        vertex = Stage(Text(f"#version {version}\n{_SCREEN}"))
        drawing = drawing._replace(vertex=vertex, textures={**drawing.textures, **bound}, values=values)
        return calls.results(probe_calls, layout, self.machines["gl"].draw(drawing))

    def run_translation(self, backend: str, inputs: Inputs) -> list[Array]:
        """The outputs of the translation for a back end."""
        machine = self.machines[backend]
        outputs: list[Array] = []
        for probes, text, names in self.translations(machine.target.name):
            probe_calls = [
                self.call(probe, names.get(probe.name, probe.name), [p.name for p in self.params[probe.name]], inputs)
                for probe in probes
            ]
            outputs += machine.run(text, probe_calls, inputs.textures)
        return outputs

    def translations(self, target: str) -> list[_Translation]:
        """The texts for a target, cached."""
        if target not in self.texts:
            probes = self.case.probes
            separate = self.passes_variables(target)
            groups = [[probe] for probe in probes] if separate else [probes]
            self.texts[target] = [self.translation(target, group) for group in groups]
        return self.texts[target]

    def passes_variables(self, target: str) -> bool:
        """Whether module variables become parameters of the target's functions."""
        return bool(self.module.variables) and not registry.load(target).capabilities.module_variables

    def translation(self, target: str, probes: Sequence[Probe]) -> _Translation:
        """One text with these probes; only one, where module variables become its parameters."""
        keys = [self.keys[probe.name] for probe in probes]
        module = keep_reachable(self.module, keys)
        if self.passes_variables(target):
            module = variables_to_parameters(module, keys[0])
        compiled = transpile(module, target, "verified", "none", keys, keep=True)
        text = "\n".join([text for name, text in compiled.files.items() if not name.endswith(".json")])
        return _Translation(tuple(probes), Text(text), compiled.reflection["renames"])

    def call(self, probe: Probe, name: str, params: Sequence[str], inputs: Inputs) -> Call:
        """The call of a probe, called `name` in the text."""
        types = {param.name: param.type for param in self.params[probe.name]}
        args = tuple([inputs.values.get(param, param) for param in params])
        return Call(name, tuple([types[param] for param in params]), probe.result, args)


def _elements(module: Module) -> dict[str, str]:
    """The author's name of each texture that is an element of an array, as `maps[1]`, by its name in the IR.

    The elements of an array have the place of its declaration, and the names `maps_0`, `maps_1`, …
    """
    arrays: dict[Span, list[str]] = {}
    for uniform in module.uniforms:
        if isinstance(uniform.type, Sampler):
            arrays.setdefault(uniform.span, []).append(uniform.name)
    return {
        name: f"{names[0].partition('_0')[0]}[{index}]"
        for names in arrays.values()
        for index, name in enumerate(names)
        if "_0" in names[0]
    }


def _text(value: Array) -> str:
    return str(np.asarray(value).tolist())


def _finite(outputs: Mapping[str, Array]) -> Array:
    """The lanes in which every output is finite."""
    each = [np.isfinite(value).reshape(len(value), -1).all(axis=1) for value in outputs.values()]
    finite: Array = np.all(each, axis=0)
    return finite


def _title(function: Function) -> str:
    return function.key.replace(MAIN, "main")
