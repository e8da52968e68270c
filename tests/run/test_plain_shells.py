"""What a material may add to a shell without an engine: on every back end as in NumPy, and nothing unless asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sssgen
from sssgen.cli.main import main
from sssgen.material.library import OF_SHELLS
from sssgen.material.material_loading import load_material, parse_material
from sssgen.material.shell_stages import with_shell
from sssgen.run import backends
from sssgen.run.backends import Array, Backend
from sssgen.run.render.scene_render import render
from sssgen.scene.environment import read_environment
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError, UnsupportedError
from sssgen.support.paths import display_name

FEW = ["gl", "webgpu", "hlsl", "metal"]
MORE = ["gl-es", "browser", "hlsl-glslang"]
DRAWING = [*FEW, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE)]
SIZE = (48, 36)
MATERIAL = """
[material]
name = "wax"

[[thickness]]
technique = "constant_thickness"

[[thickness]]
technique = "beer_lambert"

[[surface]]
technique = "base_color"
tint = [0.8, 0.5, 0.3, 1.0]

[[surface]]
technique = "pbr_constants"
surface_roughness = 0.3

[translucency]
technique = "lobe_normalized"
"""
SCENE = f"""
material = "wax.toml"
size = [{SIZE[0]}, {SIZE[1]}]
samples = 1
ambient = [0.1, 0.12, 0.15]

[camera]
position = [1.0, 1.5, 3.5]
target = [0.0, 0.0, 0.0]
field_of_view = 40.0

[[light]]
direction = [0.6, 0.7, 0.4]
color = [4.0, 3.6, 3.0]

[[light]]
position = [-2.0, 1.0, 1.0]
color = [3.0, 3.0, 4.0]
"""
BALL = '[geometry]\nkind = "ball"\n'


REFERENCES: dict[tuple[str, str], Array] = {}
"""The oracle's pictures of a material and a scene, each drawn once."""


def picture_of(folder: Path, backend: Backend, material: str, scene: str) -> Array:
    """The linear picture."""
    if backend.name == "numpy" and (material, scene) in REFERENCES:
        return REFERENCES[material, scene]
    (folder / "wax.toml").write_text(material, encoding="utf-8")
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    picture = render(load(str(folder / "scene.toml")), backend).linear
    if backend.name == "numpy":
        REFERENCES[material, scene] = picture
    return picture


def drawn(folder: Path, backend: Backend, stages: str, scene: str = BALL) -> Array:
    """The linear picture of the material with more stages."""
    return picture_of(folder, backend, MATERIAL + stages, SCENE + scene)


# Tone mapping

AGX = '[tone_mapping]\ntechnique = "agx"\nexposure = 1.5\n'


def test_tone_mapping_is_applied_to_the_whole_light(tmp_path: Path) -> None:
    numpy = backends.require("numpy")
    plain = drawn(tmp_path, numpy, "")
    assert plain.max() > 2.0
    shown = drawn(tmp_path, numpy, '[tone_mapping]\ntechnique = "reinhard"\n')
    covered = plain.max(axis=-1) > 0.0
    np.testing.assert_allclose(shown[covered], (plain / (1.0 + plain))[covered], atol=1e-9)


# The options of the command line, and errors


def test_an_option_replaces_the_stages_of_its_role() -> None:
    material = parse_material(MATERIAL + AGX, "wax.toml")
    names = [stage.technique.name for stage in with_shell(material, ["tone_mapping=aces"]).stages]
    assert "aces" in names and "agx" not in names
    without = with_shell(material, ["tone_mapping=aces", "tone_mapping=none"])
    bare = parse_material(MATERIAL, "wax.toml")
    assert sssgen.compile(without, "glsl-330").files == sssgen.compile(bare, "glsl-330").files


@pytest.mark.parametrize(
    ("option", "message", "hint"),
    [
        ("tone_maping=aces", "'tone_maping' is no part of a shell", "did you mean 'tone_mapping'?"),
        ("tone_mapping=acse", "unknown technique 'acse' for tone_mapping", "did you mean 'aces'?"),
        ("tone_mapping=srgb", "unknown technique 'srgb' for tone_mapping", ""),
    ],
)
def test_wrong_options(option: str, message: str, hint: str) -> None:
    with pytest.raises(SssgenError) as caught:
        with_shell(load_material("ice"), [option])
    (entry,) = caught.value.diagnostics
    assert entry.message == message and hint in entry.hint


