"""CONTRIBUTING.md, followed step by step: its files written, its commands run, in a copy of the project."""

from __future__ import annotations

import os
import re
import shutil
import sys
import sysconfig
import tomllib
import venv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from documents import Reader, blocks, programs, read, uncommented
from folders import ROOT
from sssgen import SssgenError
from sssgen.cli.main import main
from sssgen.lang.check.shader_interface import BUILTIN_VARIABLES
from sssgen.material.chain_assembly import AT_REST, INPUTS
from sssgen.passes.capabilities import Capabilities
from sssgen.targets import descriptor_reader, plugins, registry
from sssgen.targets.chain_inputs import CHAIN_INPUTS
from sssgen.targets.descriptor import STAGE_BUILTINS
from sssgen.targets.descriptor_table import table_of

CONTRIBUTING = ROOT / "CONTRIBUTING.md"
COPIED = ("src", "targets", "templates", "examples", "tests", "docs", "pyproject.toml", "README.md", "LICENSE")


def checkout(folder: Path, programs: Path) -> Reader:
    """A reader in a fresh copy of the project, with the compilers that this one has."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(
                source, folder / name, ignore=shutil.ignore_patterns("__pycache__", ".*_cache", "snapshots")
            )
        else:
            shutil.copy(source, folder / name)
    environment = {"PYTHONPATH": str(folder / "src"), "SSSGEN_CACHE": str(folder / "cache")}
    modules = os.environ.get("SSSGEN_NODE_MODULES") or str(ROOT / "build" / "node" / "node_modules")
    return Reader(folder, programs, {**environment, "SSSGEN_NODE_MODULES": modules})


def test_add_a_technique(tmp_path: Path, compiler: Callable[[str], Any]) -> None:
    for name in ("gl", "glslang", "naga", "tint", "dxc", "unity"):
        compiler(name)
    reader = checkout(tmp_path, programs(tmp_path / "programs"))
    steps = blocks(CONTRIBUTING, "Add a technique")
    assert [step.verb for step in steps] == ["write", "output", "write", "run", "write", "run", "run"]
    for step in steps:
        reader.follow(step)
    assert "sheet_thickness" in reader.run("sssgen list techniques --role thickness")[0]
    assert "sheet_thickness(" in (tmp_path / "out" / "sheet" / "frosted_sheet.wgsl").read_text("utf-8")


def test_add_a_builtin(tmp_path: Path, compiler: Callable[[str], Any]) -> None:
    compiler("gl")
    reader = checkout(tmp_path, programs(tmp_path / "programs"))
    for step in blocks(CONTRIBUTING, "Add a builtin"):
        reader.follow(step)
    assert "`genF clampSigned(genF)`<br>clamp(x, -1, 1)." in read(tmp_path / "docs" / "intrinsics.md")


@pytest.mark.slow
def test_add_a_role(tmp_path: Path, compiler: Callable[[str], Any]) -> None:
    for name in ("gl", "glslang", "naga", "tint", "dxc", "unity"):
        compiler(name)
    reader = checkout(tmp_path, programs(tmp_path / "programs"))
    for step in blocks(CONTRIBUTING, "Add a role"):
        reader.follow(step)
    assert "wetness" in reader.run("sssgen list techniques --role weathering")[0]
    assert "wetness(" in read(tmp_path / "out" / "wet" / "wet_paper.wgsl")


@pytest.mark.slow
def test_add_a_target(tmp_path: Path, compiler: Callable[[str], Any]) -> None:
    """In a fresh environment with sssgen and its dependencies, and no plug-in yet."""
    compiler("glslang")
    environment = tmp_path / "environment"
    venv.create(environment)
    (environment / "bin" / "sssgen").symlink_to(
        programs(tmp_path / "programs", str(environment / "bin" / "python")) / "sssgen"
    )
    (packages,) = (environment / "lib").glob("python*/site-packages")
    (packages / "outer.pth").write_text(f"{sysconfig.get_path('purelib')}\n", encoding="utf-8")  # lark, jinja2
    reader = checkout(tmp_path / "checkout", environment / "bin")
    before = reader.run("sssgen list targets")[0]
    assert "vulkan" not in before.split()
    steps = blocks(CONTRIBUTING, "Add a target")
    for step in steps:
        reader.follow(step)
    after = reader.run("sssgen list targets")[0]
    assert {line.split()[0] for line in after.splitlines()} == {line.split()[0] for line in before.splitlines()} | {
        "vulkan"
    }
    reflection = (reader.folder / "out" / "vulkan" / "paper_lantern.vulkan.reflection.json").read_text("utf-8")
    assert '"binding": {"group": 1, "texture": 1}' in reflection and '"offset": 0' in reflection


def test_every_step_is_followed() -> None:
    """Only the commands at the top, for the project's own environment, are not."""
    lines = read(CONTRIBUTING).splitlines()
    assert [lines[number] for number in uncommented(CONTRIBUTING)] == [lines[3]]
    assert lines[3].startswith("make test")


