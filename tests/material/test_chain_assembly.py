"""How stages become functions: what runs once per light cannot write what the surface has once for all lights."""

from __future__ import annotations

from pathlib import Path

import pytest

import sssgen
from sssgen.support.diagnostics import SssgenError

HEAD = """
/**
 * A stage.
 * role: {role}
 * formula: None.
 * source: None.
 * units: None.
 * limits: None.
{more} */
"""
DUSTY = "void stage(inout thickness d, inout vec3 albedo) { albedo *= exp(-float(d)); d = thickness(2.0 * d); }"
THICKER = "void stage(inout thickness d) { d = thickness(2.0 * d); }"
SHINE = "vec3 stage(thickness d) { return vec3(d); }"
MATERIAL = """
[material]
name = "one"
[[thickness]]
{thickness}
[[surface]]
technique = "base_color"
[[{section}]]
technique = "stage.sss"
"""
PER_LIGHT = 'technique = "march_light"\nbind = { body_distance = "sphere" }'
CONSTANT = 'technique = "constant_thickness"'


def emitted(folder: Path, thickness: str, stage: str, section: str = "surface", more: str = "", tail: str = "") -> str:
    """The fragment shader of a material with a stage of its own after a thickness."""
    (folder / "stage.sss").write_text(HEAD.format(role=section, more=more) + stage)
    (folder / "one.toml").write_text(MATERIAL.format(thickness=thickness, section=section) + tail)
    return sssgen.compile(folder / "one.toml", "glsl-330").files["one.glsl-330.frag"]


def function(text: str, name: str) -> str:
    return text[text.index(f" {name}(") :].partition("\n}")[0]


TAIL = '[[thickness]]\ntechnique = "beer_lambert"\n[translucency]\ntechnique = "lobe_normalized"\n'


def test_a_surface_value_that_depends_on_the_light_is_an_error(tmp_path: Path) -> None:
    """It was written into a copy that nobody read."""
    with pytest.raises(SssgenError) as raised:
        emitted(tmp_path, PER_LIGHT, DUSTY)
    (error,) = raised.value.diagnostics
    assert error.message == "'stage' writes albedo once per light, as it reads thickness; all lights share the surface"
    assert error.hint == "write albedo in a technique that does not read thickness"
    assert (error.span.line, error.source_line) == (10, 'technique = "stage.sss"')


def test_the_same_stage_after_a_thickness_of_all_lights(tmp_path: Path) -> None:
    surface = function(emitted(tmp_path, CONSTANT, DUSTY, tail=TAIL), "evaluate_surface")
    assert surface.index("base_color(uv, albedo, alpha);") < surface.index("stage(thickness, albedo);")
    assert "return Surface(albedo" in surface


def test_a_stage_may_write_what_each_light_has_of_its_own(tmp_path: Path) -> None:
    text = emitted(tmp_path, PER_LIGHT, THICKER, tail=TAIL)
    assert "stage(" not in function(text, "evaluate_surface")
    light = function(text, "evaluate_translucency")
    assert light.index("march_light(") < light.index("stage(thickness);")


def test_light_that_is_added_once_does_not_depend_on_a_light(tmp_path: Path) -> None:
    glows = " * glows: Its light is the body's own.\n"
    assert "emission" in function(emitted(tmp_path, CONSTANT, SHINE, "translucency", glows), "evaluate_surface")
    with pytest.raises(SssgenError, match="'stage' writes emission once per light, as it reads thickness"):
        emitted(tmp_path, PER_LIGHT, SHINE, "translucency", glows)
