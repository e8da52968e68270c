"""Published methods of subsurface light, compared with integrals and sums that are computed here by themselves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import UP, Array, close, rng, technique, units

COUNT = 100
V, N, L = units(COUNT, 1), units(COUNT, 2), units(COUNT, 3)
COLOR = np.array([0.9, 0.5, 0.2])
COSINE = (N * L).sum(axis=-1)

SKIN = {
    0.0064: (0.233, 0.455, 0.649), 0.0484: (0.1, 0.336, 0.344), 0.187: (0.118, 0.198, 0.0),
    0.567: (0.113, 0.007, 0.007), 1.99: (0.358, 0.004, 0.0), 7.41: (0.078, 0.0, 0.0),
}  # fmt: skip
"""d'Eon and Luebke's skin: variance in mm² → weights of the channels"""


def test_hdrp_is_burleys_profile_integrated_behind_a_slab() -> None:
    s, d = 1.0 / 0.13, 0.21
    points, weights = np.polynomial.legendre.leggauss(400)
    r = d + (points + 1.0) * 30.0 / s  # r² = rho² + d², so rho d(rho) = r dr
    profile = s * (np.exp(-s * r) + np.exp(-s * r / 3.0)) / (8.0 * np.pi * r)
    behind = (weights * 30.0 / s * 2.0 * np.pi * r * profile).sum()
    through = technique("hdrp_transmittance")
    straight = through(d=d, N=UP, L=-UP, scattering_distance=1.0 / s, transmission_tint=COLOR)
    wrap = np.sin(np.radians(15.0))
    close(straight, COLOR * behind * (1.0 + wrap) / (1.0 + wrap) ** 2, rtol=1e-6)
    turned = through(d=d, N=N, L=L, scattering_distance=1.0 / s, transmission_tint=COLOR)
    close(turned, straight * np.clip((wrap - COSINE) / (1.0 + wrap), 0.0, 1.0)[:, None], atol=1e-6)


def test_jimenez_is_the_sum_of_gaussians() -> None:
    d = rng().uniform(0.0, 0.5, COUNT)
    expected = np.sum([np.array(weight) * np.exp(-((7.0 * d[:, None]) ** 2) / v) for v, weight in SKIN.items()], axis=0)
    result = technique("skin_translucency")(d=d, N=N, L=L, millimetres_per_unit=7.0, subsurface_color=COLOR)
    close(result, COLOR * expected * np.maximum(0.3 - COSINE, 0.0)[:, None], atol=1e-12)


def over_the_sphere(name: str, **values: Any) -> tuple[Array, Array]:
    """The light that a white sheet returns and lets through, of light from all directions of one side."""
    points, weights = np.polynomial.legendre.leggauss(64)
    cosine, weight = (points + 1.0) / 2.0, weights
    directions = np.stack([np.sqrt(1.0 - cosine**2), cosine, 0.0 * cosine], axis=-1)
    sheet = technique(name)
    front, back = (sheet(N=UP, V=UP, L=directions * (1.0, side, 1.0), **values) for side in (1.0, -1.0))
    # the integral of the cosine over the hemisphere is pi, that of a lobe's value over it the light that leaves
    return (weight[:, None] * front).sum(axis=0), (weight[:, None] * back).sum(axis=0)


@pytest.mark.parametrize("g", [-1.0, 0.0, 0.3, 1.0])
def test_openpbrs_thin_wall_shares_the_light_out_by_its_anisotropy(g: float) -> None:
    values = {"subsurface_scatter_anisotropy": g, "subsurface_weight": 0.7, "subsurface_color": COLOR}
    reflected, transmitted = over_the_sphere("openpbr_thin_wall", **values)
    close(reflected, 0.7 * COLOR * (1.0 - g) / 2.0, atol=1e-12)
    close(transmitted, 0.7 * COLOR * (1.0 + g) / 2.0, atol=1e-12)


def test_gltfs_thin_wall_is_the_sheet_with_a_transmittance_of_1() -> None:
    values = {"diffuse_transmission_factor": 0.6, "diffuse_transmission_color": COLOR}
    reflected, transmitted = over_the_sphere("gltf_thin_wall", **values)
    close(reflected, 0.0, atol=1e-12)
    close(transmitted, 0.6 * COLOR, rtol=1e-12)
    sheet = technique("gltf_diffuse_transmission")(V=V, N=N, L=L, through=1.0, **values)
    close(technique("gltf_thin_wall")(V=V, N=N, L=L, **values), sheet, atol=1e-15)


def ring(cosine: Array, radius: float) -> Array:
    """Penner and Borshukov's integral on a ring of a radius in mm, by the midpoint rule: (n, 3)."""
    x = (np.arange(40000) + 0.5) / 40000 * 2.0 * np.pi - np.pi
    chord = 2.0 * radius * np.sin(x / 2.0)
    rings = [np.array(weight) / v * np.exp(-(chord**2) / (2.0 * v))[:, None] for v, weight in SKIN.items()]
    profile = np.sum(rings, axis=0)
    lit = np.maximum(np.cos(np.arccos(cosine)[:, None] + x), 0.0)
    blurred: Array = lit @ profile / profile.sum(axis=0)
    return blurred


