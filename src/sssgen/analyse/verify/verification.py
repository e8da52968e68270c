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
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from functools import partial
from typing import NamedTuple

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes, branches
from sssgen.analyse.verify.driven_function import DrivenFunction, Inputs
from sssgen.analyse.verify.input_search import FEW, Search
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.machines import SECONDS, Machines, backends_of, start_machines
from sssgen.analyse.verify.plain_inputs import Source, join, picture
from sssgen.analyse.verify.plain_probes import TEXTURES, FunctionProbes, Leaf, probe_functions
from sssgen.analyse.verify.rounding_limits import RoundingLimits
from sssgen.analyse.verify.rounding_noise import noise
from sssgen.analyse.verify.stage_variables import MAIN, Plain, plain
from sssgen.analyse.verify.time_limit import TimeLimit, TimeOverError
from sssgen.analyse.verify.verification_report import (
    EVERY,
    Comparison,
    Coverage,
    Report,
    Row,
)
from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import Sampler, spell, with_article
from sssgen.lang import shadertoy
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.prune import prune
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.evaluate.deviation import GOAL, errors
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.progress import Progress, silent
from sssgen.targets.runtime.numpy_textures import Texture

SAMPLES = 1000
ROUNDS = 16
"""How many values a uniform has."""
SAME_TEXT = {"glsl"}
"""The translations whose builtins are those of the author's text."""
RUNS = 30
"""A function takes about as long as so many runs of a few inputs."""
LEAST_SECONDS = 10.0
"""What a back end gets for one answer where the time of the function is nearly over."""
SEARCH, ANALYSIS = 0.4, 0.6
"""The shares of a function's time at which the search for inputs, and the run that finds undefined ones, end."""


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
    machines: Machines | None = None, progress: Progress = silent, limit: TimeLimit | None = None,
    show: Callable[[Report, Row], None] = lambda report, row: None,
) -> Report:  # fmt: skip
    """Runs the functions of a text without `#include` (see `inline_includes`).

    `shown` is the text's name in messages; `read(text, shown)` parses it; without `machines` the back ends are started
    here. `show` gets the report so far and each row as it is done. Ctrl-C and the end of the time leave functions out.
    Raises SssgenError where the front end refuses the text, where no function has the name, where no back end runs the
    target here, and without OpenGL, which runs the reference.
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
        titles = [title(case.function) for case in cases]
        report = Report([], missing, (*running, *missing), max(map(len, titles), default=0))
        limit = limit or TimeLimit()
        limit.start()
        for index, case in enumerate(cases):
            progress(index, len(cases), titles[index])
            limit.start_function()
            try:
                if limit.over:
                    row = unreached(case.function)
                else:
                    row = Case(case, written, with_probes, running, options, limit).row()
            except KeyboardInterrupt:
                rest = [unreached(other.function) for other in cases[index:]]
                return report._replace(rows=[*report.rows, *rest], interrupted=True)
            report = report._replace(rows=[*report.rows, row])
            show(report, row)
    return report


def unreached(function: Function) -> Row:
    """The row of a function that the time did not suffice for."""
    return Row(title(function), function.span.line, reason="not reached", complete=False)


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


class Case(DrivenFunction):
    """One function on all back ends."""

    def __init__(
        self,
        case: FunctionProbes,
        written: Plain,
        module: Module,
        machines: Mapping[str, BackendProcess],
        options: Options,
        limit: TimeLimit | None = None,
    ) -> None:
        super().__init__(case, written, module, machines)
        self.limit = limit or TimeLimit()
        self.samples, self.seed = options.samples, options.seed
        self.shortened = ""
        """Why it has fewer inputs than were asked for; '' where it has not."""
        self.rounding = {granted: RoundingLimits(partial(self.noise, granted=granted)) for granted in (False, True)}
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
            self.program = Program(prune(self.module, list(self.keys.values())), self.limit.check)
            self.key = self.keys[case.probes[0].name]
            self.textures = self.pictures()
            try:
                with self.limit.until(SEARCH):
                    self.inputs = self.search(options.samples)
            except TimeOverError:
                self.shortened = "one run of a few inputs takes too long"

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
        affordable = self.limit.each / (RUNS * max(search.time_of_few(self.limit.clock), 1e-9))
        if affordable < 1.0:
            samples = min(samples, max(FEW, int(samples * affordable)))
        sampled = search.inputs(samples)
        rounds = ROUNDS if uniforms else 1
        lanes = -(-samples // rounds // 4) * 4  # derivatives need whole quads
        picked = search.rounds(sampled, rounds, lanes)
        if rounds > 1 and picked:
            picked = search.best_of_rounds(picked, lanes)
        if samples < self.samples:
            self.shortened = "fewer inputs, as each takes long"
        elif search.ended_early:
            self.shortened = "the search for inputs ended early"
        return [Inputs(values, self.textures) for values in picked if next(iter(values.values())).shape[-1]]

    def interpreted(self) -> list[Inputs]:
        """The rounds as the interpreter runs them: all at once, unless lanes read their neighbours in the picture."""
        if self.program.neighbours or len(self.inputs) < 2:
            return self.inputs
        return [Inputs(join([inputs.values for inputs in self.inputs]), self.textures)]

    def row(self) -> Row:
        """The comparison of all translations."""
        row = Row(title(self.case.function), self.case.function.span.line, asked=self.samples)
        if self.case.reason or not self.case.probes:
            return row._replace(reason=self.case.reason)
        if self.unread:
            return row._replace(reason=self.unread)
        if not self.inputs:
            reason = f"not reached: {self.shortened}" if self.shortened else "its loops do not end"
            return row._replace(reason=reason, complete=not self.shortened)
        try:
            with self.limit.until(ANALYSIS):
                undefined, coverage = self.analysis()
        except TimeOverError:
            reason = "not reached: the run that finds undefined inputs takes too long"
            return row._replace(reason=reason, complete=False)
        row = row._replace(branches=coverage)
        names = [name for name, backend in EVERY.items() if backend in self.machines]
        try:
            original, results = self.outputs(names)
        except SssgenError as error:
            return row._replace(reason=f"the driver refuses it as written: {error.diagnostics[0].message}")
        except KeyboardInterrupt:
            for machine in self.machines.values():
                machine.close()  # which ends the threads that wait for it
            raise
        defined = _finite(original)
        defined &= ~undefined[: len(defined)]
        comparisons = {
            name: Comparison(None, error=outputs)
            if isinstance(outputs, str)
            else self.comparison(name, outputs, original, defined)
            for name, outputs in results.items()
        }
        return row._replace(
            lanes=len(defined),
            undefined=int((~defined).sum()),
            comparisons=comparisons,
            reason=_reason(defined, comparisons.values()),
            shortened=self.shortened,
        )

    def outputs(self, names: Sequence[str]) -> tuple[dict[str, Array], dict[str, dict[str, Array] | str]]:
        """The author's outputs and those of the translations, or why one does not run: of the rounds in the time."""
        original: list[list[Array]] = []
        results: dict[str, list[list[Array]]] = {name: [] for name in names}
        failures: dict[str, str] = {}

        def run(name: str, inputs: Inputs) -> None:
            if name not in failures:
                try:
                    results[name].append(self.run_translation(EVERY[name], inputs))
                except SssgenError as error:
                    failures[name] = error.diagnostics[0].message

        with ThreadPoolExecutor(max(len(names), 1)) as pool:  # each waits for its own process
            for inputs in self.inputs:
                if original and self.limit.left <= 0.0:
                    self.shortened = f"the time was over after {len(original)} of {len(self.inputs)} values of uniforms"
                    break
                for machine in self.machines.values():
                    machine.limit_time(min(SECONDS, max(self.limit.left, LEAST_SECONDS)))
                original.append(self.original(inputs))
                list(pool.map(partial(run, inputs=inputs), names))
        return self.join_rounds(original), {
            name: failures[name] if name in failures else self.join_rounds(results[name]) for name in names
        }

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
        unexplained, undecided = self.rounding[name not in SAME_TEXT].unexplained(each, beyond)
        if undecided.any() and (undecided | ~beyond).all():
            return Comparison(None, error="it deviates, and there was no time to say whether rounding explains it")
        excluded = beyond & ~unexplained & ~undecided
        left = defined & ~excluded & ~undecided
        if not left.any():
            return Comparison(None, int(excluded.sum()), undecided=int(undecided.sum()))
        comparison = Comparison(0.0, int(excluded.sum()), undecided=int(undecided.sum()))
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

    def noise(self, lanes: Array, draws: int, at_edges: bool, granted: bool) -> dict[str, Array]:
        """The largest movement that rounding explains, of each output in these lanes."""
        keys = [self.keys[probe.name] for probe in self.case.probes]
        parts: list[list[Array]] = []
        start = 0
        for inputs in self.interpreted():
            count = next(iter(inputs.values.values())).shape[-1]
            own = lanes[(lanes >= start) & (lanes < start + count)] - start
            if len(own):
                values, textures = inputs
                parts.append(noise(self.program, keys, values, textures, own, draws, granted, draws, at_edges))
            start += count
        return {
            probe.output: np.concatenate([part[index] for part in parts])
            for index, probe in enumerate(self.case.probes)
        }


def _reason(defined: Array, comparisons: Iterable[Comparison]) -> str:
    """Why there is no result; '' where there is."""
    if not defined.any():
        return "GLSL leaves every result undefined"
    if all(comparison.deviation is None and not comparison.error for comparison in comparisons):
        undecided = any(comparison.undecided for comparison in comparisons)
        return "" if undecided else "every result is ill-conditioned: it depends on rounding"
    return ""


def _text(value: Array) -> str:
    return str(np.asarray(value).tolist())


def _finite(outputs: Mapping[str, Array]) -> Array:
    """The lanes in which every output is finite."""
    each = [np.isfinite(value).reshape(len(value), -1).all(axis=1) for value in outputs.values()]
    finite: Array = np.all(each, axis=0)
    return finite


def title(function: Function) -> str:
    """The function as `box(vec3,vec3)`."""
    return function.key.replace(MAIN, "main")
