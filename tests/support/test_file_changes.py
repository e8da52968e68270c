"""The iterator of changes, with files on disk, and messages and a clock that the test controls."""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from sssgen.support import file_changes
from sssgen.support.file_changes import FolderMessages, changes
from sssgen.support.file_memo import CLOCK_STEP, CachedResult, FileState, noted_files, remember
from sssgen.support.text_files import read_text


class Steps:
    """Messages that are steps of a test: each wait runs the next one; after the last one the waiting ends."""

    def __init__(self, *steps: Callable[[], object]) -> None:
        self.steps = list(steps)
        self.now = 0.0
        self.folders: list[str] = []
        self.closed = False

    def follow(self, folders: list[str]) -> bool:
        new, self.folders = folders != self.folders, folders
        return new

    def wait(self, milliseconds: int) -> bool:
        if not self.steps:
            return False
        self.now += milliseconds / 1000
        self.steps.pop(0)()
        return True

    def close(self) -> None:
        self.closed = True


class Reader:
    """Reads the file `a`, which may name another file to read: `include NAME`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.files: dict[str, FileState] = {}
        self.texts: list[str] = []
        self.read()

    def read(self) -> None:
        with noted_files() as self.files:
            try:
                text = read_text(self.folder / "a", "a")
                if text.startswith("include "):
                    text += read_text(self.folder / text.split()[1], "included")
            except Exception as error:
                text = f"error: {error}"
        self.texts.append(text)

    def follow(self, messages: Steps) -> list[set[str]]:
        """The names of the files of each change; the texts that were read are in `texts`."""
        found = []
        for changed in changes(lambda: self.files, None, messages, lambda: messages.now):
            found.append({os.path.relpath(path, self.folder) for path in changed})
            self.read()
            assert len(found) < 50
        assert messages.closed
        return found


def soon(path: Path) -> int:
    """Sets a file's time to one that is within a step of the clock for as long as a test takes, and returns it."""
    value = time.time_ns() + 10_000 * CLOCK_STEP
    os.utime(path, ns=(value, value))
    return value


@pytest.fixture
def reader(tmp_path: Path) -> Reader:
    (tmp_path / "a").write_text("one")
    return Reader(tmp_path)


def test_nothing_is_reported_without_a_change(reader: Reader) -> None:
    other = reader.folder / "other"
    messages = Steps(lambda: other.write_text("x"), lambda: other.unlink(), lambda: os.utime(reader.folder))
    assert reader.follow(messages) == []
    assert messages.folders == sorted([str(reader.folder), str(reader.folder.parent)])


def test_each_save_is_reported_once(reader: Reader) -> None:
    a = reader.folder / "a"
    messages = Steps(lambda: a.write_text("two"), lambda: None, lambda: a.write_text("three"), lambda: None)
    assert reader.follow(messages) == [{"a"}, {"a"}]
    assert reader.texts == ["one", "two", "three"]


def test_a_save_of_the_same_time_and_size_is_seen(reader: Reader) -> None:
    """Two saves within one step of the clock."""
    a = reader.folder / "a"
    saved = soon(a)
    reader.read()

    def save() -> None:
        a.write_text("two")
        os.utime(a, ns=(saved, saved))

    assert reader.follow(Steps(save)) == [{"a"}]
    assert reader.texts == ["one", "one", "two"]


