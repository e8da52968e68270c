"""Engines draw the passes of a material themselves: pictures of the body alone, seen from the eye and from lights."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import sssgen
from engine_cases import BLACK, ENGINES, HEAD, PAGES, mesh_of, pages, through
from skips import or_skip
from slow_cases import diagonal
from sssgen.material.material_loading import load_material
from sssgen.run.backends import Array, engine_page
from sssgen.run.backends.backend_interface import VERTEX_SIZE
from sssgen.run.backends.engine_page import EngineDrawing, EnginePage
from sssgen.run.render import page_values
from sssgen.run.render.scene_render import PlacedMesh
from sssgen.run.render.scene_values import shell_of
from sssgen.scene import scene_loading
from sssgen.scene.solids import Torus
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture
from torus_cases import SEVERAL, inner_pixels, lengths_scene, torus_mesh, torus_scene


@pytest.fixture(scope="module")
def page(request: pytest.FixtureRequest) -> Iterator[EnginePage]:
    target, name = request.param
    renderer: EnginePage = or_skip(partial(EnginePage, ENGINES[target]), name)
    yield renderer
    renderer.page.close()


ONE_PAGE = pages(("babylonjs", "webgl"))
NODES = [page for page in PAGES if page.id in ("threejs-webgpu", "threejs-webgl2")]
"""Those of three.js whose shaders are made of nodes."""
LIGHTS = [pytest.param(True, id="layers of each light"), pytest.param(False, id="depth map")]


class Case(NamedTuple):
    """A scene with the mesh of its points."""

    path: str
    mesh: PlacedMesh
    expected: Array
    """The light that comes through by the oracle."""


@pytest.fixture(scope="module")
def case_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[bool], Case]:
    """The scene with one light or with several."""

    @cache
    def case(several: bool) -> Case:
        path = torus_scene(tmp_path_factory.mktemp("torus"), SEVERAL if several else "")
        mesh = mesh_of(path)
        return Case(path, mesh, through(str(Path(path).with_name("jade.toml")), mesh))

    return case


def differences(page: EnginePage, case: Case, **properties: Any) -> Array:
    """Of the light that comes through from that of the oracle, in each pixel but those at the edge."""
    scene = scene_loading.load(case.path)
    assert isinstance(scene.geometry, Torus)
    vertices, triangles = torus_mesh(scene.geometry)
    compiled = sssgen.compile(scene.material, page.engine.target)
    mesh, shell = case.mesh, case.mesh.shell
    drawing = EngineDrawing(
        page_values.modules_of(compiled), mesh.size, vertices, triangles, shell.view_projection, shell.camera_position,
        shell.model, shell.light_positions, shell.light_colors, properties=BLACK[page.engine.target] | properties,
    )  # fmt: skip
    drawn = page.draw(drawing)
    inner = inner_pixels(mesh.hit)
    assert case.expected[..., :3][inner].mean() > 0.05
    result: Array = np.abs(drawn - case.expected)[..., :3][inner].max(axis=-1)
    return result


@pytest.mark.parametrize(("page", "several"), diagonal(PAGES, LIGHTS), indirect=["page"])
def test_the_engine_draws_the_passes(page: EnginePage, several: bool, case_of: Callable[[bool], Case]) -> None:
    """Without textures from the page, the light that comes through is that of the oracle."""
    # the oracle's depths are half floats, so that every back end has the same
    assert np.quantile(differences(page, case_of(several)), 0.98) < 1.0 / 255.0


@pytest.mark.parametrize("page", ONE_PAGE, indirect=True)
def test_the_eyes_layers(page: EnginePage, tmp_path: Path) -> None:
    """The length inside the ring's near side, the gap behind it, and the length inside its far side."""
    path = lengths_scene(tmp_path)
    mesh = mesh_of(path)
    expected = through(str(tmp_path / "jade.toml"), mesh)
    inside = expected[..., :3][mesh.hit]
    assert (inside[:, 2] > 0.05).sum() > 200, "the far side is behind the near one"
    assert np.quantile(differences(page, Case(path, mesh, expected)), 0.95) < 1.0 / 255.0


