"""`sssgen bake environment`: cube maps in DDS files, read back by the specification's offsets."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from sssgen.cli.main import main
from sssgen.targets.runtime.numpy_textures import cube_directions

HEAD = 4 + 124 + 20


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a bake of light that is red towards +x, green towards +y and blue towards -z."""
    folder = tmp_path_factory.mktemp("sky")
    polar = np.pi * (np.arange(32) + 0.5)[:, None] / 32
    around = np.pi * ((np.arange(64) + 0.5) / 32 - 1.0)
    ways = [np.sin(polar) * np.cos(around), np.cos(polar) + 0.0 * around, -np.sin(polar) * np.sin(around)]
    np.save(folder / "sky.npy", np.flipud(np.maximum(np.stack(ways, axis=-1), 0.0)).astype(np.float32))
    command = ["bake", "environment", str(folder / "sky.npy"), "-o", str(folder / "cube.dds"), "--intensity", "2"]
    assert main(command) == 0
    return folder


def levels_of(path: Path) -> list[np.ndarray]:
    """The levels (6, side, side, 4) of a cube map: faces one after the other, each with all its levels."""
    data = path.read_bytes()
    magic, size, flags, height, width, pitch, depth, count = struct.unpack_from("<4s7I", data)
    assert (magic, size, height, depth) == (b"DDS ", 124, width, 0) and flags & 0x20000 and pitch == 8 * width
    assert struct.unpack_from("<4s", data, 84) == (b"DX10",)
    assert struct.unpack_from("<2I", data, 108) == (0x401008, 0xFE00)  # complex, texture, mipmaps; a whole cube
    assert struct.unpack_from("<5I", data, 128) == (10, 3, 4, 1, 0)  # R16G16B16A16_FLOAT, 2D, cube, one, straight
    sides = [width >> level for level in range(count)]
    assert len(data) == HEAD + 6 * 8 * sum(side * side for side in sides)
    texels = np.frombuffer(data, "<f2", offset=HEAD).reshape(6, -1, 4)
    ends = np.cumsum([0, *(side * side for side in sides)])
    return [texels[:, a:b].reshape(6, s, s, 4) for a, b, s in zip(ends, ends[1:], sides, strict=False)]


def test_the_files_are_cube_maps_of_the_light(baked: Path) -> None:
    levels = levels_of(baked / "cube.dds")
    assert [level.shape[1] for level in levels] == [64, 32, 16, 8, 4]
    ways = cube_directions(64)
    expected = 2.0 * np.maximum(ways * [1.0, 1.0, -1.0], 0.0)
    assert np.abs(levels[0][..., :3] - expected).max() < 0.12  # pixels of the picture
    assert np.abs(levels[0][..., :3] - expected).mean() < 0.02
    (irradiance,) = levels_of(baked / "cube_irradiance.dds")
    # a cosine lobe of light: towards its axis the mean is 2 · 2/3, the hemisphere's mean of the cosine's square
    middle = irradiance[0, 7:9, 7:9, 0].mean()
    assert abs(middle - 4.0 / 3.0) < 0.02
    assert irradiance[1, 8, 8, 0] < 0.01 and irradiance[2, 8, 8, 1] > 1.3 and irradiance[5, 8, 8, 2] > 1.3


def test_the_json_has_the_parameter(baked: Path) -> None:
    facts = json.loads((baked / "cube.dds.json").read_text(encoding="utf-8"))
    assert facts["kind"] == "environment" and facts["parameters"] == {"reflection_levels": 4.0}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["-o", "cube.png"], "'.png' is not the suffix of a cube map's file"),
        (["-o", "cube.dds", "--intensity", "0"], "the intensity 0 is not a factor of light"),
    ],
)
def test_wrong_options(
    options: list[str], message: str, baked: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(baked)
    assert main(["bake", "environment", "sky.npy", *options]) != 0
    assert message in capsys.readouterr().err
    assert not (baked / "cube.png").exists()
