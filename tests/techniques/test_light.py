"""Lobes of translucency, lighting and output, compared with formulas in NumPy and published facts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from oracle import UP, Array, close, rng, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

COUNT = 200
V, N, L = units(COUNT, 1), units(COUNT, 2), units(COUNT, 3)
THROUGH = rng().uniform(0.0, 1.0, COUNT)
COLOR = np.array([0.9, 0.5, 0.2])
HALF = Texture(np.full((1, 1, 4), 0.5))


def dot(a: Array, b: Array) -> Array:
    product: Array = (a * b).sum(axis=-1)
    return product


# Lobes

CONTROLS = {
    "distortion": 0.35,
    "power": 5.0,
    "scale": 3.0,
    "ambient": 0.15,
    "attenuation": 0.7,
    "subsurface_color": COLOR,
}


def glow(lobe: Array) -> Array:
    return COLOR * (0.7 * (3.0 * lobe + 0.15) * THROUGH)[:, None]


def half_vector(distortion: float = 0.35) -> Array:
    return L + N * distortion


def front(cosine: Array) -> Array:
    return np.clip(cosine, 0.0, 1.0)


LOBES: dict[str, tuple[dict[str, Any], Callable[[], Array]]] = {
    "lobe_gdc2011": (
        {"V": V, "N": N, "L": L, "through": THROUGH, **CONTROLS},
        lambda: glow(front(dot(V, -half_vector())) ** 5),
    ),
    "lobe_exp2": (
        {"V": V, "N": N, "L": L, "through": THROUGH, **CONTROLS},
        lambda: glow(2.0 ** (5.0 * front(dot(V, -half_vector())) - 5.0)),
    ),
    "lobe_normalized": (
        {"V": V, "N": N, "L": L, "through": THROUGH, **CONTROLS},
        lambda: glow(front(dot(V, -unit(half_vector()))) ** 5),
    ),
    "ice_shader_lobe": (
        {"N": N, "L": L, "through": THROUGH, **CONTROLS},
        lambda: glow(np.zeros(COUNT)),  # the lobe is 0 everywhere, so only constant ambient light remains
    ),
    "three_js_port": (
        {"V": V, "N": N, "L": L, "through": THROUGH, "thickness_color": COLOR, "thickness_ambient": 0.2},
        lambda: (
            COLOR * ((10.0 * front(dot(V, -unit(half_vector(0.1)))) ** 2 + 0.2) * 0.1 * THROUGH)[:, None]
        ),
    ),
    "alisavakis_lobe": (
        {
            "V": V, "N": N, "L": L, "d": THROUGH,
            "distortion": 0.35, "concentration": 4.0, "scale": 2.0, "sss_color": COLOR,
        },
        lambda: COLOR * (2.0 * front(dot(V, -unit(half_vector()))) ** 4 * (1.0 - THROUGH))[:, None],
    ),
    "lobe_henyey_greenstein": (
        {"V": V, "L": L, "through": THROUGH, "anisotropy": 0.6, "weight": 0.8, "subsurface_color": COLOR},
        lambda: COLOR * (0.8 * THROUGH * 0.64 / (1.36 - 1.2 * -dot(V, L)) ** 1.5)[:, None],
    ),
    "wrap_lighting": (
        {"N": N, "L": L, "wrap": 0.3, "subsurface_color": COLOR},
        lambda: COLOR * (np.maximum((dot(N, L) + 0.3) / 1.3, 0.0) - np.maximum(dot(N, L), 0.0))[:, None],
    ),
    "gltf_diffuse_transmission": (
        {
            "V": V, "N": N, "L": L, "through": THROUGH,
            "diffuse_transmission_factor": 0.6, "diffuse_transmission_color": COLOR,
        },
        lambda: COLOR * (0.6 * np.maximum(-np.sign(dot(N, V)) * dot(N, L), 0.0) * THROUGH)[:, None],
    ),
    "diffuse_transmission_map": (
        {
            "uv": np.zeros((COUNT, 2)), "d": THROUGH, "V": V, "N": N, "L": L,
            "diffuse_transmission_tint": COLOR, "diffuse_transmission_texture": HALF, "extinction": (1.0, 2.0, 3.0),
        },
        lambda: 0.5
        * COLOR
        * np.exp(-np.outer(THROUGH, (1.0, 2.0, 3.0)))
        * np.maximum(-np.sign(dot(N, V)) * dot(N, L), 0.0)[:, None],
    ),
    "seen_through": (
        {
            "uv": np.zeros((COUNT, 2)), "d": THROUGH, "V": V, "N": N, "ior": 1.0,
            "entering_color": COLOR, "entering_texture": HALF, "extinction": (1.0, 2.0, 3.0),
            "sky_below": (0.0, 0.0, 0.0), "sky_above": (1.0, 1.0, 1.0),
        },
        lambda: 0.5
        * COLOR
        * np.exp(-np.outer(THROUGH, (1.0, 2.0, 3.0)))
        * (0.5 - 0.5 * V[:, 1:2])
        * (1.0 - (1.0 - np.abs(dot(N, V))) ** 5)[:, None],
    ),
    "seen_through_body": (
        {
            "uv": np.zeros((COUNT, 2)), "d": THROUGH, "V": V, "N": N, "ior": 1.0,
            "entering_color": COLOR, "entering_texture": HALF, "extinction": (1.0, 2.0, 3.0),
            "sky_below": (1.0, 1.0, 1.0), "sky_above": (1.0, 1.0, 1.0),
        },
        lambda: 0.5
        * COLOR
        * np.exp(-np.outer(THROUGH, (1.0, 2.0, 3.0)))
        * (1.0 - (1.0 - np.abs(dot(N, V))) ** 5)[:, None],
    ),
    "base_color_alone": (
        {"albedo": np.outer(THROUGH, COLOR), "emission": COLOR},
        lambda: np.outer(THROUGH, COLOR) + COLOR,
    ),
    "sky_glow": (
        {"V": V, "th": THROUGH, "glow_strength": 0.5, "sky_color": COLOR},
        lambda: 0.5 * THROUGH[:, None] * (COLOR + (1.0 - COLOR) * front(5.0 * V[:, 1:2])),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LOBES)
def test_lobes(name: str) -> None:
    values, expected = LOBES[name]
    close(technique(name)(**values), expected(), atol=1e-14)


@pytest.mark.parametrize("distortion", [0.0, 0.2, 0.99])
def test_the_published_seed_3_is_constant_ambient(distortion: float) -> None:
    values = {"ambient": 0.3, "attenuation": 0.5, "scale": 20.0, "distortion": distortion}
    result = technique("ice_shader_lobe")(N=N, L=L, through=0.5, **values)
    close(result, 0.075, rtol=1e-14)


def test_the_three_js_port_is_lobe_normalized() -> None:
    own = {"distortion": 0.1, "ambient": 0.0, "attenuation": 0.1, "power": 2.0, "scale": 10.0}
    port = technique("three_js_port")(V=V, N=N, L=L, through=THROUGH)
    close(port, technique("lobe_normalized")(V=V, N=N, L=L, through=THROUGH, **own), atol=1e-15)


def test_the_published_seed_1_is_dark_by_default() -> None:
    assert not technique("alisavakis_lobe")(V=V, N=N, L=L, d=0.5).any()


@pytest.mark.parametrize("g", [-0.95, -0.3, 0.0, 0.6, 0.9])
def test_the_phase_function_integrates_to_1_and_has_mean_cosine_g(g: float) -> None:
    """Integrates over the sphere by Gaussian quadrature in the cosine of the scattering angle."""
    cosine, weight = np.polynomial.legendre.leggauss(400)
    out = np.stack([np.sqrt(1.0 - cosine**2), 0 * cosine, cosine], axis=1)
    lobe = technique("lobe_henyey_greenstein")(V=out, L=np.array([0.0, 0.0, -1.0]), through=1.0, anisotropy=g)[:, 0]
    close((weight * lobe).sum() / 2.0, 1.0, rtol=1e-6)
    close((weight * lobe * cosine).sum() / 2.0, g, atol=1e-6)


def test_the_notes_on_exp2_are_correct() -> None:
    """The minimum is 2^-power; with 1.44 power + 1.44 the lobe transmits as much light as pow, within 2 %."""
    values = {"scale": 1.0, "ambient": 0.0, "distortion": 0.0, "through": 1.0, "N": UP}
    close(technique("lobe_exp2")(V=UP, L=UP, power=6.0, **values), 2.0**-6)
    cosine, weight = np.polynomial.legendre.leggauss(200)
    cosine, weight = (cosine + 1.0) / 2.0, weight / 2.0
    out = np.stack([np.sqrt(1.0 - cosine**2), cosine, 0 * cosine], axis=1)
    for power in (4.0, 8.0, 12.0):
        exact = (weight * technique("lobe_gdc2011")(V=out, L=-UP, power=power, **values)[:, 0]).sum()
        cheap = (weight * technique("lobe_exp2")(V=out, L=-UP, power=1.4427 * (power + 1), **values)[:, 0]).sum()
        close(exact, 1.0 / (power + 1.0), rtol=1e-9)
        close(cheap, exact, rtol=0.02)


def test_the_notes_on_gdc_2011_are_correct() -> None:
    """Opposite the light the peak is (1 - distortion dot(n, v))^power."""
    facing = N * np.sign(dot(N, V))[:, None]
    values = {"scale": 1.0, "ambient": 0.0, "power": 6.0, "distortion": 0.3}
    result = technique("lobe_gdc2011")(V=V, N=facing, L=-V, through=1.0, **values)
    close(result[:, 0], (1.0 - 0.3 * dot(facing, V)) ** 6)


# Absorption


def test_absorption_by_colour() -> None:
    d = rng().uniform(0.0, 2.0, 50)
    body = {"attenuation_color": COLOR, "attenuation_distance": 0.3}
    expected = 0.5 * COLOR ** (d[:, None] / 0.3)
    close(technique("absorption_tint")(d=d, weight=0.5, **body), expected, rtol=1e-12)
    close(technique("gltf_volume")(d=d, **body), 2.0 * expected, rtol=1e-12)
    close(technique("gltf_volume")(d=0.3, transmission_factor=0.25, **body), COLOR / 4)


@pytest.mark.parametrize(
    ("d", "distance", "color", "expected"),
    [
        (0.0, 0.3, (0.0, 0.5, 1.0), (1.0, 1.0, 1.0)),  # T(0) = 1, also for a component of 0 (three.js #23448)
        (0.3, 0.3, (0.0, 0.5, 1.0), (1e-4, 0.5, 1.0)),
        (-1.0, 0.3, (0.0, 0.5, 1.0), (1.0, 1.0, 1.0)),
        (0.0, 0.0, (0.0, 0.5, 0.99), (1.0, 1.0, 1.0)),
        (0.1, 0.0, (0.0, 0.5, 0.99), (0.0, 0.0, 0.0)),  # an attenuation distance of 0: opaque
        (100.0, 1.0, (0.0, 0.99, 1.0), (0.0, 0.99**100, 1.0)),  # a nearly clear colour at 100 attenuation distances
    ],
)
def test_limits_of_absorption(d: float, distance: float, color: Any, expected: Any) -> None:
    result = technique("absorption_tint")(d=d, attenuation_color=color, attenuation_distance=distance, weight=1.0)
    close(result, expected, rtol=1e-9, atol=1e-30)


# Lighting


def own_standard(albedo: Array, metallic: Array, roughness: Array, reflected: Any = 0.04) -> Array:
    """Cook and Torrance's f_r times pi and the cosine, with D, G and F of the papers."""
    h = unit(V + L)
    nl, nv, nh, vh = dot(N, L), dot(N, V), dot(N, h), dot(V, h)
    a = np.maximum(roughness, 0.045) ** 2
    ndf = a**2 / (np.pi * (nh**2 * (a**2 - 1.0) + 1.0) ** 2)
    masking = 2.0 * nl * nv / ((1.0 - a) * 2.0 * nl * nv + a * (nl + nv))
    f0 = (reflected * (1.0 - metallic))[:, None] + albedo * metallic[:, None]
    f90 = np.clip(51.0 * f0.mean(axis=1), metallic, 1.0)[:, None]
    fresnel = f0 + (f90 - f0) * ((1.0 - vh) ** 5)[:, None]
    specular = fresnel * (ndf * masking / (4.0 * nl * nv))[:, None]
    diffuse = (1.0 - fresnel) * (1.0 - metallic)[:, None] * albedo / np.pi
    lit = (np.pi * nl)[:, None] * (diffuse + specular)
    return np.where(((nl > 0.0) & (nv > 0.0))[:, None], lit, 0.0)


