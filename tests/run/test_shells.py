"""The computations of the shells are finite on hostile points, for any input of a mesh or a program.

The tests draw a mesh with one vertex per pixel, as `sssgen render` does, into float pictures, which are not clamped.
The result of the built-in pipeline's surface shaders for a normal of 0 is Unity's own computation, so the tests draw
the unlit shader there.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from carried import carries
from example_cases import ALIKE
from slow_cases import diagonal, some_slow
from sssgen.ir.types import VEC3
from sssgen.material.material_loading import examples, load_material
from sssgen.pipeline.compiler import Compiled, all_targets, compile
from sssgen.run.backends import Array, Backend, Call, Text
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source
from sssgen.run.render.shade import shade
from sssgen.run.render.shell_values import Shell

PLAIN = ["numpy", "numpy-f32", "gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang", "metal"]
DRAWN_SHELLS = [*((name, probe) for name in [*PLAIN, "unity-urp"] for probe in ("lit", "unlit")), ("unity", "unlit")]
SIZE = (8, 6)
BRIGHT = 1e8
"""More than the lights of these tests can give."""

INPUTS = "world_direction V, world_direction N, world_direction T, world_direction B, object_direction V_object, "
INPUTS += "object_direction N_object, vec2 screen_uv, float eye_distance, uv_position uv2, vec4 vertex_color"
LIT = f"""
/** Shows what a shell gives a surface.
role: surface
*/
void shown({INPUTS}, inout tangent_direction normal, out vec3 emission) {{
    emission = 0.5 + 0.1 * vec3(V + N + T + B + vec3(V_object) + vec3(N_object) + vec3(screen_uv, eye_distance))
        + 0.1 * (vec3(uv2, vertex_color.a) + vertex_color.rgb);
}}
"""
THROUGH = """
/** Shows what a shell gives a light.
role: translucency
*/
vec3 through(world_direction V, world_direction N, world_direction L, object_direction L_object, vec2 screen_uv,
    float eye_distance, float light_nearness, uv_position uv2, vec4 vertex_color) {
    return 0.5 + 0.1 * vec3(V + N + L + vec3(L_object)) + vec3(screen_uv, eye_distance) + light_nearness
        + 0.1 * (vec3(uv2, vertex_color.a) + vertex_color.rgb);
}
"""
UNLIT = f"""
/** Shows what a shell gives an unlit material.
role: lighting
*/
vec3 unlit({INPUTS}, world_direction L, object_direction L_object, float light_nearness) {{
    return 0.5 + 0.1 * vec3(V + N + T + B + vec3(V_object) + vec3(N_object) + L + vec3(L_object))
        + vec3(screen_uv, eye_distance) + light_nearness + 0.1 * (vec3(uv2, vertex_color.a) + vertex_color.rgb);
}}
"""
RAYS = """
/** Shows what a shell gives a raymarched material.
role: lighting
*/
vec3 rays(world_direction ray_direction, vec2 screen_uv) {
    return 0.5 + 0.1 * ray_direction + vec3(screen_uv, 0.0);
}
"""
EMPTY = """
/** Needs no direction.
role: lighting
*/
vec3 plain(uv_position uv) {
    return vec3(uv, 0.5);
}
"""
MATERIALS = {
    "lit": '[material]\nname = "lit"\nshading = "lit"\n[[surface]]\ntechnique = "shown.sss"\n'
    '[translucency]\ntechnique = "through.sss"\n',
    "unlit": '[material]\nname = "unlit"\nshading = "unlit"\n[[lighting]]\ntechnique = "unlit.sss"\n',
    "rays": '[material]\nname = "rays"\nshading = "unlit"\n[[lighting]]\ntechnique = "rays.sss"\n',
    "plain": '[material]\nname = "plain"\nshading = "unlit"\nalpha_mode = "blend"\n[[lighting]]\n'
    'technique = "plain.sss"\n',
}

FRONT = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.5, 0.5, 0.25, 0.5, 0.5, 0.4, 0.3, 0.8])
"""A vertex that faces +z; `grid` sets its position."""
LAMPS = np.array([[0.0, 0.0, 1.0, 0.0], [1.0, 2.0, 3.0, 1.0]])


def grid(**changed: Array) -> Array:
    """The vertices of a square that faces the camera, all with the same attributes."""
    width, height = SIZE
    x, y = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    points = np.tile(FRONT, (width * height, 1))
    points[:, 0], points[:, 1] = 2.0 * x.ravel() - 1.0, 2.0 * y.ravel() - 1.0
    at = {"normal": slice(3, 6), "tangent": slice(6, 9)}
    for name, value in changed.items():
        points[:, at[name]] = value
    return points.astype(np.float32)


SHELL = Shell(
    view_projection=np.eye(4), camera_position=(0.2, 0.3, 4.0), ambient=(0.1, 0.1, 0.1),
    light_positions=LAMPS, light_colors=np.ones((2, 3)),
)  # fmt: skip
NEAR = 1e-30
"""The distance of points if a camera or light is at the surface; its square is 0."""
MAGNIFIED = dataclasses.replace(SHELL, view_projection=np.diag([1.0 / NEAR, 1.0 / NEAR, 1.0, 1.0]))
LIGHTS_AT_SURFACE = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""A directional light with direction 0, and a light at the surface."""


