"""The Lit shaders of Unity's pipelines as records."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sssgen.interchange.diffusion_profile import DiffusionProfile, profile_of
from sssgen.interchange.surface_model import (
    AlphaMode,
    Image,
    Quantity,
    SurfaceModel,
    extinction_of_color,
    medium,
)
from sssgen.interchange.texels import mean_of
from sssgen.interchange.unity_material import UnityMaterial, constant
from sssgen.interchange.unity_project import guid_of_vector, hash_of_number

_WHITE = (1.0, 1.0, 1.0, 1.0)
_DETAIL = "detail maps"
_PARALLAX = "a height map"
_ANISOTROPIC = "anisotropic reflection"
_FILM = "interference in a thin film"
_METAL_REFLECTANCE = 0.25
"""A specular colour of more than this is a metal's."""
_INVERSION = "at most 0.006 of the light that a thick body reflects, and Burley's fit"


def _scale_texels(image: Image, low: float, high: float) -> Image:
    """An image whose texels 0 and 1 are two numbers."""
    return image._replace(scale=high - low, bias=low)


def _complement(image: Image | None, factor: float) -> Quantity:
    """One minus a factor times the texels of a picture, where there is one."""
    if image is None:
        return constant(1.0 - factor)
    return Quantity((1.0,), _scale_texels(image, 1.0, 1.0 - factor))


class _Surface:
    """What the shaders of URP and HDRP have in common: names of properties and how they are read."""

    def __init__(self, material: UnityMaterial, base_map: str, base_color: str) -> None:
        self.material, self.base_map = material, base_map
        self.transform = material.transform(base_map)
        self.base = material.color(base_color, _WHITE, "base_color")

    def image(self, name: str, channels: str, field: str, *, color: bool = False) -> Image | None:
        """A texture with the coordinates of the base colour."""
        return self.material.image(name, channels, field, self.transform, color=color)

    def base_quantity(self) -> Quantity:
        """The base colour."""
        return Quantity(self.base[:3], self.image(self.base_map, "rgb", "base_color", color=True))

    def alpha(self, field: str = "opacity") -> Quantity:
        """The alpha of the base colour."""
        return Quantity((self.base[3],), self.image(self.base_map, "a", field, color=True))

    def normal(self, name: str, scale: str) -> Quantity:
        """The normal map and its strength."""
        strength = self.material.number(scale, 1.0, "normal" if self.material.has_texture(name) else "")
        return Quantity((strength,), self.image(name, "rgb", "normal"))

    def with_specular_color(self, model: SurfaceModel, color: Quantity) -> SurfaceModel:
        """A record of the workflow with a specular colour: of a dielectric, or of a metal where it reflects much."""
        mean = mean_of(color)
        strongest = max(mean)
        if strongest > _METAL_REFLECTANCE:
            return replace(model, base_color=color, metalness=constant(1.0))
        root = np.sqrt(max(strongest, 1e-6))
        tint = Quantity(tuple(part / max(strongest, 1e-6) for part in color.factor), color.image)
        return replace(
            model, ior=float((1.0 + root) / (1.0 - root)), specular_color=tint if strongest > 0.0 else constant(0, 0, 0)
        )