NO_SHEEN = {"sheen_color": (0.0, 0.0, 0.0), "sheen_roughness": 0.0}
BARE = {"specular": 0.04, "clearcoat": 0.0, "clearcoat_roughness": 0.0, **NO_SHEEN}
"""The usual reflection of a dielectric, without a coat and a sheen."""


def test_standard_light() -> None:
    albedo, metallic, roughness = rng().uniform(size=(COUNT, 3)), rng(1).uniform(size=COUNT), rng(2).uniform(size=COUNT)
    roughness[:20] *= 0.05  # some values are below the minimum
    values = {"albedo": albedo, "metallic": metallic, "roughness": roughness, "light_color": COLOR, **BARE}
    result = technique("standard")(N=N, V=V, L=L, **values)
    visible = dot(N, V) > 0.0
    assert (result[visible].max(axis=1) > 0.01).sum() > 20
    close(result[visible], (own_standard(albedo, metallic, roughness) * COLOR)[visible], rtol=1e-9, atol=1e-12)
    assert not result[dot(N, L) <= 0.0].any()


@pytest.mark.parametrize("specular", [0.0, 0.01, 0.02])
def test_what_reflects_little_from_the_front_is_no_mirror_from_the_side(specular: float) -> None:
    side = unit(np.array([[1.0, 0.0, 0.02]]))
    values = {"N": np.array([[0.0, 0.0, 1.0]]), "V": side, "L": side * [-1.0, 1.0, 1.0], "light_color": np.ones(3)}
    layers = {**BARE, "specular": specular, "albedo": np.zeros(3), "metallic": 0.0, "roughness": 0.3}
    usual = technique("standard")(**values, **layers | {"specular": 0.02})
    close(technique("standard")(**values, **layers), usual * specular / 0.02, rtol=0.03, atol=1e-12)


