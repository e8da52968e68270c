"""The folder that the tests of `sssgen bake` run in."""

from __future__ import annotations

from pathlib import Path

import pytest

import bake_meshes as meshes


@pytest.fixture
def folder(in_folder: Path) -> Path:
    """An empty folder, but for a box."""
    meshes.write(Path("box.obj"), meshes.box((1.0, 0.6, 0.4)))
    return in_folder
