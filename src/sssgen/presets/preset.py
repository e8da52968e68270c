"""Ready materials: the table `presets.toml`, and each as a neutral record for a mesh of a size."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import dataclass

from sssgen.interchange.albedo_inversion import subsurface_medium
from sssgen.interchange.surface_model import ONE, WHITE, Quantity, SurfaceModel, extinction_of_color
from sssgen.scene.measured import media
from sssgen.scene.measured.media import Medium
from sssgen.scene.toml_table import Table, number, text, vector
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.support.paths import PRESETS, posix
from sssgen.support.text_files import read_text
from sssgen.support.toml_source import parse

_COLOR, _LENGTH = (0.0, 1.0), (1e-3, 1e4)
_KEYS = {
    "title": text(),
    "doc": text(),
    "medium": text(),
    "color": vector(3, _COLOR),
    "depth_mm": vector(3, _LENGTH),
    "clear": number(_COLOR),
    "clear_color": vector(3, _COLOR),
    "clear_depth_mm": number(_LENGTH),
    "sheet": vector(3, _COLOR),
    "base": vector(3, _COLOR),
    "size_mm": number(_LENGTH),
    "roughness": number(_COLOR),
    "ior": number((1.0, 3.0)),
    "mesh_color": text("kept"),
}
Color = tuple[float, float, float]
_BLACK: Color = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Preset:
    """A ready material. One of `medium`, `color`, `clear` and `sheet` says what happens to light inside."""

    name: str
    title: str
    doc: str
    size_mm: float
    """The longest side of a mesh, unless the user gives another"""
    roughness: float
    ior: float
    """That of the medium, where the row has no other"""
    medium: str = ""
    """The name of a published medium"""
    color: Color = _BLACK
    """What a thick body reflects of diffuse light, with `depth_mm`"""
    depth_mm: Color = _BLACK
    """The mean free path, per channel"""
    clear: float = 0.0
    """The share of the light that enters a clear body"""
    clear_color: Color = _BLACK
    """The colour of white light after `clear_depth_mm`"""
    clear_depth_mm: float = 1.0
    sheet: Color = _BLACK
    """The share of the light that leaves on the other side of a sheet"""
    base: Color = _BLACK
    """What a sheet reflects"""
    keeps_color: bool = False
    """Whether a textured mesh keeps the detail of its colours, unless the user says"""

    @property
    def source(self) -> str:
        """Where its numbers come from."""
        return media.media()[self.medium].source if self.medium else "Chosen by us by its look"

    @property
    def scatters(self) -> bool:
        """Whether light is scattered between the surfaces of the body."""
        return bool(self.medium) or any(self.color)

    def interior(self, unit_mm: float) -> Medium:
        """The medium inside, where a world unit is `unit_mm` millimetres; a clear one scatters nothing."""
        if self.medium:
            return dataclasses.replace(media.preset(self.medium, unit_mm), ior=self.ior)
        if any(self.color):
            red, green, blue = (depth / unit_mm for depth in self.depth_mm)
            inside = subsurface_medium(self.color, (red, green, blue))
            return dataclasses.replace(inside, name=self.name, ior=self.ior)
        red, green, blue = extinction_of_color(self.clear_color, self.clear_depth_mm / unit_mm)
        return Medium(self.name, (red, green, blue), _BLACK, ior=self.ior)

    def surface(self, color: Color) -> SurfaceModel:
        """The neutral record of a body with nothing inside, which reflects a colour."""
        return SurfaceModel(
            self.name, self.doc, roughness=Quantity((self.roughness,)), ior=self.ior, base_color=Quantity(color)
        )

    def model(self, unit_mm: float) -> SurfaceModel:
        """The neutral record, whose lengths are world units of `unit_mm` millimetres."""
        surface = self.surface(self.base)
        if any(self.sheet):
            color, share = _share(self.sheet)
            # the chooser leaves the share of a sheet out of the reflection
            base = Quantity(tuple(min(part / (1.0 - share), 1.0) for part in self.base))
            return dataclasses.replace(
                surface, base_color=base, thin_walled=True, two_sided=True,
                diffuse_transmission=Quantity((share,)), diffuse_transmission_color=Quantity(color),
            )  # fmt: skip
        interior = self.interior(unit_mm)
        if self.scatters:
            return dataclasses.replace(surface, subsurface=ONE, interior=interior)
        clear = Quantity((self.clear,))
        return dataclasses.replace(surface, transmission=clear, transmission_tint=WHITE, interior=interior)


def presets() -> Mapping[str, Preset]:
    """All presets by name, in the order of their file. Raises SssgenError for a faulty file."""
    measured = media.media()
    document = parse(read_text(PRESETS, posix(PRESETS)), posix(PRESETS))
    result = {}
    for name, content in document.data.items():
        table = Table(document, (name,), content, _KEYS)
        medium = table.text("medium", "", measured)
        index = measured[medium].ior if medium else 1.5
        result[name] = Preset(
            name, table.text("title", name), table.text("doc", ""), table.number("size_mm", 100.0),
            table.number("roughness", 0.5), table.number("ior", index), medium,
            table.vector("color", _BLACK), table.vector("depth_mm", (1.0, 1.0, 1.0)), table.number("clear", 0.0),
            table.vector("clear_color", _BLACK), table.number("clear_depth_mm", 1.0), table.vector("sheet", _BLACK),
            table.vector("base", _BLACK), table.text("mesh_color", "") == "kept",
        )  # fmt: skip
    document.reporter.check()
    return result


def preset(name: str) -> Preset:
    """The preset of a name: in any case, with spaces or hyphens for underscores. Raises SssgenError for another one."""
    table = presets()
    plain = re.sub(r"[\s-]+", "_", name.strip().lower())
    if plain not in table:
        raise failure(f"unknown preset '{name}'", did_you_mean(plain, table) or f"presets: {', '.join(table)}")
    return table[plain]


def _share(color: Color) -> tuple[Color, float]:
    """A colour whose largest component is 1, and its factor."""
    largest = max(color)
    return (color[0] / largest, color[1] / largest, color[2] / largest), largest
