"""Faulty MaterialX documents: an error with a place and the element's path, and nothing is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.cli.main import main
from sssgen.interchange.mapping_report import Report
from sssgen.support.diagnostics import SssgenError

pytest.importorskip("MaterialX")

from sssgen.interchange import materialx_reader

HEAD = '<?xml version="1.0"?>\n<materialx version="1.39" xmlns:xi="http://www.w3.org/2001/XInclude">\n'


def document(inputs: str, nodes: str = "") -> str:
    """A document with one standard_surface."""
    return (
        f'{HEAD}{nodes}\n<standard_surface name="S" type="surfaceshader">{inputs}</standard_surface>\n'
        '<surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S"/>'
        "</surfacematerial>\n</materialx>"
    )


ROUGHNESS = '<input name="specular_roughness" type="float" nodename="n"/>'
CIRCLE = """<add name="n" type="float"><input name="in1" type="float" nodename="m"/></add>
<multiply name="m" type="float"><input name="in1" type="float" nodename="n"/></multiply>"""
OWN_CIRCLE = """<nodedef name="ND_r" node="r"><output name="out" type="float"/></nodedef>
<nodegraph name="NG_r" nodedef="ND_r"><r name="again" type="float"/><output name="out" type="float" nodename="again"/>
</nodegraph><r name="n" type="float"/>"""
GRAPH = '<nodegraph name="G"><constant name="c" type="float"/><output name="o" type="float" nodename="c"/></nodegraph>'
UNBOUND = GRAPH.replace(
    'type="float"/>', 'type="float"><input name="value" type="float" interfacename="x"/></constant>', 1
)
ELL = """<input name="subsurface_scale" type="float" value="1" unit="ell" unittype="distance"/>
<input name="subsurface" type="float" value="1"/>"""
BOMB = '<!DOCTYPE materialx [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>\n<materialx version="1.39">&b;</materialx>'


def graph_input(attributes: str, kind: str = "float") -> str:
    """An input that is connected with a graph."""
    return f'<input name="specular_roughness" type="{kind}" {attributes}/>'


def picture(name: str) -> str:
    """An image node that reads a file."""
    return f'<image name="n" type="float"><input name="file" type="filename" value="{name}"/></image>'


@pytest.mark.parametrize(
    ("text", "message", "path"),
    [
        ("<materialx>\n<a", "this is not XML", ""),
        ("<other/>", "root is <other>", ""),
        (BOMB, "a document type or an entity is not read", ""),
        ("<materialx version='1.39'>" + "<nodegraph name='a'>" * 40 + "</nodegraph>" * 40 + "</materialx>", "deep", ""),
        (f'{HEAD}<image name="a" type="float"/><image name="a" type="float"/></materialx>', "two elements", "a"),
        ('<materialx version="9.9"/>', "version '9.9'", ""),
        (f"{HEAD}</materialx>", "no material that can be read", ""),
        (f'{HEAD}<disney_principled name="d" type="surfaceshader"/></materialx>', "no material that can be read", ""),
        (document(ROUGHNESS, CIRCLE), "runs in a circle: n ← m ← n", "m/in1"),
        (document(ROUGHNESS, OWN_CIRCLE), "nested too deeply", "ND_r/out"),
        (document(ROUGHNESS), "there is no node 'n'", "S/specular_roughness"),
        (document(ROUGHNESS, '<wobble name="n" type="float"/>'), "unknown node 'wobble'", "n"),
        (
            document(ROUGHNESS, '<add name="n" type="float"><input name="in1" type="color3" value="1, 1, 1"/></add>'),
            "the types do not match: 'in1' is float, not color3",
            "n/in1",
        ),
        (document(ROUGHNESS, '<constant name="n" type="color3"/>'), "types do not match: float is expected", "S/spec"),
        (document(graph_input('nodegraph="missing"')), "there is no graph 'missing'", "S/specular_roughness"),
        (document(graph_input('nodegraph="G" output="p"'), GRAPH), "has no output 'p'", "S/specular_roughness"),
        (document(graph_input('value="1, 1, 1"', "color3")), "is float, not color3", "S/specular_roughness"),
        (document(graph_input('nodegraph="G"'), UNBOUND), "no interface input 'x'", "G/c/value"),
        (document(graph_input('interfacename="x"')), "used outside a graph", "S/specular_roughness"),
        (document(graph_input('value="much"')), "'much' is not a value of the type float", "S/specular_roughness"),
        (document(graph_input('value="inf"')), "'inf' is not a value", "S/specular_roughness"),
        (document('<input name="base_color" type="color3" value="1, 2"/>'), "3 numbers", "S/base_color"),
        (
            document('<input name="base_color" type="color3" value="1, 1, 1" colorspace="foo"/>'),
            "unknown colour space 'foo'",
            "S/base_color",
        ),
        (document(ELL), "unknown unit 'ell'", "S/subsurface_scale"),
        (document(ROUGHNESS, picture("no.png")), "there is no picture 'no.png'", ""),
        (document(ROUGHNESS, picture("../up.png")), "'../up.png' leaves the folder", "n/file"),
        (document(ROUGHNESS, picture("/etc/hostname")), "leaves the folder", "n/file"),
        (f'{HEAD}<xi:include href="../up.mtlx"/></materialx>', "'../up.mtlx' leaves the folder", ""),
        (f'{HEAD}<xi:include href="document.mtlx"/></materialx>', "'document.mtlx' includes itself", ""),
        (f'{HEAD}<xi:include href="gone.mtlx"/></materialx>', "no such file: 'gone.mtlx'", ""),
    ],
)
def test_faulty_documents(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str, path: str
) -> None:
    """The message names the fault and the element's path; the command writes nothing."""
    folder = tmp_path / "in"
    folder.mkdir()
    file = folder / "document.mtlx"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(SssgenError) as caught:
        materialx_reader.read(str(file), Report("document.mtlx"))
    diagnostic = caught.value.diagnostics[0]
    text = f"{diagnostic.message} {diagnostic.hint}"
    assert message in text and path in diagnostic.message
    assert diagnostic.span.file.endswith("document.mtlx")
    assert diagnostic.span.line > 0 or not path, "an element has its line"
    assert main(["import", str(file), "-o", str(tmp_path / "out")]) != 0
    assert not (tmp_path / "out").exists()
    assert "Traceback" not in capsys.readouterr().err


