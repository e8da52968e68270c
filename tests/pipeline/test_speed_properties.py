"""The reasons why emitting is fast: few modules are loaded, and results are cached. No test uses a clock."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from carried import carrying
from slow_cases import some_slow
from sssgen.cli import main as cli
from sssgen.ir.types import Sampler, kind_of
from sssgen.material.material_loading import examples, load_material, parse_material
from sssgen.material.model import Material, TechniqueUse
from sssgen.pipeline import compiler, emitted_cache, pass_list, programs
from sssgen.support import cache
from sssgen.targets import assemble as emit

LANTERN = Path(examples()["paper_lantern"]).read_text(encoding="utf-8")
EDITED = ("distortion = 0.15", "distortion = 0.25")

ALONE = """
/**
The colour alone.
role: surface
*/
void plain(out vec3 albedo) {
    albedo = vec3(0.25);
}
"""
MATERIAL = '[material]\nname = "plain"\n[surface]\ntechnique = "plain.sss"\n'


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Starts each test with empty caches, in memory and on disk."""
    monkeypatch.setattr(cache, "folder", lambda: str(tmp_path))
    for memory in (compiler._programs, compiler._compiled, programs._material_programs):
        memory.clear()
    yield
    compiler._programs.clear()


# Loaded modules


def loaded(code: str, stored: Path, *names: str) -> set[str]:
    """The modules among these that a new process has loaded after running the code."""
    script = f"import sys\n{code}\nprint('loaded', *[name for name in {names!r} if name in sys.modules])"
    environment = {**os.environ, "SSSGEN_CACHE": str(stored)}
    process = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, env=environment
    )
    return set(process.stdout.splitlines()[-1].split()[1:])


def test_the_command_line_loads_no_expensive_module(tmp_path: Path) -> None:
    heavy = ("numpy", "lark", "jinja2", "json", "tomllib", "pathlib", "sssgen.pipeline.compiler")
    assert loaded("import sssgen.cli.main, sssgen.cli.emit", tmp_path, *heavy) == set()


def test_an_emit_with_warm_caches_imports_few_modules(tmp_path: Path) -> None:
    source, stored = tmp_path / "lantern.toml", tmp_path / "cache"
    heavy = (
        "numpy",
        "lark",
        "jinja2",
        "tomllib",
        "pathlib",
        "sssgen.pipeline.programs",
        "sssgen.lang.check.module_checker",
        "sssgen.material.model",
    )
    emit_all = (
        f"from sssgen.cli.main import main; main(['emit', {str(source)!r}, '-t', 'all', '-o', {str(tmp_path)!r}])"
    )
    source.write_text(LANTERN, encoding="utf-8")
    compiled = {"jinja2", "sssgen.pipeline.programs", "sssgen.lang.check.module_checker"}
    first = loaded(emit_all, stored, *heavy)
    assert compiled <= first
    assert not {"numpy", "lark"} & first
    assert loaded(emit_all, stored, *heavy) == set()
    source.write_text(LANTERN.replace(*EDITED), encoding="utf-8")
    assert not {"numpy", "lark", "sssgen.pipeline.programs", "sssgen.lang.check.module_checker"} & loaded(
        emit_all, stored, *heavy
    )


# Caches in the process


def test_the_same_input_gives_the_same_result() -> None:
    material, path = load_material("ice"), examples()["ice"]
    result, again, by_path = (compiler.compile(source, "wgsl").files for source in (material, material, path))
    assert result.keys() == by_path.keys()
    assert all(text is again[name] for name, text in result.items())  # the same object, not an equal text
    assert all(text is compiler.compile(path, "wgsl").files[name] for name, text in by_path.items())
    result["ice.wgsl"] = "the caller's own"
    assert compiler.compile(material, "wgsl").files == again
    assert again.keys() != compiler.compile(material, "wgsl", "functions").files.keys()


def test_a_changed_file_is_compiled_again(tmp_path: Path) -> None:
    material, technique = tmp_path / "plain.toml", tmp_path / "plain.sss"
    material.write_text(MATERIAL, encoding="utf-8")
    technique.write_text(ALONE, encoding="utf-8")
    first = compiler.compile(material, "wgsl")
    technique.write_text(ALONE.replace("0.25", "0.125"), encoding="utf-8")
    second = compiler.compile(material, "wgsl")
    material.write_text(MATERIAL.replace('"plain"', '"other"'), encoding="utf-8")
    third = compiler.compile(material, "wgsl")
    assert "vec3f(0.25)" in first.files["plain.wgsl"]
    assert "vec3f(0.125)" in second.files["plain.wgsl"]
    assert "other.wgsl" in third.files


def test_caches_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiler, "_CACHE_SIZE", 4)
    for number in range(12):
        compiler.compile(edited(load_material("resin_inlay"), number), "wgsl")
    assert len(compiler._compiled) <= 4
    assert len(compiler._programs) <= 4


# Variants


def edited(material: Material, number: int) -> Material:
    """The material with other values for all free parameters, in their ranges."""
    return material._replace(stages=tuple([_edited(stage, number) for stage in material.stages]))


