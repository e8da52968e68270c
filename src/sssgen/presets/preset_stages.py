"""The material file of a preset for a body, in three qualities.

`fast` needs nothing but lights, `good` measures the body in each frame, and `best` reads a bake of the light inside.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from sssgen.bake.fluence import variant
from sssgen.interchange.dense_bodies import isotropic_medium
from sssgen.interchange.imported_material import Notes
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.interchange.technique_choice import Choice, choose_for_lights
from sssgen.material.material_text import MaterialSection, material_text
from sssgen.material.scatter_color import multiscatter_of_albedo
from sssgen.presets.boundary_light import behind_boundary, leaving_shares
from sssgen.presets.kept_material import with_pictures
from sssgen.presets.preset import Color, Preset
from sssgen.scene.measured.media import Medium
from sssgen.support.diagnostics import failure

RESPONSE = "light.bin"
"""The file of the baked light, beside the material."""
_MATTE, _WRAP, _GLOW, _EVEN = 0.5, 0.5, 1.0, 0.3
"""Of `fast`: the share of a thick body's colour that is reflected, the wrap of a body of one mean free path, and the
strength of the lobe and of the even light over what a slab transmits. Fitted like the constants of `boundary_light`."""
_DETAIL = 0.5
"""The share of the light of a scattering body that has the detail of the mesh's own colours."""
_OPAQUE = 12.0
"""The mean chord in mean free paths from which nothing is seen through a body."""
_MEAN_CHORD = 0.6
"""Of a body that is two units large, as figures have it: the mean length of lines inside."""
_DENSEST = 10000.0
"""The largest extinction of techniques for light inside."""
_LONGEST_PATH = 100.0
"""The largest mean free path."""


class BodySize(NamedTuple):
    """What a material must know of a mesh."""

    unit_mm: float
    """Millimetres in a world unit"""
    mean_chord: float
    """World units: the mean length of straight lines inside"""


class PresetMaterial(NamedTuple):
    """A material of a preset."""

    text: str
    files: Mapping[str, bytes]
    """Its textures, by their names beside it"""


def preset_text(preset: Preset, quality: str, name: str, size: BodySize) -> str:
    """The material file of a preset, called `name`, for a body of a size."""
    return preset_material(preset, quality, name, size).text


def two_units_text(preset: Preset, name: str) -> str:
    """The material file of a preset for a body that is two units large, with the quality that needs no bake."""
    return preset_text(preset, "good", name, BodySize(0.5 * preset.size_mm, _MEAN_CHORD))


def preset_material(
    preset: Preset, quality: str, name: str, size: BodySize, kept: SurfaceModel | None = None, keeps_color: bool = False
) -> PresetMaterial:
    """The material of a preset for a body, with the pictures of `kept`, that of the colour only if `keeps_color`.

    Raises SssgenError for a mesh whose unit is too small or too large for the parameters of techniques.
    """
    _check_unit(preset, size)
    choice = _choice(preset, quality, size, kept, keeps_color)
    doc = f"{preset.doc} A world unit is {size.unit_mm:.4g} mm. {preset.source}."
    read = {value for stage in choice.stages for _, value in stage.values if isinstance(value, str)}
    files = {name: content for name, content in choice.files.items() if name in read}
    return PresetMaterial(material_text(name, choice.stages, preset.title, doc, choice.settings), files)


def preset_stages(preset: Preset, quality: str, size: BodySize) -> list[MaterialSection]:
    """The stages for a body, without pictures. Raises SssgenError as `preset_material` does."""
    _check_unit(preset, size)
    return _choice(preset, quality, size, None, False).stages


def _choice(preset: Preset, quality: str, size: BodySize, kept: SurfaceModel | None, keeps_color: bool) -> Choice:
    """The stages. A sheet is the same in all qualities: it needs no picture of the body and no bake."""

    def choose(model: SurfaceModel, mean_chord: float) -> Choice:
        model = model if kept is None else with_pictures(model, kept, keeps_color)
        return choose_for_lights(model, Notes(), mean_chord)

    if any(preset.sheet) or (quality == "fast" and not preset.scatters):
        # one thickness: its unit is free, and here it is the mean chord
        choice = choose(preset.model(size.unit_mm * size.mean_chord), 1.0)
        return choice._replace(stages=[_without_scene(stage) for stage in choice.stages])
    if quality == "good" or not preset.scatters:
        choice = choose(preset.model(size.unit_mm), size.mean_chord)
        stages = [_behind_boundary(preset, size, stage) for stage in choice.stages]
        choice = choice._replace(stages=_seen_through(preset, size, stages))
        has_detail = keeps_color and kept is not None and kept.base_color.image is not None
        if not (has_detail and preset.scatters):
            return choice
        painted = choose(preset.surface(_reflected(preset, size, _DETAIL)), size.mean_chord)
        return _with_detail(choice, painted)
    inside, color = (_fast if quality == "fast" else _best)(preset, size)
    choice = choose(preset.surface(color), size.mean_chord)
    return choice._replace(stages=[*inside, *choice.stages])


def _with_detail(choice: Choice, painted: Choice) -> Choice:
    """The stages of a body with light inside, a part of which is the colour of `painted` in its place: light inside has
    no picture."""
    (color,) = [stage for stage in painted.stages if stage.technique == "base_color"]
    stages = []
    for stage in choice.stages:
        values = [(key, _shares_left(value) if key == "octaves" else value) for key, value in stage.values]
        stages.append(color if stage.technique == "base_color" else stage._replace(values=tuple(values)))
    return choice._replace(stages=stages, files={**choice.files, **painted.files})


def _shares_left(octaves: Any) -> list[float]:
    return [(1.0 - _DETAIL) * share for share in octaves]


