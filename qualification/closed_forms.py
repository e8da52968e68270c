"""Light transport in closed form, which the Monte Carlo reference is compared with.

Every function gives the reading of `transport`: π L / E, the outgoing radiance L over the irradiance E of a beam on a
plane that faces it, times π, so that a white Lambert surface which faces the light reads 1. Boundaries are matched:
nothing is refracted or reflected at them. Cosines are above 0, to at most 1.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_NODES = 256


def h_function(albedo: float, cosine: npt.ArrayLike) -> Array:
    """Chandrasekhar's H for isotropic scattering, of the cosine's shape; `albedo` from 0 to 1.

    Chandrasekhar, Radiative Transfer (1960), chapter V. H is solved by iterating the form of its integral equation
    that converges for every albedo,

        1 / H(μ) = √(1 − a) + a/2 ∫₀¹ μ′ H(μ′) / (μ + μ′) dμ′,

    on Gauss points of √μ, as H rises steeply at 0. Accurate to about 1e-9.
    """
    root, weight = _gauss(0.0, 1.0)
    nodes, weights = root * root, 2.0 * root * weight
    kernel = 0.5 * albedo * weights * nodes / (nodes[:, None] + nodes)
    escape = np.sqrt(1.0 - albedo)
    h = np.ones_like(nodes)
    for _ in range(10_000):
        # the mean of two iterates: at albedo 1 the plain iteration oscillates about its limit
        after = 0.5 * (h + 1.0 / (escape + kernel @ h))
        done = np.abs(after - h).max() < 1e-14
        h = after
        if done:
            break
    cosines = np.asarray(cosine, np.float64)
    integral = (weights * nodes * h / (cosines[..., None] + nodes)).sum(axis=-1)
    solved: Array = 1.0 / (escape + 0.5 * albedo * integral)
    return solved


def half_space(albedo: float, cosine_in: float, cosine_out: npt.ArrayLike) -> Array:
    """The light that a half-space with isotropic scattering reflects.

    Chandrasekhar's law of diffuse reflection, L = a / 4π · μ₀ / (μ + μ₀) · H(μ) H(μ₀) · E (Radiative Transfer, §34;
    there the beam carries π F, here E). The azimuth does not matter.
    """
    out = np.asarray(cosine_out, np.float64)
    both = h_function(albedo, out) * h_function(albedo, cosine_in)
    reading: Array = 0.25 * albedo * cosine_in / (out + cosine_in) * both
    return reading


def unscattered(depth: float, cosine: npt.ArrayLike) -> Array:
    """The part of a beam that crosses a slab of optical depth `depth` untouched: Beer and Lambert's exp(−τ / μ)."""
    part: Array = np.exp(-depth / np.asarray(cosine, np.float64))
    return part


def henyey_greenstein(anisotropy: float, cosine: npt.ArrayLike) -> Array:
    """The phase function per steradian, of the angle between the way in and the way out; cosine 1 is straight on.

    Henyey and Greenstein, Diffuse radiation in the galaxy (1941).
    """
    g = anisotropy
    along = np.asarray(cosine, np.float64)
    phase: Array = (1.0 - g * g) / (4.0 * np.pi * (1.0 + g * g - 2.0 * g * along) ** 1.5)
    return phase


def slab_once(depth: float, albedo: float, phase: float, cosine_in: float, cosine_out: float, back: bool) -> float:
    """The light that a slab of optical depth `depth` reflects (`back`) or transmits after one scattering.

    `phase` is the phase function's value per steradian for the two directions. From the integral along the ray:
    back  a p μ₀ / (μ + μ₀) · (1 − exp(−τ (1/μ + 1/μ₀))),  through  a p μ₀ / (μ₀ − μ) · (exp(−τ/μ₀) − exp(−τ/μ)),
    for equal cosines  a p τ/μ exp(−τ/μ); each times π, and E.
    """
    into, out = 1.0 / cosine_in, 1.0 / cosine_out
    if back:
        part = -np.expm1(-depth * (into + out)) * out / (into + out)
    elif np.isclose(into, out):
        part = depth * out * np.exp(-depth * out)
    else:
        part = out * (np.exp(-depth * into) - np.exp(-depth * out)) / (out - into)
    return float(np.pi * albedo * phase * part)


def ball_once(
    radius: float,
    absorption: float,
    scattering: float,
    anisotropy: float,
    light: npt.ArrayLike,
    origin: npt.ArrayLike,
    directions: npt.ArrayLike,
) -> Array:
    """The radiance of a ball at 0 after one scattering, (n,), along rays from `origin` (3,) with `directions` (n, 3).

    `light` is the unit direction towards the light. The integral  σs p ∫ exp(−σt (s + c(s))) ds  along the chord,
    where c is the way from the point to the ball's surface towards the light, on Gauss points. Rays that miss read 0.
    """
    start, along, sun = (np.asarray(vector, np.float64) for vector in (origin, directions, light))
    nearest = -along @ start
    foot = start + nearest[:, None] * along
    half = np.sqrt(np.maximum(radius**2 - np.einsum("nc,nc->n", foot, foot), 0.0))
    nodes, weights = _gauss(-1.0, 1.0)
    points = foot[:, None, :] + (half[:, None] * nodes)[..., None] * along[:, None, :]
    inward = points @ sun
    inside = np.maximum(radius**2 - np.einsum("nkc,nkc->nk", points, points), 0.0)
    to_light = np.sqrt(inward**2 + inside) - inward
    way = half[:, None] * (1.0 + nodes) + to_light
    total = half * (weights * np.exp(-(absorption + scattering) * way)).sum(axis=1)
    # the light travels along −sun, and on to the eye along −direction
    once: Array = np.pi * scattering * henyey_greenstein(anisotropy, along @ sun) * total
    return once


def _gauss(low: float, high: float) -> tuple[Array, Array]:
    """Gauss–Legendre points and weights between two limits."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * (high - low)
    return low + half * (nodes + 1.0), half * weights
