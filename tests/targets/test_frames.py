"""The frames of targets: what a program uses of them, and that templates decide nothing about inputs and values."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import pytest
from jinja2 import Environment, nodes

import sssgen
from sssgen.ir.surface_fields import NAMES, OPTIONAL
from sssgen.lang.check.quantities import SCALARS
from sssgen.material.chain_assembly import TAKEN
from sssgen.material.shell_assembly import SHELLS
from sssgen.pipeline.compiler import all_targets
from sssgen.pipeline.frame_functions import check_word
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import folder
from sssgen.targets.descriptor_reader import read
from sssgen.targets.frame import Variant, used_parts
from sssgen.targets.printed_places import Places, check_places
from sssgen.targets.used_frame import check_inputs, with_names

TEMPLATES = sorted(folder("templates").rglob("*.j2"))
OF_VALUES = {
    "inputs",
    "fields",
    "surface_fields",
    "light_fields",
    "surface_reads",
    "light_reads",
    "all",
    "reads",
    "needs",
}
"""The variables of templates that list inputs, or values of the surface."""
ENGINES = ("bevy", "unreal", "godot", "threejs", "babylonjs", "playcanvas", "unity-urp", "unity-builtin")
SELECTING = {"select", "reject", "selectattr", "rejectattr"}

SHEEN = """
[material]
name = "velvet"

[[surface]]
technique = "base_color"

