"""What a material requires: `emit` says it, and the first lines of its shader."""

from __future__ import annotations

from pathlib import Path

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
    own = "(drawn by the material itself)"
    pictures = [f"the light's depth map {own}", f"a picture of the body's back faces {own}"]
    assert describe(load_material("jade_ring").stages, ["the material itself"]) == pictures
    assert describe(load_material("leaves").stages, ["the material itself"]) == ["a rigid mesh"]


def test_each_picture_says_by_whom_it_is_drawn(tmp_path: Path) -> None:
    """What draws distances may not draw light."""
    text = '[material]\nname = "skin"\n[[surface]]\ntechnique = "screen_diffusion"\n'
    text += '[[thickness]]\ntechnique = "depth_map_thickness"\n[[thickness]]\ntechnique = "beer_lambert"\n'
    text += '[translucency]\ntechnique = "wrap_lighting"\n'
    (tmp_path / "skin.toml").write_text(text, encoding="utf-8")
    stages = load_material(str(tmp_path / "skin.toml")).stages
    distances, light = "the light's depth map", "a picture of what the body would reflect if it were white"
    assert describe(stages) == [distances, light]
    assert describe(stages, ["a node"]) == [f"{distances} (drawn by a node)", light]
    several = ["a node in A", "a feature in B"]
    by = "(drawn by a node in A, by a feature in B)"
    assert describe(stages, several, several[1:]) == [f"{distances} {by}", f"{light} (drawn by a feature in B)"]


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
