"""Parameters that are changed on the page, in the TOML file: comments and order stay."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.preview.pane import Pane
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("tomlkit")
pytest.importorskip("igl")

TEXT = """# A plain stone.
[material]
name = "stone"   # its name
shading = "lit"

[thickness]
technique = "constant_thickness"
thickness_factor = 0.25  # metres

[translucency]
technique = "absorption_tint"

[[surface]]
technique = "base_color"
tint = [0.1, 0.2, 0.3, 1.0]

[[surface]]
technique = "pbr_constants"
surface_roughness = { value = 0.5, fixed = false }
"""


@pytest.fixture
def stone(tmp_path: Path) -> Path:
    path = tmp_path / "stone.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_comments_and_order_stay(stone: Path) -> None:
    shown = Pane(str(stone))
    shown.save(
        {"thicknessFactor": [0.4], "tint": [0.1, 0.25, 0.3, 1.0], "surfaceRoughness": [0.7], "sssMetalness": [1.0]}
    )
    expected = TEXT.replace("= 0.25", "= 0.4").replace("0.2, 0.3", "0.25, 0.3").replace("value = 0.5", "value = 0.7")
    assert stone.read_text(encoding="utf-8") == f"{expected}metalness = 1.0\n"
    shown.renew()
    values = {control["property"]: control["value"] for control in shown.picture.head["controls"]}
    assert (values["thicknessFactor"], values["sssMetalness"], values["surfaceRoughness"]) == ([0.4], [1.0], [0.7])


def test_numbers_are_the_shortest_of_float32(stone: Path) -> None:
    Pane(str(stone)).save({"thicknessFactor": [0.1 + 0.2]})
    assert "thickness_factor = 0.3  # metres" in stone.read_text(encoding="utf-8")


def test_the_level_of_detail_is_shown_and_not_saved(stone: Path) -> None:
    """The engine sets it."""
    text = TEXT.replace('shading = "lit"', "levels = 2") + "level = 0\n"
    stone.write_text(text, encoding="utf-8")
    shown = Pane(str(stone))
    (control,) = [one for one in shown.picture.head["controls"] if one["property"] == "detailLevel"]
    assert control["range"] == [0.0, 1.0]
    assert shown.save({"detailLevel": [1.0]}) == "" and stone.read_text(encoding="utf-8") == text


def test_a_level_of_detail_keeps_its_own_value(stone: Path) -> None:
    """Two stages of a technique have different values; a third one sets none, which is the default."""
    near, far, plain = ('[[surface]]\ntechnique = "base_color"\n' + end for end in (
        "tint = [0.1, 0.2, 0.3, 1.0]\nlevel = 0\n", "tint = [0.5, 0.2, 0.3, 1.0]\nlevel = 1\n", "level = 2\n"
    ))  # fmt: skip
    text = '[material]\nname = "stone"\nlevels = 3\n\n' + near + far + plain
    stone.write_text(text, encoding="utf-8")
    shown = Pane(str(stone))
    tints = [control for control in shown.picture.head["controls"] if control["name"] == "tint"]
    far_property, plain_property = (
        next(control["property"] for control in tints if np.allclose(control["default"], value))
        for value in ([0.5, 0.2, 0.3, 1.0], [1.0, 1.0, 1.0, 1.0])
    )
    shown.save({far_property: [0.6, 0.2, 0.3, 1.0], plain_property: [0.8, 0.8, 0.8, 1.0]})
    expected = text.replace("0.5, 0.2", "0.6, 0.2") + "tint = [0.8, 0.8, 0.8, 1.0]\n"
    assert stone.read_text(encoding="utf-8") == expected


def test_a_value_of_the_scene_is_saved_in_the_scene(stone: Path) -> None:
    scene = stone.with_name("scene.toml")
    scene.write_text(
        'material = "stone.toml"\n[geometry]\nkind = "ball"\n[parameters]\n# dull\nsurface_roughness = 0.7\n',
        encoding="utf-8",
    )
    shown = Pane(str(scene))
    assert shown.picture.head["saved_in"] == f"Save writes {stone}, and {scene} for what the scene sets."
    assert shown.save({"surfaceRoughness": [0.9]}) == f"Saved: surface_roughness in {scene}."
    assert scene.read_text(encoding="utf-8").endswith("# dull\nsurface_roughness = 0.9\n")
    assert stone.read_text(encoding="utf-8") == TEXT


@pytest.mark.parametrize("values", [{"nothing": [1.0]}, {"tint": [1.0]}, {"thicknessFactor": []}])
def test_what_the_material_does_not_have_is_refused(stone: Path, values: dict[str, list[float]]) -> None:
    with pytest.raises(SssgenError, match="has no parameter"):
        Pane(str(stone)).save(values)
    assert stone.read_text(encoding="utf-8") == TEXT


def test_the_last_good_picture_stays_beside_errors(stone: Path) -> None:
    shown = Pane(str(stone))
    module, version = shown.picture.head["module"], shown.version
    for broken in (TEXT[:60], TEXT.replace("base_color", "base_colour"), TEXT.replace("0.25", '"thick"'), "\udcff"):
        stone.write_bytes(broken.encode("utf-8", "surrogateescape"))
        shown.renew()
        assert shown.error.startswith("error: ") and shown.picture.head["module"] == module, broken
    stone.unlink()
    shown.renew()
    assert shown.error and shown.version == version and str(stone) in shown.files
    stone.write_text(TEXT, encoding="utf-8")
    shown.renew()
    assert not shown.error and shown.version == version + 1


WAX = """[material]
name = "wax"

