"""Runs the trials of techniques on back ends, and collects their faults."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from time import perf_counter
from types import TracebackType
from typing import NamedTuple

import numpy as np

from sssgen.analyse.stress import boundaries, energy, jumps
from sssgen.analyse.stress import dangerous_inputs as dangerous
from sssgen.analyse.stress.contract_inputs import sample_inputs
from sssgen.analyse.stress.result_checks import JUMP, KINDS, OutputFaults, faults_of
from sssgen.analyse.stress.shrink import lane, line, shrink
from sssgen.analyse.stress.subject import Specimen
from sssgen.analyse.stress.trial import RANDOM, STEPS, Trial
from sssgen.ir.formats import FLOAT16, FLOAT32, Format
from sssgen.run.backends import Array, Backend, CompilerMissing, get
from sssgen.run.backends.backend_process import start_backend
from sssgen.run.evaluate.deviation import GOAL, MARGIN, errors, rounding_deviation
from sssgen.run.evaluate.evaluation import Inputs
from sssgen.run.evaluate.evaluation import run as evaluated
from sssgen.support.diagnostics import SssgenError

CHUNK = 1 << 16
"""Lanes per evaluation; more are slower because they do not fit into the cache."""
COMPARED = 1000
"""Random lanes that are compared with the oracle."""
SHOWN = 3
"""Faults of one technique on one back end that are reduced to their simplest input."""


class Settings(NamedTuple):
    """The options of a run."""

    samples: int
    seed: int = 0
    guards: str = "auto"
    """Which guards the emitted functions have: auto, all or none."""
    half: bool = False
    """Whether the back ends compute in half precision, whose contract is narrower."""
    rows: tuple[str, ...] = ()
    """Only these rows of the dangerous table, and nothing else; empty for all."""

    @property
    def format(self) -> Format:
        """The number format of the computation."""
        return FLOAT16 if self.half else FLOAT32


class Fault(NamedTuple):
    """Faults of one kind in one output, of one trial on one back end."""

    trial: str
    kind: str
    output: str
    counts: bool
    """Whether it is a failure; otherwise the inputs were outside the contract."""
    lanes: int
    of: int
    """The number of lanes that failed, and of those tried."""
    inputs: Inputs
    """The first that failed."""
    actual: Array
    command: str = ""
    """The command that shows the simplest input found; '' if none was searched for."""


class Column(NamedTuple):
    """The results of one technique on one back end."""

    backend: str
    evaluations: int
    seconds: float
    faults: tuple[Fault, ...]
    jump: float
    """The largest change of an output for a small step of an input, where the oracle's own change is small."""
    deviation: float
    """The largest difference to the oracle that rounding does not explain."""
    error: str = ""
    """Why the results are incomplete: the driver rejected the program, crashed or hung."""

    @property
    def ok(self) -> bool:
        """Whether there are no faults that count."""
        return not self.error and not any(fault.counts for fault in self.faults)


class Row(NamedTuple):
    """The results of one technique."""

    specimen: Specimen
    columns: tuple[Column, ...]
    model_jumps: tuple[jumps.ModelJump, ...]
    """Where the formula itself jumps."""

    @property
    def ok(self) -> bool:
        """Whether there are no faults that count on any back end."""
        return all(column.ok for column in self.columns)


class Machines:
    """The back ends, each but NumPy in its own process; a context manager that ends them."""

    def __init__(self, names: Sequence[str]) -> None:
        self.backends: dict[str, Backend] = {}
        self.missing: dict[str, str] = {}
        for name in names:
            try:
                self.backends[name] = start_backend(name)
            except CompilerMissing as reason:
                self.missing[name] = str(reason)
            except SssgenError as error:
                self.missing[name] = error.diagnostics[0].message

    def __enter__(self) -> Machines:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        for backend in self.backends.values():
            if (close := getattr(backend, "close", None)) is not None:
                close()


Progress = Callable[[str, int], None]
"""Receives the progress: the current task, and how much of it is done."""


