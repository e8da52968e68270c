"""Damaged files for every reader: each is accepted, or refused with a place, within a bound of processor time."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amounts import examples
from front_ends import FRONT_ENDS, accepts, survives
from hostile import HOSTILE
from mutations import mutated
from slow_cases import some_slow
from sssgen.support import paths as data

TEXTS = [name for name, front_end in FRONT_ENDS.items() if front_end.is_text]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that the examples name."""
    result = tmp_path_factory.mktemp("fuzz")
    for example in sorted(data.folder("examples").iterdir()):
        for beside in (*example.glob("*.sss"), *example.glob("textures")):
            copy = shutil.copytree if beside.is_dir() else shutil.copy
            copy(beside, result / beside.name, **({"dirs_exist_ok": True} if beside.is_dir() else {}))
    return result


@pytest.mark.filterwarnings("ignore")  # warnings of Pillow, trimesh and OpenEXR are not tested
@pytest.mark.parametrize("name", FRONT_ENDS)
@examples(60, 1.0)
@given(draw=st.data())
def test_mutated_valid_input(name: str, folder: Path, draw: st.DataObject) -> None:
    front_end = FRONT_ENDS[name]
    survives(front_end, draw.draw(mutated(front_end.seeds(), not front_end.is_text)), folder)


@pytest.mark.parametrize("name", FRONT_ENDS)
def test_the_seeds_are_right(name: str, folder: Path) -> None:
    """The seeds are valid; else the mutations would test the first check alone."""
    front_end = FRONT_ENDS[name]
    good = [survives(front_end, seed, folder) for seed in front_end.seeds()]
    assert sum(good) > 0.8 * len(good)


@pytest.mark.parametrize("name", some_slow(TEXTS, "source", "material", "plain glsl"))
def test_hostile_texts(name: str, folder: Path) -> None:
    """Each by itself: too deep, too long, too large, no text at all."""
    for title, content in HOSTILE.items():
        try:
            survives(FRONT_ENDS[name], content, folder)
        except BaseException as error:
            error.add_note(f"the input was: {title}")
            raise


@pytest.mark.parametrize("name", FRONT_ENDS)
@pytest.mark.parametrize("file", ["no\0name", "no\ud800name", "a" * 300, "folder", "missing"])
def test_names_that_no_file_has(name: str, file: str, folder: Path) -> None:
    path = folder / f"{file}{FRONT_ENDS[name].suffix}"
    if file == "folder":
        path.mkdir(exist_ok=True)
    if name not in ("baked", "ci folder", "reflection", "ci table"):  # these look for their files themselves
        assert not accepts(FRONT_ENDS[name], path)