@pytest.mark.parametrize("radius", [1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 40.0])
def test_preintegrated_skin_is_within_its_bound_of_the_integral(radius: float) -> None:
    cosine = np.linspace(-1.0, 1.0, 41)
    light = np.stack([np.sqrt(1.0 - cosine**2), cosine, 0.0 * cosine], axis=-1)
    result = technique("preintegrated_skin")(N=UP, L=light, mean_curvature=10.0 / radius, millimetres_per_unit=10.0)
    close(result, ring(cosine, radius), atol=0.008, rtol=0.0)


def test_preintegrated_skin_is_lambert_where_the_body_is_flat() -> None:
    result = technique("preintegrated_skin")(N=N, L=L, mean_curvature=0.0)
    close(result, np.repeat(np.maximum(COSINE, 0.0)[:, None], 3, axis=1), atol=1e-12)


# Translucent shadow maps

EXTINCTION, ALBEDO = np.array([4.0, 6.0, 9.0]), np.array([0.95, 0.8, 0.5])
FREE_PATH = 1.0 / EXTINCTION.mean()


def jensen(r: Array) -> Array:
    """The dipole's reflectance at distances (n,), with A = 1: (n, 3)."""
    depth = 1.0 / EXTINCTION
    diffusion = 1.0 / (3.0 * EXTINCTION)
    sigma = np.sqrt((1.0 - ALBEDO) * EXTINCTION / diffusion)
    total = np.zeros((len(r), 3))
    for z in (depth, depth + 4.0 * diffusion):
        d = np.sqrt(r[:, None] ** 2 + z**2)
        total += z * (sigma * d + 1.0) * np.exp(-sigma * d) / d**3
    return ALBEDO / (4.0 * np.pi) * total


def shadow_map(depths: Array, at: Array) -> Array:
    """The technique on a light's map of 4 units, whose plane is y = 1, seen from above."""
    matrix = np.array([[0.25, 0.0, 0.0, 0.5], [0.0, 0.0, 0.25, 0.5], [0.0, -1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]])
    result: Array = technique("translucent_shadow_map")(
        P=at, L=UP, light_depth_map=depths[..., None], light_matrix=matrix, extinction=EXTINCTION,
        scattering_albedo=ALBEDO, mean_free_path=FREE_PATH, pattern_width=2.0,
    )  # fmt: skip
    return result


