"""The picture that a pane of the page shows: the last good one, and the errors of the files as they are now."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.preview.bodies import OWN_MESH
from sssgen.preview.chain_edits import edited_files, stage_rows
from sssgen.preview.chosen_textures import ChosenTextures, save_texture
from sssgen.preview.emitted_head import Control, Slot, follows
from sssgen.preview.file_history import FileHistory
from sssgen.preview.flat_head import is_plain, transpile_plain
from sssgen.preview.flat_picture import plain_picture, raymarched_picture
from sssgen.preview.picture import Choices, Picture, on_shape, picture_of
from sssgen.preview.saved_copy import Copy, copy_of
from sssgen.preview.saved_values import (
    Change,
    is_saved_in_scene,
    save_lights,
    save_to_material,
    save_to_scene,
    saves_where,
    write_text,
)
from sssgen.preview.technique_scene import SAVES, is_technique, scene_of_technique
from sssgen.scene.bake_advice import is_scene
from sssgen.scene.geometry import Mesh
from sssgen.scene.preview_scene import scene_of
from sssgen.scene.scene import Light, Scene
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_memo import FileState, noted_files
from sssgen.support.installed_files import is_installed, refusal
from sssgen.support.paths import posix, shell_word
from sssgen.support.unsaved import kept

Values = Mapping[str, Sequence[float]]
"""A parameter's property on the page → its numbers."""


class Pane:
    """The picture of a material or scene; `renew` makes it again from the files."""

    def __init__(self, name: str, mesh: Mesh | None = None, choices: Choices | None = None) -> None:
        """Raises SssgenError for a name that stands for nothing."""
        self.name, self.version, self.error = name, 0, ""
        self.choices = choices or (Choices() if mesh is None else Choices(OWN_MESH, mesh))
        self.files: dict[str, FileState] = {}
        self._textures = ChosenTextures()
        self._make()
        self.first = self.scene, self.picture
        self.history = FileHistory()

    @property
    def pieces(self) -> Mapping[str, bytes]:
        return self.picture.pieces

    def _make(self) -> None:
        """The picture of the files; after an error, `files` has those that were read or searched for, too."""
        with noted_files() as read:
            try:
                self.scene, self.picture = self._new_picture()
            except Exception:
                self.files = {**self.files, **read}
                raise
        self.files = {**read}
        self.version += 1

    def _new_picture(self) -> tuple[Scene | None, Picture]:
        return _picture(self.name, self.choices)

    def renew(self) -> None:
        """Makes the picture again. Where the files have errors, the last good one stays, beside the errors."""
        try:
            self._make()
            self.error = ""
        except SssgenError as error:
            self.error = str(error)
        except OSError as error:  # a file that vanishes while it is read
            self.error = f"error: {error.strerror}: {error.filename}"

    def choose(self, choices: Choices) -> None:
        """Shows what a person chose. Raises SssgenError where that cannot be shown; then the picture stays."""
        before, self.choices = self.choices, choices
        try:
            self._make()
        except SssgenError:
            if not self.error:  # the files are right: the choice is not
                self.choices = before
                raise

    @property
    def label(self) -> str:
        """What tells this picture from one beside it."""
        title: str = self.picture.head["title"]
        return f"{title}, without guards" if self.choices.guards == "none" else title

    def message(self) -> dict[str, Any]:
        """What a page gets: the picture, and the errors or ''. A picture whose textures are missing is not drawn."""
        return {
            "kind": "picture",
            "version": self.version,
            "error": self.error or self.picture.head.get("missing", ""),
            "label": self.label,
            "undoes": self.history.last(),
            "stages": self._stages(),
            "picture": self.picture.head,
        }

    def _stages(self) -> list[dict[str, Any]]:
        """The chain, where the menus of the page change it."""
        material = self.picture.material
        if material is None or self.error or not self.picture.head.get("copies"):
            return []
        try:
            return stage_rows(material)
        except SssgenError:  # it is written in a way that the menus cannot change
            return []

    def emit(self, target: str, form: str) -> Compiled:
        """The text of a target. Raises SssgenError where the target cannot carry the material."""
        if self.picture.material is None:
            return transpile_plain(self.name, target, self.choices.guards)[0]
        return compile(self.picture.material, target, form, guards=self.choices.guards)

    def choose_texture(self, slot: str, name: str, data: bytes) -> None:
        """Shows a picture in the slot of that property, or for no bytes the file's own. Raises SssgenError."""
        row = self._row(slot)
        textures = {one: file for one, file in self.choices.textures.items() if one != slot}
        if data:
            textures[slot] = self._textures.add(row, name, data)
        self.choose(self.choices._replace(textures=textures))

    def save_textures(self) -> str:
        """Writes the chosen pictures beside the file that names the texture; says what it did. Raises SssgenError."""
        if not self.choices.textures:
            return ""
        scene, material = self._save_files()
        reports = [save_texture(self._row(slot), file, scene, material) for slot, file in self.choices.textures.items()]
        self.choices = self.choices._replace(textures={})
        return " ".join(reports)

    def _row(self, slot: str) -> Slot:
        """The texture of that property. Raises SssgenError."""
        rows: list[Slot] = self.picture.head["textures"]
        for row in rows:
            if row["property"] == slot:
                return row
        raise failure(f"{self.picture.head['name']} has no texture '{slot}'")

    def _save_files(self) -> tuple[Scene, Material]:
        """The scene and the material whose files hold the values. Raises SssgenError where there are none."""
        if self.scene is None or self.picture.material is None or self.picture.head["saves"]:
            raise failure("nothing can be saved here", self.picture.head["saves"])
        return self.scene, self.picture.material

    def edit(self, change: Mapping[str, Any]) -> None:
        """Changes the chain in the material's file, see `edited_files`. Raises SssgenError, and changes no file, where
        the picture of the changed files has an error."""
        scene, material = self.scene, self.picture.material
        if scene is None or material is None or not self.picture.head.get("copies"):
            raise failure("this has no chain that can be changed", self.picture.head["saves"])
        files = edited_files(on_shape(scene, self.choices), material, change)
        with kept(files):
            self._new_picture()
        with self.history.recorded(files):
            for path, text in files.items():
                write_text(path, text)

    def written_files(self) -> list[str]:
        """The files that Save may write."""
        scene, material = self.scene, self.picture.material
        return [] if scene is None or material is None else [material.file, scene.document.reporter.file]

    def copy(self, name: str) -> Copy:
        """The files of the material under another name. Raises SssgenError where it cannot be copied."""
        scene, material = self.scene, self.picture.material
        if scene is None or material is None or not self.picture.head.get("copies"):
            raise failure("this cannot be saved under another name", self.picture.head["saves"])
        return copy_of(scene, material, self.files, name)

    def follow(self, path: str) -> None:
        """Shows another file from now on, with what was chosen. Raises SssgenError."""
        self.name, self.history = path, FileHistory()
        self._make()
        self.error = ""

    def save(self, values: Values, look: Values = MappingProxyType({})) -> str:
        """Writes parameters, by the names of their properties, to the scene or to the material (see `saved_values`).

        `look` has, for some of them, the numbers of the medium's look that they follow from: the material gets these,
        once for all that follow.
        Returns what was written and where, for a person. Raises SssgenError for a property that the material does not
        have.
        """
        rows: list[Control] = self.picture.head["controls"]
        controls = {control["property"]: control for control in rows}
        scene, material = self._save_files()
        for name, numbers in values.items():
            if name not in controls or len(numbers) != len(controls[name]["default"]):
                raise failure(f"{material.name} has no parameter '{name}' of {len(numbers)} numbers")
        in_scene = [name for name in values if is_saved_in_scene(scene, material, controls[name]["label"])]
        written = []
        if in_scene:
            own = {controls[name]["label"]: values[name] for name in in_scene}
            save_to_scene(scene.document.reporter.file, own)
            written.append(f"{', '.join(own)} in {posix(scene.document.reporter.file)}")
        # the level of detail is of no technique: the engine sets it, and the material has no value for it
        others = {
            name: values[name]
            for name in values
            if name not in in_scene and controls[name]["technique"] and not (name in look and follows(controls[name]))
        }
        if others:
            changes = [_change(controls[name], value, look.get(name)) for name, value in others.items()]
            save_to_material(material, changes)
            labels = ", ".join(
                change.look or controls[name]["label"] for name, change in zip(others, changes, strict=True)
            )
            written.append(f"{labels} in {posix(material.file)}")
        return f"Saved: {'; '.join(written)}." if written else ""

    def save_lights(self, lights: Sequence[Light]) -> str:
        """Writes lamps into the scene's file; says where. Raises SssgenError where the scene is not a person's own."""
        scene, material = self._save_files()
        file = scene.document.reporter.file
        if not is_scene(scene, material):
            hint = f"write one beside the material: {posix(os.path.join(os.path.dirname(file), 'scene.toml'))}"
            raise failure("these lamps are the preview's own: the material has no scene", hint)
        if is_installed(file):
            raise refusal(file)
        save_lights(file, lights)
        return f"Saved: {len(lights)} lamps in {posix(file)}."