def _edited(stage: TechniqueUse, number: int) -> TechniqueUse:
    values = dict(stage.values)
    for uniform in stage.technique.uniforms:
        if uniform.name in stage.fixed or isinstance(uniform.type, Sampler):
            continue
        old = values.get(uniform.name, uniform.default)
        if kind_of(uniform.type) == "float":
            values[uniform.name] = tuple(value * (1.0 - 0.001 * (number + 1)) for value in old)
        elif kind_of(uniform.type) == "int":
            values[uniform.name] = tuple(float(int(value) + number % 2) for value in old)
    return stage._replace(values=values)


@pytest.mark.parametrize("name", some_slow(examples(), "jade_ring"))
def test_a_variant_equals_a_compilation_from_source(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    original, variant = load_material(name), edited(load_material(name), 0)
    stored = {}
    for target in carrying(original):
        for form in compiler.FORMS:
            compiler.compile(original, target, form)
            stored[target, form] = compiler.compile(variant, target, form).files
    compiler._programs.clear()
    compiler._compiled.clear()
    monkeypatch.setattr(cache, "folder", lambda: "")
    monkeypatch.setattr(compiler, "_bare", lambda stage, fixed: stage)
    for (target, form), files in stored.items():
        assert compiler.compile(variant, target, form).files == files, (target, form)


def test_variants_run_no_pass_and_render_once_each(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[str] = []

    def counted(name: str, function: Callable[..., object]) -> Callable[..., object]:
        def call(*arguments: object) -> object:
            runs.append(name)
            return function(*arguments)

        return call

    for passes in ("MATERIAL", "TARGET"):
        steps = tuple(record._replace(step=counted("pass", record.step)) for record in getattr(pass_list, passes))
        monkeypatch.setattr(pass_list, passes, steps)
    monkeypatch.setattr(programs, "print_parts", counted("printing", programs.print_parts))
    monkeypatch.setattr(emit, "render", counted("rendering", emit.render))
    material = load_material("paper_lantern")
    compiler.compile(material, "unity-urp")
    assert (runs.count("printing"), runs.count("rendering")) == (1, 1)
    assert runs.count("pass") > 9
    for count in (50, 200):
        runs.clear()
        for number in range(count):
            compiler.compile(edited(material, number), "unity-urp")
        assert runs == ["rendering"] * count


def test_structural_changes_compile_another_program() -> None:
    material = parse_material(LANTERN, "lantern.toml")
    fixed = parse_material(LANTERN.replace(EDITED[0], "distortion = { value = 0.15, fixed = true }"), "lantern.toml")
    texts = [compiler.compile(source, "glsl-330").files["paper_lantern.glsl-330.frag"] for source in (material, fixed)]
    assert ["uniform float distortion;" in text for text in texts] == [True, False]


# The cache of the command line on disk


def test_a_command_is_recalled_until_something_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    source, technique = Path("plain.toml"), Path("plain.sss")
    source.write_text(MATERIAL, encoding="utf-8")
    technique.write_text('#include "common/uv_scale.sss"\n' + ALONE, encoding="utf-8")
    command = ["wgsl", "shader", "auto", "", "", "False", "plain.toml"]
    assert emitted_cache.load(command) is None
    assert cli.main(["emit", "plain.toml", "-t", "wgsl", "-o", "out"]) == 0
    result = emitted_cache.load(command)
    assert result is not None
    assert result.files == {path.name: path.read_text(encoding="utf-8") for path in Path("out").iterdir()}
    for position, other in enumerate(["all", "functions", "none", "wax_", "tone_mapping=agx", "True", "ice"]):
        assert emitted_cache.load([*command[:position], other, *command[position + 1 :]]) is None
    for path in (source, technique):
        text = path.read_text(encoding="utf-8")
        path.write_text(text + "\n", encoding="utf-8")
        assert emitted_cache.load(command) is None
        path.write_text(text, encoding="utf-8")
        assert emitted_cache.load(command) is not None
    Path("common").mkdir()  # a file with priority over the library's file
    Path("common/uv_scale.sss").write_text("", encoding="utf-8")
    assert emitted_cache.load(command) is None


def test_a_damaged_entry_is_recomputed(tmp_path: Path) -> None:
    material = load_material("resin_inlay")
    first = compiler.compile(material, "wgsl").files
    entries = [path for path in tmp_path.iterdir() if path.is_file()]
    assert any(path.name.startswith("program-") for path in entries)
    for path in entries:
        path.write_bytes(path.read_bytes()[:100])
    compiler._programs.clear()
    compiler._compiled.clear()
    assert compiler.compile(material, "wgsl").files == first


def test_the_reflection_equals_its_file_and_may_be_changed() -> None:
    compiled = compiler.compile("ice", "wgsl")
    assert compiled.reflection == json.loads(compiled.files["ice.wgsl.reflection.json"])
    compiled.reflection["uniforms"].clear()
    assert compiled.reflection["uniforms"]
