"""The renderer feature that draws a material's passes in URP, run on stand-ins of Unity's objects (`unity_frames`)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sssgen
from slow_cases import some_slow
from sssgen.ir.frame_passes import BACK_FACES, EYE_LAYERS, FAR
from sssgen.run.backends import Array, Backend
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.scene.bounds import world_corners
from sssgen.scene.camera import Camera
from sssgen.scene.drawn_views import TEXELS, TILES, brightest, eye_layers, light_depth, light_layers
from sssgen.scene.geometry import Torus
from torus_cases import torus_mesh
from unity_frames import (
    VERSIONS,
    Frame,
    Lamp,
    Replay,
    compile_feature,
    mirrored,
    passes_of,
    run_feature,
    runtime_of,
    texture_numbers,
)

TORUS = Torus(major=0.78, minor=0.3)
BOX = (np.array([-1.08, -0.3, -1.08]), np.array([1.08, 0.3, 1.08]))
CAMERA = Camera(position=(0.3, 1.9, 3.4))
LOW = Camera(position=(0.3, 0.4, 3.9))
"""Its rays meet the near and the far side of the ring."""
SIZE = (96, 72)
LAYERS = ("entry 1", "exit 1", "entry 2", "exit 2")
SUN = Lamp("Directional", towards=(-0.7, 0.1, -0.7))
NEAR = Lamp("Point", place=(1.9, 0.5, -1.4), color=(4.0, 2.0, 1.0))
LAMPS = (
    SUN._replace(color=(0.02, 0.01, 0.0)),
    NEAR,
    Lamp("Spot", place=(-3.0, 0.4, 2.0), towards=(3.0, -0.4, -2.0), color=(3.0, 0.0, 9.0)),
    Lamp("Directional", towards=(0.5, -0.2, 0.66), color=(0.2, 0.3, 0.6)),
    Lamp("Point", place=(0.4, 3.0, -1.0), color=(1.0, 1.0, 1.0)),
)
"""Five lights. z is never the least part of their ways: a mirrored view would stand on its head there."""
MATERIALS = {"one light": "depth_map_path", "several lights": "light_layers_path"}


@pytest.fixture(scope="module", params=some_slow(["URP 12", "URP 17"], "URP 17"))
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compile_feature(request.param, tmp_path_factory.mktemp("feature"))


@pytest.fixture(scope="module")
def shaders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The emitted shader of jade_ring, with a map for one light or for several."""
    folder, texts = tmp_path_factory.mktemp("shaders"), {}
    example = Path(sssgen.__file__).parents[2] / "examples/jade_ring/jade_ring.toml"
    for case, technique in MATERIALS.items():
        material = folder / f"{technique}.toml"
        material.write_text(example.read_text(encoding="utf-8").replace("depth_map_path", technique), encoding="utf-8")
        files = sssgen.compile(str(material), "unity-urp").files
        (texts[case],) = (text for name, text in files.items() if name.endswith(".shader"))
    return texts


def frame_of(
    program: Path,
    shader: str,
    lamps: tuple[Lamp, ...] = LAMPS,
    given: str = "",
    bodies: int = 1,
    camera: Camera = CAMERA,
) -> Frame:
    eye = np.array(camera.position), camera.view_projection(SIZE[0] / SIZE[1])
    return run_feature(program, shader, [BOX] * bodies, lamps, eye, SIZE, given)


def light_of(lamp: Lamp) -> Array:
    """(4,): as the scene's lights."""
    if lamp.kind == "Directional":
        return np.append(np.array(lamp.towards) / np.linalg.norm(lamp.towards), 0.0)
    return np.append(lamp.place, 1.0)


def four_brightest(lamps: tuple[Lamp, ...]) -> Array:
    lights = np.array([light_of(lamp) for lamp in lamps])
    return lights[brightest(world_corners(TORUS).mean(axis=0), lights, np.array([lamp.color for lamp in lamps]))]


@pytest.mark.parametrize("version", VERSIONS)
def test_every_version_compiles_the_feature(version: str, tmp_path: Path) -> None:
    assert compile_feature(version, tmp_path).is_file()


def test_the_feature_is_written_for_materials_with_passes_alone() -> None:
    compiled = sssgen.compile("jade_ring", "unity-urp")
    listed = [file["name"] for file in compiled.reflection["files"]]
    assert listed == ["jade_ring.unity-urp.shader", "SssgenPasses.cs"]
    assert compiled.files["SssgenPasses.cs"] == runtime_of("SssgenPasses.cs")
    assert "SssgenPasses.cs" not in sssgen.compile("ice", "unity-urp").files


