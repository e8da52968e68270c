"""`sssgen check`: the files that it accepts, its messages, and their places in the technique."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from command_line import Run
from folders import UNITY_SAMPLES
from sssgen.cli import check as check_command
from sssgen.run import machine_parts
from sssgen.run.backend_registry import BACKENDS, ENGINES
from sssgen.run.check import compile_check as check
from sssgen.run.check.shader_files import of_files, of_material, read
from sssgen.run.compiler_registry import COMPILERS
from sssgen.run.compilers import Compiler, Source
from sssgen.run.compilers.compiler_process import Worker
from sssgen.run.compilers.unity_compiler import STANDIN
from sssgen.support.file_writer import write_files

FRAGMENT = "in vec2 v_uv;\nout vec4 color;\nvoid main() {\n    color = vec4(v_uv, 0.0, 1.0);\n}\n"
HLSL = """\
struct Varyings { float4 position : SV_Position; float2 uv : TEXCOORD0; };
Varyings place(float3 position : POSITION) {
    Varyings made;
    made.position = float4(position, 1.0);
    made.uv = position.xy;
    return made;
}
float4 tint(float2 uv) { return float4(uv, 0.0, 1.0); }
float4 shade(Varyings input) : SV_Target { return tint(input.uv); }
"""
WGSL = "@fragment fn shade() -> @location(0) vec4<f32> {\n    return vec4<f32>(1.0);\n}\n"


pytestmark = pytest.mark.usefixtures("in_folder", "outside_ci")


def write(files: dict[str, str]) -> None:
    write_files(".", files)


def emitted(target: str, form: str = "shader") -> dict[str, str]:
    from sssgen.pipeline.compiler import compile

    return compile("ice", target, form).files


def program(name: str, script: str) -> str:
    """Writes a program that imitates a faulty compiler."""
    path = Path(name)
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path.resolve())


# Correct files


def test_handwritten_files_in_every_language(run: Run, compiler: Callable[[str], Compiler]) -> None:
    for name in ("gl", "glslang", "dxc", "naga", "tint"):
        compiler(name)
    write({"a.frag": FRAGMENT, "a.hlsl": HLSL, "a.wgsl": WGSL, "f.glsl": "float f(float x) { return x; }\n"})
    ran = run("check", "a.frag", "a.hlsl", "a.wgsl", "f.glsl", "--json")
    assert ran.status == 0, ran.out
    assert ran.data["missing"] == []
    rows = {(row["file"], row["stage"], row["compiler"]) for row in ran.data["results"]}
    assert rows == {
        ("a.frag", "fragment", "gl"), ("a.frag", "fragment", "glslang"),
        ("f.glsl", "library", "gl"), ("f.glsl", "library", "glslang"),
        ("a.hlsl", "vertex", "glslang"), ("a.hlsl", "vertex", "dxc"),
        ("a.hlsl", "fragment", "glslang"), ("a.hlsl", "fragment", "dxc"),
        ("a.wgsl", "fragment", "naga"), ("a.wgsl", "fragment", "tint"),
    }  # fmt: skip


def test_a_material_in_both_forms(run: Run, compiler: Callable[[str], Compiler]) -> None:
    compiler("glslang")
    ran = run("check", "ice", "--target", "glsl-330", "-t", "hlsl", "--compiler", "glslang", "--json")
    assert ran.status == 0
    assert set(ran.data) == {"ok", "compilers", "missing", "engines", "results", "not_compiled"}
    assert ran.data["compilers"][0]["name"] == "glslang"
    assert {row["file"] for row in ran.data["results"]} == {
        "ice.glsl-330.vert", "ice.glsl-330.frag", "ice.glsl-330.glsl", "ice.hlsl", "ice.functions.hlsl",
    }  # fmt: skip
    assert all(row["ok"] and row["messages"] == [] for row in ran.data["results"])


def test_a_material_is_checked_for_every_target_with_a_compiler() -> None:
    results = {source.language for shader in of_material("ice", ()) for source in shader.sources}
    assert results == {language for record in COMPILERS.values() for language in record.languages}


def test_a_folder_selects_its_shaders(run: Run) -> None:
    write({**emitted("numpy"), "sub/b.py": "x = \n", "sub/README.md": "# no shader\n", ".hidden/c.frag": "no"})
    ran = run("check", ".")
    assert ran.status == 0
    assert "ok   ice.py  python" in ran.out
    assert "1 files, 1 compilations, 0 failed" in ran.out


def test_languages_by_text_and_by_target() -> None:
    es = f"#version 300 es\nprecision highp float;\n{FRAGMENT}"
    urp = '#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Common.hlsl"\n'
    shader = 'Shader "A/B" { SubShader { } }\n'
    files = {
        "a.frag": FRAGMENT,
        "e.frag": es,
        "u.hlsl": urp,
        "s.shader": shader,
        "c.cginc": "float f() { return 1; }\n",
    }

    def languages(*targets: str) -> dict[str, str]:
        return {shader_file.name: shader_file.sources[0].language for shader_file in of_files(files, set(), targets)}

    builtin = {"s.shader": "unity-builtin", "c.cginc": "unity-builtin"}
    assert languages() == {"a.frag": "glsl-330", "e.frag": "glsl-es-300", "u.hlsl": "unity-urp", **builtin}
    assert languages("glsl-es-300") == {"a.frag": "glsl-es-300", "e.frag": "glsl-es-300"}
    assert of_files({"x.txt": FRAGMENT}, {"x.txt"}, ["glsl-es-300"])[0].sources[0].language == "glsl-es-300"


# Files with errors


@pytest.mark.parametrize(
    ("name", "text", "right", "wrong", "places"),
    [
        ("a.frag", FRAGMENT, "vec4(v_uv,", "vec4(nowhere,", {"gl": (4, 18), "glslang": (4, 0)}),
        ("a.hlsl", HLSL, "float4(uv,", "float4(nowhere,", {"glslang": (8, 0), "dxc": (8, 40)}),
        ("a.wgsl", WGSL, "(1.0)", "(nowhere)", {"naga": (2, 22), "tint": (2, 22)}),
    ],
)
def test_an_error_at_its_line_and_column(
    name: str,
    text: str,
    right: str,
    wrong: str,
    places: dict[str, tuple[int, int]],
    run: Run,
    compiler: Callable[[str], Compiler],
) -> None:
    for needed in places:
        compiler(needed)
    assert right in text
    write({name: text.replace(right, wrong)})
    ran = run("check", name, "--json")
    assert ran.status == 1
    rows = [row for row in ran.data["results"] if row["compiler"] in places]
    assert {row["compiler"] for row in rows} == set(places)
    for row in rows:
        assert not row["ok"]
        first = row["messages"][0]
        assert (first["line"], first["column"]) == places[row["compiler"]], row
        assert (first["severity"], "nowhere" in first["text"], "source" in first) == ("error", True, False)


@pytest.mark.parametrize(
    ("target", "form", "name", "compiler_name"),
    [
        ("wgsl", "shader", "ice.wgsl", "tint"),
        ("hlsl", "functions", "ice.functions.hlsl", "glslang"),
        ("unity-builtin", "shader", "ice.unity-builtin.shader", "unity"),
        ("unity-urp", "shader", "ice.unity-urp.shader", "unity"),
    ],
)
def test_an_error_in_an_edited_file_leads_to_the_technique(
    target: str, form: str, name: str, compiler_name: str, run: Run, compiler: Callable[[str], Compiler]
) -> None:
    compiler(compiler_name)
    files = emitted(target, form)
    lines = files[name].split("\n")
    number = next(number for number, line in enumerate(lines, 1) if "return exp(-min(" in line)
    files[name] = files[name].replace("return exp(-min(", "return nowhere(-min(")
    write({f"out/{file}": text for file, text in files.items()})
    ran = run("check", "out", "--compiler", compiler_name, "--json")
    assert ran.status == 1
    message = next(m for row in ran.data["results"] for m in row["messages"])
    assert message["line"] == number
    assert message["source"].startswith("conversion/beer_lambert.sss:")
    output = run("check", f"out/{name}", "--compiler", compiler_name).out
    assert f"--> out/{name}:{number}" in output
    assert f"from {message['source']}" in output
    assert "return transmittance(exp(" in output


def test_a_material_leads_to_the_technique_without_files(compiler: Callable[[str], Compiler]) -> None:
    from dataclasses import replace

    compiler("glslang")
    shader = next(shader_file for shader_file in of_material("ice", ["glsl-330"]) if shader_file.name.endswith(".frag"))
    text = shader.text.replace("return exp(-min(", "return nowhere(-min(")
    broken = replace(shader, text=text, sources=tuple(source.with_text(text) for source in shader.sources))
    (result,) = check.run([broken], ["glslang"]).results
    assert result.origin(result.messages[0]).startswith("conversion/beer_lambert.sss:")


def test_an_error_in_the_other_stage_names_that_stage(run: Run, compiler: Callable[[str], Compiler]) -> None:
    compiler("gl")
    files = emitted("glsl-330")
    files["ice.glsl-330.vert"] = files["ice.glsl-330.vert"].replace("gl_Position =", "gl_Nowhere =")
    write(files)
    ran = run("check", ".", "--compiler", "gl", "--json")
    assert {row["file"]: row["ok"] for row in ran.data["results"]} == {
        "ice.glsl-330.frag": True,
        "ice.glsl-330.vert": False,
    }


def test_an_error_outside_of_the_file_has_no_line(compiler: Callable[[str], Compiler]) -> None:
    unity = compiler("unity")
    text = (UNITY_SAMPLES / "surface.shader").read_text(encoding="utf-8")
    assert not unity.check(Source(text, "unity-builtin", name='a "quoted": name.shader'))
    result = unity.check(Source(text.replace("LightingBacklit_GI", "LightingOther_GI"), "unity-builtin"))
    assert any("surface entries:" in message.text for message in result), result
    assert all(not message.line for message in result)


# Missing and faulty compilers


def test_a_missing_compiler_is_reported(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    write({"a.wgsl": WGSL})
    monkeypatch.setenv("SSSGEN_NODE_MODULES", "nowhere")
    ran = run("check", "a.wgsl", "--json")
    assert [row["name"] for row in ran.data["missing"]][-1] == "tint"
    assert "webgpu" in ran.data["missing"][-1]["how"] or "node" in ran.data["missing"][-1]["how"]
    result_without = run("check", "a.wgsl")
    assert "tint     not found: " in result_without.out
    assert result_without.status == ran.status
    monkeypatch.setenv("CI", "true")
    assert run("check", "a.wgsl").status == 1
    named = run("check", "a.wgsl", "--compiler", "tint")
    assert (named.status, named.out) == (2, "")
    assert "error: tint is not available\n  help: " in named.err


def test_engines_are_named_and_none_is_started(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each with how to get it where its program or its package is missing."""
    families = ("threejs", "babylonjs", "playcanvas", "godot", "firefox", "bevy", "metal", "unreal", "tsl")
    scenes = {name for name, record in BACKENDS.items() if record.scenes_only}
    assert scenes | {*families, "tsl-webgl2"} == set(ENGINES)
    write({"a.py": "x = 1\n"})
    for variable in ("SSSGEN_NODE_MODULES", "SSSGEN_CHROMIUM", "SSSGEN_FIREFOX", "SSSGEN_GODOT", "PATH"):
        monkeypatch.setenv(variable, "nowhere")
    monkeypatch.setattr(machine_parts, "folder", Path)
    rows = {row["name"]: row for row in run("check", "a.py", "--json").data["engines"]}
    assert [*rows] == [*ENGINES]
    assert not any(row["found"] for name, row in rows.items())
    needs = {
        "threejs": "Chromium.*npm package three", "babylonjs": "Chromium.*@babylonjs/core",
        "playcanvas": "Chromium.*npm package playcanvas", "godot": "make .*engines", "firefox": "firefox-esr",
        "bevy": "node.*npm package webgpu.*npm package wesl", "metal": r"g\+\+", "unreal": "spirv-cross",
        "tsl": "Chromium.*npm package three",
    }  # fmt: skip
    for name, row in rows.items():
        assert re.search(needs[name.partition("-")[0]], row["how"]), row
    for text in (
        "threejs, threejs-webgl, threejs-webgl2, tsl, tsl-webgl2: not found: ",
        "metal: not found: g++ (Debian: g++)\n",
    ):
        assert text in run("check", "a.py").out