@pytest.mark.parametrize(("page", "several"), diagonal(ONE_PAGE, LIGHTS), indirect=["page"])
def test_a_rectangle_of_light_is_as_a_point(page: EnginePage, several: bool, tmp_path: Path) -> None:
    """A pass shows the body from the rectangle's centre: what comes through is that of a point light there.

    The rectangle is small, but where a chain finds the view of a light by the way to it.
    """
    scene = scene_loading.load(torus_scene(tmp_path, SEVERAL if several else ""))
    assert isinstance(scene.geometry, Torus)
    vertices, triangles = torus_mesh(scene.geometry)
    shell = shell_of(scene, load_material(scene.material), sssgen.compile(scene.material, "numpy").reflection)
    place = np.array([2.0, 3.0, -4.0])
    z = place / np.linalg.norm(place)
    x = np.cross([0.0, 1.0, 0.0], z) / np.hypot(z[0], z[2])
    model = np.eye(4)
    model[:3] = np.stack([x, np.cross(z, x), z, place], axis=-1)
    size = np.array([0.3, 0.2]) * (10.0 if several else 1.0)
    radiance = np.pi * place @ place / size.prod()
    area = {"model": model.T.ravel().tolist(), "size": size.tolist(), "radiance": radiance}
    drawing = EngineDrawing(
        page_values.modules_of(sssgen.compile(scene.material, page.engine.target)), (96, 72), vertices, triangles,
        shell.view_projection, shell.camera_position, shell.model, properties=BLACK[page.engine.target],
    )  # fmt: skip
    point = page.draw(
        drawing._replace(light_positions=np.array([[*place, 1.0]]), light_colors=np.full((1, 3), place @ place))
    )
    rectangle = page.draw(drawing._replace(properties={**drawing.properties, "stage": {"area": area}}))
    assert point[..., :3].max() > 0.05
    assert np.abs(rectangle - point)[..., :3].max() < 0.05 * point[..., :3].max()


ELSEWHERE = {"size": 2.0, "model": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 3, -5, 1]}
"""A copy of the body."""


@pytest.mark.parametrize("page", [page for page in PAGES if page.values[0][0] == "babylonjs"], indirect=True)
@pytest.mark.parametrize("stage", [{"leftHanded": True}, {"copies": [ELSEWHERE]}], ids=["left-handed", "two bodies"])
def test_other_scenes(page: EnginePage, stage: dict[str, Any], case_of: Callable[[bool], Case]) -> None:
    """A left-handed scene, which is Babylon's default; a second body of the material, with pictures of its own."""
    assert np.quantile(differences(page, case_of(False), stage=stage), 0.98) < 1.0 / 255.0


@pytest.mark.slow
@pytest.mark.parametrize("page", [("threejs", "webgl"), ("threejs", "webgl2")], ids="-".join, indirect=True)
def test_two_renderers(page: EnginePage, case_of: Callable[[bool], Case]) -> None:
    """Another renderer has drawn the object before, with pictures of its own."""
    first = "webgl2" if page.name == "webgl" else "webgl"
    assert np.quantile(differences(page, case_of(True), stage={"first": first}), 0.98) < 1.0 / 255.0


@pytest.mark.parametrize(("page", "size"), diagonal(ONE_PAGE, [0.5, 1.0]), indirect=["page"])
def test_values_of_the_object_come_from_its_matrix(page: EnginePage, size: float) -> None:
    """wax_mouse and another one of half its size have one material; the page sets no scale."""
    mesh, target = mesh_of("wax_mouse"), page.engine.target
    compiled = sssgen.compile("wax_mouse", target)
    half = np.diag([0.5, 0.5, 0.5, 1.0])
    half[:3, 3] = [0.3, -0.2, 0.1]
    own = mesh.shell
    moved, other = (half, np.eye(4)) if size == 0.5 else (np.eye(4), half)
    shell = dataclasses.replace(
        own,
        model=moved @ own.model,
        camera_position=tuple(moved[:3, :3] @ own.camera_position + moved[:3, 3]),
        view_projection=own.view_projection @ np.linalg.inv(moved),
        parameters={**own.parameters, "object_scale": (size * own.parameters["object_scale"][0],)},
        ambient=(0.0, 0.0, 0.0),
    )
    assert shell.unplaced(compiled.reflection["uniforms"])["object_scale"] == pytest.approx([1.0])
    elsewhere = other @ own.model
    elsewhere[:3, 3] += [9.0, 3.0, -5.0]
    stage = {"copies": [{"size": 1.0, "model": elsewhere.T.ravel().tolist()}]}
    drawn = page_values.shade(compiled, shell, page, mesh.size, mesh.points, BLACK[target] | {"stage": stage})
    expected, whole = (through("wax_mouse", mesh._replace(shell=one)) for one in (shell, own))
    assert np.abs(drawn - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert (np.abs(whole - expected)[..., :3][mesh.hit].max() > 0.02) == (size == 0.5), "the size matters"


def bare(target: str, name: str) -> EngineDrawing:
    """A triangle with a material, without its textures."""
    modules = page_values.modules_of(sssgen.compile(name, target))
    vertices = np.zeros((3, VERTEX_SIZE))
    vertices[1:, :2] = np.eye(2)
    view = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 2.0], [0, 0, -1, 3.0]])
    light = np.array([[0.0, 0.0, 1.0, 0.0]])
    return EngineDrawing(
        modules, (4, 3), vertices, [[0, 1, 2]], view, (0.0, 0.0, 3.0), np.eye(4), light, np.ones((1, 3))
    )


