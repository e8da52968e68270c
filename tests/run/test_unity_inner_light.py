"""The component that computes the light inside a body in URP, run on stand-ins of Unity's objects, against NumPy."""

from __future__ import annotations

import base64
import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import sssgen
from oracle import close
from relit_cases import write_body
from sssgen.run.backends import Array
from sssgen.scene.geometry_base import unit
from sssgen.scene.light_response import Incoming, LightResponse, from_bytes, harmonics, volume
from unity_frames import MIRROR, STAND_INS, VERSIONS, mono, runtime_of

NEGATED_X = np.diag([-1.0, 1.0, 1.0, 1.0])
RANGE, SPOT, INNER = 4.0, 60.0, 25.0
"""The range of the lamps, and the angles of the spot light in degrees."""
COLORS = np.array([[2.0, 1.6, 1.2], [0.2, 0.4, 0.8], [3.0, 0.5, 1.0]])
SUN, LAMP, TORCH = np.array([-0.6, 0.3, -0.8]), np.array([0.9, -0.2, 0.7]), np.array([-1.1, 0.9, 0.8])
"""The direction towards the sun, and the places of the other two."""
WARM = [1.0, 0.5, 0.25]
"""The colour of the lamp's temperature in the stand-in, by which Unity multiplies its own."""


class Frame(NamedTuple):
    """What the component gave the renderer."""

    count: int
    """How often the volume was computed"""
    texels: Array
    """(z, y, x, 4)"""
    values: dict[str, list[float]]


@pytest.fixture(scope="module", params=["URP 12", "URP 17"])
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program that runs the component as a version of Unity compiles it; a warning is an error."""
    folder = tmp_path_factory.mktemp("inside")
    component = folder / "SssgenInnerLight.cs"
    component.write_text(runtime_of(component.name), encoding="utf-8")
    symbols = [f"-define:{symbol}" for symbol in VERSIONS[request.param]]
    sources = map(str, [STAND_INS / "engine.cs", STAND_INS / "pipeline.cs", STAND_INS / "inside/inside.cs", component])
    call = [mono()[0], "-langversion:latest", "-warnaserror", *symbols, f"-out:{folder / 'inside.exe'}", *sources]
    done = subprocess.run(call, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "inside.exe"


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a body, its material and its bake."""
    folder = tmp_path_factory.mktemp("body")
    write_body(folder)
    return folder


def response_of(folder: Path) -> tuple[LightResponse, dict[str, Any]]:
    facts = json.loads((folder / "body.bin.json").read_text("utf-8"))
    return from_bytes((folder / "body.bin").read_bytes(), facts), facts