def test_standard_light_under_a_clear_coat() -> None:
    """KHR_materials_clearcoat: mix(base, coat, weight * F), with a coat of F0 = 0.04 and its own roughness."""
    albedo, metallic, roughness = rng().uniform(size=(COUNT, 3)), rng(1).uniform(size=COUNT), rng(2).uniform(size=COUNT)
    reflected, weight, rough = rng(3).uniform(size=COUNT), rng(4).uniform(size=COUNT), rng(5).uniform(size=COUNT)
    weight[:5] = 0.0
    values = {"albedo": albedo, "metallic": metallic, "roughness": roughness, "light_color": COLOR}
    layers = {"specular": reflected, "clearcoat": weight, "clearcoat_roughness": rough, **NO_SHEEN}
    result = technique("standard")(N=N, V=V, L=L, **values, **layers)
    h = unit(V + L)
    share = (weight * (0.04 + 0.96 * (1.0 - dot(V, h)) ** 5))[:, None]
    # a black surface of no metal that reflects everything has the highlight alone
    black = np.zeros((COUNT, 3))
    coat = own_standard(black, np.zeros(COUNT), rough, 1.0)
    expected = (1.0 - share) * own_standard(albedo, metallic, roughness, reflected) + share * coat
    visible = dot(N, V) > 0.0
    close(result[visible], (expected * COLOR)[visible], rtol=1e-9, atol=1e-12)
    assert (np.abs(expected - own_standard(albedo, metallic, roughness, reflected)).max(axis=1) > 1e-3).sum() > 20