def test_the_command_emits_and_warns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`--target all` leaves the engines out; the same command without the option has other files."""
    (tmp_path / "wax.toml").write_text(MATERIAL, encoding="utf-8")
    command = ["emit", str(tmp_path / "wax.toml"), "-o", str(tmp_path)]
    options = ["--shell", "shadow=shadow_map", "--shell", "tone_mapping=aces"]
    assert main([*command, "-t", "wgsl,metal", *options]) == 0
    assert "evaluate_shadow" in (tmp_path / "wax.wgsl").read_text("utf-8")
    assert "evaluate_tone_mapping" in (tmp_path / "wax.metal").read_text("utf-8")
    assert main([*command, "-t", "wgsl"]) == 0
    assert "evaluate_shadow" not in (tmp_path / "wax.wgsl").read_text("utf-8")
    capsys.readouterr()
    assert main([*command, "-t", "shadertoy", *options]) == 2
    said = capsys.readouterr().err
    assert "Shadertoy does not take a material's [shadow]: its shell cannot carry it" in said
    assert "tone_mapping" not in said


def test_a_wrong_name_in_a_material() -> None:
    with pytest.raises(SssgenError) as caught:
        parse_material(MATERIAL + AGX.replace("agx", "agxx"), "wax.toml")
    (entry,) = caught.value.diagnostics
    assert (entry.message, entry.hint) == ("unknown technique 'agxx'", "did you mean 'agx'?")


def test_engines_have_their_own() -> None:
    """Each target takes all that its descriptor lists, and one clear error names what it does not take."""
    material = parse_material(MATERIAL + AGX, "wax.toml")
    taking = []
    for name, target in sssgen.all_targets().items():
        assert set(target.shell) <= set(OF_SHELLS)
        try:
            sssgen.compile(material, name)
            taking.append(name)
        except UnsupportedError as error:
            (entry,) = error.diagnostics
            assert entry.message == f"{target.title} does not take a material's [tone_mapping]: the engine does this"
            assert entry.hint == "leave it out for this target: --shell tone_mapping=none"
            assert display_name(entry.span.file) == "wax.toml"
    assert {"glsl-330", "glsl-es-300", "hlsl", "wgsl", "metal", "numpy", "shadertoy"} == set(taking)


# A shadow map

SHADOW = '[shadow]\ntechnique = "shadow_map"\n'
BALL_OVER_FLOOR = """
[geometry]
kind = "union"

[[geometry.part]]
kind = "ball"
radius = 0.5
position = [0.0, 0.4, 0.0]

[[geometry.part]]
kind = "box"
size = [3.0, 0.2, 3.0]
position = [0.0, -0.6, 0.0]
"""


def shares(folder: Path, bias: float = 0.02) -> tuple[Array, Array]:
    """The oracle's pictures of the first light without its shadow, and with it; the second light is dark."""
    scene = SCENE.replace("[3.0, 3.0, 4.0]", "[0, 0, 0]").replace("[0.1, 0.12, 0.15]", "[0, 0, 0]") + BALL_OVER_FLOOR
    opaque = MATERIAL.replace(
        'technique = "lobe_normalized"', 'technique = "lobe_normalized"\nscale = 0.0\nambient = 0.0'
    )
    numpy = backends.require("numpy")
    without = picture_of(folder, numpy, opaque, scene)
    return without, picture_of(folder, numpy, f"{opaque}{SHADOW}shadow_bias = {bias}\n", scene)


def test_the_shadow_is_where_the_way_to_the_light_meets_the_body(tmp_path: Path) -> None:
    """Against rays to the light: only pixels at the shadow's edge differ, and no lit surface has spots."""
    without, shadowed = shares(tmp_path)
    (tmp_path / "any.toml").write_text(SCENE.replace("wax.toml", "ice") + BALL_OVER_FLOOR, encoding="utf-8")
    scene = load(str(tmp_path / "any.toml"))
    origin, directions = scene.camera.rays(*SIZE)
    assert scene.geometry is not None and scene.lights[0].direction is not None
    hits = scene.geometry.hits(origin, directions)
    light = np.array(scene.lights[0].direction)
    starts = hits.position + 1e-4 * hits.normal
    blocked = np.array([scene.geometry.hits(start, light[None]).hit[0] for start in starts])
    faces = hits.hit & (hits.normal @ light > 0.05)
    share = np.divide(shadowed, without, out=np.ones_like(without), where=without > 1e-6).max(axis=-1)[::-1].ravel()
    assert (blocked & faces).sum() > 40 and (~blocked & faces).sum() > 300
    wrong = faces & (np.abs(share - np.where(blocked, 0.0, 1.0)) > 0.02)
    assert wrong.sum() < 0.08 * faces.sum()
    # every other pixel is within two texels of the edge: its neighbours differ in whether they are blocked
    seen = blocked.reshape(SIZE[::-1])
    steps = [np.roll(seen, step, axis) != seen for axis in (0, 1) for step in (-1, 1)]
    edge = np.logical_or.reduce(steps).ravel()
    assert not (wrong & ~edge).any()


def test_too_little_bias_causes_spots(tmp_path: Path) -> None:
    _, clear = shares(tmp_path)
    _, shadowed = shares(tmp_path, bias=0.0)
    assert (shadowed < 0.9 * clear).any(axis=-1).sum() > 50


