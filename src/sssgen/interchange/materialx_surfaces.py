"""The shaders of MaterialX documents as records: OpenPBR, standard_surface, glTF's PBR, UsdPreviewSurface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from sssgen.interchange.albedo_inversion import subsurface_medium, transmission_medium
from sssgen.interchange.graph_values import Constant, Value, mean
from sssgen.interchange.materialx_shader import Shader
from sssgen.interchange.record_limits import BRIGHTEST
from sssgen.interchange.surface_model import (
    AlphaMode,
    Quantity,
    SurfaceModel,
    extinction_of_color,
    medium,
)

Reasons = dict[str, tuple[str, str]]

_INVERSION = "at most 0.006 of the light that a thick body reflects"


def _group(weight: str, reason: str, *names: str) -> Reasons:
    """Inputs that are left out together; they have no effect where `weight` is 0."""
    return dict.fromkeys(names, (weight, reason))


def _one_minus(shader: Shader, value: Value) -> Value:
    return shader.compute("subtract", Constant((1.0,)), value)


def _opacity(shader: Shader, name: str) -> tuple[Quantity, AlphaMode]:
    """The opacity, the mean of a colour, and whether it has an effect."""
    value = shader.value(name, "opacity")
    if len(mean(value)) == 3:
        weights = Constant((0.2126, 0.7152, 0.0722))
        if len(set(mean(value))) > 1:
            shader.report_approximation(name, "its luminance: opacity has no colour")
        value = shader.compute("dotproduct", value, weights)
    quantity = shader.as_quantity(value, "opacity")
    return quantity, "opaque" if quantity == Quantity((1.0,)) else "blend"


def _coat_attenuation(shader: Shader, base: Value, weight: str, color: str) -> Value:
    """The base colour below a tinted coat."""
    tint = shader.value(color, "base_color")
    if mean(tint) == (1.0, 1.0, 1.0):
        return base
    if any(mean(shader.value(weight, "coat"))):
        shader.report_approximation(color, "multiplied to the base colour, for light along the normal")
    white = Constant((1.0, 1.0, 1.0))
    return shader.compute("multiply", base, shader.compute("mix", white, tint, shader.value(weight, "coat")))


def _emission(shader: Shader, weight: str, color: str) -> Quantity:
    """The emitted radiance: the number of the weight is taken as it is."""
    quantity = shader.product(weight, color, "emission")
    if max(quantity.factor) >= BRIGHTEST:
        shader.report_approximation(weight, f"{BRIGHTEST:g}, the brightest emission of a material")
    return quantity


# OpenPBR and standard_surface


_STANDARD_NAMES = {
    "base_weight": "base", "base_metalness": "metalness", "specular_ior": "specular_IOR", "specular_weight": "specular",
    "geometry_normal": "normal", "geometry_opacity": "opacity", "emission_luminance": "emission", "coat_weight": "coat",
    "transmission_weight": "transmission", "subsurface_weight": "subsurface", "subsurface_radius": "subsurface_scale",
    "subsurface_radius_scale": "subsurface_radius", "subsurface_scatter_anisotropy": "subsurface_anisotropy",
    "geometry_thin_walled": "thin_walled",
}  # fmt: skip
"""OpenPBR's name of an input → that of standard_surface, where they differ."""

_SUBSURFACE_INPUTS = (
    "subsurface_color", "subsurface_radius", "subsurface_radius_scale", "subsurface_scatter_anisotropy",
)  # fmt: skip
_TRANSMISSION_INPUTS = (
    "transmission_color", "transmission_depth", "transmission_scatter", "transmission_scatter_anisotropy",
)  # fmt: skip