def test_standard_light_is_reciprocal_and_reads_1_on_white() -> None:
    above = {"N": UP, "albedo": COLOR, "metallic": 0.3, "roughness": 0.4, "light_color": np.ones(3), **BARE}
    v, light = (unit(np.abs(vectors) + 0.1 * UP) for vectors in (V, L))
    forward, backward = technique("standard")(V=v, L=light, **above), technique("standard")(V=light, L=v, **above)
    close(forward / light[:, 1:2], backward / v[:, 1:2], rtol=1e-9)
    white = {**above, "albedo": np.ones(3), "metallic": 0.0, "roughness": 1.0}
    straight = technique("standard")(V=UP, L=UP, **white)
    close(straight, 0.96 + 0.04 / 4.0)  # Lambert minus 4 % (Schlick), plus a highlight with D = 1 / pi, G = 1


def sky(direction: Array) -> Array:
    return COLOR + (1.0 - COLOR) * np.clip(5.0 * direction[..., 1:2], 0.0, 1.0)


def test_sky_background() -> None:
    close(technique("sky_background")(ray_direction=V, sky_color=COLOR), sky(V))


def own_shadow(p: Array, light: Array, sharpness: float, distance: Callable[[Array], float]) -> float:
    t, free = 0.001, 1.0
    for _ in range(25):
        gap = distance(p + light * t)
        free = min(free, sharpness * gap / t)
        if free <= 0.0:
            break
        t += min(max(gap, 0.001), 2.0)
    return min(max(free, 0.0), 1.0)


