"""Opens glTF files: the JSON, the binary chunk, and files beside it. Nothing outside one folder is read.

pygltflib would replace the 25 lines that split a file into chunks, and none of the checks: it takes truncated files,
adds a missing `asset`, accepts any index, and gives the numbers of an accessor as bytes.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import re
import struct
import urllib.parse
from dataclasses import dataclass, field

from sssgen.interchange.gltf_json import JsonElement
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_memo import note
from sssgen.support.json_source import parse
from sssgen.support.paths import posix
from sssgen.support.text_files import refuse_folder, refuse_special

SUFFIXES = (".glb", ".gltf")
LARGEST_FILE = 1 << 30
"""Bytes of a file that is read."""
LARGEST_JSON = 256 << 20
"""Bytes of the JSON; it may contain pictures and meshes as text."""

_MAGIC, _JSON, _BIN = b"glTF", 0x4E4F534A, 0x004E4942
_SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


@dataclass
class Container:
    """A glTF file that is open."""

    root: JsonElement
    """The whole JSON"""
    folder: str
    binary: bytes | None
    """The binary chunk of a GLB file"""
    top: str
    """The folder that no name of a file may leave"""
    _files: dict[str, bytes] = field(default_factory=dict)

    def resource(self, element: JsonElement) -> bytes:
        """The bytes of an element's `uri`. Raises SssgenError for a URI that is not allowed, missing or faulty."""
        uri = element.text("uri")
        place = element.require("uri")
        if uri.startswith("data:"):
            return _data_uri(uri, place)
        path = self._path(uri, place)
        if path not in self._files:
            self._files[path] = _read(path, place, uri)
        return self._files[path]

    def _path(self, uri: str, place: JsonElement) -> str:
        if _SCHEME.match(uri) or uri.startswith("//"):
            raise place.fault(
                f"'{uri[:80]}' is not a file beside this one", "download it, and name it relative to the file"
            )
        name = urllib.parse.unquote(uri).replace("\\", "/")
        if not name or "\0" in name or not name.isprintable():
            raise place.fault("this is not the name of a file")
        if name.startswith("/") or _SCHEME.match(name):
            raise place.fault(f"'{name[:80]}' is an absolute path", "name the file relative to this one")
        path = os.path.join(self.folder, name)
        top = os.path.realpath(self.top)
        if os.path.commonpath([top, os.path.realpath(path)]) != top:
            hint = "copy it to that folder; or name a folder that has all files with --root, which sssgen import takes"
            raise place.fault(f"'{name[:80]}' leaves the folder of the file", hint)
        return path


def open_file(path: str, top: str = "") -> Container:
    """Opens a .glb or .gltf file; what it names lies in the folder `top`, by default its own.

    Raises SssgenError for a file that is missing, too large, truncated or no glTF.
    """
    file_name = posix(path)
    refuse_folder(path, SUFFIXES)
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in SUFFIXES:
        raise failure(f"'{suffix}' is not the suffix of a glTF file", f"they end in {' or '.join(SUFFIXES)}", file_name)
    note(path)
    try:
        refuse_special(path, file_name)
        size = os.path.getsize(path)
        with open(path, "rb") as file:
            head = file.read(20)
            binary_format = head[:4] == _MAGIC
            _check_size(size, head if binary_format else b"", file_name)
            data = head + file.read()
    except FileNotFoundError:
        raise failure("no such file", file=file_name) from None
    except OSError as error:
        raise failure(f"cannot read the file: {error.strerror}", file=file_name) from None
    except ValueError:  # a zero byte or a lone surrogate in its name
        raise failure("this is not a valid file name", file=file_name) from None
    if not data:
        raise failure("the file is empty", "copy or export it again", file_name)
    if suffix == ".glb" and not binary_format and data.lstrip()[:1] != b"{":
        raise failure("this is not a GLB file: it does not begin with 'glTF'", "copy or export it again", file_name)
    text, binary = _chunks(data, file_name) if binary_format else (data, None)
    root = _document(text, file_name)
    folder = os.path.dirname(path) or "."
    return Container(root, folder, binary, top or folder)


