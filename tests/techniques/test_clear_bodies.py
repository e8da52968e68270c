"""Light that comes through clear bodies without scattering, compared with rays through a ball."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracle import Array, close, technique, units
from sssgen.material import library
from sssgen.targets.runtime.numpy_textures import Texture

IOR, EXTINCTION = 1.4, np.array([0.2, 0.5, 1.0])
V = np.array([0.0, 0.0, 1.0])
UV = np.array([0.5, 0.5])
WHITE, BLACK = Texture(np.ones((1, 1, 3))), Texture(np.zeros((1, 1, 3)))
N = units(4000, 3)
N = N[N @ V > 0.2]
"""Places of a ball of radius 1 that the eye sees."""


def refracted(ray: Array, normal: Array, ratio: float) -> Array:
    """Snell's law, in the form of angles: `normal` faces the ray."""
    cosine = -(ray * normal).sum(axis=1)
    along = ray + cosine[:, None] * normal
    sine = ratio * np.sqrt(1.0 - cosine**2)
    side = along / np.maximum(np.linalg.norm(along, axis=1), 1e-12)[:, None]
    result: Array = sine[:, None] * side - np.sqrt(1.0 - sine**2)[:, None] * normal
    return result


def through_ball() -> tuple[Array, Array, Array]:
    """The direction behind a ball of each ray of the eye; the lengths of the straight and the refracted ray inside."""
    inside = refracted(np.broadcast_to(-V, N.shape), N, 1.0 / IOR)
    length = -2.0 * (inside * N).sum(axis=1)
    far = N + length[:, None] * inside
    return refracted(inside, -far, IOR), 2.0 * N @ V, length


def entering_share() -> Array:
    mirrored = ((IOR - 1.0) / (IOR + 1.0)) ** 2
    share: Array = (1.0 - mirrored) * (1.0 - (1.0 - N @ V) ** 5)
    return share


def test_a_lamp_is_seen_where_a_ball_bends_the_ray_to_it() -> None:
    leaving, straight, length = through_ball()
    values = {"uv": UV, "V": V, "N": N, "roughness": 0.3, "spread": 0.2, "ior": IOR, "extinction": EXTINCTION}
    values["entering_texture"] = WHITE
    spot = technique("lamps_through_body")(L=leaving, d=straight, **values)
    a2 = (0.3**2 + 0.2**2) ** 2
    passed = np.exp(-2.0 * EXTINCTION * length[:, None]) * entering_share()[:, None]
    close(spot, 0.75 * passed / (4.0 * a2), rtol=1e-6)
    beside = technique("lamps_through_body")(L=-leaving, d=straight, **values)
    assert (beside < 0.01 * spot).all()


def surroundings(d: Array, **inputs: Any) -> Array:
    name = "seen_through_body"
    inputs = {"entering_texture": WHITE, "scene_behind_map": BLACK, **inputs}
    result: Array = technique(f"{library.index()[name]}:{name}_surroundings")(
        d=d, uv=UV, P=N, V=V, N=N, ior=IOR, extinction=EXTINCTION, **inputs
    )
    return result


def test_the_scene_behind_is_coloured_by_the_length_of_the_refracted_ray() -> None:
    _, straight, length = through_ball()
    passed = np.exp(-EXTINCTION * length[:, None]) * entering_share()[:, None]
    around = np.array([0.3, 0.6, 0.9])
    close(surroundings(straight, roughness=0.0, irradiance_behind=around), around * passed, rtol=1e-6)
    # a picture of the left half of which is white; the point far behind the surface is at the right or the left of it
    picture = Texture(np.repeat(np.array([[1.0, 0.0]]), 2, axis=0)[..., None].repeat(3, 2), "nearest", "clamp")
    to_picture = np.array([[0.25, 0, 0, 0.5], [0, 0.25, 0, 0.5], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])
    seen = surroundings(
        straight, roughness=0.0, irradiance_behind=around, scene_behind_map=picture, scene_behind_matrix=to_picture,
        scene_behind_levels=1.0,
    )  # fmt: skip
    inside = refracted(np.broadcast_to(-V, N.shape), N, 1.0 / IOR)
    leaving = N + length[:, None] * inside
    certain = np.abs(leaving[:, 0]) > 1e-3
    close(seen[certain], (leaving[:, :1] < 0.0)[certain] * passed[certain], rtol=1e-6)


def test_roughness_blurs_the_scene_behind() -> None:
    texels = np.zeros((64, 64, 3))
    texels[:, :32] = 1.0
    picture = Texture(texels, wrap="clamp", mipmaps=True)
    to_picture = np.array([[0.25, 0, 0, 0.5], [0, 0.25, 0, 0.5], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])
    given = {"scene_behind_map": picture, "scene_behind_matrix": to_picture, "scene_behind_levels": 6.0}
    thin = np.full(len(N), 1e-4)
    middles = [
        surroundings(thin, roughness=rough, irradiance_behind=np.zeros(3), **given)[:, 0] for rough in (0.0, 0.5, 1.0)
    ]
    spreads = [middle.std() for middle in middles]
    assert spreads[0] > spreads[1] > 2.0 * spreads[2]


def test_two_parts_behind_each_other_are_added() -> None:
    layers = Texture(np.array([[[3.0, 5.0, 5.5]]]), "nearest", "clamp")
    depth = technique("eye_layers_thickness")(screen_uv=UV, eye_distance=2.0, eye_layer_map=layers)
    close(np.asarray(depth), 1.5, rtol=1e-6)