def test_includes_that_run_in_a_circle(tmp_path: Path) -> None:
    for name, other in (("a", "b"), ("b", "a")):
        (tmp_path / f"{name}.mtlx").write_text(f'{HEAD}<xi:include href="{other}.mtlx"/></materialx>', encoding="utf-8")
    with pytest.raises(SssgenError, match=r"'a\.mtlx' includes itself"):
        materialx_reader.read(str(tmp_path / "a.mtlx"), Report("a"))


def test_a_folder_above_must_be_named(tmp_path: Path) -> None:
    """With `top`, names may go up as far as that folder."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.mtlx").write_text(f'{HEAD}<xi:include href="../b.mtlx"/></materialx>', encoding="utf-8")
    (tmp_path / "b.mtlx").write_text(document(""), encoding="utf-8")
    path = str(tmp_path / "in" / "a.mtlx")
    with pytest.raises(SssgenError, match="--root"):
        materialx_reader.read(path, Report("a"))
    assert materialx_reader.read(path, Report("a"), top=str(tmp_path))[0].model.name == "M"


def test_a_picture_that_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file that is no picture is refused before anything is written."""
    (tmp_path / "a.mtlx").write_text(document(ROUGHNESS, picture("p.png")), encoding="utf-8")
    (tmp_path / "p.png").write_bytes(b"no picture")
    assert main(["import", str(tmp_path / "a.mtlx"), "-o", str(tmp_path / "out")]) != 0
    assert not (tmp_path / "out").exists()
    assert "p.png" in capsys.readouterr().err


def test_a_name_that_no_material_has(tmp_path: Path) -> None:
    (tmp_path / "a.mtlx").write_text(document(""), encoding="utf-8")
    with pytest.raises(SssgenError, match="materials: M"):
        materialx_reader.read(str(tmp_path / "a.mtlx"), Report("a"), "Z")