def _add_interior(shader: Shader, model: SurfaceModel, base: Value) -> SurfaceModel:
    """The record with what is below the surface: a sheet's two sides, or a body's medium."""
    thin = bool(shader.number("geometry_thin_walled", "thin_walled"))
    model = replace(model, thin_walled=thin, two_sided=thin)
    weight = shader.value("subsurface_weight", "diffuse_transmission" if thin else "subsurface")
    transmission = shader.quantity("transmission_weight", "transmission")
    scatters, transmits = any(part > 0.0 for part in mean(weight)), not transmission.is_zero
    if thin:
        model = _sheet(shader, model, base, weight) if scatters else model
        if transmits:
            tint = shader.quantity("transmission_color", "transmission_tint", color=True)
            model = replace(model, transmission=transmission, transmission_tint=tint)
        return model
    if scatters:
        model = replace(model, subsurface=shader.as_quantity(weight, "subsurface"))
    if transmits:
        model = replace(model, transmission=transmission)
        depth = shader.number("transmission_depth", "interior")
        model = replace(model, transmission_tint=Quantity((1.0, 1.0, 1.0)))
        if depth <= 0.0:
            tint = shader.quantity("transmission_color", "transmission_tint", color=True)
            model = replace(model, transmission_tint=tint)
            return _add_subsurface(shader, model) if scatters else model
        if not scatters or mean(shader.value("transmission_weight", "transmission"))[0] >= 0.5:
            interior = transmission_medium(
                shader.shares("transmission_color", "interior"),
                depth,
                shader.numbers("transmission_scatter", "interior"),
                shader.number("transmission_scatter_anisotropy", "interior"),
            )
            if scatters:
                _drop(shader, _SUBSURFACE_INPUTS, "the body has one medium: that of the transmission")
            return replace(model, interior=interior)
        _drop(shader, _TRANSMISSION_INPUTS, "the body has one medium: that of the subsurface")
    return _add_subsurface(shader, model) if scatters else model


def _drop(shader: Shader, names: tuple[str, ...], reason: str) -> None:
    for name in names:
        shader.report_approximation(name, reason)


def _add_subsurface(shader: Shader, model: SurfaceModel) -> SurfaceModel:
    color = shader.numbers("subsurface_color", "interior")
    anisotropy = shader.number("subsurface_scatter_anisotropy", "interior")
    scale = shader.number("subsurface_radius", "interior")
    radii = tuple(scale * part for part in shader.numbers("subsurface_radius_scale", "interior"))  # in metres
    interior = subsurface_medium(color, radii, anisotropy)
    albedo = ", ".join(f"{part:.4g}" for part in interior.albedo)
    shader.report_approximation("subsurface_color", f"the scattering albedo {albedo}", _INVERSION)
    return replace(model, interior=interior)


def _sheet(shader: Shader, model: SurfaceModel, base: Value, weight: Value) -> SurfaceModel:
    """A thin sheet: its subsurface reflects and transmits diffusely.

    With the share T of the sheet's light that is transmitted (OpenPBR: (1 + g) / 2; standard_surface: all), the weight
    w and the colour C, it reflects (1 - w) base + w (1 - T) C and transmits w T C. The record's sheet transmits the
    share f = w T of the colour C, and reflects 1 - f of its base colour.
    """
    color = shader.value("subsurface_color", "diffuse_transmission_color")
    through = 1.0
    if not shader.aliases:  # OpenPBR
        through = 0.5 * (1.0 + shader.number("subsurface_scatter_anisotropy", "diffuse_transmission"))
    share = shader.compute("multiply", weight, Constant((through,)))
    back = shader.compute("multiply", color, shader.compute("multiply", weight, Constant((1.0 - through,))))
    front = shader.compute("multiply", base, _one_minus(shader, weight))
    kept = shader.compute("max", _one_minus(shader, share), Constant((1e-3,)))
    reflected = shader.compute("divide", shader.compute("add", front, back), kept)
    return replace(
        model,
        base_color=shader.as_quantity(reflected, "base_color", color=True),
        diffuse_transmission=shader.as_quantity(share, "diffuse_transmission"),
        diffuse_transmission_color=shader.as_quantity(color, "diffuse_transmission_color", color=True),
    )


_FILM = "interference in a thin film"
_FUZZ = "a layer of fuzz"
_ANISOTROPIC = "anisotropic reflection"
_DISPERSION = "dispersion"
_ROUGH_DIFFUSE = "rough diffuse reflection: it is Lambert's"
_COAT_BOUNDARY = "the coat has the index 1.5 and does not darken the base"

_OPEN_PBR_LEFT_OUT: Reasons = {
    **_group("base_diffuse_roughness", _ROUGH_DIFFUSE, "base_diffuse_roughness"),
    **_group("specular_roughness_anisotropy", _ANISOTROPIC, "specular_roughness_anisotropy"),
    **_group(
        "transmission_dispersion_scale", _DISPERSION, "transmission_dispersion_scale",
        "transmission_dispersion_abbe_number",
    ),
    **_group(
        "coat_weight", _COAT_BOUNDARY, "coat_ior", "coat_darkening", "coat_roughness_anisotropy",
        "geometry_coat_normal", "geometry_coat_tangent",
    ),
    **_group("fuzz_weight", _FUZZ, "fuzz_weight", "fuzz_color", "fuzz_roughness"),
    **_group("thin_film_weight", _FILM, "thin_film_weight", "thin_film_thickness", "thin_film_ior"),
    **_group("specular_roughness_anisotropy", _ANISOTROPIC, "geometry_tangent"),
    **_group("transmission_weight", "no effect at this depth", *_TRANSMISSION_INPUTS),
    **_group("subsurface_weight", "no effect on a thin sheet", *_SUBSURFACE_INPUTS),
}  # fmt: skip