def test_a_save_while_the_result_is_made_is_seen(reader: Reader, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file changes after it was read, and before the next change is requested; no message tells it."""
    a = reader.folder / "a"
    saves = itertools.chain(["three", "four"])
    read = Reader.read

    def read_and_save(self: Reader) -> None:
        read(self)
        if text := next(saves, ""):
            a.write_text(text)

    monkeypatch.setattr(Reader, "read", read_and_save)
    assert reader.follow(Steps(lambda: a.write_text("two"))) == [{"a"}, {"a"}, {"a"}]
    assert reader.texts == ["one", "two", "three", "four"]


def test_many_saves_between_two_looks_are_one_change(reader: Reader) -> None:
    a = reader.folder / "a"
    messages = Steps(lambda: [a.write_text(f"text {number}") for number in range(1000)])
    assert reader.follow(messages) == [{"a"}]
    assert reader.texts == ["one", "text 999"]


def test_a_new_file_that_takes_the_name_is_a_change(reader: Reader) -> None:
    """An editor writes a new file and renames it, or moves the old one away first."""
    a, new, backup = (reader.folder / name for name in ("a", "new", "backup"))
    status = a.stat()

    def replace() -> None:
        new.write_text("two")
        os.utime(new, ns=(status.st_atime_ns, status.st_mtime_ns))
        new.replace(a)

    messages = Steps(replace, lambda: a.rename(backup), lambda: a.write_text("three"))
    assert reader.follow(messages) == [{"a"}, {"a"}]
    assert reader.texts == ["one", "two", "three"]


@pytest.mark.parametrize("emptied", [False, True])
def test_a_file_that_is_being_written_is_not_read_yet(reader: Reader, emptied: bool) -> None:
    a = reader.folder / "a"
    messages = Steps(
        (lambda: a.write_text("")) if emptied else a.unlink, lambda: None, lambda: None, lambda: a.write_text("two")
    )
    assert reader.follow(messages) == [{"a"}]
    assert reader.texts == ["one", "two"]


def test_a_file_that_stays_away_is_reported_once_and_again_when_it_is_back(reader: Reader) -> None:
    a, backup = reader.folder / "a", reader.folder / "backup"
    messages = Steps(lambda: a.rename(backup), *[lambda: None] * 60, lambda: backup.rename(a))
    assert reader.follow(messages) == [{"a"}, {"a"}]
    assert [text.splitlines()[0] for text in reader.texts] == ["one", "error: error: no such file", "one"]


def test_a_renamed_folder(tmp_path: Path) -> None:
    folder, moved = tmp_path / "folder", tmp_path / "moved"
    folder.mkdir()
    (folder / "a").write_text("one")
    reader = Reader(folder)

    def back() -> None:
        moved.rename(folder)
        (folder / "a").write_text("two")

    assert reader.follow(Steps(lambda: folder.rename(moved), *[lambda: None] * 60, back)) == [{"a"}, {"a"}]
    assert reader.texts[-1] == "two"


def test_the_files_of_the_newest_result_are_followed(reader: Reader) -> None:
    """One that is included from now on, also while it is missing, and no longer one that is not."""
    a, b = reader.folder / "a", reader.folder / "b"
    messages = Steps(
        lambda: a.write_text("include b"),
        lambda: b.write_text(" first"),
        lambda: b.write_text(" second"),
        lambda: a.write_text("alone"),
        lambda: b.write_text(" third"),
    )
    assert reader.follow(messages) == [{"a"}, {"b"}, {"b"}, {"a"}]
    assert reader.texts[2:] == ["include b first", "include b second", "alone"]


def test_who_makes_no_new_result_is_not_told_again(reader: Reader) -> None:
    a = reader.folder / "a"
    messages = Steps(lambda: a.write_text("two"), lambda: None, lambda: a.write_text("three"))
    assert len(list(changes(lambda: reader.files, None, messages, lambda: messages.now))) == 2


def test_a_result_in_memory_is_of_the_newest_text(tmp_path: Path) -> None:
    """Also where the file changes while it is read, or again at the same time."""
    path = tmp_path / "a"
    path.write_text("one")
    saved = soon(path)
    memory: dict[str, CachedResult] = {}
    saves: Iterator[str] = iter(["two", "six"])

    def read() -> str:
        text = read_text(path, "a")
        if new := next(saves, ""):
            path.write_text(new)
            os.utime(path, ns=(saved, saved))
        return text

    results = [remember(memory, "a", read) for _ in range(4)]
    assert results == ["one", "two", "six", "six"]


def test_messages_of_the_system(tmp_path: Path) -> None:
    """A save ends the wait, a message to the process raises, and a new folder of the same name is listened to."""
    pytest.importorskip("watchfiles")
    folder, moved = tmp_path / "folder", tmp_path / "moved"
    folder.mkdir()

    class Stopped:
        stopped = False

        def is_set(self) -> bool:
            return self.stopped

    stop = Stopped()
    messages = FolderMessages(stop)
    try:
        assert messages.follow([str(folder), str(tmp_path / "missing")])
        assert not messages.follow([str(folder)])
        folder.rename(moved)
        assert messages.follow([str(folder)])
        assert messages.wait(1)  # there is nothing to listen to
        folder.mkdir()
        assert messages.follow([str(folder)])
        (folder / "a").write_text("one")
        assert messages.wait(60_000)
        stop.stopped = True
        assert not messages.wait(60_000)
    finally:
        messages.close()


def test_a_system_without_messages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It refuses to send any, as Linux does with too many watches: the files are looked at by time."""
    pytest.importorskip("watchfiles")

    def refuse(*_: object) -> None:
        raise OSError("no space left on device")

    waited: list[float] = []
    monkeypatch.setattr("sssgen.support.file_changes.time.sleep", waited.append)
    messages = FolderMessages()
    monkeypatch.setattr(messages, "_notify", refuse)
    assert messages.follow([str(tmp_path)])
    assert messages.wait(5000)
    assert waited == [file_changes.UNHEARD_MS / 1000]
