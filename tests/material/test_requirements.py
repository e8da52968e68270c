"""What a material requires: `emit` says it, and the first lines of its shader."""

from __future__ import annotations

import pytest

from sssgen.material.material_loading import load_material
from sssgen.material.requirements import describe
from sssgen.pipeline.compiler import compile

REQUIRED = {
    "ice": [],
    "wax_mouse": ["a texture that is baked from the body (distance_map)", "a rigid mesh"],
    "jelly": ["the body that it is made for (cubes), as on another mesh its light is wrong"],
    "leaves": ["a rigid mesh"],
    "jade_ring": ["the light's depth map", "a picture of the body's back faces"],
}


@pytest.mark.parametrize("name", REQUIRED)
def test_the_requirements_of_examples(name: str) -> None:
    assert describe(load_material(name).stages) == REQUIRED[name]


def test_what_an_engine_draws_itself() -> None:
    pictures = ["the light's depth map", "a picture of the body's back faces (each drawn by the material itself)"]
    assert describe(load_material("jade_ring").stages, ["the material itself"]) == pictures
    assert describe(load_material("leaves").stages, ["the material itself"]) == ["a rigid mesh"]


def head(name: str, file: str = "{}.js", target: str = "threejs", form: str = "shader") -> str:
    """The comment at the head of an example's file."""
    text = compile(load_material(name), target, form).files[file.format(name)]
    return text.partition("import")[0].replace("\n// ", " ")


def test_the_head_of_a_shader_names_what_it_requires() -> None:
    assert "distanceMap: bake it from the body (sssgen bake)." in head("wax_mouse")
    assert "Made for the body of cubes: on another mesh the light inside is wrong." in head("jelly")
    assert "backFaceMap: drawn by the material itself." in head("jade_ring")
    node = "back_face_map: drawn by the node of jade_ring_passes.gd below the body."
    assert node in head("jade_ring", "{}.gdshader", "godot")
    assert "backFaceMap: draw the translucent body" in head("jade_ring", "{}.functions.js", form="functions")
    assert "bake" not in head("ice") and "Made for" not in head("ice")