def _change(control: Control, value: Sequence[float], look: Sequence[float] | None) -> Change:
    if look is None or not control["look"]:
        return Change(control["technique"], control["name"], value, control["default"])
    return Change(control["technique"], control["name"], look, control["default"], control["look"])


class StartPane(Pane):
    """Material and scene as they were when the preview started; textures and meshes are read as they are now."""

    def __init__(self, now: Pane) -> None:
        self._then = now.first
        super().__init__(now.name, choices=now.choices._replace(guards="auto", textures={}))

    @property
    def label(self) -> str:
        return f"{self.picture.head['title']}, at the start"

    def _new_picture(self) -> tuple[Scene | None, Picture]:
        scene, picture = self._then
        head = picture.head
        if "flat" in head or (self.choices.shape, self.choices.textures) == (head["shape"], {}):
            changed = picture
        else:
            assert scene is not None and picture.material is not None  # only plain GLSL has none
            changed = picture_of(scene, picture.material, self.choices)
        return scene, changed._replace(
            head={**changed.head, "saves": "this is the material as it was", "copies": False}
        )


def _picture(name: str, choices: Choices) -> tuple[Scene | None, Picture]:
    """The scene and the picture of what a name stands for. Raises SssgenError."""
    if is_plain(name):
        return None, plain_picture(name, choices)
    if is_technique(name):
        scene, material = scene_of_technique(name)
        picture = picture_of(scene, material, choices)
        return scene, picture._replace(head={**picture.head, "saves": SAVES})
    scene = scene_of(name)
    if scene.bodies:
        listed = ", ".join(shell_word(path) for path in scene.bodies)
        hint = f"open one of its scenes: {listed}; sssgen render draws all of them"
        raise failure(f"the scene has {len(scene.bodies)} bodies, and the preview shows one", hint, posix(name))
    material = load_material(scene.material)
    picture = (raymarched_picture if material.makes_rays else picture_of)(scene, material, choices)
    return scene, picture._replace(head={**picture.head, **saves_where(scene, material)})
