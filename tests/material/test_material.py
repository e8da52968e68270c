"""Materials: the contents of a file reach the stages; every error in it is reported, with its place."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from snapshot import check_snapshot
from sssgen.material import roles
from sssgen.material.chain_assembly import DEFAULTS, INPUTS
from sssgen.material.material_loading import examples, load_material, parse_material
from sssgen.material.model import Material
from sssgen.support.diagnostics import MAX_ERRORS, SssgenError
from sssgen.support.toml_source import MAX_CHARACTERS, parse

HEAD = '[material]\nname = "wax"\n'
CHAIN = """
[[thickness]]
technique = "constant_thickness"
[[thickness]]
technique = "beer_lambert"
[translucency]
technique = "lobe_normalized"
"""


pytestmark = pytest.mark.usefixtures("in_folder")


def read(text: str) -> Material:
    return parse_material(text, Path("wax.toml"))


def errors_of(text: str) -> SssgenError:
    with pytest.raises(SssgenError) as caught:
        read(text)
    return caught.value


# The contents of a file


@pytest.mark.parametrize("name", sorted(examples()))
def test_every_example_loads(name: str) -> None:
    material = load_material(name)
    assert material.name == name
    assert material.doc
    assert material.stages
    again = load_material(material.path)
    assert [stage.values for stage in again.stages] == [stage.values for stage in material.stages]


def test_stages_run_in_the_order_of_the_roles_then_of_the_file() -> None:
    material = read(
        HEAD
        + '[translucency]\ntechnique = "lobe_exp2"\n'
        + '[[thickness]]\ntechnique = "constant_thickness"\n[[thickness]]\ntechnique = "beer_lambert"\n'
        + '[coordinates]\ntechnique = "parallax_straight"\n'
    )
    names = [stage.technique.name for stage in material.stages]
    assert names == ["parallax_straight", "constant_thickness", "beer_lambert", "lobe_exp2"]
    assert [stage.span.line for stage in material.stages] == [10, 6, 8, 4]


def test_title_and_shading_have_defaults() -> None:
    material = read('[material]\nname = "old_wax"\n' + CHAIN)
    assert (material.title, material.doc, material.shading) == ("Old wax", "", "lit")


def test_parameters() -> None:
    material = read(
        HEAD
        + CHAIN
        + "subsurface_distortion = 0.5\n"  # an alias
        + 'subsurface_color = "#ff8000"\n'
        + "power = { value = 4, fixed = true }\n"
        + "ambient = { fixed = true }\n"
        + 'scale.value = 3.0\n[[surface]]\ntechnique = "base_color"\nbase_color_texture = "wood.png"\n'
        + "tint = [1, 0.5, 0, 1]\n"
    )
    surface, lobe = material.stages[-2:]
    assert lobe.values["distortion"] == (0.5,)
    assert lobe.values["subsurface_color"] == pytest.approx((1.0, 0.2158605, 0.0), abs=1e-6)
    assert lobe.values["power"] == (4.0,)
    assert lobe.values["ambient"] == (0.05,)  # the technique's own default
    assert lobe.values["scale"] == (3.0,)
    assert lobe.fixed == {"power", "ambient"}
    assert surface.values == {"tint": (1.0, 0.5, 0.0, 1.0)}
    assert surface.textures == {"base_color_texture": "wood.png"}


def test_parameters_of_a_bound_function_belong_to_the_stage() -> None:
    stage = read(
        HEAD
        + '[thickness]\ntechnique = "thinness_uniform"\n'
        + 'bind = { body_distance = "sphere" }\nradius = 2.0\nreach = 1.0\n'
    ).stages[0]
    assert stage.values == {"radius": (2.0,), "reach": (1.0,)}
    assert stage.bindings["body_distance"].function.name == "sphere"


EGG = "float egg(world_position p)\n{\n    return length(vec3(p)) - 1.0;\n}\n"


def test_a_slot_accepts_a_function_of_a_file_of_the_material() -> None:
    Path("shapes").mkdir()
    Path("shapes/egg.sss").write_text(EGG, encoding="utf-8")
    for bound in ("shapes/egg.sss", "shapes/egg.sss:egg", "distance/sphere.sss", "box"):
        stage = read(HEAD + f'[thickness]\ntechnique = "thinness_uniform"\nbind.body_distance = "{bound}"\n').stages[0]
        assert stage.bindings["body_distance"].function.name == Path(bound.partition(":")[0]).stem


def test_another_function_of_a_technique_file_can_be_bound() -> None:
    stage = read(
        HEAD
        + '[thickness]\ntechnique = "march_distance_texture"\n'
        + 'bind = { distance_at = "sphere:sphere_object" }\n'
    ).stages[0]
    assert stage.bindings["distance_at"].function.name == "sphere_object"


def test_slots_of_bound_functions_are_bound_too() -> None:
    Path("hollow.sss").write_text(
        "float outside(world_position p);\nfloat hollow(world_position p)\n{\n    return abs(outside(p)) - 0.1;\n}\n",
        encoding="utf-8",
    )
    start = HEAD + '[thickness]\ntechnique = "thinness_uniform"\n[thickness.bind]\nbody_distance = "hollow.sss"\n'
    assert set(read(start + 'outside = "sphere"\n').stages[0].bindings) == {"body_distance", "outside"}
    assert "slot 'outside'" in str(errors_of(start))
    assert "calls 'outside' again" in str(errors_of(start + 'outside = "hollow.sss"\n'))


def test_a_technique_can_be_a_file_of_the_material() -> None:
    Path("glow.sss").write_text(
        "/**\n * Glows.\n * role: translucency\n */\nfloat glow(world_direction N, world_direction L)\n"
        "{\n    return max(-dot(N, L), 0.0);\n}\n",
        encoding="utf-8",
    )
    assert read(HEAD + '[translucency]\ntechnique = "glow.sss"\n').stages[0].technique.name == "glow"


def test_two_stages_of_one_technique_have_their_own_parameters_but_share_those_of_includes() -> None:
    two = HEAD + '[[thickness]]\ntechnique = "constant_thickness"\n[[thickness]]\ntechnique = "beer_lambert"\n'
    for name in ("lobe_exp2", "lobe_gdc2011"):
        two += f'[[translucency]]\ntechnique = "{name}"\npower = {{}}\n'
    assert len(read(two.format(4, 4)).stages) == 4
    message = str(errors_of(two.format(4, 8)))
    assert "'power' has another value in 'lobe_exp2', line 9" in message


@pytest.mark.parametrize("name", sorted({*INPUTS, *DEFAULTS}))
def test_the_quantities_of_chain_values_are_those_of_their_types(name: str) -> None:
    from sssgen.lang.check.quantities import QUANTITIES

    type_ = INPUTS[name] if name in INPUTS else DEFAULTS[name][0]
    quantity = roles.VALUE_QUANTITIES.get(name)
    assert quantity is None or QUANTITIES[quantity] == type_
    assert roles.VALUE_QUANTITIES.keys() <= INPUTS.keys() | DEFAULTS.keys()


def test_every_technique_of_the_library_keeps_to_its_role() -> None:
    from sssgen.material.library import load_all

    assert [wrong for technique in load_all() if (wrong := roles.wrong_result(technique))] == []


# What is wrong with a file

THINNESS = '[thickness]\ntechnique = "thinness_uniform"\n'
BOUND = THINNESS + 'bind = { body_distance = "sphere" }\n'
LOBE = HEAD + CHAIN
BAD = {
    "toml_no_value": HEAD + "shading =\n" + CHAIN,
    "toml_several_errors": '[material\nname = wax\ntitle "Wax"\n[[thickness]\ntechnique = "beer_lambert\n',
    "toml_key_twice": HEAD + 'name = "wood"\n' + CHAIN,
    "toml_section_twice": HEAD + '[surface]\ntechnique = "base_color"\n[surface]\ntechnique = "normal_map"\n',
    "toml_no_end": HEAD + "doc = '''it goes on\n" + CHAIN,
    "toml_unclosed_list": LOBE + "subsurface_color = [1.0, 0.5\n",
    "toml_number_of_5000_digits": LOBE + f"power = {'1' * 5000}\n",
    "empty": "",
    "no_stages": HEAD,
    "no_name": '[material]\ntitle = "Wax"\n' + CHAIN,
    "name_with_spaces": '[material]\nname = "Old Wax!"\n' + CHAIN,
    "name_of_a_path": '[material]\nname = "../../wax"\n' + CHAIN,
    "name_of_a_device": '[material]\nname = "con"\n' + CHAIN,
    "name_is_a_number": "[material]\nname = 3\n" + CHAIN,
    "title_of_two_lines": HEAD + 'title = "a\\nb"\n' + CHAIN,
    "unknown_shading": HEAD + 'shading = "lti"\n' + CHAIN,
    "unknown_key_in_material": HEAD + 'titel = "Wax"\n' + CHAIN,
    "key_outside_any_section": 'name = "wax"\n' + CHAIN,
    "two_materials": '[[material]]\nname = "wax"\n[[material]]\nname = "wood"\n' + CHAIN,
    "unknown_section": LOBE + '[surfaces]\ntechnique = "base_color"\n',
    "conversion_section": LOBE + '[conversion]\ntechnique = "beer_lambert"\n',
    "section_is_a_text": 'surface = "base_color"\n' + HEAD,
    "stage_without_technique": LOBE
    + "[[surface]]\ntint = [1.0, 1.0, 1.0, 1.0]\n[[surface]]\n[[surface]]\ntechnique = 3\n",
    "unknown_technique": LOBE + '[surface]\ntechnique = "base_colour"\n',
    "unlike_any_technique": LOBE + '[coordinates]\ntechnique = "zzz"\n',
    "technique_in_another_role": LOBE + '[surface]\ntechnique = "beer_lambert"\n[lighting]\ntechnique = "sphere"\n',
    "technique_file_missing": LOBE + '[surface]\ntechnique = "my/paint.sss"\n',
    "technique_file_faulty": LOBE + '[surface]\ntechnique = "faulty.sss"\nwrong = 1\n',
    "unknown_parameter": LOBE + "distorsion = 0.2\n",
    "parameters_there_are": LOBE + "zzz = 0.2\n",
    "no_parameters": HEAD + '[thickness]\ntechnique = "transmittance_map"\nzzz = 1\n',
    "alias_and_name": LOBE + "distortion = 0.2\nsubsurface_distortion = 0.3\n",
    "value_of_another_type": LOBE + 'distortion = "0.2"\npower = true\nscale = [1.0]\nambient = 1979-05-27\n',
    "value_of_another_size": LOBE + "subsurface_color = [1.0, 0.5]\n",
    "element_of_another_type": LOBE + 'subsurface_color = [1.0, 0.5, "red"]\n',
    "value_out_of_range": LOBE + "distortion = 1.4\npower = 0.5\n",
    "value_not_finite": LOBE + "distortion = nan\nscale = inf\npower = 1e99\n",
    "fraction_for_an_int": HEAD + BOUND + "taps = 29.0\n",
    "colour_misspelt": LOBE + 'subsurface_color = "#ff80"\n',
    "colour_for_a_vector": HEAD + BOUND + 'center = "#ff8000"\n',
    "unknown_key_of_a_parameter": LOBE + "distortion = { value = 0.2, fxed = true }\nscale = {}\n",
    "fixed_is_no_bool": LOBE + 'distortion = { value = 0.2, fixed = "yes" }\n',
    "texture_is_a_number": LOBE + '[surface]\ntechnique = "base_color"\nbase_color_texture = 3\n',
    "texture_fixed": LOBE
    + '[surface]\ntechnique = "base_color"\nbaseColorTexture = { value = "a.png", fixed = true }\n',
    "unbound_slot": HEAD + THINNESS,
    "unknown_slot": HEAD + THINNESS + 'bind = { body_distanse = "sphere" }\n',
    "slot_given_as_a_parameter": HEAD + THINNESS + 'body_distance = "sphere"\n',
    "no_slots": LOBE + 'bind = { body_distance = "sphere" }\n',
    "bind_is_a_text": HEAD + THINNESS + 'bind = "sphere"\n',
    "bound_to_a_number": HEAD + THINNESS + "bind = { body_distance = 3 }\n",
    "bound_to_an_unknown_function": HEAD + THINNESS + 'bind = { body_distance = "sphree" }\n',
    "bound_to_a_missing_file": HEAD + THINNESS + 'bind = { body_distance = "shapes/egg.sss:egg" }\n',
    "bound_to_an_unknown_function_of_a_file": HEAD + THINNESS + 'bind = { body_distance = "sphere:egg" }\n',
    "bound_to_another_space": HEAD + THINNESS + 'bind = { body_distance = "sphere:sphere_object" }\n',
    "bound_to_another_signature": HEAD + THINNESS + 'bind = { body_distance = "beer_lambert" }\n',
    "bound_to_a_faulty_file": HEAD + THINNESS + 'bind = { body_distance = "faulty.sss" }\n',
    "shared_parameter_differs": HEAD
    + BOUND
    + "radius = 1.0\n"
    + "[translucency]\ntechnique = 'slotted.sss'\nbind = { body_distance = 'sphere' }\nradius = 2.0\n",
    "quantity_not_converted": HEAD
    + '[thickness]\ntechnique = "thickness_map"\n[translucency]\ntechnique = "lobe_normalized"\n',
    "quantity_missing": HEAD + '[translucency]\ntechnique = "lobe_normalized"\n',
    "quantity_unused": HEAD
    + '[[thickness]]\ntechnique = "thickness_map"\n[[thickness]]\ntechnique = "constant_thickness"\n',
    "unlit_without_color": HEAD + 'shading = "unlit"\n[surface]\ntechnique = "base_color"\n',
    "lit_raymarching": HEAD + "[[geometry]]\ntechnique = 'raymarch'\nbind.scene_distance = 'jelly_scene'\n",
    "technique_breaks_its_role": LOBE + '[surface]\ntechnique = "breaks_role.sss"\n',
    "all_at_once": '[material]\nname = "a b"\nshading = "x"\n[coordinates]\ntechnique = "parallax"\n'
    + '[surface]\ntechnique = "base_color"\ntint = [2.0, "x"]\nzzz = 1\n[thing]\n',
    "file_without_its_suffix": HEAD
    + '[surface]\ntechnique = "breaks_role"\n'
    + '[translucency]\ntechnique = "slotted.sss"\nbind.body_distance = "faulty"\n',
    "escape_sequence_in_a_key": LOBE + '"\\u001b[31mred" = 1\n',
}
FAULTY = "void faulty(out vec3 albedo)\n{\n    albedo = vec2(1.0);\n    nothing();\n}\n"
SLOTTED = (
    "float body_distance(world_position p);\n/**\n * Slotted.\n * role: translucency\n */\n"
    "float slotted(world_position P)\n{\n    return body_distance(P);\n}\n"
)
BREAKS_ROLE = (
    "/**\n * Breaks its role.\n * role: surface\n */\n"
    "float breaks_role(vec2 uv, vec2 N, float albedoo, out float normal)\n"
    "{\n    normal = albedoo + N.x;\n    return uv.x;\n}\n"
)


@pytest.mark.parametrize("case", BAD)
def test_error(case: str) -> None:
    Path("faulty.sss").write_text(FAULTY, encoding="utf-8")
    Path("slotted.sss").write_text(SLOTTED, encoding="utf-8")
    Path("breaks_role.sss").write_text(BREAKS_ROLE, encoding="utf-8")
    error = errors_of(BAD[case])
    check_snapshot(f"cli/material/{case}.txt", f"{error}\n")
    for result in error.diagnostics:
        assert result.span.line >= 1
        lines = BAD[case].split("\n") if result.span.file == "wax.toml" else None
        assert lines is None or result.span.column <= len(lines[result.span.line - 1]) + 1
        assert "\x1b" not in result.render()


def test_a_file_that_is_missing_or_no_text(tmp_path: Path) -> None:
    Path("latin.toml").write_bytes('[material]\nname = "wax"\ndoc = "fade d\xe9grad\xe9"\n'.encode("latin-1"))
    Path("zero.toml").write_bytes(b"[material]\n\x00")
    Path("folder.toml").mkdir()
    texts = []
    for name in ("missing.toml", "latin.toml", "zero.toml", "folder.toml", "ise", "zzz", "wax/zzz"):
        with pytest.raises(SssgenError) as caught:
            load_material(name)
        texts.append(f"{name}\n{caught.value}\n")
    check_snapshot("cli/material/unreadable_files.txt", "\n".join(texts))


def test_a_missing_suffix_is_suggested() -> None:
    Path("wax.toml").write_text(LOBE, encoding="utf-8")
    with pytest.raises(SssgenError, match=r"did you mean 'wax\.toml'"):
        load_material("wax")


@pytest.mark.parametrize(
    "text",
    [
        "a = " + "[" * 10_000 + "]" * 10_000,
        "a = " + "{a = " * 10_000 + "1" + "}" * 10_000,
        "a" + ".a" * 10_000 + " = 1",
        "[a" + ".a" * 10_000 + "]",
        "[" * 10_000,
    ],
    ids=["list", "table", "key", "section", "open"],
)
def test_nesting_10000_deep(text: str) -> None:
    error = errors_of(HEAD + text)
    assert "nested more than 32 levels deep" in str(error)
    assert error.diagnostics[0].span.line == 3


def test_a_huge_file_is_refused() -> None:
    assert "too large" in str(errors_of("#" * (MAX_CHARACTERS + 1)))


def test_the_number_of_errors_is_limited() -> None:
    error = errors_of(HEAD + "".join(f'[[surface]]\ntechnique = "base_color"\nzzz{n} = 1\n' for n in range(3000)))
    assert len(error.diagnostics) == MAX_ERRORS + 1  # the last one reports that there are more


@given(st.data())
def test_random_faults_give_readable_errors(data: st.DataObject) -> None:
    text = (HEAD + BOUND + CHAIN.split("[translucency]")[1] + 'tint = ["#ff8000", { value = 1 }]\n').replace("\n", "\n")
    for _ in range(data.draw(st.integers(1, 3))):
        index = data.draw(st.integers(0, len(text)))
        removed = data.draw(st.integers(0, 6))
        text = (
            text[:index]
            + data.draw(st.sampled_from([*"[]{}=\"'.,#\n\\ a1", '"""', "[[", "'''"]))
            + text[index + removed :]
        )
    try:
        read(text)
    except SssgenError as error:
        assert str(error)


