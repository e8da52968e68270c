"""Bevy: the linked text lights through a body as the oracle does; the Rust struct binds what the WESL declares."""

from __future__ import annotations

import inspect
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sssgen
from folders import EXAMPLES
from sssgen.ir.types import BY_NAME, VEC2, VEC3, Sampler, Type
from sssgen.run.backends import Backend, Call, Text
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.run.compilers.bevy_compiler import CONDITIONS, Bevy
from sssgen.targets.runtime.numpy_textures import Texture

LANES = 64
WAX = str(EXAMPLES / "engines" / "bevy" / "wax.toml")
MATERIALS = (WAX, "wax_mouse", "ice", "examples/bake/wax_map.toml")
Array = np.ndarray[Any, Any]


def files(material: str) -> tuple[str, str, dict[str, Any]]:
    """The WESL, the Rust and the reflection of a material."""
    compiled = sssgen.compile(material, "bevy")
    shader, rust, _ = compiled.files.values()
    return shader, rust, compiled.reflection


def in_the_open(linked: str, material: dict[str, Any], set_up: str) -> str:
    """Linked WGSL with `called`, which sets what Bevy would bind, and calls the fragment stage.

    Its uniforms become variables of the module, and its textures parameters.
    """
    text = re.sub(r"@group\(\w+\) @binding\(\d+\) var<uniform> ", "var<private> ", linked)
    text = re.sub(r"@group\(\w+\) @binding\(\d+\) var \w+: (?:texture_\w+<f32>|sampler);", "", text)
    text = re.sub(r"@fragment\s+fn fragment", "fn fragment", text).replace("@builtin(front_facing) ", "")
    values = "".join(
        f"material.{row['name']} = {spelled(row['type'])}({', '.join(map(repr, row['default']))});\n"
        for row in material["uniforms"]
    )
    names = [f"{row['name']}: {kind}, {row['name']}_sampler: sampler" for row, kind in textures_of(material)]
    chain = ["uv: vec2f", "P: vec3f", "N: vec3f", "V: vec3f", "L: vec3f"]
    body = f"""{values}
    var in: VertexOutput;
    in.uv = uv;
    in.world_position = vec4f(P, 1.0);
    in.world_normal = N;
    view.world_position = P + 2.0 * V;
    view.exposure = 0.5;
    meshes[0] = mat4x4f(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    meshes[1] = meshes[0];
    let dark = fragment(in, true).color.rgb;
    {set_up}
    return fragment(in, true).color.rgb - dark;"""
    used = "\n".join(line for line in body.split("\n") if "meshes[" not in line or "meshes:" in text)
    return f"{text}\nfn called({', '.join(chain + names)}) -> vec3f {{\n{used}\n}}\n"


def textures_of(reflection: dict[str, Any]) -> list[tuple[dict[str, Any], str]]:
    kinds = {"sampler2D": "texture_2d<f32>", "sampler3D": "texture_3d<f32>"}
    return [(row, kinds[row["type"]]) for row in reflection["textures"]]


def spelled(name: str) -> str:
    return {"float": "f32", "int": "i32"}.get(name, f"{name}f")


LIGHTS = {
    "directional": (
        "lights.n_directional_lights = 1u; lights.directional_lights[0].direction_to_light = L;"
        " lights.directional_lights[0].color = vec4f(3.0, 2.0, 1.0, 1.0);",
        0.5 / np.pi * np.array([3.0, 2.0, 1.0]),
    ),
    "point": (
        "for (var i = 0u; i < 2u; i++) { clusters[i] = vec4u(0u, 1u, 1u, 0u); }"
        " clustered_lights.data[0].position_radius = vec4f(P + 1.5 * L, 0.0);"
        " clustered_lights.data[0].color_inverse_square_range = vec4f(3.0, 2.0, 1.0, 0.0);",
        0.5 / np.pi * np.array([3.0, 2.0, 1.0]) / 1.5**2,
    ),
    "spot": (
        "for (var i = 0u; i < 2u; i++) { clusters[i] = vec4u(0u, 0u, 1u, 0u); }"
        " clustered_lights.data[0].position_radius = vec4f(P + 1.5 * L, 0.0);"
        " clustered_lights.data[0].light_custom_data = vec4f(-L.x, -L.z, 2.0, -1.2);"
        " clustered_lights.data[0].flags = select(0u, 2u, L.y > 0.0);"
        " clustered_lights.data[0].color_inverse_square_range = vec4f(3.0, 2.0, 1.0, 0.0);",
        0.5 / np.pi * np.array([3.0, 2.0, 1.0]) / 1.5**2 * 0.8**2,
    ),
}
"""A light that Bevy would bind, and the colour of its light on a white surface that faces it."""