# Plug-ins that are faulty


@pytest.fixture
def plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str, str], None]:
    """`plugin(entry, module)`: a package with that entry point and that text, on the path."""

    def install(entry: str, module: str) -> None:
        information = tmp_path / "toy-1.0.dist-info"
        information.mkdir()
        (information / "METADATA").write_text("Metadata-Version: 2.1\nName: toy\nVersion: 1.0\n", encoding="utf-8")
        (information / "entry_points.txt").write_text(f"[sssgen.targets]\n{entry}\n", encoding="utf-8")
        (tmp_path / "toy_target.py").write_text(module, encoding="utf-8")

    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "toy_target", raising=False)
    for module_, name in ((registry, "names"), (registry, "faults"), (registry, "load"), (plugins, "entries")):
        monkeypatch.setattr(module_, name, getattr(module_, name).__wrapped__)
    return install


TOY = "from sssgen.targets import registry\ndef toy():\n    return registry.load('glsl-330')._replace(name='{}')\n"


def test_a_plugin_can_add_a_target(plugin: Callable[[str, str], None]) -> None:
    plugin("toy = toy_target:toy", TOY.format("toy"))
    assert "toy" in registry.names()
    assert registry.load("toy").language == "glsl"


@pytest.mark.parametrize(
    ("entry", "module", "message"),
    [
        ("toy = toy_target:toy", "import no_such_module", "No module named 'no_such_module'"),
        ("toy = toy_target:tow", "toy = 1", "no attribute 'tow'"),
        ("toy = toy_target:toy", "toy = 1", "TypeError"),
        ("toy = toy_target:toy", "def toy(): raise KeyError('x')", "KeyError: 'x'"),
        ("toy = toy_target:toy", "toy = 'no_such_file.toml'", "cannot read the target descriptor"),
        ("toy = toy_target:toy", TOY.format("other"), "gives a target called 'other'"),
    ],
)
def test_a_faulty_plugin_is_named(plugin: Callable[[str, str], None], entry: str, module: str, message: str) -> None:
    plugin(entry, module)
    with pytest.raises(SssgenError) as error:
        registry.load("toy")
    (result,) = error.value.diagnostics
    assert message in result.render()


