"""The command line: what each command prints and writes, its exit status, and what it says of errors."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from snapshot import check_snapshot
from sssgen.cli import listing, show, transpile
from sssgen.cli import main as cli
from sssgen.ir.nodes import Module, Span
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline import emitted_cache
from sssgen.support import file_writer as output
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import write_files

WAX = """\
[material]
name = "wax"
[thickness]
technique = "transmittance_map"
[translucency]
technique = "lobe_normalized"
"""
GLSL = "float twice(float x)\n{\n    return 2.0 * x;\n}\n"


class Compiled(NamedTuple):
    files: dict[str, str]
    warnings: list[Diagnostic]

    @property
    def reflection(self) -> dict[str, object]:
        return {}


class Target(NamedTuple):
    title: str


class FakeCompiler(types.ModuleType):
    """A compiler that writes down what it was asked, so that these tests are about the command line alone."""

    def __init__(self) -> None:
        super().__init__("sssgen.pipeline.compiler")
        self.asked: list[tuple[str, str, str, Path | None]] = []
        self.text = "text 1"
        self.name = "{}.{}.txt"
        self.failing: dict[str, Exception] = {}
        self.warnings: list[Diagnostic] = []

    def all_targets(self) -> dict[str, Target]:
        return {"glsl-330": Target("GLSL 3.30"), "wgsl": Target("WGSL")}

    def compile(self, material: Material, target: str, form: str, templates: Path | None, guards: str) -> Compiled:
        self.asked.append((material.name, target, form, templates))
        if target in self.failing:
            raise self.failing[target]
        name = self.name.format(material.name, target)
        files = {name: f"{self.text}\n", f"{material.name}.{target}.reflection.json": "{}\n"}
        return Compiled(files, self.warnings)

    def transpile(self, module: Module, target: str, name: str, guards: str, **kept: object) -> Compiled:
        text = f"// {name}: {', '.join(function.name for function in module.functions)}\n"
        return Compiled({f"{name}.{target}.txt": text, f"{name}.{target}.reflection.json": "{}\n"}, [])


@pytest.fixture
def compiler(monkeypatch: pytest.MonkeyPatch) -> FakeCompiler:
    fake = FakeCompiler()
    monkeypatch.setitem(sys.modules, "sssgen.pipeline.compiler", fake)
    monkeypatch.setattr(listing, "all_targets", fake.all_targets)
    monkeypatch.setattr(transpile, "transpile", fake.transpile)
    monkeypatch.setattr(emitted_cache, "load", lambda *_: None)
    monkeypatch.setattr(emitted_cache, "store", lambda *_: None)
    return fake


@pytest.fixture(autouse=True)
def in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SSSGEN_DEBUG", raising=False)
    Path("wax.toml").write_text(WAX, encoding="utf-8")
    return tmp_path


class Ran(NamedTuple):
    status: int
    out: str
    err: str


Run = Callable[..., Ran]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*arguments: str) -> Ran:
        status = cli.main(arguments)
        return Ran(status, *capsys.readouterr())

    return call


def folder_content(path: str = "out") -> dict[str, str]:
    return {one.name: one.read_text(encoding="utf-8") for one in sorted(Path(path).iterdir())}


# The frame


@pytest.mark.parametrize("arguments", [["--help"], ["emit", "--help"], ["--version"]])
def test_help_and_version(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main(arguments)
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith(("usage: sssgen", "sssgen 0."))


def test_help_and_emit_start_light() -> None:
    """What `--help` and reading a material import: nothing heavy."""
    code = """
import sys, sssgen.cli.emit, sssgen.cli.main, sssgen.material.material_loading
try:
    sssgen.cli.main.main(["--help"])
