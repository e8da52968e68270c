"""The length along the eye's ray, and light scattered inside a body, compared with closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from oracle import Array, close, rng, technique, unit, units
from sssgen.targets.runtime.numpy_textures import Texture

RADIUS = 0.7


def seen_ball(count: int) -> tuple[Array, Array, Array]:
    """Points on a ball, directions to an eye that sees them, and the lengths of the eye's rays inside."""
    normal = units(count, 3)
    view = unit(normal + 0.9 * units(count, 4))
    return RADIUS * normal, view, 2.0 * RADIUS * np.einsum("nc,nc->n", normal, view)


def test_the_march_along_the_eyes_ray_ends_at_the_first_exit() -> None:
    place, view, length = seen_ball(300)
    march = technique("march_view", body_distance="sphere")
    errors = [np.abs(march(P=place, V=view, radius=RADIUS, steps=steps) - length).max() for steps in (4, 16, 64)]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2], errors
    assert errors[2] < 2e-3
    slabs = "float slabs(world_position p) { return min(abs(p.y + 0.2) - 0.2, abs(p.y + 1.0) - 0.3); }"
    close(technique("march_view", body_distance=slabs)(P=np.zeros(3), V=np.array([0.0, 1.0, 0.0])), 0.4, atol=1e-9)


def test_the_back_faces_give_the_length_along_the_eyes_ray() -> None:
    depth = rng().uniform(1.0, 3.0, (4, 5))
    x, y = rng().integers(0, 5, 50), rng().integers(0, 4, 50)
    place = (np.stack([x, y], axis=1) + 0.5) / [5.0, 4.0]
    own = rng().uniform(0.5, 3.5, 50)
    faces = Texture(depth[..., None])
    result = technique("back_face_thickness")(screen_uv=place, eye_distance=own, back_face_map=faces)
    close(result, np.maximum(depth[y, x] - own, 0.0))
    assert (result == 0.0).any() and (result > 0.0).any()


def test_a_balls_mean_chord_gives_the_length_along_the_eyes_ray() -> None:
    place, view, length = seen_ball(200)
    result = technique("view_thickness_from_chord")(d=4.0 / 3.0 * RADIUS, N=place / RADIUS, V=view)
    close(result[length > 0.1], length[length > 0.1], rtol=1e-9)
    assert result.min() >= 0.04 * RADIUS * 0.99  # the smallest cosine is 0.02


def test_the_path_from_a_lights_depth_map() -> None:
    turn = np.array([[0.0, 1.0, 0.0, 0.5], [-1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, 1.0]])
    place = rng().uniform(-0.4, 0.4, (50, 3))
    path = technique("depth_map_path")
    result = path(P=place, L=np.zeros(3), light_matrix=turn, light_depth_map=Texture(np.full((4, 4, 1), 1.9)))
    close(result, np.maximum(place[:, 2] + 2.0 - 1.9, 0.0), atol=1e-12)


def test_the_path_through_a_gap() -> None:
    """From points before, in and behind a gap between two slabs of matter, and in front of both."""
    view = np.diag([1.0, 1.0, -1.0, 1.0])  # the light is above, and its plane at z = 0
    place = np.zeros((7, 3))
    place[:, 2] = [-0.1, -0.2, -0.35, -0.5, -0.7, -0.8, -1.3]
    layers = Texture(np.broadcast_to(np.array([0.2, 0.5, 0.8]), (4, 4, 3)))
    result = technique("depth_layers_path")(P=place, L=np.zeros(3), light_matrix=view, light_layer_map=layers)
    close(result, np.array([0.0, 0.0, 0.15, 0.3, 0.3, 0.3, 0.8]), atol=1e-7)


def inside_ball(place: Array, towards: Array) -> Array:
    """The length inside the ball from points in it."""
    along = np.einsum("nc,nc->n", place, towards)
    result: Array = -along + np.sqrt(np.maximum(along**2 + RADIUS**2 - (place**2).sum(axis=1), 0.0))
    return result


