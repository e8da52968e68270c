"""Pipes, devices, folders and loops of links in place of files; files that include files without end."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from front_ends import FRONT_ENDS, NAME, accepts
from sssgen.lang import loader
from sssgen.lang.loader import load_file
from sssgen.support.diagnostics import SssgenError
from watchdog import bounded

BESIDE = ("ci folder", "reflection", "ci table", "baked")
"""These look for their files themselves."""

posix = pytest.mark.skipif(os.name != "posix", reason="there are no pipes with names")


@posix
@pytest.mark.parametrize("name", FRONT_ENDS)
def test_a_pipe_is_not_waited_for(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{NAME}{FRONT_ENDS[name].suffix}"
    os.mkfifo(path)
    assert not accepts(FRONT_ENDS[name], path) or name in BESIDE


@posix
@pytest.mark.parametrize("name", FRONT_ENDS)
@pytest.mark.parametrize("target", ["/dev/zero", "itself"])
def test_links_to_devices_and_cyclic_links(name: str, target: str, tmp_path: Path) -> None:
    path = tmp_path / f"{NAME}{FRONT_ENDS[name].suffix}"
    path.symlink_to(path if target == "itself" else target)
    assert not accepts(FRONT_ENDS[name], path) or name in BESIDE


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="there is nothing that root may not read")
@pytest.mark.parametrize("name", FRONT_ENDS)
def test_an_unreadable_file(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{NAME}{FRONT_ENDS[name].suffix}"
    path.write_bytes(FRONT_ENDS[name].seeds()[0])
    path.chmod(0)
    assert not accepts(FRONT_ENDS[name], path) or name in BESIDE


# Includes


def included(path: Path) -> str:
    """The error of loading a file, or ''."""
    with bounded():
        try:
            load_file(path)
        except SssgenError as error:
            assert error.diagnostics[0].span.line
            return str(error)
    return ""


def chain(folder: Path, length: int, line: str = '#include "{}.sss"\n') -> Path:
    """A file that includes the next, which includes the next."""
    for number in range(length):
        text = line.replace("{}", str(number + 1)) if number + 1 < length else ""
        (folder / f"{number}.sss").write_text(f"{text}float f{number}() {{ return 1.0; }}\n", encoding="utf-8")
    return folder / "0.sss"


def test_a_chain_of_files(tmp_path: Path) -> None:
    assert included(chain(tmp_path, loader.MAX_INCLUDED)) == ""
    assert f"more than {loader.MAX_INCLUDED} deep" in included(chain(tmp_path, 1000))


def test_paths_that_double(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each file includes the next by two names: the number of paths doubles with each file; not all are followed."""
    read: list[str] = []
    original = loader.read_text
    monkeypatch.setattr(loader, "read_text", lambda path, shown: (read.append(str(path)), original(path, shown))[1])
    assert included(chain(tmp_path, 30, '#include "{}.sss"\n#include "./{}.sss"\n')) == ""
    assert len(read) < 30 * 30


def test_many_includes_of_one_file(tmp_path: Path) -> None:
    (tmp_path / "a.sss").write_text("float f() { return 1.0; }\n", encoding="utf-8")
    (tmp_path / "many.sss").write_text('#include "a.sss"\n' * 20_000, encoding="utf-8")
    assert included(tmp_path / "many.sss") == ""


@pytest.mark.parametrize("name", ["a.sss", "./a.sss", "b.sss", "loop/a.sss"])
def test_cycles(name: str, tmp_path: Path) -> None:
    if "loop" in name:
        if os.name != "posix":
            pytest.skip("a symbolic link needs an administrator's rights on Windows")
        (tmp_path / "loop").symlink_to(tmp_path)
    (tmp_path / "a.sss").write_text(f'#include "{name}"\n', encoding="utf-8")
    (tmp_path / "b.sss").write_text('#include "a.sss"\n', encoding="utf-8")
    assert "includes itself" in included(tmp_path / "a.sss")


@pytest.mark.parametrize(
    "name", [".", "..", "nothing.sss", "/dev/null", "/dev/stdin", "a\\b", "pipe.sss", "dangling.sss"]
)
def test_invalid_include_paths_are_refused(name: str, tmp_path: Path) -> None:
    if os.name == "posix":
        os.mkfifo(tmp_path / "pipe.sss")
        (tmp_path / "dangling.sss").symlink_to(tmp_path / "gone.sss")
    (tmp_path / "a.sss").write_text(f'\n#include "{name}"\n', encoding="utf-8")
    assert "a.sss:2:11" in included(tmp_path / "a.sss")