_STANDARD_LEFT_OUT: Reasons = {
    **_group("diffuse_roughness", _ROUGH_DIFFUSE, "diffuse_roughness"),
    **_group("specular_anisotropy", _ANISOTROPIC, "specular_anisotropy", "specular_rotation", "tangent"),
    **_group("transmission_dispersion", _DISPERSION, "transmission_dispersion"),
    **_group(
        "transmission_extra_roughness", "rougher transmission than reflection", "transmission_extra_roughness"
    ),
    **_group(
        "coat", _COAT_BOUNDARY, "coat_IOR", "coat_anisotropy", "coat_rotation", "coat_normal", "coat_affect_color",
        "coat_affect_roughness",
    ),
    **_group("sheen", _FUZZ, "sheen", "sheen_color", "sheen_roughness"),
    **_group("thin_film_thickness", _FILM, "thin_film_thickness", "thin_film_IOR"),
    **_group("transmission", "no effect at this depth", *_TRANSMISSION_INPUTS),
    **_group("subsurface", "no effect on a thin sheet", *_SUBSURFACE_INPUTS),
}  # fmt: skip


def open_pbr_surface(shader: Shader, name: str) -> SurfaceModel:
    """OpenPBR Surface 1.1."""
    return _layered_surface(shader, name, _OPEN_PBR_LEFT_OUT)


def standard_surface(shader: Shader, name: str) -> SurfaceModel:
    """Autodesk's standard_surface 1.0.1."""
    shader.aliases = _STANDARD_NAMES
    return _layered_surface(shader, name, _STANDARD_LEFT_OUT)


def _layered_surface(shader: Shader, name: str, left_out: Reasons) -> SurfaceModel:
    """A base with an interior, below a coat; the inputs have OpenPBR's names."""
    base = _coat_attenuation(
        shader, shader.weighted_value("base_weight", "base_color", "base_color"), "coat_weight", "coat_color"
    )
    opacity, alpha_mode = _opacity(shader, "geometry_opacity")
    model = SurfaceModel(
        name,
        alpha_mode=alpha_mode,
        base_color=shader.as_quantity(base, "base_color", color=True),
        opacity=opacity,
        metalness=shader.quantity("base_metalness", "metalness"),
        roughness=shader.quantity("specular_roughness", "roughness"),
        ior=shader.number("specular_ior", "ior"),
        specular=shader.quantity("specular_weight", "specular"),
        specular_color=shader.quantity("specular_color", "specular_color", color=True),
        normal=shader.normal("geometry_normal", "normal"),
        emission=_emission(shader, "emission_luminance", "emission_color"),
        coat=shader.quantity("coat_weight", "coat"),
        coat_roughness=shader.quantity("coat_roughness", "coat_roughness"),
    )
    model = _add_interior(shader, model, base)
    shader.report_omissions(left_out)
    return model


# glTF's PBR and UsdPreviewSurface


_GLTF_LEFT_OUT: Reasons = {
    **_group("alpha_mode", "the alpha mode has no use for it", "alpha", "alpha_cutoff"),
    **_group("iridescence", _FILM, "iridescence", "iridescence_ior", "iridescence_thickness"),
    **_group("sheen_color", _FUZZ, "sheen_color", "sheen_roughness"),
    **_group("clearcoat", "a normal of the coat's own", "clearcoat_normal"),
    **_group("anisotropy_strength", _ANISOTROPIC, "anisotropy_strength", "anisotropy_rotation", "tangent"),
    **_group("dispersion", _DISPERSION, "dispersion"),
    **_group("transmission", "no light enters", "thickness", "attenuation_distance", "attenuation_color"),
}
_ALPHA_MODES: Mapping[int, AlphaMode] = {1: "mask", 2: "blend"}


