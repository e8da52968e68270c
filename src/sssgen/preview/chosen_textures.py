"""Pictures from a person's disk in a material's texture slots: until the page closes, or saved beside the material."""

from __future__ import annotations

import io
import os
import re
import shutil
import tempfile
import warnings
import weakref

from sssgen.material.model import Material
from sssgen.preview.emitted_head import Slot
from sssgen.preview.saved_values import Change, is_saved_in_scene, save_to_material, save_to_scene
from sssgen.scene.pictures import images
from sssgen.scene.scene import Picture, Scene
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.extras import need
from sssgen.support.file_writer import write_files
from sssgen.support.paths import posix

SUFFIXES = (".png", ".jpg", ".jpeg", ".exr")
JPEG = (".jpg", ".jpeg")
FOLDER = "textures"
"""The usual folder of pictures beside a material."""


class ChosenTextures:
    """The files of chosen pictures, in a folder that is removed at the end."""

    def __init__(self) -> None:
        self._folder = ""

    def add(self, row: Slot, name: str, data: bytes) -> str:
        """The file with the bytes of a picture for a texture's row of the picture's head.

        A JPEG becomes a PNG, which scenes and engines read. Raises SssgenError for a texture that takes no picture, and
        for a file that is none.
        """
        if row["type"] != "sampler2D" or row["page_draws"]:
            what = "it is drawn for each frame" if row["page_draws"] else f"it is a {row['type']}"
            raise failure(f"'{row['source_name']}' takes no picture: {what}")
        base, suffix = os.path.splitext(os.path.basename(name.replace("\\", "/")))
        suffix = suffix.lower()
        if suffix not in SUFFIXES:
            hint = did_you_mean(suffix, SUFFIXES) or f"textures end in {', '.join(SUFFIXES)}"
            raise failure(f"'{suffix}' is not a texture's suffix", hint, name)
        if suffix in JPEG:
            data, suffix = _png_of_jpeg(data, name), ".png"
        if not self._folder:
            self._folder = tempfile.mkdtemp(prefix="sssgen_preview_")
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        folder = tempfile.mkdtemp(dir=self._folder)  # two pictures may have the same name
        file = re.sub(r"[^\w.-]", "_", base).lstrip(".") or "texture"
        write_files(folder, {f"{file}{suffix}": data})
        path = os.path.join(folder, f"{file}{suffix}")
        try:
            images.read(path)
        except SssgenError as error:  # which names the copy
            raise failure(error.diagnostics[0].message, error.diagnostics[0].hint, name) from None
        return path


def save_texture(row: Slot, file: str, scene: Scene, material: Material) -> str:
    """Copies a chosen picture beside the file that names the texture, and writes its name there; says what it did.

    `saved_values` says which file names it. Raises SssgenError where a file cannot be written.
    """
    name = row["source_name"]
    in_scene = is_saved_in_scene(scene, material, name)
    toml = scene.document.reporter.file if in_scene else material.file
    before = scene.textures.get(name)
    folder = os.path.dirname(os.path.abspath(toml))
    usual = os.path.join(folder, FOLDER)
    target = os.path.dirname(before.file) if isinstance(before, Picture) else usual if os.path.isdir(usual) else folder
    with open(file, "rb") as chosen:
        data = chosen.read()
    path = _unused_path(os.path.join(target, os.path.basename(file)), data)
    write_files(os.path.dirname(path), {os.path.basename(path): data})
    relative = posix(os.path.relpath(path, folder))
    if in_scene:
        save_to_scene(toml, {name: relative}, "textures")
    else:
        save_to_material(material, [Change(row["technique"], row["name"], relative)])
    return f"{relative} is written, and {posix(toml)} names it."


def _unused_path(path: str, data: bytes) -> str:
    """The path, or one with a number where a file with another content has the name."""
    base, suffix = os.path.splitext(path)
    number = 1
    while os.path.exists(path):
        with open(path, "rb") as file:
            if file.read() == data:
                break
        number += 1
        path = f"{base}_{number}{suffix}"
    return path


def _png_of_jpeg(data: bytes, name: str) -> bytes:
    """The PNG of a JPEG, turned upright as its camera says."""
    pillow, operations = need("PIL.Image", "pillow"), need("PIL.ImageOps", "pillow")
    buffer = io.BytesIO()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pillow.DecompressionBombWarning)
            with pillow.open(io.BytesIO(data), formats=["JPEG"]) as image:
                upright = operations.exif_transpose(image)
                upright.convert("L" if upright.mode == "L" else "RGB").save(buffer, "PNG")
    except (pillow.DecompressionBombError, pillow.DecompressionBombWarning, MemoryError):
        raise failure("the picture is too large to read", "make it smaller", name) from None
    except (OSError, SyntaxError, ValueError):
        raise failure("this is not a JPEG picture", "export it again", name) from None
    return buffer.getvalue()
