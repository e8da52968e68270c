"""The Assets folder for Unity: files, references, shaders, scripts. In place of Unity, stand-ins of its API are run."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from folders import ROOT
from gltf_files import write_gltf
from sssgen.cli.main import main
from sssgen.interchange.unity_project import guid_of
from sssgen.run.compilers.compiler_interface import Compiler, Source
from sssgen.scene.mesh_files import read
from textured_head import textured
from unity_frames import mono

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")

STAND_INS = ROOT / "tests" / "presets" / "unity_editor"


@pytest.fixture
def assets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder for skin on a cube with pictures, whose middle is at (1, 0, 0)."""
    monkeypatch.chdir(tmp_path)
    write_gltf(Path("head.glb"), *textured())
    assert main(["use", "skin_fair", "head.glb", "--target", "unity-urp", "-o", "Assets"]) == 0
    return Path("Assets")


def guids(folder: Path) -> dict[str, str]:
    """GUID → its file."""
    metas = list(folder.rglob("*.meta"))
    found = {guid_of(str(path)): path.relative_to(folder).as_posix().removesuffix(".meta") for path in metas}
    assert len(found) == len(metas) and all((folder / path).is_file() for path in found.values())
    return found


def yaml_of(path: Path) -> dict[str, object]:
    yaml = pytest.importorskip("yaml", reason="PyYAML is missing: pip install -e '.[import]'")
    text = re.sub(r"^%.*\n|^--- .*\n", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    content: dict[str, object] = yaml.safe_load(text)
    return content


def test_every_reference_has_its_file(assets: Path) -> None:
    known = guids(assets)
    for path in [*assets.rglob("*.mat"), *assets.rglob("*Scene.cs")]:
        for guid in re.findall(r"\b[0-9a-f]{32}\b", path.read_text(encoding="utf-8")):
            assert guid in known, path
    text = (assets / "skin_fair/skin_fair.mat").read_text(encoding="utf-8")
    (shader,) = re.findall(r"m_Shader: .*guid: (\w+)", text)
    assert known[shader] == "skin_fair/skin_fair.unity-urp.shader"
    pictures = dict(re.findall(r"- (\w+):\n +m_Texture: .*guid: (\w+)", text))
    declared = (assets / known[shader]).read_text(encoding="utf-8")
    assert len(pictures) == 4 and all(f"{name} (" in declared for name in pictures)
    assert known[pictures["_NormalTexture"]] == "skin_fair/textures/normal.png"


def test_the_yaml_files_say_how_unity_imports(assets: Path) -> None:
    for path in [*assets.rglob("*.meta"), *assets.rglob("*.mat")]:
        assert yaml_of(path), path

    def importer(name: str) -> tuple[int, int, int]:
        (content,) = [value for value in yaml_of(assets / f"skin_fair/{name}.meta").values() if isinstance(value, dict)]
        (platform,) = content["platformSettings"]
        return content["mipmaps"]["sRGBTexture"], content["textureType"], platform["textureCompression"]

    assert importer("textures/base_color.png") == (1, 0, 0)
    assert importer("textures/normal.png") == (0, 1, 0)
    assert importer("textures/occlusion.png") == (0, 0, 0)
    model = yaml_of(assets / "skin_fair/body.obj.meta")["ModelImporter"]
    assert isinstance(model, dict)
    assert model["meshes"]["globalScale"] == 1 and model["tangentSpace"]["normalImportMode"] == 0


def test_the_mesh_is_that_of_the_other_projects(assets: Path) -> None:
    """Places, normals, texture coordinates, and which side is outside."""
    here, there = read(str(assets / "skin_fair/body.obj")), read(str(assets / "skin_fair/body.glb"))
    assert here.uv is not None and there.uv is not None

    def corners(content: object, values: np.ndarray) -> np.ndarray:
        return values[content.faces].reshape(-1, values.shape[1])  # type: ignore[attr-defined]

    assert corners(here, here.vertices) == pytest.approx(corners(there, there.vertices), abs=1e-5)
    assert corners(here, here.uv) == pytest.approx(corners(there, there.uv), abs=1e-5)
    first, second, third = np.moveaxis(here.vertices[here.faces], 1, 0)
    outwards = np.einsum("nc,nc->n", np.cross(second - first, third - first), first - [1.0, 0.0, 0.0])
    assert (outwards > 0.0).all()


@pytest.mark.slow
def test_the_shader_compiles(assets: Path, compiler: Callable[[str], Compiler]) -> None:
    """With the stand-in headers, or with Unity's own where SSSGEN_UNITY_INCLUDES names them."""
    text = (assets / "skin_fair/skin_fair.unity-urp.shader").read_text(encoding="utf-8")
    assert not compiler("unity").check(Source(text, "unity-urp", name="skin_fair.shader"))


def run_menu(assets: Path, *symbols: str) -> dict[str, list[str]]:
    """Compiles the scripts with stand-ins, chooses the menu, and gives the rows that the program writes."""
    compiler, runtime = mono()
    own = ["Sssgen/SssgenOrbit.cs", "Sssgen/Editor/SssgenScene.cs"]
    scripts = [*sorted(STAND_INS.glob("*.cs")), *(assets / name for name in own), *assets.glob("*/Editor/*Scene.cs")]
    sources = sorted({str(path) for path in scripts})
    flags = [f"-define:{symbol}" for symbol in symbols]
    call = [compiler, "-langversion:latest", "-warnaserror", *flags, "-out:scene.exe", *sources]
    done = subprocess.run(call, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run([runtime, "scene.exe", str(assets)], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    rows = [line.split("\t") for line in done.stdout.splitlines()]
    return {Path(row[0]).name: row[1:] for row in rows}


def numbers(text: str) -> np.ndarray:
    return np.array(text.split(), float)


@pytest.mark.parametrize("symbols", [(), ("ENABLE_INPUT_SYSTEM",)], ids=["old input", "new input"])
def test_the_menu_makes_a_scene(assets: Path, symbols: tuple[str, ...]) -> None:
    """The x of all places is negated; without URP a dialog says what is missing."""
    rows = run_menu(assets, *symbols)
    assert "Universal Render Pipeline" in rows["dialog"][0]
    assert rows["features"] == ["Sssgen Passes", "11"]  # once, although the menu was chosen twice
    radius = np.sqrt(3.0)
    body, camera, lamp = rows["body.obj"], rows["Camera"], rows["Lamp"]
    assert body[3].endswith("skin_fair.mat")
    assert numbers(body[2]) == pytest.approx(2.0 / 0.02)  # whatever the importer made of the lengths
    middle = [-1.0, 0.0, 0.0]
    assert numbers(camera[1]) == pytest.approx(middle) and numbers(lamp[1]) == pytest.approx(middle)
    eye = (numbers(camera[0]) - middle) / radius
    assert np.linalg.norm(eye) == pytest.approx(4.0, abs=1e-3) and eye[0] < 0.0 < eye[2]
    behind = (numbers(lamp[0]) - middle) / radius
    assert behind == pytest.approx([0.88, 1.5, -3.28], abs=0.02)
    assert float(lamp[3].split()[1]) == pytest.approx(260 / np.pi * 3.0, rel=1e-3)
    assert rows["sky"][0].endswith("surroundings.png")
    moved = numbers(rows["dragged"][0])
    assert (moved[0] > numbers(camera[0])[0]) == (not symbols)  # only the old input reports a drag here


def test_baked_light_comes_with_its_component(assets: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    baked = {"skin_fair/light.bin": b"bake", "skin_fair/light.bin.json": "{}"}
    monkeypatch.setattr("sssgen.presets.project_files._baked_light", lambda *_: baked)
    command = ["use", "skin_fair", "head.glb", "--target", "unity-urp", "-o", "Assets", "--quality", "best", "--force"]
    assert main(command) == 0
    assert (assets / "skin_fair/light.bytes").read_bytes() == b"bake"
    bound = [Path(name).name for name in run_menu(assets)["body.obj"][4].split()]
    assert bound == ["light.bytes", "light.bin.json"]


def test_two_presets_share_the_scripts(assets: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["use", "leaf", "head.glb", "--target", "unity-urp", "-o", "Assets"]) == 0
    assert "kept  Assets/Sssgen/SssgenPasses.cs" in capsys.readouterr().out
    guids(assets)  # no two files have one GUID
    names = [path.name for path in assets.rglob("*.cs")]
    assert len(names) == len(set(names))
    assert {"Front", "Lamp", "Camera"} <= set(run_menu(assets))
