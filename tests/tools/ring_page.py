"""A ring as an .obj file, and whether a picture shows it in red with a lamp behind it."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from sssgen.scene.arrays import Array

SIZE = (320, 240)


@pytest.fixture
def ring(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")
    monkeypatch.chdir(tmp_path)
    trimesh.creation.torus(1.0, 0.4, major_sections=64, minor_sections=32).export("ring.obj")
    return "ring.obj"


def pixels(png: bytes) -> Array:
    """(height, width, 3), 0 to 255."""
    from PIL import Image

    return np.asarray(Image.open(BytesIO(png)).convert("RGB"), np.float64)


def check_coral(picture: Array) -> None:
    """A red body fills a part of the picture, and is bright although the lamp is behind it."""
    red = (picture[..., 0] > 90) & (picture[..., 0] > 2.0 * picture[..., 2])
    assert 0.02 < red.mean() < 0.5