def _reflected(preset: Preset, size: BodySize, share: float) -> Color:
    """A share of what a thick body reflects of diffuse light through its refracting surface."""
    colors = _thick_color(preset, size)
    leaving = leaving_shares(colors, preset.ior)
    red, green, blue = (share * part * color for part, color in zip(leaving, colors, strict=True))
    return red, green, blue


def _thick_color(preset: Preset, size: BodySize) -> tuple[float, ...]:
    """What a thick body of the medium reflects of diffuse light where its surface does not refract."""
    return multiscatter_of_albedo(isotropic_medium(preset.interior(size.unit_mm)).albedo)


def _check_unit(preset: Preset, size: BodySize) -> None:
    """Raises SssgenError where a length in units of the mesh is outside of what techniques take."""
    medium = preset.interior(size.unit_mm)
    if not preset.scatters or (max(medium.extinction) <= _DENSEST and medium.mean_free_path <= _LONGEST_PATH):
        return
    depth = medium.mean_free_path * size.unit_mm
    raise failure(
        f"a unit of the mesh is {size.unit_mm:.3g} mm, and light in {preset.name} is scattered after {depth:.3g} mm: "
        "the numbers of the material leave their ranges",
        f"choose another --size, in millimetres ({preset.size_mm:g} is usual), or scale the mesh to 1 to 10 units",
    )


def _behind_boundary(preset: Preset, size: BodySize, stage: MaterialSection) -> MaterialSection:
    """The stage below the preset's refracting surface; that of a clear body as it is."""
    return behind_boundary(stage, _thick_color(preset, size), preset.ior) if preset.scatters else stage


def _transmitted(medium: Medium, depth: float) -> list[float]:
    """What a slab transmits of diffuse light, per channel: 4 / (3 tau + 4) exp(-depth sqrt(3 absorption extinction)),
    tau its thickness in mean free paths (diffusion, with a matched boundary)."""
    return [
        4.0 / (3.0 * extinction * depth + 4.0) * math.exp(-depth * math.sqrt(3.0 * absorption * extinction))
        for extinction, absorption in zip(medium.extinction, medium.absorption, strict=True)
    ]


def _seen_through(preset: Preset, size: BodySize, stages: list[MaterialSection]) -> list[MaterialSection]:
    """The stages with the length along each ray of the eye, and the light that comes through without scattering."""
    medium = isotropic_medium(preset.interior(size.unit_mm))
    if min(medium.extinction) * size.mean_chord > _OPAQUE:
        return stages
    replaced = [stage for stage in stages if stage.technique in ("constant_thickness", "seen_through")]
    kept = [stage for stage in stages if stage not in replaced]
    texture = [pair for stage in replaced for pair in stage.values if pair[0] == "entering_texture"]
    lengths = [] if preset.scatters else [MaterialSection("thickness", "back_face_thickness")]
    share = 1.0 if preset.scatters else preset.clear
    entering = (
        *texture, ("entering_color", [share] * 3), ("extinction", [*medium.extinction]), ("ior", preset.ior),
    )  # fmt: skip
    values = (*entering, ("sky_below", [0.0, 0.0, 0.0]), ("sky_above", [0.0, 0.0, 0.0]))
    comment = "The engine's surroundings are seen through; for a sky of two colours set sky_below and sky_above."
    seen = MaterialSection("translucency", "seen_through_body", values, comment=comment)
    if preset.scatters:  # too little of the scene is seen to draw it once more
        return [*lengths, *kept, _without_scene(seen)]
    return [*lengths, *kept, seen, MaterialSection("translucency", "lamps_through_body", entering)]


def _without_scene(stage: MaterialSection) -> MaterialSection:
    """The stage with the mean light of the surroundings in place of a picture of the scene."""
    if stage.technique not in ("seen_through", "seen_through_body"):
        return stage
    return stage._replace(values=(*stage.values, ("scene_share", 0.0)), fixed=(*stage.fixed, "scene_share"))


def _fast(preset: Preset, size: BodySize) -> tuple[list[MaterialSection], Color]:
    """A lobe behind, diffusion through a slab of half the mean chord, and a matte colour that reaches around."""
    medium = isotropic_medium(preset.interior(size.unit_mm))
    matte = _reflected(preset, size, _MATTE)
    depth = 0.5 * size.mean_chord
    leaving = leaving_shares(_thick_color(preset, size), preset.ior)
    through = [share * part for share, part in zip(leaving, _transmitted(medium, depth), strict=True)]
    strongest = max(through)
    wrap = _WRAP * min(medium.mean_free_path / max(depth, 1e-6), 1.0)
    lobe = (
        ("subsurface_color", [part / strongest for part in through]), ("scale", min(_GLOW * strongest, 20.0)),
        ("power", 2.0), ("distortion", 0.3), ("ambient", min(_EVEN * strongest, 1.0)),
    )  # fmt: skip
    stages = [
        MaterialSection("thickness", "constant_thickness", (("thickness_factor", 1.0),)),
        MaterialSection("thickness", "beer_lambert", (("attenuation_distance", 4.0),)),
        MaterialSection("translucency", "wrap_lighting", (("wrap", wrap), ("subsurface_color", [*matte]))),
        MaterialSection("translucency", "lobe_normalized", lobe),
    ]
    return stages, matte


def _best(preset: Preset, size: BodySize) -> tuple[list[MaterialSection], Color]:
    """The volume contains the diffuse reflection, so that the colour is black; its medium is in the bake's JSON."""
    technique = f"fluence_relit{variant(preset.interior(size.unit_mm))}"
    return [MaterialSection("translucency", technique, (("inner_light", RESPONSE),))], (0.0, 0.0, 0.0)
