"""How far a back end is from the oracle, and how far from it float32 itself must be.

Where a technique decides (a ray that just hits, the edge of a cell) or subtracts nearly equal numbers, two right
machines with float32 differ by more than rounding. The *blur* of a lane measures that without a look at any of them:
how far the oracle's own result moves when its inputs move by one unit in the last place, and how far the same formulas
in NumPy's float32 are off there. A lane beyond the goal is *excused* while its deviation is at most `MARGIN` times its
blur. The excused are counted, and told.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from sssgen.harness.backends import HALF, Array, CompilerMissing, get
from sssgen.harness.backends.isolated import started
from sssgen.harness.evaluate.evaluation import Inputs, run
from sssgen.harness.evaluate.probes import Subject
from sssgen.support.diagnostics import SssgenError

GOAL = 1e-5
"""The largest deviation that a technique in float32 is meant to have."""


MARGIN = 4.0
"""What another order of rounding may add to the blur, which only a few draws have measured."""
DRAWS = 8
"""How often the blur moves the inputs, each time up or down at random."""


class Deviation(NamedTuple):
    """The largest of all outputs and of all lanes that are not excused, and where it is."""

    largest: float
    """|got - wanted| over the larger of |wanted| and 1, both over a value's components; infinite where one is NaN and
    the other is not."""
    output: str
    lane: int
    got: Array
    wanted: Array
    excused: int
    """Lanes beyond the goal, no further than the blur explains."""
    furthest: float
    """The largest deviation of the excused; 0 where there are none."""


class Row(NamedTuple):
    """What came of one back end."""

    name: str
    device: str
    deviation: Deviation | None
    error: str
    missing: bool = False

    @property
    def ok(self) -> bool:
        """Whether it agrees, or is not here, or computes in half precision, which is not meant to."""
        if self.missing or self.name in HALF:
            return True
        return self.deviation is not None and self.deviation.largest <= GOAL

    @property
    def told(self) -> str:
        """The row for a person."""
        if self.deviation is None:
            return f"{'missing' if self.missing else 'FAILED'}: {self.error}"
        found = self.deviation
        where = f" at {found.output}[{found.lane}]: {found.got.tolist()}" if found.largest > GOAL else ""
        where += " (half precision, which the goal is not for)" if where and self.name in HALF else ""
        excused = f", float32 blurs {found.excused} more by up to {found.furthest:.2g}" if found.excused else ""
        return f"{found.largest:8.2g}{where}{excused}  ({self.device})"

    def as_json(self) -> dict[str, Any]:
        """The row for programs."""
        if self.deviation is None:
            return {"name": self.name, "missing": self.missing, "error": self.error}
        found = self.deviation
        largest = found.largest if np.isfinite(found.largest) else None
        return {
            "name": self.name, "device": self.device, "ok": self.ok, "deviation": largest,
            "output": found.output, "lane": found.lane, "excused": found.excused,
        }  # fmt: skip


def deviation(
    got: Mapping[str, Array], wanted: Mapping[str, Array], blurred: Callable[[], Mapping[str, Array]] | None = None
) -> Deviation:
    """The largest deviation of outputs, lanes first, from the oracle's.

    `blurred` gives the blur of each output; it is asked where a lane is beyond the goal. Without it none is excused.
    """
    each = {name: _apart(got[name], right) for name, right in wanted.items()}
    excused = {name: np.zeros(len(found), np.bool_) for name, found in each.items()}
    if blurred is not None and any((found > GOAL).any() for found in each.values()):
        limit = blurred()
        excused = {name: (found > GOAL) & (found <= MARGIN * limit[name]) for name, found in each.items()}
    worst = Deviation(-1.0, "", 0, np.zeros(()), np.zeros(()), 0, 0.0)
    for name, right in wanted.items():
        left = np.where(excused[name], 0.0, each[name])
        lane = int(np.argmax(left))
        if left[lane] > worst.largest:
            found = np.atleast_1d(got[name])[lane], np.atleast_1d(right)[lane]
            worst = worst._replace(
                largest=float(left[lane]), output=name, lane=lane, got=np.asarray(found[0]), wanted=np.asarray(found[1])
            )
    count = int(np.any([*excused.values()], axis=0).sum())
    furthest = max((float(each[name][lanes].max()) for name, lanes in excused.items() if lanes.any()), default=0.0)
    return worst._replace(excused=count, furthest=furthest)


def blur(subject: Subject, inputs: Inputs, oracle: Mapping[str, Array], guards: str = "auto") -> dict[str, Array]:
    """How far rounding alone takes each lane of each output from the oracle, (lanes,), measured as `errors` does."""
    rounded, exact = get("numpy-f32"), get("numpy")
    found = {name: _apart(value, oracle[name]) for name, value in run(subject, inputs, rounded, guards).items()}
    rng = np.random.default_rng(0)
    for _ in range(DRAWS):
        near = inputs._replace(values={name: _moved(value, rng) for name, value in inputs.values.items()})
        right, got = run(subject, near, exact, guards), run(subject, near, rounded, guards)
        for name, value in right.items():
            apart = np.maximum(_apart(value, oracle[name]), _apart(got[name], value))
            found[name] = np.maximum(found[name], apart)
    return found


def _apart(got: Array, wanted: Array) -> Array:
    return errors(np.atleast_1d(got), np.atleast_1d(wanted))


def _moved(value: Array, rng: np.random.Generator) -> Array:
    """Numbers moved by one float32 step, up or down; whole numbers stay."""
    if value.dtype.kind != "f":
        return value
    moved: Array = value + rng.choice([-1.0, 1.0], value.shape) * np.spacing(np.abs(value).astype(np.float32))
    return moved


def errors(got: Array, wanted: Array) -> Array:
    """The deviation of each lane, (lanes,)."""
    lanes = len(wanted)
    a = got.reshape(lanes, -1).astype(np.float64)
    b = wanted.reshape(lanes, -1).astype(np.float64)
    with np.errstate(invalid="ignore"):
        apart = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.abs(a - b))
    apart = np.where(np.isnan(apart), np.inf, apart).max(axis=1)
    size = np.where(np.isfinite(b), np.abs(b), 0.0).max(axis=1)
    found: Array = apart / np.maximum(size, 1.0)
    return found


def compared(
    subject: Subject, inputs: Inputs, names: Sequence[str], guards: str = "auto"
) -> tuple[dict[str, Array], list[Row]]:
    """The oracle's outputs, and each back end's deviation. Each back end runs in a process of its own."""
    oracle = run(subject, inputs, get("numpy"), guards)
    blurred = cache(lambda: blur(subject, inputs, oracle, guards))
    return oracle, [_row(subject, inputs, oracle, blurred, name, guards) for name in names]


def _row(
    subject: Subject, inputs: Inputs, oracle: Mapping[str, Array], blurred: Callable[[], Mapping[str, Array]],
    name: str, guards: str,
) -> Row:  # fmt: skip
    try:
        backend = started(name)
    except CompilerMissing as reason:
        return Row(name, "", None, str(reason), missing=True)
    except SssgenError as error:
        return Row(name, "", None, error.diagnostics[0].message)
    try:
        found = run(subject, inputs, backend, guards)
    except SssgenError as error:
        return Row(name, backend.device(), None, str(error))
    finally:
        if (close := getattr(backend, "close", None)) is not None:
            close()
    return Row(name, backend.device(), deviation(found, oracle, blurred if name not in HALF else None), "")
