"""The tutorials can be followed to the end, and their pictures are what their commands draw."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from documents import Reader, blocks, programs, read, uncommented
from folders import ROOT
from sssgen.run.backends import Backend
from sssgen.scene.pictures.images import read as read_picture

TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
LARGEST = 150_000
"""Bytes of a picture."""

each = pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda path: path.stem)


@pytest.fixture
def reader(tmp_path: Path) -> Reader:
    """A reader in a checkout without anything but the examples."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    environment = {"PYTHONPATH": str(ROOT / "src"), "SSSGEN_CACHE": str(tmp_path / "cache")}
    return Reader(tmp_path, programs(tmp_path / "programs"), environment)


@each
def test_every_block_of_a_short_tutorial_is_a_step(tutorial: Path) -> None:
    assert len(read(tutorial).splitlines()) <= 120
    assert not uncommented(tutorial)
    (picture,) = re.findall(r"!\[.+\]\((\S+)\)", read(tutorial))
    assert (tutorial.parent / picture).stat().st_size <= LARGEST


@each
def test_the_steps_without_the_picture(tutorial: Path, reader: Reader) -> None:
    steps = [block for block in blocks(tutorial) if block.argument != "gl"]
    assert len(steps) < len(blocks(tutorial))
    for block in steps:
        reader.follow(block)


@pytest.mark.slow
@each
def test_the_picture_is_what_the_commands_draw(
    tutorial: Path, reader: Reader, backend: Callable[[str], Backend]
) -> None:
    backend("gl")
    for block in blocks(tutorial):
        reader.follow(block)
    (drawn,) = reader.folder.glob(f"*/{tutorial.stem}.png")
    shown, expected = read_picture(str(tutorial.with_suffix(".png"))), read_picture(str(drawn))
    assert shown.shape == expected.shape
    assert np.abs(shown - expected).mean() < 0.005
