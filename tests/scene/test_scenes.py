"""Measured scenes: capsules, unions, media and inlays from files, and bodies of materials."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from sssgen.cli.main import main
from sssgen.lab.measure import scene_references as references
from sssgen.run.evaluate.evaluation import half
from sssgen.scene.bounds import bounds, world_corners
from sssgen.scene.example_scenes import measured_scenes
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.measured import measured_scene, media
from sssgen.scene.measured import scene_body as body
from sssgen.scene.measured.measured_scene import Inlay, MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.scene.scene_loading import parse_scene
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

BALL = '[geometry]\nkind = "ball"\n'
LIT = "[[light]]\ndirection = [0, 0, -2]\n"
UNION = '[medium]\npreset = "cream"\n[geometry]\nkind = "union"\n'


def measured(text: str) -> MeasuredScene:
    return measured_scene.of_scene(parse_scene(text, "my_scene.toml"), "my_scene.toml")


# --- the file ---


def test_a_capsule_and_a_union_are_read() -> None:
    scene = parse_scene(
        UNION.replace("preset", "unit_mm = 2.0\npreset")
        + 'rotation = [0.0, 90.0, 0.0]\nprojection = "planar"\n'
        + '[[geometry.part]]\nkind = "capsule"\nradius = 0.1\nlength = 0\n'
        + '[[geometry.part]]\nkind = "union"\nscale = 2\n[[geometry.part.part]]\nkind = "ball"\nradius = 3\n',
        "scene.toml",
    )
    inner = Union((Ball(3.0),), scale=2.0)
    assert scene.geometry == Union((Capsule(0.1, 0.0), inner), "planar", rotation=(0.0, 90.0, 0.0))
    assert scene.material == ""
    assert scene.measured == {"medium": {"unit_mm": 2.0, "preset": "cream"}}


def test_every_scene_of_the_library_loads() -> None:
    for name in measured_scenes():
        scene = measured_scene.load(name)
        assert scene.name == name and scene.title
        assert (scene.medium is None) == name.startswith("inlay") == (scene.inlay is not None)
        assert points(replace(scene, size=(12, 12))).count > 10


def test_a_situation_describes_its_scene() -> None:
    scene = measured('title = "Mine"\nsize = [200, 100]\n[medium]\npreset = "marble"\nunit_mm = 4\n' + BALL + LIT)
    assert (scene.name, scene.title, scene.size) == ("my_scene", "Mine", (64, 32))
    assert scene.medium == media.preset("marble", 4.0).matched()
    assert scene.lights[0].direction == (0.0, 0.0, -1.0)
    assert measured("[inlay]\n" + BALL).title == "My scene"
    inputs = measured("[medium]\nabsorption = [0, 1, 2]\nscattering = [3, 4, 5]\nanisotropy = 0.5\n" + BALL + LIT)
    assert inputs.medium is not None
    assert (inputs.medium.absorption, inputs.medium.scattering) == ((0.0, 1.0, 2.0), (3.0, 4.0, 5.0))
    assert (inputs.medium.anisotropy, inputs.medium.ior) == (0.5, 1.0)
    assert measured("[inlay]\ndepth = 0.2\nior = 1.33\noutside_ior = 1.1\n" + BALL).inlay == Inlay(0.2, 1.33, 1.1)


def test_situations_are_compared_by_value(tmp_path: Path) -> None:
    text = '[medium]\npreset = "marble"\n' + BALL + LIT
    scene, equal_scene = measured(text), measured(text + "\n# the same\n")
    assert scene is not equal_scene and scene == equal_scene and hash(scene) == hash(equal_scene)
    for other in (
        replace(scene, size=(8, 8)),
        replace(scene, geometry=Ball(1.1)),
        scene.held_out(),
        replace(scene, name="b"),
    ):
        assert other != scene
    # the content of a file counts, not its path
    file = tmp_path / "figure.sss"
    scene = '[inlay]\n[geometry]\nkind = "distance"\ntechnique = "figure.sss"\n'
    results = []
    for radius in ("0.5", "0.6"):
        file.write_text(f"float figure(vec3 p)\n{{\n    return length(p) - {radius};\n}}\n", encoding="utf-8")
        results.append(measured_scene.of_scene(parse_scene(scene, tmp_path / "s.toml"), "s.toml"))
    assert results[0] != results[1] and results[0].geometry == results[1].geometry


def test_the_held_out_view_is_turned_about_the_vertical_through_the_target() -> None:
    scene = measured_scene.load("bracket")
    aside = scene.held_out()
    before, after = (np.subtract(view.camera.position, scene.camera.target) for view in (scene, aside))
    assert after[1] == pytest.approx(before[1])
    assert np.linalg.norm(after) == pytest.approx(np.linalg.norm(before))
    turned = np.degrees(np.arctan2(after[0], after[2]) - np.arctan2(before[0], before[2]))
    assert turned == pytest.approx(measured_scene.HELD_OUT)
    above = replace(scene, camera=replace(scene.camera, position=(0.0, 4.0, 0.0)))
    assert above.held_out().camera.position[0] != 0.0  # the view is not the same


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        (UNION, "a union has from 1 to 64 parts", 3),
        (UNION + "part = []\n", "a union has from 1 to 64 parts", 5),
        (UNION + 'part = "ball"\n', "a union has from 1 to 64 parts", 5),
        (UNION + '[[geometry.part]]\nkind = "ball"\n' * 65, "a union has from 1 to 64 parts", 0),
        (UNION + '[[geometry.part]]\nkind = "ball"\n[[geometry.part]]\nkind = "bal"\n', "did you mean 'ball'", 8),
        (UNION + "[[geometry.part]]\nradius = 1\n", "the geometry has no kind", 0),
        (UNION + '[[geometry.part]]\nkind = "capsule"\nmajor = 1\n', "unknown key 'major'", 7),
        (UNION + '[[geometry.part]]\nkind = "capsule"\nlength = -1\n', "'length' cannot be -1", 7),
        (UNION + 'projection = "sperical"\n[[geometry.part]]\nkind = "ball"\n', "unknown projection", 5),
        ('title = ["a"]\n[inlay]\n' + BALL, "'title' takes one line of text", 1),
        ("[medum]\n" + BALL, "did you mean 'medium'", 1),
        ('[medium]\npreset = "marbel"\n' + BALL + LIT, "did you mean 'marble'", 2),
        ('[medium]\npreset = "marble"\nabsorption = [1, 1, 1]\n' + BALL + LIT, "a preset has its own absorption", 3),
        ('[medium]\npreset = "marble"\nanisotropy = 0.1\n' + BALL + LIT, "a preset has its own anisotropy", 3),
        ("[medium]\nscattering = [1, 1, 1]\nunit_mm = 3\n" + BALL + LIT, "given in world units", 3),
        ("[medium]\nscattering = [0.0, 0.0, 0.0]\n" + BALL + LIT, "this medium does not scatter", 2),
        ("[medium]\nscattering = [1, 1]\n" + BALL + LIT, "'scattering' takes 3 numbers", 2),
        ("[medium]\nscattering = [1, 1, -1]\n" + BALL + LIT, "'scattering' cannot be -1", 2),
        ("[medium]\nanisotropy = 1\n" + BALL + LIT, "'anisotropy' cannot be 1", 2),
        ("[medium]\npresett = 1\n" + BALL + LIT, "did you mean 'preset'", 2),
        ("medium = 3\n" + LIT + BALL, "'medium' is a table", 1),
        ("[medium]\n" + BALL + "[[light]]\nposition = [0, 0.5, 0]\n", "the light is inside the body", 5),
        ("[medium]\nior = 0.9\n" + BALL + LIT, "'ior' cannot be 0.9", 2),
        ('[medium]\npreset = "wax"\nior = 5\n' + BALL + LIT, "'ior' cannot be 5", 3),
        ("[medium]\nior = 1.4\nroughness = 1.1\n" + BALL + LIT, "'roughness' cannot be 1.1", 3),
        ("[medium]\nior = 1.4\nroughness = -0.1\n" + BALL + LIT, "'roughness' cannot be -0.1", 3),
        ("[medium]\nroughness = 0.2\n" + BALL + LIT, "does not refract has no roughness", 2),
        ('[medium]\nior = "glass"\n' + BALL + LIT, "'ior' takes a number", 2),
        ("[medium]\n" + BALL + "[environment]\ncolor = [0, 0, 0]\n", "the environment is black", 4),
        ("[medium]\n" + BALL + "[environment]\nintensity = -1\n", "'intensity' cannot be -1", 5),
        ("[medium]\n" + BALL + '[environment]\nfile = "none.exr"\n', "searched for next to the scene", 5),
        ("[medium]\n" + BALL + '[environment]\nfile = "none.hdr"\n', "'.hdr' is not a picture", 5),
        ("[medium]\n" + BALL + "[environment]\ncolour = [1, 1, 1]\n", "did you mean 'color'", 5),
        ("[medium]\n" + BALL, "the scene has no light", 1),
        ("[medium]\n" + LIT, "no geometry to measure", 0),
        ('material = "ice"\n' + BALL + LIT, "does not describe the medium of its body", 0),
        ("[inlay]\ndepth = 0\n" + BALL, "'depth' cannot be 0", 2),
        ("[inlay]\nior = 0.5\n" + BALL, "'ior' cannot be 0.5", 2),
        ("[inlay]\ndeph = 1\n" + BALL, "did you mean 'depth'", 2),
    ],
)
def test_errors_are_reported_at_their_place(text: str, message: str, line: int) -> None:
    with pytest.raises(SssgenError) as caught:
        measured(text)
    results = [
        diagnostic for diagnostic in caught.value.diagnostics if message in f"{diagnostic.message} {diagnostic.hint}"
    ]
    assert results, caught.value
    if line:
        assert (results[0].span.file, results[0].span.line) == ("my_scene.toml", line)


def test_an_unknown_scene_gets_a_suggestion() -> None:
    with pytest.raises(SssgenError) as caught:
        measured_scene.load("brackt")
    assert "did you mean 'bracket'" in str(caught.value)


def test_a_scene_for_pictures_says_which_can_be_measured() -> None:
    with pytest.raises(SssgenError) as caught:
        measured_scene.load("wax_mouse")
    (diagnostic,) = caught.value.diagnostics
    assert "'wax_mouse' is for pictures" in diagnostic.message
    assert all(name in diagnostic.hint for name in measured_scenes())


def test_a_scene_without_a_material_is_not_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text('[medium]\npreset = "cream"\n' + BALL + LIT, encoding="utf-8")
    assert main(["render", str(scene), "-o", str(tmp_path / "a.png"), "--backend", "numpy"]) == 2
    output = capsys.readouterr().err
    assert "the scene names no material" in output and 'add: material = "…"' in output
    assert not (tmp_path / "a.png").exists()


# --- the body of a material ---

ASKEW: dict[str, Any] = {"position": (0.3, -0.2, 0.5), "rotation": (20.0, -30.0, 65.0), "scale": 1.7}
SOLIDS: list[Geometry] = [
    Ball(0.9),
    Box(size=(1.0, 1.4, 0.7)),
    Slab(1.5, 2.0, 0.2),
    Torus(0.8, 0.3),
    Capsule(0.3, 0.7),
    Union((Ball(0.5, position=(0.4, 0.0, 0.0)), Box(size=(1.0, 0.2, 0.3), rotation=(0.0, 30.0, 10.0)))),
    Union((Union((Torus(0.6, 0.2, **ASKEW),), scale=0.6), Capsule(0.25, 0.9, rotation=(0.0, 0.0, 90.0)))),
]


def evaluated(text: str, folder: Path) -> Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]:
    """The function `body` of a file at points (n, 3), compiled like the distance function of a scene."""
    (folder / body.FILE).write_text(text, encoding="utf-8")
    return Distance(f"{body.FILE}:body", folder=str(folder)).distance


@pytest.mark.parametrize("shape", [*SOLIDS, *(replace(solid, **ASKEW) for solid in SOLIDS)], ids=repr)
def test_the_text_of_a_body_computes_its_distance(shape: Geometry, tmp_path: Path) -> None:
    at = np.random.default_rng(4).uniform(-3.0, 3.0, (400, 3))
    inwards = shape.to_object()
    exact = shape.scale * shape.distance(at @ inwards[:3, :3].T + inwards[:3, 3])
    assert (exact < 0.0).any() and (exact > 0.0).any()
    result = body.body(shape)
    assert result.function == f"{body.FILE}:body"
    # its numbers are rounded to float32
    assert evaluated(result.files[body.FILE], tmp_path)(at) == pytest.approx(exact, abs=3e-6)


def test_bodies_without_a_transform_are_bound_directly(tmp_path: Path) -> None:
    sphere = Distance("sphere", parameters={"radius": 0.4})
    bound = body.body(sphere)
    assert bound == body.Body("sphere", {}, {"radius": 0.4}, bound.span)
    assert 0.8 * 3.0**0.5 <= bound.span < 0.9 * 3.0**0.5  # the diagonal of its box, which comes from a grid
    text = "float egg(vec3 p)\n{\n    return length(p) - 0.5;\n}\n"
    (tmp_path / "egg.sss").write_text(text, encoding="utf-8")
    egg = Distance("egg.sss:egg", folder=str(tmp_path))
    assert replace(body.body(egg), span=0.0) == body.Body("egg.sss:egg", {"egg.sss": text}, {})
    # a function of object space does not depend on the body's position
    assert body.body(replace(egg, position=(1.0, 0.0, 0.0))).function == "distance_texture_world"
    corners, faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "m.obj").write_text(corners + faces, encoding="utf-8")
    assert body.body(Mesh(path=str(tmp_path / "m.obj"))).function == "distance_texture_world"
    with pytest.raises(SssgenError, match="cannot be part of a union"):
        body.body(Union((egg,)))


@pytest.mark.parametrize("shape", [*SOLIDS, Distance("sphere", parameters={"radius": 0.4}, reach=1.0)], ids=repr)
def test_bounds_hold_the_body_and_its_texture_reads_the_distance(shape: Geometry) -> None:
    low, high = bounds(shape)
    at = np.random.default_rng(4).uniform(low - 1.0, high + 1.0, (4000, 3))
    inside = shape.distance(at) < 0.0
    assert inside.sum() > 20
    cell = 0.05 if isinstance(shape, Distance) else 1e-9  # the bounds of a distance function come from a grid
    assert ((low - cell <= at[inside]) & (at[inside] <= high + cell)).all()
    result = body.distance_texture(shape)
    texture, reach = half(Texture(result.values(shape), wrap="clamp")), result.range
    box_min, box_max = np.array(result.box_min), np.array(result.box_max)
    within = ((box_min < at) & (at < box_max)).all(axis=1)
    read = texture.sample(((at[within] - box_min) / (box_max - box_min)).T)[0]
    exact = np.clip(shape.distance(at[within]), -reach, reach)
    texel = float((box_max - box_min).max()) / body.TEXELS
    assert np.abs((read - 0.5) * 2.0 * reach - exact).max() < 1.1 * texel


def test_placed_corners_hold_the_body() -> None:
    for shape in SOLIDS:
        placed = replace(shape, **ASKEW)
        corners = world_corners(placed)
        at = np.random.default_rng(4).uniform(-3.0, 3.0, (3000, 3))
        inwards = placed.to_object()
        inside = at[placed.distance(at @ inwards[:3, :3].T + inwards[:3, 3]) < 0.0]
        assert len(inside) and (corners.min(axis=0) <= inside).all() and (inside <= corners.max(axis=0)).all()


# --- the scenes of the fit ---


def test_training_sizes_are_powers_of_two() -> None:
    scene = replace(measured('[medium]\npreset = "cream"\n' + BALL + LIT))
    sizes = [
        references.training_scenes(replace(scene, geometry=Ball(radius)))[0].geometry for radius in (0.9, 1.0, 1.1, 2.0)
    ]
    assert sizes == [Ball(1.0), Ball(1.0), Ball(1.0), Ball(2.0)]
    training_scenes = references.training_scenes(scene)
    assert [training_scene.name for training_scene in training_scenes] == ["ball", "bar", "ball", "bar", "slab"]
    for training_scene in training_scenes:
        assert training_scene.medium == scene.medium
        surface = points(replace(training_scene, size=(16, 16)))
        # each scene has lights behind and in front of its body
        facing = [float((surface.inputs["V"].mean(axis=1) * light.direction).sum()) for light in training_scene.lights]
        assert min(facing) < -0.4 and max(facing) > 0.4