@pytest.mark.parametrize("mean_free_path", [0.05, 0.4])
def test_the_interior_sample(mean_free_path: float) -> None:
    place, view, length = seen_ball(200)
    light = units(200, 5)
    depth = np.minimum(np.log(2.0) * mean_free_path, 0.5 * length)
    path = inside_ball(place - depth[:, None] * view, light)
    lit = technique("interior_sample", light_path="march_light", body_distance="sphere")
    values = {"radius": RADIUS, "steps": 128, "reach": 1.5, "mean_free_path": mean_free_path, "reach_of_light": 4.0}
    result = lit(d=length, P=place, V=view, L=light, subsurface_color=(0.5, 1.0, 0.25), **values)
    expected = (1.0 - np.exp(-length / mean_free_path)) * np.exp(-path / (4.0 * mean_free_path))
    close(result, expected[:, None] * (0.5, 1.0, 0.25), atol=6e-3)


def test_the_first_octave_is_single_scattering() -> None:
    """The integral over the eye's ray of a slab that the light crosses along the normal has a closed form.

    Through one sample it is exact where the light's path is the same for the whole ray: for a light that is
    perpendicular to the eye's ray, at the depth of the ray.
    """
    sigma, albedo = np.array([2.0, 4.0, 8.0]), np.array([0.9, 0.6, 0.3])
    constant = "thickness fixed_length(world_position p, world_direction l) { return thickness(0.3); }"
    length = np.linspace(0.0, 2.0, 9)
    zeros = np.zeros((9, 3))
    result = technique("interior_octaves", light_path=constant)(
        d=length, P=zeros, V=zeros, L=units(9, 6), light_nearness=0.0, extinction=sigma, scattering_albedo=albedo,
        octaves=(1.0, 0.0, 0.0, 0.0),
        mean_free_path=3.0 / sigma.sum(),
    )  # fmt: skip
    depth = np.linspace(0.0, 1.0, 20001)[:, None, None] * length[:, None]
    scattered = albedo * sigma * np.exp(-sigma * depth) * np.exp(-sigma * 0.3) / 4.0
    close(result, np.trapezoid(scattered, axis=0, dx=1.0) * length[:, None] / 20000, rtol=1e-6, atol=1e-12)
    mixed = technique("interior_octaves", light_path=constant)(
        d=np.array([1e9]), P=zeros[:1], V=zeros[:1], L=units(1, 6), extinction=sigma, scattering_albedo=albedo,
        octaves=(0.5, 1.0, 2.0, 3.0), mean_free_path=0.2, light_nearness=0.0,
    )  # fmt: skip
    again = sum(share * np.exp(-0.3 * sigma / part) for share, part in ((1.0, 2.0), (2.0, 4.0), (3.0, 16.0)))
    close(mixed[0], 0.25 * albedo * (0.5 * np.exp(-0.3 * sigma) + albedo * again), rtol=1e-9)


def test_light_that_is_scattered_again_fades_faster_at_thin_edges() -> None:
    """Single scattering is in proportion to the length of a short ray, what is scattered again to its square."""
    constant = "thickness fixed_length(world_position p, world_direction l) { return thickness(0.3); }"
    zeros = np.zeros((2, 3))
    lit = technique("interior_octaves", light_path=constant)
    values = {"P": zeros, "V": zeros, "L": zeros, "d": np.array([1e-4, 2e-4]), "light_nearness": 0.0}
    values |= {"extinction": np.full(3, 4.0)}
    once = lit(octaves=(1.0, 0.0, 0.0, 0.0), **values)
    close(once[1] / once[0], np.full(3, 2.0), rtol=1e-3)
    for shares in np.eye(4)[1:]:
        again = lit(octaves=tuple(shares), **values)
        close(again[1] / again[0], np.full(3, 4.0), rtol=1e-3)


def transmitted(cosine: Array, ior: float) -> Array:
    """The share that a surface lets through, by Fresnel's equations with the angles on both sides."""
    before = np.arccos(cosine)
    beyond = np.arcsin(np.sin(before) / ior)
    if ior == 1.0:
        return np.ones_like(cosine)
    across = np.sin(before - beyond) / np.sin(before + beyond)
    along = np.tan(before - beyond) / np.tan(before + beyond)
    result: Array = 1.0 - 0.5 * (across**2 + along**2)
    return result