def test_the_passes_say_what_they_draw(shaders: dict[str, str]) -> None:
    rows = [tags for _, tags in passes_of(shaders["several lights"]) if tags["LightMode"] == "SssgenLayer"]
    assert [row["SssgenPass"] for row in rows] == ["back_faces", *["light_layers"] * 4]
    assert [row["SssgenSeenFrom"] for row in rows] == ["eye", *["each light"] * 4]
    assert rows[1]["SssgenViews"].split() == ["_LightMatrix", "_LightMatrix2", "_LightMatrix3", "_LightMatrix4"]
    assert {row["SssgenTexture"] for row in rows[1:]} == {"_LightLayerMap"}
    for row in rows:
        assert row["SssgenTexture"] + " (" in shaders["several lights"]  # a property


def test_the_views_of_the_brightest_lights(program: Path, shaders: dict[str, str]) -> None:
    frame = frame_of(program, shaders["several lights"])
    expected, _ = light_layers(TORUS, four_brightest(LAMPS), LAYERS)
    for name, matrix in zip(("", "2", "3", "4"), expected, strict=True):
        np.testing.assert_allclose(frame.matrix(f"_LightMatrix{name}"), matrix, atol=2e-5)


@pytest.mark.parametrize(("lamps", "first"), [((NEAR, SUN), SUN), ((NEAR,), None), ((), None)])
def test_the_view_of_a_distant_light(
    lamps: tuple[Lamp, ...], first: Lamp | None, program: Path, shaders: dict[str, str]
) -> None:
    """A directional light before a brighter lamp; a lamp alone as if it were far away; zeros without any."""
    frame = frame_of(program, shaders["one light"], lamps)
    afar = light_of(first) if first else np.append(np.array(NEAR.place) / np.linalg.norm(NEAR.place), 0.0)
    expected = light_depth(TORUS, afar)[0].matrix if lamps else np.zeros((4, 4))
    np.testing.assert_allclose(frame.matrix("_LightMatrix"), expected, atol=2e-5)


def test_lights_that_do_not_reach_the_body(program: Path, shaders: dict[str, str]) -> None:
    """A spot light that looks away, a lamp beyond its range, a light of an area and one of no colour have no view."""
    beside = (
        Lamp("Spot", place=(-3.0, 0.4, 2.0), towards=(-3.0, -0.4, -2.0)),
        NEAR._replace(reach=1.0),
        NEAR._replace(kind="Rectangle"),
        SUN._replace(color=(0.0, 0.0, 0.0)),
    )
    frame = frame_of(program, shaders["several lights"], (*beside, NEAR))
    expected, _ = light_layers(TORUS, light_of(NEAR)[None], LAYERS)
    np.testing.assert_allclose(frame.matrix("_LightMatrix"), expected[0], atol=2e-5)
    assert not frame.matrix("_LightMatrix2").any()


def test_a_lamp_in_the_box_has_a_view(program: Path, shaders: dict[str, str]) -> None:
    frame = frame_of(program, shaders["several lights"], (Lamp("Point", place=(0.1, 0.02, 0.2)),))
    assert np.isfinite(frame.matrix("_LightMatrix")).all() and frame.matrix("_LightMatrix").any()


def test_a_texture_of_the_material_is_not_drawn(program: Path, shaders: dict[str, str]) -> None:
    frame = frame_of(program, shaders["one light"], given="_BackFaceMap")
    assert list(texture_numbers(frame.values[0])) == ["_LightDepthMap"]
    assert sum(row[0] == "target" for row in frame.commands) == 1


def test_textures_are_given_back(program: Path, shaders: dict[str, str]) -> None:
    assert frame_of(program, shaders["several lights"], bodies=2).lent == 0


def test_bodies_share_what_the_eye_sees(program: Path, shaders: dict[str, str]) -> None:
    """It is cleared once; each body has its own picture of what the lights see."""
    frame = frame_of(program, shaders["several lights"], bodies=2)
    first, second = map(texture_numbers, frame.values)
    assert first["_BackFaceMap"] == second["_BackFaceMap"]
    assert first["_LightLayerMap"] != second["_LightLayerMap"]
    targets = [row[1].split()[0] for row in frame.commands if row[0] == "target"]
    assert sorted(map(targets.count, {*first.values(), *second.values()})) == [1, 4, 4]


