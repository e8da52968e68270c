"""What a material may add to a shell without an engine: on every back end as in NumPy, and nothing unless asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import sssgen
from sssgen.harness import backends
from sssgen.harness.backends import Array, Backend
from sssgen.harness.render.scene_render import render
from sssgen.harness.scenes.scene_loading import load
from sssgen.material.library import OF_SHELLS
from sssgen.material.material_loading import load_material, parse_material
from sssgen.material.shell_stages import with_shell
from sssgen.support.diagnostics import SssgenError, UnsupportedError

DRAWING = ["gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "metal"]
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


def drawn(folder: Path, backend: Backend, stages: str, scene: str = BALL) -> Array:
    """The linear picture of the material with more stages."""
    (folder / "wax.toml").write_text(MATERIAL + stages, encoding="utf-8")
    (folder / "scene.toml").write_text(SCENE + scene, encoding="utf-8")
    return render(load(str(folder / "scene.toml")), backend).linear


# Tone mapping

AGX = '[tone_mapping]\ntechnique = "agx"\nexposure = 1.5\n'


def test_tone_mapping_is_applied_to_the_whole_light(tmp_path: Path) -> None:
    numpy = backends.needed("numpy")
    plain = drawn(tmp_path, numpy, "")
    assert plain.max() > 2.0
    shown = drawn(tmp_path, numpy, '[tone_mapping]\ntechnique = "reinhard"\n')
    covered = plain.max(axis=-1) > 0.0
    np.testing.assert_allclose(shown[covered], (plain / (1.0 + plain))[covered], atol=1e-9)


@pytest.mark.parametrize("name", DRAWING)
def test_every_back_end_maps_tones(name: str, backend: Callable[[str], Backend], tmp_path: Path) -> None:
    expected = drawn(tmp_path, backends.needed("numpy"), AGX)
    assert np.abs(drawn(tmp_path, backend(name), AGX) - expected).max() < 1.0 / 255.0


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
            assert entry.span.file == "wax.toml"
    assert {"glsl-330", "glsl-es-300", "hlsl", "wgsl", "metal", "numpy", "shadertoy"} == set(taking)
