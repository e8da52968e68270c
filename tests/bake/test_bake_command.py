"""`sssgen bake` as a command: faulty input, interrupts and formats."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bake_meshes as meshes
from bake_meshes import MeshData, bake, facts, write
from processes import HANG, wait_until, wait_until_busy
from sssgen.cli.main import main

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[bake]'")
pytest.importorskip("igl", reason="libigl is missing: pip install -e '.[bake]'")
pytest.importorskip("embreex", reason="embreex is missing: pip install -e '.[bake]'")
pytest.importorskip("scipy", reason="SciPy is missing: pip install -e '.[bake]'")
pytest.importorskip("xatlas", reason="xatlas is missing: pip install -e '.[bake]'")
pytest.importorskip("psutil", reason="psutil is missing: pip install -e '.[bake]'")
pytest.importorskip("OpenEXR", reason="OpenEXR is missing: pip install -e '.[bake]'")

from sssgen.bake.distance_encoding import ENCODINGS
from sssgen.scene.pictures import images
from sssgen.support import progress

pytestmark = pytest.mark.usefixtures("folder")

SHEET = MeshData(np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], float), np.array([[0, 2, 1], [0, 3, 2]]))


def files_present() -> set[str]:
    return {str(path) for path in Path().rglob("*")}


# Faulty input


@pytest.fixture
def idle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fails the test where a bake starts computing."""

    def working(*_: Any, **__: Any) -> None:
        raise AssertionError("the work began")

    monkeypatch.setattr("sssgen.bake.distance_texture.distances", working)
    monkeypatch.setattr("sssgen.bake.thickness_map._measure_chords", working)
    monkeypatch.setattr("sssgen.scene.mesh_rays.MeshRays.nearest", working)


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The errors of an invalid bake, which writes nothing."""
    before = files_present()
    capsys.readouterr()
    status = main(["bake", *arguments])
    output = capsys.readouterr()
    assert status == 2 and "Traceback" not in output.err and output.out == "", output
    assert files_present() == before
    status = main(["bake", *arguments, "--json"])
    as_json = json.loads(capsys.readouterr().out)
    assert status == 2 and not as_json["ok"] and as_json["diagnostics"][0]["message"] in output.err
    assert files_present() == before
    return output.err


def with_vertex(text: str) -> str:
    return Path("box.obj").read_text(encoding="utf-8").replace("v ", f"v {text} 0 0\nv ", 1).replace("f 1/", "f 2/", 1)


NOISE = np.random.default_rng(1).integers(0, 256, 4000).astype(np.uint8).tobytes()
FILES: dict[str, tuple[str, Callable[[], str | bytes], str]] = {
    "a text": ("a.obj", lambda: "a letter\nto nobody\n", "not an .obj file"),
    # trimesh reads noise as text where a package for other encodings is installed: then there are no triangles
    "noise.obj": ("a.obj", lambda: NOISE, "a.obj"),
    "noise.ply": ("a.ply", lambda: NOISE, "cannot be read"),
    "noise.stl": ("a.stl", lambda: NOISE, "a.stl"),
    "noise.glb": ("a.glb", lambda: NOISE, "cannot be read"),
    "noise.gltf": ("a.gltf", lambda: NOISE, "cannot be read"),
    "empty.obj": ("a.obj", lambda: b"", "a.obj"),
    "empty.ply": ("a.ply", lambda: b"", "a.ply"),
    "empty.glb": ("a.glb", lambda: b"", "a.glb"),
    "points": ("a.obj", lambda: "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no triangles"),
    "no area": ("a.obj", lambda: "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle has an area"),
    "a vertex that is not": ("a.obj", lambda: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "a.obj"),
    "nan": ("a.obj", lambda: with_vertex("nan"), "not a number"),
    "inf": ("a.obj", lambda: with_vertex("inf"), "not a number"),
    "other": ("a.fbx", lambda: NOISE, "not a mesh file's suffix"),
}


@pytest.mark.parametrize("what", ["sdf", "thickness", "depth"])
@pytest.mark.parametrize("name", FILES)
def test_files_that_are_not_meshes_are_refused(
    capsys: pytest.CaptureFixture[str], idle: None, what: str, name: str
) -> None:
    file, content, message = FILES[name]
    data = content()
    Path(file).write_bytes(data if isinstance(data, bytes) else data.encode())
    more = ["--direction", "0,1,0"] if what == "depth" else []
    assert message in refused(capsys, what, file, "-o", "o.npy", *more)


@pytest.mark.parametrize(("size", "message"), [(1e-30, "is only 1e-30 units large"), (1e30, "not a number, or beyond")])
def test_sizes_that_numbers_do_not_reach(
    capsys: pytest.CaptureFixture[str], idle: None, size: float, message: str
) -> None:
    box = meshes.box()
    write(Path("a.obj"), box._replace(vertices=size * box.vertices))
    for what in ("sdf", "thickness"):
        assert message in refused(capsys, what, "a.obj", "-o", "o.npy")


@pytest.mark.parametrize("size", [2e-6, 1e8])
def test_sizes_that_they_reach(size: float) -> None:
    box = meshes.box()
    write(Path("a.obj"), box._replace(vertices=size * box.vertices))
    bake("sdf", "a.obj", "-o", "o.npy", "--resolution", "12", "--encode", "r32f")
    assert facts("o.npy")["inside"] == pytest.approx((1.0 / 1.1) ** 3, abs=0.25)
    assert facts("o.npy")["range"] == pytest.approx(0.5 * size, rel=0.15)
    bake("thickness", "a.obj", "-o", "t.npy", "--mode", "chord", "--size", "32", "--processes", "1")
    assert facts("t.npy")["mean"] == pytest.approx(size, rel=1e-4)


WRONG: list[tuple[list[str], str]] = [
    (["sdf", "no.obj", "-o", "o.npy"], "cannot find the mesh"),
    (["sdf", ".", "-o", "o.npy"], "this is a folder"),
    (["sdf", "box.obj", "-o", "o.tga"], "'.tga' is not the suffix of a volume file"),
    (["sdf", "box.obj", "-o", "o"], "not the suffix of a volume file"),
    (["sdf", "box.obj", "-o", "o.npy", "--format", "dss"], "did you mean 'dds'?"),
    (["sdf", "box.obj", "-o", "o.npy", "--format", "dds"], "ends in .dds"),
    (["sdf", "box.obj", "-o", "o.npy", "--encode", "r12"], "unknown encoding 'r12'"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "0"], "'0' is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution=-8"], "'-8' is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "8,8"], "is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "8,8,8,8"], "is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "many"], "'many' is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "8.5"], "'8.5' is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", ""], "'' is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "99999"], "is not a resolution"),
    (["sdf", "box.obj", "-o", "o.npy", "--resolution", "2048,2048,2048"], "GiB are free"),
    (["sdf", "box.obj", "-o", "o.npy", "--padding", "-1"], "is not a padding"),
    (["sdf", "box.obj", "-o", "o.npy", "--padding", "nan"], "is not a padding"),
    (["sdf", "box.obj", "-o", "o.npy", "--range", "0"], "--range 0 is not a length"),
    (["sdf", "box.obj", "-o", "o.npy", "--range", "nan"], "is not a length"),
    (["sdf", "box.obj", "-o", "o.npy", "--thin", "-1"], "--thin -1 is not a length"),
    (["sdf", "box.obj", "-o", "box.obj/o.npy"], "box.obj"),
    (["sdf", "box.obj", "-o", "folder.npy"], "a folder has its name"),
    (["sdf", "sheet.obj", "-o", "o.npy"], "--thin"),
    (["thickness", "no.obj", "-o", "o.png"], "cannot find the mesh"),
    (["thickness", "box.obj", "-o", "o.jpg"], "'.jpg'"),
    (["thickness", "box.obj", "-o", "folder.png"], "a folder has its name"),
    (["thickness", "box.obj", "-o", "o.png", "--mode", "median"], "median"),
    (["thickness", "box.obj", "-o", "o.png", "--rays", "7"], "7 is not a number of rays"),
    (["thickness", "box.obj", "-o", "o.png", "--rays", "-8"], "-8 is not a number of rays"),
    (["thickness", "box.obj", "-o", "o.png", "--rays", "0"], "0 is not a number of rays"),
    (["thickness", "box.obj", "-o", "o.png", "--rays", "1000000"], "is not a number of rays"),
    (["thickness", "box.obj", "-o", "o.png", "--seed", "-1"], "-1 is not a seed"),
    (["thickness", "box.obj", "-o", "o.png", "--size", "0"], "'0' is not a size"),
    (["thickness", "box.obj", "-o", "o.png", "--size", "20000"], "'20000' is not a size"),
    (["thickness", "box.obj", "-o", "o.png", "--size", "8x8x8"], "is not a size"),
    (["thickness", "box.obj", "-o", "o.png", "--mode", "transmittance"], "--attenuation"),
    (["thickness", "box.obj", "-o", "o.png", "--mode", "transmittance", "--attenuation", "0"], "--attenuation"),
    (["thickness", "box.obj", "-o", "o.png", "--mode", "transmittance", "--attenuation", "nan"], "--attenuation"),
    (["thickness", "box.obj", "-o", "o.png", "--attenuation", "1"], "--mode transmittance"),
    (["thickness", "box.obj", "-o", "o.png", "--processes", "0"], "processes"),
    (["thickness", "tiled.obj", "-o", "o.png"], "--unwrap"),
    (["thickness", "box.obj", "-o", "o.png", "--direction", "up"], "'up' is not a light"),
    (["thickness", "box.obj", "-o", "o.png", "--direction", "0,0,0"], "no length"),
    (["thickness", "box.obj", "-o", "o.png", "--direction", "0,nan,0"], "three numbers"),
    (["thickness", "box.obj", "-o", "o.png", "--direction", "1,2"], "three numbers"),
    (["thickness", "box.obj", "-o", "o.png", "--direction", "no.json"], "cannot find the light's file"),
    (["depth", "box.obj", "-o", "o.npy"], "--direction"),
    (["depth", "box.obj", "-o", "o.png", "--direction", "0,1,0"], ".exr or .npy"),
    (["depth", "box.obj", "-o", "folder.npy", "--direction", "0,1,0"], "a folder has its name"),
    (["pack", "-o", "o.png"], "nothing to pack"),
    (["pack", "-o", "o.png", "--red", "0.5"], "no picture to pack"),
    (["pack", "-o", "o.png", "--red", "a.png", "--green", "b.png"], "different sizes"),
    (["pack", "-o", "o.png", "--red", "a.png:x"], "'x' is not a channel"),
    (["pack", "-o", "o.png", "--red", "a.png:b"], "no channel b"),
    (["pack", "-o", "o.png", "--red", "no.png"], "cannot find the picture"),
    (["pack", "-o", "o.png", "--red", "2"], "from 0 to 1"),
    (["normal", "no.png", "-o", "o.png"], "cannot find the picture"),
    (["normal", "a.png", "-o", "folder.png"], "a folder has its name"),
    (["voronoi", "-o", "o.png", "--cells", "0"], ""),
    (["voronoi", "-o", "o.png", "--size", "-4"], "is not a size"),
    (["voronoi", "-o", "folder.png"], "a folder has its name"),
]


@pytest.mark.parametrize(
    ("arguments", "message"), WRONG, ids=lambda part: " ".join(part) if isinstance(part, list) else ""
)
def test_wrong_arguments(capsys: pytest.CaptureFixture[str], idle: None, arguments: list[str], message: str) -> None:
    for name in ("folder.npy", "folder.png"):
        Path(name).mkdir()
    write(Path("sheet.obj"), SHEET)
    box = meshes.box()
    assert box.uv is not None
    write(Path("tiled.obj"), box._replace(uv=10.0 * box.uv))
    images.write_png("a.png", np.full((4, 4), 0.5))
    images.write_png("b.png", np.full((4, 8), 0.5))
    assert message in refused(capsys, *arguments)


LIGHTS = {
    "{": "this is not JSON",
    "": "",
    "[1, 2, 3]": "a direction or a position",
    "{}": "a direction or a position",
    '{"direction": [0, 1, 0], "position": [0, 9, 0]}': "either a direction or a position",
    '{"directoin": [0, 1, 0]}': "did you mean 'direction'?",
    '{"direction": [0, 1]}': "three numbers",
    '{"direction": [0, 1, 0, 0]}': "three numbers",
    '{"direction": 1}': "three numbers",
    '{"direction": ["a", "b", "c"]}': "three numbers",
    '{"direction": [true, false, false]}': "three numbers",
    '{"direction": [0, 0, 0]}': "no length",
    '{"direction": [NaN, 0, 0]}': "",
    '{"position": [0, 1e30, 0]}': "three numbers",
    '{"position": [0, 0, 0]}': "inside the body",
    '{"position": [0.1, 0.1, 0]}': "inside the body",
}


@pytest.mark.parametrize("text", LIGHTS)
def test_invalid_lights_are_refused(capsys: pytest.CaptureFixture[str], idle: None, text: str) -> None:
    Path("light.json").write_text(text, encoding="utf-8")
    arguments = ["depth", "box.obj", "-o", "o.npy", "--direction", "light.json", "--size", "8"]
    assert LIGHTS[text] in refused(capsys, *arguments)


def test_a_sheet_with_a_thickness_is_a_body() -> None:
    write(Path("sheet.obj"), SHEET)
    bake("sdf", "sheet.obj", "-o", "o.npy", "--thin", "0.2", "--resolution", "24")
    assert facts("o.npy")["inside"] > 0.1


def test_a_sheet_has_no_thickness_map(capsys: pytest.CaptureFixture[str]) -> None:
    write(Path("sheet.obj"), SHEET)
    output = refused(capsys, "thickness", "sheet.obj", "-o", "o.png", "--size", "16", "--rays", "8", "--processes", "1")
    assert "no inside" in output


def test_inputs_are_not_overwritten(capsys: pytest.CaptureFixture[str], idle: None) -> None:
    """By the texture and the files next to it: its JSON, and a mesh that gets texture coordinates."""
    box = meshes.box()._replace(uv=None)
    write(Path("box.png.obj"), box)
    images.write_png("height.png", np.eye(4))
    Path("d.exr.json").write_text('{"direction": [0, 1, 0]}', encoding="utf-8")
    before = {name: Path(name).read_bytes() for name in ("box.png.obj", "height.png", "d.exr.json")}
    for arguments in (
        ["thickness", "./box.png.obj", "-o", "box.png"],
        ["depth", "box.png.obj", "-o", "d.exr", "--direction", "d.exr.json"],
        ["normal", "height.png", "-o", "height.png"],
        ["pack", "-o", "height.png", "--red", "0", "--green", "1-height.png:r"],
    ):
        assert "would overwrite" in refused(capsys, *arguments)
    assert before == {name: Path(name).read_bytes() for name in before}


def test_other_files_are_not_overwritten() -> None:
    write(Path("plain.obj"), meshes.box()._replace(uv=None))
    Path("map.obj").write_text("mine", encoding="utf-8")
    bake("thickness", "plain.obj", "-o", "map.png", "--mode", "chord", "--size", "16", "--processes", "1")
    assert Path("map.obj").read_text(encoding="utf-8") == "mine" and Path("map.png.obj").is_file()


def test_triangles_that_face_the_other_way_are_turned(capsys: pytest.CaptureFixture[str]) -> None:
    box = meshes.box()
    faces = box.faces.copy()
    faces[::2] = faces[::2, ::-1]
    write(Path("mixed.obj"), box._replace(faces=faces, uv=None))
    write(Path("plain.obj"), box._replace(uv=None))
    for what, option in (("sdf", "--resolution"), ("thickness", "--size")):
        for name in ("mixed", "plain"):
            bake(what, f"{name}.obj", "-o", f"{what}_{name}.npy", option, "16")
            assert ("face the other way than their neighbours" in capsys.readouterr().out) == (name == "mixed")
        turned, plain = facts(f"{what}_mixed.npy"), facts(f"{what}_plain.npy")
        assert turned["mesh"]["turned"] == len(faces) // 2 and not turned["mesh"]["mixed_sides"]
        assert plain["mesh"]["turned"] == 0
        part = "inside" if what == "sdf" else "mean"
        assert turned[part] == pytest.approx(plain[part], rel=0.01)


def test_a_light_that_hits_nothing_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    write(Path("sheet.obj"), SHEET)
    bake("depth", "sheet.obj", "-o", "d.exr", "--direction", "1,0,0", "--size", "16")
    assert "no ray of the light hits the mesh" in capsys.readouterr().out


def test_missing_folders_are_created() -> None:
    bake("sdf", "box.obj", "-o", "new/deep/o.npy", "--resolution", "8")
    assert {"new/deep/o.npy", "new/deep/o.npy.json"} < {path.replace(os.sep, "/") for path in files_present()}


def test_bake_reports_its_files(capsys: pytest.CaptureFixture[str]) -> None:
    bake("sdf", "box.obj", "-o", "o.npy", "--resolution", "16")
    assert "wrote o.npy, o.npy.json" in capsys.readouterr().out
    bake("sdf", "box.obj", "-o", "o.npy", "--resolution", "16", "--json")
    report = json.loads(capsys.readouterr().out)
    assert report["ok"] and report["files"] == ["o.npy", "o.npy.json"]
    assert report["parameters"] == facts("o.npy")["parameters"]


# Interrupts


@pytest.mark.parametrize(
    "arguments",
    [
        ["sdf", "box.obj", "-o", "o.npy", "--resolution", "16"],
        ["thickness", "box.obj", "-o", "o.png", "--size", "16", "--rays", "8", "--processes", "1"],
        ["depth", "box.obj", "-o", "o.npy", "--direction", "0,1,0", "--size", "8"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_an_interrupt_leaves_nothing(monkeypatch: pytest.MonkeyPatch, arguments: list[str]) -> None:
    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    before = files_present()
    with monkeypatch.context() as patch:
        patch.setattr(progress.ProgressBar, "__call__", interrupt)
        assert main(["bake", *arguments]) == 130
    assert files_present() == before

    def half(path: str, data: bytes) -> None:
        Path(path).write_bytes(data[: len(data) // 2])
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("sssgen.support.file_writer._write_bytes", half)
        assert main(["bake", *arguments]) == 130
    assert files_present() == before


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a group of processes")
@pytest.mark.parametrize(
    "arguments",
    [
        ["sdf", "ball.obj", "-o", "o.npy", "--resolution", "512"],
        ["thickness", "ball.obj", "-o", "o.png", "--size", "4096", "--processes", "2"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_ctrl_c_ends_all_of_it(arguments: list[str]) -> None:
    write(Path("ball.obj"), meshes.globe(1.0, 64, 32))
    before = files_present()
    # a process of a shell in the background ignores interrupts, and so would its own
    heed = "import signal, sys; signal.signal(signal.SIGINT, signal.default_int_handler); "
    command = [sys.executable, "-c", f"{heed}from sssgen.cli.main import main; sys.exit(main())", "bake", *arguments]
    with subprocess.Popen(command, start_new_session=True, stderr=subprocess.PIPE, text=True) as process:
        wait_until_busy(process, 8.0)
        os.killpg(process.pid, signal.SIGINT)
        try:
            _, message = process.communicate(timeout=HANG)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            raise
    assert process.returncode == 130 and message.splitlines()[-1] == "interrupted"  # behind the progress
    assert files_present() == before

    def all_ended() -> bool:
        try:
            os.killpg(process.pid, 0)
        except ProcessLookupError:
            return True
        return False

    wait_until(all_ended, "the workers to end")


def test_processes_make_no_difference() -> None:
    """Byte for byte: the random rays, which an open mesh needs, depend on the texel only."""
    whole = meshes.box((1.0, 0.6, 0.4))
    assert whole.uv is not None
    meshes.write(Path("open.obj"), whole._replace(faces=whole.faces[:-2], uv=whole.uv[:-2]))
    common = ["thickness", "open.obj", "--size", "96", "--rays", "64"]
    bake(*common, "-o", "one.png", "--processes", "1")
    bake(*common, "-o", "two.png", "--processes", "2")
    bake(*common, "-o", "other.png", "--processes", "1", "--seed", "1")
    assert Path("one.png").read_bytes() == Path("two.png").read_bytes() != Path("other.png").read_bytes()
    one, two = ({**facts(name), "file": None} for name in ("one.png", "two.png"))
    assert one == two and one["by_rays"] == 1.0


# Formats


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_all_formats_hold_the_same_texels(encoding: str) -> None:
    common = ["sdf", "box.obj", "--resolution", "12,10,9", "--encode", encoding]
    for name in ("npy", "dds", "ktx2"):
        bake(*common, "-o", f"o.{name}")
    bake(*common, "-o", "o.exr", "--format", "exr-slices")
    bake(*common, "-o", "o.raw", "--format", "raw+json")
    expected = images.read("o.npy")
    assert expected.shape == (9, 10, 12, 1) and expected.min() >= 0.0 and expected.max() <= 1.0
    assert np.array_equal(images.read("o.dds"), expected)
    assert np.array_equal(images.read("o.ktx2"), expected)
    description = facts("o.raw")["file"]
    stored = np.fromfile("o.raw", np.dtype(description["dtype"]).newbyteorder("<"))
    assert np.array_equal(stored.reshape(9, 10, 12) / description["one"], expected[..., 0])
    sheet, description = images.read("o.exr")[..., 0], facts("o.exr")["file"]
    for z in range(9):
        row, column = divmod(z, description["columns"])
        part = sheet[10 * row : 10 * (row + 1), 12 * column : 12 * (column + 1)]
        assert part[::-1] == pytest.approx(expected[z, ..., 0], abs=1e-7)
    assert len({json.dumps({**facts(f"o.{name}"), "file": 0}) for name in ("npy", "dds", "ktx2", "exr", "raw")}) == 1