def test_a_faulty_plugin_leaves_the_other_targets(
    plugin: Callable[[str, str], None], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """It is listed with the reason; only those who name it, or ask for all targets, get the error."""
    plugin("toy = toy_target:toy", "import no_such_module")
    out = str(tmp_path / "out")
    assert "toy" not in registry.names() and main(["emit", "ice", "--target", "wgsl", "-o", out]) == 0
    assert main(["list", "targets"]) == 0
    (line,) = [line for line in capsys.readouterr().out.splitlines() if line.split()[:1] == ["toy"]]
    assert "cannot be read: the plug-in of target 'toy' cannot be loaded" in line
    for targets in ("wgsl,toy", "all"):
        assert main(["emit", "ice", "--target", targets, "-o", out]) == 2
        assert "No module named 'no_such_module'" in capsys.readouterr().err


def test_a_faulty_descriptor_is_named(tmp_path: Path) -> None:
    path = tmp_path / "toy.toml"
    names = "title = 'T'\nlanguage = 'glsl'\n[types]\n[names]\nreserved = 3\n[files]\n"
    for text, message in (
        ("title = 1\n", "the target descriptor is incomplete"), (names, "toy.toml:5:1"), ("= 1", "toy.toml:1:1"),
    ):  # fmt: skip
        path.write_text(text, encoding="utf-8")
        with pytest.raises(SssgenError, match=message):
            descriptor_reader.read(path)


def changed(old: str, new: str, tmp_path: Path) -> str:
    """The error for the toy's descriptor with one text replaced."""
    text = (ROOT / "examples/plugin/vulkan/sssgen_vulkan/vulkan.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = tmp_path / "vulkan.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(SssgenError) as error:
        descriptor_reader.read(path)
    return error.value.diagnostics[0].render()


@pytest.mark.parametrize(
    ("old", "new", "section", "nearest"),
    [
        ("uniform_values =", "uniform_value =", " in [capabilities]", "uniform_values"),
        ("color_space =", "colour_space =", " in [conventions]", "color_space"),
        ("layout =", "lay_out =", "", "layout"),
        ("[conventions]", "[convention]", "", "conventions"),
        ("reserved =", "reserve =", " in [names]", "reserved"),
        ("screen_uv =", "screenuv =", " in [inputs]", "screen_uv"),
        ("[inputs]", "[types]\nsamplercube = ''\n[inputs]", " in [types]", "samplerCube"),
        ('template = "vulkan', 'templates = "vulkan', " in [files.shader]", "template"),
        ("[inputs]", "[limits]\nsampler = 16\n[inputs]", " in [limits]", "samplers"),
        ("[inputs]", "[textures]\nparameters = ''\n[inputs]", " in [textures]", "parameter"),
        ("[inputs]", "[stage_builtins]\ngl_position = ''\n[inputs]", " in [stage_builtins]", "gl_Position"),
    ],
)
def test_a_misspelt_key_is_named(tmp_path: Path, old: str, new: str, section: str, nearest: str) -> None:
    message = changed(old, new, tmp_path)
    assert "the target descriptor has an unknown key '" in message and f"'{section}\n" in message
    assert re.search(r"vulkan\.toml:\d+:\d+\n \d+ \| .*\n +\| +\^\^\^", message), message
    assert f"did you mean '{nearest}'?" in message


@pytest.mark.parametrize(
    ("old", "new", "wrong"),
    [
        ("uniform_values = false", "uniform_values = 1", "needs true or false for 'uniform_values' in [capabilities]"),
        ("clip_z = [0.0, 1.0]", "clip_z = 0.0", "needs a list for 'clip_z' in [conventions]"),
        ('uv = "v_uv"', "uv = 1", "needs a text for 'uv' in [inputs]"),
    ],
)
def test_a_value_of_the_wrong_type_is_named(tmp_path: Path, old: str, new: str, wrong: str) -> None:
    assert wrong in changed(old, new, tmp_path)


def write(folder: Path, **texts: str) -> Path:
    """Descriptors called after the keywords in a folder; the path of the first."""
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return folder / f"{next(iter(texts))}.toml"


FILES = "[[files.functions]]\nname = '{material}.toy'\n"


def test_a_descriptor_inherits(tmp_path: Path) -> None:
    (tmp_path / "words.txt").write_text("# the toy's\n[names.reserved]\nplay # a word\nblock\n", encoding="utf-8")
    path = write(
        tmp_path,
        toy=f"title = 'Toy'\nextends = 'middle'\nwords = 'words.txt'\n{FILES}[types]\nvec2 = ''\nvec3 = 'three'\n",
        middle="extends = 'glsl-330'\nalso = ['block']\n[capabilities]\nternary = false\n[names]\nshell = 'lamp'\n",
    )
    toy, base = descriptor_reader.read(path), registry.load("glsl-330")
    assert (toy.name, toy.title, toy.also, toy.language, toy.version) == ("toy", "Toy", (), base.language, base.version)
    assert toy.types == {**{name: text for name, text in base.types.items() if name != "vec2"}, "vec3": "three"}
    assert list(toy.files) == ["functions"] and toy.inputs == base.inputs
    assert toy.capabilities == base.capabilities._replace(ternary=False)
    assert toy.names == base.names._replace(reserved=frozenset({"play", "block"}), shell=frozenset({"lamp"}))


@pytest.mark.parametrize(
    ("texts", "message", "hint"),
    [
        ({"toy": "extends = 'glsl-333'"}, "extends 'glsl-333', which is unknown", "did you mean 'glsl-330'?"),
        ({"toy": "extends = 'nothing_like_it'"}, "extends 'nothing_like_it', which is unknown", "targets: babylonjs, "),
        ({"toy": "extends = 'toy'"}, "extends itself: toy → toy", "extend another target"),
        ({"toy": "extends = 'a'", "a": "extends = 'b'", "b": "extends = 'a'"}, "itself: a → b → a", "extend another"),
        ({"toy": "extends = 1"}, "needs a text for 'extends'", ""),
        ({"toy": "words = 'words.txt'"}, "words before the first list", "[names.reserved]"),
        ({"toy": "words = 'none.txt'"}, "cannot read the target descriptor", ""),
        ({"toy": "extend = 'wgsl'"}, "key 'extend'", "'extends'?"),
    ],
)
def test_a_faulty_base_is_named(tmp_path: Path, texts: dict[str, str], message: str, hint: str) -> None:
    (tmp_path / "words.txt").write_text("play\n", encoding="utf-8")
    with pytest.raises(SssgenError) as error:
        descriptor_reader.read(write(tmp_path, **texts))
    shown = error.value.diagnostics[0].render()
    assert message in shown and hint in shown and ".t" in shown.splitlines()[1]


def test_a_descriptor_inherits_from_a_plugin(plugin: Callable[[str, str], None], tmp_path: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    base = write(folder, toy=f"title = 'Toy'\nextends = 'wgsl'\nversion = '7'\n{FILES}")
    plugin("toy = toy_target:path", f"path = {str(base)!r}")
    target = descriptor_reader.read(write(tmp_path, smaller=f"title = 'Smaller'\nextends = 'toy'\n{FILES}"))
    assert (target.language, target.version) == ("wgsl", "7")


def test_bases_and_variants_are_no_targets() -> None:
    assert {"shared", "half", "base", "unity", "wgsl-f16"}.isdisjoint(registry.names())
    assert registry.load("wgsl-f16").half_of == "wgsl"


def repeated(table: dict[str, Any], base: dict[str, Any], place: str) -> list[str]:
    """The keys whose values are those of the base."""
    keys = []
    for key, value in table.items():
        if isinstance(value, dict) and key != "stage_builtins" and isinstance(base.get(key), dict):
            keys += repeated(value, base[key], f"{place} {key}")
        elif key in base and base[key] == value:
            keys.append(f"{place} {key}")
    return keys


@pytest.mark.parametrize("path", sorted((ROOT / "targets").rglob("*.toml")), ids=lambda path: path.stem)
def test_no_descriptor_repeats_its_base(path: Path) -> None:
    own = tomllib.loads(path.read_text(encoding="utf-8"))
    if "extends" in own:
        assert not repeated(own, table_of(str(ROOT / "targets" / f"{own['extends']}.toml")), path.stem)


def test_own_descriptors_declare_every_capability() -> None:
    for name in registry.names():
        path = ROOT / "targets" / f"{name}.toml"
        assert list(table_of(str(path))["capabilities"]) == list(Capabilities._fields), name
    assert not any(Capabilities())


def test_the_keys_of_descriptors_equal_the_inputs_of_the_chain() -> None:
    assert set(CHAIN_INPUTS) == {*INPUTS, *AT_REST.values(), "surface", "color"}
    assert set(STAGE_BUILTINS) < set(BUILTIN_VARIABLES)
