"""Levels of detail in a material: what is read, which errors there are, and what the levels share."""

from __future__ import annotations

from pathlib import Path

import pytest

import sssgen
from sssgen.material.material_loading import load_material, parse_material
from sssgen.support.diagnostics import SssgenError

HEAD = '[material]\nname = "wax"\nlevels = 2\n'
BY_LIGHT = '[[thickness]]\ntechnique = "march_light"\nbind = { body_distance = "sphere" }\nlevel = 0\n'
ALIKE = '[[thickness]]\ntechnique = "constant_thickness"\nlevel = 1\n'
LIGHT = '[[thickness]]\ntechnique = "beer_lambert"\n[[translucency]]\ntechnique = "lobe_normalized"\n'


def emitted(text: str, folder: Path, target: str = "glsl-330") -> str:
    (folder / "wax.toml").write_text(text)
    return sssgen.compile(folder / "wax.toml", target).files["wax.glsl-330.frag"]


def function(text: str, name: str) -> str:
    return text[text.index(f" {name}(") :].partition("\n}")[0]


def test_what_depends_on_a_light_is_decided_for_each_level(tmp_path: Path) -> None:
    """The stages that both levels have run once per light in the first one, and once in the second one."""
    text = emitted(HEAD + BY_LIGHT + ALIKE + LIGHT, tmp_path)
    assert "uniform int detail_level;" in text
    surface, light = function(text, "evaluate_surface"), function(text, "evaluate_translucency")
    assert "march_light(" not in surface and surface.count("beer_lambert(") == 1
    first, second = light.split("if (detail_level < 1) {")[1].split("\n    }")
    assert "march_light(" in first and "beer_lambert(" in first
    assert "surface.transmittance" in second and "beer_lambert(" not in second
    # what both have is not written twice
    assert "if (" not in function(text, "evaluate_lighting")


def test_equal_levels_have_no_branch(tmp_path: Path) -> None:
    text = emitted(HEAD.replace("2", "3") + ALIKE.replace("level = 1", "level = [2, 0, 1]") + LIGHT, tmp_path)
    assert "if (detail_level" not in text


def test_a_level_without_light_is_dark(tmp_path: Path) -> None:
    lobe = '[[translucency]]\ntechnique = "wrap_lighting"\nlevel = 0\n'
    light = function(emitted(HEAD + lobe, tmp_path), "evaluate_translucency")
    assert "return wrap_lighting(" in light and light.endswith("return vec3(0.0);")


def test_levels_share_textures_but_no_numbers(tmp_path: Path) -> None:
    volumes = "".join(
        f'[[translucency]]\ntechnique = "{name}"\nmean_free_path = {length}\nlevel = {level}\n'
        for level, (name, length) in enumerate([("fluence_relit", 0.2), ("fluence_relit_once", 0.3)])
    )
    text = '[[thickness]]\ntechnique = "back_face_thickness"\nlevel = 1\n' + volumes
    (tmp_path / "wax.toml").write_text(HEAD + text)
    reflection = sssgen.compile(tmp_path / "wax.toml", "glsl-330").reflection
    lengths = [one["default"] for one in reflection["uniforms"] if one["name"].endswith("mean_free_path")]
    assert sorted(lengths) == [[0.2], [0.3]]
    textures = [texture["name"] for texture in reflection["textures"]]
    assert textures.count("inner_light") == 1 and len(set(textures)) == len(textures)
    assert [drawn["name"] for drawn in reflection["passes"]].count("inner_light") == 1


@pytest.mark.parametrize(("files", "count"), [(("a.png", "a.png"), 1), (("a.png", "b.png"), 2)])
def test_levels_share_a_texture_if_its_file_is_the_same(files: tuple[str, str], count: int, tmp_path: Path) -> None:
    stages = "".join(
        f'[[surface]]\ntechnique = "metallic_roughness_map"\nmetallic_roughness_texture = "{file}"\nlevel = {level}\n'
        for level, file in enumerate(files)
    )
    assert emitted(HEAD + stages, tmp_path).count("uniform sampler2D ") == count


def test_levels_have_one_file_for_a_volume_that_a_pass_draws(tmp_path: Path) -> None:
    """The volume of the light inside is drawn once, from one file."""
    stages = "".join(
        f'[[translucency]]\ntechnique = "fluence_relit"\ninner_light = "{file}"\nlevel = {level}\n'
        for level, file in enumerate(("a.bin", "b.bin"))
    )
    (tmp_path / "wax.toml").write_text(HEAD + stages)
    with pytest.raises(SssgenError, match="'inner_light' has another value in 'fluence_relit', line 6"):
        load_material(tmp_path / "wax.toml")


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        (HEAD.replace("2", "0") + ALIKE + LIGHT, "'levels' takes a number of levels of detail, 1 to 8", "write levels"),
        (HEAD.replace("2", "true") + ALIKE + LIGHT, "'levels' takes a number", "write levels = 2"),
        (
            HEAD + ALIKE.replace("1", "2") + LIGHT,
            "'level' is 2, but the levels are 0 to 1",
            "write levels = 3 in",
        ),
        (HEAD + ALIKE.replace("1", "-1") + LIGHT, "'level' is -1, but", "levels are 0 to 7"),
        (HEAD.replace("2", "1") + ALIKE + LIGHT, "'level' is 1, but the material has one level", "write levels = 2"),
        (HEAD + ALIKE.replace("1", '"far"') + LIGHT, "'level' takes the number of a level", "write level = 0, or"),
        (HEAD + ALIKE.replace("1", "[]") + LIGHT, "'level' takes the number of a level", "write level = 0, or"),
        (HEAD + LIGHT + '[shadow]\ntechnique = "shadow_map"\nlevel = 0\n', "a [shadow] stage belongs to all", "omit"),
        (HEAD + BY_LIGHT + LIGHT, "'beer_lambert' takes a thickness, which no stage before it gives", "add a [thick"),
    ],
)
def test_errors(text: str, message: str, hint: str) -> None:
    with pytest.raises(SssgenError) as raised:
        parse_material(text, "wax.toml")
    texts = [(error.message, error.hint) for error in raised.value.diagnostics]
    assert any(message in found and hint in more for found, more in texts), texts
    assert len(set(texts)) == len(texts)


@pytest.mark.parametrize(("first", "second"), [("level = 0", "level = 1"), ('uv = "uv"', 'uv = "uv2"')])
def test_a_changed_line_is_another_program(first: str, second: str, tmp_path: Path) -> None:
    """No value of a uniform changes, and no place: the cached program must not be used."""
    stage = '[[surface]]\ntechnique = "base_color"\n'
    texts = [emitted(HEAD + stage + line + "\n", tmp_path) for line in (first, second)]
    assert texts[0] != texts[1]
