"""Edits of a material's text: stages come, go and change; comments and all other lines stay."""

from __future__ import annotations

import pytest

from sssgen.material.material_text import MaterialSection
from sssgen.preview.stage_edits import ChainText
from sssgen.support.diagnostics import SssgenError

TEXT = """# A plain stone.
[material]
name = "stone"   # its name

# how thick
[thickness]
technique = "constant_thickness"  # the same everywhere
thickness_factor = 0.25  # metres

[translucency]
technique = "absorption_tint"
attenuation_color = [
    0.9, 0.5,
    0.2,
]
weight = 0.7

# the colour
[[surface]]
technique = "base_color"
tint = [0.1, 0.2, 0.3, 1.0]

# bumps
[[surface]]
technique = "normal_map"
"""


def chain(text: str = TEXT) -> ChainText:
    return ChainText(text, "stone.toml")


def test_a_stage_follows_the_last_one_of_its_section() -> None:
    text = chain().with_stage(MaterialSection("thickness", "beer_lambert"))
    expected = TEXT.replace("[thickness]", "[[thickness]]").replace(
        "# metres\n", '# metres\n\n[[thickness]]\ntechnique = "beer_lambert"\n'
    )
    assert text == expected


def test_a_stage_of_a_new_section_follows_those_that_run_before_it() -> None:
    text = chain().with_stage(MaterialSection("coordinates", "uv_transform"))
    expected = TEXT.replace("# its name\n", '# its name\n\n[[coordinates]]\ntechnique = "uv_transform"\n')
    assert text == expected
    assert chain().with_stage(MaterialSection("output", "srgb")).endswith('\n\n[[output]]\ntechnique = "srgb"\n')


def test_a_stage_goes_with_the_comments_above_it() -> None:
    assert chain().without_stage(("surface", 0)) == TEXT.replace(
        '# the colour\n[[surface]]\ntechnique = "base_color"\ntint = [0.1, 0.2, 0.3, 1.0]\n\n', ""
    )
    assert chain().without_stage(("surface", 1)) == TEXT[: TEXT.index("\n# bumps")]


def test_another_technique_keeps_the_keys_that_it_takes() -> None:
    stage = MaterialSection("translucency", "lobe_exp2")
    text = chain().with_technique(("translucency",), stage, {"weight"})
    start, end = TEXT.index("attenuation_color"), TEXT.index("weight")
    assert text == (TEXT[:start] + TEXT[end:]).replace("absorption_tint", "lobe_exp2")
    text = chain().with_technique(("thickness",), MaterialSection("thickness", "thickness_map"), {"thickness_factor"})
    assert text == TEXT.replace('"constant_thickness"', '"thickness_map"')


def test_a_bound_table_goes_with_the_technique() -> None:
    text = TEXT.replace("weight = 0.7\n", 'weight = 0.7\n[translucency.bind]\nlight_path = "march_light"\n')
    stage = MaterialSection("translucency", "interior_sample", bind=(("light_path", "depth_map_path"),))
    edited = chain(text).with_technique(("translucency",), stage, {"weight"})
    assert (
        'technique = "interior_sample"\nbind = { light_path = "depth_map_path" }\nweight = 0.7\n\n# the colour'
        in edited
    )
    assert chain(text).given_bindings() == {"light_path": "march_light"}


def test_a_chain_replaces_the_stages_and_keeps_other_surfaces() -> None:
    stages = [
        MaterialSection("thickness", "back_face_thickness"),
        MaterialSection("translucency", "wrap_lighting", (("wrap", 0.5),)),
        MaterialSection("surface", "base_color"),
    ]
    expected = """# A plain stone.
[material]
name = "stone"   # its name
two_sided = true

[[thickness]]
technique = "back_face_thickness"

[[translucency]]
technique = "wrap_lighting"
wrap = 0.5

[[surface]]
technique = "base_color"

# bumps
[[surface]]
technique = "normal_map"
"""
    assert chain().with_chain(stages, ["two_sided = true"]) == expected


def test_what_has_no_header_is_refused() -> None:
    with pytest.raises(SssgenError, match="without a header"):
        chain('material = { name = "stone" }\nsurface = [{ technique = "base_color" }]\n')
    with pytest.raises(SssgenError, match="has no stage surface 7"):
        chain().without_stage(("surface", 7))
