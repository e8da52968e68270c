"""Godot: the text of its shaders; with a Godot, its parser and its three renderers. All but the text is slow.

Without `make engines`, or another Godot 4, the slow tests are skipped.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

import sssgen
from folders import ROOT
from godot_scenes import (
    MESHES,
    THROUGH,
    WHOLE,
    back_face_deviation,
    deviation,
    layered_deviation,
    raymarched_deviation,
    standard_material_deviation,
    vertex_deviation,
)
from pitfall_cases import program
from sssgen.material import library
from sssgen.material.material_loading import examples
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends.godot_drawing import RENDERERS
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import COMPILERS, Compiler, Source, errors
from sssgen.run.evaluate import probes
from sssgen.scene.pictures.images import encode_srgb
from sssgen.targets import registry
from validate import module_of

GODOT = "godot"
TEMPLATES = ROOT / "templates" / "godot"


def shader(name: str) -> str:
    return sssgen.compile(name, GODOT).files[f"{name}.gdshader"]


def test_two_files_for_a_lit_material_one_for_an_unlit() -> None:
    assert list(sssgen.compile("ice", GODOT).files)[:2] == ["ice.gdshader", "ice.own_light.gdshader"]
    assert [file for file in sssgen.compile("jelly_cubes", GODOT).files if "gdshader" in file] == [
        "jelly_cubes.gdshader"
    ]


def test_only_own_light_has_the_lighting_of_other_targets() -> None:
    files = sssgen.compile("ice", GODOT).files
    assert "standard(" not in files["ice.gdshader"] and "evaluate_lighting" not in files["ice.gdshader"]
    assert "evaluate_lighting(surface, N, V, L, light_color);" in files["ice.own_light.gdshader"]


def test_without_transmitted_light_the_light_is_godots() -> None:
    assert "void light()" not in shader("resin_inlay")
    assert "void light()" in sssgen.compile("resin_inlay", GODOT).files["resin_inlay.own_light.gdshader"]


def test_uniforms_for_the_inspector() -> None:
    text = shader("paper_lantern")
    assert "group_uniforms lobe_normalized;\n/** " in text
    assert "uniform float power : hint_range(1.0, 32.0) = 4.0;" in text
    assert "uniform sampler2D normal_texture : hint_normal, filter_linear_mipmap, repeat_enable;" in text
    assert "uniform sampler2D base_color_texture : source_color, hint_default_white, filter_linear_mipmap" in text
    stored = encode_srgb(np.array([1.0, 0.72, 0.38]))
    line = next(line for line in text.splitlines() if "vec3 subsurface_color : source_color = vec3(" in line)
    assert eval(line.partition("vec3(")[2].rstrip(");")) == pytest.approx(tuple(stored), abs=1e-6)


def test_colors_are_converted_where_they_are_read() -> None:
    text = shader("ice")
    assert "linear_color(tint) * linear_color(texture(base_color_texture, uv))" in text
    assert "linear_color(vec4(subsurface_color, 1.0)).rgb" in text


def test_textures_of_the_program_are_explained_at_the_head() -> None:
    text = shader("jade_ring")
    assert "// back_face_map: drawn by the node of jade_ring_passes.gd" in text.partition("shader_type")[0]
    assert "float light_nearness = entering.y;" in text.partition("void light()")[2]


def test_light_gets_what_it_reads() -> None:
    """Of the values of the surface, fragment() passes on those that light() reads."""
    both = sssgen.compile("ice", GODOT).files
    godots, own = both["ice.gdshader"], both["ice.own_light.gdshader"]
    assert re.findall(r"varying \w+ passed_(\w+);", godots) == ["albedo", "transmittance"]
    assert {"albedo", "roughness"} <= set(re.findall(r"varying \w+ passed_(\w+);", own))
    for text in (godots, own):
        passed = re.findall(r"varying \w+ (passed_\w+);", text)
        assert all(f"    {name} = surface." in text and f"= {name};" in text for name in passed)


def test_each_file_has_the_functions_that_it_calls() -> None:
    both = sssgen.compile("ice", GODOT).files
    assert "reflected_light(" in both["ice.gdshader"] and "reflected_light(" not in both["ice.own_light.gdshader"]


def test_no_parameter_has_the_name_of_a_uniform() -> None:
    """Functions read uniforms, and Godot refuses a parameter or a local of the name."""
    source = "const float near = 2.0;\nfloat g(float x) { return x * near; }\n"
    module = module_of(f"{source}float f(float near, float x) {{ float h = near + x; return g(h * h); }}")
    text = transpile(module, GODOT, "names").files["names.gdshaderinc"]
    assert "float f(float near_, float x)" in text and "float h = near_ + x;" in text
    assert "float f(float near, float x)" in next(iter(transpile(module, "glsl-330", "names").files.values()))


def test_matrices_by_columns() -> None:
    module = module_of("mat2 turn(float x) { return mat2(x, -x, 1.0, x); }")
    assert "return mat2(vec2(x, -x), vec2(1.0, x));" in transpile(module, GODOT, "m").files["m.gdshaderinc"]


def test_variables_of_the_shell_are_reserved_at_file_scope() -> None:
    """Godot refuses a variable or a parameter with the name of a uniform."""
    texts = [re.sub(r"\{#.*?#\}", "", path.read_text("utf-8"), flags=re.DOTALL) for path in TEMPLATES.glob("*.j2")]
    target = registry.load(GODOT)
    for parts in (target, *target.variants.values()):
        texts += [text for place in (*parts.frame.values(), *parts.surface.values()) for text in place.values()]
    code = re.sub(r"//[^\n]*", "", "\n".join(texts))
    declared = set(re.findall(r"(?:float|vec[234]|mat4|}}) (\w+)(?= =|\)|;)", code))
    names = registry.load(GODOT).names
    assert {"reflected", "surface", "light_color", "texel", "world_position", "N"} <= declared
    assert declared <= names.local | names.shell


def test_its_compiler_is_apart() -> None:
    assert COMPILERS[GODOT].apart and "make engines" in COMPILERS[GODOT].install


# With a Godot


@pytest.mark.slow
def test_everything_is_parsed(compiler: Callable[[str], Compiler]) -> None:
    """Every example in both forms, every technique, every case of the pitfalls."""
    godot = compiler(GODOT)
    found = [source for name in examples() for form in ("shader", "functions")
             for source in sources(sssgen.compile(name, GODOT, form).files)]  # fmt: skip
    for name in ["pitfalls", *library.index()]:
        subject = probes.subject(name) if name != "pitfalls" else None
        module = subject.module if subject else program()[0]
        called = subject.called if subject else None
        files = transpile(module, GODOT, name, "auto", called, chained=bool(subject and subject.chained)).files
        found.append(Source(files[f"{name}.gdshaderinc"], GODOT, "library", name=name))
    assert len(found) > 100
    failures = [f"{source.name}: {message}" for source in found for message in errors(godot.check(source))]
    assert not failures


@pytest.mark.slow
def test_a_fault_is_reported_at_its_line(compiler: Callable[[str], Compiler]) -> None:
    lines = shader("ice").splitlines()
    number = next(index for index, line in enumerate(lines) if "float up = " in line)
    lines[number] = "    float up = vec2(1.0);"
    messages = errors(compiler(GODOT).check(Source("\n".join(lines), GODOT)))
    assert [message.line for message in messages] == [number + 1]


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
@pytest.mark.parametrize("name", [name for name in MESHES if name != "resin_inlay"])
def test_light_that_comes_through(name: str, renderer: str, compiler: Callable[[str], Compiler]) -> None:
    compiler(GODOT)
    assert_alike(deviation(name, renderer, THROUGH))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "renderer"),
    [
        # the Compatibility renderer filters textures of colours before it decodes them
        (name, renderer)
        for name in MESHES
        for renderer in RENDERERS
        if renderer != "gl_compatibility" or name not in ("ice_inlay", "paper_lantern", "resin_inlay")
    ],
)
def test_whole_light(name: str, renderer: str, compiler: Callable[[str], Compiler]) -> None:
    compiler(GODOT)
    assert_alike(deviation(name, renderer, WHOLE))


def assert_alike(difference: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> None:
    """Within 1/255; a pixel at the threshold of a mask may be on either side of it."""
    assert (difference > 1.0 / 255.0).sum() <= 1
    assert np.median(difference) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
@pytest.mark.parametrize("roughness", [0.5, 0.9])
def test_reflected_light_is_that_of_the_standard_material(
    renderer: str, roughness: float, compiler: Callable[[str], Compiler]
) -> None:
    compiler(GODOT)
    assert standard_material_deviation(renderer, roughness).max() <= 1.0 / 255.0


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
def test_back_faces_have_the_reversed_normal(renderer: str, compiler: Callable[[str], Compiler]) -> None:
    compiler(GODOT)
    assert back_face_deviation(renderer).max() <= 1.0 / 255.0


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
def test_a_raymarched_scene_is_upright_on_a_quad(renderer: str, compiler: Callable[[str], Compiler]) -> None:
    compiler(GODOT)
    difference = raymarched_deviation(renderer)
    assert np.quantile(difference, 0.98) < 1.0 / 255.0  # but for edges, where a ray may miss


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
@pytest.mark.parametrize("role", ["lighting", "translucency"])
def test_values_of_the_vertices(role: str, renderer: str, compiler: Callable[[str], Compiler]) -> None:
    """Godot's meshes have colours of 8 bits."""
    compiler(GODOT)
    assert vertex_deviation(renderer, role).max() <= 1.0 / 255.0


@pytest.mark.slow
@pytest.mark.parametrize("renderer", RENDERERS)
def test_specular_level_and_clear_coat_are_godots(renderer: str, compiler: Callable[[str], Compiler]) -> None:
    compiler(GODOT)
    assert layered_deviation(renderer).max() <= 1.0 / 255.0