@pytest.mark.parametrize("kind", LIGHTS)
@pytest.mark.parametrize("material", [WAX, "wax_mouse"])
def test_the_light_that_comes_through(
    material: str, kind: str, compiler: Callable[[str], Compiler], backend: Callable[[str], Backend]
) -> None:
    """The fragment stage, linked with the stand-ins: what a light adds is the translucent term of the oracle."""
    shader, _, reflection = files(material)
    linker = compiler("bevy")
    assert isinstance(linker, Bevy)
    set_up, color = LIGHTS[kind]
    text = in_the_open(linker.link(shader, CONDITIONS["forward"]), reflection, set_up)
    chain = inputs()
    rng = np.random.default_rng(3)
    textures = {}
    params: list[Type] = [VEC2, VEC3, VEC3, VEC3, VEC3]
    args: list[Any] = [chain[name] for name in ("uv", "P", "N", "V", "L")]
    for row, _ in textures_of(reflection):
        type_ = BY_NAME[row["type"]]
        assert isinstance(type_, Sampler)
        size = (4, 4, 4) if type_.dim == "3D" else (8, 8)
        textures[row["name"]] = Texture(rng.integers(0, 256, (*size, 4)).astype(np.float32) / 256.0)
        params.append(type_)
        args.append(row["name"])
    (actual,) = backend("webgpu").run(Text(text), [Call("called", tuple(params), VEC3, tuple(args))], textures)
    expected = by_the_oracle(material, chain, textures) * color[:, None]
    assert np.max(expected) > 0.0
    np.testing.assert_allclose(actual, np.broadcast_to(expected, actual.shape), atol=2e-5, rtol=2e-3)


@pytest.mark.parametrize("material", ["jelly_cubes", "rays"])
def test_a_raymarched_picture_is_upright(
    material: str, tmp_path: Path, compiler: Callable[[str], Compiler], backend: Callable[[str], Backend]
) -> None:
    """v of Bevy's own meshes is 0 at the top, that of a picture at the bottom; the rays of Bevy's camera have no v."""
    if material == "rays":
        (tmp_path / "rays.sss").write_text(RAYS, encoding="utf-8")
        path = tmp_path / "rays.toml"
        path.write_text('[material]\nname = "rays"\nshading = "unlit"\n[lighting]\ntechnique = "./rays.sss"\n')
        material = str(path)
    shader, _, reflection = files(material)
    linker = compiler("bevy")
    assert isinstance(linker, Bevy)
    lit = in_the_open(linker.link(shader, CONDITIONS["forward"]), reflection, "")
    text = lit.replace("fragment(in, true).color.rgb - dark", "dark").replace("globals.time", "2.0")
    chain = inputs()
    params = (VEC2, VEC3, VEC3, VEC3, VEC3)
    calls = [Call("called", params, VEC3, tuple(chain[name] for name in ("uv", "P", "N", "V", "L")))]
    (actual,) = backend("webgpu").run(Text(text), calls)
    upward = chain["uv"] if material != "jelly_cubes" else np.stack([chain["uv"][0], 1.0 - chain["uv"][1]])
    rays = {"ray_origin": chain["P"] + 2.0 * chain["V"], "ray_direction": -chain["V"]}
    expected, turned = (
        by_the_oracle(material, {**chain, **rays, "uv": uv, "time": np.full(LANES, 2.0)}, {})[:3]
        for uv in (upward, np.stack([upward[0], 1.0 - upward[1]]))
    )
    if material == "jelly_cubes":
        expected, turned = expected**2.2, turned**2.2  # decoded: Bevy has no output technique
        assert np.mean(np.abs(turned - expected)) > 0.1
    assert np.quantile(np.abs(actual - expected), 0.95) < 1e-3  # but for edges, where a ray may miss


