"""Baked light and lengths that do not fit their scene, and bad input of `sssgen bake fluence`: a message for each."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import bake, facts, write
from sssgen.bake import fluence, memory_check
from sssgen.cli import bake_fluence
from sssgen.cli.main import main
from sssgen.material.baked import mesh_key
from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile
from sssgen.run import backends
from sssgen.run.render.scene_render import render
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import body_identity
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Mesh, Union
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import Diagnostic, SssgenError

for package in ("trimesh", "igl", "embreex", "scipy", "psutil"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake]'")

pytestmark = pytest.mark.usefixtures("folder")

FEW = ["--voxels", "6", "--photons", "16", "--processes", "1"]
MEDIUM = "[medium]\nabsorption = [0.5, 1.0, 1.5]\nscattering = [4.0, 4.0, 4.0]\n"
MATERIAL = """
[material]
name = "stone"
shading = "lit"
[[thickness]]
technique = "constant_thickness"
[[thickness]]
technique = "view_thickness_from_chord"
[translucency]
technique = "fluence_fixed"
fluence_volume = "stone.npy"
"""
SCENE = """
material = "stone.toml"
size = [12, 10]
[camera]
position = [0.0, 0.6, 3.4]
target = [0.0, 0.0, 0.0]
[geometry]
kind = "box"
size = [1.0, 0.6, 0.4]
[[light]]
direction = [0.4, 0.8, 0.1]
"""


@pytest.fixture(scope="module")
def volume(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The fluence of SCENE's box, for one light."""
    top = tmp_path_factory.mktemp("volume")
    (top / "box.toml").write_text(SCENE.replace('material = "stone.toml"', "") + MEDIUM, encoding="utf-8")
    bake("fluence", str(top / "box.toml"), "-o", str(top / "stone.npy"), "--light", "0.4,0.8,0.1", *FEW)
    return top


@pytest.fixture
def stone(volume: Path, folder: Path) -> Path:
    """The volume with its material and scene, here."""
    for name in ("stone.npy", "stone.npy.json"):
        (folder / name).write_bytes((volume / name).read_bytes())
    (folder / "stone.toml").write_text(MATERIAL, encoding="utf-8")
    (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
    return folder


def drawn(text: str = SCENE) -> float:
    """The brightness of the scene's picture."""
    Path("scene.toml").write_text(text, encoding="utf-8")
    return float(render(load("scene.toml"), backends.get("numpy")).linear.mean())


def message(text: str) -> str:
    with pytest.raises(SssgenError) as caught:
        drawn(text)
    return str(caught.value)


@pytest.mark.usefixtures("stone")
def test_a_bake_fits_its_body_wherever_it_is() -> None:
    assert drawn() > 0.0
    placed = SCENE.replace("[[light]]", "position = [0.1, 0.2, 0.0]\nrotation = [0.0, 20.0, 0.0]\n[[light]]")
    placed = placed.replace("[0.4, 0.8, 0.1]", "[0.4101, 0.8, -0.0428]")  # turned with the body
    assert drawn(placed) > 0.0


@pytest.mark.usefixtures("stone")
@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        (
            "[1.0, 0.6, 0.4]", "[1.0, 0.6, 0.8]",
            ["another body: box from (-0.5, -0.3, -0.2) to (0.5, 0.3, 0.2)", "box from (-0.5, -0.3, -0.4)"],
        ),
        ('"box"\nsize = [1.0, 0.6, 0.4]', '"ball"\nradius = 0.3', ["another body: box", "ball from (-0.3, -0.3"]),
        ("size = [1.0, 0.6, 0.4]", "size = [1.001, 0.6, 0.4]", ["with the key", "the scene has the key"]),
        ("size = [1.0", "scale = 2.0\nsize = [1.0", ["for the scale 1.0", "has 2", "bake it for this scene"]),
        (
            "[[light]]", "[parameters]\nextinction = [4.5, 5.0, 9.0]\n[[light]]",
            ["the extinction (4.5, 5, 5.5)", "the material has (4.5, 5, 9)", "scene.toml:"],
        ),
        (
            "[[light]]", "[parameters]\nscattering_albedo = [0.9, 0.8, 0.1]\n[[light]]",
            ["the scattering_albedo (0.8889, 0.8, 0.7273)", "has (0.9, 0.8, 0.1)"],
        ),
        (
            "[[light]]", "[parameters]\nmean_free_path = 0.3\n[[light]]",
            ["the mean_free_path 0.2", "the material has 0.3", "mean_free_path = 0.3", "leave mean_free_path out"],
        ),
        ("direction = [0.4, 0.8, 0.1]", "position = [0.1, 0.1, 0.0]", ["light 1 is inside the body", "from afar"]),
    ],
    ids=[
        "another size", "another shape", "another key", "another scale", "extinction", "albedo", "mean free path",
        "light inside",
    ],
)  # fmt: skip
def test_a_bake_of_something_else_is_an_error_with_both_values(old: str, new: str, parts: list[str]) -> None:
    text = message(SCENE.replace(old, new))
    for part in parts:
        assert part in text, text