def coinciding_points() -> Array:
    points = grid()
    points[:, :2] *= NEAR
    return points


HOSTILE: dict[str, tuple[Array, Shell]] = {
    "normal 0": (grid(normal=np.zeros(3)), SHELL),
    "tiny normal": (grid(normal=np.array([0.0, 0.0, 1e-25])), SHELL),
    "tangent 0": (grid(tangent=np.zeros(3)), SHELL),
    "camera at the surface": (coinciding_points(), dataclasses.replace(MAGNIFIED, camera_position=(0.0, 0.0, 0.0))),
    "light at the surface": (coinciding_points(), dataclasses.replace(MAGNIFIED, light_positions=LIGHTS_AT_SURFACE)),
    "camera and light at the surface": (
        coinciding_points(),
        dataclasses.replace(MAGNIFIED, light_positions=LIGHTS_AT_SURFACE, camera_position=(0.0, 0.0, 0.0)),
    ),
    "flattened": (grid(), dataclasses.replace(SHELL, model=np.diag([1.0, 1.0, 0.0, 1.0]))),
    "model 0": (grid(), dataclasses.replace(SHELL, model=np.zeros((4, 4)))),
}


@pytest.fixture
def compiled_shell(tmp_path: Path) -> Callable[[str, str], Compiled]:
    """Compiles a probe for a target."""

    def write(name: str, target: str) -> Compiled:
        for file, text in (("shown", LIT), ("through", THROUGH), ("unlit", UNLIT), ("rays", RAYS), ("plain", EMPTY)):
            (tmp_path / f"{file}.sss").write_text(text, encoding="utf-8")
        path = tmp_path / f"{name}.toml"
        path.write_text(MATERIALS[name], encoding="utf-8")
        return compile(load_material(str(path)), target)

    return write


def assert_numbers(picture: Array) -> None:
    """Asserts that no number is NaN or infinite, or a value that results from clamping these."""
    bits = np.ascontiguousarray(picture, np.float32).view(np.uint32)
    assert ((bits >> 23) & 0xFF != 0xFF).all()
    assert np.abs(picture).max() < BRIGHT


def inner(picture: Array) -> Array:
    """The picture without its border, which the mesh may not cover."""
    return picture[1:-1, 1:-1]


@pytest.mark.parametrize(("name", "probe", "case"), diagonal(DRAWN_SHELLS, HOSTILE))
def test_hostile_points(
    case: str, probe: str, name: str, backend: Callable[[str], Backend], compiled_shell: Callable[[str, str], Compiled]
) -> None:
    machine, (points, shell) = backend(name), HOSTILE[case]
    if name.startswith("numpy"):  # NumPy draws without triangles, so the points may coincide
        points = np.where(np.abs(points) < 1e-20, 0.0, points)
    picture = shade(machine, compiled_shell(probe, machine.target.name), shell, SIZE, points)
    assert_numbers(picture)
    if case != "model 0":  # with a model matrix of 0, nothing is drawn
        assert inner(picture)[..., :3].min() > 0.05


@pytest.mark.parametrize("name", [*PLAIN, "unity", "unity-urp"])
def test_rays_of_a_matrix_of_0(
    name: str, backend: Callable[[str], Backend], compiled_shell: Callable[[str, str], Compiled]
) -> None:
    machine = backend(name)
    shell = dataclasses.replace(SHELL, view_projection=np.zeros((4, 4)))
    assert_numbers(shade(machine, compiled_shell("rays", machine.target.name), shell, SIZE, None))


@pytest.mark.parametrize("name", ["unity", "unity-urp"])
def test_rays_from_the_surface(
    name: str, backend: Callable[[str], Backend], compiled_shell: Callable[[str, str], Compiled]
) -> None:
    """In Unity a ray ends on the mesh that is drawn."""
    machine, (points, shell) = backend(name), HOSTILE["camera at the surface"]
    picture = shade(machine, compiled_shell("rays", machine.target.name), shell, SIZE, points)
    assert_numbers(picture)
    assert inner(picture)[..., :3].min() > 0.05


@pytest.mark.parametrize("name", [*PLAIN, "unity-urp"])
@pytest.mark.parametrize("material", ["ice_inlay", "resin_inlay"])
def test_examples_on_hostile_points(material: str, name: str, backend: Callable[[str], Backend]) -> None:
    machine = backend(name)
    compiled = compile(load_material(material), machine.target.name)
    for points, shell in HOSTILE.values():
        assert_numbers(shade(machine, compiled, shell, SIZE, points))


