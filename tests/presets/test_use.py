"""`sssgen use`: the files of a project, errors, and what a repeated call keeps."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sssgen.cli.main import main
from sssgen.presets.engines import ENGINES
from sssgen.presets.used_mesh import Pose, used_mesh
from sssgen.presets.written_project import RECORD, WrittenProject
from sssgen.scene.mesh_files import read

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")

CORNERS = np.array([[x, y, z] for x in (0, 2) for y in (0, 1) for z in (0, 1)], float)


@pytest.fixture
def block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A block of 2 × 1 × 1, in a folder of its own."""
    import trimesh

    monkeypatch.chdir(tmp_path)
    trimesh.convex.convex_hull(CORNERS).export("block.obj")
    return "block.obj"


@pytest.mark.parametrize("target", ENGINES)
def test_a_project_has_the_material_the_mesh_and_what_opens_it(target: str, block: str) -> None:
    assert main(["use", "jade", block, "--target", target, "-o", "out"]) == 0
    files = {path.relative_to("out").as_posix() for path in Path("out").rglob("*") if path.is_file()}
    own = "jade/" if target == "unity-urp" else ""
    opened = {"godot": "project.godot", "gltf": "jade.glb", "unity-urp": "Editor/JadeScene.cs"}.get(
        target, "index.html"
    )
    wanted = {"jade.toml", "body.glb", "scene.toml", "surroundings.png", "README.md", opened}
    assert {own + name for name in wanted} <= files
    for name in files:
        if name.endswith((".md", ".js", ".html", ".toml", ".gd", ".tscn", ".cs", ".meta", ".mat")):
            text = Path("out", name).read_text(encoding="utf-8")
            assert not re.search(r"\{% |\{\{ [\w.]+ ", text), name
    assert f"sssgen use jade {block} --target {target}" in Path("out", own, "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(("words", "name"), [("Wax {}", "wax"), ("skin-fair {}", "skin_fair"), ("{} Jade", "jade")])
def test_names_of_presets_are_read_as_people_write_them(words: str, name: str, block: str) -> None:
    """Before or behind the mesh, too."""
    assert main(["use", *words.format(block).split(), "-o", "out"]) == 0
    assert f"sssgen use {name} {block} --target" in Path("out", "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("target", [name for name, engine in ENGINES.items() if engine.is_page])
def test_a_page_asks_for_no_icon(target: str, block: str) -> None:
    assert main(["use", "wax", block, "--target", target, "-o", "out"]) == 0
    assert '<link rel="icon" href="data:,">' in Path("out", "index.html").read_text(encoding="utf-8")


def test_a_repeated_call_changes_nothing(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["use", "wax", block, "-o", "out"]
    assert main(command) == 0 and "kept" not in capsys.readouterr().out
    assert main(command) == 0 and "wrote" not in capsys.readouterr().out


def test_edited_files_are_kept_without_force(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["use", "wax", block, "-o", "out"]
    assert main(command) == 0
    page = Path("out", "main.js")
    page.write_text("// mine\n", encoding="utf-8")
    assert main(command) == 2 and "main.js" in capsys.readouterr().err
    assert page.read_text(encoding="utf-8") == "// mine\n"
    assert main([*command, "--force"]) == 0 and "createMaterial" in page.read_text(encoding="utf-8")


def test_another_project_replaces_one_that_nobody_edited(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["use", "wax", block, "-o", "out"]) == 0
    Path("out", "mine.txt").write_text("notes", encoding="utf-8")
    assert main(["use", "jade", block, "-o", "out"]) == 0 and "removed out/wax.js\n" in capsys.readouterr().out
    assert not list(Path("out").glob("wax.*")) and "jade.js" in Path("out", "main.js").read_text(encoding="utf-8")
    assert main(["use", "jade", block, "-t", "godot", "-o", "out"]) == 0
    assert not Path("out", "index.html").exists() and not Path("out", "library").exists()
    assert Path("out", "mine.txt").exists()


def test_folders_that_become_empty_are_removed(tmp_path: Path) -> None:
    digests = {}
    for name in ("library/three/addons/loader.js", "library/three/three.js", "textures/a.png"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name, encoding="utf-8")
        digests[name] = hashlib.sha256(name.encode()).hexdigest()
    (tmp_path / "textures" / "mine.png").touch()
    assert len(WrittenProject("wax", digests).remove_others(str(tmp_path), ())) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["textures"]


@pytest.mark.parametrize("edited", ["wax.toml", "main.js"])
def test_another_project_replaces_no_edits(edited: str, block: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Neither where the new project has a file of the name, nor where it has none."""
    assert main(["use", "wax", block, "-o", "out"]) == 0
    with Path("out", edited).open("a", encoding="utf-8") as file:
        file.write("\n")
    before = {path: path.read_bytes() for path in Path("out").rglob("*") if path.is_file()}
    assert main(["use", "jade", block, "-o", "out"]) == 2
    error = capsys.readouterr().err
    assert f"the folder holds wax on block.obj for threejs, and files of it were edited: {edited}" in error
    assert f"--> out/{edited}" in error and "--force" in error
    assert {path: path.read_bytes() for path in Path("out").rglob("*") if path.is_file()} == before
    assert main(["use", "jade", block, "-o", "out", "--force"]) == 0
    assert Path("out", "wax.toml").exists() == (edited == "wax.toml") and not Path("out", "wax.js").exists()


def test_emit_replaces_no_edits_of_a_project(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    """But what it wrote there itself, after each change of the material."""
    assert main(["use", "wax", block, "-o", "out"]) == 0
    material, shader = Path("out", "wax.toml"), Path("out", "wax.js")
    emit = ["emit", str(material), "--target", "threejs", "-o"]
    for roughness in ("0.5", "0.6"):
        text = re.sub("surface_roughness = .*", f"surface_roughness = {roughness}", material.read_text("utf-8"))
        material.write_text(text, encoding="utf-8")
        before = shader.read_bytes()
        assert main([*emit, "out"]) == 0 and shader.read_bytes() != before
    emitted = shader.read_text("utf-8")
    shader.write_text(emitted + "// mine\n", encoding="utf-8")
    capsys.readouterr()
    assert main([*emit, "out"]) == 2 and shader.read_text("utf-8").endswith("// mine\n")
    error = capsys.readouterr().err
    assert "the file was edited since sssgen wrote it" in error and "--> out/wax.js" in error and "--force" in error
    assert main([*emit, "elsewhere"]) == 0 and main([*emit, "out", "--force"]) == 0
    assert shader.read_text("utf-8") == emitted == Path("elsewhere", "wax.js").read_text("utf-8")


@pytest.mark.parametrize("record", ["", "[]", '{"project": "wax", "files": {"../block.obj": ""}}'])
def test_without_a_right_record_nothing_is_replaced(
    record: str, block: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["use", "wax", block, "-o", "out"]) == 0
    Path("out", RECORD).write_text(record, encoding="utf-8")
    assert main(["use", "jade", block, "-o", "out"]) == 2
    assert "the file already exists, with another content" in capsys.readouterr().err and Path(block).exists()


def test_the_mesh_keeps_its_place_and_gets_normals(block: str) -> None:
    mesh = used_mesh(block, 40.0)
    assert (mesh.low, mesh.high) == ((0.0, 0.0, 0.0), (2.0, 1.0, 1.0))
    assert mesh.size.unit_mm == pytest.approx(20.0)
    assert mesh.size.mean_chord == pytest.approx(4.0 * 2.0 / 10.0)  # 4 V / S
    Path("body.glb").write_bytes(mesh.glb)
    content = read("body.glb")
    assert content.normals is not None and np.linalg.norm(content.normals, axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("pose", "low", "high"),
    [
        (Pose(turn=180.0), (-2, 0, -1), (0, 1, 0)),
        (Pose(turn=90.0), (0, 0, -2), (1, 1, 0)),
        (Pose(z_is_up=True), (0, 0, -1), (2, 1, 0)),
        (Pose(z_is_up=True, turn=-90.0), (0, 0, 0), (1, 1, 2)),
    ],
)
def test_a_body_is_turned(pose: Pose, low: tuple[int, ...], high: tuple[int, ...], block: str) -> None:
    mesh = used_mesh(block, 40.0, pose=pose)
    assert (mesh.low, mesh.high) == (pytest.approx(low), pytest.approx(high))
    content, center = mesh.content, 0.5 * np.add(low, high)
    first, second, third = np.moveaxis(content.vertices[content.faces], 1, 0)
    assert np.einsum("nc,nc->n", np.cross(second - first, third - first), first - center).min() > 0.0
    assert content.normals is not None and np.einsum("nc,nc->n", content.normals, content.vertices - center).min() > 0.0


def test_the_readme_says_how_a_body_was_turned(block: str) -> None:
    assert main(["use", "wax", block, "-o", "out", "--turn", "180", "--up", "z"]) == 0
    assert "--turn 180 --up z" in Path("out", "README.md").read_text(encoding="utf-8")


def test_a_mesh_that_is_inside_out_is_turned(block: str) -> None:
    import trimesh

    turned = trimesh.convex.convex_hull(CORNERS)
    turned.invert()
    turned.export("turned.obj")
    Path("body.glb").write_bytes(used_mesh("turned.obj", 40.0).glb)
    content = read("body.glb")
    first, second, third = np.moveaxis(content.vertices[content.faces], 1, 0)
    outwards = np.einsum("nc,nc->n", np.cross(second - first, third - first), first - CORNERS.mean(axis=0))
    assert (outwards > 0.0).all()
    assert content.normals is not None
    assert (np.einsum("nc,nc->n", content.normals, content.vertices - CORNERS.mean(axis=0)) > 0.0).all()


def test_an_open_mesh_has_a_warning(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(block).read_text(encoding="utf-8").splitlines()
    last = max(index for index, line in enumerate(lines) if line.startswith("f "))
    Path("open.obj").write_text("\n".join(lines[:last]), encoding="utf-8")
    assert main(["use", "wax", "open.obj", "-o", "out"]) == 0 and "has holes" in capsys.readouterr().out
    assert main(["use", "leaf", "open.obj", "-o", "leaf"]) == 0 and "has holes" not in capsys.readouterr().out


def test_a_body_that_cannot_be_baked_leaves_nothing(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = Path(block).read_text(encoding="utf-8").splitlines()
    last = max(index for index, line in enumerate(lines) if line.startswith("f "))
    Path("open.obj").write_text("\n".join(lines[:last]), encoding="utf-8")
    assert main(["use", "wax", "open.obj", "-o", "out", "--quality", "best"]) == 2 and not Path("out").exists()
    error = capsys.readouterr().err
    assert "the mesh has a hole" in error and "--> open.obj" in error and "--quality good" in error


def test_flipped_triangles_are_turned_in_the_written_mesh(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    import trimesh

    lines = Path(block).read_text(encoding="utf-8").splitlines()
    first = next(index for index, line in enumerate(lines) if line.startswith("f "))
    letter, *corners = lines[first].split()
    lines[first] = " ".join([letter, *corners[::-1]])
    Path("mixed.obj").write_text("\n".join(lines), encoding="utf-8")
    assert main(["use", "wax", "mixed.obj", "-o", "out"]) == 0
    assert "1 triangle faces the other way than its neighbours" in capsys.readouterr().out
    written = trimesh.load_mesh("out/body.glb")
    written.merge_vertices(merge_norm=True)
    assert written.is_winding_consistent and written.volume == pytest.approx(2.0)


def test_sheets_are_doubtful_but_for_fast_and_for_presets_of_sheets(
    block: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", encoding="utf-8")
    for preset, quality, is_doubtful in (
        ("wax", "good", True), ("honey", "good", True), ("wax", "fast", False), ("paper", "good", False),
    ):  # fmt: skip
        assert main(["use", preset, "flat.obj", "-o", f"{preset}_{quality}", "--quality", quality]) == 0
        assert ("encloses no volume" in capsys.readouterr().out) == is_doubtful, (preset, quality)


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["use", "waxx", "block.obj", "-o", "out"], "did you mean 'wax'"),
        (["use", "block.obj", "waxx", "-o", "out"], "unknown preset 'waxx'"),
        (["use", "wax", "blok.obj", "-o", "out"], "cannot find the mesh"),
        (["use", "wax", "block.obj", "-t", "threjs", "-o", "out"], "did you mean 'threejs'"),
        (["use", "wax", "block.obj", "-t", "unreal", "-o", "out"], "there is no project for the target 'unreal' yet"),
        (["use", "wax", "block.obj", "-t", "metal", "-o", "out"], "sssgen emit NAME.toml -t metal"),
        (["use", "wax", "block.obj", "-t", "gltf", "-o", "out", "--quality", "best"], "leave --quality out"),
        (["use", "wax", "block.obj", "-o", "out", "--size", "big"], "'big' is no size"),
        (["use", "wax", "block.obj", "-o", "out", "--size", "3.5 cm"], "as --size 35,"),
        (["use", "wax", "block.obj", "-o", "out", "--size", "0.01"], "choose another --size, in millimetres (20 is"),
        (["use", "wax", "block.obj", "-o", "out", "--material", "Skin"], "leave --material out"),
        (["use", "wax", "block.obj", "-t", "godot", "-o", "out", "--open"], "--open shows pages"),
        (["use", "wax", "block.obj", "-o", "out", "--size", "0"], "cannot be 0 mm large"),
        (["use", "wax", "block.obj", "-o", "out", "--size", "nan"], "cannot be nan mm large"),
        (["use", "wax", "block.obj", "-o", "out", "--turn", "inf"], "cannot be turned by inf degrees"),
        (["use", "wax", "block.obj", "-o", "block.obj"], "block.obj"),
    ],
)
def test_mistakes_are_errors_and_write_nothing(
    arguments: list[str], message: str, block: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    assert message in capsys.readouterr().err
    assert {path.name for path in Path().iterdir()} <= {"block.obj", "material.mtl"}


def test_the_report_as_json(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["use", "honey", block, "-o", "out", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["ok"] and "out/index.html" in report["files"]
    assert (report["size_mm"], report["unit_mm"]) == (40.0, 20.0)


def test_the_size_that_is_assumed_is_printed(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    for option, line in (
        ([], "size: the longest side is 20 mm, assumed for wax (--size MM, or --size file for metres); a unit"),
        (["--size", "30"], "size: the longest side is 30 mm; a unit of the mesh is 15 mm"),
        (["--size", "file"], "size: the longest side is 2000 mm; a unit of the mesh is 1000 mm"),
    ):
        assert main(["use", "wax", block, "-o", "out", "--force", *option]) == 0
        assert line in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "text", "offers_best"),
    [
        (["wax"], "Quality: good, the body is drawn", True),
        (["wax", "--target", "gltf"], "Quality: that of the viewer", False),
        (["leaf"], "Quality: the same for all", False),
        (["honey", "--quality", "best"], "honey has no light inside to bake, so that best is the same as good", False),
    ],
)
def test_the_readme_says_what_the_quality_is(words: list[str], text: str, offers_best: bool, block: str) -> None:
    preset, *options = words
    assert main(["use", preset, block, "-o", "out", *options]) == 0
    readme = Path("out", "README.md").read_text(encoding="utf-8")
    assert text in readme and ("the same command with `--quality best`" in readme) == offers_best


def test_best_without_a_bake_is_said_once(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    for words, is_said in (
        (["ice", "--quality", "best"], True),
        (["leaf", "--quality", "best"], True),
        (["ice"], False),
    ):
        preset, *options = words
        assert main(["use", preset, block, "-o", "out", *options]) == 0
        said = f"warning: {preset} has no light inside to bake, so that best is the same as good\n"
        assert capsys.readouterr().out.count(said) == is_said


def test_the_side_in_front_is_said_where_nobody_says_it(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("block.glb").write_bytes(used_mesh(block, 40.0).glb)
    line = "front: the view shows the side towards +z; --turn 180 shows the other one\n"
    for words in ([block], [block, "--turn", "0"], [block, "--up", "y"], ["block.glb"]):
        assert main(["use", "wax", *words, "-o", "out"]) == 0
        assert (line in capsys.readouterr().out) == (words == [block])


def test_sheets_on_bodies_and_bodies_of_no_thickness_are_doubtful(
    block: str, capsys: pytest.CaptureFixture[str]
) -> None:
    import trimesh

    for height in (0.001, 0.02):
        trimesh.creation.box((2, 2, height)).export(f"{height}.stl")
    for preset, mesh, text in (
        ("paper", block, "a thick closed body"), ("leaf", "0.02.stl", ""), ("jade", block, ""),
        ("ice", "0.001.stl", "may have rings"), ("ice", "0.02.stl", ""), ("leaf", "0.001.stl", ""),
        ("wax", "0.001.stl", "mean free paths thick"),
    ):  # fmt: skip
        assert main(["use", preset, mesh, "-o", "out"]) == 0
        warnings = [line for line in capsys.readouterr().out.splitlines() if line.startswith("warning")]
        assert len(warnings) == bool(text) and text in "".join(warnings), (preset, mesh)


def test_options_without_an_effect_and_sizes_that_are_dark(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    for words, text in (
        (["skin_fair", "--keep-color"], "--keep-color keeps nothing"), (["skin_fair"], ""),
        (["honey", "--size", "5000"], "the body is too large to be clear"), (["honey"], ""),
    ):  # fmt: skip
        preset, *options = words
        assert main(["use", preset, block, "-o", "out", "--force", *options]) == 0
        printed = capsys.readouterr().out
        assert ("warning" in printed) == bool(text) and text in printed


def test_the_preview_is_offered_with_what_it_needs(
    block: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for is_there in (True, False):
        monkeypatch.setattr("sssgen.support.extra_packages.is_installed", lambda extra, has=is_there: has)
        assert main(["use", "wax", block, "-o", "out"]) == 0
        assert ("[preview]" in capsys.readouterr().out) != is_there


@pytest.mark.parametrize("scale", [1e-5, 1e4])
def test_a_mesh_of_a_few_units_is_asked_for(scale: float, block: str, capsys: pytest.CaptureFixture[str]) -> None:
    import trimesh

    trimesh.convex.convex_hull(scale * CORNERS).export("scaled.obj")
    assert main(["use", "wax", "scaled.obj", "-o", "out"]) == 2 and not Path("out").exists()
    assert "scale the mesh" in capsys.readouterr().err
    assert main(["use", "paper", "scaled.obj", "-o", "out"]) == 0


def test_a_new_material_begins_with_a_preset(block: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "mine", "--from", "jade"]) == 0
    text = Path("mine.toml").read_text(encoding="utf-8")
    assert 'name = "mine"' in text and 'title = "Jade"' in text and "A world unit is 15 mm" in text
    assert main(["emit", "mine.toml", "--target", "wgsl", "-o", "out"]) == 0
    assert main(["new", "other", "--from", "jad"]) == 2 and "did you mean 'jade'" in capsys.readouterr().err
    assert main(["new", "other", "--from", "jade", "--copy", "ice"]) == 2 and not Path("other").exists()


def test_a_page_without_the_bundle_loads_three_from_the_network(block: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSSGEN_NODE_MODULES", str(Path("none").resolve()))
    assert main(["use", "wax", block, "-o", "out"]) == 0
    page = Path("out", "index.html").read_text(encoding="utf-8")
    assert "https://cdn.jsdelivr.net/npm/three@" in page and "which was not reached" in page
    assert not Path("out", "library").exists()


def test_the_bake_of_best_is_kept_for_its_body_and_medium(block: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from sssgen.bake import relit
    from sssgen.lab.fluence.fluence_field import Settings

    bakes, original = [], relit.bake

    def coarse(scene: Any, rank: int, settings: Settings, **_: object) -> Any:
        bakes.append(scene.medium.extinction[0])
        return original(scene, 8, Settings(voxels=8, side=8, photons=200), processes=0)

    monkeypatch.setattr(relit, "bake", coarse)
    command = ["use", "wax", block, "-o", "out", "--quality", "best"]
    assert main(command) == 0 and main(command) == 0 and len(bakes) == 1
    assert main([*command, "--size", "40", "--force"]) == 0 and len(bakes) == 2  # a denser medium
    Path("out", "light.bin").write_bytes(b"broken")
    assert main([*command, "--size", "40", "--force"]) == 0 and len(bakes) == 3
    page = Path("out", "main.js").read_text(encoding="utf-8")
    assert "createMaterial({ innerLight: 'light.bin' })" in page
