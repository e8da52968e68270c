"""The environment of plain shells: the split sum against an integral, and the energy in uniform light."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

WHITE = Texture(np.ones((6, 1, 1, 3)), dim="Cube")
BLACK = Texture(np.zeros((6, 1, 1, 3)), dim="Cube")
UP = np.array([0.0, 0.0, 1.0])


def lit(**values: Any) -> Array:
    surface = {"albedo": np.ones(3), "metallic": 0.0, "roughness": 0.5, "occlusion": 1.0, "N": UP, "V": UP}
    surface |= {"specular": 0.04, "clearcoat": 0.0, "clearcoat_roughness": 0.0}
    surface |= {"sheen_color": np.zeros(3), "sheen_roughness": 0.0}
    maps = {"irradiance_map": WHITE, "reflection_map": WHITE}
    result: Array = technique("prefiltered_environment")(**{**surface, **maps, **values})
    return result


def from_angle(cosine: float) -> Array:
    return np.array([np.sqrt(1.0 - cosine * cosine), 0.0, cosine])


def reflected(cosine: float, roughness: float, f0: float, count: int = 512) -> float:
    """The share of uniform light that GGX with Smith's masking and Schlick's Fresnel reflects towards the eye.

    Sampled evenly in the numbers from which GGX's half vectors follow (Karis 2013).
    """
    alpha = roughness * roughness
    u, v = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) / count)
    cos_half = np.sqrt((1.0 - v) / (1.0 + (alpha * alpha - 1.0) * v))
    sin_half = np.sqrt(1.0 - cos_half**2)
    half = np.stack([sin_half * np.cos(2.0 * np.pi * u), sin_half * np.sin(2.0 * np.pi * u), cos_half], axis=-1)
    eye = from_angle(cosine)
    towards = half @ eye
    light = 2.0 * towards * cos_half - cosine
    above = (light > 0.0) & (towards > 0.0)
    safe = np.where(above, light, 1.0)
    root_eye, root_light = (np.sqrt(alpha * alpha + (1.0 - alpha * alpha) * c * c) for c in (cosine, safe))
    visible = 2.0 * safe * cosine / (safe * root_eye + cosine * root_light)
    fresnel = f0 + (1.0 - f0) * (1.0 - np.clip(towards, 0.0, 1.0)) ** 5
    return float(np.where(above, fresnel * visible * towards / (cos_half * cosine), 0.0).mean())


@pytest.mark.parametrize("roughness", [0.1, 0.3, 0.6, 1.0])
def test_the_fit_is_near_the_integral(roughness: float) -> None:
    """As near as the technique's limits state: for dielectrics, and for metals."""
    for cosine in (0.15, 0.4, 0.7, 1.0):
        dielectric, metal = (
            lit(albedo=np.full(3, f0), metallic=1.0, roughness=roughness, V=from_angle(cosine))[0] for f0 in (0.04, 0.8)
        )
        assert abs(dielectric - reflected(cosine, roughness, 0.04)) < (0.09 if cosine < 0.7 else 0.035)
        assert abs(metal - reflected(cosine, roughness, 0.8)) < 0.21


def test_a_white_surface_in_white_light_is_white() -> None:
    """What is not mirrored is reflected diffusely: no light is lost or made, at any angle and roughness."""
    for roughness in (0.0, 0.3, 1.0):
        close(lit(N=UP, V=units(100), roughness=roughness), 1.0, atol=1e-12)


def test_metals_have_no_diffuse_light_and_occlusion_is_a_factor() -> None:
    close(lit(metallic=1.0, reflection_map=BLACK), 0.0)
    assert 0.9 < lit(metallic=1.0, roughness=0.0, albedo=np.ones(3))[0] <= 1.0
    close(lit(occlusion=0.25), 0.25 * lit())


def test_the_highlight_is_of_the_mirrored_direction_and_its_level() -> None:
    faces = np.zeros((6, 4, 4, 3))
    faces[0] = 1.0  # +x
    texture = Texture.of_levels([faces, np.full((6, 2, 2, 3), 0.5), np.zeros((6, 1, 1, 3))], dim="Cube", wrap="clamp")
    values = {"irradiance_map": BLACK, "reflection_map": texture, "reflection_levels": 2.0, "metallic": 1.0}
    right = lit(V=unit(np.array([-1.0, 0.0, 0.05])), roughness=0.0, **values)
    left = lit(V=unit(np.array([1.0, 0.0, 0.05])), roughness=0.0, **values)
    assert right[0] > 0.9 and left[0] == 0.0
    middle = [lit(roughness=rough, **values)[0] for rough in (0.0, 0.25, 0.5, 1.0)]
    assert middle[0] == 0.0 == middle[3] and 0.3 < middle[2] < 0.5 and 0.15 < middle[1] < 0.3


def test_a_normal_of_zero_is_finite() -> None:
    assert np.isfinite(lit(N=np.zeros(3), V=np.zeros(3))).all()


def test_a_clear_coat_mirrors_over_the_base() -> None:
    """KHR_materials_clearcoat: mix(base, coat, weight * F), F = 0.04 from the front."""
    bare, coated = lit(albedo=np.zeros(3), specular=0.0, roughness=1.0), 0.5 * 0.04
    close(lit(albedo=np.zeros(3), specular=0.0, roughness=1.0, clearcoat=0.5), (1.0 - coated) * bare + coated)


def test_the_reflectance_of_a_dielectric_is_that_of_the_surface() -> None:
    levels = [
        float(lit(albedo=np.zeros(3), roughness=0.1, specular=value)[..., 0].max()) for value in (0.02, 0.04, 0.08)
    ]
    assert levels[0] < levels[1] < levels[2]
    assert levels[2] - levels[1] == pytest.approx(2.0 * (levels[1] - levels[0]), rel=1e-6)


def test_what_reflects_nothing_is_no_mirror_from_the_side() -> None:
    values = {"albedo": np.zeros(3), "roughness": 0.1, "V": from_angle(0.02)}
    assert lit(specular=0.04, **values).max() > 0.5
    close(lit(specular=0.0, **values), 0.0)


def test_a_sheen_adds_its_light_and_takes_it_from_the_base() -> None:
    fibres = {"sheen_color": np.array([1.0, 0.0, 0.0]), "sheen_roughness": 0.5}
    V = from_angle(0.1)
    plain, sheen = lit(V=V), lit(V=V, **fibres)
    assert sheen[..., 1].max() < plain[..., 1].max()  # green is the base alone
    black = lit(V=V, albedo=np.zeros(3), specular=0.0, roughness=1.0, **fibres)
    assert black[..., 0].max() > black[..., 1].max() + 0.05