@pytest.mark.parametrize("case", MATERIALS)
def test_the_pictures_are_those_of_the_oracle(
    case: str, program: Path, shaders: dict[str, str], backend: Callable[[str], Backend]
) -> None:
    """The feature's commands with the emitted passes draw what `scene/drawn_views.py` casts."""
    machine = backend("unity-urp")
    assert isinstance(machine, UnityHLSL)
    lamps = LAMPS if case == "several lights" else (SUN,)
    frame = frame_of(program, shaders[case], lamps)
    mesh = mirrored(torus_mesh(TORUS, 384, 192))
    pictures = Replay(machine, shaders[case]).pictures_of(frame, mesh)
    drawn = {name: pictures[number] for name, number in texture_numbers(frame.values[0]).items()}
    seen = eye_layers(TORUS, *CAMERA.rays(*SIZE), BACK_FACES).reshape(SIZE[1], SIZE[0])
    assert_same(drawn["_BackFaceMap"][..., 0], seen, "the eye")
    if case == "several lights":
        _, expected = light_layers(TORUS, four_brightest(LAMPS), LAYERS)
        assert (expected[:TEXELS, :TEXELS] < expected[0, 0]).mean(axis=(0, 1)).min() > 0.01  # all layers have surfaces
        for tile in range(TILES * TILES):
            rows, columns = (slice(TEXELS * at, TEXELS * (at + 1)) for at in divmod(tile, TILES))
            for channel, layer in enumerate(LAYERS):
                shown = drawn["_LightLayerMap"][rows, columns, channel]
                assert_same(shown, expected[rows, columns, channel], f"light {tile}, {layer}")
    else:
        depth = light_depth(TORUS, light_of(SUN))[1][..., 0]
        every_second = drawn["_LightDepthMap"][..., 0].reshape(TEXELS, TILES, TEXELS, TILES).mean(axis=(1, 3))
        assert_same(every_second, depth, "distant light")


def test_what_lies_behind_the_first_exit(program: Path, tmp_path: Path, backend: Callable[[str], Backend]) -> None:
    """First exit, second entrance and second exit as the eye sees them. Two bodies do not share this picture."""
    machine = backend("unity-urp")
    assert isinstance(machine, UnityHLSL)
    material = '[material]\nname = "wax"\n[translucency]\ntechnique = "fluence_fixed_layers"\n'
    (tmp_path / "wax.toml").write_text(material, encoding="utf-8")
    files = sssgen.compile(str(tmp_path / "wax.toml"), "unity-urp").files
    (shader,) = (text for name, text in files.items() if name.endswith(".shader"))
    frame = frame_of(program, shader, (), bodies=2, camera=LOW)
    first, second = (texture_numbers(values)["_EyeLayerMap"] for values in frame.values)
    assert first != second
    picture = Replay(machine, shader).pictures_of(frame, mirrored(torus_mesh(TORUS, 384, 192)))[first]
    expected = eye_layers(TORUS, *LOW.rays(*SIZE), EYE_LAYERS).reshape(SIZE[1], SIZE[0], 3)
    assert (expected[..., 2] < FAR).sum() > 200
    for channel in range(3):
        assert_same(picture[..., channel], expected[..., channel], f"layer {channel}")


def assert_same(drawn: Array, expected: Array, name: str) -> None:
    """Equal distances, but for edges, where triangles replace the round body, and texels without a surface."""
    far = float(expected.max())
    difference = np.abs(np.minimum(drawn, far) - expected)
    share = float((difference > 2e-3).mean())
    print(f"{name}: {100 * share:.2f} % of the texels differ")
    assert share < 0.005


BAKED = """
[material]
name = "ear"
[[surface]]
technique = "base_color"
[[thickness]]
technique = "view_thickness_map"
[translucency]
technique = "interior_octaves"
bind = { light_path = "depth_map_path" }
"""


def test_a_texture_that_is_missing_is_a_warning(program: Path, tmp_path: Path) -> None:
    """Once for each material, with the command that bakes it; not where the material has the texture."""
    (tmp_path / "ear.toml").write_text(BAKED, encoding="utf-8")
    compiled = sssgen.compile(str(tmp_path / "ear.toml"), "unity-urp")
    needed = {t["name"]: t["needed"] for t in compiled.reflection["textures"] if t["needed"]}
    assert len(needed) == 3 and all("sssgen bake" in text for text in needed.values())
    shader = compiled.files["ear.unity-urp.shader"]
    frame = frame_of(program, shader, bodies=2)
    own = [f"{name} is missing: {text}" for name, text in needed.items()]
    assert [warning.partition(": ")[2] for warning in frame.warnings] == own * 2
    assert len({warning.partition(": ")[0] for warning in frame.warnings}) == 2
    given = frame_of(program, shader, given=next(iter(needed)))
    assert [warning.partition(": ")[2] for warning in given.warnings] == own[1:]


def test_a_shader_without_baked_textures_warns_of_nothing(program: Path, shaders: dict[str, str]) -> None:
    assert "SssgenNeeds" not in shaders["one light"]
    assert not frame_of(program, shaders["one light"]).warnings
