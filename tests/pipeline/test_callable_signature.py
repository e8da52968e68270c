"""The reflection tells how to call the assembled functions, and `--prefix` makes room for them beside other names."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import sssgen
from sssgen.cli import main as cli
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import SssgenError

EXAMPLES = ("ice", "jade_ring", "marble_idol", "wax_mouse")
DECLARED = re.compile(r"^(?:export |static )?(?:const )?(?:struct|fn|def|class|[\w<>]+)\s+(\w+)\s*[({=:]", re.MULTILINE)


@pytest.mark.parametrize("target", ["glsl-330", "glsl-es-300", "hlsl", "wgsl"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_the_shell_calls_as_the_reflection_says(name: str, target: str) -> None:
    compiled = sssgen.compile(name, target)
    text = "\n".join(text for file, text in compiled.files.items() if not file.endswith(".json"))
    text = re.sub(r"\s+", " ", text)  # long calls are on several lines
    for entry in compiled.reflection["entries"].values():
        call = f"{entry['function']}({', '.join(param['expression'] for param in entry['params'])})"
        # without a technique for the surroundings, both are this variable
        pattern = re.sub(r"\birradiance(_behind)?\b", r"(irradiance\1|[\\w.]*ambient\\w*)", re.escape(call))
        assert re.search(pattern, text)


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_parameter_is_described(name: str) -> None:
    reflection = sssgen.compile(name, "wgsl", "functions").reflection
    uniforms = {one["name"]: one["type"] for one in [*reflection["uniforms"], *reflection["textures"]]}
    for entry in reflection["entries"].values():
        inputs = [param["input"] for param in entry["params"] if "input" in param]
        assert [one for one in inputs if one != "surface"] == entry["inputs"]
        for param in entry["params"]:
            assert param["meaning"] if "input" in param else uniforms[param["uniform"]] == param["type"]
    spaces = {
        param["input"]: param["space"]
        for entry in reflection["entries"].values()
        for param in entry["params"]
        if "input" in param
    }
    assert all(spaces[one] == "world" for one in ("P", "N", "V", "L") if one in spaces)


@pytest.mark.parametrize("target", [name for name, one in sssgen.all_targets().items() if one.language != "python"])
def test_every_global_name_has_the_prefix(target: str, assert_compiles: Callable[[Source], None]) -> None:
    compiled = sssgen.compile("ice", target, "functions", prefix="wax_")
    for source in sources(compiled.files):
        assert_compiles(source)
        names = [name for name in DECLARED.findall(source.text) if name != "precision"]
        assert len(names) > 10
        assert [name for name in names if not re.match(r"wax_|ice_", name, re.IGNORECASE)] == []
    reflection = compiled.reflection
    assert reflection["entries"]["surface"]["function"] == "wax_evaluate_surface"
    assert all(one["name"].startswith("wax_") for one in reflection["uniforms"])


@pytest.mark.parametrize(
    ("prefix", "form", "message"),
    [
        ("1x", "functions", "'1x' cannot begin a name"),
        ("a__b", "functions", "'a__b' cannot begin a name"),
        ("gl_", "functions", "names that begin with 'gl_' are reserved"),
        ("wax_", "shader", "whole shaders take none: wgsl"),
    ],
)
def test_a_prefix_that_cannot_be(prefix: str, form: str, message: str) -> None:
    with pytest.raises(SssgenError, match=re.escape(message)):
        sssgen.compile("ice", "wgsl", form, prefix=prefix)


def test_one_error_lists_all_targets_whose_whole_shaders_take_no_prefix(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "wax.toml"
    path.write_text('[material]\nname = "wax"\n[surface]\ntechnique = "base_color"\n', encoding="utf-8")
    out = tmp_path / "out"
    assert cli.main(["emit", str(path), "--target", "all", "--prefix", "wax_", "-o", str(out)]) == 2
    said = capsys.readouterr()
    message, hint = said.err.splitlines()
    listed = message.removeprefix(
        "error: --prefix is for text that is pasted into other shaders; whole shaders take none: "
    )
    assert listed.split(", ") == [name for name, one in sssgen.all_targets().items() if not one.prefix]
    assert "wgsl" in listed.split(", ") and "threejs" not in listed
    assert hint == "  help: leave the prefix out, or add --form functions"
    assert said.out == "" and not out.exists()
    assert cli.main(["emit", str(path), "--target", "threejs,babylonjs", "--prefix", "wax_", "-o", str(out)]) == 0
    assert "wax_evaluate_surface" in (out / "wax.js").read_text(encoding="utf-8")


def test_two_parameters_of_one_property(tmp_path: Path) -> None:
    """In JavaScript `cell_count` is `cellCount`."""
    doc = "/**\n * X.\n * role: surface\n * formula: none\n * source: none\n * units: none\n * limits: none\n */\n"
    uniforms = "/// One.\nuniform float cell_count = 1.0;\n/// Two.\nuniform float cellCount = 1.0;\n"
    (tmp_path / "made.sss").write_text(
        f"{uniforms}{doc}void made(out float roughness) {{\n roughness = cell_count * cellCount;\n}}\n"
    )
    (tmp_path / "made.toml").write_text('[material]\nname = "m"\n[[surface]]\ntechnique = "./made.sss"\n')
    path = str(tmp_path / "made.toml")
    assert "cellCount" in sssgen.compile(path, "wgsl").files["m.wgsl"]
    with pytest.raises(SssgenError, match="'cell_count' and 'cellCount' would both be the property 'cellCount'"):
        sssgen.compile(path, "threejs")