[[thickness]]
technique = "back_face_thickness"

[translucency]
technique = "interior_octaves"
bind = { light_path = "depth_map_path" }
color = [0.8, 0.5, 0.2]  # warm
extinction = [5.0, 6.0, 7.0]
"""


@pytest.fixture
def wax(tmp_path: Path) -> Path:
    path = tmp_path / "wax.toml"
    path.write_text(WAX, encoding="utf-8")
    return path


def values_of(shown: Pane) -> dict[str, list[float]]:
    return {control["name"]: control["value"] for control in shown.picture.head["controls"]}


def test_the_look_of_a_medium_is_saved_in_its_own_words(wax: Path) -> None:
    shown = Pane(str(wax))
    assert {control["name"]: control["look"] for control in shown.picture.head["controls"] if control["look"]} == {
        "extinction": "depth", "scattering_albedo": "color", "mean_free_path": "depth",
    }  # fmt: skip
    numbers = {"scatteringAlbedo": [0.9, 0.8, 0.7], "extinction": [2.0, 4.0, 10.0], "meanFreePath": [0.1875]}
    look = {"scatteringAlbedo": [0.7, 0.5, 0.2], "extinction": [0.5, 0.25, 0.1], "meanFreePath": [0.5, 0.25, 0.1]}
    said = shown.save(numbers, look)
    assert said == f"Saved: color, depth in {wax}."
    expected = WAX.replace("[0.8, 0.5", "[0.7, 0.5").replace("extinction = [5.0, 6.0, 7.0]", "depth = [0.5, 0.25, 0.1]")
    assert wax.read_text(encoding="utf-8") == expected
    shown.renew()
    assert not shown.error and values_of(shown)["mean_free_path"] == pytest.approx([0.1875])


def test_a_parameter_of_the_medium_takes_the_line_of_the_look(wax: Path) -> None:
    """The mean free path that followed from the depth stays as it was."""
    text = WAX.replace("extinction = [5.0, 6.0, 7.0]", "depth = [0.5, 0.25, 0.1]")
    wax.write_text(text, encoding="utf-8")
    shown = Pane(str(wax))
    path = values_of(shown)["mean_free_path"]
    shown.save({"extinction": [3.0, 4.0, 5.0], "scatteringAlbedo": [0.9, 0.8, 0.7]})
    expected = text.replace("depth = [0.5, 0.25, 0.1]", "extinction = [3.0, 4.0, 5.0]\nmean_free_path = 0.1875")
    assert wax.read_text(encoding="utf-8") == expected.replace(
        "color = [0.8, 0.5, 0.2]", "scattering_albedo = [0.9, 0.8, 0.7]"
    )
    shown.renew()
    assert not shown.error and values_of(shown)["mean_free_path"] == path


def test_a_conversion_is_saved_in_its_section(stone: Path) -> None:
    text = TEXT.replace("[thickness]", "[[thickness]]").replace(
        "# metres\n", '# metres\n\n[[thickness]]\ntechnique = "beer_lambert"\nattenuation_distance = 0.5\n'
    ).replace("absorption_tint", "lobe_normalized")  # fmt: skip
    stone.write_text(text, encoding="utf-8")
    Pane(str(stone)).save({"sssAttenuationDistance": [0.25]})
    assert stone.read_text(encoding="utf-8") == text.replace("distance = 0.5", "distance = 0.25")


def test_channels_are_named_by_what_they_are(wax: Path) -> None:
    controls = {control["name"]: control["channels"] for control in Pane(str(wax)).picture.head["controls"]}
    assert controls["extinction"] == controls["scattering_albedo"] == "RGB"
    assert (controls["octaves"], controls["mean_free_path"]) == ("1234", "")
