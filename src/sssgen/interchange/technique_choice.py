"""Chooses the techniques of a foreign material: from its record to the stages of a material."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from sssgen.interchange.body_shares import Shares, shares_of
from sssgen.interchange.dense_bodies import as_matte, isotropic_medium, scatters_inside, weight_inside
from sssgen.interchange.imported_material import Notes
from sssgen.interchange.record_limits import limit_numbers
from sssgen.interchange.surface_model import ONE, WHITE, Quantity, SurfaceModel, UvTransform
from sssgen.interchange.texels import mean_of
from sssgen.interchange.texture_composer import ComposedTexture, Composer, Coordinates, coordinates
from sssgen.material.material_text import MaterialSection
from sssgen.scene.arrays import Array

_LUMINANCE = (0.2126, 0.7152, 0.0722)
"""Of linear sRGB (ITU-R BT.709)."""
_MOST_REFLECTED = 0.08
"""The largest reflectance that `specular_level` has."""
_USUAL_REFLECTED = 0.04
_MOST_TILED = 100.0
"""The largest tiling and offset of texture coordinates that `uv_transform` takes."""
_DARKEST = 1e-3
"""A base colour that is darker counts as this where it is multiplied."""
_ONE_MEDIUM = (
    "These values belong to one medium, with a share of the tint above and [medium] of the scene: change them together."
)
_BLACK = [0.0, 0.0, 0.0]
_SEEN_THROUGH = "The scene and its surroundings are seen through; for a sky of two colours set sky_below and sky_above."
_LONGEST, _DENSEST = 10.0, 1000.0
"""The largest thickness and extinction that techniques take, in world units."""
_DENSEST_INSIDE = 10000.0
"""The largest extinction of techniques for light inside"""


class Choice(NamedTuple):
    """The stages of a material, and what they need."""

    stages: list[MaterialSection]
    settings: dict[str, object]
    """Keys of the section [material]"""
    files: dict[str, bytes]
    """Textures, relative to the material"""
    clamped: dict[str, str]
    """Texture parameter → file, of the textures that are not repeated"""
    coordinates: list[Coordinates]
    """What `uv` and `uv2` are in the file"""
    metres: float
    """The length of a world unit"""


class _Lengths(NamedTuple):
    """How lengths inside a body are measured in each frame."""

    view: str
    """The technique for the eye's rays"""
    light: str
    """The same for the rays of lights"""
    beam: float = 0.0
    """The radius of the beam over which both are averaged, in mean free paths; 0 for one ray"""


_ONE_LIGHT = _Lengths("back_face_thickness", "depth_map_path")
_LIGHTS = _Lengths("back_face_thickness_soft", "light_layers_path_soft", 2.0)
_WIDEST_BEAM = 0.2
"""The radius of the widest beam, in mean chords: it would miss thin parts."""


