"""Faulty glTF files: each is refused with the element's path, and nothing is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gltf_files import box, data_uri, glb_header, png, write_gltf
from sssgen.interchange.gltf_container import LARGEST_FILE
from sssgen.interchange.gltf_reader import read
from sssgen.interchange.mapping_report import Report
from sssgen.material.model import wrong_name
from sssgen.scene.scene_loading import load
from sssgen.support.diagnostics import SssgenError

Edit = Callable[[dict[str, Any]], Any]


def volume(**values: Any) -> dict[str, Any]:
    """A material that transmits light, with an edited volume."""
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_volume": values}
    return {"name": "glass", "extensions": extensions}


def textured(uri: str) -> Edit:
    """Gives the material a picture."""

    def edit(content: dict[str, Any]) -> None:
        content["materials"][0]["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
        content["textures"], content["images"] = [{"source": 0}], [{"uri": uri}]

    return edit


def at(*path: str | int, value: Any) -> Edit:
    """Sets an element."""

    def edit(content: Any) -> None:
        for key in path[:-1]:
            content = content[key]
        content[path[-1]] = value

    return edit


FAULTS: dict[str, tuple[Edit, str, str]] = {
    "a missing buffer": (at("buffers", 0, "uri", value="box.bin"), "/buffers/0/uri", "there is no file 'box.bin'"),
    "a missing picture": (textured("wood.png"), "/images/0/uri", "there is no file 'wood.png'"),
    "a path that climbs": (textured("../wood.png"), "/images/0/uri", "leaves the folder"),
    "an encoded path that climbs": (textured("%2e%2e/wood.png"), "/images/0/uri", "leaves the folder"),
    "an absolute path": (textured("/etc/passwd"), "/images/0/uri", "absolute path"),
    "a name that is not printable": (textured("wood\u0007.png"), "/images/0/uri", "not the name of a file"),
    "a drive": (textured("C:\\wood.png"), "/images/0/uri", "is not a file beside this one"),
    "a URL": (textured("https://example.org/wood.png"), "/images/0/uri", "is not a file beside this one"),
    "a host": (textured("//example.org/wood.png"), "/images/0/uri", "is not a file beside this one"),
    "a faulty data URI": (textured("data:image/png;base64,@@@"), "/images/0/uri", "base64"),
    "a data URI as text": (textured("data:text/plain,hello"), "/images/0/uri", "not base64"),
    "an unknown requirement": (
        at("extensionsRequired", value=["KHR_draco_mesh_compression"]),
        "/extensionsRequired/0",
        "requires 'KHR_draco_mesh_compression', which is not read",
    ),
    "nodes in a circle": (
        at("nodes", value=[{"mesh": 0, "children": [1]}, {"children": [0]}]),
        "/nodes/0",
        "its own ancestor",
    ),
    "two parents": (
        at("nodes", value=[{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]),
        "/nodes/2",
        "two parents",
    ),
    "a missing node": (at("scenes", 0, "nodes", value=[7]), "/scenes/0/nodes/0", "there is no node 7"),
    "a missing mesh": (at("nodes", 0, "mesh", value=3), "/nodes/0/mesh", "there is no mesh 3"),
    "NaN": (at("materials", 0, value=volume(attenuationDistance=float("nan"))), "/attenuationDistance", "finite"),
    "infinity": (at("materials", 0, value=volume(thicknessFactor=float("inf"))), "/thicknessFactor", "finite"),
    "a negative thickness": (
        at("materials", 0, value=volume(thicknessFactor=-1.0)),
        "/thicknessFactor",
        "out of range",
    ),
    "a distance of 0": (at("materials", 0, value=volume(attenuationDistance=0.0)), "/attenuationDistance", "above 0"),
    "a colour of two": (at("materials", 0, value=volume(attenuationColor=[1, 1])), "/attenuationColor", "3 numbers"),
    "a text as factor": (
        at("materials", 0, value={"pbrMetallicRoughness": {"metallicFactor": "1"}}),
        "/materials/0/pbrMetallicRoughness/metallicFactor",
        "a number is needed",
    ),
    "an object as array": (at("materials", value={}), "/materials", "an array is needed"),
    "an accessor beyond its view": (at("accessors", 0, "count", value=25), "/accessors/0", "it needs 300 bytes"),
    "a view beyond its buffer": (
        at("bufferViews", 2, "byteLength", value=9999),
        "/bufferViews/2",
        "its buffer /buffers/0",
    ),
    "a buffer that is cut": (at("buffers", 0, "byteLength", value=10**9), "/buffers/0", "bytes"),
    "an index beyond the vertices": (at("accessors", 0, "count", value=3), "/accessors/2", "beyond the 3 vertices"),
    "an accessor of the wrong type": (at("accessors", 0, "type", value="VEC2"), "/accessors/0", "not 3"),
    "an unknown component type": (at("accessors", 0, "componentType", value=1), "/accessors/0", "component type 1"),
    "a huge accessor": (at("accessors", 0, "count", value=10**9), "/accessors/0", "numbers"),
    "a missing texture": (
        at("materials", 0, value={"normalTexture": {"index": 2}}),
        "/materials/0/normalTexture/index",
        "there is no texture 2",
    ),
    "a requirement that is no text": (
        at("extensionsRequired", value=[["KHR_materials_ior"]]),
        "/extensionsRequired/0",
        "a string is needed",
    ),
    "a newer glTF": (at("asset", value={"version": "2.1", "minVersion": "2.1"}), "/asset/minVersion", "2.0 is read"),
    "glTF 1": (at("asset", "version", value="1.0"), "/asset", "not glTF 2"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_names_its_element(fault: str, tmp_path: Path) -> None:
    edit, path, message = FAULTS[fault]
    content, data = box()
    edit(content)
    with pytest.raises(SssgenError) as caught:
        read(str(write_gltf(tmp_path / "box.gltf", content, data)), Report("box"))
    (diagnostic,) = caught.value.diagnostics
    assert path in diagnostic.message.split(": ")[0]
    assert message in diagnostic.message + diagnostic.hint


def test_a_link_that_leaves_the_folder(tmp_path: Path) -> None:
    (tmp_path / "secret.png").write_bytes(png((1, 2, 3)))
    (tmp_path / "asset").mkdir()
    (tmp_path / "asset" / "wood.png").symlink_to(tmp_path / "secret.png")
    content, data = box()
    textured("wood.png")(content)
    with pytest.raises(SssgenError, match="leaves the folder"):
        read(str(write_gltf(tmp_path / "asset" / "box.gltf", content, data)), Report("box"))


BROKEN = {
    "half a JSON": (b'{"asset": {"version": "2.0"', "not JSON"),
    "a list": (b"[]", "an object"),
    "no asset": (b"{}", "'asset' is missing"),
    "half of a character": (b'{"asset": {"version": "2.0"}, "materials": [{"name": "\\ud800"}]}', "lone surrogate"),
    "no text": (b"\xff\xfe\x00", "not UTF-8"),
    "nested too deeply": (b"[" * 100_000, "nested too deeply"),
    "thousands of digits": (b'{"asset": ' + b"1" * 5000 + b"}", "thousands of digits"),
    "a cut header": (glb_header(100)[:10], "truncated"),
    "a cut file": (glb_header(5000) + bytes(40), "truncated: it has 52 of 5000 bytes"),
    "a chunk beyond the end": (glb_header(40) + b"\xff\0\0\0JSON" + bytes(20), "longer than the file"),
    "no chunk of JSON": (glb_header(28) + b"\x08\0\0\0BIN\0" + bytes(8), "no JSON chunk"),
    "nothing": (b"", "the file is empty"),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_broken_file(fault: str, tmp_path: Path) -> None:
    content, message = BROKEN[fault]
    path = tmp_path / ("asset.glb" if content[:4] == b"glTF" else "asset.gltf")
    path.write_bytes(content)
    with pytest.raises(SssgenError, match=message):
        read(str(path), Report("asset"))


def test_a_large_file_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "large.glb"
    with path.open("wb") as file:
        file.write(glb_header(2**31))
        file.truncate(2**31)
    with pytest.raises(SssgenError, match=f"too large: {2**31} bytes; at most {LARGEST_FILE} are read"):
        read(str(path), Report("large"))
    path.write_bytes(glb_header(2**31) + bytes(100))  # the header alone says so
    with pytest.raises(SssgenError, match="too large"):
        read(str(path), Report("large"))


def test_a_buffer_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "box.bin").open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    content, data = box()
    content["buffers"][0]["uri"] = "box.bin"
    path = write_gltf(tmp_path / "box.gltf", content, data)
    with pytest.raises(SssgenError) as caught:
        read(str(path), Report("box"))
    assert caught.value.diagnostics[0].message.startswith("/buffers/0/uri: 'box.bin' is too large")


def test_a_picture_that_is_none(tmp_path: Path) -> None:
    from sssgen.interchange.material_writer import write_import

    content, data = box()
    textured(data_uri(b"not a picture"))(content)
    report = Report("box")
    materials = read(str(write_gltf(tmp_path / "box.gltf", content, data)), report)
    with pytest.raises(SssgenError, match="the format of this picture is unknown") as caught:
        write_import(str(tmp_path / "out"), materials, report)
    assert "/images/0" in caught.value.diagnostics[0].span.file
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "name", ["../../escape", "/etc", "CON", "a/b\\c", "", "..", "x" * 300, "1st", "名前", "\0\x07\n"]
)
def test_the_names_of_materials_stay_in_the_folder(name: str, tmp_path: Path) -> None:
    from sssgen.interchange.material_writer import write_import

    content, data = box({"name": name})
    report = Report("box")
    materials = read(str(write_gltf(tmp_path / "box.gltf", content, data)), report)
    (written,) = write_import(str(tmp_path / "out"), materials, report)
    assert wrong_name(written.name) is None
    assert load(str(tmp_path / "out" / written.scene)).material
    assert {path.name for path in tmp_path.iterdir()} == {"box.gltf", "out"}
