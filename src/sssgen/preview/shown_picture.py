"""The picture that a pane of the page shows: the last good one, and the errors of the files as they are now."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sssgen.harness.scenes.geometry import Mesh
from sssgen.harness.scenes.preview_scene import scene_of
from sssgen.material.material_loading import load_material
from sssgen.preview.bodies import OWN_MESH
from sssgen.preview.chosen_textures import ChosenTextures, saved
from sssgen.preview.picture import Chosen, picture_of
from sssgen.preview.saved_values import save_to_material, save_to_scene
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.support.file_memo import FileState, noted_files


class ShownPicture:
    """The picture of a material or scene; `renew` makes it again from the files."""

    def __init__(self, name: str, mesh: Mesh | None = None, chosen: Chosen | None = None) -> None:
        """Raises SssgenError for a name that stands for nothing."""
        self.name, self.version, self.error = name, 0, ""
        self.chosen = chosen or (Chosen() if mesh is None else Chosen(OWN_MESH, mesh))
        self.files: dict[str, FileState] = {}
        self._textures = ChosenTextures()
        self._make()

    @property
    def pieces(self) -> Mapping[str, bytes]:
        return self.picture.pieces

    def _make(self) -> None:
        """The picture of the files; after an error, `files` has those that were read or searched for, too."""
        with noted_files() as read:
            try:
                scene = scene_of(self.name)
                picture = picture_of(scene, load_material(scene.material), self.chosen)
                self.scene, self.picture = scene, picture
            except Exception:
                self.files = {**self.files, **read}
                raise
        self.files = {**read}
        self.version += 1

    def renew(self) -> None:
        """Makes the picture again. Where the files have errors, the last good one stays, beside the errors."""
        try:
            self._make()
            self.error = ""
        except SssgenError as error:
            self.error = str(error)
        except OSError as error:  # a file that vanishes while it is read
            self.error = f"error: {error.strerror}: {error.filename}"

    def choose(self, chosen: Chosen) -> None:
        """Shows what a person chose. Raises SssgenError where that cannot be shown; then the picture stays."""
        before, self.chosen = self.chosen, chosen
        try:
            self._make()
        except SssgenError:
            if not self.error:  # the files are right: the choice is not
                self.chosen = before
                raise

    def message(self) -> dict[str, Any]:
        """What a page gets: the picture, and the errors or ''."""
        return {"kind": "picture", "version": self.version, "error": self.error, "picture": self.picture.head}

    def choose_texture(self, slot: str, name: str, data: bytes) -> None:
        """Shows a picture in the slot of that property, or for no bytes the file's own. Raises SssgenError."""
        row = self._row(slot)
        chosen = {one: file for one, file in self.chosen.textures.items() if one != slot}
        if data:
            chosen[slot] = self._textures.added(row, name, data)
        self.choose(self.chosen._replace(textures=chosen))

    def save_textures(self) -> str:
        """Writes the chosen pictures beside the file that names the texture; says what it did. Raises SssgenError."""
        said = []
        for slot, file in self.chosen.textures.items():
            said.append(saved(self._row(slot), file, self.scene, self.picture.material))
        self.chosen = self.chosen._replace(textures={})
        return " ".join(said)

    def _row(self, slot: str) -> dict[str, Any]:
        """The texture of that property. Raises SssgenError."""
        for row in self.picture.head["textures"]:
            if row["property"] == slot:
                found: dict[str, Any] = row
                return found
        raise failure(f"{self.picture.material.name} has no texture '{slot}'")

    def save(self, values: Mapping[str, Sequence[float]]) -> None:
        """Writes parameters, by the names of their properties, to the scene where it sets them, else to the material.

        Raises SssgenError for a property that the material does not have.
        """
        controls = {control["property"]: control for control in self.picture.head["controls"]}
        for name, numbers in values.items():
            if name not in controls or len(numbers) != len(controls[name]["default"]):
                raise failure(f"{self.picture.material.name} has no parameter '{name}' of {len(numbers)} numbers")
        in_scene = {name for name in values if controls[name]["in_scene"]}
        if in_scene:
            own = {str(controls[name]["label"]): values[name] for name in in_scene}
            save_to_scene(self.scene.document.reporter.file, own)
        if others := {name: values[name] for name in values if name not in in_scene}:
            changes = {(controls[name]["technique"], controls[name]["name"]): value for name, value in others.items()}
            save_to_material(self.picture.material, changes)