def to_ball(p: Array) -> float:
    return float(np.linalg.norm(p)) - 1.0


def test_soft_shadow_of_a_ball() -> None:
    """The shadow is black in the middle, 0 far away, monotonic, and its rim is wider if it is less sharp."""
    at = np.stack([np.linspace(0.0, 3.0, 40), np.full(40, -3.0), np.zeros(40)], axis=1)
    shadow = technique("lighting/studio.sss:soft_shadow", scene_distance="sphere")
    hard, soft = (shadow(p=at, L=UP, shadow_sharpness=sharpness) for sharpness in (20.0, 4.0))
    for sharpness, result in ((20.0, hard), (4.0, soft)):
        expected = [own_shadow(p, UP, sharpness, to_ball) for p in at]
        close(result, expected, atol=1e-12)
        assert not result[at[:, 0] < 0.99].any() and (np.diff(result) >= -0.02).all() and result[-1] == 1.0
    assert (soft <= hard).all()
    assert ((soft > 0.0) & (soft < 1.0)).sum() > ((hard > 0.0) & (hard < 1.0)).sum() > 0


def test_studio() -> None:
    at = rng().uniform(-2.0, 2.0, (40, 3)) * [1.0, 0.0, 1.0] + [0.0, -1.6, 0.0]
    n, albedo, through = units(40), rng(1).uniform(size=(40, 3)), rng(2).uniform(size=(40, 3))
    key = unit([0.5, 2.0, -1.0])
    shadow = [own_shadow(p + 0.001 * m, key, 20.0, to_ball) for p, m in zip(at, n, strict=True)]
    assert 5 < np.count_nonzero(shadow) < 40
    behind = np.maximum(-(n[:, 0] * key[0] + n[:, 2] * key[2]), 0.0)
    expected = np.array(
        [
            np.array([0.2, 0.2, 0.2]) * s
            + np.array([0.82, 0.8, 0.82]) * s * max(float(m @ key), 0.0)
            + np.array([0.26, 0.32, 0.334]) * (0.2 + 0.8 * max(m[1], 0.0))
            + np.array([0.3, 0.21, 0.23]) * (0.2 + 0.8 * max(-m[1], 0.0))
            + np.array([0.2, 0.21, 0.23]) * b
            for m, s, b in zip(n, shadow, behind, strict=True)
        ]
    )
    studio = technique("studio", scene_distance="sphere")
    result = studio(P=at, N=n, albedo=albedo, translucency=through, key_direction=(0.5, 2.0, -1.0))
    close(result, albedo * (expected + through), atol=1e-12)


# Output


def test_srgb_curve() -> None:
    """IEC 61966-2-1: values of the standard, continuity at the end of the linear part, the inverse of the standard."""
    encode = technique("srgb")
    table = [(0.0, 0.0), (-1.0, 0.0), (1.0, 1.0), (0.0031308, 0.04044994), (0.21404114, 0.5), (0.001, 0.01292)]
    linear, expected = np.array(table).T
    close(encode(color=np.stack([linear] * 3, axis=1))[:, 1], expected, atol=1e-7)
    joint = encode(color=np.array([0.0031308, 0.0031308 + 1e-9, 0.0]))
    close(joint[1], joint[0], atol=1e-6)
    light = rng().uniform(size=(300, 3))
    code = encode(color=light)
    close(np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4), light, atol=1e-7)


def test_gamma() -> None:
    light = rng().uniform(size=(50, 3))
    close(technique("gamma")(color=light), light ** (1.0 / 2.2))
    close(technique("gamma")(color=light, display_gamma=1.8) ** 1.8, light)
    assert not technique("gamma")(color=-light).any()