@pytest.mark.skipif(os.name != "posix", reason="the programs are shell scripts")
def test_an_engine_is_found_by_its_files_alone(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("websockets")
    write({"a.py": "x = 1\n", "packages/three/package.json": "{}"})
    for browser in ("chromium", "firefox"):
        monkeypatch.setenv(f"SSSGEN_{browser.upper()}", program(browser, f"touch {Path.cwd()}/started"))
    monkeypatch.setenv("SSSGEN_NODE_MODULES", "packages")
    rows = {row["name"]: row["found"] for row in run("check", "a.py", "--json").data["engines"]}
    assert (rows["threejs"], rows["threejs-webgl"], rows["firefox"], rows["playcanvas"]) == (True, True, True, False)
    assert "firefox" in run("check", "a.py").out.partition(": found")[0].splitlines()[-1]
    assert not Path("started").exists()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="the system that `make engines` sets up needs root")
def test_the_godot_that_is_named_is_the_only_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """As with the browsers; else the path comes first, then the system that `make engines` sets up."""
    write({"build/engines/godot/usr/bin/godot": ""})
    monkeypatch.setattr(machine_parts, "folder", lambda name: Path(name).resolve())
    system = [("godot", str(Path("build/engines/godot").resolve()))]
    monkeypatch.delenv("SSSGEN_GODOT", raising=False)
    monkeypatch.setenv("PATH", "nowhere")
    assert machine_parts.godots() == system
    own = program("own", "true")
    monkeypatch.setenv("PATH", str(Path(program("godot4", "true")).parent))
    (on_path, root), *others = machine_parts.godots()
    assert (Path(on_path).name, root, others) == ("godot4", "", system)
    monkeypatch.setenv("SSSGEN_GODOT", own)
    assert machine_parts.godots() == [(own, "")]
    for missing in ("none", "godot", "/nowhere/godot"):
        monkeypatch.setenv("SSSGEN_GODOT", missing)
        assert machine_parts.godots() == []
    assert "SSSGEN_GODOT" in machine_parts.lacks("godot")