@pytest.mark.parametrize("command", [["emit", "--target", "wgsl", "-o", "out"], ["check"]])
def test_a_material_with_another_medium_is_refused(
    stone: Path, command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = MATERIAL + "extinction = [4.5, 5.0, 7.0]\n"
    Path("stone.toml").write_text(wrong, encoding="utf-8")
    assert main([command[0], "stone.toml", *command[1:]]) == 2
    text = capsys.readouterr().err
    assert "the extinction (4.5, 5, 5.5)" in text and "the material has (4.5, 5, 7)" in text and "stone.toml:" in text
    # rounding, as in a value that was copied from the JSON, is no difference
    Path("stone.toml").write_text(MATERIAL + "extinction = [4.52, 5.0, 5.49]\n", encoding="utf-8")
    assert main(["emit", "stone.toml", "--target", "wgsl", "-o", "out"]) == 0


OCTAVES = """
[[translucency]]
technique = "interior_octaves"
bind = { light_path = "depth_map_path" }
"""


@pytest.mark.parametrize("first", [True, False], ids=["before", "after"])
def test_a_stage_that_shares_a_parameter_of_the_medium_is_compared(stone: Path, first: bool) -> None:
    """Whichever stage is first, its mean free path is that of the light in the volume, too."""
    baked = MATERIAL[MATERIAL.index("[translucency]") :].replace("[translucency]", "[[translucency]]")
    head = MATERIAL[: MATERIAL.index("[translucency]")]
    for length, fits in (("0.2", True), ("0.7", False)):
        other = f"{OCTAVES}mean_free_path = {length}\n"
        Path("stone.toml").write_text(head + (other + baked if first else baked + other), encoding="utf-8")
        if fits:
            load_material("stone.toml")
            continue
        with pytest.raises(SssgenError) as caught:
            load_material("stone.toml")
        (wrong,) = caught.value.diagnostics
        assert "is baked for the mean_free_path 0.2, and the material has 0.7" in wrong.message
        assert wrong.source_line == "mean_free_path = 0.7"


@pytest.mark.usefixtures("stone")
def test_a_scene_is_compared_where_another_stage_declares_the_shared_parameter() -> None:
    """The scene names the volume, and the stage before it has the parameter in the shader."""
    bare = MATERIAL.replace('fluence_volume = "stone.npy"\n', "").replace(
        "[translucency]", f"{OCTAVES}[[translucency]]"
    )
    Path("stone.toml").write_text(bare, encoding="utf-8")
    named = SCENE + '[textures]\nfluence_volume = "stone.npy"\n'
    loaded = load_material("stone.toml")
    Path("scene.toml").write_text(named, encoding="utf-8")
    shell = shell_of(load("scene.toml"), loaded, compile(loaded, "numpy").reflection)
    assert shell.parameters["mean_free_path"] == pytest.approx((0.2,))
    assert "the mean_free_path 0.2" in message(f"{named}[parameters]\nmean_free_path = 0.7\n")


def warnings_of(text: str) -> list[Diagnostic]:
    Path("scene.toml").write_text(text, encoding="utf-8")
    return list(render(load("scene.toml"), backends.get("numpy")).warnings)


@pytest.mark.usefixtures("stone")
def test_a_medium_that_was_changed_after_the_bake_is_a_warning() -> None:
    assert warnings_of(SCENE + MEDIUM) == []
    cases = (
        (
            MEDIUM.replace("1.5]", "3.5]"),
            "extinction (4.5, 5, 5.5) and not (4.5, 5, 7.5), albedo (0.8889, 0.8",
        ),
        (f"{MEDIUM}ior = 1.4\n", "for another medium: ior 1 and not 1.4"),
        (f"{MEDIUM}anisotropy = 0.5\n", "for another medium: anisotropy 0 and not 0.5"),
    )
    for medium, said in cases:
        (warning,) = warnings_of(SCENE + medium)
        assert warning.severity == "warning" and "'stone.npy' is baked" in warning.message and said in warning.message
        assert warning.source_line == "[medium]" and warning.span.line == SCENE.count("\n") + 1
        assert "bake again" in warning.hint


@pytest.mark.usefixtures("stone")
def test_a_medium_without_values_is_no_medium_of_a_bake() -> None:
    assert "the medium has neither a preset nor scattering" in message(f"{SCENE}[medium]\n")


@pytest.mark.parametrize(
    ("medium", "said"),
    [
        ("[medium]\n", "the medium has neither a preset nor scattering"),
        ("[medium]\nabsorption = [0.5, 1.0, 1.5]\n", "the medium has neither a preset nor scattering"),
    ],
)
def test_a_bake_has_no_default_medium(folder: Path, medium: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "body.toml").write_text(SCENE.replace('material = "stone.toml"', "") + medium, encoding="utf-8")
    text = refused(capsys, "body.toml", *FEW)
    assert said in text and f"body.toml:{SCENE.count(chr(10)) + 1}:1" in text and 'preset = "marble"' in text


def test_a_bake_says_which_boundary_it_has(folder: Path) -> None:
    """A mesh has the measured index of a medium; a scene has the ior of its [medium], which is 1 without this key."""
    body = SCENE.replace('material = "stone.toml"', "")
    marble = '[medium]\npreset = "marble"\nunit_mm = 2.0\n'
    (folder / "matched.toml").write_text(body + marble, encoding="utf-8")
    (folder / "refracting.toml").write_text(f"{body}{marble}ior = 1.5\n", encoding="utf-8")
    (folder / "own.toml").write_text(body + MEDIUM, encoding="utf-8")
    for path, name, said in (
        ("box.obj", "marble", "the surface refracts, which a scene states by ior = 1.5 in [medium]"),
        ("refracting.toml", "", "the surface refracts, which a scene states by ior = 1.5 in [medium]"),
        ("matched.toml", "", "the surface does not refract; for that of marble write ior = 1.5 in [medium]"),
        ("own.toml", "", "the surface does not refract"),
    ):
        medium = fluence.body(path, name, 2.0).medium
        assert medium is not None and bake_fluence.boundary(fluence.medium_facts(medium)) == said


@pytest.mark.usefixtures("stone")
def test_two_bakes_of_different_media_in_one_material() -> None:
    """The scene names the texture; the material sets the medium by itself."""
    bare = MATERIAL.replace('fluence_volume = "stone.npy"', "scattering_albedo = [0.5, 0.5, 0.5]")
    Path("stone.toml").write_text(bare, encoding="utf-8")
    text = message(SCENE + '[textures]\nfluence_volume = "stone.npy"\n')
    assert "the scattering_albedo (0.8889, 0.8, 0.7273)" in text and "has (0.5, 0.5, 0.5)" in text


@pytest.mark.usefixtures("stone")
def test_files_without_the_body_are_not_compared() -> None:
    content = facts("stone.npy")
    del content["body"]
    Path("stone.npy.json").write_text(json.dumps(content), encoding="utf-8")
    assert drawn(SCENE.replace("0.6, 0.4]", "0.6, 0.5]")) > 0.0


def test_a_key_is_of_the_shape_alone(folder: Path) -> None:
    box = Box(size=(1.0, 2.0, 3.0))
    assert body_identity.key(box) == body_identity.key(Box(size=(1.0, 2.0, 3.0), position=(1.0, 0.0, 0.0), scale=2.0))
    different = [
        box, Box(size=(1.0, 2.0, 3.5)), Ball(0.5), Capsule(0.5), Union((box,)),
        Union((Box(size=(1.0, 2.0, 3.0), position=(1.0, 0.0, 0.0)),)), Distance("sphere"),
        Distance("sphere", parameters={"radius": 0.7}), Mesh(path="box.obj"),
    ]  # fmt: skip
    assert len({body_identity.key(shape) for shape in different}) == len(different)
    Path("copy.obj").write_bytes(Path("box.obj").read_bytes())
    assert body_identity.key(Mesh(path="copy.obj")) == body_identity.key(Mesh(path="box.obj"))
    assert body_identity.key(Mesh(path="box.obj")) == mesh_key(Path("box.obj").read_bytes())
    first = body_identity.key(Mesh(path="copy.obj"))
    Path("copy.obj").write_bytes(Path("box.obj").read_bytes() + b"v 0 0 0\n")
    assert body_identity.key(Mesh(path="copy.obj")) != first
    for place in ("here", "there"):
        Path(place).mkdir()
        Path(place, "ball.sss").write_text("float ball(world_position p) { return length(p) - 0.5; }\n")
    assert body_identity.key(Distance("ball.sss", "here")) == body_identity.key(Distance("ball.sss", "there"))
    Path("there", "ball.sss").write_text("float ball(world_position p) { return length(p) - 0.6; }\n")
    assert body_identity.key(Distance("ball.sss", "here")) != body_identity.key(Distance("ball.sss", "there"))


# --- maps of lengths ---

LENGTHS = """
[material]
name = "stone"
[thickness]
technique = "view_thickness_map"
view_harmonics_1 = "made_1.png"
view_harmonics_2 = "made_2.png"
view_harmonics_3 = "made_3.png"
[translucency]
technique = "interior_sample"
bind = { light_path = "march_light", body_distance = "sphere" }
mean_free_path = 0.1
"""


@pytest.mark.parametrize(
    ("mesh", "length", "parts"),
    [
        ("box.obj", "0.1", []),
        ("other.obj", "0.1", ["another body: other.obj from (-0.5, -0.3, -0.4)", "box.obj from (-0.5, -0.3, -0.2)"]),
        ("box.obj", "0.03", ["the mean free path 0.03", "the material's is 0.1"]),
        ("box.obj", "0.6", []),  # the map stores lengths relative to a quarter of the body: it resolves them
        ("box.obj", "0.01", ["the mean free path 0.01"]),
    ],
)
def test_maps_of_lengths_are_compared(folder: Path, mesh: str, length: str, parts: list[str]) -> None:
    write(Path("other.obj"), meshes.box((1.0, 0.6, 0.8)))
    bake("view_thickness", mesh, "--mean-free-path", length, "-o", "made.png", "--size", "24", "--processes", "1")
    Path("stone.toml").write_text(LENGTHS, encoding="utf-8")
    scene = SCENE.replace('"box"\nsize = [1.0, 0.6, 0.4]', '"mesh"\nfile = "box.obj"')
    if not parts:
        assert drawn(scene) > 0.0
    for part in parts:
        assert part in message(scene)


# --- bad input of the bake ---

BAD: dict[str, tuple[list[str], list[str]]] = {
    "no medium": (["box.obj"], ["a mesh has no medium", "--medium"]),
    "an open mesh": (["open.obj", "--medium", "marble"], ["open.obj", "hole"]),
    "a sheet": (["thin.obj", "--medium", "marble", "--unit-mm", "1"], ["no voxel is inside", "more voxels"]),
    "a lamp inside": (["lamp.toml"], ["the light is inside the body", "move it out"]),
    "a light with a position": (["box.obj", "--medium", "marble", "--light", "lamp.json"], ["has a position"]),
    "no scattering": (["black.toml"], ["does not scatter"]),
    "a .bin": (["box.obj", "--medium", "marble", "-o", "out.bin"], ["for all lights and surroundings", "add --relit"]),
    "nearly clear": (["clear.toml"], ["nearly clear", "at least 0.05", "seen_through"]),
    "opaque voxels": (["dense.toml"], ["mean free paths long", "at most 10", "more voxels"]),
    "too many voxels": (["box.obj", "--medium", "marble", "--voxels", "500"], ["500 voxels"]),
    "no technique": (["box.obj", "--medium", "marble", "--rank", "5"], ["rank 5", "4, 8"]),
}


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """The message of a bake that fails with the exit code of an error, and writes nothing."""
    assert main(["bake", "fluence", "-o", "out.npy", *words]) == 2
    text = capsys.readouterr().err
    assert "Traceback" not in text and not list(Path().glob("out*"))
    return text


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_refused(case: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    whole = meshes.box((1.0, 0.6, 0.4))
    assert whole.uv is not None
    write(Path("open.obj"), whole._replace(faces=whole.faces[:-2], uv=whole.uv[:-2]))
    write(Path("thin.obj"), meshes.box((1.0, 1.0, 1e-4)))
    Path("lamp.json").write_text('{"position": [1.0, 2.0, 3.0]}', encoding="utf-8")
    body = SCENE.replace('material = "stone.toml"', "")
    Path("lamp.toml").write_text(body.replace("direction = [0.4, 0.8", "position = [0.1, 0.1") + MEDIUM, "utf-8")
    Path("black.toml").write_text(body + MEDIUM.replace("[4.0, 4.0, 4.0]", "[0.0, 0.0, 0.0]"), "utf-8")
    Path("clear.toml").write_text(body + MEDIUM.replace("[4.0, 4.0, 4.0]", "[1e-4, 1e-4, 1e-4]"), "utf-8")
    Path("dense.toml").write_text(body + MEDIUM.replace("[4.0, 4.0, 4.0]", "[900.0, 900.0, 900.0]"), "utf-8")
    words, parts = BAD[case]
    text = refused(capsys, *FEW, *words)
    for part in parts:
        assert part in text, text


def test_a_bake_that_does_not_fit_into_memory(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory_check, "SPARE", 1e-9)
    text = refused(capsys, "box.obj", "--medium", "marble", *FEW)
    assert "of memory" in text and "use fewer voxels" in text


def test_an_opaque_voxel_is_a_warning_and_the_volume_is_finite(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = SCENE.replace('material = "stone.toml"', "") + MEDIUM.replace("[4.0, 4.0, 4.0]", "[30.0, 4.0, 4.0]")
    Path("dense.toml").write_text(scene, encoding="utf-8")
    assert main(["bake", "fluence", "dense.toml", "-o", "out.npy", "--light", "0,1,0", *FEW]) == 0
    text = capsys.readouterr().out
    assert "warning: a voxel is opaque in one channel: use more voxels" in text
    assert "for the technique fluence_fixed: the surface does not refract" in text
    assert facts("out.npy")["opaque_voxels"]
    assert np.isfinite(facts("out.npy")["parameters"]["fluence_scale"]).all()


def test_an_inverted_mesh_is_the_same_body(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(Path("turned.ply"), meshes.box((1.0, 0.6, 0.4)).inverted()._replace(uv=None))
    write(Path("right.ply"), meshes.box((1.0, 0.6, 0.4))._replace(uv=None))
    words = ["--medium", "marble", "--unit-mm", "2", "--light", "0,1,0", *FEW]
    for name in ("turned", "right"):
        bake("fluence", f"{name}.ply", "-o", f"{name}.npy", *words)
        assert ("the mesh is inside out" in capsys.readouterr().out) == (name == "turned")
    assert facts("turned.npy")["parameters"] == facts("right.npy")["parameters"]
    assert (Path("turned.npy").read_bytes()) == Path("right.npy").read_bytes()


@pytest.mark.slow
def test_parts_inside_each_other_have_no_light_inside(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outer, inner = meshes.box((1.0, 0.6, 0.4)), meshes.box((0.5, 0.3, 0.2))
    faces = np.concatenate([outer.faces, inner.faces + len(outer.vertices)])
    write(Path("both.ply"), outer._replace(vertices=np.r_[outer.vertices, inner.vertices], faces=faces, uv=None))
    assert main(["bake", "fluence", "both.ply", "-o", "out.npy", "--medium", "marble", "--unit-mm", "2", *FEW]) == 2
    error = capsys.readouterr().err
    assert "20% of the surface is inside another part of the mesh" in error and "--> both.ply" in error
    cavity = np.concatenate([outer.faces, inner.faces[:, ::-1] + len(outer.vertices)])
    write(Path("both.ply"), outer._replace(vertices=np.r_[outer.vertices, inner.vertices], faces=cavity, uv=None))
    bake("fluence", "both.ply", "-o", "out.npy", "--medium", "marble", "--unit-mm", "2", *FEW)


def test_a_volume_for_another_light(stone: Path, folder: Path) -> None:
    scene = folder / "scene.toml"
    scene.write_text(SCENE.replace("[0.4, 0.8, 0.1]", "[0.0, 1.0, 0.0]"), encoding="utf-8")
    with pytest.raises(SssgenError) as caught:
        render(load(str(scene)), backends.require("numpy"))
    (wrong,) = caught.value.diagnostics
    assert wrong.message == (
        "'stone.npy' is baked for a light from (0.444, 0.889, 0.111) in the body's space; the scene has (0, 1, 0)"
    )
    # the body turns, and the light with it
    turned = SCENE.replace("size = [1.0", "rotation = [0.0, 0.0, 90.0]\nsize = [1.0")
    scene.write_text(turned.replace("[0.4, 0.8, 0.1]", "[-0.8, 0.4, 0.1]"), encoding="utf-8")
    render(load(str(scene)), backends.require("numpy"))


@pytest.mark.parametrize(
    ("name", "message"), [("missing.obj", "there is no such file"), (".", "this is a folder")], ids=["file", "folder"]
)
def test_a_body_that_is_no_file(name: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bake", "fluence", name, "-o", "out.npy", "--medium", "marble", *FEW]) == 2
    assert message in capsys.readouterr().err


def test_a_seed_is_not_negative(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "body.toml").write_text(SCENE.replace('material = "stone.toml"', "") + MEDIUM, encoding="utf-8")
    assert main(["bake", "fluence", "body.toml", "-o", "out.npy", "--seed", "-1"]) == 2
    assert "-1 is not a seed" in capsys.readouterr().err


def test_the_media_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "media"]) == 0
    assert "marble" in capsys.readouterr().out
