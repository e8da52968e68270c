"""Faulty files of Unity: an error with a place, and nothing is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.interchange.mapping_report import Report
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("yaml")

from sssgen.interchange import unity_reader

HEAD = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n--- !u!21 &2100000\n"
SHADER = "m_Shader: {fileID: 4800000, guid: 933532a4fcc9baf4fa0491de14d08ed7, type: 3}"
PARENT = "m_Parent: {fileID: 2100000, guid: GUID, type: 2}"
BOMB = "Material:\n  a: &a [x, x]\n  b: &b [*a, *a]\n"


def material(*lines: str) -> str:
    """A material with some lines of its own."""
    return f"{HEAD}Material:\n  {SHADER}\n" + "".join(f"  {line}\n" for line in lines)


def saved(*lines: str) -> str:
    """A material with some lines of saved properties."""
    return material("m_SavedProperties:", *(f"  {line}" for line in lines))


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        ("", "this is not a text file of Unity", 1),
        ("\x01binary", "this is not a text file of Unity", 1),
        (f"{HEAD}Material:\n  a: [1, 2", "this is not YAML", 5),
        (f"{HEAD}Material:\n  m_Name: !!python/object:os.system x\n", "the tag", 5),
        (f"{HEAD}Material:\n  m_Name: !evil x\n", "", 5),
        (f"{HEAD}{BOMB}", "an alias (*name) is not read", 6),
        (f"{HEAD}Material:\n  a: {'[' * 60}{']' * 60}\n", "nested too deeply", 5),
        (f"{HEAD}Material:\n  a: 1\n  a: 2\n", "the key 'a' is there twice", 6),
        (f"{HEAD}Material: 5\n", "a mapping is expected here", 4),
        (f"{HEAD}Mesh:\n  a: 1\n", "the file has no material", 0),
        (material("m_SavedProperties: 5"), "a mapping is expected here", 6),
        (saved("m_Floats: {x: 1}"), "a list is expected here", 7),
        (saved("m_Floats:", "- _Metallic: much"), "'much' is not a number", 8),
        (saved("m_Floats:", "- _Metallic: .nan"), "is not a number", 8),
        (saved("m_Floats:", "- _Metallic: {x: 1}"), "a number or a text is expected", 8),
        (saved("m_Colors:", "- _BaseColor: {r: 1, g: 1}"), "the key 'b' is missing", 8),
        (saved("m_TexEnvs:", "- _BaseMap: {m_Texture: {fileID: 0}}"), "the key 'm_Scale' is missing", 8),
        (material(), "the key 'm_SavedProperties' is missing: the file is truncated", 5),
        (saved("m_TexEnvs: []", "m_Floats: []"), "the key 'm_Colors' is missing: the file is truncated", 7),
        (material(PARENT.replace("GUID", "7" * 32)), "the parent material", 6),
        (f"{HEAD}Material:\n  m_Shader: {{fileID: 1, guid: {'8' * 32}, type: 3}}\n", "the shader 8888", 5),
    ],
)
def test_faulty_materials(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str, line: int
) -> None:
    """The message names the fault and its line; the command writes nothing."""
    path = tmp_path / "Assets" / "a.mat"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SssgenError) as caught:
        unity_reader.read(str(path), Report("a"))
    diagnostic = caught.value.diagnostics[0]
    assert message in diagnostic.message
    assert diagnostic.span.file.endswith("a.mat") and diagnostic.span.line == line
    assert main(["import", str(path), "-o", str(tmp_path / "out")]) != 0
    assert not (tmp_path / "out").exists()
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("  m_Name: x\n", "no diffusion profile"),
        ("  profile:\n    scatteringDistance: {r: -1, g: 1, b: 1, a: 1}\n", "below 0"),
        ("  profile:\n    scatteringDistance: {r: a, g: 1, b: 1, a: 1}\n", "'a' is not a number"),
        ("  profile:\n    scatteringDistance: 3\n", "a mapping is expected"),
    ],
)
def test_faulty_profiles(tmp_path: Path, body: str, message: str) -> None:
    path = tmp_path / "a.asset"
    path.write_text(f"{HEAD.replace('21', '114')}MonoBehaviour:\n{body}", encoding="utf-8")
    with pytest.raises(SssgenError, match=message):
        unity_reader.read(str(path), Report("a"))


def test_materials_that_are_their_own_ancestors(tmp_path: Path) -> None:
    """Two materials, each the parent of the other."""
    for name, other in (("a", "2"), ("b", "1")):
        path = tmp_path / f"{name}.mat"
        path.write_text(material(PARENT.replace("GUID", other * 32)), encoding="utf-8")
        own = "1" if name == "a" else "2"
        path.with_name(f"{name}.mat.meta").write_text(f"fileFormatVersion: 2\nguid: {own * 32}\n", encoding="utf-8")
    with pytest.raises(SssgenError, match="its own ancestor"):
        unity_reader.read(str(tmp_path / "a.mat"), Report("a"))


def test_a_texture_that_is_gone(tmp_path: Path) -> None:
    """A .meta file without its picture counts as a missing GUID."""
    guid = "3" * 32
    (tmp_path / "p.png.meta").write_text(f"fileFormatVersion: 2\nguid: {guid}\n", encoding="utf-8")
    texture = (
        f"- _BaseMap: {{m_Texture: {{fileID: 1, guid: {guid}}}, m_Scale: {{x: 1, y: 1}}, m_Offset: {{x: 0, y: 0}}}}"
    )
    text = saved("m_TexEnvs:", texture, "m_Floats: []", "m_Colors: []")
    (tmp_path / "a.mat").write_text(text, encoding="utf-8")
    report = Report("a")
    unity_reader.read(str(tmp_path / "a.mat"), report)
    assert [row.value for row in report.rows if row.outcome == "left out"] == [guid]
