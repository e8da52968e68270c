"""The surface between a body and its surroundings: reflection and refraction of light, smooth or rough.

A rough surface has the facets of GGX (Walter, Marschner, Li and Torrance, Microfacet Models for Refraction through
Rough Surfaces, 2007), with alpha = roughness². Light that does not escape from a facet meets the next one, as in Heitz,
Hanika, d'Eon and Dachsbacher, Multiple-Scattering Microfacet BSDFs with the Smith Model, 2016, but without heights: the
share that escapes is Smith's masking of its direction. So no light is lost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

MOST_FACETS = 32
"""The facets of a rough surface that light meets; what has not escaped then is lost."""


class Turn(NamedTuple):
    """n directions after they met the surface."""

    direction: Array
    """(n, 3), unit"""
    weight: Array
    """(n,): the share that has this direction"""
    crosses: Bools
    """(n,): whether the direction is on the other side of the surface"""


class Dielectric(NamedTuple):
    """A surface between two transparent media."""

    ior: float
    """The refractive index inside, relative to the outside"""
    roughness: float = 0.0

    def reflect_or_refract(self, direction: Array, normal: Array, rng: np.random.Generator) -> Turn:
        """Reflected or refracted at random, by Fresnel's share; `normal` is outward. Light and eye paths alike.

        The weights are those of light. A path of the eye also has the factor of `radiance`.
        """
        count = len(direction)
        if self.ior == 1.0:
            return Turn(direction, np.ones(count), np.ones(count, np.bool_))
        slope = np.einsum("nc,nc->n", direction, normal)
        ratio, facing = np.where(slope > 0.0, self.ior, 1.0 / self.ior), -np.sign(slope)[:, None] * normal
        if self.roughness > 0.0:
            return self._among_facets(direction, facing, ratio, rng)
        cosine = np.abs(slope)
        reflected, beyond = fresnel(cosine, ratio)
        crosses = rng.random(count) >= reflected
        return Turn(_after(direction, facing, cosine, beyond, ratio, crosses), np.ones(count), crosses)

    def refract(self, direction: Array, normal: Array, rng: np.random.Generator) -> Turn:
        """Refracted in any case: the weight has the transmitted share. What is reflected is left out."""
        if self.ior == 1.0 or self.roughness > 0.0:
            turn = self.reflect_or_refract(direction, normal, rng)
            return turn._replace(weight=np.where(turn.crosses, turn.weight, 0.0))
        cosine = -np.einsum("nc,nc->n", direction, normal)
        ratio = np.full_like(cosine, 1.0 / self.ior)
        reflected, beyond = fresnel(cosine, ratio)
        crosses = np.ones(len(cosine), np.bool_)
        return Turn(_after(direction, normal, cosine, beyond, ratio, crosses), 1.0 - reflected, crosses)

    def radiance(self, direction: Array, normal: Array) -> Array:
        """The factor of radiance for eye paths that crossed in this direction: radiance over index² is constant."""
        factor: Array = np.where(np.einsum("nc,nc->n", direction, normal) > 0.0, self.ior**2, self.ior**-2)
        return factor

    def _among_facets(self, direction: Array, facing: Array, ratio: Array, rng: np.random.Generator) -> Turn:
        """From facet to facet until the direction escapes; `ratio` is that of crossing from the side of `facing`."""
        ways, above = direction.copy(), np.ones(len(direction), np.bool_)
        left = np.arange(len(direction))
        for _ in range(MOST_FACETS):
            side = np.where(above[left], 1.0, -1.0)
            facet = self._facets(ways[left], side[:, None] * facing[left], rng)
            cosine = np.clip(-np.einsum("nc,nc->n", ways[left], facet), 0.0, 1.0)
            index = np.where(above[left], ratio[left], 1.0 / ratio[left])
            reflected, beyond = fresnel(cosine, index)
            crosses = rng.random(len(left)) >= reflected
            ways[left] = _after(ways[left], facet, cosine, beyond, index, crosses)
            above[left] ^= crosses
            height = np.where(above[left], 1.0, -1.0) * np.einsum("nc,nc->n", ways[left], facing[left])
            left = left[~((height > 0.0) & (rng.random(len(left)) < self._masking(height)))]
            if not len(left):
                break
        weight = np.ones(len(ways))
        weight[left] = 0.0
        return Turn(ways, weight, ~above)

    def _facets(self, direction: Array, facing: Array, rng: np.random.Generator) -> Array:
        """The normals of the facets that are met, on the side of `facing`.

        Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps, HPG 2023.
        """
        alpha = self.roughness**2
        first, second = axes(facing)
        local = -np.stack([np.einsum("nc,nc->n", direction, axis) for axis in (first, second, facing)], axis=1)
        local[:, :2] *= alpha
        local /= np.linalg.norm(local, axis=1, keepdims=True)
        angle, height = 2.0 * np.pi * rng.random(len(local)), rng.random(len(local))
        z = (1.0 - height) * (1.0 + local[:, 2]) - local[:, 2]
        sine = np.sqrt(np.maximum(1.0 - z * z, 0.0))
        half = np.stack([sine * np.cos(angle), sine * np.sin(angle), z], axis=1) + local
        half[:, :2] *= alpha
        half[:, 2] = np.maximum(half[:, 2], 1e-12)
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        facets: Array = half[:, :1] * first + half[:, 1:2] * second + half[:, 2:] * facing
        return facets

    def _masking(self, cosine: Array) -> Array:
        """Smith's share of the light with this cosine that meets no other facet."""
        square = np.maximum(cosine * cosine, 1e-12)
        share: Array = 2.0 / (1.0 + np.sqrt(1.0 + self.roughness**4 * (1.0 / square - 1.0)))
        return share


def _after(direction: Array, facet: Array, cosine: Array, beyond: Array, ratio: Array, crosses: Bools) -> Array:
    """The directions that cross the facets, refracted, or else are reflected; of length 1."""
    along = np.where(crosses, ratio * cosine - beyond, 2.0 * cosine)
    turned = np.where(crosses, ratio, 1.0)[:, None] * direction + along[:, None] * facet
    unit: Array = turned / np.linalg.norm(turned, axis=1, keepdims=True)
    return unit


def fresnel(cosine: Array, ratio: Array) -> tuple[Array, Array]:
    """The reflected share of unpolarised light, and the cosine behind the surface (0 for total reflection).

    `ratio` is the index before the surface over the one behind it.
    """
    square = 1.0 - ratio**2 * (1.0 - cosine**2)
    beyond = np.sqrt(np.maximum(square, 0.0))
    across = (cosine - ratio * beyond) / np.maximum(cosine + ratio * beyond, 1e-300)
    along = (ratio * cosine - beyond) / np.maximum(ratio * cosine + beyond, 1e-300)
    reflected: Array = np.where(square > 0.0, 0.5 * (across**2 + along**2), 1.0)
    return reflected, beyond


def axes(normal: Array) -> tuple[Array, Array]:
    """Two unit vectors perpendicular to each unit vector (n, 3).

    Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017.
    """
    x, y, z = normal.T
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    first = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], axis=1)
    return first, np.stack([b, sign + y * y * a, -y], axis=1)
