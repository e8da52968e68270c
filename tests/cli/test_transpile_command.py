"""`sssgen transpile` as a command, and commands with the real compiler."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from command_line import GLSL, FakeCompiler, Run, folder_content
from snapshot import check_snapshot


def test_transpile(run: Run, compiler: FakeCompiler) -> None:
    Path("2 twice.glsl").write_text(GLSL, encoding="utf-8")
    assert run("transpile", "2 twice.glsl", "-t", "wgsl") == (0, "// file_2_twice: twice\n", "")
    assert run("transpile", "2 twice.glsl", "-t", "wgsl", "-o", "to/twice.wgsl") == (0, "", "")
    assert folder_content("to") == {
        "twice.wgsl": "// file_2_twice: twice\n",
        "twice.wgsl.reflection.json": "{}\n",
    }
    report = json.loads(run("transpile", "2 twice.glsl", "-t", "wgsl", "--json").out)
    assert report["texts"]["file_2_twice.wgsl.txt"] == "// file_2_twice: twice\n"


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


@pytest.mark.parametrize("text", ["", "// a comment\n", "#ifdef NEVER\nfloat f() { return 1.0; }\n#endif\n"])
@pytest.mark.parametrize("option", ["--target=wgsl", "--verify", "--as=technique"])
def test_a_file_with_nothing_is_an_error(text: str, option: str, run: Run, compiler: FakeCompiler) -> None:
    Path("empty.glsl").write_text(text, encoding="utf-8")
    status, out, err = run("transpile", "empty.glsl", option)
    assert (status, out) == (2, "") and "there is nothing to translate in the file" in err and "empty.glsl" in err


def test_a_file_that_is_no_text(run: Run, compiler: FakeCompiler) -> None:
    Path("bad.glsl").write_bytes(b"float f()\n\xff\xfe")
    Path("zero.glsl").write_bytes(b"float f()\n\x00")
    texts = [run("transpile", name, "-t", "wgsl").err for name in ("bad.glsl", "zero.glsl")]
    check_snapshot("cli/language/no_text.txt", "\n".join(texts))


# With the real compiler


def test_a_file_of_an_older_editor_is_windows_1252(run: Run) -> None:
    Path("part.glsl").write_bytes("// Größe “x”\nfloat part(float x) { return x; }\n".encode("windows-1252"))
    Path("old.glsl").write_text('#include "part.glsl"\nfloat f(float x) { return part(x); }\n', encoding="utf-8")
    for name in ("part.glsl", "old.glsl"):
        ran = run("transpile", name, "-t", "wgsl")
        assert ran.status == 0 and "// Größe “x”" in ran.out


def test_the_starter_emits_for_every_target(run: Run) -> None:
    from sssgen.pipeline.compiler import all_targets

    assert run("new", "wood").status == 0
    ran = run("emit", "wood.toml", "--target", "all", "-o", "out", "--json")
    report = json.loads(ran.out)
    assert (ran.status, report["diagnostics"]) == (0, [])
    assert {row["target"] for row in report["files"]} == set(all_targets())
    names = set(folder_content())
    assert {f"wood.{target}.reflection.json" for target in all_targets()} <= names


def test_transpile_for_every_target(run: Run) -> None:
    from sssgen.pipeline.compiler import all_targets

    Path("twice.glsl").write_text(GLSL, encoding="utf-8")
    for target in all_targets():
        ran = run("transpile", "twice.glsl", "-t", target)
        assert (ran.status, ran.err) == (0, "")
        assert "twice" in ran.out


def test_included_files_are_not_overwritten(run: Run) -> None:
    Path("lib.glsl").write_text("float twice(float x) { return x + x; }\n", encoding="utf-8")
    Path("own.glsl").write_text('#include "lib.glsl"\nfloat f(float x) { return twice(x); }\n', encoding="utf-8")
    ran = run("transpile", "own.glsl", "-t", "glsl-330", "-o", "lib.glsl")
    assert (ran.status, ran.out) == (2, "")
    assert "the output file is also an input file" in ran.err
    assert Path("lib.glsl").read_text(encoding="utf-8").startswith("float twice")


def test_prune_keeps_reachable_declarations(run: Run) -> None:
    text = "uniform float far;\nconst float A = 1.0;\nstruct S { float x; };\nfloat g;\nfloat f() { return 1.0; }\n"
    Path("lib.glsl").write_text(text, encoding="utf-8")
    Path("own.glsl").write_text('#include "lib.glsl"\nfloat h(float x) { return x; }\n', encoding="utf-8")
    out = run("transpile", "own.glsl", "-t", "glsl-330", "--prune").out
    assert "float h(float x)" in out
    assert not any(word in out for word in ("far", "const", "struct", "float g", "float f("))


def test_reserved_names_are_renamed(run: Run) -> None:
    Path("own.glsl").write_text("float half4(float half) { return half; }\n", encoding="utf-8")
    assert "renamed: half4 → half4_ (hlsl reserves it)" in run("transpile", "own.glsl", "-t", "unity-urp").err
    assert "float half4_(float half_)" in run("transpile", "own.glsl", "-t", "unity-urp").out
    assert run("transpile", "own.glsl", "-t", "glsl-330").out.count("half4_") == 0


def test_a_technique_has_the_name_of_its_emitted_function(run: Run) -> None:
    text = "// Half of it.\nfloat half(float x) { return x * 0.5; }\nfloat g(float x) { return half(x); }\n"
    Path("own.glsl").write_text(text, encoding="utf-8")
    ran = run("transpile", "own.glsl", "--as", "technique", "--function", "half", "-o", ".")
    assert (ran.status, ran.out) == (0, "wrote half_.sss\n")
    written = Path("half_.sss").read_text(encoding="utf-8")
    assert " * Half of it.\n" in written
    assert written.endswith("float half_(float x) {\n    return x * 0.5;\n}\n")


def test_a_void_return_is_evaluated_once(run: Run) -> None:
    text = "void add(int k);\nvoid add(int k) {}\nvoid f(inout int k) { return add(k++); }\n"
    Path("own.glsl").write_text(text, encoding="utf-8")
    assert run("transpile", "own.glsl", "-t", "glsl-330").out.count("k++") == 1
