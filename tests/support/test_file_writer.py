"""Writing emitted files: only inside of their folder, with any links and names in it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from snapshot import check_snapshot
from sssgen.support.diagnostics import SssgenError
from sssgen.support.file_writer import check_names, write_files

pytestmark = pytest.mark.usefixtures("in_folder")


def test_names_that_leave_the_folder_are_refused() -> None:
    with pytest.raises(SssgenError) as caught:
        check_names(["fine.txt", "../x", "/x", "a\x00b"])
    check_snapshot("cli/names_that_climb_out.txt", f"{caught.value}\n")


def test_sub_folders_are_created_and_links_outside_are_not_followed(tmp_path: Path) -> None:
    write_files(Path("out"), {"include/wax.hlsl": "a\n"})
    assert Path("out/include/wax.hlsl").read_bytes() == b"a\n"
    (tmp_path / "elsewhere").mkdir()
    Path("out/link").symlink_to(tmp_path / "elsewhere", target_is_directory=True)
    with pytest.raises(SssgenError, match="a link that leaves the output folder"):
        write_files(Path("out"), {"link/wax.hlsl": "a\n"})
    with pytest.raises(SssgenError, match="a link that leaves the output folder"):
        write_files(Path("out"), {"link/deeper/wax.hlsl": "a\n"})


def test_a_pipe_is_not_replaced(tmp_path: Path) -> None:
    """Nor a device, which needs more rights to try."""
    os.mkfifo(tmp_path / "a.wgsl")
    with pytest.raises(SssgenError, match="this is a device or a pipe"):
        write_files(tmp_path, {"a.wgsl": "new"})
    assert (tmp_path / "a.wgsl").is_fifo()


def test_a_linked_file_is_replaced_not_written_through() -> None:
    Path("precious.txt").write_text("mine\n", encoding="utf-8")
    Path("out").mkdir()
    Path("out/wax.txt").symlink_to(Path("precious.txt").absolute())
    write_files(Path("out"), {"wax.txt": "new\n"})
    assert Path("precious.txt").read_text(encoding="utf-8") == "mine\n"
    assert Path("out/wax.txt").read_text(encoding="utf-8") == "new\n"
