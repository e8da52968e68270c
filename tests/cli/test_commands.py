"""The command line: the output, files, exit status and error messages of each command."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from command_line import GLSL, WAX, FakeCompiler, Run, folder_content
from snapshot import check_snapshot
from sssgen.cli import main as cli
from sssgen.cli import show
from sssgen.ir.nodes import Span
from sssgen.material.material_loading import load_material
from sssgen.support import file_writer as output
from sssgen.support.diagnostics import Diagnostic, SssgenError, failure
from sssgen.support.file_writer import write_files

# The frame


@pytest.mark.parametrize("words", [["--", "list"], ["--json", "list"], ["-x"]])
def test_arguments_that_do_not_begin_with_a_command(words: list[str], run: Run) -> None:
    assert run(*words).status == cli.WRONG_INPUT


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("unknown_command", ["emmit"]),
        ("unknown_command_of_help", ["help", "emmit"]),
        ("unknown_texture_of_help", ["help", "bake", "thicknes"]),
        ("option_before_the_command", ["--guards", "all", "emit"]),
        ("unknown_option", ["list", "targets", "--jsn"]),
        ("missing_arguments", ["emit"]),
        ("unknown_list", ["list", "technique"]),
        ("unknown_form", ["emit", "wax.toml", "-t", "wgsl", "-o", "out", "--form", "function"]),
        ("no_folder", ["emit", "wax.toml", "-t", "wgsl", "-o", ""]),
        ("no_prefix", ["emit", "wax.toml", "-t", "wgsl", "-o", "out", "--form", "functions", "--prefix", ""]),
        ("no_file", ["transpile", "twice.glsl", "-t", "wgsl", "-o", " "]),
        ("technique_beside", ["show", "beside"]),
        ("unknown_name", ["show", "nomalise"]),
        ("another_name_of_a_target", ["show", "hdrp"]),
        ("unlike_any_name", ["show", "zzz"]),
        ("unknown_target_of_show", ["show", "--kind", "target", "unity-upr"]),
        ("unknown_scene_of_show", ["show", "--kind", "scene", "cub"]),
        ("unknown_builtin_of_show", ["show", "--kind", "builtin", "nrmalize"]),
        ("unknown_backend_of_show", ["show", "--kind", "backend", "webgp"]),
        ("unknown_medium_of_show", ["show", "--kind", "medium", "marbl"]),
        ("missing_toml_of_show", ["show", "no.toml"]),
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
        ("option_as_a_command", ["version"]),
        ("no_number", ["pick", "cube", "--max-error", "abc"]),
        ("no_whole_number", ["chart", "cube", "--samples", "1.5"]),
        ("verify_with_a_target", ["transpile", "twice.glsl", "--verify", "-t", "metal"]),
        ("technique_with_a_target", ["transpile", "twice.glsl", "--as", "technique", "-t", "wgsl"]),
        ("new_with_a_bad_name", ["new", "my wax"]),
        ("new_over_an_old_one", ["new", "wax"]),
        ("new_in_no_folder", ["new", "there/wood"]),
    ],
)
def test_wrong_arguments(name: str, arguments: list[str], run: Run, compiler: FakeCompiler) -> None:
    Path("twice.glsl").write_text(GLSL, encoding="utf-8")
    Path("beside.sss").write_text("", encoding="utf-8")
    ran = run(*arguments)
    assert (ran.status, ran.out) == (2, "")
    check_snapshot(f"cli/arguments/{name}.txt", ran.err)
    as_json = run(*arguments, "--json")
    assert (as_json.status, as_json.err) == (2, "")
    report = json.loads(as_json.out)
    assert report["ok"] is False
    assert all(result["message"] in ran.err for result in report["diagnostics"])
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
def test_a_closed_pipe_is_no_error(arguments: list[str]) -> None:
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


# list, new


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
    scenes = json.loads(run("list", "scenes", "--json").out)["scenes"]
    assert {"ice", "cube"} <= {row["name"] for row in scenes}
    assert all(row["summary"].endswith(".") for row in scenes)
    assert "normalize" in run("list", "builtins").out
    assert "unity-urp" in run("list", "backends").out
    assert run("list", "targets").out == "  glsl-330  GLSL 3.30\n  wgsl      WGSL\n"


@pytest.mark.parametrize("argument", ["wood", "wood.toml", "sub/wood"])
def test_new(argument: str, run: Run) -> None:
    Path("sub").mkdir()
    ran = run("new", argument)
    path = Path(argument).with_suffix(".toml")
    assert ran == (0, f"wrote {path.as_posix()}\n", "")
    material = load_material(path)
    assert (material.name, material.title) == ("wood", "Wood")


def test_the_comments_of_a_new_material_are_valid(run: Run) -> None:
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
    assert compiler.calls == [("wax", "wgsl", "shader", None), ("wax", "glsl-330", "shader", None)]
    assert folder_content("out/shaders")["wax.wgsl.txt"] == "text 1\n"
    assert ran.out.splitlines() == [
        "wrote out/shaders/wax.wgsl.txt",
        "wrote out/shaders/wax.wgsl.reflection.json",
        "wrote out/shaders/wax.glsl-330.txt",
        "wrote out/shaders/wax.glsl-330.reflection.json",
        "wax requires a texture that is baked from the body (transmittance_texture)",
    ]


def test_emit_all_as_json(run: Run, compiler: FakeCompiler) -> None:
    compiler.warnings = [Diagnostic("warning", "beware", Span("wax.toml", 1, 1, 1, 2))]
    Path("tpl").mkdir()
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out", "--form", "functions", "--templates", "tpl", "--json")
    report = json.loads(ran.out)
    assert (ran.status, ran.err, report["ok"], report["form"]) == (0, "", True, "functions")
    assert [(row["file"], row["target"]) for row in report["files"]][::2] == [
        ("out/wax.glsl-330.txt", "glsl-330"),
        ("out/wax.wgsl.txt", "wgsl"),
    ]
    assert [result["message"] for result in report["diagnostics"]] == ["beware"]
    assert compiler.calls[0] == ("wax", "glsl-330", "functions", "tpl")


def test_emit_without_target_and_folder(run: Run, compiler: FakeCompiler) -> None:
    ran = run("emit", "wax.toml")
    assert (ran.status, ran.err) == (0, "the target is glsl-330; --target chooses others (sssgen list targets)\n")
    assert list(folder_content()) == ["wax.glsl-330.reflection.json", "wax.glsl-330.txt"]
    assert run("emit", "wax.toml", "--json").err == ""


def test_emit_to_the_standard_output(run: Run, compiler: FakeCompiler) -> None:
    """One text alone, several after their names; the reflections only as JSON; nothing is written."""
    assert run("emit", "wax.toml", "-t", "wgsl", "-o", "-") == (0, "text 1\n", "")
    several = "// wax.glsl-330.txt\ntext 1\n\n// wax.wgsl.txt\ntext 1\n"
    assert run("emit", "wax.toml", "-t", "all", "-o", "-") == (0, several, "")
    report = json.loads(run("emit", "wax.toml", "-t", "wgsl", "-o", "-", "--json").out)
    assert [(row["file"], row["target"], row["text"]) for row in report["files"]] == [
        ("wax.wgsl.txt", "wgsl", "text 1\n"),
        ("wax.wgsl.reflection.json", "wgsl", "{}\n"),
    ]
    assert "--trace writes files" in run("emit", "wax.toml", "-o", "-", "--trace").err
    compiler.failing = {"wgsl": failure("no such thing")}
    ran = run("emit", "wax.toml", "-t", "all", "-o", "-")
    assert (ran.status, ran.out) == (2, "")
    assert sorted(Path().iterdir()) == [Path("wax.toml")]


def test_a_file_that_would_not_change_is_left_alone(run: Run, compiler: FakeCompiler) -> None:
    run("emit", "wax.toml", "-t", "wgsl", "-o", "out")
    before = Path("out/wax.wgsl.txt").stat().st_mtime_ns
    assert "kept  out/wax.wgsl.txt" in run("emit", "wax.toml", "-t", "wgsl", "-o", "out").out
    assert Path("out/wax.wgsl.txt").stat().st_mtime_ns == before


def test_warnings_do_not_change_the_result(run: Run, compiler: FakeCompiler) -> None:
    compiler.warnings = [Diagnostic("warning", "beware", Span("wax.toml", 1, 1, 1, 2))]
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 0
    assert ran.err.count("warning: beware") == 1  # although two targets report it


def test_all_errors_of_all_materials_and_targets(run: Run, compiler: FakeCompiler) -> None:
    Path("bad.toml").write_text('[material]\nname = "bad"\n[surfac]\n', encoding="utf-8")
    compiler.failing = {"wgsl": failure("no such thing"), "glsl-330": failure("no such thing")}
    ran = run("emit", "bad.toml", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 1
    assert ran.err.count("no such thing") == 1
    assert "unknown section 'surfac'" in ran.err
    assert ran.err.endswith("3 errors\n")
    assert not Path("out").exists()


def test_two_materials_of_one_name(run: Run, compiler: FakeCompiler) -> None:
    """Both files are named and neither is written; the other materials are."""
    Path("other.toml").write_text(WAX, encoding="utf-8")
    Path("ice.toml").write_text(WAX.replace('"wax"', '"ice"'), encoding="utf-8")
    ran = run("emit", "wax.toml", "ice.toml", "other.toml", "-t", "wgsl", "-o", "out")
    assert ran.status == 1
    assert "2 materials are called 'wax', in wax.toml and other.toml" in ran.err
    assert sorted(path.name for path in Path("out").iterdir()) == ["ice.wgsl.reflection.json", "ice.wgsl.txt"]
    report = json.loads(run("emit", "wax.toml", "other.toml", "ice.toml", "-t", "wgsl", "-o", "out", "--json").out)
    assert report["ok"] is False and report["requires"].keys() == {"ice"} and len(report["files"]) == 2
    assert "wax.toml and other.toml" in report["diagnostics"][0]["message"]
    assert run("emit", "wax.toml", "other.toml", "-t", "wgsl", "-o", "none").status == 1 and not Path("none").exists()


def test_one_file_named_twice_is_one_material(run: Run, compiler: FakeCompiler) -> None:
    ran = run("emit", "wax.toml", str(Path("wax.toml").absolute()), "./wax.toml", "-t", "wgsl", "-o", "out")
    assert ran.status == 0 and len(compiler.calls) == 1


@pytest.mark.parametrize("output", ["out", "-"])
def test_a_faulty_material_does_not_stop_the_others(output: str, run: Run, compiler: FakeCompiler) -> None:
    """Whether it cannot be read or cannot be compiled for one target: then none of its files are written."""
    Path("bad.toml").write_text('[material]\nname = "bad"\n[surfac]\n', encoding="utf-8")
    Path("ice.toml").write_text(WAX.replace('"wax"', '"ice"'), encoding="utf-8")
    compiler.refused = {("ice", "wgsl")}
    ran = run("emit", "bad.toml", "ice.toml", "wax.toml", "missing.toml", "-t", "all", "-o", output)
    assert ran.status == 1 and ran.err.endswith("4 errors\n") and "Traceback" not in ran.err
    assert "unknown section 'surfac'" in ran.err and "ice is refused" in ran.err and "missing.toml" in ran.err
    written = ran.out if output == "-" else " ".join(path.name for path in Path(output).iterdir())
    assert "wax.wgsl.txt" in written and "wax.glsl-330.txt" in written and "ice" not in written


def test_two_sources_of_one_file(run: Run, compiler: FakeCompiler) -> None:
    compiler.name = "{0}.txt"
    ran = run("emit", "wax.toml", "-t", "all", "-o", "out")
    assert ran.status == 2
    assert "'wax.txt' comes from wax for glsl-330 and from wax for wgsl" in ran.err


# Writing


def test_a_failed_emit_keeps_the_old_files(run: Run, compiler: FakeCompiler) -> None:
    run("emit", "wax.toml", "-t", "all", "-o", "out")
    old = folder_content()
    compiler.text, compiler.failing = "text 2", {"wgsl": failure("no")}
    assert run("emit", "wax.toml", "-t", "all", "-o", "out").status == 2
    assert folder_content() == old


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("step", ["_write_bytes", "_replace"])
@pytest.mark.parametrize("at", [0, 1, 3])
def test_an_interrupted_emit_writes_atomically(
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
