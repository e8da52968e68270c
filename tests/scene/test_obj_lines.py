"""A wrong line of an .obj file is an error at this line, in plain words."""

from __future__ import annotations

import pytest

from sssgen.scene import mesh_files
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("trimesh", reason="trimesh is missing: pip install -e '.[import]'")

RIGHT = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0", "vt 0 0", "f 1/1 2/1 3/1", "f 1/1 3/1 4/1"]


@pytest.mark.parametrize(
    ("line", "text", "message"),
    [
        (2, "v 1 x 0", "'x' is no number"),
        (2, "v 1 0,5 0", "'0,5' is no number: write a point in place of the comma"),
        (2, "v 1 0", "a vertex has at least 3 numbers, and this one has 2"),
        (2, "v 1 0 0 1 1 1", "a vertex has 6 numbers, and others have 3"),
        (5, "vt a 0", "'a' is no number"),
        (6, "f 1/1 2/1 9/1", "a triangle refers to vertex 9, and the file has 4"),
        (6, "f 1/1 2/1 -9/1", "a triangle refers to vertex 9, and the file has 4"),
        (6, "f 0/1 2/1 3/1", "a triangle refers to vertex 0, and the first one has the number 1"),
        (6, "f 1/1 2/7 3/1", "a triangle refers to texture coordinate 7, and the file has 1"),
        (6, "f 1/1 2/1 b/1", "'b/1' is no number of a vertex"),
    ],
)
def test_a_wrong_line_is_named(line: int, text: str, message: str) -> None:
    lines = [*RIGHT]
    lines[line - 1] = text
    with pytest.raises(SssgenError) as caught:
        mesh_files.parse("\n".join(lines).encode(), "bad.obj")
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.span.file, diagnostic.span.line, diagnostic.source_line) == ("bad.obj", line, text)
    assert diagnostic.message.startswith(message) and "float" not in diagnostic.render()


@pytest.mark.parametrize(
    "lines",
    [
        RIGHT,
        ["# made by hand", *RIGHT[:5], "s 1", "g part", "f -4/-1 -3/-1 -2/-1", "f 1//  2//  3//"],
        [*RIGHT[:4], "vt 0 0", "f 1 2 3 4"],
        [f"{line} 0.5 0.5 0.5" if line.startswith("v ") else line for line in RIGHT],
    ],
)
def test_right_lines_are_read(lines: list[str]) -> None:
    content = mesh_files.parse("\r\n".join(lines).encode(), "right.obj")
    assert content.vertices.max() == 1.0 and len(content.faces) > 0


@pytest.mark.parametrize(("data", "name"), [(b"ply\nformat ascii 1.0\n", "cut.ply"), (b"glTF", "cut.glb")])
def test_a_file_that_is_cut_off_has_no_words_of_python(data: bytes, name: str) -> None:
    with pytest.raises(SssgenError) as caught:
        mesh_files.parse(data, name)
    text = str(caught.value)
    assert "it may be cut off, or another kind of file: export it again" in text and "Error:" not in text, text
