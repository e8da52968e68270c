"""What a target cannot supply to a program is one error per parameter or texture, with its place and what to do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import sssgen
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.support.diagnostics import UnsupportedError

HEAD = "/** X.\nrole: surface\n*/\n"


def material(folder: Path, uniform: str, value: str) -> str:
    """A material of one technique that reads the uniform `x`."""
    (folder / "reads.sss").write_text(
        f"uniform {uniform};\n{HEAD}void reads(uv_position uv, out vec3 albedo) {{ albedo = vec3({value}); }}\n",
        encoding="utf-8",
    )
    path = folder / "made.toml"
    path.write_text('[material]\nname = "made"\n[[surface]]\ntechnique = "./reads.sss"\n', encoding="utf-8")
    return str(path)


@pytest.mark.parametrize(
    ("uniform", "value", "targets"),
    [
        ("float[3] x = float[3](0.1, 0.2, 0.3)", "x[1]", ("threejs", "bevy", "unreal", "unity-shadergraph")),
        ("bvec2 x = bvec2(true, false)", "x.x ? 1.0 : 0.0", ("threejs", "bevy")),
        ("mat2 x = mat2(1.0)", "x[0].x", ("bevy",)),
    ],
)
def test_parameters_of_other_types(uniform: str, value: str, targets: tuple[str, ...], tmp_path: Path) -> None:
    path = material(tmp_path, uniform, value)
    for target in targets:
        with pytest.raises(UnsupportedError, match="'x' cannot be a parameter in ") as raised:
            sssgen.compile(path, target)
        (only,) = raised.value.diagnostics
        assert only.span.file.endswith("reads.sss") and only.span.line == 1 and "--form functions" in only.hint
        assert sssgen.compile(path, target, "functions").files  # whose caller passes the value


def test_a_bool_is_a_number_in_bevy(tmp_path: Path) -> None:
    files = sssgen.compile(material(tmp_path, "bool x = true", "x ? 0.5 : 0.25"), "bevy").files
    rust = next(text for name, text in files.items() if name.endswith(".rs"))
    assert "pub x: i32" in rust and "x: 1," in rust


@pytest.mark.parametrize("target", ["unity-builtin", "unity-urp", "unity-shadergraph", "unreal", "godot", "shadertoy"])
def test_kinds_of_textures(target: str, tmp_path: Path) -> None:
    path = material(tmp_path, "sampler2DShadow x", "texture(x, vec3(vec2(uv), 0.5))")
    for form in ("shader", "functions"):
        with pytest.raises(UnsupportedError, match="cannot supply 'x': it has no sampler2DShadow") as raised:
            sssgen.compile(path, target, form)
        (only,) = raised.value.diagnostics
        assert only.span.line == 1 and "another target" in only.hint


NUMBERS = {
    "isampler2D": "float(texelFetch(x, ivec2(0), 0).x)",
    "usampler2DArray": "float(texelFetch(x, ivec3(0), 0).x)",
    "usamplerCube": "float(textureSize(x, 0).x)",
    "sampler2DShadow": "texture(x, vec3(vec2(uv), 0.5))",
    "samplerCubeShadow": "texture(x, vec4(vec2(uv), 0.5, 0.5))",
}


@pytest.mark.parametrize("kind", NUMBERS)
def test_textures_that_no_material_of_an_engine_sets(
    kind: str, tmp_path: Path, assert_compiles: Callable[[Source], None]
) -> None:
    """Of integers, and for shadows: a whole shader is refused, functions are not."""
    path = material(tmp_path, f"{kind} x", NUMBERS[kind])
    for target in ("threejs", "babylonjs", "playcanvas", "bevy"):
        with pytest.raises(UnsupportedError, match=f"cannot supply 'x': its materials set no {kind}") as raised:
            sssgen.compile(path, target)
        (only,) = raised.value.diagnostics
        assert only.span.line == 1 and only.hint.endswith("another target, or --form functions")
        for source in sources(sssgen.compile(path, target, "functions").files):
            assert_compiles(source)


def test_a_texture_with_layers_is_declared_as_one(tmp_path: Path, assert_compiles: Callable[[Source], None]) -> None:
    path = material(tmp_path, "sampler2DArray x", "texture(x, vec3(vec2(uv), 1.0)).rgb")
    declared = {
        "threejs": ("x: { type: 'sampler2DArray'",),
        "babylonjs": ("x: { type: 'sampler2DArray'", "sampler2DArray: '2d_array'"),
        "playcanvas": ("x: { type: 'sampler2DArray'", "sampler2DArray: '2d_array'"),
        "bevy": ('dimension = "2d_array"', "var x: texture_2d_array<f32>;"),
        "glsl-es-300": ("precision highp sampler2DArray;", "uniform highp sampler2DArray x;"),
        "glsl-330": ("uniform sampler2DArray x;",),
        "wgsl": ("var x: texture_2d_array<f32>;",),
    }
    for target, lines in declared.items():
        files = sssgen.compile(path, target).files
        assert [line for line in lines if line not in "".join(files.values())] == [], target
        for source in sources(files):
            assert_compiles(source)
