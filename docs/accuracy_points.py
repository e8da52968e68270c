"""What the site quotes of the charts' records, which are too large for the repository: docs/accuracy/points.json."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence

from sssgen.ir.baked_textures import is_baked
from sssgen.lab.chart.record import Point, Record, measures
from sssgen.lab.measure.technique_chain import is_drawn, textures_of
from sssgen.material import library

DRAWN = "cube"
"""The scene on which the site draws the most accurate chain with each technique."""
CHAIN = (
    "role", "name", "label", "settings", "chain", "baseline", "path", "path_settings", "parameters", "scale", "matte",
    "training_error", "factor", "scene",
)  # fmt: skip
"""What a point needs to be drawn: `charting.candidate_of` and `fit_of` read it."""


def quoted(records: Sequence[Record]) -> str:
    """JSON: `alone` has the error and cost of each technique by itself, `best` the most accurate chain with each.

    Of two records with the same scene and chain, it quotes the first.
    """
    unique: dict[tuple[object, ...], Point] = {}
    for point in (point for record in records for point in record["points"] if not point["failed"]):
        unique.setdefault((point["role"], point["scene"], point["label"]), point)
    alone = [_alone(point) for point in unique.values() if point["role"] != "material"]
    chains = [point for point in unique.values() if point["role"] == "material" and point["scene"] == DRAWN]
    best = [f"{json.dumps(name)}: {json.dumps(point)}" for name, point in sorted(_best(chains).items())]
    rows, chain_rows = (",\n".join(lines) for lines in (map(json.dumps, alone), best))
    return f'{{"alone": [\n{rows}\n], "best": {{\n{chain_rows}\n}}}}\n'


def _alone(point: Point) -> dict[str, object]:
    return {
        "role": point["role"], "name": point["name"], "label": point["label"], "scene": point["scene"],
        "error": {"value": round(measures(point)[1], 6)}, "cost": {"value": round(point["cost"]["value"], 6)},
    }  # fmt: skip


def _best(chains: Iterable[Point]) -> dict[str, dict[str, object]]:
    """For each technique, the most accurate chain with it that needs no baked texture."""
    best: dict[str, dict[str, object]] = {}
    for point in sorted(chains, key=lambda point: measures(point)[1]):
        fields: Mapping[str, object] = point
        names = [name for name in (*point["chain"], point.get("path", "")) if name]
        if not any(map(_is_baked, names)):
            kept = {key: fields[key] for key in CHAIN if key in fields} | {"error": {"value": point["error"]["value"]}}
            for name in names:
                best.setdefault(name, kept)
    return best


def _is_baked(name: str) -> bool:
    textures = textures_of(library.load(name.partition(":")[0]))
    return any(is_baked(texture) or not is_drawn(texture) for texture in textures)
