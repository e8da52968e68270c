"""Reads a scene from its TOML document; every error has its position."""

from __future__ import annotations

import contextlib
import math
import os
from typing import Any

from sssgen.material.library import OF_SHELLS
from sssgen.material.material_loading import examples, is_example, load_material, preset_hint
from sssgen.material.requirements import baked_functions
from sssgen.material.roles import SECTIONS
from sssgen.material.shell_stages import choices
from sssgen.scene import mesh_files
from sssgen.scene.bake_advice import advice
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Box, Capsule, Distance, Geometry, Mesh, Slab, Torus, Union
from sssgen.scene.pictures import images
from sssgen.scene.scene import DistanceTexture, Light, Picture, Scene
from sssgen.scene.scene_keys import (
    CAMERA,
    DISTANCE_TEXTURE,
    KEYS,
    LIGHT,
    MAX_BODIES,
    MAX_LIGHTS,
    MAX_PARTS,
    MEASURED,
    PICTURE,
    PLACE,
    SHAPES,
    SHELL,
)  # fmt: skip
from sssgen.scene.toml_table import ANY, Table, text
from sssgen.support.diagnostics import SssgenError, did_you_mean
from sssgen.support.file_memo import note
from sssgen.support.paths import posix
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import Document, Path, parse

_ONLY_IN_MATERIALS = set(SECTIONS) - set(KEYS)

ENVIRONMENT_SHOWN = "environment"
"""The background that is the scene's [environment]."""
_GREY = (0.5, 0.5, 0.5)
"""In its place where two colours are shown."""
MAX_COUNT = 2**24
"""The largest number of samples of a picture: each takes a few hundred bytes."""


def read_scene(document: Document, folder: str, draws: bool = True) -> Scene:
    """The scene of a document; files are relative to `folder`.

    Raises SssgenError with all errors; a missing picture is one unless nothing `draws` the scene.
    """
    if isinstance(document.data.get("material"), dict):
        hint = 'name a scene: a file with material = "…" and, for its body, [geometry]'
        document.error(document.place("material").key, "this is a material, and no scene", hint)
        document.reporter.check()
    reader = _Reader(document, folder)
    scene = reader.scene()
    if draws:
        reader.check_pictures(scene)
    document.reporter.check()
    return scene


def material_beside(name: str, folder: str) -> str:
    """The path of the material NAME.toml in a scene's folder, which comes before the example of that name.

    Without such a file it is "", and so it is in the example's own folder: there the name means the same file.
    """
    path = os.path.join(folder, f"{name}.toml")
    note(path)
    if not os.path.isfile(path) or is_example(path, name):
        return ""
    try:
        return path if is_material(path) else ""
    except SssgenError:
        return path  # whoever loads it reports its errors


def is_material(path: str) -> bool:
    """Whether a TOML file describes a material, and no scene. Raises SssgenError for a text that is no TOML."""
    data = parse(read_text(path, posix(path)), posix(path)).data
    return isinstance(data.get("material"), dict) or not _ONLY_IN_MATERIALS.isdisjoint(data)