def run(program: Path, rows: Sequence[Sequence[Any]], shape: tuple[int, int, int]) -> tuple[list[Frame], list[str]]:
    """The frames of some rows, and the warnings."""
    text = "\n".join("\t".join(map(str, row)) for row in rows) + "\n"
    done = subprocess.run(
        [mono()[1], str(program)], input=text, capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    frames, warnings, values, volumes = [], [], {}, []
    for word, *rest in (line.split("\t") for line in done.stdout.splitlines()):
        if word == "warning":
            warnings += rest
        elif word == "end":
            count, texels = volumes.pop() if volumes else ("0", "")
            drawn = np.frombuffer(base64.b64decode(texels), np.float16).astype(float)
            frames.append(Frame(int(count), drawn.reshape(*shape, 4) if texels else drawn, values))
            values = {}
        elif rest[0] == "_InnerLight":
            volumes.append(rest[1].split(" "))
        else:
            values[rest[0]] = [float(number) for number in rest[1].split(" ")]
    return frames, warnings


def bake_row(folder: Path, mirrored: bool) -> list[Any]:
    return ["bake", folder / "body.bin", folder / "body.bin.json", mirrored]


def place_row(place: Array, mirrored: bool) -> list[Any]:
    """The matrices of a renderer whose mesh is at `place` of this project's world, which is Unity's without mirrors."""
    to_world = MIRROR @ place @ (NEGATED_X if mirrored else np.eye(4))
    return ["place", *to_world.ravel(), *np.linalg.inv(to_world).ravel()]


def light_rows(torch: Array = TORCH) -> list[list[Any]]:
    """A sun, a point light, and a spot light that looks at the origin; their intensity is a half."""
    rows = []
    places, ahead = (np.zeros(3), LAMP, torch), unit(np.stack([-SUN, LAMP, -torch]))
    for kind, place, way, color in zip(("Directional", "Point", "Spot"), places, ahead, COLORS, strict=True):
        vectors = np.concatenate([MIRROR[:3, :3] @ place, MIRROR[:3, :3] @ way, 2.0 * color])
        rows.append(["light", kind, *vectors, RANGE, SPOT, INNER])
    return rows


def incoming(response: LightResponse, place: Array, torch: Array = TORCH) -> list[Incoming]:
    """The same lights at the voxels, with URP's falloff."""
    to_object = np.linalg.inv(place)
    at = response.places() @ place[:3, :3].T + place[:3, 3]
    lights = [Incoming(unit((to_object[:3, :3] @ SUN)[None]), COLORS[:1])]
    for lamp, color in ((LAMP, COLORS[1] * WARM), (torch, COLORS[2])):
        way = lamp - at
        away = np.linalg.norm(way, axis=1, keepdims=True)
        share = np.clip(1.0 - (away / RANGE) ** 4, 0.0, None) ** 2 / away**2
        if lamp is torch:
            cosine, (outer, inner) = (way / away) @ unit(torch[None])[0], np.cos(0.5 * np.radians([SPOT, INNER]))
            share *= np.clip((cosine - outer) / (inner - outer), 0.0, 1.0)[:, None] ** 2
        lights.append(Incoming(unit(way @ to_object[:3, :3].T), color * share))
    return lights


def polynomials(ways: Array) -> Array:
    """What Unity's shaders multiply the numbers of a probe by."""
    x, y, z = ways.T
    return np.stack([x**0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y])


def surroundings(probe: Array, place: Array) -> Array:
    """The integrals of a probe's light (3, 9) times the harmonics in object space, by sums over many directions."""
    ways = unit(np.random.default_rng(1).normal(size=(4000, 3)))
    shown = probe @ polynomials(unit(ways @ place[:3, :3].T) @ MIRROR[:3, :3])
    integrals: Array = np.linalg.lstsq(harmonics(ways), shown.T, rcond=None)[0]
    return integrals / (np.pi * np.repeat([1.0, 2.0 / 3.0, 0.25], [1, 3, 5])[:, None])


@pytest.mark.parametrize("mirrored", [True, False])
def test_the_light_is_that_of_numpy(mirrored: bool, program: Path, body: Path) -> None:
    """Of a sun, a lamp, a spot light and a probe, also after one of them and the body have moved."""
    response, facts = response_of(body)
    random = np.random.default_rng(0)
    probe = random.uniform(-0.05, 0.05, (3, 9)) + 0.3 * np.eye(9)[0]
    places = [np.eye(4), np.eye(4)]
    places[0][:3, :3] = Rotation.from_rotvec([0.9, -1.3, 0.4]).as_matrix()
    places[1][:3, :3] = 1.4 * Rotation.from_rotvec([-0.3, 0.2, 2.0]).as_matrix()
    places[1][:3, 3] = 0.3, -0.1, 0.2
    around = ["probe", *probe.ravel()]
    rows = [bake_row(body, mirrored), around, *light_rows(), place_row(places[0], mirrored), ["frame"], ["frame"]]
    rows += [["dark"], *light_rows(1.2 * TORCH), place_row(places[1], mirrored), ["frame"]]
    frames, warnings = run(program, rows, response.nearest.shape)
    assert not warnings and [frame.count for frame in frames] == [1, 1, 2]
    for frame, place, torch in zip(frames[1:], places, (TORCH, 1.2 * TORCH), strict=True):
        expected = volume(response, incoming(response, place, torch), surroundings(probe, place))
        assert expected[..., :3].std() > 0.05
        close(frame.texels, expected, rtol=5e-3, atol=1e-3)  # stored roots are rounded between texels
        to_volume = np.array(facts["parameters"]["world_to_volume"]).reshape(4, 4).T @ np.linalg.inv(place) @ MIRROR
        close(np.reshape(frame.values["_WorldToVolume"], (4, 4)), to_volume, rtol=1e-5, atol=1e-5)
        close(frame.values["_Extinction"][:3], facts["parameters"]["extinction"], rtol=1e-6, atol=0.0)
        close(frame.values["_MeanFreePath"], [facts["parameters"]["mean_free_path"]], rtol=1e-6, atol=0.0)


def test_the_values_are_those_of_the_shader(program: Path, body: Path) -> None:
    """The shader has each property that the component sets, but for parameters that its technique does not read."""
    files = sssgen.compile(str(body / "relit.toml"), "unity-urp").files
    (shader,) = (text for name, text in files.items() if name.endswith(".shader"))
    assert files["SssgenInnerLight.cs"] == runtime_of("SssgenInnerLight.cs") and "SssgenPasses.cs" in files
    assert "// _InnerLight: drawn by the component of SssgenInnerLight.cs." in shader
    response, _ = response_of(body)
    frames, _ = run(program, [bake_row(body, True), place_row(np.eye(4), True), ["frame"]], response.nearest.shape)
    unread = {name for name in frames[0].values if f" {name};" not in shader}
    assert unread == {"_Ior", "_FluenceReach"} and "TEXTURE3D(_InnerLight);" in shader


def test_a_body_without_pictures_has_the_component_alone(body: Path) -> None:
    material = body / "once.toml"
    text = (body / "relit.toml").read_text("utf-8").replace("fluence_relit", "fluence_relit_once")
    material.write_text(text + '[thickness]\ntechnique = "march_view"\nbind = { body_distance = "torus" }\n', "utf-8")
    files = sssgen.compile(str(material), "unity-urp").files
    assert "SssgenInnerLight.cs" in files and "SssgenPasses.cs" not in files


@pytest.mark.parametrize("broken", ["file", "json", "other json"])
def test_a_wrong_file_is_a_warning(broken: str, program: Path, body: Path, tmp_path: Path) -> None:
    for name in ("body.bin", "body.bin.json"):
        (tmp_path / name).write_bytes((body / name).read_bytes())
    if broken == "file":
        (tmp_path / "body.bin").write_bytes(b"no file of a bake")
    else:
        (tmp_path / "body.bin.json").write_text(
            '{"format": ' if broken == "json" else '{"format": [1, "a\\"b"]}', "utf-8"
        )
    frames, warnings = run(program, [bake_row(tmp_path, True), ["frame"]], (1, 1, 1))
    assert not frames[0].values and frames[0].count == 0
    assert len(warnings) == 1 and "sssgen bake fluence --relit" in warnings[0]