RAYS = """/**
 * Rays.
 * role: lighting
 * formula: none
 * source: none
 * units: none
 * limits: none
 */
vec3 rays(world_direction ray_direction, world_position ray_origin, uv_position uv)
{
    return abs(vec3(ray_direction) + vec3(ray_origin) + vec3(uv, 0.0));
}
"""


def inputs() -> dict[str, Array]:
    rng = np.random.default_rng(5)
    chain = {"uv": rng.uniform(0.0, 1.0, (2, LANES))}
    chain["P"] = np.array([-2.5, 1.2, 4.1])[:, None] + rng.uniform(-0.8, 0.8, (3, LANES))
    for name in ("N", "V", "L"):
        chain[name] = rng.normal(size=(3, LANES))
        chain[name] /= np.linalg.norm(chain[name], axis=0)
    chain |= {f"{name}_object": chain[name] for name in ("P", "V", "L")}
    return {name: value.astype(np.float32) for name, value in chain.items()}


def by_the_oracle(material: str, chain: dict[str, Array], textures: dict[str, Texture]) -> Array:
    compiled = sssgen.compile(material, "numpy", form="functions")
    functions: dict[str, Any] = {}
    exec(next(iter(compiled.files.values())), functions)
    dark = dict.fromkeys(("irradiance", "irradiance_behind"), np.zeros((3, LANES)))
    known: dict[str, Any] = {**chain, **textures, **dark}
    for row in compiled.reflection["uniforms"]:
        value = np.array(row["default"], np.float64)
        known[row["name"]] = float(value[0]) if value.size == 1 else value[:, None] * np.ones(LANES)
    if "evaluate_color" in functions:
        function = functions["evaluate_color"]
        color: Array = function(*(known[name] for name in inspect.signature(function).parameters))
        return color
    for kind in ("surface", "translucency"):
        function = functions[f"evaluate_{kind}"]
        known[kind] = function(*(known[name] for name in inspect.signature(function).parameters))
    result: Array = known["translucency"]
    return result


@pytest.mark.parametrize("material", MATERIALS)
def test_the_struct_binds_what_the_shader_declares(material: str) -> None:
    """Members in the same order with the same types, padded to 16 bytes; the same bindings, from 100 on."""
    shader, rust, reflection = files(material)
    block = shader.partition("struct Material {\n")[2].partition("\n}")[0]
    members = re.findall(r"^    (\w+): (\w+),", block, re.MULTILINE)
    fields = re.findall(r"#\[uniform\(100\)\]\n    (?:pub )?(\w+): (\w+),", rust)
    spelling = {"vec2f": "Vec2", "vec3f": "Vec3", "vec4f": "Vec4", "mat4x4f": "Mat4"}
    assert fields == [(name, spelling.get(type_, type_)) for name, type_ in members]
    last = reflection["uniforms"][-1]
    padding = len([name for name, _ in members if name.startswith("padding_")])
    assert last["offset"] + last["size"] + 4 * padding == reflection["uniform_block_size"]
    assert reflection["uniform_block_size"] % 16 == 0
    assert "@group(constants::MATERIAL_BIND_GROUP) @binding(100) var<uniform> material: Material;" in shader
    declared = re.findall(r"@binding\((\d+)\) var (\w+): (?:texture|sampler)", shader)
    attributes = re.findall(r"#\[(?:texture|sampler)\((\d+)[^)]*\)\]", rust)
    assert [number for number, _ in declared] == attributes
    assert [(row["binding"]["texture"], row["name"]) for row in reflection["textures"]] == [
        (int(number), name) for number, name in declared[::2]
    ]