def test_transmitted_light_and_the_second_light_have_no_shadow(tmp_path: Path) -> None:
    numpy = backends.require("numpy")
    without, shadowed = shares(tmp_path)
    with_light = drawn(tmp_path, numpy, SHADOW, BALL_OVER_FLOOR)
    plain = drawn(tmp_path, numpy, "", BALL_OVER_FLOOR)
    np.testing.assert_allclose(plain - with_light, without - shadowed, atol=1e-6)
    assert (without - shadowed).max() > 0.5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            'shading = "unlit"\n[lighting]\ntechnique = "sky_background"\n[shadow]',
            "an unlit material has no lights for [shadow]",
        ),
        (
            '[surface]\ntechnique = "base_color"\n[[shadow]]\ntechnique = "shadow_map"\n[[shadow]]',
            "a second [shadow] stage",
        ),
    ],
)
def test_wrong_shadows(text: str, message: str) -> None:
    with pytest.raises(SssgenError) as caught:
        parse_material(f'[material]\nname = "wax"\n{text}\ntechnique = "shadow_map"\n', "wax.toml")
    assert [entry.message for entry in caught.value.diagnostics] == [message]


# An environment

SKY = '[environment]\ntechnique = "prefiltered_environment"\n'
ENVIRONMENT = '\n[environment]\nfile = "sky.npy"\nintensity = 1.2\n'


def with_sky(folder: Path) -> None:
    """A picture with a warm sky, a dark ground and a bright spot, row 0 at the top once it is read."""
    v, u = np.meshgrid((np.arange(128) + 0.5) / 128, (np.arange(256) + 0.5) / 256, indexing="ij")
    sky = np.stack([1.2 - v, 1.0 - v + 0.2 * u, 0.6 + 0.0 * v], axis=-1) * np.where(v > 0.5, 0.2, 1.0)[..., None]
    sky += 6.0 * np.exp(-80.0 * ((v - 0.3) ** 2 + (u - 0.7) ** 2))[..., None]
    np.save(folder / "sky.npy", np.flipud(sky).astype(np.float32))


def test_a_polished_metal_shows_the_surroundings(tmp_path: Path) -> None:
    """Against the picture itself, at the mirrored directions of the pixels of a ball."""
    with_sky(tmp_path)
    dark = SCENE.replace("[4.0, 3.6, 3.0]", "[0, 0, 0]").replace("[3.0, 3.0, 4.0]", "[0, 0, 0]")
    dark = dark.replace("[0.1, 0.12, 0.15]", "[0, 0, 0]") + BALL + ENVIRONMENT
    head = '[material]\nname = "wax"\n[[surface]]\ntechnique = "base_color"\n[[surface]]\ntechnique = "pbr_constants"\n'
    metal = f"{head}metalness = 1.0\nsurface_roughness = 0.0\n{SKY}"
    shown = picture_of(tmp_path, backends.require("numpy"), metal, dark)[::-1].reshape(-1, 3)
    (tmp_path / "any.toml").write_text(dark.replace("wax.toml", "ice"), encoding="utf-8")
    scene = load(str(tmp_path / "any.toml"))
    environment = read_environment(scene)
    assert environment is not None and scene.geometry is not None
    origin, directions = scene.camera.rays(*SIZE)
    hits = scene.geometry.hits(origin, directions)
    along = (directions * hits.normal).sum(axis=1, keepdims=True)
    expected = environment.sky()(directions - 2.0 * along * hits.normal)
    inside = hits.hit & (along[:, 0] < -0.3)
    difference = np.abs(shown - expected)[inside]
    assert np.median(difference) < 0.01 and np.ptp(expected[inside]) > 2.0
    assert (difference.max(axis=1) > 0.1).mean() < 0.05  # at the picture's horizon


def test_without_surroundings_it_adds_nothing(tmp_path: Path) -> None:
    numpy = backends.require("numpy")
    np.testing.assert_array_equal(drawn(tmp_path, numpy, SKY), drawn(tmp_path, numpy, ""))


# Everything together


ALL = AGX + SHADOW + SKY
LIT_SCENE = BALL_OVER_FLOOR + ENVIRONMENT


@pytest.fixture(scope="module")
def lit_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder for all back ends, so that the surroundings are prefiltered once."""
    folder = tmp_path_factory.mktemp("lit")
    with_sky(folder)
    return folder


@pytest.mark.parametrize("name", DRAWING)
def test_every_back_end_draws_all_of_it(name: str, backend: Callable[[str], Backend], lit_folder: Path) -> None:
    expected = drawn(lit_folder, backends.require("numpy"), ALL, LIT_SCENE)
    beyond = np.abs(drawn(lit_folder, backend(name), ALL, LIT_SCENE) - expected).max(axis=-1) > 1.0 / 255.0
    assert beyond.mean() < 0.005  # at the shadow's edge, where rounding decides which texels are compared
