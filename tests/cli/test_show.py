"""`sssgen show`: every name that `sssgen list` prints, and what is said about it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from command_line import Run
from snapshot import check_snapshot
from sssgen.cli import layout, show
from sssgen.ir import signatures
from sssgen.material.material_loading import examples
from sssgen.targets import registry

QUICK = tuple(kind for kind in show.KINDS if kind != "material")
"""A material is compiled for every target."""


@pytest.mark.parametrize("name", ["beer_lambert", "thinness_uniform", "base_color"])
def test_show(name: str, run: Run) -> None:
    ran = run("show", name)
    assert (ran.status, ran.err) == (0, "")
    check_snapshot(f"cli/show/{name}.txt", ran.out)


@pytest.mark.parametrize("kind", QUICK)
def test_every_name_of_a_kind(kind: str, run: Run) -> None:
    names = show.names_of(kind)
    assert names
    for name in names:
        facts = json.loads(run("show", name, "--kind", kind, "--json").out)
        assert (facts["ok"], facts["kind"], facts["name"]) == (True, kind, name)
        assert kind != "technique" or (facts["summary"] and "source" in facts["doc"])
        text = show.facts_module(kind).lines(facts, 80)
        assert text[0].startswith(name)
        assert all(len(line) <= 80 for line in text if line[:1] != " "), name


def test_a_material(run: Run) -> None:
    facts = json.loads(run("show", "jade_ring", "--json").out)
    assert facts["other_kinds"] == ["scene"]
    stages = {stage["technique"]: stage for stage in facts["stages"]}
    values = {parameter["name"]: parameter["value"] for parameter in stages["base_color"]["parameters"]}
    assert values["tint"] == [0.035, 0.06, 0.045, 1.0]  # of the material, not of the technique
    assert "depth-map" in facts["requires"]
    assert set(facts["refused"]) < set(registry.names())
    assert "shadertoy" in facts["refused"]  # no program draws back faces there
    assert all(cost["weight"] >= cost["operations"] > 0 for cost in facts["cost"].values())
    text = run("show", "jade_ring").out
    assert f"targets: {len(registry.names()) - len(facts['refused'])}, all but:" in text
    assert "tint = (0.035, 0.06, 0.045, 1)" in text


def test_emit_names_the_targets_whose_passes_are_drawn_by_the_users_program(run: Run) -> None:
    emitted = run("emit", "jade_ring", "--target", "threejs,wgsl,hlsl", "-o", "out").out.splitlines()[-1]
    drawers = "(drawn by the material itself in three.js, by your own program for wgsl, hlsl)"
    assert emitted.count(drawers) == 2
    assert "drawn by" not in run("emit", "jade_ring", "--target", "wgsl,hlsl", "-o", "out").out


def test_the_parameters_of_a_material_are_those_of_its_shader(run: Run) -> None:
    """Stages share a parameter: each shows the value that the shader has."""
    stages = json.loads(run("show", "ice", "--json").out)["stages"]
    values = [p["value"] for stage in stages for p in stage["parameters"] if p["name"] == "cell_count"]
    assert values == [[10.0], [10.0]]


def test_files(run: Run) -> None:
    """A file is shown as what it describes."""
    shutil.copytree(Path(examples()["ice"]).parent, "mine")
    assert json.loads(run("show", "mine/ice.toml", "--json").out)["kind"] == "material"
    assert json.loads(run("show", "mine/scene.toml", "--json").out)["kind"] == "scene"


def test_a_name_of_several_kinds(run: Run) -> None:
    ran = run("show", "ice")
    assert ran.out.startswith("ice (material): Ice\n")
    assert ran.out.endswith(
        "also a scene: sssgen show --kind scene ice\nalso a preset: sssgen show --kind preset ice\n"
        "also a medium: sssgen show --kind medium ice\n"
    )
    assert run("show", "--kind", "scene", "ice").out.startswith("ice (scene)\n")
    assert "also a" not in run("show", "beer_lambert").out


def test_a_target(run: Run) -> None:
    lacks = json.loads(run("show", "unity-builtin", "--json").out)["lacks"]
    assert list(lacks["values"]) == ["clearcoat", "clearcoat_roughness", "sheen_color", "sheen_roughness"]
    assert "textureSize" in lacks["functions"]
    assert "clearcoat: leave the stage out" in run("show", "unity-builtin").out


def test_a_builtin(run: Run) -> None:
    """The texts are those that the printers use."""
    facts = json.loads(run("show", "atan", "--json").out)
    assert facts["languages"]["hlsl"] == {"genF": "atan", "genF,genF": "atan2"}
    assert signatures.texts("mod", "hlsl-dx9") == {"genF,genF": "", "genF,float": ""}
    assert "polyfill:\n  genF mod(genF x, genF y) { return x - y * floor(x / y); }" in run("show", "mod").out


def test_a_builtin_that_is_a_function_and_an_old_name(run: Run) -> None:
    assert "genF modf(genF x, out genF whole) {" in run("show", "modf").out
    old, new = run("show", "texture2D").out, run("show", "texture").out
    assert old.splitlines()[0] == "texture2D (builtin), an old name of texture"
    assert old.splitlines()[1:] == new.splitlines()[1:]


def test_tables_fit_a_terminal_and_stay_whole_in_a_pipe(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = run("list", "scenes").out.splitlines()
    assert len(whole) == len(show.names_of("scene"))
    monkeypatch.setattr(layout, "table_width", lambda: 50)
    lines = run("list", "scenes").out.splitlines()
    assert len(lines) > len(whole)
    assert max(map(len, lines)) <= 50
    assert max(map(len, run("show", "firefox").out.splitlines())) <= 50