def stress(specimen: Specimen, machines: Machines, settings: Settings, progress: Progress = lambda *_: None) -> Row:
    """All trials of one technique on all back ends."""
    gathered = [_Results(name, backend, specimen, settings) for name, backend in machines.backends.items()]
    for trial in _trials(specimen, settings):
        progress(trial.name, 0)
        reference = _Reference(trial, settings)
        for results in gathered:
            results.take(trial, reference)
    if not settings.rows:
        for results in gathered:
            progress("small steps", 0)
            results.step()
        done = 0
        for trial in _random(specimen, settings):
            for results in gathered:
                results.take(trial, None)
            done += trial.inputs.lanes
            progress(RANDOM, done)
    model_jumps = jumps.of_model(specimen, exact(specimen, settings)) if not settings.rows else ()
    return Row(specimen, tuple(results.column() for results in gathered), model_jumps)


def _trials(specimen: Specimen, settings: Settings) -> Iterator[Trial]:
    yield from dangerous.trials(specimen, settings.rows, settings.format)
    if settings.rows:
        return
    yield from boundaries.trials(specimen, settings.seed, settings.format)
    yield from energy.trials(specimen, settings.seed, settings.format)
    rng = np.random.default_rng([settings.seed, 2])
    yield Trial(
        RANDOM, specimen, sample_inputs(specimen, min(COMPARED, settings.samples), rng, settings.format), compared=True
    )


def _random(specimen: Specimen, settings: Settings) -> Iterator[Trial]:
    """Random inputs: the same for each back end, and a prefix of those for any larger number of samples."""
    for number, first in enumerate(range(0, settings.samples, CHUNK)):
        rng = np.random.default_rng([settings.seed, 3, number])
        lanes = min(CHUNK, settings.samples - first)
        yield Trial(RANDOM, specimen, sample_inputs(specimen, lanes, rng, settings.format))


def evaluate(specimen: Specimen, inputs: Inputs, backend: Backend, settings: Settings) -> dict[str, Array]:
    """The outputs, lanes first. Raises SssgenError if the back end rejects the program."""
    return evaluated(specimen.subject, inputs, backend, settings.guards)


def exact(specimen: Specimen, settings: Settings) -> Callable[[Inputs], dict[str, Array]]:
    """The oracle's outputs for inputs."""
    return lambda inputs: evaluate(specimen, inputs, get("numpy"), settings)


class _Reference:
    """The oracle's outputs for a trial and their rounding deviation, computed when they are needed."""

    def __init__(self, trial: Trial, settings: Settings) -> None:
        self.trial, self.settings = trial, settings

    @cached_property
    def outputs(self) -> dict[str, Array]:
        """The oracle's, lanes first."""
        return exact(self.trial.specimen, self.settings)(self.trial.inputs)

    @cached_property
    def rounding(self) -> dict[str, Array]:
        """See `deviation.rounding_deviation`."""
        with np.errstate(over="ignore"):  # the largest number has no next one
            return rounding_deviation(self.trial.specimen.subject, self.trial.inputs, self.outputs)