@pytest.mark.parametrize("ior", [1.0, 1.3, 1.8])
@pytest.mark.parametrize(
    ("name", "refracted"),
    [("interior_sample", "interior_sample_refracted"), ("interior_octaves", "interior_octaves_refracted")],
)
def test_a_refracting_surface_bends_the_eyes_ray_and_lets_a_share_through(
    name: str, refracted: str, ior: float
) -> None:
    place, view, length = seen_ball(200)
    normal, light = place / RADIUS, units(200, 5)
    path = (
        "thickness height(world_position p, world_direction l) { return thickness(2.0 + dot(p, vec3(0.5, 0.7, 0.3))); }"
    )
    cosine = np.einsum("nc,nc->n", normal, view)
    # Snell's law by angles: the ray stays in the plane of normal and view
    side = view - cosine[:, None] * normal
    sine = np.linalg.norm(side, axis=1) / ior
    bent = np.sqrt(1.0 - sine**2)[:, None] * normal + side / ior
    share = transmitted(cosine, ior)
    values = {"mean_free_path": 0.3, "P": place, "L": light}
    # the chord of the refracted ray
    chord = 2.0 * RADIUS * np.einsum("nc,nc->n", normal, bent)
    if "octaves" in name:
        values["light_nearness"] = 0.4
    straight = technique(name, light_path=path)(V=bent, d=chord, **values)
    result = technique(refracted, light_path=path)(V=view, N=normal, ior=ior, d=length, **values)
    close(result, share[:, None] * straight, rtol=1e-9)
    assert np.linalg.norm(bent, axis=1) == pytest.approx(1.0)


def test_the_directional_map_has_the_length_of_its_numbers() -> None:
    numbers = rng(3).uniform(-0.4, 0.4, (60, 9))
    numbers[:, 0] += 0.4
    lowest, span = numbers.min(axis=0), np.ptp(numbers, axis=0)
    texels = (numbers - lowest) / span
    view, count = units(60, 4), len(numbers)
    names: dict[str, object] = {}
    for number in range(3):
        part = slice(3 * number, 3 * number + 3)
        names[f"view_harmonics_{number + 1}"] = Texture(texels[None, :, part], "nearest", "clamp")
        names[f"harmonics_lowest_{number + 1}"] = tuple(lowest[part])
        names[f"harmonics_span_{number + 1}"] = tuple(span[part])
    uv = np.stack([(np.arange(count) + 0.5) / count, np.full(count, 0.5)], axis=1)
    result = technique("view_thickness_map")(uv=uv, V_object=view, fade_length=0.7, **names)
    x, y, z = -view.T
    terms = np.stack([x**0, x, y, z, x * y, y * z, z * x, 3.0 * z**2 - 1.0, x**2 - y**2], axis=1)
    share = (terms * numbers).sum(axis=1)
    assert (share < 0.02).any() and (share > 0.9999).any() and ((share > 0.1) & (share < 0.9)).sum() > 20
    close(result, -0.7 * np.log(1.0 - np.clip(share, 0.02, 0.9999)), rtol=1e-9)


def test_octaves_have_the_light_at_the_point_inside() -> None:
    """The direction and the irradiance of a lamp there; the path of this test depends on both place and direction."""
    place, view, length = seen_ball(200)
    mean_free_path, lamp = 0.5, np.array([0.4, 0.9, -1.3])
    towards = lamp - place
    distance = np.linalg.norm(towards, axis=1)
    path = "thickness sloped(world_position p, world_direction l) "
    path += "{ return thickness(2.0 + dot(p, vec3(0.5, 0.7, 0.3)) + dot(l, vec3(0.2, -0.6, 0.4))); }"
    lit = technique("interior_octaves", light_path=path)
    values = {"P": place, "V": view, "d": length, "mean_free_path": mean_free_path, "extinction": (2.0,) * 3,
              "scattering_albedo": (0.5,) * 3, "octaves": (1.0, 0.0, 0.0, 0.0)}  # fmt: skip
    inside = place - np.minimum(np.log(2.0) * mean_free_path, 0.5 * length)[:, None] * view
    seen = 0.125 * (1.0 - np.exp(-2.0 * length))

    def expected(way: Array) -> Array:
        depth = 2.0 + inside @ [0.5, 0.7, 0.3] + way @ [0.2, -0.6, 0.4]
        result: Array = (seen * np.exp(-2.0 * depth))[:, None] * np.ones(3)
        return result

    from_inside = lamp - inside
    result = lit(L=unit(towards), light_nearness=1.0 / distance, **values)
    nearer = (distance / np.linalg.norm(from_inside, axis=1)) ** 2
    # the technique has ln 2 with six digits
    close(result, nearer[:, None] * expected(unit(from_inside)), rtol=1e-6)
    assert nearer.min() < 0.9 and nearer.max() > 1.1
    close(lit(L=unit(towards), light_nearness=0.0, **values), expected(unit(towards)), rtol=1e-6)