class _Chooser:
    def __init__(
        self, model: SurfaceModel, notes: Notes, mean_chord: float, closed: bool, metres: float, lengths: _Lengths
    ) -> None:
        self.model, self.notes, self.mean_chord = model, notes, mean_chord
        has_map = model.thickness.image is not None
        self.measured = closed and model.interior is not None and not model.thin_walled and not has_map
        """Whether the length inside the body along the eye's rays is measured for each picture"""
        self.composer = Composer(model)
        self.stages: list[MaterialSection] = []
        self.clamped: dict[str, str] = {}
        self.metres, self.lengths = metres, lengths

    def add(self, section: str, technique: str, bind: dict[str, str] | None = None, **values: object) -> None:
        """Adds a stage; a `ComposedTexture` also sets the stage's set of coordinates."""
        plain: dict[str, object] = {}
        for key, value in values.items():
            if isinstance(value, ComposedTexture):
                plain[key] = value.file
                if value.uv == "uv2":
                    plain["uv"] = "uv2"
                if value.wrap == "clamp":
                    self.clamped[key] = value.file
            elif value is not None:
                plain[key] = value
        self.stages.append(MaterialSection(section, technique, tuple(plain.items()), (), tuple((bind or {}).items())))

    def choose(self) -> Choice:
        model = self.model
        self.coordinates()
        self.thickness()
        self.colors()
        if not model.unlit:
            self.relief()
            self.reflection()
            self.emission()
            self.translucency()
        settings: dict[str, object] = {"shading": "unlit" if model.unlit else "lit"}
        if model.alpha_mode != "opaque":
            settings["alpha_mode"] = model.alpha_mode
        if model.two_sided:
            settings["two_sided"] = True
        for field, reason in self.composer.substitutions.items():
            self.notes.add_approximation(field, reason)
        return Choice(self.stages, settings, self.composer.files, self.clamped, self.composer.sets, self.metres)

    def coordinates(self) -> None:
        for name, placed in zip(("uv", "uv2"), self.composer.sets, strict=False):
            tiling, offset, rotation = self.limit_transform(placed)
            if placed.transform != Coordinates().transform:
                self.add(
                    "coordinates", "uv_transform", uv=name if name == "uv2" else None,
                    uv_tiling=tiling, uv_offset=offset, uv_rotation=float(np.fmod(rotation, 360.0)),
                )  # fmt: skip

    def limit_transform(self, placed: Coordinates) -> UvTransform:
        """The transform in the ranges of `uv_transform`: of an offset whole repetitions go first."""
        tiling, offset, rotation = placed.transform
        placed_images = {image: field for image, field in self.composer.fields.items() if coordinates(image) == placed}
        if _limit_pair(offset) != offset and all(image.wrap == "repeat" for image in placed_images):
            offset = offset[0] % 1.0, offset[1] % 1.0
        within = UvTransform(_limit_pair(tiling), _limit_pair(offset), rotation)
        if within.tiling != tiling or within.offset != offset:
            for field in placed_images.values():
                self.notes.add_approximation(
                    field, f"its picture with a tiling and an offset of at most {_MOST_TILED:g}"
                )
        return within

    def thickness(self) -> None:
        model = self.model
        if model.unlit or not model.transmits:
            return
        seen_through = self.measured and not model.transmission.is_zero
        if scatters_inside(model):
            self.add("thickness", self.lengths.view, beam_radius=self.beam_radius())
        elif seen_through:
            self.add("thickness", "eye_layers_thickness")
        if not model.diffuse_transmission.is_zero or not (model.transmission.is_zero or self.measured):
            self.thickness_of_absorption()
        elif seen_through:
            became = "the length inside the body along each ray of the eye"
            self.notes.add_approximation("thickness", became, "refraction changes that length")

    def thickness_of_absorption(self) -> None:
        model = self.model
        quantity = self.composer.usable_quantity(model.thickness)
        factor = quantity.factor[0] / self.metres
        texture = self.composer.pack("thickness", [quantity])
        if model.thin_walled or model.interior is None:
            self.add("thickness", "constant_thickness", thickness_factor=0.0)
        elif texture is not None and factor > 0.0:
            self.add("thickness", "thickness_map", thickness_texture=texture, thickness_factor=factor)
        else:
            if factor == 0.0:
                factor = self.mean_chord / self.metres
                became = f"{self.mean_chord:.4g} m everywhere, the mean chord of the body"
                self.notes.add_approximation("thickness", became, "not known: it differs from place to place")
            self.add("thickness", "constant_thickness", thickness_factor=factor)

    def colors(self) -> None:
        model = self.model
        base, opacity = self.composer.align(model.base_color, model.opacity)
        base, matte = self.with_matte_share(base)
        cutoff = 0.5 / max(model.alpha_cutoff, 1e-3) if model.alpha_mode == "mask" else 1.0
        shares = self.composer.align(
            base, model.metalness, model.transmission, model.diffuse_transmission, model.subsurface
        )
        removed = any(not share.is_zero for share in shares[2:])
        kept = _reflected_share(*(np.array(share.factor) for share in shares[1:])) + matte
        computed = removed and (any(share.image is not None for share in shares[1:]) or _tint_exceeds_one(base, kept))
        if not removed and cutoff == 1.0:
            texture = self.composer.pack("base_color", [base, opacity], srgb=True)
            tint = (*base.factor, *opacity.factor)
        elif not computed and cutoff == 1.0:
            texture = self.composer.pack("base_color", [base, opacity], srgb=True)
            tint = (*(np.array(base.factor) * kept).tolist(), *opacity.factor)
        else:
            grid = self.composer.grid(*shares, opacity)
            values = [np.array(share.factor) for share in (*shares, opacity)] if grid is None else grid[0]
            rgb = values[0] * (_reflected_share(*values[1:5]) + matte)
            alpha = np.clip(values[5] * cutoff, 0.0, 1.0)
            rgba = np.concatenate([np.clip(rgb, 0.0, 1.0), alpha], axis=-1)
            texture = None if grid is None else self.composer.write_values("base_color", rgba, grid[1], srgb=True)
            tint = (1.0, 1.0, 1.0, 1.0) if grid else tuple(rgba.tolist())
        self.add("surface", "base_color", base_color_texture=texture, tint=tint)
        if model.vertex_colors:
            self.add("surface", "vertex_tint")
        if model.unlit:
            self.add("lighting", "base_color_alone")

    def with_matte_share(self, base: Quantity) -> tuple[Quantity, Array | float]:
        """The base colour, and the factor of it that is the matte share of a body with light inside: 0 for others."""
        if not scatters_inside(self.model):
            return base, 0.0
        if base.image is None:
            base = Quantity(tuple(max(part, _DARKEST) for part in base.factor))
        mean = np.maximum(mean_of(base), _DARKEST)
        return base, weight_inside(self.model) * np.array(self.shares().matte) / mean

    def relief(self) -> None:
        model = self.model
        normal = self.composer.usable_quantity(model.normal)
        if (texture := self.composer.pack("normal", [normal])) is not None:
            name = "normal_map_directx" if model.normal_down else "normal_map"
            self.add("surface", name, normal_texture=texture, normal_scale=min(normal.factor[0], 4.0))

    def reflection(self) -> None:
        model = self.model
        roughness, metalness = self.composer.align(model.roughness, model.metalness)
        texture = self.composer.pack("metallic_roughness", [ONE, roughness, metalness])
        self.add(
            "surface", "pbr_constants" if texture is None else "metallic_roughness_map",
            metallic_roughness_texture=texture, metalness=metalness.factor[0], surface_roughness=roughness.factor[0],
        )  # fmt: skip
        occlusion = self.composer.usable_quantity(model.occlusion)
        if (texture := self.composer.pack("occlusion", [occlusion])) is not None:
            self.add(
                "surface", "occlusion_map", occlusion_texture=texture, occlusion_strength=min(occlusion.factor[0], 1.0)
            )
        self.specular()
        coat, coat_roughness = self.composer.align(model.coat, model.coat_roughness)
        if not coat.is_zero:
            texture = self.composer.pack("coat", [coat, coat_roughness])
            name = "clearcoat_constants" if texture is None else "clearcoat_map"
            self.add(
                "surface", name, clearcoat_texture=texture,
                coat_weight=coat.factor[0], coat_roughness=coat_roughness.factor[0],
            )  # fmt: skip

        self.sheen()

    def sheen(self) -> None:
        values = {field: mean_of(getattr(self.model, field)) for field in ("sheen_color", "sheen_roughness")}
        if not any(values["sheen_color"]):
            return
        for field in values:
            if getattr(self.model, field).image is not None:
                self.notes.add_approximation(field, "the mean of its picture: the sheen is the same everywhere")
        self.add(
            "surface", "sheen_constants", sheen_tint=list(values["sheen_color"]),
            sheen_spread=values["sheen_roughness"][0],
        )  # fmt: skip

    def specular(self) -> None:
        model = self.model
        tint = mean_of(model.specular_color)
        luminance = sum(weight * part for weight, part in zip(_LUMINANCE, tint, strict=True))
        if max(tint) - min(tint) > 1e-3:
            self.notes.add_approximation("specular_color", f"its luminance {luminance:.3g}: reflection has no tint")
        specular = self.composer.usable_quantity(model.specular)
        reflected = model.reflectance * specular.factor[0] * luminance
        if reflected > _MOST_REFLECTED:
            reason = f"{_MOST_REFLECTED:.0%} are reflected in place of {reflected:.1%}: the largest value"
            self.notes.add_approximation("ior" if model.reflectance > _MOST_REFLECTED else "specular", reason)
        level = min(reflected / _MOST_REFLECTED, 1.0)
        texture = self.composer.pack("specular", [WHITE, specular])
        if texture is not None:
            self.add("surface", "specular_map", specular_texture=texture, specular_strength=level)
        elif abs(reflected - _USUAL_REFLECTED) > 1e-6:
            self.add("surface", "specular_level", dielectric_specular=level)

    def emission(self) -> None:
        emission = self.composer.usable_quantity(self.model.emission)
        if not emission.is_zero:
            texture = self.composer.pack("emission", [emission], srgb=True)
            strength = max(max(emission.factor), 1.0)
            color = [part / strength for part in emission.factor]
            self.add(
                "surface", "emission_map", emission_texture=texture, emission_color=color, emission_strength=strength
            )

    def translucency(self) -> None:
        model = self.model
        interior = model.interior
        extinction = [0.0, 0.0, 0.0]
        if interior is not None and not model.thin_walled:
            extinction = [min(part * self.metres, _DENSEST) for part in interior.extinction]
        if not model.transmission.is_zero:
            tint = model.base_color if model.transmission_tint is None else model.transmission_tint
            texture, color = self.product("entering", tint, model.transmission)
            self.add(
                "translucency", "seen_through_body" if self.measured else "seen_through",
                entering_texture=texture, entering_color=color,
                extinction=extinction, ior=min(max(model.ior, 1.0), 3.0),
                sky_below=_BLACK, sky_above=_BLACK,
            )  # fmt: skip
            self.stages[-1] = self.stages[-1]._replace(comment=_SEEN_THROUGH)
            if self.measured:
                self.add(
                    "translucency", "lamps_through_body", entering_texture=texture, entering_color=color,
                    extinction=extinction, ior=min(max(model.ior, 1.0), 3.0),
                )  # fmt: skip
        if scatters_inside(model):
            self.interior()
        elif not model.diffuse_transmission.is_zero:
            texture, color = self.product(
                "diffuse_transmission", model.diffuse_transmission_color, model.diffuse_transmission
            )
            self.add(
                "translucency", "diffuse_transmission_map", diffuse_transmission_texture=texture,
                diffuse_transmission_tint=color, extinction=extinction,
            )  # fmt: skip

    def product(self, name: str, color: Quantity, share: Quantity) -> tuple[ComposedTexture | None, list[float]]:
        """The texture and the constant of a colour times the share of dielectric light that it has."""
        color, share, metalness = self.composer.align(color, share, self.model.metalness)
        grid = self.composer.grid(color, share, metalness)
        if grid is None:
            dielectric = 1.0 - metalness.factor[0]
            return None, [part * share.factor[0] * dielectric for part in color.factor]
        values = np.clip(grid[0][0] * grid[0][1] * (1.0 - grid[0][2]), 0.0, 1.0)
        return self.composer.write_values(name, values, grid[1], srgb=True), [1.0, 1.0, 1.0]

    def interior(self) -> None:
        """Light that is scattered inside; anisotropic scattering by the similarity relation."""
        assert self.model.interior is not None
        medium, weight = isotropic_medium(self.model.interior), weight_inside(self.model)
        extinction = ", ".join(f"{part:.4g}" for part in medium.extinction)
        became = f"four exponentials and a matte share in place of light transport; extinction {extinction} per metre"
        self.notes.add_approximation("interior", became)
        self.add(
            "translucency", "interior_octaves", {"light_path": self.lengths.light},
            extinction=[min(part * self.metres, _DENSEST_INSIDE) for part in medium.extinction],
            scattering_albedo=medium.albedo,
            octaves=[weight * part for part in self.shares().octaves],
            mean_free_path=min(max(medium.mean_free_path / self.metres, 1e-4), 100.0),
            beam_radius=self.beam_radius(),
        )  # fmt: skip
        self.stages[-1] = self.stages[-1]._replace(comment=_ONE_MEDIUM)

    def beam_radius(self) -> float | None:
        """In world units; None for techniques that follow one ray."""
        assert self.model.interior is not None
        path = isotropic_medium(self.model.interior).mean_free_path
        return min(self.lengths.beam * path, _WIDEST_BEAM * self.mean_chord) / self.metres or None

    def shares(self) -> Shares:
        """How the light in the body is divided."""
        assert self.model.interior is not None
        medium = isotropic_medium(self.model.interior)
        return shares_of([part * self.mean_chord for part in medium.extinction], medium.albedo)


