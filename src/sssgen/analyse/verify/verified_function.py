"""One function on all back ends: its inputs, its results, and what they say of the translations and of the driver."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import NamedTuple

import numpy as np

from sssgen.analyse.verify.branch_outcomes import Outcomes, branches
from sssgen.analyse.verify.driven_function import DrivenFunction, Inputs
from sssgen.analyse.verify.input_search import FEW, Search
from sssgen.analyse.verify.lane_interpreter import Run
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.loop_inputs import loop_inputs
from sssgen.analyse.verify.machines import SECONDS
from sssgen.analyse.verify.plain_inputs import Source, join, picture
from sssgen.analyse.verify.plain_probes import TEXTURES, FunctionProbes, Leaf
from sssgen.analyse.verify.rounding_limits import RoundingLimits
from sssgen.analyse.verify.rounding_noise import noise
from sssgen.analyse.verify.stage_variables import MAIN, Plain
from sssgen.analyse.verify.time_limit import TimeLimit, TimeOverError
from sssgen.analyse.verify.verification_report import (
    EVERY,
    TRANSLATIONS,
    Comparison,
    Coverage,
    Finding,
    Row,
)
from sssgen.analyse.verify.witnesses import ORACLE, Dispute, Second, Verdict, judge
from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import Sampler, spell, with_article
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.passes.prune import prune
from sssgen.passes.reachable import keep_reachable
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.glsl_reread import reread
from sssgen.run.compilers import CompilerMissing
from sssgen.run.evaluate.deviation import GOAL, errors
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.targets.runtime.numpy_textures import Texture

SAMPLES = 1000
ROUNDS = 16
"""How many values a uniform has."""
QUAD = 4
"""The lanes that derivatives need."""
SAME_TEXT = {"glsl"}
"""The translations whose builtins are those of the author's text."""
RUNS = 30
"""A function takes about as long as so many runs of a few inputs."""
LEAST_SECONDS = 10.0
"""What a back end gets for one answer where the time of the function is nearly over."""
SEARCH, ANALYSIS = 0.4, 0.6
"""The shares of a function's time at which the search for inputs, and the run that finds undefined ones, end."""


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


