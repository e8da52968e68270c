"""The hero pictures of docs/heroes.py: their models, materials and film, without drawing."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.material.material_loading import load_material
from sssgen.pipeline.compiler import compile

ROOT = Path(__file__).parents[2]
MATERIALS = sorted(file for file in (ROOT / "docs" / "heroes").glob("*/*.toml") if file.name != "hero.toml")


@pytest.fixture
def stage(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The modules of the heroes."""
    pytest.importorskip("scipy")
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    import hero_stage.hair
    import hero_stage.hero
    import hero_stage.human
    import hero_stage.shapes

    yield hero_stage
    for name in [name for name in sys.modules if name.startswith("hero_stage")]:
        del sys.modules[name]


@pytest.mark.parametrize("path", MATERIALS, ids=lambda path: path.stem)
def test_materials_of_heroes_are_emitted(path: Path) -> None:
    files = compile(load_material(str(path)), "threejs").files
    assert "createMaterial" in files[f"{path.stem}.js"]


def test_heroes_name_what_they_have(stage: Any) -> None:
    assert len(stage.hero.heroes()) >= 6
    for name in stage.hero.heroes():
        hero = stage.hero.load(name)
        assert hero.lamps and hero.bodies, name
        for body in hero.bodies:
            assert (hero.folder / body.material).is_file(), name
            assert "passed" in body.medium or len(body.medium["absorption"]) == 3, name


def test_a_hero_has_photons_of_its_own_and_bakes_only_what_scatters(stage: Any, tmp_path: Path) -> None:
    import dataclasses

    from hero_stage.mesh import Mesh
    from hero_stage.prepare import bake, bake_name

    bears, honey = stage.hero.load("gummy_bears"), stage.hero.load("honey")
    corner = Mesh(np.eye(3), np.array([[0, 1, 2]]), np.eye(3))
    names = {bake_name(dataclasses.replace(bears, photons=count), bears.bodies[0], corner) for count in (800, 1200)}
    assert len(names) == 2
    assert bake(honey, honey.bodies[0], corner, tmp_path) is None
    assert not list(tmp_path.iterdir())


def test_a_meshed_ball_is_a_ball(stage: Any) -> None:
    pytest.importorskip("skimage")
    mesh = stage.shapes.meshed(lambda p: stage.shapes.sphere(p, (0.1, 0, 0), 0.7), (-1, -1, -1), (1, 1, 1), 24)
    away = mesh.vertices - [0.1, 0.0, 0.0]
    assert np.abs(np.linalg.norm(away, axis=1) - 0.7).max() < 1e-3
    assert np.abs(mesh.normals - away / 0.7).max() < 1e-2
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    assert np.einsum("nc,nc->", a, np.cross(b, c)) / 6.0 == pytest.approx(4.0 / 3.0 * np.pi * 0.7**3, rel=0.01)


def test_joined_bodies_flow_together_where_they_meet(stage: Any) -> None:
    p = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]])
    first, second = stage.shapes.sphere(p, (-0.5, 0, 0), 0.5), stage.shapes.sphere(p, (0.5, 0, 0), 0.5)
    both = stage.shapes.joined(first, second, blend=0.2)
    assert both[0] == pytest.approx(-0.2 / 6.0)
    assert both[1] == min(first[1], second[1])


def test_a_floor_darkens_what_faces_it(stage: Any) -> None:
    pytest.importorskip("skimage")
    pytest.importorskip("embreex")
    ball = stage.shapes.meshed(
        lambda p: stage.shapes.sphere(p, (0, 0.5, 0), 0.5), (-0.6, -0.1, -0.6), (0.6, 1.1, 0.6), 12
    )
    seen = ball.with_colors(floor=0.0).colors[:, 3]
    up = ball.normals[:, 1]
    assert seen[up > 0.9].min() > 0.9
    assert seen[up < -0.9].max() < 0.4


CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
SIDES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


def test_a_subdivided_cube_is_round_and_closed(stage: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = stage.human.mesh(*stage.human.subdivided(CUBE, SIDES, 3))
    away = np.linalg.norm(mesh.vertices, axis=1)
    assert away.max() / away.min() < 1.15
    body = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    assert body.is_watertight and body.volume > 0.0
    assert np.einsum("nc,nc->n", mesh.normals, mesh.vertices).min() > 0.0


def test_an_open_mesh_gets_a_lid(stage: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    vertices, quads = stage.human.subdivided(CUBE, SIDES, 2)
    volume = trimesh.Trimesh(vertices, stage.human.mesh(vertices, quads).faces, process=False).volume
    open_part = stage.human.kept(vertices, quads, vertices[:, 1] > -1e-6)  # the upper half
    mesh = stage.human.mesh(*stage.human.closed(*open_part))
    body = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    assert body.is_watertight
    assert body.volume == pytest.approx(0.5 * volume)


def test_hairs_go_from_their_roots_along_their_ways(stage: Any) -> None:
    roots, ways = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    mesh = stage.hair.strands(roots, ways, np.array([0.5, 0.25]), 0.01, np.zeros((2, 3)), 4)
    rings = mesh.vertices.reshape(2, 5, 3, 3).mean(axis=2)
    assert rings[:, 0] == pytest.approx(roots)
    assert rings[:, -1] == pytest.approx(roots + ways * [[0.5], [0.25]])


def test_a_mesh_file_has_colours_and_texture_coordinates(stage: Any, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = stage.human.mesh(CUBE, SIDES)
    both = stage.human.Mesh(mesh.vertices, mesh.faces, mesh.normals, np.full((8, 4), 0.5), CUBE[:, :2])
    both.write_glb(tmp_path / "cube.glb")
    visual = next(iter(trimesh.load(tmp_path / "cube.glb", force="scene").geometry.values())).visual
    assert np.asarray(visual.vertex_attributes["color"])[:, 0] == pytest.approx(128, abs=1)
    assert np.ptp(visual.uv, axis=0) == pytest.approx([2.0, 2.0])


def test_a_flame_is_split_into_pieces_of_one_color(stage: Any) -> None:
    from hero_stage.mesh import Mesh
    from hero_stage.traced import pieces_of_one_color

    vertices = np.random.default_rng(0).random((60, 3))
    colors = np.column_stack([np.repeat(vertices[:20, :1], 3, axis=0) * [1.0, 0.5, 0.0], np.ones(60)])
    mesh = Mesh(vertices, np.arange(60).reshape(-1, 3), np.ones((60, 3)), colors=colors)
    pieces = pieces_of_one_color(mesh)
    assert sorted(np.concatenate([piece.faces for _, piece in pieces])[:, 0]) == list(range(0, 60, 3))
    for color, piece in pieces:
        assert np.abs(colors[piece.faces, :3] - color).max() <= 0.5 / 16
        assert not len(piece.colors)