[[surface]]
technique = "sheen_constants"
sheen_tint = [0.9, 0.4, 0.5]
"""


def questions(text: str) -> list[int]:
    """The lines of a template that ask which inputs or values of the surface a program uses."""
    tree = Environment().parse(text)
    asked: list[nodes.Node | None] = [node.test for node in tree.find_all((nodes.If, nodes.CondExpr, nodes.For))]
    asked += [*tree.find_all((nodes.Compare, nodes.Test))]
    asked += [node for node in tree.find_all(nodes.Filter) if node.name in SELECTING]
    asked += [node.iter for node in tree.find_all(nodes.For) if node.test is not None]
    names = [name for node in asked if node is not None for name in (node, *node.find_all(nodes.Name))]
    return sorted({name.lineno for name in names if isinstance(name, nodes.Name) and name.name in OF_VALUES})


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_no_template_asks_which_values_a_program_uses(path: Path) -> None:
    """The frame of its target answers that: [inputs] and [frame] for inputs, [surface] for values of the surface."""
    place = f"{path.parent.name}/{path.name}"
    assert [f"{place}:{line}" for line in questions(path.read_text("utf-8"))] == []


@pytest.mark.parametrize(
    "question",
    [
        '{% if "V" in inputs %}{% endif %}',
        '{% set lit = "albedo" in fields or "alpha" in fields %}',
        '{{ "a" if fields }}',
        '{% for field in inputs if field == "V" %}{% endfor %}',
        '{{ surface_fields | selectattr("name", "equalto", "normal") | list }}',
        '{{ light_reads | select("in", ["L"]) | list | length }}',
    ],
)
def test_such_a_question_is_found(question: str) -> None:
    assert questions(f"\n{question}") == [2]


def test_what_a_template_lists_is_no_question() -> None:
    assert (
        questions("{{ inputs | sort }}{% for field in light_fields %}{% endfor %}{% if frame.vertex %}{% endif %}")
        == []
    )


def lines_of(paths: Iterable[Path]) -> int:
    return sum(len(path.read_text("utf-8").splitlines()) for path in paths)


def test_the_templates_are_small() -> None:
    """What is a program is in another file: a frame, a function of `shells/`, a runtime, a graph."""
    assert lines_of(path for path in folder("templates").rglob("*") if path.is_file()) <= 3000


@pytest.mark.parametrize("engine", ENGINES)
def test_an_engine_is_small(engine: str) -> None:
    """Its descriptor and its own templates."""
    assert lines_of([folder("targets") / f"{engine}.toml", *(folder("templates") / engine).iterdir()]) <= 300


def test_a_part_pulls_in_what_it_mentions() -> None:
    parts = {
        "varyings": {"input.normal": "float3 normal : NORMAL;", "input.uv": "float2 uv : UV;"},
        "fragment": {"N": "float3 N = input.normal;", "V": "float3 V = eye - P;"},
        "vertex_attributes": {"mesh.normal": "float3 normal;"},
        "vertex": {"input.normal": "output.normal = mesh.normal;", "input.uv": "output.uv = mesh.uv;"},
    }
    used = used_parts(parts, [], [("", "turned(N)")])
    assert used == {
        "varyings": "float3 normal : NORMAL;",
        "fragment": "float3 N = input.normal;",
        "vertex_attributes": "float3 normal;",
        "vertex": "output.normal = mesh.normal;",
    }


def test_the_loop_over_the_lights_sees_its_own_parts_first() -> None:
    parts = {"fragment": {"N": "vec3 N = a;"}, "light": {"N": "vec3 N = b;", "L": "vec3 L = l;"}}
    assert used_parts(parts, [], [("", "N")]) == {"fragment": "vec3 N = a;", "light": ""}
    assert used_parts(parts, [], [("light", "f(N, L)")]) == {"fragment": "", "light": "vec3 N = b;\nvec3 L = l;"}
    assert used_parts(parts, [], [("", "L")]) == {"fragment": "", "light": ""}


def test_a_part_of_several_names_is_declared_once_and_parts_that_mention_each_other_end() -> None:
    parts = {"blocks": {"time eye": "cbuffer { time; eye; }", "a": "b", "b": "a"}}
    assert used_parts(parts, ["a"], [("", "eye + time")]) == {"blocks": "cbuffer { time; eye; }\nb\na"}


def test_a_member_of_another_variable_is_another_name() -> None:
    parts = {"varyings": {"input.position": "position"}, "blocks": {"camera": "camera"}}
    assert used_parts(parts, [], [("", "camera.position")]) == {"varyings": "", "blocks": "camera"}


def test_variants_replace_parts_by_their_names() -> None:
    base = Variant(inputs={"P": "p", "uv": "u"}, frame={"vertex": {"a": "1", "b": "2"}}, reads=("a",))
    both = base.with_variant(
        Variant(inputs={"P": "q"}, frame={"vertex": {"b": "3"}, "image": {"c": "4"}}, reads=("c",))
    )
    assert both.inputs == {"P": "q", "uv": "u"} and both.reads == ("a", "c")
    assert both.frame == {"vertex": {"a": "1", "b": "3"}, "image": {"c": "4"}}


def test_names_in_braces_are_replaced_and_other_braces_stay() -> None:
    assert (
        with_names("{f}({metallic}) { x; } {other}", {"f": "sss_f", "metallic": "0.0"}) == "sss_f(0.0) { x; } {other}"
    )


def test_functions_of_shells_have_names_that_no_technique_takes() -> None:
    names = {path.stem for path in Path(SHELLS).glob("*.sss")} - {"chain", "fragment"}
    assert names <= TAKEN


@pytest.mark.parametrize("target", sorted(all_targets()))
def test_every_optional_value_has_a_row_in_each_engine(target: str) -> None:
    """A value that a technique may write reaches the engine, or is an error that says what to do."""
    described = all_targets()[target]
    if described.fragment_shell or not described.surface:
        return
    texts = [text for rows in described.surface.values() for text in rows.items()]
    texts += [text for inner in described.embedded.values() for rows in inner.surface.values() for text in rows.items()]
    for name in OPTIONAL:
        has_row = any(row == name or f"{{{name}}}" in text for row, text in texts)
        assert has_row != (name in described.lacks), name
    for row, _ in texts:
        assert row in (*NAMES, *SCALARS)


@pytest.mark.parametrize("target", sorted(all_targets()))
def test_a_sheen_is_emitted_or_an_error_that_names_it(target: str, tmp_path: Path) -> None:
    path = tmp_path / "velvet.toml"
    path.write_text(SHEEN, encoding="utf-8")
    try:
        compiled = sssgen.compile(path, target)
    except SssgenError as error:
        assert "'sheen_color', which 'sheen_constants' gives" in error.diagnostics[0].message
        assert error.diagnostics[0].hint
    else:
        text = "\n".join(text for file, text in compiled.files.items() if not file.endswith((".json", ".d.ts")))
        written = re.sub(r"(?m)^.*\bsheen_(?:constants|tint|spread)\b.*$", "", text)
        assert written.count("sheen_roughness") + written.count("sheenRoughness") > 3


def test_a_frame_in_two_languages_is_written_once() -> None:
    """Both languages have the same parts, each with its spelling; parameters are passed as their types need it."""
    target = all_targets()["babylonjs"]
    inner = target.embedded["wgsl"]
    assert inner.frame == target.frame and inner.surface == target.surface and inner.variants == target.variants
    assert set(inner.spelling) == set(target.spelling)
    entries = sssgen.compile("ice", "babylonjs").reflection["entries"]
    params = {param["name"]: param for param in entries["surface"]["params"]}
    uv, tint = params["uv"], params["tint"]
    assert (uv["expression"], uv["embedded_expressions"]["wgsl"]) == ("sss_uv", "fragmentInputs.sss_uv")
    assert (tint["expression"], tint["embedded_expressions"]["wgsl"]) == ("sss_tint", "uniforms.sss_tint")


def test_what_an_engine_does_not_have_is_an_error() -> None:
    """A value without an expression, and a word in braces that means nothing: an error before any text is written."""
    godot = all_targets()["godot"]
    without = godot._replace(inputs={name: text for name, text in godot.inputs.items() if name != "screen_uv"})
    check_inputs(godot, {"surface": ["screen_uv", "P", "N"]})
    with pytest.raises(SssgenError, match="Godot 4 does not have the value 'screen_uv'"):
        check_inputs(without, {"surface": ["P", "screen_uv"]})
    with pytest.raises(SssgenError) as caught:
        check_word(godot, "safe_normalise")
    assert "names {safe_normalise}, which does not exist" in caught.value.diagnostics[0].message
    assert "safe_normalize" in str(caught.value.diagnostics[0].hint)


def test_a_place_that_no_template_prints_is_an_error(tmp_path: Path) -> None:
    """Its text would be lost; a place of the base is not checked."""
    (tmp_path / "toy.toml").write_text("title = 'Toy'\nextends = 'godot'\n[frame.varyingss]\na = 'varying vec3 a;'\n")
    toy = read(tmp_path / "toy.toml")
    contexts = [{"frame": Places({"varyings": "varying vec3 a;", "light": ""}), "surface": Places({})}]
    assert contexts[0]["frame"]["varyings"]
    contexts.append({"frame": Places({"light": "vec3 L = LIGHT;", "of_base": "a"}), "surface": Places({})})
    check_places(toy, ["godot/shader.gdshader.j2"], [("", own) for own in contexts])
    contexts.append({"frame": Places({"varyingss": "varying vec3 a;"}), "surface": Places({})})
    with pytest.raises(SssgenError) as caught:
        check_places(toy, ["godot/shader.gdshader.j2"], [("", own) for own in contexts])
    (result,) = caught.value.diagnostics
    assert "do not print the place 'varyingss' of [frame]" in result.message and result.span.line == 3
    assert "did you mean 'varyings'?" in result.hint


def test_a_form_that_a_target_does_not_have_is_an_error() -> None:
    target = all_targets()["metal"]
    with pytest.raises(SssgenError, match="unknown form 'shadr'"):
        sssgen.compile("ice", target.name, "shadr")
