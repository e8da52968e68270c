"""The computations of our shells are finite on hostile points too, for any input of a mesh or a program.

Drawn on a mesh of one vertex a pixel, as `sssgen render` does, into pictures of floats, which nothing clamps. What the
built-in pipeline's surface shaders do with a normal of 0 is Unity's own: there the unlit shader is drawn.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sssgen.harness.backends import Array, Backend, Call, Text
from sssgen.harness.backends.unity_backend import UnityHLSL
from sssgen.harness.check.compiler_inputs import sources
from sssgen.harness.compilers import Source
from sssgen.harness.render.shade import shade
from sssgen.harness.render.shell_values import Shell
from sssgen.ir.types import VEC3
from sssgen.material.material_loading import examples, load_material
from sssgen.pipeline.compiler import Compiled, all_targets, compile

PLAIN = ["numpy", "numpy-f32", "gl", "gl-es", "webgpu", "hlsl", "hlsl-glslang"]
DRAWN = [*((name, probe) for name in [*PLAIN, "unity-urp"] for probe in ("lit", "unlit")), ("unity", "unlit")]
SIZE = (8, 6)
BRIGHT = 1e8
"""More than the lights here can give."""

INPUTS = "world_direction V, world_direction N, world_direction T, world_direction B, object_direction V_object, "
INPUTS += "object_direction N_object"
LIT = f"""
/** Shows what a shell gives a surface.
role: surface
*/
void shown({INPUTS}, inout tangent_direction normal, out vec3 emission) {{
    emission = 0.5 + 0.1 * vec3(V + N + T + B + vec3(V_object) + vec3(N_object));
}}
"""
THROUGH = """
/** Shows what a shell gives a light.
role: translucency
*/
vec3 through(world_direction V, world_direction N, world_direction L, object_direction L_object) {
    return 0.5 + 0.1 * vec3(V + N + L + vec3(L_object));
}
"""
UNLIT = f"""
/** Shows what a shell gives an unlit material.
role: lighting
*/
vec3 unlit({INPUTS}, world_direction L, object_direction L_object) {{
    return 0.5 + 0.1 * vec3(V + N + T + B + vec3(V_object) + vec3(N_object) + L + vec3(L_object));
}}
"""
RAYS = """
/** Shows what a shell gives a raymarched material.
role: lighting
*/
vec3 rays(world_direction ray_direction) {
    return 0.5 + 0.1 * ray_direction;
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

FRONT = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.5, 0.5])
"""A vertex that faces +z; its place is filled in."""
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
"""So near to each other are the points where something stands at the surface: their distance squared is 0."""
MAGNIFIED = dataclasses.replace(SHELL, view_projection=np.diag([1.0 / NEAR, 1.0 / NEAR, 1.0, 1.0]))
HERE = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""A light from afar without a direction, and one at the surface."""


def at_one_place() -> Array:
    points = grid()
    points[:, :2] *= NEAR
    return points


HOSTILE: dict[str, tuple[Array, Shell]] = {
    "normal 0": (grid(normal=np.zeros(3)), SHELL),
    "tiny normal": (grid(normal=np.array([0.0, 0.0, 1e-25])), SHELL),
    "tangent 0": (grid(tangent=np.zeros(3)), SHELL),
    "camera at the surface": (at_one_place(), dataclasses.replace(MAGNIFIED, camera_position=(0.0, 0.0, 0.0))),
    "light at the surface": (at_one_place(), dataclasses.replace(MAGNIFIED, light_positions=HERE)),
    "camera and light at the surface": (
        at_one_place(),
        dataclasses.replace(MAGNIFIED, light_positions=HERE, camera_position=(0.0, 0.0, 0.0)),
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
    """No NaN and no infinity by the bits, and no value that clamping them would give."""
    bits = np.ascontiguousarray(picture, np.float32).view(np.uint32)
    assert ((bits >> 23) & 0xFF != 0xFF).all()
    assert np.abs(picture).max() < BRIGHT


def inner(picture: Array) -> Array:
    """Without the outermost pixels, which the mesh may not cover."""
    return picture[1:-1, 1:-1]


@pytest.mark.parametrize(("name", "probe"), DRAWN)
@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_points(
    case: str, probe: str, name: str, backend: Callable[[str], Backend], compiled_shell: Callable[[str, str], Compiled]
) -> None:
    machine, (points, shell) = backend(name), HOSTILE[case]
    if name.startswith("numpy"):  # without triangles, and with smaller numbers: the points may be one
        points = np.where(np.abs(points) < 1e-20, 0.0, points)
    picture = shade(machine, compiled_shell(probe, machine.target.name), shell, SIZE, points)
    assert_numbers(picture)
    if case != "model 0":  # which draws nothing
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
    """In Unity a ray ends on the mesh that it is drawn on."""
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
    """A direction shorter than 1 gives a highlight of its inverse cube: a normal has length 1, or 0 and is not lit."""
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
    """Shader Graph's function, called with directions of 0 and in an object whose matrices are 0."""
    backend("unity-urp")
    machine = UnityHLSL("unity-shadergraph", "unity-shadergraph", "dxc")
    (text,) = (
        text for file, text in compiled_shell("unlit", "unity-shadergraph").files.items() if file.endswith(".hlsl")
    )
    ports = re.findall(r"^    float3 (\w+),$", text.partition("void Unlit_float(")[2].partition(") {")[0], re.MULTILINE)
    assert {"V", "N"} <= set(ports)
    call = f"float4 color; Unlit_float({', '.join('v' for _ in ports)}, color); return color.rgb;"
    text += f"\nfloat3 called(float3 v) {{ {call} }}\n"
    lanes = np.array([[0.0, 0.0, 0.3], [0.0, 1e-25, 0.4], [0.0, 0.0, 0.5]])
    (result,) = machine.run(Text(text), [Call("called", (VEC3,), VEC3, (lanes,))])
    assert_numbers(result)


