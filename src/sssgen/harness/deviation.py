"""How far a back end is from the oracle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..diagnostics import SssgenError
from .backends import Array, Backend, CompilerMissing, get
from .evaluate import Inputs, run
from .isolated import isolated
from .probes import Subject

GOAL = 1e-5
"""The largest deviation that a technique in float32 is meant to have."""


class Deviation(NamedTuple):
    """The largest of all lanes and outputs, and where it is."""

    largest: float
    """|got - wanted| over the larger of |wanted| and 1, both over a value's components; infinite where one is NaN and
    the other is not."""
    output: str
    lane: int
    got: Array
    wanted: Array


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
        if self.missing or self.name == "numpy-f16":
            return True
        return self.deviation is not None and self.deviation.largest <= GOAL

    @property
    def told(self) -> str:
        """The row for a person."""
        if self.deviation is None:
            return f"{'missing' if self.missing else 'FAILED'}: {self.error}"
        found = self.deviation
        where = f" at {found.output}[{found.lane}]: {found.got.tolist()}" if found.largest > GOAL else ""
        return f"{found.largest:8.2g}{where}  ({self.device})"

    def as_json(self) -> dict[str, Any]:
        """The row for programs."""
        if self.deviation is None:
            return {"name": self.name, "missing": self.missing, "error": self.error}
        found = self.deviation
        largest = found.largest if np.isfinite(found.largest) else None
        return {
            "name": self.name, "device": self.device, "ok": self.ok, "deviation": largest,
            "output": found.output, "lane": found.lane,
        }  # fmt: skip


def deviation(got: Mapping[str, Array], wanted: Mapping[str, Array]) -> Deviation:
    """The largest deviation of outputs, lanes first, from the oracle's."""
    worst = Deviation(-1.0, "", 0, np.zeros(()), np.zeros(()))
    for name, right in wanted.items():
        each = errors(np.atleast_1d(got[name]), np.atleast_1d(right))
        lane = int(np.argmax(each))
        if each[lane] > worst.largest:
            found = np.atleast_1d(got[name])[lane], np.atleast_1d(right)[lane]
            worst = Deviation(float(each[lane]), name, lane, *map(np.asarray, found))
    return worst


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


def compared(subject: Subject, inputs: Inputs, names: Sequence[str]) -> tuple[dict[str, Array], list[Row]]:
    """The oracle's outputs, and each back end's deviation. Each back end runs in a process of its own."""
    oracle = run(subject, inputs, get("numpy"))
    return oracle, [_row(subject, inputs, oracle, name) for name in names]


def _row(subject: Subject, inputs: Inputs, oracle: Mapping[str, Array], name: str) -> Row:
    try:
        backend: Backend = get(name) if name.startswith("numpy") else isolated(name)
    except CompilerMissing as reason:
        return Row(name, "", None, str(reason), missing=True)
    except SssgenError as error:
        return Row(name, "", None, error.diagnostics[0].message)
    try:
        found = run(subject, inputs, backend)
    except SssgenError as error:
        return Row(name, backend.device(), None, str(error))
    finally:
        if (close := getattr(backend, "close", None)) is not None:
            close()
    return Row(name, backend.device(), deviation(found, oracle), "")
