"""The cache folder: damaged entries, folders of other users, full disks."""

import os
import pickle
import stat
from pathlib import Path

import pytest

from sssgen.support import cache


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SSSGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "_folder", None)
    return tmp_path / "cache"


def test_an_entry_is_read_back() -> None:
    cache.write("entry", b"content")
    assert cache.read("entry") == b"content"
    assert cache.read("another") == b""


def test_no_flipped_bit_is_unpickled(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each single bit of an entry is flipped: the entry is never unpickled, and the value is recomputed."""
    cache.load_or_make("value", "stamp", lambda: {"a": (1, 2.5)})
    entry = (folder / "value").read_bytes()
    monkeypatch.setattr(pickle, "loads", lambda _: pytest.fail("a damaged entry was unpickled"))
    for bit in range(8 * len(entry)):
        damaged = bytearray(entry)
        damaged[bit // 8] ^= 1 << bit % 8
        (folder / "value").write_bytes(damaged)
        assert cache.read("value") == b""
        assert cache.load_or_make("value", "stamp", lambda: "new") == "new"


@pytest.mark.parametrize("length", [0, 1, cache.DIGEST_SIZE, cache.DIGEST_SIZE + 3])
def test_a_cut_entry_is_not_read(folder: Path, length: int) -> None:
    cache.write("entry", b"content")
    (folder / "entry").write_bytes((folder / "entry").read_bytes()[:length])
    assert cache.read("entry") == b""


def test_a_value_of_another_stamp_is_recomputed() -> None:
    assert cache.load_or_make("value", 1, lambda: "first") == "first"
    assert cache.load_or_make("value", 1, lambda: "second") == "first"
    assert cache.load_or_make("value", 2, lambda: "third") == "third"


@pytest.mark.skipif(os.name == "nt", reason="Windows has other permissions")
@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777])
def test_a_folder_writable_by_others_is_not_used(folder: Path, mode: int) -> None:
    folder.mkdir()
    folder.chmod(mode)
    assert cache.folder() == ""
    cache.write("entry", b"content")
    assert not list(folder.iterdir())


@pytest.mark.skipif(os.name == "nt", reason="Windows has other permissions")
def test_a_new_folder_is_private(folder: Path) -> None:
    assert cache.folder() == str(folder)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_full_disk_is_no_error(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    assert cache.load_or_make("value", 1, lambda: "made") == "made"
    assert not list(folder.iterdir())


def test_a_folder_that_cannot_be_created_is_no_error(folder: Path) -> None:
    folder.write_text("a file in its place")
    assert cache.folder() == ""
    assert cache.load_or_make("value", 1, lambda: "made") == "made"


def test_an_empty_variable_turns_the_cache_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSSGEN_CACHE", "")
    monkeypatch.setattr(cache, "_folder", None)
    assert cache.folder() == ""