def choose(model: SurfaceModel, notes: Notes, mean_chord: float, closed: bool, metres: float) -> Choice:
    """The stages of a material; `mean_chord`, in metres, is used where the thickness is not known.

    `closed` says whether the body's mesh has an inside, `metres` is the length of a world unit. `notes` gets what the
    stages cannot express.
    """
    model = as_matte(limit_numbers(model, notes), notes, mean_chord)
    return _Chooser(model, notes, mean_chord, closed, metres, _ONE_LIGHT).choose()


def choose_for_lights(model: SurfaceModel, notes: Notes, mean_chord: float) -> Choice:
    """The stages for several lights of any kind; lengths of the record are world units. See `choose`.

    A dense body transmits light where it is thin, so that it has no other technique.
    """
    return _Chooser(limit_numbers(model, notes), notes, mean_chord, False, 1.0, _LIGHTS).choose()


def _limit_pair(pair: tuple[float, float]) -> tuple[float, float]:
    """The numbers, none beyond the largest tiling."""
    first, second = (min(max(part, -_MOST_TILED), _MOST_TILED) for part in pair)
    return first, second


def _reflected_share(metalness: ArrayLike, transmission: ArrayLike, diffuse: ArrayLike, subsurface: ArrayLike) -> Array:
    """The share of the base colour that is left for the reflection: metals keep all, as it is their mirror's colour."""
    m, t, d, s = (np.asarray(share) for share in (metalness, transmission, diffuse, subsurface))
    return 1.0 - (1.0 - m) * (1.0 - (1.0 - t) * (1.0 - d) * (1.0 - s))


def _tint_exceeds_one(base: Quantity, kept: Array) -> bool:
    """Whether the factor of a picture would be larger than a tint can be."""
    return base.image is not None and bool((np.array(base.factor) * kept > 1.0).any())


def world_unit(models: Sequence[tuple[SurfaceModel, float]]) -> float:
    """The length of a world unit in metres for which the numbers of all materials are in the ranges of techniques.

    Each model is given with the mean chord of its body, in metres.
    """
    ready = [as_matte(limit_numbers(model, Notes()), Notes(), mean_chord) for model, mean_chord in models]
    longest = max(model.thickness.factor[0] for model in ready)
    densest = max((max(model.interior.extinction) for model in ready if model.interior is not None), default=0.0)
    metres = 1.0
    while longest / metres > _LONGEST:
        metres *= 10.0
    if metres == 1.0:
        while densest * metres > _DENSEST and longest / metres <= 0.1 * _LONGEST:
            metres /= 10.0
    return metres
