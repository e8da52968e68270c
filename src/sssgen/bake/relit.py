"""The file of the techniques fluence_relit and fluence_relit_refracted: how a body responds to light from anywhere."""

from __future__ import annotations

import os
from typing import Any

from sssgen.bake.bake_facts import RelitFacts
from sssgen.bake.fluence import check, facts_of, medium_facts, variant
from sssgen.jobs.executor import Progress
from sssgen.lab.fluence import response
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.lab.fluence.fluence_volumes import reach_of
from sssgen.material.baked import read_bake_file
from sssgen.scene.body_identity import identity
from sssgen.scene.light_response import is_of_file, to_bytes
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.support.diagnostics import failure

RANKS = (4, 32)
"""The least and the largest count of numbers in a voxel."""


def is_current(path: str, scene: MeasuredScene) -> bool:
    """Whether a file and its JSON are of a body and its medium, however many numbers and photons they have."""
    assert scene.medium is not None
    if not (os.path.isfile(path) and (described := read_bake_file(path)) and described.kind == "fluence"):
        return False
    facts: Any = described.facts
    body, medium = identity(scene.geometry, scaled=True), medium_facts(scene.medium)
    same = {**facts["medium"], "name": ""} == {**medium, "name": ""}
    same = same and (facts["body"]["key"], facts["body"]["scale"]) == (body["key"], body["scale"])
    with open(path, "rb") as file:
        return same and is_of_file(file.read(), facts["file"])


def bake(
    scene: MeasuredScene, rank: int, settings: Settings, scheduler: str = "", processes: int | None = None,
    progress: Progress = lambda *_: None,
) -> tuple[bytes, RelitFacts]:  # fmt: skip
    """The file with `rank` numbers in a voxel, and the facts for its JSON. Raises SssgenError."""
    if not RANKS[0] <= rank <= RANKS[1]:
        raise failure(
            f"{rank} numbers in a voxel are not between {RANKS[0]} and {RANKS[1]}",
            "16 are enough, 32 for a body with thin parts",
        )
    check(scene, settings)
    stored, traced = response.response(scene, rank, settings, scheduler, processes, progress)
    data, arrays = to_bytes(stored)
    assert scene.medium is not None
    facts = facts_of(scene, settings, traced)
    facts["parameters"]["fluence_reach"] = reach_of(traced.grid) * scene.geometry.scale
    return data, {
        **facts, "rank": rank, "technique": f"fluence_relit{variant(scene.medium)}",
        "arrays": arrays, "highest": stored.highest, "powers": stored.powers.tolist(),
        "largest": stored.largest.tolist(),
    }  # fmt: skip
