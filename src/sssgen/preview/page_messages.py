"""What a page and this program say to each other.

A message is a JSON object with a `kind`; one from the page may carry the bytes of a file. The same messages serve a
page that is connected to a server and one that runs this module in the browser.

From the page: `shape` (a body from the list), `beside` (what stands beside the picture), `mesh` (a file as the body),
`texture` (a file, or none, in a slot), `save` (parameters and chosen textures, for the files), `save_as` (the same,
for a new folder), `lights` (the lamps, for the scene's file), `edit` (a change of the chain) and `undo` (of what was
written last); the questions `existing` (the files that `save_as` would replace), `menus` (presets and media),
`techniques` (for a place in the chain), `medium` (the parameters of a medium by name) and `measured` (the error in a
chart); and, while the page shows emitted text, `text` (of a target and a form) and `source` (a file that lines come
from). To the page: `picture` (of the pane `pane`), `said` and `error` (a text), and the answer to a question, which
has its kind.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from sssgen.presets.preset_list import MENU_QUALITIES, media_list, preset_list
from sssgen.preview.bodies import OWN_MESH, SHAPES, dropped_mesh
from sssgen.preview.chain_edits import technique_rows
from sssgen.preview.emitted_text import source_of, text_of
from sssgen.preview.page_frames import MOST_BYTES
from sssgen.preview.pane import Pane, StartPane
from sssgen.preview.saved_copy import Copy, existing_files, write_copy
from sssgen.scene.measured import media
from sssgen.scene.scene import Light
from sssgen.scene.scene_keys import MAX_LIGHTS
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import FileState
from sssgen.support.paths import posix

BESIDE = {"": "nothing", "guards": "without guards", "start": "as at the start"}
"""What may stand beside a picture, and its name on the page."""
OTHER = "other"
"""The second of two names on the command line."""


class PageMessages:
    """The panes of the pages, and what the pages may ask."""

    def __init__(self, pane: Pane, other: Pane | None = None) -> None:
        self.panes = [pane] if other is None else [pane, other]
        self._other, self._beside = other, "" if other is None else OTHER
        self._answers: Mapping[str, Callable[[dict[str, Any], bytes], str]] = {
            "shape": self._shape,
            "beside": self._place_beside,
            "mesh": self._mesh,
            "texture": self._texture,
            "save": self._save,
            "save_as": self._save_as,
            "edit": self._edit,
            "undo": self._undo,
            "lights": self._save_lights,
        }
        self._questions: Mapping[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
            "text": self._text,
            "source": self._source,
            "measured": self._measured_error,
            "existing": self._existing,
            "menus": self._menus,
            "techniques": self._techniques,
            "medium": self._medium,
        }
        self._top = os.getcwd()
        """Below it the pages may write new folders"""

    @property
    def files(self) -> dict[str, FileState]:
        """The files that the pictures depend on."""
        return {path: state for pane in self.panes for path, state in pane.files.items()}

    def piece(self, digest: str) -> bytes | None:
        """The triangles or texels with a digest; None where no picture that is shown has them."""
        return next((pane.pieces[digest] for pane in self.panes if digest in pane.pieces), None)

    def messages(self) -> list[dict[str, Any]]:
        """What a page gets at its start and after each change: a picture for each pane."""
        other = {} if self._other is None else {OTHER: self._other.label}
        common = {
            "panes": len(self.panes),
            "beside": self._beside,
            "besides": {**BESIDE, **other},
            "limit": MOST_BYTES,
        }
        return [{**pane.message(), "pane": number, **common} for number, pane in enumerate(self.panes)]

    def answer(self, message: Mapping[str, Any], data: bytes = b"") -> str:
        """Does what a page asks, and says what it wrote; `messages` is then what all pages get.

        Raises SssgenError for what cannot be done, and ValueError, TypeError or KeyError for a faulty message.
        """
        if len(data) > MOST_BYTES:
            raise failure(f"the file has {len(data)} bytes", f"at most {MOST_BYTES} are read", str(message.get("name")))
        return self._answers[str(message["kind"])](dict(message), data)

    def reply(self, message: Mapping[str, Any]) -> dict[str, Any] | None:
        """The answer to a page's question, for this page only; None for a message that is none.

        Raises as `answer` does.
        """
        question = self._questions.get(str(message["kind"]))
        return question(dict(message)) if question else None

    def renew(self) -> None:
        """Makes the pictures again from the files."""
        for pane in self.panes:
            pane.renew()

    def _pane(self, message: Mapping[str, Any]) -> Pane:
        number = int(message.get("pane", 0))
        if number not in range(len(self.panes)):
            raise ValueError(number)
        return self.panes[number]

    def _text(self, message: dict[str, Any]) -> dict[str, Any]:
        pane = self._pane(message)
        return text_of(pane.emit, str(message["target"]), str(message["form"]))

    def _source(self, message: dict[str, Any]) -> dict[str, Any]:
        material = self._pane(message).picture.material
        folder = os.path.dirname(material.file) if material is not None else ""
        return source_of(str(message["name"]), folder, self.files)

    def _measured_error(self, message: dict[str, Any]) -> dict[str, Any]:
        from sssgen.preview.measured_error import MeasuredError, measured_error

        pane = self._pane(message)
        scene, material = pane.scene, pane.picture.material
        answer = measured_error(scene, material) if scene and material else MeasuredError("", "")
        return {"kind": "measured", **answer._asdict()}

    def _shape(self, message: dict[str, Any], _: bytes) -> str:
        shape = message["shape"]
        if shape not in ("", *SHAPES, OWN_MESH):
            raise ValueError(shape)
        for pane in self.panes:
            if shape != OWN_MESH or pane.choices.mesh is not None:
                pane.choose(pane.choices._replace(shape=shape))
        return ""

    def _place_beside(self, message: dict[str, Any], _: bytes) -> str:
        what, first = message["beside"], self.panes[0]
        if what == OTHER and self._other is not None:
            beside = [self._other]
        elif what == "guards":
            beside = [Pane(first.name, choices=first.choices._replace(guards="none"))]
        else:
            beside = [] if BESIDE[what] == BESIDE[""] else [StartPane(first)]
        self.panes[1:], self._beside = beside, what
        return ""

    def _mesh(self, message: dict[str, Any], data: bytes) -> str:
        mesh = dropped_mesh(str(message["name"]), data)
        for pane in self.panes:
            pane.choose(pane.choices._replace(shape=OWN_MESH, mesh=mesh))
        return ""

    def _texture(self, message: dict[str, Any], data: bytes) -> str:
        self._pane(message).choose_texture(str(message["slot"]), str(message["name"]), data)
        return ""

    def _save(self, message: dict[str, Any], _: bytes) -> str:
        pane = self._pane(message)
        try:
            with pane.history.recorded(pane.written_files()):
                written = pane.save(_numbers(message["values"]), _numbers(message.get("look", {})))
                return " ".join(filter(None, (written, pane.save_textures())))
        finally:
            self.renew()

    def _edit(self, message: dict[str, Any], _: bytes) -> str:
        pane = self._pane(message)
        pane.edit(message)
        self.renew()
        return f"{pane.history.last()} is changed."

    def _undo(self, message: dict[str, Any], _: bytes) -> str:
        said = self._pane(message).history.undo()
        self.renew()
        return said

    def _menus(self, message: dict[str, Any]) -> dict[str, Any]:
        return {"kind": "menus", "presets": preset_list(), "media": media_list(), "qualities": MENU_QUALITIES}

    def _techniques(self, message: dict[str, Any]) -> dict[str, Any]:
        material, path = self._pane(message).picture.material, tuple(message.get("path", ()))
        rows = technique_rows(material, path) if material is not None else []
        return {"kind": "techniques", "path": list(path), "rows": [row._asdict() for row in rows]}

    def _medium(self, message: dict[str, Any]) -> dict[str, Any]:
        medium = media.preset(str(message["name"]), float(message["unit_mm"]))
        return {"kind": "medium", "name": medium.name, "parameters": medium.parameters}

    def _existing(self, message: dict[str, Any]) -> dict[str, Any]:
        folder, copy = self._copy(message)
        return {"kind": "existing", "name": folder, "files": existing_files(self._top, folder, copy)}

    def _save_as(self, message: dict[str, Any], data: bytes) -> str:
        folder, copy = self._copy(message)
        path = write_copy(self._top, folder, copy, message.get("replace") is True)
        self._pane(message).follow(os.path.relpath(path))
        return " ".join(filter(None, (f"{posix(os.path.relpath(path))} is written.", self._save(message, data))))

    def _copy(self, message: dict[str, Any]) -> tuple[str, Copy]:
        """The folder of a copy, relative to the top, and its files."""
        folder = str(message["name"]).replace("\\", "/")
        return folder, self._pane(message).copy(folder.rpartition("/")[2])

    def _save_lights(self, message: dict[str, Any], _: bytes) -> str:
        lights = [_light(row["position"], row["color"]) for row in message["lights"]]
        if len(lights) > MAX_LIGHTS:
            raise ValueError(len(lights))
        try:
            return self._pane(message).save_lights(lights)
        finally:
            self.renew()


def _numbers(values: Mapping[str, Sequence[Any]]) -> dict[str, list[float]]:
    """Values as the page sends them. Raises ValueError, TypeError or AttributeError for others."""
    return {str(name): [float(number) for number in value] for name, value in values.items()}


def _light(place: Sequence[Any], color: Sequence[Any]) -> Light:
    """The light of a message: a position that ends with 1, or a direction that ends with 0. Raises ValueError."""
    x, y, z, w = (float(number) for number in place)
    red, green, blue = (float(number) for number in color)
    if not all(math.isfinite(number) for number in (x, y, z, red, green, blue)) or (w == 0.0 and x == y == z == 0.0):
        raise ValueError(place)
    return Light((x, y, z) if w else None, None if w else (x, y, z), (red, green, blue))