def universal_lit(material: UnityMaterial) -> SurfaceModel:
    """URP's Lit, Complex Lit and Simple Lit; Standard of the built-in pipeline, whose properties have other names."""
    builtin = not material.has("_BaseMap") and material.has("_MainTex")
    surface = _Surface(material, *(("_MainTex", "_Color") if builtin else ("_BaseMap", "_BaseColor")))
    specular_workflow = material.number("_WorkflowMode", 1.0) == 0.0 or "_SPECULAR_SETUP" in material.keywords
    gloss_map = "_SpecGlossMap" if specular_workflow else "_MetallicGlossMap"
    two_sided = material.number("_Cull", 2.0, "two_sided") == 0.0
    alpha_mode, cutoff = _universal_alpha(material)
    model = SurfaceModel(
        material.name,
        two_sided=two_sided,
        alpha_mode=alpha_mode,
        alpha_cutoff=cutoff,
        base_color=surface.base_quantity(),
        opacity=constant(1.0) if alpha_mode == "opaque" else surface.alpha(),
        normal=surface.normal("_BumpMap", "_BumpScale"),
        normal_down=material.flips_green("_BumpMap"),
        roughness=_universal_roughness(material, surface, gloss_map),
    )
    occlusion = surface.image("_OcclusionMap", "g", "occlusion")
    if occlusion is not None:
        model = replace(
            model, occlusion=Quantity((material.number("_OcclusionStrength", 1.0, "occlusion"),), occlusion)
        )
    if "_EMISSION" in material.keywords:
        color = material.color("_EmissionColor", (0.0, 0.0, 0.0, 1.0), "emission", hdr=True)
        image = surface.image("_EmissionMap", "rgb", "emission", color=True)
        model = replace(model, emission=Quantity(color[:3], image))
    if specular_workflow:
        image = surface.image(gloss_map, "rgb", "specular_color", color=True)
        color = _WHITE if image is not None else material.color("_SpecColor", (0.2, 0.2, 0.2, 1.0), "specular_color")
        model = surface.with_specular_color(model, Quantity(color[:3], image))
    else:
        image = surface.image(gloss_map, "r", "metalness")
        factor = 1.0 if image is not None else material.number("_Metallic", 0.0, "metalness")
        model = replace(model, metalness=Quantity((factor,), image))
    if {"_CLEARCOAT", "_CLEARCOATMAP"} & material.keywords:
        model = _universal_coat(material, surface, model)
    material.report_omissions(
        {"_ParallaxMap": _PARALLAX, "_DetailAlbedoMap": _DETAIL, "_DetailNormalMap": _DETAIL, "_DetailMask": _DETAIL}
    )
    return model


def _universal_alpha(material: UnityMaterial) -> tuple[AlphaMode, float]:
    cutoff = material.number("_Cutoff", 0.5)
    if cutoff > 0.0 and (material.number("_AlphaClip", 0.0) or "_ALPHATEST_ON" in material.keywords):
        return "mask", material.number("_Cutoff", 0.5, "alpha_cutoff")
    transparent = material.number("_Surface", 0.0) or material.number("_Mode", 0.0) >= 2.0
    return "blend" if transparent else "opaque", cutoff


def _universal_roughness(material: UnityMaterial, surface: _Surface, gloss_map: str) -> Quantity:
    """One minus the smoothness, which is in the alpha of the gloss map or of the base colour."""
    from_base = material.number("_SmoothnessTextureChannel", 0.0) == 1.0
    name = surface.base_map if from_base else gloss_map
    image = surface.image(name, "a", "roughness", color=from_base)
    builtin = not material.has("_Smoothness") and material.has("_Glossiness")
    property_ = "_Smoothness" if not builtin else "_Glossiness" if image is None else "_GlossMapScale"
    smoothness = material.number(property_, 0.5, "roughness")
    return _complement(image, smoothness)


def _universal_coat(material: UnityMaterial, surface: _Surface, model: SurfaceModel) -> SurfaceModel:
    weight = surface.image("_ClearCoatMap", "r", "coat")
    smooth = surface.image("_ClearCoatMap", "g", "coat_roughness")
    smoothness = material.number("_ClearCoatSmoothness", 0.0, "coat_roughness")
    return replace(
        model,
        coat=Quantity((material.number("_ClearCoatMask", 0.0, "coat"),), weight),
        coat_roughness=_complement(smooth, smoothness),
    )


def unlit(material: UnityMaterial) -> SurfaceModel:
    """The Unlit shaders of URP and HDRP."""
    names = ("_UnlitColorMap", "_UnlitColor") if material.has("_UnlitColor") else ("_BaseMap", "_BaseColor")
    surface = _Surface(material, *names)
    alpha_mode, cutoff = _universal_alpha(material)
    return SurfaceModel(
        material.name,
        unlit=True,
        alpha_mode=alpha_mode,
        alpha_cutoff=cutoff,
        base_color=surface.base_quantity(),
        opacity=constant(1.0) if alpha_mode == "opaque" else surface.alpha(),
    )


# HDRP

_SUBSURFACE, _SPECULAR_COLOR, _TRANSLUCENT = 0, 4, 5
"""Values of `_MaterialID`; 1 is the standard, 2 anisotropic, 3 iridescent."""
_NO_REFRACTION, _THIN_REFRACTION = 0, 3
"""Values of `_RefractionModel`; 1 is a box, 2 a ball."""
_COAT_ROUGHNESS = 0.1
"""Of HDRP's coat, which is fixed."""
_HD_LEFT_OUT = {
    "_HeightMap": _PARALLAX,
    "_DetailMap": _DETAIL,
    "_BentNormalMap": "bent normals",
    "_TangentMap": _ANISOTROPIC,
    "_NormalMapOS": "normals in object space",
    "_TransmittanceColorMap": "the colour of a refracting body is a constant",
}


