"""A picture whose textures are missing is an error with the command that bakes them; the command makes the picture."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

import sssgen
from slow_cases import some_slow
from sssgen.cli.bake import KINDS
from sssgen.cli.commands import command_parser
from sssgen.cli.main import main
from sssgen.ir.baked_textures import is_baked
from sssgen.material import library
from sssgen.material.attributes import Bake, read_attributes, sections
from sssgen.material.requirements import baked_functions
from sssgen.preview.page_messages import PageMessages
from sssgen.preview.pane import Pane
from sssgen.scene.pictures import images
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import folder
from sssgen.testing.project_run import Run, cases

for package in ("trimesh", "igl", "embreex", "xatlas", "scipy", "psutil"):
    pytest.importorskip(package, reason=f"{package} is missing: pip install -e '.[bake]'")

MAP = '[[thickness]]\ntechnique = "{}"\n[translucency]\ntechnique = "absorption_tint"\n'
BACK = '[[thickness]]\ntechnique = "back_face_thickness"\n'
MATERIALS = {
    "thickness": MAP.format("thickness_map"),
    "transmittance": '[[thickness]]\ntechnique = "transmittance_map"\n[translucency]\ntechnique = "lobe_normalized"\n',
    "sdf": MAP.format("march_distance_texture").replace(
        'e"\n[t', 'e"\nbind = { distance_at = "distance_texture" }\n[t'
    ),
    "view": '[[thickness]]\ntechnique = "view_thickness_map"\n[translucency]\ntechnique = "interior_sample"\n'
    'bind = { light_path = "depth_map_path" }\nmean_free_path = 0.3\n',
    "fixed": f'{BACK}[translucency]\ntechnique = "fluence_fixed"\n',
    "rank_4": f'{BACK}[translucency]\ntechnique = "fluence_factored_4"\nbind = {{ light_path = "depth_map_path" }}\n',
    "rank_8": f'{BACK}[translucency]\ntechnique = "fluence_factored_8"\nbind = {{ light_path = "depth_map_path" }}\n',
}
SCENE = """material = "wax.toml"
size = [16, 12]
samples = 1
[geometry]
kind = "mesh"
file = "box.obj"
rotation = [0, 30, 0]
scale = 1.5
[[light]]
direction = [0.3, -0.2, -1.0]
color = [3, 3, 3]
[medium]
scattering = [3.0, 2.5, 2.0]
absorption = [0.1, 0.2, 0.3]
"""
QUICK = {
    "sdf": ["--resolution", "8"], "thickness": ["--size", "16", "--rays", "8", "--processes", "1"],
    "view_thickness": ["--size", "16", "--rays", "16", "--processes", "1"],
    "fluence": ["--voxels", "4", "--photons", "8", "--processes", "1"],
}  # fmt: skip


def write(kind: str, scene: str = SCENE) -> None:
    Path("wax.toml").write_text(f'[material]\nname = "wax"\nshading = "lit"\n{MATERIALS[kind]}', encoding="utf-8")
    Path("scene.toml").write_text(scene, encoding="utf-8")


def render(file: str = "scene.toml") -> int:
    return main(["render", file, "-o", "x.png", "--backend", "numpy", "--size", "16x12"])


@pytest.mark.parametrize("kind", MATERIALS)
def test_the_reflection_names_what_a_render_refuses(
    kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the same command, but for the user's own files; a texture that is drawn, or optional, has none."""
    write(kind)
    assert render() == 1
    message = capsys.readouterr().err
    (bake,) = set(re.findall(r"`(sssgen bake \w+) ", message))
    textures = sssgen.compile("wax.toml", "threejs").reflection["textures"]
    needed = {texture["technique_name"]: texture["needed"] for texture in textures if texture["needed"]}
    assert set(needed) == {one["technique_name"] for one in textures if f"'{one['technique_name']}'" in message}
    assert needed and all(re.fullmatch(rf"load wax_\S+, which `{bake} .*` makes", one) for one in needed.values())