# Places

SAMPLE = """\
# comment = "no"
top = 'a#b'  # after
"quoted key" = "x = [1, 2] \\" #"
a.b . c = 1.5
[t]
list = [ 1, # one
  [2, "]"], { x = 3, y.z = [4] }, ]
long = \"\"\"
[no] = 1
""\"\"\"
[[r]]
k = 1979-05-27 07:32:00
[[r]]
k = -inf
[r.s]
k = '''
'''''
"""


def leaves(value: object, path: tuple[str | int, ...] = ()) -> list[tuple[tuple[str | int, ...], object]]:
    """Every value with its path."""
    items: list[tuple[str | int, Any]] = []
    if isinstance(value, dict):
        items = list(value.items())
    elif isinstance(value, list):
        items = list(enumerate(value))
    results: list[tuple[tuple[str | int, ...], object]] = [(path, value)] if path and not items else []
    for key, inner in items:
        results += leaves(inner, (*path, key))
    return results


def check_places(text: str) -> None:
    document = parse(text, "sample.toml")
    lines = text.split("\n")
    for path, value in leaves(document.data):
        key, span = document.place(*path)
        rows = lines[span.line - 1 : span.end_line]
        rows[-1] = rows[-1][: span.end_column - 1]
        rows[0] = rows[0][span.column - 1 :]
        if value != {} or rows[0] == "{":  # an empty section is no value
            assert tomllib.loads("k = " + "\n".join(rows))["k"] == value
        if isinstance(path[-1], str):
            name = lines[key.line - 1][key.column - 1 : key.end_column - 1]
            assert name.endswith(path[-1]) or path[-1] in tomllib.loads(f"{name} = 1")


def test_places_of_a_hard_sample() -> None:
    check_places(SAMPLE)


SCALARS = st.sampled_from(["1", "-2.5e3", "true", '"a # b"', "'[x]'", '"\\""', "1979-05-27", '"""x\ny"""', "0xff"])
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(lambda items: "[\n" + ", # c\n".join(items) + "]"),
        st.lists(inner, max_size=2).map(
            lambda items: "{ " + ", ".join(f"k{i} = {item}" for i, item in enumerate(items)) + " }"
        ),
    ),
    max_leaves=6,
)


@given(st.lists(st.tuples(st.sampled_from(["", "[s{}]", "[[list]]", "[a.b{}]"]), VALUES), max_size=6))
def test_places_of_any_file(parts: list[tuple[str, str]]) -> None:
    text = ""
    for number, (header, value) in enumerate(parts):
        text += f"{header.format(number)}\nkey{number}.x = {value}  # note\n"
    check_places(text)