@pytest.mark.parametrize("name", ["gl", "gl-es", "webgpu", "hlsl", "unity-urp", "numpy-f32"])
def test_a_short_normal_does_not_sharpen_the_highlight(name: str, backend: Callable[[str], Backend]) -> None:
    """A short direction would scale the highlight by its inverse cube. A normal has length 1, or 0 and no light."""
    machine = backend(name)
    compiled = compile(load_material("resin_inlay"), machine.target.name)
    brightest = []
    for length in (1.0, 1e-4, 1e-8, 1e-12, 1e-18, 1e-25, 0.0):
        points = grid(normal=length * np.array([0.3, 0.0, 0.954]))
        brightest.append(inner(shade(machine, compiled, SHELL, SIZE, points))[..., :3].max())
    np.testing.assert_allclose(brightest[1:4], brightest[0], rtol=0.05)
    np.testing.assert_allclose(brightest[4:], SHELL.ambient[0], rtol=1e-3)


def test_hostile_ports_of_a_graph(
    backend: Callable[[str], Backend], compiled_shell: Callable[[str, str], Compiled]
) -> None:
    """Calls the function of Shader Graph with directions of 0, for an object whose matrices are 0."""
    backend("unity-urp")
    machine = UnityHLSL("unity-shadergraph", "unity-shadergraph", "dxc")
    (text,) = (
        text for file, text in compiled_shell("unlit", "unity-shadergraph").files.items() if file.endswith(".hlsl")
    )
    ports = re.findall(
        r"^    (float\d) (\w+),$", text.partition("void Unlit_float(")[2].partition(") {")[0], re.MULTILINE
    )
    assert {("float3", "V"), ("float3", "N"), ("float2", "screen_uv")} <= set(ports)
    given = ", ".join("float4(v, 1.0)" if type == "float4" else f"({type})v" for type, _ in ports)
    call = f"float4 color; Unlit_float({given}, color); return color.rgb;"
    text += f"\nfloat3 called(float3 v) {{ {call} }}\n"
    lanes = np.array([[0.0, 0.0, 0.3], [0.0, 1e-25, 0.4], [0.0, 0.0, 0.5]])
    (result,) = machine.run(Text(text), [Call("called", (VEC3,), VEC3, (lanes,))])
    assert_numbers(result)


NORMALISING = re.compile(
    r"\b(?:normalize|UnityObjectToWorldNormal|UnityObjectToWorldDir|UnityWorldToObjectDir|TransformWorldToObjectDir"
    r"|GetWorldSpaceNormalizeViewDir)\((?!float3\(0\.5, 0\.5, -0\.5\))"
)
"""Operations that give NaN for 0, with an argument that is not a constant."""


@pytest.mark.parametrize("probe", some_slow(MATERIALS, "lit", "unlit"))
def test_the_probes_compile(
    probe: str, compiled_shell: Callable[[str, str], Compiled], assert_compiles: Callable[[Source], None]
) -> None:
    """The probes compile in all passes, as does a surface shader of the built-in pipeline with every direction."""
    for target in all_targets():
        for source in sources(compiled_shell(probe, target).files):
            assert_compiles(source)


@pytest.mark.parametrize("target", [target for target in all_targets() if target != "numpy"])
def test_no_shell_normalises_by_itself(target: str, compiled_shell: Callable[[str, str], Compiled]) -> None:
    """No pass normalises without a guard, not even those that are not drawn. Guards are defined exactly where used."""
    names = [name for name in examples() if name not in ALIKE[1:] and carries(target, name)]
    compiled = [compile(load_material(name), target) for name in names]
    compiled += [compiled_shell(probe, target) for probe in MATERIALS]
    for shader in compiled:
        for file, places in shader.reflection["source_map"].items():
            lines = enumerate(shader.files[file].splitlines(), 1)
            shell = [line for number, line in lines if str(number) not in places]
            assert [line for line in shell if NORMALISING.search(line)] == [], file
            calls = [line for line in shell if re.search(r"\b(?:sss_)?safe_normalize\w*\(", line)]
            defined = re.search(r"^\s*(?!return)\S+ (?:sss_)?safe_normalize\w*\(", shader.files[file], re.MULTILINE)
            assert not calls or defined, f"{file}: a function is called and not defined"


@pytest.mark.parametrize("target", [target for target in all_targets() if target != "numpy"])
def test_a_technique_can_use_a_name_of_the_shell(target: str, tmp_path: Path) -> None:
    """The author's function gets another name; the function of the shell keeps its name."""
    text = UNLIT.replace("/**", "vec3 unit_vector(world_direction v) { return vec3(v) * 0.5; }\n/**", 1)
    (tmp_path / "unlit.sss").write_text(text.replace("0.5 + 0.1", "unit_vector(N) + 0.1"), encoding="utf-8")
    (tmp_path / "unlit.toml").write_text(MATERIALS["unlit"], encoding="utf-8")
    compiled = compile(load_material(str(tmp_path / "unlit.toml")), target)
    prefix = all_targets()[target].prefix.format(material=compiled.reflection["material"])
    renamed = f"{prefix}unit_vector(" if prefix else "unit_vector_("
    assert any(renamed in text for text in compiled.files.values())