@pytest.mark.parametrize("page", ONE_PAGE, indirect=True)
def test_a_texture_that_is_missing_is_named_once(page: EnginePage) -> None:
    """The console has the command that bakes it; what is optional may be missing. A second body says nothing more."""
    drawing = bare(page.engine.target, "wax_mouse")
    copies = {"stage": {"copies": [ELSEWHERE]}}
    command = r"`sssgen bake sdf MESH -o wax_mouse_sdf\.raw --format raw\+json --encode r16f`"
    missing = rf"error: \w+: wax_mouse: 'distanceMap' is missing: load wax_mouse_sdf\.raw, which {command} makes$"
    with pytest.raises(SssgenError, match=missing):
        page.draw(drawing._replace(properties=copies))
    volume = Texture(np.ones((2, 2, 2, 4), np.float32))
    assert np.isfinite(page.draw(drawing._replace(textures={"distanceMap": volume}))).all()
    assert np.isfinite(page.draw(bare(page.engine.target, "jade_ring"))).all(), "it draws its texture itself"


@pytest.mark.parametrize("page", NODES, indirect=True)
def test_a_mesh_without_texture_coordinates_is_one_warning(page: EnginePage, monkeypatch: pytest.MonkeyPatch) -> None:
    """Though three builds a shader for its shadow, too."""
    uvs = {name: place for name, place in engine_page.ATTRIBUTES.items() if not name.startswith("uv")}
    monkeypatch.setattr(engine_page, "ATTRIBUTES", uvs)
    said = r"error: threejs: Mesh: the geometry has no attribute 'uv', which the material reads: it is 0$"
    with pytest.raises(SssgenError, match=said):
        page.draw(bare("threejs", "skin_ear")._replace(properties={"stage": {"shadows": True}}))


TRANSFORMS = {"threejs": "coverTexture.rotation", "babylonjs": "coverTexture.uScale"}


@pytest.mark.parametrize("page", [page for page in ONE_PAGE if page.values[0][0] in TRANSFORMS], indirect=True)
def test_a_transform_of_a_texture_is_not_applied(page: EnginePage) -> None:
    drawing = bare(page.engine.target, "ice")._replace(
        textures={"coverTexture": Texture(np.ones((2, 2, 4), np.float32))}
    )
    assert np.isfinite(page.draw(drawing)).all()
    with pytest.raises(SssgenError, match=r"ice: 'coverTexture' has a transform, .*: the technique uv_transform moves"):
        page.draw(drawing._replace(properties={TRANSFORMS[page.engine.target]: 2.0}))


PLACED = f"""/// To a texture of the body.
uniform mat4 to_texture : placed = mat4(1.0);
{HEAD.format("surface")}void shown(world_position P, out vec3 emission)
{{ emission = abs((to_texture * vec4(vec3(P), 1.0)).xyz); }}
"""


@pytest.mark.parametrize("page", ONE_PAGE, indirect=True)
def test_matrices_of_the_object_come_from_its_matrix(page: EnginePage, tmp_path: Path) -> None:
    """A body that is turned, stretched and mirrored, and one elsewhere."""
    (tmp_path / "shown.sss").write_text(PLACED, encoding="utf-8")
    material = tmp_path / "made.toml"
    material.write_text('[material]\nname = "made"\n[[surface]]\ntechnique = "./shown.sss"\n', encoding="utf-8")
    mesh, target = mesh_of("wax_mouse"), page.engine.target
    changed = np.array([[0.0, -1.5, 0.0, 0.3], [-2.0, 0.0, 0.0, 0.1], [0.0, 0.0, 0.5, 0.2], [0.0, 0.0, 0.0, 1.0]])
    to_texture = np.diag([0.2, 0.4, 0.3, 1.0]) @ np.linalg.inv(changed)
    points = mesh.points.copy()
    moved = np.linalg.inv(changed) @ mesh.shell.model  # the same points in the world
    points[:, :3] = points[:, :3] @ moved[:3, :3].T + moved[:3, 3]
    points[:, 3:6] = points[:, 3:6] @ np.linalg.inv(moved[:3, :3])
    shell = dataclasses.replace(
        mesh.shell, model=changed, parameters={"to_texture": to_texture.T.ravel()}, textures={}, ambient=(0.0, 0.0, 0.0)
    )
    compiled = sssgen.compile(str(material), target)
    properties = BLACK[target] | {"stage": {"copies": [ELSEWHERE]}}
    drawn = page_values.shade(compiled, shell, page, mesh.size, points, properties)
    expected = through(str(material), mesh._replace(shell=shell, points=points))
    assert np.abs(drawn - expected)[..., :3][mesh.hit].max() < 1.0 / 255.0
    assert expected[..., :3][mesh.hit].std() > 0.02
