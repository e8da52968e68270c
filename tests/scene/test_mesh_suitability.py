"""Warnings of meshes that do not suit a material."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_suitability import MeshNeeds, mesh_warnings, size_warnings

pytest.importorskip("igl")
INSIDE = MeshNeeds(inside=True)
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = np.array([
    [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
])  # fmt: skip


def mesh(path: Path, *boxes: float, faces: np.ndarray = FACES, uv: bool = False) -> Mesh:
    """Cubes around the origin with these half sides."""
    lines = [f"v {x} {y} {z}" for half in boxes for x, y, z in half * CORNERS]
    lines += ["vt 0 0", "vt 1 0", "vt 0 1"] if uv else []
    for number in range(len(boxes)):
        for first, second, third in faces + 1 + 8 * number:
            lines.append(f"f {first}/1 {second}/2 {third}/3" if uv else f"f {first} {second} {third}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Mesh(path=str(path))


def test_a_closed_mesh_suits(tmp_path: Path) -> None:
    assert mesh_warnings(mesh(tmp_path / "box.obj", 1.0), INSIDE._replace(paths=5.0)) == []


def test_holes_and_parts_inside_each_other_matter_for_light_inside_alone(tmp_path: Path) -> None:
    open_box = mesh(tmp_path / "open.obj", 1.0, faces=FACES[:-1])
    assert mesh_warnings(open_box, MeshNeeds()) == []
    (warning,) = mesh_warnings(open_box, INSIDE)
    assert "has holes (3 open edges)" in warning
    nested = mesh(tmp_path / "nested.obj", 1.0, 0.5, 0.25)
    assert mesh_warnings(nested, MeshNeeds()) == []
    (warning,) = mesh_warnings(nested, INSIDE)
    assert "2 of the mesh's 3 parts are inside another" in warning


@pytest.mark.parametrize(("place", "is_far"), [(100.0, False), (1e4, True)])
def test_a_mesh_far_from_the_origin_is_coarse(place: float, is_far: bool, tmp_path: Path) -> None:
    box = mesh(tmp_path / "box.obj", 1.0)
    text = Path(box.path).read_text(encoding="utf-8")
    lines = [
        f"v {float(line.split()[1]) + place} {' '.join(line.split()[2:])}" if line.startswith("v ") else line
        for line in text.splitlines()
    ]
    Path(box.path).write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert any("away from the origin" in text for text in mesh_warnings(Mesh(path=box.path), MeshNeeds())) == is_far


def test_a_body_on_its_copy_is_one_body(tmp_path: Path) -> None:
    single, double = mesh(tmp_path / "single.obj", 1.0), mesh(tmp_path / "double.obj", 1.0, 1.0)
    assert double.triangles.repeated == len(FACES) and len(double.triangles.corners) == len(single.triangles.corners)
    (warning,) = mesh_warnings(double, INSIDE)
    assert "12 triangles are there twice: they are left out here" in warning
    sheet = mesh(tmp_path / "sheet.obj", 1.0, faces=np.array([[0, 1, 3], [0, 3, 1]]))
    assert sheet.triangles.repeated == 0, "both sides of a sheet stay"


def test_parts_beside_each_other_suit(tmp_path: Path) -> None:
    both = mesh(tmp_path / "both.obj", 1.0, 0.5)
    text = Path(both.path).read_text(encoding="utf-8").splitlines()
    text[8:16] = [f"v {x} {y} {z}" for x, y, z in 0.5 * CORNERS + [3.0, 0.0, 0.0]]
    Path(both.path).write_text("\n".join(text), encoding="utf-8")
    assert mesh_warnings(Mesh(path=both.path), INSIDE) == []


def test_normals_that_look_inwards_and_mixed_ones(tmp_path: Path) -> None:
    (warning,) = mesh_warnings(mesh(tmp_path / "in.obj", 1.0, faces=FACES[:, ::-1]), INSIDE)
    assert "inside out" in warning
    mixed = FACES.copy()
    mixed[0] = mixed[0, ::-1]
    turned = mesh(tmp_path / "mixed.obj", 1.0, faces=mixed)
    (warning,) = mesh_warnings(turned, INSIDE)
    assert warning.startswith("1 triangle faces the other way than its neighbours: turned here; do so in the file")
    (warning,) = mesh_warnings(turned, INSIDE._replace(written="body.glb"))
    assert warning.endswith("turned here and in body.glb")


def test_a_part_that_is_inside_out(tmp_path: Path) -> None:
    lines = [f"v {x} {y} {z}" for at in (0.0, 3.0) for x, y, z in CORNERS + np.array([at, 0.0, 0.0])]
    faces = [*(FACES + 1).tolist(), *(FACES[:, ::-1] + 9).tolist()]
    lines += [f"f {first} {second} {third}" for first, second, third in faces]
    (tmp_path / "two.obj").write_text("\n".join(lines), encoding="utf-8")
    (warning,) = mesh_warnings(Mesh(path=str(tmp_path / "two.obj")), INSIDE)
    assert warning == "1 of the mesh's 2 parts is inside out: turn the triangles in the file"


def test_sheets_have_no_inside(tmp_path: Path) -> None:
    flat = mesh(tmp_path / "flat.obj", 1.0, faces=np.r_[FACES[:1], FACES[:1, ::-1]])
    (warning,) = mesh_warnings(flat, INSIDE)
    assert "encloses no volume" in warning and "leaf or paper" in warning
    assert mesh_warnings(flat, MeshNeeds()) == []


def test_textures_need_coordinates(tmp_path: Path) -> None:
    needs = MeshNeeds(textures=("base_color",))
    assert mesh_warnings(mesh(tmp_path / "uv.obj", 1.0, uv=True), needs) == []
    (warning,) = mesh_warnings(mesh(tmp_path / "box.obj", 1.0), needs)
    assert "no texture coordinates, and base_color reads a texture" in warning


def test_a_body_of_few_mean_free_paths(tmp_path: Path) -> None:
    (warning,) = mesh_warnings(mesh(tmp_path / "box.obj", 1.0), INSIDE._replace(paths=0.4))
    assert "0.4 mean free paths thick" in warning and "leaf or paper" in warning


def test_a_body_of_many_mean_free_paths_looks_opaque() -> None:
    assert size_warnings(57.7) == []
    (warning,) = size_warnings(1.2e3)
    assert "1.2e+03 mean free paths thick" in warning and "--size" in warning