def gltf_pbr(shader: Shader, name: str) -> SurfaceModel:
    """glTF's PBR 2.0.1, with the volume of KHR_materials_volume."""
    alpha_mode = _ALPHA_MODES.get(round(shader.number("alpha_mode", "alpha_mode")), "opaque")
    cutoff = shader.number("alpha_cutoff", "alpha_cutoff") if alpha_mode == "mask" else 0.5
    transmission = shader.quantity("transmission", "transmission")
    model = SurfaceModel(
        name,
        alpha_mode=alpha_mode,
        alpha_cutoff=cutoff,
        base_color=shader.quantity("base_color", "base_color", color=True),
        opacity=Quantity((1.0,)) if alpha_mode == "opaque" else shader.quantity("alpha", "opacity"),
        metalness=shader.quantity("metallic", "metalness"),
        roughness=shader.quantity("roughness", "roughness"),
        ior=shader.number("ior", "ior"),
        specular=shader.quantity("specular", "specular"),
        specular_color=shader.quantity("specular_color", "specular_color", color=True),
        normal=shader.normal("normal", "normal"),
        occlusion=shader.quantity("occlusion", "occlusion"),
        emission=_emission(shader, "emissive_strength", "emissive"),
        coat=shader.quantity("clearcoat", "coat"),
        coat_roughness=shader.quantity("clearcoat_roughness", "coat_roughness"),
        transmission=transmission,
    )
    if not transmission.is_zero:
        thickness = shader.quantity("thickness", "thickness")
        distance = shader.number("attenuation_distance", "interior")
        if distance > 0.0 and not thickness.is_zero:
            extinction = extinction_of_color(shader.shares("attenuation_color", "interior"), distance)
            model = replace(model, interior=medium(extinction, (0.0, 0.0, 0.0)))
        model = replace(model, thickness=thickness, thin_walled=thickness.is_zero)
    shader.report_omissions(_GLTF_LEFT_OUT)
    return model


_PREVIEW_LEFT_OUT: Reasons = {
    **_group("displacement", "displacement", "displacement"),
    **_group("useSpecularWorkflow", "the workflow with a specular colour", "specularColor"),
}


def usd_preview_surface(shader: Shader, name: str) -> SurfaceModel:
    """UsdPreviewSurface 2.6, the workflow with metalness."""
    threshold = shader.number("opacityThreshold", "alpha_cutoff")
    opacity, alpha_mode = _opacity(shader, "opacity")
    if threshold > 0.0 and alpha_mode == "blend":
        alpha_mode = "mask"
    if shader.number("useSpecularWorkflow", "metalness"):
        shader.report_approximation("useSpecularWorkflow", "the workflow with metalness: specularColor is not read")
    model = SurfaceModel(
        name,
        alpha_mode=alpha_mode,
        alpha_cutoff=threshold or 0.5,
        base_color=shader.quantity("diffuseColor", "base_color", color=True),
        opacity=opacity,
        metalness=shader.quantity("metallic", "metalness"),
        roughness=shader.quantity("roughness", "roughness"),
        ior=shader.number("ior", "ior"),
        normal=shader.normal("normal", "normal"),
        occlusion=shader.quantity("occlusion", "occlusion"),
        emission=shader.quantity("emissiveColor", "emission", color=True),
        coat=shader.quantity("clearcoat", "coat"),
        coat_roughness=shader.quantity("clearcoatRoughness", "coat_roughness"),
    )
    shader.report_omissions(_PREVIEW_LEFT_OUT)
    if model.alpha_mode == "blend" and opacity.image is None:  # UsdPreviewSurface 2.6: what is clear still reflects
        shader.report_approximation(
            "opacity", "light that comes through without refraction: the surface still reflects"
        )
        through, white = Quantity((1.0 - opacity.factor[0],)), Quantity((1.0, 1.0, 1.0))
        model = replace(
            model, alpha_mode="opaque", opacity=Quantity((1.0,)), transmission=through, transmission_tint=white,
            thin_walled=True, two_sided=True,
        )  # fmt: skip
    return model


def surface_unlit(shader: Shader, name: str) -> SurfaceModel:
    """A surface that only emits."""
    return SurfaceModel(name, unlit=True, base_color=shader.product("emission", "emission_color", "base_color"))


SURFACES: Mapping[str, Callable[[Shader, str], SurfaceModel]] = {
    "open_pbr_surface": open_pbr_surface,
    "standard_surface": standard_surface,
    "gltf_pbr": gltf_pbr,
    "UsdPreviewSurface": usd_preview_surface,
    "surface_unlit": surface_unlit,
}
"""Category of a shader node → its reader."""
