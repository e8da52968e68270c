"""The record of docs/light_that_moves.py, and the goals that it shows: lights that no fit used."""

from __future__ import annotations

import json
from pathlib import Path
from statistics import median
from typing import NamedTuple, TypedDict

RECORD = Path(__file__).parent / "accuracy" / "light_that_moves.json"
AFAR, NEAR, AROUND = "A light from afar", "A lamp at one radius from the surface", "Surroundings"
"""Tables of a part."""
ALL_AROUND = "all three: volume"
"""The row of all surroundings"""
MEBIBYTE = 1024**2


class RowRecord(TypedDict):
    """A row of a table: lists with a value for each body."""

    label: str
    median: list[float]
    """Over the cases"""
    worst: list[float]


class ChainCost(TypedDict):
    """What a chain costs, for any number of lights."""

    operations: float
    bytes: int
    """The largest of the bodies' textures"""


class PartRecord(TypedDict):
    """The bodies with one kind of surface."""

    index: float
    """The refractive index; 1 for a matched boundary"""
    bodies: list[str]
    costs: dict[str, ChainCost]
    """By the chain's label"""
    tables: dict[str, list[RowRecord]]


class MovingRecord(TypedDict):
    """The page's figures."""

    lights: int
    samples: int
    """In surroundings; a light has a quarter"""
    parts: list[PartRecord]


class Boundary(NamedTuple):
    """A goal with a refracting boundary: the median error within a cost."""

    error: float
    operations: int


MATCHED_OPERATIONS = 400
MEDIAN, WORST_LIGHT, SURROUNDINGS, LAMP, WORST_BODY = 0.06, 0.10, 0.06, 0.10, 0.10
BOUNDARIES = (Boundary(0.25, 250), Boundary(0.12, 600), Boundary(0.09, 1000))


def load() -> MovingRecord:
    """The stored record."""
    record: MovingRecord = json.loads(RECORD.read_text(encoding="utf-8"))
    return record


def rows(record: MovingRecord) -> list[str]:
    """The goals as rows of a table: the goal, what was measured, and whether it is reached."""
    matched, bent = record["parts"]
    ours = _within(matched, MATCHED_OPERATIONS)
    far, near, around = (
        next(row for row in matched["tables"][title] if row["label"] == label)
        for title, label in ((AFAR, ours), (NEAR, ours), (AROUND, ALL_AROUND))
    )
    body = max(range(len(matched["bodies"])), key=lambda number: far["median"][number])
    size = matched["costs"][ours]["bytes"]
    result = [
        _row(f"{_lights(record)}: median error ≤ {MEDIAN:g} for at most {MATCHED_OPERATIONS} operations for all lights",
             f"{_middle(far['median'])}: `{ours}`", median(far["median"]) <= MEDIAN),
        _row(f"their worst light ≤ {WORST_LIGHT:g}, median over the bodies",
             f"{_middle(far['worst'])}; the largest {max(far['worst']):.3f}", median(far["worst"]) <= WORST_LIGHT),
        _row(f"the worst body ≤ {WORST_BODY:g}, with at most 1 MiB of textures",
             f"{matched['bodies'][body]} {far['median'][body]:.3f}, {size / 1024:.0f} KiB",
             far["median"][body] <= WORST_BODY and size <= MEBIBYTE),
        _row(f"surroundings alone ≤ {SURROUNDINGS:g}", _middle(around["median"]),
             median(around["median"]) <= SURROUNDINGS),
        _row(f"a lamp at one radius ≤ {LAMP:g}", _middle(near["median"]), median(near["median"]) <= LAMP),
    ]  # fmt: skip
    for goal in BOUNDARIES:
        label = _within(bent, goal.operations)
        errors = next(row for row in bent["tables"][AFAR] if row["label"] == label)["median"]
        result.append(
            _row(
                f"a boundary of index {bent['index']:g}, lights from afar: ≤ {goal.error:g} for at most "
                f"{goal.operations} operations",
                f"{_middle(errors)} at {bent['costs'][label]['operations']:.0f}: `{label}`",
                median(errors) <= goal.error,
            )
        )
    return result


def _within(part: PartRecord, operations: int) -> str:
    """The chain with the smallest median error within a cost."""
    chains = [row for row in part["tables"][AFAR] if part["costs"][row["label"]]["operations"] <= operations]
    return min(chains, key=lambda row: median(row["median"]))["label"]


def _lights(record: MovingRecord) -> str:
    return f"{record['lights']} lights from afar that no fit used"


def _middle(errors: list[float]) -> str:
    return f"{median(errors):.3f}"


def _row(goal: str, measured: str, met: bool) -> str:
    return f"| {goal} | {measured} | {'reached' if met else '**missed**'} |"