class _Results:
    """The results of one technique on one back end, while it runs."""

    def __init__(self, name: str, backend: Backend, specimen: Specimen, settings: Settings) -> None:
        self.name, self.backend, self.specimen, self.settings = name, backend, specimen, settings
        self.faults: dict[tuple[str, str, str, bool], Fault] = {}
        self.trials: dict[tuple[str, str, str, bool], Trial] = {}
        self.lanes: Counter[tuple[str, bool]] = Counter()
        self.evaluations, self.seconds, self.deviation, self.jump = 0, 0.0, 0.0, 0.0
        self.error = ""

    def run(self, specimen: Specimen, inputs: Inputs) -> dict[str, Array]:
        """The outputs of one evaluation, which is counted."""
        start = perf_counter()
        outputs = evaluate(specimen, inputs, self.backend, self.settings)
        self.seconds += perf_counter() - start
        self.evaluations += inputs.lanes
        return outputs

    def take(self, trial: Trial, reference: _Reference | None) -> None:
        """Runs one trial; does nothing once the back end has failed."""
        if self.error:
            return
        trial = trial._replace(epsilon=self.settings.format.epsilon)
        try:
            outputs = self.run(trial.specimen, trial.inputs)
        except SssgenError as error:
            self.error = error.diagnostics[0].message
            return
        self.lanes[trial.name, trial.counts] += trial.inputs.lanes
        steady = reference.outputs if reference is not None and trial.path else None
        faults = faults_of(trial, outputs, steady)
        if reference is not None and trial.compared and not self.settings.half:
            faults += self.compare(trial, outputs, reference)
        for fault in faults:
            self.add(trial, fault, outputs[fault.output])

    def add(self, trial: Trial, faults: OutputFaults, value: Array) -> None:
        """Records faults; of each kind the first input is kept."""
        # float32 may decide differently on random inputs of the contract, but not on a row of the table
        counts = trial.counts and (faults.kind != "disagreement" or trial.name != RANDOM)
        key = (trial.name, faults.kind, faults.output, counts)
        count = int(faults.bad.sum())
        if key in self.faults:
            earlier = self.faults[key]
            self.faults[key] = earlier._replace(lanes=earlier.lanes + count)
            return
        first = int(np.argmax(faults.bad))
        actual = np.array(value[first] if value.ndim else value)
        self.trials[key] = trial
        self.faults[key] = Fault(
            trial.name, faults.kind, faults.output, counts, count, trial.inputs.lanes, lane(trial.inputs, first), actual
        )

    def compare(self, trial: Trial, outputs: Mapping[str, Array], reference: _Reference) -> Iterator[OutputFaults]:
        """The lanes where finite outputs deviate from the oracle's by more than rounding explains."""
        for name, expected in reference.outputs.items():
            actual = outputs[name]
            if actual.dtype.kind != "f" or not actual.ndim:
                continue
            apart = errors(actual, expected)
            apart[~np.isfinite(apart)] = 0.0  # reported as non-finite
            bad = apart > GOAL
            if bad.any():
                bad &= apart > MARGIN * reference.rounding[name]
                self.deviation = max(self.deviation, float(apart[bad].max(initial=0.0)))
                if bad.any():
                    yield OutputFaults("disagreement", name, bad)
            else:
                self.deviation = max(self.deviation, float(apart.max()))

    def step(self) -> None:
        """Measures the largest jump for a small step of each input."""
        if self.error or self.settings.half:
            return
        try:
            self.jump, name, inputs = jumps.largest_jump(
                self.specimen,
                lambda inputs_of_step: self.run(self.specimen, inputs_of_step),
                exact(self.specimen, self.settings),
            )
        except SssgenError as error:
            self.error = error.diagnostics[0].message
            return
        if self.jump > JUMP and inputs is not None:
            output = f"a step of {name}"
            self.faults[STEPS, "jump", output, True] = Fault(
                STEPS, "jump", output, True, 1, jumps.LANES, inputs, np.array(self.jump)
            )

    def column(self) -> Column:
        """The results, with the simplest inputs of the worst faults."""
        order = sorted(self.faults, key=lambda key: (not key[3], KINDS.index(key[1])))
        faults = [self.with_command(key, number < SHOWN) for number, key in enumerate(order)]
        return Column(
            self.name, self.evaluations, self.seconds, tuple(faults), self.jump, self.deviation, self.error
        )  # fmt: skip

    def with_command(self, key: tuple[str, str, str, bool], reduce: bool) -> Fault:
        """A fault with the command that shows it."""
        fault, trial = self.faults[key], self.trials.get(key)
        if trial is not None:
            fault = fault._replace(of=self.lanes[trial.name, trial.counts])
        specimen = trial.specimen if trial is not None else self.specimen
        if not reduce or self.error:
            return fault
        inputs = fault.inputs
        if trial is not None and fault.kind in ("non-finite", "out of range"):
            bare = trial._replace(expected={}, path=False, grows="", compared=False)

            def fails(candidates: Inputs) -> Array:
                outputs = self.run(specimen, candidates)
                faults = faults_of(bare._replace(inputs=candidates), outputs)
                same_kind = [other.bad for other in faults if other.kind == fault.kind and other.output == fault.output]
                return same_kind[0] if same_kind else np.zeros(candidates.lanes, np.bool_)

            with contextlib.suppress(SssgenError):  # then the input stays unreduced
                inputs = shrink(specimen, inputs, fails)
        return fault._replace(inputs=inputs, command=line(specimen, inputs, self.name, self.settings.guards))