@pytest.mark.parametrize("material", [*MATERIALS, "jade_ring", "jelly_cubes"])
def test_rust_reads_the_struct(material: str, tmp_path: Path) -> None:
    """rustfmt parses it, and has nothing to change."""
    program = shutil.which("rustfmt")
    if program is None:
        pytest.skip("rustfmt is missing: apt-get install rustfmt")
    path = tmp_path / "material.rs"
    path.write_text(files(material)[1], encoding="utf-8")
    ran = subprocess.run([program, "--edition", "2021", "--check", str(path)], capture_output=True, text=True)
    assert not ran.returncode, ran.stdout + ran.stderr


def test_the_example_names_what_is_emitted() -> None:
    """The names that its program imports and calls."""
    _, rust, _ = files(WAX)
    main = (EXAMPLES / "engines" / "bevy" / "src" / "main.rs").read_text(encoding="utf-8")
    (names,) = re.findall(r"use wax::\{(.*)\};", main)
    for name in names.split(", "):
        assert re.search(rf"pub (?:struct|type) {name}\b", rust)
    assert "Wax::material()" in main and "pub fn material() -> WaxMaterial" in rust


WRONG = [
    ("surface.metallic", "surface.metalic", "metalic"),
    ("bevy_functions::alpha_discard", "bevy_functions::alpha_discards", "alpha_discards"),
    ("bevy_view::view.exposure", "bevy_view::view.exposures", "exposures"),
]


@pytest.mark.parametrize(("right", "wrong", "message"), WRONG)
def test_a_wrong_text_is_refused(right: str, wrong: str, message: str, compiler: Callable[[str], Compiler]) -> None:
    shader = files("wax_mouse")[0]
    source = Source(shader.replace(right, wrong), "bevy", "fragment", "fragment", "wax_mouse.wesl")
    assert right in shader and message in errors(compiler("bevy").check(source))[0].text


def test_an_error_has_its_line(compiler: Callable[[str], Compiler]) -> None:
    shader = files("wax_mouse")[0].replace("surface.metallic", "surface.metalic")
    line = next(number for number, text in enumerate(shader.splitlines(), 1) if "surface.metalic" in text)
    assert errors(compiler("bevy").check(Source(shader, "bevy", "fragment", "fragment")))[0].line == line


@pytest.mark.parametrize(
    "name", ["standard_material", "extended_material", "handle", "vec2", "self", "standard", "as_bind_group"]
)
def test_no_type_has_the_name_of_another(name: str, tmp_path: Path) -> None:
    """Of Rust's own, of Bevy's, or of those that the file itself reads."""
    path = tmp_path / "material.toml"
    path.write_text(f'[material]\nname = "{name}"\n[surface]\ntechnique = "base_color"\n')
    rust = next(text for file, text in sssgen.compile(str(path), "bevy").files.items() if file.endswith(".rs"))
    code = re.sub(r"//.*", "", rust)
    made = re.findall(r"pub (?:type|struct) (\w+)", code)
    free = sssgen.compile(WAX, "bevy").files["wax.rs"]
    read = set(re.findall(r"\b[A-Z]\w+", re.sub(r"//.*", "", free))) - {"Wax", "WaxMaterial"}
    assert len(set(made)) == 2 and not set(made) & read
    assert (
        f"ExtendedMaterial<StandardMaterial, {made[1]}>" in code and f"impl MaterialExtension for {made[1]} {{" in code
    )


@pytest.mark.parametrize("name", ["fn", "self", "crate", "mod", "main", "lib", "bevy", "Main", "wax", "main_"])
def test_rust_has_a_module_of_the_file_s_name(name: str, tmp_path: Path) -> None:
    """No word of Rust, not the program itself, and not a crate that the file reads."""
    path = tmp_path / "material.toml"
    path.write_text(f'[material]\nname = "{name}"\n[surface]\ntechnique = "base_color"\n', encoding="utf-8")
    compiled = sssgen.compile(str(path), "bevy")
    module = name if name in ("wax", "main_") else f"{name}_"
    assert [*compiled.files][:2] == [f"{name}.wesl", f"{module}.rs"]
    assert [file["name"] for file in compiled.reflection["files"]][:2] == [f"{name}.wesl", f"{module}.rs"]
    assert f"shaders/{name}.wesl" in compiled.files[f"{module}.rs"]