def _check_size(size: int, head: bytes, file_name: str) -> None:
    """Refuses a file by its size, and a GLB file by its header, before it is read."""
    declared = struct.unpack_from("<I", head, 8)[0] if len(head) >= 12 else 0
    largest = LARGEST_FILE if head else LARGEST_JSON
    if max(size, declared) > largest:
        message = f"the file is too large: {max(size, declared)} bytes; at most {largest} are read"
        raise failure(message, "reduce its meshes or pictures, or export its parts", file_name)
    if head and declared > size:
        raise failure(f"the file is truncated: it has {size} of {declared} bytes", "copy or export it again", file_name)


def _chunks(data: bytes, file_name: str) -> tuple[bytes, bytes | None]:
    """The JSON and the binary chunk of a GLB file (glTF 2.0, section 4.4)."""
    if len(data) < 20:
        raise failure(f"the file is truncated: it has {len(data)} bytes", "copy or export it again", file_name)
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise failure(f"this is glTF {version}, not glTF 2", "export it again as glTF 2.0", file_name)
    text, binary, start = None, None, 12
    while start + 8 <= length:
        size, kind = struct.unpack_from("<II", data, start)
        if start + 8 + size > length:
            raise failure(f"the chunk at byte {start} is longer than the file", "copy or export it again", file_name)
        chunk = data[start + 8 : start + 8 + size]
        if kind == _JSON and text is None:
            text = chunk
        elif kind == _BIN and binary is None:
            binary = chunk
        start += 8 + size + (-size % 4)
    if text is None:
        raise failure("the file has no JSON chunk", "copy or export it again", file_name)
    if len(text) > LARGEST_JSON:
        raise failure(f"the JSON is too large: {len(text)} bytes; at most {LARGEST_JSON} are read", "", file_name)
    return text, binary


def _document(text: bytes, file_name: str) -> JsonElement:
    try:
        content = parse(text.decode("utf-8-sig"), file_name)
    except UnicodeDecodeError as error:
        raise failure(f"the JSON is not UTF-8 text: byte {error.start}", "export the file again", file_name) from None
    if not isinstance(content, dict):
        raise failure("the JSON of a glTF file is an object", "", file_name)
    if _SURROGATE.search(text) and not _is_text(content):
        raise failure("the JSON has half of a character: a lone surrogate", "export the file again", file_name)
    root = JsonElement(content, "", file_name)
    asset = root.child("asset")
    if asset is None:
        raise root.fault("'asset' is missing: this is not a glTF file")
    version = asset.text("version", "?")
    if version.split(".")[0] != "2":
        raise asset.fault(f"this is glTF {version}, not glTF 2", "export it again as glTF 2.0")
    if (needed := asset.text("minVersion", "2.0")) != "2.0":
        raise asset.require("minVersion").fault(f"it needs glTF {needed}; 2.0 is read", "export it again as glTF 2.0")
    return root


def _is_text(content: object) -> bool:
    """Whether all texts of a JSON document can be written to a file."""
    try:
        json.dumps(content, ensure_ascii=False).encode()
    except UnicodeEncodeError:
        return False
    return True


def _data_uri(uri: str, place: JsonElement) -> bytes:
    head, comma, body = uri.partition(",")
    if not comma or not head.endswith(";base64"):
        raise place.fault("this data URI is not base64", "it looks like data:application/octet-stream;base64,…")
    try:
        return base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError) as error:
        raise place.fault(f"the base64 of this data URI is faulty: {error}", "export the file again") from None


def _read(path: str, place: JsonElement, uri: str) -> bytes:
    note(path)
    try:
        refuse_special(path, posix(path))
        if os.path.getsize(path) <= LARGEST_FILE:
            with open(path, "rb") as file:
                return file.read()
    except FileNotFoundError:
        raise place.fault(f"there is no file '{uri[:80]}' beside this one", "copy it to the same folder") from None
    except (OSError, ValueError) as error:
        raise place.fault(f"'{uri[:80]}' cannot be read: {getattr(error, 'strerror', error)}") from None
    except SssgenError as error:
        raise place.fault(error.diagnostics[0].message) from None
    raise place.fault(f"'{uri[:80]}' is too large; at most {LARGEST_FILE} bytes are read")
