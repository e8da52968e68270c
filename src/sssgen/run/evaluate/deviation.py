"""How far a back end deviates from the oracle, and how far float32 itself must deviate.

Where a technique branches (a ray that just hits, the edge of a cell) or subtracts nearly equal numbers, two correct
float32 implementations differ by more than rounding: such lanes are ill-conditioned. The *rounding deviation* of a lane
measures this without any back end: how far the oracle's result moves when its inputs move by one unit in the last
place, and how far the same formulas in NumPy's float32 deviate there. A lane beyond the goal is *excluded* while its
deviation is at most `MARGIN` times its rounding deviation. Reports give the number of excluded lanes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.run.backends import HALF, Array, CompilerMissing, get
from sssgen.run.backends.backend_process import start_backend
from sssgen.run.evaluate.evaluation import Inputs, run
from sssgen.run.evaluate.probes import Subject
from sssgen.support.diagnostics import SssgenError
from sssgen.support.progress import Progress, silent

GOAL = 1e-5
"""The largest deviation that a technique in float32 should have."""


MARGIN = 4.0
"""How much larger the rounding deviation may be than measured, since it is measured with few draws."""
DRAWS = 8
"""How often the inputs are moved, each time up or down at random."""


class Deviation(NamedTuple):
    """The largest deviation of all outputs, over all lanes that are not excluded, and its place."""

    largest: float
    """|actual - expected| over the larger of |expected| and 1, both over a value's components; infinite where one is
    NaN and the other is not."""
    output: str
    lane: int
    actual: Array
    expected: Array
    excluded: int
    """The number of lanes beyond the goal that rounding explains."""
    furthest: float
    """The largest deviation of the excluded lanes; 0 where there are none."""


class Row(NamedTuple):
    """The result of one back end."""

    name: str
    device: str
    deviation: Deviation | None
    error: str
    missing: bool = False

    @property
    def ok(self) -> bool:
        """Whether it agrees, is missing, or computes in half precision, to which the goal does not apply."""
        if self.missing or self.name in HALF:
            return True
        return self.deviation is not None and self.deviation.largest <= GOAL

    @property
    def text(self) -> str:
        """The row as text."""
        if self.deviation is None:
            return f"{'missing' if self.missing else 'FAILED'}: {self.error}"
        worst = self.deviation
        where = f" at {worst.output}[{worst.lane}]: {worst.actual.tolist()}" if worst.largest > GOAL else ""
        where += " (half precision, to which the goal does not apply)" if where and self.name in HALF else ""
        excluded = f", {worst.excluded} ill-conditioned lanes excluded, up to {worst.furthest:.2g}"
        return f"{worst.largest:8.2g}{where}{excluded if worst.excluded else ''}  ({self.device})"

    def as_json(self) -> dict[str, Any]:
        """The row as JSON."""
        if self.deviation is None:
            return {"name": self.name, "missing": self.missing, "error": self.error}
        worst = self.deviation
        largest = worst.largest if np.isfinite(worst.largest) else None
        return {
            "name": self.name, "device": self.device, "ok": self.ok, "deviation": largest,
            "output": worst.output, "lane": worst.lane, "excluded": worst.excluded,
        }  # fmt: skip


def deviation(
    actual: Mapping[str, Array],
    expected: Mapping[str, Array],
    rounding: Callable[[], Mapping[str, Array]] | None = None,
) -> Deviation:
    """The largest deviation of outputs, lanes first, from the oracle's.

    `rounding` returns the rounding deviation of each output; it is called only where a lane is beyond the goal. Without
    it no lane is excluded.
    """
    each = {name: _errors_of(actual[name], right) for name, right in expected.items()}
    excluded = {name: np.zeros(len(lanes), np.bool_) for name, lanes in each.items()}
    if rounding is not None and any((lanes > GOAL).any() for lanes in each.values()):
        limits = rounding()
        excluded = {name: (lanes > GOAL) & (lanes <= MARGIN * limits[name]) for name, lanes in each.items()}
    worst = Deviation(-1.0, "", 0, np.zeros(()), np.zeros(()), 0, 0.0)
    for name, right in expected.items():
        left = np.where(excluded[name], 0.0, each[name])
        lane = int(np.argmax(left))
        if left[lane] > worst.largest:
            worst = worst._replace(
                largest=float(left[lane]),
                output=name,
                lane=lane,
                actual=np.asarray(np.atleast_1d(actual[name])[lane]),
                expected=np.asarray(np.atleast_1d(right)[lane]),
            )
    count = int(np.any([*excluded.values()], axis=0).sum())
    furthest = max((float(each[name][lanes].max()) for name, lanes in excluded.items() if lanes.any()), default=0.0)
    return worst._replace(excluded=count, furthest=furthest)


def rounding_deviation(
    subject: Subject, inputs: Inputs, oracle: Mapping[str, Array], guards: str = "auto"
) -> dict[str, Array]:
    """The rounding deviation of each output from the oracle, (lanes,), relative as that of `errors`."""
    rounded, exact = get("numpy-f32"), get("numpy")
    largest = {name: _errors_of(value, oracle[name]) for name, value in run(subject, inputs, rounded, guards).items()}
    rng = np.random.default_rng(0)
    for _ in range(DRAWS):
        near = inputs._replace(values={name: _move(value, rng) for name, value in inputs.values.items()})
        right, actual = run(subject, near, exact, guards), run(subject, near, rounded, guards)
        for name, value in right.items():
            apart = np.maximum(_errors_of(value, oracle[name]), _errors_of(actual[name], value))
            largest[name] = np.maximum(largest[name], apart)
    return largest


def _errors_of(actual: Array, expected: Array) -> Array:
    return errors(np.atleast_1d(actual), np.atleast_1d(expected))


def _move(value: Array, rng: np.random.Generator) -> Array:
    """Numbers moved by one float32 step, up or down; whole numbers stay."""
    if value.dtype.kind != "f":
        return value
    moved: Array = value + rng.choice([-1.0, 1.0], value.shape) * np.spacing(np.abs(value).astype(np.float32))
    return moved


def errors(actual: Array, expected: Array) -> Array:
    """The deviation of each lane, (lanes,)."""
    lanes = len(expected)
    a = actual.reshape(lanes, -1).astype(np.float64)
    b = expected.reshape(lanes, -1).astype(np.float64)
    with np.errstate(invalid="ignore"):
        apart = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.abs(a - b))
    apart = np.where(np.isnan(apart), np.inf, apart).max(axis=1)
    size = np.where(np.isfinite(b), np.abs(b), 0.0).max(axis=1)
    relative: Array = apart / np.maximum(size, 1.0)
    return relative


def compare(
    subject: Subject, inputs: Inputs, names: Sequence[str], guards: str = "auto", progress: Progress = silent
) -> tuple[dict[str, Array], list[Row]]:
    """The oracle's outputs, and each back end's deviation. Each back end runs in a process of its own."""
    progress(0, len(names) + 1, "numpy, the oracle")
    oracle = run(subject, inputs, get("numpy"), guards)
    rounding = cache(lambda: rounding_deviation(subject, inputs, oracle, guards))
    rows = []
    for index, name in enumerate(names):
        progress(index + 1, len(names) + 1, name)
        rows.append(_row(subject, inputs, oracle, rounding, name, guards))
    return oracle, rows


def _row(
    subject: Subject, inputs: Inputs, oracle: Mapping[str, Array], rounding: Callable[[], Mapping[str, Array]],
    name: str, guards: str,
) -> Row:  # fmt: skip
    try:
        backend = start_backend(name)
    except CompilerMissing as reason:
        return Row(name, "", None, str(reason), missing=True)
    except SssgenError as error:
        return Row(name, "", None, error.diagnostics[0].message)
    try:
        outputs = run(subject, inputs, backend, guards)
    except SssgenError as error:
        return Row(name, backend.device(), None, str(error))
    finally:
        if (close := getattr(backend, "close", None)) is not None:
            close()
    return Row(name, backend.device(), deviation(outputs, oracle, rounding if name not in HALF else None), "")