class Deviations(NamedTuple):
    """The deviations of one translation from the driver."""

    each: Mapping[str, Array]
    """Of each output."""
    beyond: Array
    """The lanes beyond the goal; of these, those that rounding does not explain, and those without time to decide."""
    unexplained: Array
    undecided: Array


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
        self.names = [name for name, backend in TRANSLATIONS.get(options.target, EVERY).items() if backend in machines]
        self.shortened = ""
        """Why it has fewer inputs than were asked for; '' where it has not."""
        self.rounding = {granted: RoundingLimits(partial(self.noise, granted=granted)) for granted in (False, True)}
        self.inputs: list[Inputs] = []
        self.reread_outputs: dict[str, Array] | None = None
        """The interpreter's outputs of the text that glslang reads; None before they are asked for."""
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
        if not uniforms and not any(leaf.path for leaf in leaves):  # every lane has the same result
            lanes = QUAD if self.program.neighbours else 1
            return [Inputs({leaf.name: np.zeros(lanes) for leaf in leaves}, self.textures)]
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
        witnesses = [ORACLE] if "numpy" in self.machines else []
        try:
            original, results = self.outputs(list(dict.fromkeys([*self.names, *witnesses])))
        except SssgenError as error:
            return row._replace(reason=f"the driver refuses it as written: {error.diagnostics[0].message}")
        except KeyboardInterrupt:
            for machine in self.machines.values():
                machine.close()  # which ends the threads that wait for it
            raise
        defined = _finite(original)
        defined &= ~undefined[: len(defined)]
        results = {name: _shaped(outputs, original) for name, outputs in results.items()}
        ran = {name: outputs for name, outputs in results.items() if not isinstance(outputs, str)}
        deviations = {name: self.deviations(name, ran[name], original, defined) for name in self.names if name in ran}
        verdict = self.verdict(original, ran, {name: each.unexplained for name, each in deviations.items()})
        comparisons = {
            name: self.comparison(name, ran[name], original, defined, deviations[name], verdict)
            if name in ran
            else Comparison(None, error=str(results[name]))
            for name in self.names
        }
        return row._replace(
            lanes=len(defined),
            undefined=int((~defined).sum()),
            comparisons=comparisons,
            reason=_reason(defined, comparisons.values()),
            shortened=self.shortened,
            finding=self.finding(original, verdict),
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

    def deviations(
        self, name: str, actual: Mapping[str, Array], expected: Mapping[str, Array], defined: Array
    ) -> Deviations:
        """The deviations of a translation in the defined lanes, and which of them rounding explains."""
        each = {output: np.where(defined, errors(actual[output], right), 0.0) for output, right in expected.items()}
        beyond = np.any([error > GOAL for error in each.values()], axis=0)
        unexplained, undecided = self.rounding[name not in SAME_TEXT].unexplained(each, beyond)
        return Deviations(each, beyond, unexplained, undecided)

    def comparison(
        self, name: str, actual: Mapping[str, Array], expected: Mapping[str, Array], defined: Array,
        deviations: Deviations, verdict: Verdict,
    ) -> Comparison:  # fmt: skip
        """The largest deviation of the defined lanes, without those that rounding explains or the driver causes."""
        each, beyond, unexplained, undecided = deviations
        if undecided.any() and (undecided | ~beyond).all():
            return Comparison(None, error="it deviates, and there was no time to say whether rounding explains it")
        excluded = beyond & ~unexplained & ~undecided
        caused = unexplained & verdict.driver
        left = defined & ~excluded & ~undecided & ~caused
        counts = Comparison(None, int(excluded.sum()), undecided=int(undecided.sum()), driver=int(caused.sum()))
        if not left.any():
            return counts
        comparison = counts._replace(deviation=0.0, against=verdict.against.get(name, ()))
        for output, error in each.items():
            lane = int(np.argmax(np.where(left, error, 0.0)))
            if left[lane] and error[lane] > (comparison.deviation or 0.0):
                shown = f"{_text(actual[output][lane])}, the author's text gives {_text(expected[output][lane])}"
                at = f"{output}[{lane}]: {shown}{self.inputs_text(lane)}"
                comparison = comparison._replace(deviation=float(error[lane]), at=at)
        return comparison

    def verdict(
        self, original: Mapping[str, Array], ran: Mapping[str, Mapping[str, Array]], unexplained: Mapping[str, Array]
    ) -> Verdict:
        """Who is at fault where a translation deviates."""
        nobody = Verdict(np.zeros(len(next(iter(original.values()))), bool))
        if ORACLE not in ran or not any(lanes.any() for lanes in unexplained.values()):
            return nobody
        ends = np.cumsum([inputs.lanes for inputs in self.inputs])
        limits = self.rounding[True]

        def agree(left: Mapping[str, Array], right: Mapping[str, Array], lanes: Array) -> Array:
            each = {output: np.where(lanes, errors(left[output], value), 0.0) for output, value in right.items()}
            apart, undecided = limits.unexplained(each, lanes)
            same: Array = lanes & ~apart & ~undecided
            return same

        def ask(lane: int, reread: bool, alone: bool) -> dict[str, Array]:
            number = int(np.searchsorted(ends, lane, "right"))
            inputs, place = self.inputs[number], lane - int(ends[number] - self.inputs[number].lanes)
            outputs = self.original(inputs.repeated(place) if alone else inputs, reread)
            return {
                probe.output: np.moveaxis(value, -1, 0)[place]
                for probe, value in zip(self.case.probes, outputs, strict=True)
            }

        def second(evidence: str, reread: bool, alone: bool) -> Second:
            return Second(evidence, partial(ask, reread=reread, alone=alone))

        again = [second("as does the same driver with glslang's reading of the text", True, False)]
        if not self.program.neighbours:
            again = [
                second("as does the driver itself where all lanes have these inputs", False, True),
                *again,
                second("as does glslang's reading where all lanes have these inputs", True, True),
            ]
        again.append(Second("as does the interpreter with glslang's reading of the text", self.reread_lane))
        try:
            return judge(
                Dispute(original, self.interpretation(self.program, self.keys), ran[ORACLE], ran, unexplained, agree),
                again,
            )
        except TimeOverError:
            return nobody

    def reread_lane(self, lane: int) -> dict[str, Array]:
        """The interpreter's outputs of a lane, of the text that glslang reads. Raises SssgenError."""
        if self.reread_outputs is None:
            try:
                module = load_glsl_text(reread(self.fragment), "reread.glsl").module
            except (ValueError, CompilerMissing) as error:
                raise failure(f"glslang: {error}") from None
            keys = {function.name: function.key for function in module.functions}
            if lacking := [probe.name for probe in self.case.probes if probe.name not in keys]:
                raise failure(f"glslang's reading lacks {lacking[0]}")
            program = Program(keep_reachable(module, [keys[probe.name] for probe in self.case.probes]))
            self.reread_outputs = self.interpretation(program, keys)
        return {output: value[lane] for output, value in self.reread_outputs.items()}

    def interpretation(self, program: Program, keys: Mapping[str, str]) -> dict[str, Array]:
        """The results of the interpreter for each output, lanes first."""

        def result(inputs: Inputs, probe: str) -> Array:
            everything = {**inputs.values, **inputs.textures}
            # spirv-cross may rename parameters
            params, written = program.functions[keys[probe]].params, self.program.functions[self.keys[probe]].params
            arguments = {new.name: everything[old.name] for new, old in zip(params, written, strict=True)}
            value = Run(program, inputs.lanes, everything).result(keys[probe], arguments)
            return np.moveaxis(value, -1, 0)

        return {
            probe.output: np.concatenate([result(inputs, probe.name) for inputs in self.interpreted()])
            for probe in self.case.probes
        }

    def finding(self, original: Mapping[str, Array], verdict: Verdict) -> Finding | None:
        """The lanes in which all others agree against the driver."""
        if verdict.lane < 0:
            return None
        place = verdict.lane
        driver = ", ".join([f"{output}[{place}] = {_text(value[place])}" for output, value in original.items()])
        others = ", ".join([_text(value[place]) for value in verdict.value.values()])
        at = f"the driver gives {driver}, the others {others}{self.inputs_text(place)}"
        return Finding(verdict.blames_driver, verdict.lanes, at, verdict.agreeing, verdict.evidence)

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
    if all(each.deviation is None and not each.error and not each.driver for each in comparisons):
        undecided = any(comparison.undecided for comparison in comparisons)
        return "" if undecided else "every result is ill-conditioned: it depends on rounding"
    return ""


def _shaped(outputs: dict[str, Array] | str, expected: Mapping[str, Array]) -> dict[str, Array] | str:
    """The outputs, or that one has not the shape of the author's."""
    for output, right in expected.items():
        if not isinstance(outputs, str) and outputs[output].shape != right.shape:
            return f"{output} has the shape {outputs[output].shape}, not {right.shape}"
    return outputs


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