def test_the_reflection_names_the_pictures_of_the_material(folder: Path) -> None:
    picture = 'shading = "lit"\n[[surface]]\ntechnique = "base_color"\nbase_color_texture = "oak.png"\n'
    Path("wood.toml").write_text(f'[material]\nname = "wood"\n{picture}', encoding="utf-8")
    (texture,) = sssgen.compile("wood.toml", "threejs").reflection["textures"]
    assert texture["needed"] == "load oak.png, which the material names"


@pytest.mark.parametrize("kind", some_slow(MATERIALS, "transmittance", "sdf", "view"))
def test_the_command_of_the_message_makes_the_picture(
    kind: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(kind)
    assert render() == 1 and not Path("x.png").exists()
    message = capsys.readouterr().err
    assert re.search(r"error: \w+ reads the textures? '\w+'.* baked from the body, and there is no file\n", message)
    assert re.search(r"--> .*wax\.toml:\d+:\d+", message)
    command, lines = re.search(r"run `sssgen (.*)`, then write (.*) in \[textures\] of scene\.toml\n", message).groups()  # type: ignore[union-attr]
    words = shlex.split(command)
    assert main([*words, *QUICK[words[1]]]) == 0, capsys.readouterr().err
    Path("scene.toml").write_text(f"{SCENE}[textures]\n{lines.replace(', ', chr(10))}\n", encoding="utf-8")
    assert render() == 0, capsys.readouterr().err
    assert np.ptp(images.read("x.png")) > 0.01


def test_a_texture_that_is_named_and_missing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the scene, and in the material: the command writes the file of that name."""
    write("thickness", f'{SCENE}[textures]\nthickness_texture = "my maps/t.png"\n')
    assert render() == 2
    message = capsys.readouterr().err
    assert "cannot find the file 'my maps/t.png'" in message and "--> scene.toml:16:" in message
    assert 'run `sssgen bake thickness box.obj -o "my maps/t.png"`\n' in message
    write("thickness")
    material = Path("wax.toml").read_text(encoding="utf-8").replace('_map"', '_map"\nthickness_texture = "t.png"')
    Path("wax.toml").write_text(material, encoding="utf-8")
    assert render() == 1
    assert "run `sssgen bake thickness box.obj -o t.png`\n" in capsys.readouterr().err
    assert main(["render", "scene.toml", "-o", "x.png", "--backend", "numpy", "--json"]) == 1
    assert "sssgen bake" in json.loads(capsys.readouterr().out)["diagnostics"][0]["help"]


def test_a_scene_that_names_a_missing_bake_can_be_baked(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write("fixed", f'{SCENE}[textures]\nfluence_volume = "light.dds"\n')
    assert render() == 2
    command = re.search(r"run `sssgen (bake fluence scene\.toml .* -o light\.dds)`", capsys.readouterr().err)
    assert command and main([*shlex.split(command[1]), *QUICK["fluence"]]) == 0 and render() == 0


def test_a_picture_of_a_material_that_is_missing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = '[material]\nname = "wax"\n[[surface]]\ntechnique = "base_color"\n'
    Path("wax.toml").write_text(text, encoding="utf-8")
    assert render("wax.toml") == 0, "a texture that is not baked is optional"
    Path("wax.toml").write_text(f'{text}base_color_texture = "no.png"\n', encoding="utf-8")
    assert render("wax.toml") == 1
    assert "cannot find the file 'no.png' of the texture 'base_color_texture'" in capsys.readouterr().err


def test_without_a_mesh_the_message_says_what_to_put_in(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write("thickness")
    Path("scene.toml").unlink()
    assert render("wax.toml") == 1
    message = capsys.readouterr().err
    assert "run `sssgen bake thickness MESH -o wax_thickness.png` with your own in place of MESH, then write" in message
    assert 'thickness_texture = "wax_thickness.png" in the stage thickness_map of wax.toml\n' in message
    text = (
        '[material]\nname = "wax"\n[[thickness]]\ntechnique = "thinness_map"\n[translucency]\ntechnique = "sky_glow"\n'
    )
    Path("wax.toml").write_text(text, encoding="utf-8")
    assert render("wax.toml") == 1
    assert "makes no such texture: paint it, and write thinness_texture" in capsys.readouterr().err


def test_the_preview_says_it_and_shows_the_picture_when_the_file_comes(folder: Path) -> None:
    write("thickness")
    talk = PageMessages(Pane("scene.toml"))
    (message,) = talk.messages()
    assert "run `sssgen bake thickness box.obj" in message["error"] and message["picture"]["missing"]
    assert main(["bake", "thickness", "box.obj", "-o", "t.png", *QUICK["thickness"]]) == 0
    talk.answer({"kind": "texture", "slot": "thicknessTexture", "name": "t.png"}, Path("t.png").read_bytes())
    (message,) = talk.messages()
    assert not message["error"] and not message["picture"]["missing"]
    talk.answer({"kind": "texture", "slot": "thicknessTexture", "name": ""})
    assert talk.messages()[0]["error"]


def test_the_preview_watches_a_file_that_a_material_names(folder: Path) -> None:
    write("thickness")
    material = Path("wax.toml").read_text(encoding="utf-8").replace('_map"', '_map"\nthickness_texture = "t.png"')
    Path("wax.toml").write_text(material, encoding="utf-8")
    shown = Pane("scene.toml")
    assert "-o t.png`" in shown.message()["error"] and str(Path("t.png").absolute()) in shown.files
    assert main(["bake", "thickness", "box.obj", "-o", "t.png", *QUICK["thickness"]]) == 0
    shown.renew()
    assert not shown.message()["error"]


def test_ci_reports_it(folder: Path) -> None:
    write("thickness")
    with Run(True) as run:
        (outcome,) = [run(case).outcome for case in cases(".", ["numpy"]) if case.kind == "render"]
    assert outcome.state == "failed" and "sssgen bake thickness box.obj" in f"{outcome.message}{outcome.detail}"


# The attribute


def technique_bakes() -> dict[str, Bake]:
    return {technique.name: technique.attributes.bake for technique in library.load_all() if technique.attributes.bake}


@pytest.mark.parametrize("name", technique_bakes())
def test_the_arguments_of_each_technique_are_those_of_the_command(name: str) -> None:
    technique, bake = library.load(name), technique_bakes()[name]
    textures = [uniform for uniform in technique.uniforms if is_baked(uniform)]
    assert len(bake.files) == len(textures)
    words = shlex.split(re.sub(r"\{(light|mean_free_path)\}", "1", bake.arguments))
    assert command_parser("bake").parse_args(words).TEXTURE in KINDS


def test_all_baked_textures_have_a_command_but_these() -> None:
    readers = {
        technique.name
        for technique in library.load_all()
        if technique.role != "distance" and any(map(is_baked, technique.uniforms))
    }
    painted = {"thinness_map", "parallax_curved_map"}
    assert readers - technique_bakes().keys() == painted
    assert {"distance_texture", "distance_texture_world"} <= technique_bakes().keys()
    assert baked_functions(()) == []


def test_a_faulty_attribute_is_an_error() -> None:
    with pytest.raises(SssgenError, match="are not the arguments of sssgen bake"):
        read_attributes(sections("A map.\nbake: thickness box.obj"), "")


@pytest.mark.slow
def test_the_advice_for_an_installed_example_works(
    in_folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is written beside the example, and the bake says so before its work: a copy has the file."""
    installed = folder("examples") / "marble_idol" / "scene_relit.toml"
    assert main(["bake", "fluence", str(installed), "--relit", "16", "-o", str(installed.with_name("idol.bin"))]) == 2
    refused = capsys.readouterr()
    assert "which does not write here" in refused.err and "of 8" not in refused.err
    assert main(["render", str(installed), "-o", "idol.png"]) == 1
    advised = capsys.readouterr().err
    copied, baked = re.findall(r"`sssgen ([^`]+)`", advised)
    assert copied in refused.err and main(shlex.split(copied)) == 0
    monkeypatch.chdir("marble_idol")
    assert main([*shlex.split(baked), "--voxels", "12", "--photons", "500", "--processes", "1"]) == 0
    assert (
        main(["render", "scene_relit.toml", "--size", "24x18", "--samples", "1", "-b", "numpy", "-o", "idol.png"]) == 0
    )