def test_a_check_without_a_compilation_fails(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    write({"a.hlsl": HLSL, "a.shader": 'Shader "A/B" { }\n'})
    monkeypatch.setenv("PATH", "nowhere")
    monkeypatch.setenv("SSSGEN_GLSLANG", "nowhere")
    ran = run("check", "a.shader")
    assert ran.status == 1
    assert "not compiled: unity not found" in ran.out
    summary = ran.out.partition("\n\n1 files, ")[2].split("\n")
    assert summary[:2] == ["0 compilations, 0 failed, 1 not compiled", "  1 file: unity not found"]
    assert summary[2].startswith("  to get unity: ") and summary[3:] == [""]
    assert run("check", "a.shader", "--json").data["not_compiled"] == {"a.shader": "unity not found"}


def test_many_files_are_counted_and_only_failures_are_listed(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check_command, "LISTED", 3)
    monkeypatch.setenv("SSSGEN_GODOT", "nowhere")
    names = ["m0.py", "m1.py", "m2.py"]
    write(dict.fromkeys(names, "x = 1\n"))
    few = run("check", *names).out
    assert few.count("\nok   ") == 3 and "--verbose" not in few
    write({"bad.py": "x = \n", "a.gdshader": "shader_type spatial;\n"})
    names += ["bad.py", "a.gdshader"]
    many = run("check", *names).out
    assert "\nok   " not in many and "\n--   " not in many
    assert "\nFAIL bad.py" in many and "\n3 of 4 are ok; --verbose lists them\n" in many
    assert "\n5 files, 4 compilations, 1 failed, 1 not compiled\n  1 file: godot not found\n  to get godot: " in many
    for option in ("-v", "--verbose"):
        listed = run("check", *names, option).out
        assert listed.count("\nok   ") == 3 and "not compiled: godot not found" in listed and "lists them" not in listed


@pytest.mark.skipif(os.name != "posix", reason="the programs are shell scripts")
def test_a_compiler_that_hangs_or_crashes(monkeypatch: pytest.MonkeyPatch) -> None:
    source = Source(FRAGMENT, "glsl-330")
    started = 'if [ "$1" = --version ]; then echo "Glslang Version: 1.2"; exit; fi\n'
    monkeypatch.setenv("SSSGEN_GLSLANG", program("hangs", f"{started}sleep 100"))
    worker = Worker("glslang", seconds=2.0)
    assert worker.version() == "glslang 1.2"
    (message,) = worker.check(source)
    assert "did not finish within 2 seconds" in message.text
    monkeypatch.setenv("SSSGEN_GLSLANG", program("kills", f"{started}kill -SEGV $PPID"))
    (message,) = worker.check(source)
    assert "glslang crashed (SIGSEGV)" in message.text
    monkeypatch.setenv("SSSGEN_GLSLANG", program("works", started))
    assert worker.check(source) == []
    worker.close()


def test_a_text_too_deep_for_a_compiler(run: Run, compiler: Callable[[str], Compiler]) -> None:
    for name in ("gl", "glslang"):
        compiler(name)
    write({"a.frag": FRAGMENT.replace("v_uv,", f"{'(' * 50000}v_uv{')' * 50000},"), "b.frag": FRAGMENT})
    ran = run("check", "a.frag", "b.frag", "--json")
    assert ran.status in (0, 1)
    assert all(row["ok"] for row in ran.data["results"] if row["file"] == "b.frag")


# Wrong input


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["no.frag"], "no such file\n  --> no.frag"),
        (["no/such"], "no such file\n  --> no/such"),
        (["icee"], "unknown material 'icee'\n  help: did you mean 'ice'?"),
        (["empty.frag"], "the file is empty\n  --> empty.frag"),
        (["zero.frag"], "contains a zero byte\n  --> zero.frag"),
        (["latin.frag"], "this is not UTF-8 text\n  --> latin.frag:1:3"),
        (["bare"], "nothing to compile\n  --> bare"),
        (
            ["what.txt"],
            "the language of the file cannot be determined\n  --> what.txt\n  help: name it with --target T:",
        ),
        (["what.txt", "-t", "wgsl,hlsl"], "the language of the file cannot be determined"),
        (["x.glsl-330.frag", "-t", "wgsl"], "the file is for glsl-330\n  --> x.glsl-330.frag"),
        (["map.wgsl"], "this is not a reflection file of sssgen\n  --> map.wgsl.reflection.json"),
        (["ice", "-t", "unity-hdrp"], "unknown target 'unity-hdrp'\n  help: its target is 'unity-shadergraph'"),
        (["ice", "-t", "wgls"], "unknown target 'wgls'\n  help: did you mean 'wgsl'?"),
        (["ice", "--compiler", "glslng"], "unknown compiler 'glslng'\n  help: did you mean 'glslang'?"),
        (["ok.frag", "--compiler", "tint"], "no tint reads glsl-330\n  help: compilers that do: gl, glslang"),
        (["ok.frag", "--unity-includes", "no"], "no such folder of Unity's headers\n  --> no"),
        (["ok.frag", "--unity-includes", "bare"], "the folder has none of Unity's headers\n  --> bare"),
        (["no.frag", "empty.frag", "icee"], "3 errors"),
    ],
)
def test_wrong_input(arguments: list[str], message: str, run: Run) -> None:
    write({"ok.frag": FRAGMENT, "empty.frag": " \n", "what.txt": "x\n", "x.glsl-330.frag": FRAGMENT})
    write({"map.wgsl": WGSL, "map.wgsl.reflection.json": "[]\n"})
    Path("zero.frag").write_bytes(b"void\0")
    Path("latin.frag").write_bytes(b"//\xff")
    Path("bare").mkdir()
    ran = run("check", *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert message in ran.err
    as_json = run("check", *arguments, "--json")
    assert (as_json.status, as_json.err) == (2, "")
    assert as_json.data["ok"] is False


@pytest.mark.skipif(os.name != "posix", reason="there are no pipes with names")
def test_a_pipe_is_refused(run: Run) -> None:
    os.mkfifo("pipe.frag")
    assert "this is not a file" in run("check", "pipe.frag").err


def test_the_headers_of_unity_are_reported(run: Run, compiler: Callable[[str], Compiler]) -> None:
    compiler("unity")
    text = (UNITY_SAMPLES / "surface.shader").read_text(encoding="utf-8")
    write({"a.shader": text})
    assert "the project's stand-in headers" in run("check", "a.shader").out
    own = Path("headers")
    own.mkdir()
    for part in ("CGIncludes", "Packages"):
        (own / part).symlink_to(STANDIN / part)
    ran = run("check", "a.shader", "--unity-includes", "headers")
    assert ran.status == 0
    assert f"Unity's own headers in {own.resolve()}" in ran.out


def test_equal_arguments_are_read_once() -> None:
    write({"a.frag": FRAGMENT})
    assert len(read(["a.frag", "./a.frag", "a.frag"], ())) == 1
