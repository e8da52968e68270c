"""Tests `sssgen pick --light moving` on random scenes, under lights that neither a fit nor the race used.

python docs/moving_trial.py [--processes N]: about half an hour on two cores; an interrupted run continues. It writes
docs/accuracy/moving_picks.json, which docs/accuracy.py reads. The scenes are those of pick_trial, with limits that
are the same for all of them.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TypedDict

import numpy as np
import pick_trial

from sssgen.lab.chart import racing
from sssgen.lab.chart.charting import Settings
from sssgen.lab.chart.engine_conditions import Conditions
from sssgen.lab.chart.picking import pick
from sssgen.lab.chart.whole_progress import WholeProgress
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.file_writer import write_files
from sssgen.support.progress import ProgressBar

RECORD = Path(__file__).parent / "accuracy" / "moving_picks.json"
LIMITS = tuple(round(float(limit), 3) for limit in np.geomspace(0.1, 0.6, 8))
MOVING = Conditions(light="moving")
SHARE = 0.95
"""The goal: of the cases whose error is within the limit under lights that were not used."""


class Case(TypedDict):
    """A pick within a limit on a scene."""

    scene: str
    title: str
    limit: float
    """The largest relative error"""
    met: bool
    """Whether the race found a chain within the limit"""
    picked: str
    """The label of the chain"""
    cost: float
    """Weighted operations"""
    errors: list[float]
    """Under each of the lights that were not used, the larger one of the two views"""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--processes", type=int)
    settings = Settings(processes=options.parse_args().processes)
    cases = [
        pick_case(scene, limit, settings)
        for scene in map(pick_trial.random_scene, range(pick_trial.SCENES))
        for limit in LIMITS
    ]
    write_files(str(RECORD.parent), {RECORD.name: json.dumps(cases, indent=1) + "\n"})
    print(table(cases))


def pick_case(scene: MeasuredScene, limit: float, settings: Settings) -> Case:
    """The pick for a scene's own lights and six drawn ones, and its errors under six further lights."""
    with ProgressBar() as bar:
        progress = WholeProgress(bar, racing.STAGES)
        record = racing.race_record(scene, settings, racing.Limits(limit, None, MOVING), progress)
        picked = pick(record, scene.name, limit, None, MOVING)
        assert picked.chain is not None
        others = racing.unseen_errors(scene, picked.chain, progress.of(settings, "lights"), racing.LIGHTS)
    assert others is not None, "no chain needs a fixed light"
    return {
        "scene": scene.name, "title": scene.title, "limit": limit, "met": picked.met,
        "picked": picked.chain["label"], "cost": float(picked.chain["cost"]["value"]),
        "errors": [round(float(value), 4) for value in others.values],
    }  # fmt: skip


def load() -> list[Case]:
    """The stored cases; none where the trial was not run."""
    cases: list[Case] = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else []
    return cases


def share_within(cases: list[Case]) -> float:
    """The share of the answers whose median error under other lights is within the limit."""
    return float(np.mean([np.median(case["errors"]) <= case["limit"] for case in cases if case["met"]]))


def goal(cases: list[Case]) -> str:
    """The goal as a row of a table."""
    name = (
        "`pick --light moving`: under six lights that were not used, the median error is within the limit in ≥ "
        f"{100.0 * SHARE:g} % of the cases"
    )
    if not cases:
        return f"| {name} | not measured | |"
    answers, share = sum(case["met"] for case in cases), share_within(cases)
    verdict = "reached" if share >= SHARE else "**missed**"
    return f"| {name} | {100.0 * share:.1f} % of {answers} answers of {len(cases)} cases | {verdict} |"


def table(cases: list[Case]) -> str:
    """The cases, and their summary."""
    if not cases:
        return "Not measured with the present techniques."
    answers = [case for case in cases if case["met"]]
    single = np.concatenate([np.array(case["errors"]) <= case["limit"] for case in answers])
    lines = [
        f"{len(cases)} cases, of which {len(answers)} have an answer within the limit. Under six lights that were not "
        f"used, the median error is within the limit in {100.0 * share_within(cases):.1f} % of the answers; of the "
        f"{len(single)} single lights {100.0 * single.mean():.1f} % are.",
        "",
        "| scene | limit | picked | cost | other lights, median | worst |",
        "|---|---:|---|---:|---:|---:|",
    ]
    for case in cases:
        mark = "" if case["met"] else " (not within)"
        lines.append(
            f"| {case['scene']}: {case['title']} | {case['limit']:.3f} | {case['picked']}{mark} | {case['cost']:.0f} | "
            f"{np.median(case['errors']):.3f} | {max(case['errors']):.3f} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    main()
