"""Unsaved texts take the place of files, and results that depend on them are computed again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from sssgen.lang import loader
from sssgen.material import library
from sssgen.support import unsaved
from sssgen.support.diagnostics import SssgenError
from sssgen.support.text_files import read_text

LOBE = "/**\n * A lobe.\n * role: translucency\n */\nfloat lobe(world_direction N)\n{\n    return N.x;\n}\n"


@pytest.fixture
def file(tmp_path: Path) -> Iterator[Path]:
    path = tmp_path / "lobe.sss"
    path.write_text(LOBE, encoding="utf-8")
    yield path
    unsaved.drop(path)


def test_an_unsaved_text_is_read_in_place_of_the_file(file: Path) -> None:
    unsaved.keep(file, "float x;\r\n")
    assert read_text(file, "lobe.sss") == "float x;\n"
    unsaved.drop(file)
    assert read_text(file, "lobe.sss") == LOBE


def test_an_unsaved_text_of_a_missing_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "new.sss"
    unsaved.keep(path, "x")
    try:
        assert read_text(path, "new.sss") == "x"
    finally:
        unsaved.drop(path)
    with pytest.raises(SssgenError, match="no such file"):
        read_text(path, "new.sss")


def test_an_unsaved_text_is_checked_as_a_file_is(file: Path) -> None:
    for text, message in (("\x00", "zero byte"), ("\ud800", "not UTF-8"), ("x" * (5 << 20), "too large")):
        unsaved.keep(file, text)
        with pytest.raises(SssgenError, match=message):
            read_text(file, "lobe.sss")


def test_a_technique_is_read_again_after_each_unsaved_change(file: Path) -> None:
    assert library.load_path(str(file)).function.params[0].name == "N"
    for name in ("V", "L", "N"):
        unsaved.keep(file, LOBE.replace("N", name))
        assert library.load_path(str(file)).function.params[0].name == name
    unsaved.keep(file, "float lobe(")
    with pytest.raises(SssgenError):
        library.load_path(str(file))
    unsaved.drop(file)
    assert library.load_path(str(file)).function.params[0].name == "N"


def test_the_modules_in_memory_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loader, "MAX_MODULES", 5)
    monkeypatch.setattr(loader, "_modules", {})
    modules = [loader.load_text(f"const float X = {number}.0;\n", "x.sss") for number in range(20)]
    assert len(loader._modules) == 5
    assert len({loader.key_of(module) for module in modules} - {""}) == 20  # the key lives as long as the module
    assert loader.key_of(modules[0]._replace(constants=())) == ""