def high_definition_lit(material: UnityMaterial) -> SurfaceModel:
    """HDRP's Lit."""
    surface = _Surface(material, "_BaseColorMap", "_BaseColor")
    kind = round(material.number("_MaterialID", 1.0))
    transparent = material.number("_SurfaceType", 0.0) == 1.0
    refraction = round(material.number("_RefractionModel", 0.0)) if transparent else _NO_REFRACTION
    cutoff = material.number("_AlphaCutoffEnable", 0.0) > 0.0 and material.number("_AlphaCutoff", 0.5) > 0.0
    alpha_mode: AlphaMode = "mask" if cutoff else "blend" if transparent and not refraction else "opaque"
    model = SurfaceModel(
        material.name,
        two_sided=material.number("_DoubleSidedEnable", 0.0, "two_sided") > 0.0,
        alpha_mode=alpha_mode,
        alpha_cutoff=material.number("_AlphaCutoff", 0.5, "alpha_cutoff" if cutoff else ""),
        base_color=surface.base_quantity(),
        opacity=constant(1.0) if alpha_mode == "opaque" else surface.alpha(),
        normal=surface.normal("_NormalMap", "_NormalScale"),
        normal_down=material.flips_green("_NormalMap"),
    )
    model = _read_mask_map(material, surface, model)
    emission = material.color("_EmissiveColor", (0.0, 0.0, 0.0, 1.0), "emission", hdr=True)
    if any(emission[:3]):
        image = surface.image("_EmissiveColorMap", "rgb", "emission", color=True)
        model = replace(model, emission=Quantity(emission[:3], image))
        material.report_approximation("_EmissiveColor", emission[:3], "linear radiance: HDRP's exposure is not applied")
    if coat := material.number("_CoatMask", 0.0, "coat"):
        image = surface.image("_CoatMaskMap", "r", "coat")
        model = replace(model, coat=Quantity((coat,), image), coat_roughness=constant(_COAT_ROUGHNESS))
    if kind == _SPECULAR_COLOR:
        color = material.color("_SpecularColor", _WHITE, "specular_color")
        image = surface.image("_SpecularColorMap", "rgb", "specular_color", color=True)
        model = surface.with_specular_color(model, Quantity(color[:3], image))
    if kind in (_SUBSURFACE, _TRANSLUCENT):
        model = _add_scattering(material, surface, model, kind)
    if refraction:
        model = _add_refraction(material, surface, model, thin=refraction == _THIN_REFRACTION)
    left_out = dict(_HD_LEFT_OUT)
    if kind == 2:
        left_out["_Anisotropy"] = _ANISOTROPIC
    if kind == 3:
        left_out["_IridescenceMask"] = _FILM
    material.report_omissions(left_out)
    return model


def _read_mask_map(material: UnityMaterial, surface: _Surface, model: SurfaceModel) -> SurfaceModel:
    """Metalness, occlusion and smoothness: the red, green and alpha of the mask map, each in its range."""
    metal = surface.image("_MaskMap", "r", "metalness")
    occlusion = surface.image("_MaskMap", "g", "occlusion")
    smooth = surface.image("_MaskMap", "a", "roughness")
    if metal is None or occlusion is None or smooth is None:
        return replace(
            model,
            metalness=constant(material.number("_Metallic", 0.0, "metalness")),
            roughness=constant(1.0 - material.number("_Smoothness", 0.5, "roughness")),
        )

    def ends(name: str, field: str) -> tuple[float, float]:
        return material.number(f"{name}Min", 0.0, field), material.number(f"{name}Max", 1.0, field)

    low, high = ends("_SmoothnessRemap", "roughness")
    return replace(
        model,
        metalness=Quantity((1.0,), _scale_texels(metal, *ends("_MetallicRemap", "metalness"))),
        occlusion=Quantity((1.0,), _scale_texels(occlusion, *ends("_AORemap", "occlusion"))),
        roughness=Quantity((1.0,), _scale_texels(smooth, 1.0 - low, 1.0 - high)),
    )