NORMALISING = re.compile(
    r"\b(?:normalize|UnityObjectToWorldNormal|UnityObjectToWorldDir|UnityWorldToObjectDir|TransformWorldToObjectDir"
    r"|GetWorldSpaceNormalizeViewDir)\((?!float3\(0\.5, 0\.5, -0\.5\))"
)
"""What makes NaN of 0, of any other than a constant."""


@pytest.mark.parametrize("probe", MATERIALS)
def test_the_probes_compile(
    probe: str, compiled_shell: Callable[[str, str], Compiled], assert_compiles: Callable[[Source], None]
) -> None:
    """In all passes, the built-in pipeline's surface shader with every direction among them."""
    for target in all_targets():
        for source in sources(compiled_shell(probe, target).files):
            assert_compiles(source)


@pytest.mark.parametrize("target", [target for target in all_targets() if target != "numpy"])
def test_no_shell_normalises_by_itself(target: str, compiled_shell: Callable[[str, str], Compiled]) -> None:
    """In no pass, those that are not drawn here among them; and the function is there just where it is called."""
    compiled = [compile(load_material(name), target) for name in examples()]
    compiled += [compiled_shell(probe, target) for probe in MATERIALS]
    for one in compiled:
        for file, places in one.reflection["source_map"].items():
            lines = enumerate(one.files[file].splitlines(), 1)
            shell = [line for number, line in lines if str(number) not in places]
            assert [line for line in shell if NORMALISING.search(line)] == [], file
            calls = sum(len(re.findall(r"\bunit_vector\(", line)) for line in shell)
            assert calls != 1, f"{file}: defined and not called, or called and not defined"


@pytest.mark.parametrize("target", [target for target in all_targets() if target != "numpy"])
def test_a_technique_can_use_a_name_of_the_shell(target: str, tmp_path: Path) -> None:
    """The author's function of that name gets another one; the shell's keeps it."""
    text = UNLIT.replace("/**", "vec3 unit_vector(world_direction v) { return vec3(v) * 0.5; }\n/**", 1)
    (tmp_path / "unlit.sss").write_text(text.replace("0.5 + 0.1", "unit_vector(N) + 0.1"), encoding="utf-8")
    (tmp_path / "unlit.toml").write_text(MATERIALS["unlit"], encoding="utf-8")
    compiled = compile(load_material(str(tmp_path / "unlit.toml")), target)
    assert any("unit_vector_(" in text for text in compiled.files.values())
