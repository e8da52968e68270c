"""What a material requires: `emit` says it, and the first lines of its shader."""

from __future__ import annotations

import pytest

from sssgen.material.material_loading import load_material
from sssgen.material.requirements import describe
from sssgen.pipeline.compiler import compile

REQUIRED = {
    "ice": [],
    "wax_mouse": ["a texture that is baked from the body (distance_map)", "a rigid mesh"],
    "jelly": ["a rigid mesh (cubes)"],
    "leaves": ["a rigid mesh"],
    "jade_ring": ["the light's depth map", "a picture of the body's back faces"],
}


@pytest.mark.parametrize("name", REQUIRED)
def test_the_requirements_of_examples(name: str) -> None:
    assert describe(load_material(name).stages) == REQUIRED[name]


def head(name: str) -> str:
    """The comment at the head of an example's module."""
    return compile(load_material(name), "threejs").files[f"{name}.js"].partition("import")[0].replace("\n// ", " ")


def test_the_head_of_a_shader_names_what_it_requires() -> None:
    assert "distanceMap: bake it from the body (sssgen bake)." in head("wax_mouse")
    assert "Made for the body of cubes: on another mesh the light inside is wrong." in head("jelly")
    assert "bake" not in head("ice") and "Made for" not in head("ice")