except SystemExit:
    print(sorted({"numpy", "lark", "jinja2", "json", "tomllib", "subprocess", "difflib"} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("name", cli.COMMANDS)
def test_the_help_of_every_command(name: str, run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        cli.main([name, "--help"])
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: sssgen {name} ")


@pytest.mark.parametrize("words", [["--", "list"], ["--json", "list"], ["-x"]])
def test_arguments_that_do_not_begin_with_a_command(words: list[str], run: Run) -> None:
    assert run(*words).status == cli.WRONG_INPUT


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("no_command", []),
        ("unknown_command", ["emmit"]),
        ("unknown_option", ["list", "targets", "--jsn"]),
        ("missing_arguments", ["emit"]),
        ("unknown_list", ["list", "technique"]),
        ("unknown_form", ["emit", "wax.toml", "-t", "wgsl", "-o", "out", "--form", "function"]),
        ("unknown_role", ["list", "techniques", "--role", "thicknes"]),
        ("role_of_targets", ["list", "targets", "--role", "thickness"]),
        ("unknown_technique", ["show", "lobe_normalised"]),
        ("missing_technique_file", ["show", "my/lobe.sss"]),
        ("unknown_targets", ["emit", "wax.toml", "-t", "wgls,glsl-330,zzz", "-o", "out"]),
        ("no_target", ["emit", "wax.toml", "-t", ",", "-o", "out"]),
        (
            "several_wrong",
            ["emit", "wx", "no.toml", "wax.toml", "-t", "wgls", "-o", "out", "--templates", "tpl"],
        ),
        ("missing_glsl", ["transpile", "no.glsl", "-t", "wgsl"]),
        ("transpile_to_all", ["transpile", "twice.glsl", "-t", "all"]),
        ("new_with_a_bad_name", ["new", "my wax"]),
        ("new_over_an_old_one", ["new", "wax"]),
        ("new_in_no_folder", ["new", "there/wood"]),
    ],
)
def test_wrong_arguments(name: str, arguments: list[str], run: Run, compiler: FakeCompiler) -> None:
    Path("twice.glsl").write_text(GLSL, encoding="utf-8")
    ran = run(*arguments)
    assert (ran.status, ran.out) == (2, "")
    check_snapshot(f"cli/arguments/{name}.txt", ran.err)
    as_json = run(*arguments, "--json")
    assert (as_json.status, as_json.err) == (2, "")
    said = json.loads(as_json.out)
    assert said["ok"] is False
    assert all(found["message"] in ran.err for found in said["diagnostics"])
    assert not Path("out").exists()


def fail(error: BaseException) -> Callable[[Any], int]:
    def run_command(_: Any) -> int:
        raise error

    return run_command


def test_an_internal_error_is_short(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(show, "run", fail(ZeroDivisionError("one\ntwo")))
    ran = run("show", "sphere")
    assert (ran.status, ran.err.count("\n")) == (cli.INTERNAL_ERROR, 2)
    assert ran.err.startswith("error: internal error: ZeroDivisionError one two\n")
    assert json.loads(run("show", "sphere", "--json").out)["ok"] is False
    monkeypatch.setenv("SSSGEN_DEBUG", "1")
    assert "Traceback" in run("show", "sphere").err


def test_ctrl_c(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(show, "run", fail(KeyboardInterrupt()))
    assert run("show", "sphere") == (130, "", "interrupted\n")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such pipes")
@pytest.mark.parametrize("arguments", [["list", "techniques"], ["show", "nothing", "--json"]])
def test_a_reader_that_goes_away_is_no_error(arguments: list[str]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "sssgen", *arguments], stdout=writing, stderr=subprocess.PIPE, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (cli.BROKEN_PIPE, b"")


def test_a_terminal_without_unicode() -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    done = subprocess.run(
        [sys.executable, "-m", "sssgen", "list", "techniques"],
        capture_output=True,
        env=environment,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")


# list, show, new


def test_list_techniques(run: Run) -> None:
    from sssgen.material import library

    rows = json.loads(run("list", "techniques", "--json").out)["techniques"]
    assert {row["name"] for row in rows} == set(library.index())
    assert all(row["summary"] for row in rows)
    text = run("list", "techniques", "--role", "conversion").out
    assert text.startswith("conversion\n")
    assert len(text.splitlines()) == 1 + sum(row["role"] == "conversion" for row in rows)


def test_list_materials_and_targets(run: Run, compiler: FakeCompiler) -> None:
    rows = json.loads(run("list", "materials", "--json").out)["materials"]
    assert "ice" in [row["name"] for row in rows]
    assert run("list", "targets").out == "  glsl-330  GLSL 3.30\n  wgsl      WGSL\n"


@pytest.mark.parametrize("name", ["beer_lambert", "thinness_uniform", "base_color"])
def test_show(name: str, run: Run) -> None:
    ran = run("show", name)
    assert (ran.status, ran.err) == (0, "")
    check_snapshot(f"cli/show/{name}.txt", ran.out)


def test_show_every_technique(run: Run) -> None:
    from sssgen.material import library

    for name in library.index():
        facts = json.loads(run("show", name, "--json").out)
        assert facts["ok"]
        assert facts["summary"]
        assert {"source"} <= facts["doc"].keys()


@pytest.mark.parametrize("argument", ["wood", "wood.toml", "sub/wood"])
def test_new(argument: str, run: Run) -> None:
    Path("sub").mkdir()
    ran = run("new", argument)
    path = Path(argument).with_suffix(".toml")
    assert ran == (0, f"wrote {path.as_posix()}\n", "")
    material = load_material(path)
    assert (material.name, material.title) == ("wood", "Wood")


def test_new_starts_with_what_its_comments_offer(run: Run) -> None:
    """Every line that is commented out can be used."""
    run("new", "wood")
    text = Path("wood.toml").read_text(encoding="utf-8")
    for line in text.splitlines():
        if line.startswith("# ") and (" = " in line or line.startswith("# [")):
            text = text.replace(line, line[2:])
    Path("wood.toml").write_text(text, encoding="utf-8")
    names = [stage.technique.name for stage in load_material("wood.toml").stages]
    assert names[0] == "parallax_refracted"


# emit


def test_emit(run: Run, compiler: FakeCompiler) -> None:
    ran = run("emit", "wax.toml", "--target", "wgsl,glsl-330,wgsl", "-o", "out/shaders")
    assert (ran.status, ran.err) == (0, "")
    assert compiler.asked == [("wax", "wgsl", "shader", None), ("wax", "glsl-330", "shader", None)]
    assert folder_content("out/shaders")["wax.wgsl.txt"] == "text 1\n"
    assert ran.out.splitlines() == [
        "wrote out/shaders/wax.wgsl.txt",
        "wrote out/shaders/wax.wgsl.reflection.json",
        "wrote out/shaders/wax.glsl-330.txt",
        "wrote out/shaders/wax.glsl-330.reflection.json",
    ]


def test_emit_all_as_json(run: Run, compiler: FakeCompiler) -> None:
    compiler.warnings = [Diagnostic("warning", "beware", Span("wax.toml", 1, 1, 1, 2))]
    Path("tpl").mkdir()
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out", "--form", "functions", "--templates", "tpl", "--json")
    said = json.loads(ran.out)
    assert (ran.status, ran.err, said["ok"], said["form"]) == (0, "", True, "functions")
    assert [(row["file"], row["target"]) for row in said["files"]][::2] == [
        ("out/wax.glsl-330.txt", "glsl-330"),
        ("out/wax.wgsl.txt", "wgsl"),
    ]
    assert [found["message"] for found in said["diagnostics"]] == ["beware"]
    assert compiler.asked[0] == ("wax", "glsl-330", "functions", "tpl")


def test_a_file_that_would_not_change_is_left_alone(run: Run, compiler: FakeCompiler) -> None:
    run("emit", "wax.toml", "-t", "wgsl", "-o", "out")
    before = Path("out/wax.wgsl.txt").stat().st_mtime_ns
    assert "kept  out/wax.wgsl.txt" in run("emit", "wax.toml", "-t", "wgsl", "-o", "out").out
    assert Path("out/wax.wgsl.txt").stat().st_mtime_ns == before


def test_warnings_are_beside_the_result(run: Run, compiler: FakeCompiler) -> None:
    compiler.warnings = [Diagnostic("warning", "beware", Span("wax.toml", 1, 1, 1, 2))]
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 0
    assert ran.err.count("warning: beware") == 1  # though two targets say it


def test_all_errors_of_all_materials_and_targets(run: Run, compiler: FakeCompiler) -> None:
    Path("bad.toml").write_text('[material]\nname = "bad"\n[surfac]\n', encoding="utf-8")
    compiler.failing = {"wgsl": failure("no such thing"), "glsl-330": failure("no such thing")}
    ran = run("emit", "bad.toml", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 2
    assert ran.err.count("no such thing") == 1
    assert "unknown section 'surfac'" in ran.err
    assert ran.err.endswith("3 errors\n")
    assert not Path("out").exists()


def test_two_materials_of_one_name(run: Run, compiler: FakeCompiler) -> None:
    Path("other.toml").write_text(WAX, encoding="utf-8")
    ran = run("emit", "wax.toml", "other.toml", "-t", "wgsl", "-o", "out")
    assert ran.status == 2
    assert "two materials are called 'wax'" in ran.err


def test_two_sources_of_one_file(run: Run, compiler: FakeCompiler) -> None:
    compiler.name = "{0}.txt"
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 2
    assert "'wax.txt' comes from wax for glsl-330 and from wax for wgsl" in ran.err


# Writing


def test_a_failed_emit_leaves_the_old_files_whole(run: Run, compiler: FakeCompiler) -> None:
    run("emit", "wax.toml", "-t", "all", "-o", "out")
    old = folder_content()
    compiler.text, compiler.failing = "text 2", {"wgsl": failure("no")}
    assert run("emit", "wax.toml", "-t", "all", "-o", "out").status == 2
    assert folder_content() == old


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("step", ["_write_bytes", "_replace"])
@pytest.mark.parametrize("at", [0, 1, 3])
def test_an_interrupted_emit_leaves_every_file_whole(
    error: BaseException,
    step: str,
    at: int,
    run: Run,
    compiler: FakeCompiler,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run("emit", "wax.toml", "-t", "all", "-o", "out")
    old = folder_content()
    for name in old:
        Path("out", name).write_text("old\n", encoding="utf-8")
    done: list[str] = []
    original = getattr(output, step)

    def interrupted(path: str, *arguments: Any) -> Any:
        if len(done) == at:
            if step == "_write_bytes":
                original(path, b"half")
            raise error
        done.append(path)
        return original(path, *arguments)

    with monkeypatch.context() as patched:
        patched.setattr(output, step, interrupted)
        ran = run("emit", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == (130 if isinstance(error, KeyboardInterrupt) else 2)
    after = folder_content()
    assert after.keys() == old.keys()  # no temporary file is left
    assert all(text in ("old\n", old[name]) for name, text in after.items())
    if step == "_write_bytes":
        assert set(after.values()) == {"old\n"}


@pytest.mark.parametrize(
    "name",
    [
        *("../x", "a/../../x", "/tmp/x", "..", "", " ", "a//b", "./x"),
        *("C:\\x", "C:x", "\\\\host\\x", "..\\x", "a\nb", "x.", "a:b"),
    ],
)
def test_names_that_climb_out_of_the_folder(name: str, run: Run, compiler: FakeCompiler) -> None:
    with pytest.raises(SssgenError, match="cannot write"):
        write_files(Path("out"), {"fine.txt": "", name: ""})
    compiler.name = name
    ran = run("emit", "wax.toml", "-t", "wgsl", "-o", "out")
    assert ran.status == 2
    assert "cannot write" in ran.err
    assert not Path("out").exists()
    assert sorted(Path().iterdir()) == [Path("wax.toml")]


def test_folders_that_cannot_be_written(run: Run, compiler: FakeCompiler, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("out/wax.wgsl.txt").mkdir(parents=True)
    texts = [
        run("emit", "wax.toml", "-t", "wgsl", "-o", "wax.toml").err,
        run("emit", "wax.toml", "-t", "wgsl", "-o", "wax.toml/deeper").err,
        run("emit", "wax.toml", "-t", "wgsl", "-o", "out").err,
    ]

    def refuse(path: str, *_: Any, **__: Any) -> None:
        raise PermissionError(13, "Permission denied", path)

    with monkeypatch.context() as patched:
        patched.setattr(os, "makedirs", refuse)
        texts.append(run("emit", "wax.toml", "-t", "wgsl", "-o", "locked").err)
    check_snapshot("cli/folders_that_cannot_be_written.txt", "\n".join(texts))


# transpile


def test_transpile(run: Run, compiler: FakeCompiler) -> None:
    Path("2 twice.glsl").write_text(GLSL, encoding="utf-8")
    assert run("transpile", "2 twice.glsl", "-t", "wgsl") == (0, "// file_2_twice: twice\n", "")
    assert run("transpile", "2 twice.glsl", "-t", "wgsl", "-o", "to/twice.wgsl") == (0, "", "")
    assert folder_content("to") == {
        "twice.wgsl": "// file_2_twice: twice\n",
        "twice.wgsl.reflection.json": "{}\n",
    }
    said = json.loads(run("transpile", "2 twice.glsl", "-t", "wgsl", "--json").out)
    assert said["texts"]["file_2_twice.wgsl.txt"] == "// file_2_twice: twice\n"


BAD_GLSL = {
    "recursion": "float f(float x);\nfloat g(float x) { return f(x); }\nfloat f(float x) { return g(x); }\n",
    "reserved_names": "float gl_half(float x) { return x; }\nfloat f(float gl_x) { return gl_x; }\n",
    "not_translated": "double f(double x) { return x; }\nuniform image2D picture;\n",
    "misspelt_names": "float f(vec2 uv) {\n    float x = distanse(uv, uv);\n    return length(uvv);\n}\n",
    "several_syntax_errors": "float f( { return 1.0; }\nfloat g() { return 2.0 }\n",
    "nesting_10000_deep": "float f() {\n    return " + "(" * 10_000 + "1.0" + ")" * 10_000 + ";\n}\n",
    "no_conversion": "int f() {\n    return 1.0;\n}\n",
    "in_a_macro": "#define HALF(x) (0.5 * undefined_name * (x))\nfloat f(float y) {\n    return 1.0 + HALF(y);\n}\n",
    "missing_include": '#include "nothing.sss"\nfloat f() { return 1.0; }\n',
}


@pytest.mark.parametrize("case", BAD_GLSL)
def test_errors_in_the_language(case: str, run: Run, compiler: FakeCompiler) -> None:
    Path("bad.glsl").write_text(BAD_GLSL[case], encoding="utf-8")
    ran = run("transpile", "bad.glsl", "-t", "wgsl")
    assert (ran.status, ran.out) == (2, "")
    check_snapshot(f"cli/language/{case}.txt", ran.err)


def test_a_file_that_is_no_text(run: Run, compiler: FakeCompiler) -> None:
    Path("bad.glsl").write_bytes(b"float f()\n\xff\xfe")
    Path("zero.glsl").write_bytes(b"float f()\n\x00")
    texts = [run("transpile", name, "-t", "wgsl").err for name in ("bad.glsl", "zero.glsl")]
    check_snapshot("cli/language/no_text.txt", "\n".join(texts))


# With the real compiler


def test_the_starter_emits_for_every_target(run: Run) -> None:
    from sssgen.pipeline.compiler import all_targets

    assert run("new", "wood").status == 0
    ran = run("emit", "wood.toml", "--target", "all", "-o", "out", "--json")
    said = json.loads(ran.out)
    assert (ran.status, said["diagnostics"]) == (0, [])
    assert {row["target"] for row in said["files"]} == set(all_targets())
    names = set(folder_content())
    assert {f"wood.{target}.reflection.json" for target in all_targets()} <= names


def test_transpile_for_every_target(run: Run) -> None:
    from sssgen.pipeline.compiler import all_targets

    Path("twice.glsl").write_text(GLSL, encoding="utf-8")
    for target in all_targets():
        ran = run("transpile", "twice.glsl", "-t", target)
        assert (ran.status, ran.err) == (0, "")
        assert "twice" in ran.out


def test_what_was_included_is_not_overwritten(run: Run) -> None:
    Path("lib.glsl").write_text("float twice(float x) { return x + x; }\n", encoding="utf-8")
    Path("own.glsl").write_text('#include "lib.glsl"\nfloat f(float x) { return twice(x); }\n', encoding="utf-8")
    ran = run("transpile", "own.glsl", "-t", "glsl-330", "-o", "lib.glsl")
    assert (ran.status, ran.out) == (2, "")
    assert "the output is what was read" in ran.err
    assert Path("lib.glsl").read_text(encoding="utf-8").startswith("float twice")


def test_prune_keeps_what_is_reached(run: Run) -> None:
    text = "uniform float far;\nconst float A = 1.0;\nstruct S { float x; };\nfloat g;\nfloat f() { return 1.0; }\n"
    Path("lib.glsl").write_text(text, encoding="utf-8")
    Path("own.glsl").write_text('#include "lib.glsl"\nfloat h(float x) { return x; }\n', encoding="utf-8")
    out = run("transpile", "own.glsl", "-t", "glsl-330", "--prune").out
    assert "float h(float x)" in out
    assert not any(word in out for word in ("far", "const", "struct", "float g", "float f("))


def test_renamed_is_what_the_language_reserves(run: Run) -> None:
    Path("own.glsl").write_text("float half4(float half) { return half; }\n", encoding="utf-8")
    assert "renamed: half4 → half4_ (hlsl reserves it)" in run("transpile", "own.glsl", "-t", "unity-urp").err
    assert "float half4_(float half_)" in run("transpile", "own.glsl", "-t", "unity-urp").out
    assert run("transpile", "own.glsl", "-t", "glsl-330").out.count("half4_") == 0


def test_a_technique_has_the_name_that_its_text_has(run: Run) -> None:
    text = "// Half of it.\nfloat half(float x) { return x * 0.5; }\nfloat g(float x) { return half(x); }\n"
    Path("own.glsl").write_text(text, encoding="utf-8")
    ran = run("transpile", "own.glsl", "--as", "technique", "--function", "half", "-o", ".")
    assert (ran.status, ran.out) == (0, "wrote half_.sss\n")
    written = Path("half_.sss").read_text(encoding="utf-8")
    assert " * Half of it.\n" in written
    assert written.endswith("float half_(float x) {\n    return x * 0.5;\n}\n")


def test_what_a_void_return_does_is_done_once(run: Run) -> None:
    text = "void add(int k);\nvoid add(int k) {}\nvoid f(inout int k) { return add(k++); }\n"
    Path("own.glsl").write_text(text, encoding="utf-8")
    assert run("transpile", "own.glsl", "-t", "glsl-330").out.count("k++") == 1
