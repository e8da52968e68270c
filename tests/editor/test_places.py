"""Hover, definition and completion at marked places of each kind of file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sssgen.editor.completion import completions_at
from sssgen.editor.definition import definition_at
from sssgen.editor.hover import hover_at
from sssgen.material import library, roles
from sssgen.material.material_loading import examples

LOBE = """#include "common/lobe.sss"

const float SHARP = 4.0;
uniform float gain : hint_range(0.0, 2.0), unit("1") = 1.0; // brightness

float part(float x)
{
    return x * SHARP;
}

/**
 * A lobe of its own.
 * role: translucency
 */
vec3 own(world_direction V, world_direction N, transmittance through)
{
    float near = clamp(dot(V, N), 0.0, 1.0);
    return glow(part(near) * gain * power, through);
}
"""
ICE = Path(examples()["ice"]).read_text("utf-8")


def at(text: str, before: str, mark: str = "‸", count: int = 1) -> str:
    """The text with the mark before the `count`th occurrence of a piece."""
    position = -1
    for _ in range(count):
        position = text.index(before, position + 1)
    return text[:position] + mark + text[position:]


@pytest.mark.parametrize(
    ("before", "count", "parts"),
    [
        ("clamp(", 1, ("builtin", "clamp(")),
        ("part(near)", 1, ("float part(float x)",)),
        ("gain *", 1, ("float, default 1, 0 to 2", "own.sss")),
        ("power,", 1, ("power", "common/lobe.sss")),
        ("near) *", 1, ("float near",)),
        ("near = ", 1, ("float near",)),
        ("V, N)", 1, ("world_direction V",)),
        ("SHARP;", 1, ("const float SHARP = 4.0",)),
        ("world_direction V,", 1, ("a world direction", "vec3")),
        ("own(world", 1, ("A lobe of its own.", "translucency", "gain")),
        ("common/lobe", 1, ("common/lobe.sss",)),
    ],
)
def test_hover_in_a_technique(opened: Callable[..., Any], before: str, count: int, parts: tuple[str, ...]) -> None:
    hover = hover_at(*opened("own.sss", at(LOBE, before, count=count)).place)
    assert hover is not None
    for part in parts:
        assert part in hover.markdown


def test_a_hover_names_files_as_the_document_does(opened: Callable[..., Any]) -> None:
    hover = hover_at(*opened("own.sss", at(LOBE, "gain *")).place)
    assert hover is not None and hover.markdown.endswith("*declared in* own.sss")


def test_hover_survives_an_error_elsewhere(opened: Callable[..., Any]) -> None:
    broken = opened("own.sss", at(LOBE.replace("return x *", "return *"), "gain *"), right=LOBE)
    hover = hover_at(*broken.place)
    assert hover is not None and "0 to 2" in hover.markdown


def test_hover_in_a_comment_and_in_nothing(opened: Callable[..., Any]) -> None:
    assert hover_at(*opened("own.sss", at(LOBE, "brightness")).place) is None
    assert hover_at(*opened("own.sss", LOBE + "\n‸").place) is None


@pytest.mark.parametrize(
    ("before", "parts"),
    [
        ("voronoi_thickness", ("Thickness in Voronoi cells", "cell_count", "*source*")),
        ("bevel", ("default 0.35", "here: 0.35", "voronoi")),
        ("thickness_factor", ("0 to 10", "m")),
    ],
)
def test_hover_in_a_material(opened: Callable[..., Any], before: str, parts: tuple[str, ...]) -> None:
    hover = hover_at(*opened("ice.toml", at(ICE, before)).place)
    assert hover is not None
    for part in parts:
        assert part in hover.markdown


def test_hover_in_a_scene(opened: Callable[..., Any]) -> None:
    text = 'material = "ice"\n\n[geometry]\nkind = "ball"\n\n[parameters]\n‸erosion = 0.5\n'
    hover = hover_at(*opened("scene.toml", text).place)
    assert hover is not None and "erosion" in hover.markdown and "0 to 1" in hover.markdown


@pytest.mark.parametrize(
    ("before", "file", "line"),
    [
        ("common/lobe.sss", "lobe.sss", ""),
        ("part(near)", "own.sss", "float part(float x)"),
        ("gain *", "own.sss", "uniform float gain"),
        ("power,", "lobe.sss", "uniform float power"),
        ("glow(", "lobe.sss", "vec3 glow("),
    ],
)
def test_definition_in_a_technique(opened: Callable[..., Any], before: str, file: str, line: str) -> None:
    place = opened("own.sss", at(LOBE, before))
    target = definition_at(*place.place)
    assert target is not None and Path(target.path).name == file
    text = LOBE if file == "own.sss" else Path(target.path).read_text("utf-8")
    assert text.split("\n")[target.range.line].startswith(line)


def test_a_builtin_has_no_definition(opened: Callable[..., Any]) -> None:
    assert definition_at(*opened("own.sss", at(LOBE, "clamp(")).place) is None


def test_definition_from_a_material(opened: Callable[..., Any]) -> None:
    target = definition_at(*opened("ice.toml", at(ICE, "voronoi_thickness")).place)
    assert target is not None and target.path == library.index()["voronoi_thickness"]
    target = definition_at(*opened("ice.toml", at(ICE, "bevel")).place)
    assert target is not None and "bevel" in Path(target.path).read_text("utf-8").split("\n")[target.range.line]


def test_definition_of_a_slot_and_of_what_is_bound(opened: Callable[..., Any]) -> None:
    text = Path(examples()["jade_ring"]).read_text("utf-8")
    line = next(line for line in text.split("\n") if line.startswith("bind"))
    slot, bound = line.split("{")[1].split("=")[0].strip(), line.split('"')[1]
    target = definition_at(*opened("ring.toml", at(text, f"{slot} =")).place)
    assert target is not None and slot in Path(target.path).read_text("utf-8").split("\n")[target.range.line]
    target = definition_at(*opened("ring.toml", at(text, f'"{bound}"').replace('‸"', '"‸')).place)
    assert target is not None and target.path == library.index()[bound.partition(":")[0]]


def labels(opened: Any) -> list[str]:
    return [item.label for item in completions_at(*opened.place)]


def test_techniques_that_the_chain_supplies_come_first(opened: Callable[..., Any]) -> None:
    head = '[material]\nname = "own"\n\n'
    chain = '[[thickness]]\ntechnique = "voronoi_thickness"\n\n[[thickness]]\ntechnique = "beer_lambert"\n\n'
    stage = '[translucency]\ntechnique = "‸"\n'
    items = completions_at(*opened("own.toml", head + chain + stage).place)
    ranks = {item.label: item.rank for item in items}
    assert ranks["lobe_normalized"] == 0  # it reads the transmittance that beer_lambert gives
    assert {library.load(name).role for name in ranks} == set(roles.allowed_roles("translucency"))
    alone = completions_at(*opened("own.toml", head + stage).place)
    missing = {item.label: item for item in alone}["lobe_normalized"]
    assert missing.rank == 2 and "takes a transmittance" in missing.detail
    assert [item.rank for item in alone] == sorted(item.rank for item in alone)


def test_completion_in_a_material(opened: Callable[..., Any]) -> None:
    stage = '[material]\nname = "own"\n\n[thickness]\ntechnique = "voronoi_thickness"\nbevel = 0.2\n'
    found = completions_at(*opened("own.toml", f"{stage}‸\n").place)
    texts = {item.label: item.text for item in found}
    assert texts["cell_count"] == "cell_count = 12.0"
    assert "bevel" not in texts and "technique" not in texts and "uv" in texts
    assert "thickness" in labels(opened("own.toml", f"{stage}\n[‸\n"))
    assert labels(opened("own.toml", '[material]\nname = "own"\nshading = "‸"\n')) == ["lit", "unlit"]
    assert "alpha_mode" in labels(opened("own.toml", '[material]\nname = "own"\n‸\n'))


def test_completion_of_slots(opened: Callable[..., Any]) -> None:
    stage = '[material]\nname = "own"\n\n[thickness]\ntechnique = "march_light"\nbind = { ‸ }\n'
    (slot, *_) = labels(opened("own.toml", stage))
    fitting = labels(opened("own.toml", stage.replace("‸", f'{slot} = "‸"')))
    assert any(name.partition(":")[0] == "sphere" for name in fitting)


def test_completion_in_a_scene(opened: Callable[..., Any]) -> None:
    head = 'material = "ice"\n\n[geometry]\nkind = "ball"\n'
    assert {"erosion", "cell_count"} <= set(labels(opened("s.toml", f"{head}\n[parameters]\n‸\n")))
    assert "cover_texture" in labels(opened("s.toml", f"{head}\n[textures]\n‸\n"))
    assert "torus" in labels(opened("s.toml", head.replace('"ball"', '"‸"')))
    assert "ice" in labels(opened("s.toml", 'material = "‸"\n[camera]\n'))
    assert "field_of_view" in labels(opened("s.toml", f"{head}\n[camera]\n‸\n"))
    assert "aces" in labels(opened("s.toml", f'{head}\n[shell]\ntone_mapping = "‸"\n'))


def test_completion_in_a_technique(opened: Callable[..., Any]) -> None:
    inside = LOBE.replace("    return glow", "    ‸\n    return glow")
    found = labels(opened("own.sss", inside, right=LOBE))
    assert {"clamp", "part", "gain", "power", "near", "V", "through", "SHARP", "world_direction", "vec3"} <= set(found)
    assert found.index("near") < found.index("clamp") < found.index("return")
    assert "hint_range" in labels(opened("own.sss", LOBE.replace(": hint_range(0.0, 2.0)", ": ‸"), right=LOBE))
    texture = LOBE.replace(": hint_range(0.0, 2.0)", ": drawn(‸").replace("uniform float", "uniform sampler2D", 1)
    assert "back_faces" in labels(opened("own.sss", texture, right=LOBE))
    assert "translucency" in labels(opened("own.sss", LOBE.replace("role: translucency", "role: ‸"), right=LOBE))
    assert "formula" in labels(opened("own.sss", LOBE.replace(" * role:", " * ‸\n * role:"), right=LOBE))
    assert "common/lobe.sss" in labels(opened("own.sss", LOBE.replace("common/lobe.sss", "‸"), right=LOBE))