class _Reader:
    def __init__(self, document: Document, folder: str) -> None:
        self.document, self.folder = document, folder
        self.pictures: dict[str, tuple[Path, str]] = {}
        """Texture → where the scene names its file, and that name"""

    def scene(self) -> Scene:
        top = Table(self.document, (), self.document.data, KEYS)
        size = top.wholes("size", (640, 480))
        samples = top.whole("samples", 2)
        if size[0] * size[1] * samples**2 > MAX_COUNT:
            count = f"{size[0]} × {size[1]} pixels of {samples} × {samples} samples are too many"
            top.error("size", count, f"at most {MAX_COUNT / 1e6:.0f} million samples in total")
        geometry = self.geometry(top.content.get("geometry"))
        return Scene(
            self.material(top),
            size,
            samples,
            top.number("time", 0.0),
            self.background(top),
            top.vector("ambient", (0.0, 0.0, 0.0)),
            top.number("exposure", 1.0),
            geometry,
            self.camera(top.content.get("camera", {})),
            self.lights(top),
            self.parameters(top.content.get("parameters", {})),
            self.textures(top.content.get("textures", {}), "geometry" in top.content),
            self.document,
            top.text("title", ""),
            self.shell(top.content.get("shell", {})),
            {key: top.content[key] for key in list(MEASURED)[1:] if key in top.content},
            top.content.get("background") == ENVIRONMENT_SHOWN,
            self.bodies(top),
            self.folder,
        )

    def material(self, top: Table) -> str:
        if "material" not in top.content and not {"medium", "inlay", "bodies"}.isdisjoint(top.content):
            return ""
        if "material" not in top.content:
            self.document.error(self.document.place().key, "the scene has no material", 'add: material = "…"')
            return ""
        name = top.text("material", "")
        if name.endswith(".toml"):
            return self.file(("material",), name)
        beside = material_beside(name, self.folder)
        if name not in examples() and isinstance(top.content["material"], str):
            file_hint = f"did you mean '{name}.toml'?" if beside else ""
            hint = did_you_mean(name, examples()) or f"a path that ends in .toml, or: {', '.join(examples())}"
            top.error("material", f"unknown material '{name}'", file_hint or preset_hint(name) or hint)
        return beside or name

    def bodies(self, top: Table) -> tuple[str, ...]:
        content = top.content.get("bodies", [])
        if not isinstance(content, list) or not all(isinstance(name, str) for name in content):
            top.error(
                "bodies", "'bodies' is a list of scenes", 'write bodies = ["glass/scene.toml", "wood/scene.toml"]'
            )
            return ()
        if len(content) > MAX_BODIES:
            top.error("bodies", f"the scene has {len(content)} bodies", f"at most {MAX_BODIES} are supported")
            return ()
        for key in ("material", "geometry", "parameters", "textures"):
            if content and key in top.content:
                hint = f"'{key}' is that of each scene in 'bodies'"
                self.document.error(
                    self.document.place(key).key, "a scene has a body of its own, or those of others", hint
                )
        return tuple([self.file(("bodies", index), name) for index, name in enumerate(content)])

    def background(self, top: Table) -> Any:
        raw = top.content.get("background", [0.0, 0.0, 0.0])
        if raw == ENVIRONMENT_SHOWN:
            if "environment" not in top.content:
                top.error("background", "the scene has no environment to show", "add [environment]")
            return _GREY, _GREY
        if not (isinstance(raw, list) and raw and all(isinstance(part, list) for part in raw)):
            color = top.vector("background", (0.0, 0.0, 0.0))
            return color, color
        if len(raw) != 2:
            top.error("background", "'background' takes one colour, or two", "write [bottom, top], each [r, g, b]")
            return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        ends = []
        for index, part in enumerate(raw):
            inner = _Element(self.document, ("background",), index, part)
            ends.append(inner.vector("background", (0.0, 0.0, 0.0)))
        return tuple(ends)

    def camera(self, content: Any) -> Camera:
        default = Camera()
        table = Table(self.document, ("camera",), content, CAMERA)
        camera = Camera(
            table.vector("position", default.position),
            table.vector("target", default.target),
            table.number("field_of_view", default.field_of_view),
        )
        if math.dist(camera.position, camera.target) < 1e-6:
            table.error("target", "the camera stands at its target", "move one of the two")
        return camera

    def lights(self, top: Table) -> tuple[Light, ...]:
        content = top.content.get("light", [])
        if not isinstance(content, list):
            top.error("light", "lights are a list of tables", "write [[light]] for each")
            return ()
        if len(content) > MAX_LIGHTS:
            hint = f"at most {MAX_LIGHTS} are supported"
            self.document.error(
                self.document.place("light", MAX_LIGHTS).value, f"the scene has {len(content)} lights", hint
            )
        return tuple(self.light(("light", index), light) for index, light in enumerate(content[:MAX_LIGHTS]))

    def light(self, path: Path, content: Any) -> Light:
        table = Table(self.document, path, content, LIGHT)
        color = table.vector("color", (1.0, 1.0, 1.0))
        if ("position" in table.content) == ("direction" in table.content):
            hint = "position: a point light; direction: towards a distant light"
            span = self.document.place(*path).value
            self.document.error(span, "a light has either a position or a direction", hint)
        if "direction" not in table.content:
            return Light(table.vector("position", (0.0, 1.0, 0.0)), None, color)
        x, y, z = table.vector("direction", (0.0, 1.0, 0.0))
        length = math.hypot(x, y, z)
        if length < 1e-6:
            table.error("direction", "the direction has length 0", "it must point towards the light")
            length = 1.0
        return Light(None, (x / length, y / length, z / length), color)

    def shell(self, content: Any) -> dict[str, str]:
        table = Table(self.document, ("shell",), content, SHELL)
        chosen: dict[str, str] = {}
        for role in (role for role in OF_SHELLS if role in table.content):
            chosen[role] = table.text(role, "", choices(role))
        return chosen

    # Geometry

    def geometry(self, content: Any, path: Path = ("geometry",)) -> Geometry | None:
        if content is None:
            return None
        kind = content.get("kind") if isinstance(content, dict) else None
        own = SHAPES.get(kind, {}) if isinstance(kind, str) else {}
        keys = {
            "kind": text(*SHAPES),
            **PLACE,
            **(own or {key: k for keys in SHAPES.values() for key, k in keys.items()}),
        }
        table = Table(self.document, path, content, keys)
        if not isinstance(content, dict):
            return None
        if kind is None:
            span = self.document.place(*path).value
            self.document.error(span, "the geometry has no kind", f"write kind = one of: {', '.join(SHAPES)}")
            return None
        place: dict[str, Any] = {
            "position": table.vector("position", (0.0, 0.0, 0.0)),
            "rotation": table.vector("rotation", (0.0, 0.0, 0.0)),
            "scale": table.number("scale", 1.0),
        }
        return self.shape(table, table.text("kind", ""), place)

    def shape(self, table: Table, kind: str, place: dict[str, Any]) -> Geometry | None:
        if kind == "ball":
            return Ball(table.number("radius", 1.0), **place)
        if kind == "box":
            return Box(size=table.vector("size", (1.0, 1.0, 1.0)), **place)
        if kind == "slab":
            width, height = table.number("width", 2.0), table.number("height", 2.0)
            return Slab(width, height, table.number("thickness", 0.1), **place)
        if kind == "torus":
            torus = Torus(table.number("major", 1.0), table.number("minor", 0.4), **place)
            if torus.minor >= torus.major:
                table.error("minor", "'minor' must be less than 'major'", f"major is {torus.major:g}")
            return torus
        if kind == "capsule":
            return Capsule(table.number("radius", 0.25), table.number("length", 1.0), **place)
        if kind == "union":
            return self.union(table, place)
        if kind == "mesh":
            return self.mesh(table, place)
        return self.distance(table, place) if kind == "distance" else None

    def union(self, table: Table, place: dict[str, Any]) -> Union | None:
        content = table.content.get("part")
        if not isinstance(content, list) or not 1 <= len(content) <= MAX_PARTS:
            table.error("part", f"a union has from 1 to {MAX_PARTS} parts", "write [[geometry.part]] for each")
            return None
        parts = [self.geometry(part, (*table.path, "part", index)) for index, part in enumerate(content)]
        projection = table.text("projection", "parts")
        return Union(tuple(part for part in parts if part is not None), projection, **place)

    def mesh(self, table: Table, place: dict[str, Any]) -> Mesh | None:
        name = table.text("file", "")
        if not name:
            table.error(
                "file", "the mesh has no file", f"write file = a path that ends in {', '.join(mesh_files.SUFFIXES)}"
            )
            return None
        try:
            mesh_files.check_suffix(name)
        except SssgenError as error:
            self.add_errors(error, (*table.path, "file"))
            return None
        return Mesh(path=self.file((*table.path, "file"), name), **place)

    def distance(self, table: Table, place: dict[str, Any]) -> Distance:
        parameters = table.content.get("parameters", {})
        if not isinstance(parameters, dict):
            table.error("parameters", "'parameters' takes a table", "write parameters = { radius = 1.0 }")
            parameters = {}
        shape = Distance(
            table.text("technique", Distance.technique),
            self.folder,
            parameters,
            table.number("reach", 4.0),
            table.text("projection", "spherical"),
            **place,
        )
        if "technique" not in table.content:
            table.error("technique", "the geometry has no technique", 'write technique = "sphere", or FILE:FUNCTION')
        try:
            _ = shape.function  # compile it here, so that its errors are reported with those of the scene
        except SssgenError as error:
            named = next((key for key in parameters if f"'{key}'" in error.diagnostics[0].message), "")
            self.add_errors(error, (*table.path, "parameters", named) if named else (*table.path, "technique"))
        return shape

    # Parameters and textures of the material

    def parameters(self, content: Any) -> dict[str, object]:
        if not isinstance(content, dict):
            self.document.error(self.document.place("parameters").value, "'parameters' is a table", "[parameters]")
            return {}
        for key, raw in content.items():
            if not _is_value(raw):
                hint = "numbers, true or false, a colour as text, or a list of these"
                span = self.document.place("parameters", key).value
                self.document.error(span, f"'{key}' is not a parameter's value", hint)
        return dict(content)

    def textures(self, content: Any, has_geometry: bool) -> dict[str, Picture | DistanceTexture]:
        if not isinstance(content, dict):
            self.document.error(self.document.place("textures").value, "'textures' is a table", "write [textures]")
            return {}
        textures: dict[str, Picture | DistanceTexture] = {}
        for key, raw in content.items():
            path = ("textures", key)
            if isinstance(raw, dict) and "distance_of_geometry" in raw:
                textures[key] = self.distance_texture(path, raw, has_geometry)
            elif isinstance(raw, dict):
                table = Table(self.document, path, raw, PICTURE)
                place = (*path, "file") if "file" in raw else path
                textures[key] = Picture(self.picture(place, table.text("file", "")), table.text("wrap", ""))
            elif isinstance(raw, str):
                textures[key] = Picture(self.picture(path, raw))
            else:
                span = self.document.place(*path).value
                self.document.error(span, f"'{key}' takes a picture file", 'write "x.png" or { file = "x.png" }')
        return textures

    def distance_texture(self, path: Path, raw: dict[str, Any], has_geometry: bool) -> DistanceTexture:
        table = Table(self.document, path, raw, DISTANCE_TEXTURE)
        texture = DistanceTexture(
            table.wholes("distance_of_geometry", (64, 64, 64)),
            table.vector("box_min", (-1.0, -1.0, -1.0)),
            table.vector("box_max", (1.0, 1.0, 1.0)),
            table.number("range", 1.0),
        )
        if not has_geometry:
            table.error("distance_of_geometry", "the scene has no geometry to measure", "add [geometry]")
        sides = [high - low for low, high in zip(texture.box_min, texture.box_max, strict=True)]
        if min(sides) < 0.0 or max(sides) == 0.0:
            table.error("box_max", "the box is empty", "no number of box_max may be less than that of box_min")
        return texture

    # Files

    def picture(self, path: Path, name: str) -> str:
        if not name:
            self.document.error(self.document.place(*path).value, "the texture has no file", 'write "x.png"')
            return name
        try:
            images.check_suffix(name, images.TEXTURES)
        except SssgenError as error:
            self.add_errors(error, path)
            return name
        self.pictures[str(path[1])] = path, name
        return os.path.join(self.folder, name)

    def check_pictures(self, scene: Scene) -> None:
        """Reports the textures whose files are missing; of a baked one, with the command that bakes it. Likewise the
        picture of the surroundings, of another kind of which `read_environment` reports."""
        missing = {key: name for key, (_, name) in self.pictures.items() if not self.has_file(name)}
        hints: dict[str, str] = {}
        if missing and scene.material:
            with contextlib.suppress(SssgenError):  # whoever loads the material reports its errors
                material = load_material(scene.material)
                for function in baked_functions(material.stages):
                    given = {one.name: missing[one.name] for one in function.textures if one.name in missing}
                    if given:
                        hints |= dict.fromkeys(given, advice(function, material, scene, given, in_scene=True))
        for key, name in missing.items():
            self.missing_file(self.pictures[key][0], name, hints.get(key, ""))
        surroundings = scene.measured.get("environment")
        file = surroundings.get("file") if isinstance(surroundings, dict) else None
        if isinstance(file, str) and file.lower().endswith(images.TEXTURES) and not self.has_file(file):
            self.missing_file(("environment", "file"), file)

    def file(self, path: Path, name: str) -> str:
        """The path of a file that the scene names."""
        if not self.has_file(name):
            self.missing_file(path, name)
        return os.path.join(self.folder, name)

    def has_file(self, name: str) -> bool:
        full_path = os.path.join(self.folder, name)
        note(full_path)
        return "\0" not in full_path and os.path.isfile(full_path)

    def missing_file(self, path: Path, name: str, hint: str = "") -> None:
        place = f"it is searched for next to the scene, in {posix(self.folder or '.')}"
        self.document.error(self.document.place(*path).value, f"cannot find the file '{name}'", hint or place)

    def add_errors(self, error: SssgenError, path: Path) -> None:
        """Reports the errors of a file that the scene names: at their own positions, else at the path in the scene."""
        span = self.document.place(*path).value
        for diagnostic in error.diagnostics:
            if diagnostic.span.line:
                self.document.reporter.diagnostics.append(diagnostic)
            else:
                self.document.error(span, diagnostic.message, diagnostic.hint)


class _Element(Table):
    """One list in a list, read like a table's value."""

    def __init__(self, document: Document, path: Path, index: int, content: Any) -> None:
        super().__init__(document, path, {str(path[-1]): content}, KEYS)
        self.index = index

    def error(self, key: str, message: str, hint: str = "", index: int | None = None) -> None:
        path = (*self.path, self.index) if index is None else (*self.path, self.index, index)
        self.document.error(self.document.place(*path).value, message, hint)


def _is_value(raw: object) -> bool:
    if isinstance(raw, list):
        return bool(raw) and all(map(_is_value, raw))
    if isinstance(raw, bool | str):
        return True
    return isinstance(raw, int | float) and ANY[0] * 1e29 <= raw <= ANY[1] * 1e29