def _thickness(material: UnityMaterial, surface: _Surface, ends: tuple[float, float]) -> Quantity:
    """The thickness in metres, where `ends` are those of the stored values 0 and 1."""
    image = surface.image("_ThicknessMap", "r", "thickness")
    low, high = ends
    if image is None:
        return constant(low + (high - low) * material.number("_Thickness", 1.0, "thickness"))
    first, span, *_ = material.vector("_ThicknessRemap", (0.0, 1.0, 0.0, 0.0), "thickness")
    start, end = low + (high - low) * first, low + (high - low) * (first + span)
    largest = max(abs(start), abs(end)) or 1.0
    return Quantity((largest,), _scale_texels(image, start / largest, end / largest))


def _add_scattering(material: UnityMaterial, surface: _Surface, model: SurfaceModel, kind: int) -> SurfaceModel:
    """Scattering below the surface as the material's diffusion profile has it."""
    asset = guid_of_vector(material.vector("_DiffusionProfileAsset", (0.0,) * 4))
    stored_hash = hash_of_number(material.number("_DiffusionProfileHash", 0.0))
    profile = profile_of(material.project, asset, stored_hash)
    if profile is None:
        if asset or stored_hash:
            reason = "no diffusion profile of the project has this GUID or hash; light is not scattered"
            material.report.add_omission(f"{material.name}/_DiffusionProfileAsset", asset or stored_hash, reason)
        return model
    albedo = mean_of(model.base_color)
    thickness = _thickness(material, surface, profile.thickness)
    model = replace(model, ior=profile.ior)
    transmits = material.number("_TransmissionEnable", 1.0) > 0.0
    if profile.thin and transmits:
        return _sheet(material, model, profile, mean_of(thickness)[0])
    mask = surface.image("_SubsurfaceMaskMap", "r", "subsurface")
    weight = material.number("_SubsurfaceMask", 1.0, "subsurface") if kind == _SUBSURFACE else 1.0
    interior = profile.interior(albedo)
    numbers = ", ".join(f"{1e3 * part:.3g}" for part in profile.distance)
    material.report_approximation(
        "_DiffusionProfileAsset", profile.name,
        f"a medium for the scattering distances {numbers} mm and the mean base colour", _INVERSION,
    )  # fmt: skip
    return replace(model, subsurface=Quantity((weight,), mask), interior=interior, thickness=thickness)


def _sheet(material: UnityMaterial, model: SurfaceModel, profile: DiffusionProfile, thickness: float) -> SurfaceModel:
    """A thin object: HDRP adds the transmitted light, base colour times transmittance, to the reflected light.

    The record's sheet transmits the share f of its colour and reflects 1 - f of the base colour; f is the largest for
    which neither is more than 1.
    """
    transmittance = profile.transmittance(thickness)
    base = mean_of(model.base_color)
    reflected, through = max(base), max(t * b for t, b in zip(transmittance, base, strict=True))
    share = through / max(reflected + through, 1e-6)
    kept = 1.0 - share
    color = tuple(t / max(share, 1e-6) for t in transmittance)
    numbers = ", ".join(f"{part:.3g}" for part in transmittance)
    material.report_approximation(
        "_DiffusionProfileAsset", profile.name,
        f"a sheet that transmits {numbers} of the base colour: the profile at {1e3 * thickness:.3g} mm",
    )  # fmt: skip
    times = tuple(part / kept for part in model.base_color.factor)
    product = tuple(a * b for a, b in zip(model.base_color.factor, color, strict=True))
    return replace(
        model,
        thin_walled=True,
        two_sided=True,
        diffuse_transmission=constant(share),
        diffuse_transmission_color=Quantity(product, model.base_color.image),
        base_color=Quantity(times, model.base_color.image),
    )


def _add_refraction(material: UnityMaterial, surface: _Surface, model: SurfaceModel, *, thin: bool) -> SurfaceModel:
    """A refracting body: its transparency is one minus the alpha; the light in it fades to the transmittance colour."""
    alpha = surface.alpha("transmission")
    share = _complement(alpha.image, alpha.factor[0])
    color = material.color("_TransmittanceColor", _WHITE, "transmission_tint" if thin else "interior")[:3]
    model = replace(
        model,
        transmission=share,
        ior=max(material.number("_Ior", 1.5, "ior"), 1.0),
        transmission_tint=constant(*(color if thin else (1.0, 1.0, 1.0))),
        thin_walled=thin,
    )
    if thin:
        return model
    distance = material.number("_ATDistance", 1.0, "interior")
    interior = medium(extinction_of_color(color, distance), (0.0, 0.0, 0.0))
    return replace(model, interior=interior, thickness=_thickness(material, surface, (0.0, 1.0)))