def test_translucent_shadow_maps_on_a_plane_reflect_what_the_dipole_reflects() -> None:
    """The integral of the dipole over the plane is a / 2 (exp(-sigma z) + exp(-sigma z')) in closed form."""
    result = shadow_map(np.ones((8, 8)), np.zeros((1, 3)))[0]
    sigma = EXTINCTION * np.sqrt(3.0 * (1.0 - ALBEDO))
    exact = ALBEDO / 2.0 * (np.exp(-sigma / EXTINCTION) + np.exp(-sigma * 7.0 / 3.0 / EXTINCTION))
    close(result, exact, rtol=0.06)  # 16 taps for three profiles of different widths


def test_translucent_shadow_maps_behind_a_slab_gather_at_the_distance_in_space() -> None:
    depth = 0.4
    r = (np.arange(20000) + 0.5) / 20000 * 8.0
    exact = (2.0 * np.pi * r * 8.0 / 20000) @ jensen(np.hypot(r, depth))
    close(shadow_map(np.ones((8, 8)), np.array([[0.0, -depth, 0.0]]))[0], exact, rtol=0.1)


def test_translucent_shadow_maps_leave_out_empty_texels() -> None:
    assert not shadow_map(np.full((8, 8), 8.0), np.zeros((1, 3))).any()


# RTXCR


def rtxcr(at: Array, light: Array, **values: Any) -> Array:
    result: Array = technique("rtxcr_skin", body_distance="float half_space(world_position p) { return p.y; }")(
        P=at, N=UP, T=np.array([1.0, 0.0, 0.0]), B=np.array([0.0, 0.0, 1.0]), L=light,
        extinction=values.pop("extinction", EXTINCTION), scattering_albedo=ALBEDO, mean_free_path=FREE_PATH, **values,
    )  # fmt: skip
    return result


def test_rtxcr_on_a_half_space_is_the_profile_and_single_scattering() -> None:
    """Below the surface the light of one collision is A a / 2 (1 - ln 2), lit straight from above."""
    q = np.sqrt(1.0 - ALBEDO)
    diffuse = 0.88 * (1.0 - q) / (1.0 + 1.5535 * q)
    profile = diffuse - 0.266 * ALBEDO * (1.0 / 5.434 + 1.0 / 1.811)
    single = diffuse * ALBEDO / 2.0 * (1.0 - np.log(2.0))
    result = rtxcr(np.zeros((1, 3)), UP, samples=64)[0]
    close(result, np.maximum(profile + single, 0.0), atol=0.03)
    # the front light falls with the cosine
    slanted = rtxcr(np.zeros((1, 3)), np.array([0.6, 0.8, 0.0]), samples=64)[0]
    close(slanted, 0.8 * result, rtol=5e-3)
    close(rtxcr(np.zeros((1, 3)), -UP), 0.0, atol=1e-12)


def test_rtxcr_lets_light_through_a_slab() -> None:
    """The straight term through a slab is A^2 exp(-s d); what is scattered once adds to it."""
    q = np.sqrt(1.0 - ALBEDO)
    diffuse = 0.88 * (1.0 - q) / (1.0 + 1.5535 * q)
    slab = technique("rtxcr_skin", body_distance="float slab(world_position p) { return abs(p.y + 0.1) - 0.1; }")
    result = slab(
        P=np.zeros((1, 3)), N=UP, T=np.array([1.0, 0.0, 0.0]), B=np.array([0.0, 0.0, 1.0]), L=-UP,
        extinction=EXTINCTION, scattering_albedo=ALBEDO, mean_free_path=FREE_PATH, samples=64,
    )[0]  # fmt: skip
    straight = diffuse**2 * np.exp(-EXTINCTION * 0.2)
    # once: depth t along -n, then up or down with the cosine z: only those that leave below are lit
    t, z = np.meshgrid((np.arange(400) + 0.5) / 400 * 0.2, (np.arange(400) + 0.5) / 400)
    once = np.stack([
        diffuse[c] * ALBEDO[c] * s * (np.exp(-s * (t + (0.2 - t) / z)) * (0.2 / 400) / 400).sum() / 2.0
        for c, s in enumerate(EXTINCTION)
    ])  # fmt: skip
    close(result, straight + once, rtol=0.03)
