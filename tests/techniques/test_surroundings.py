"""The light of the surroundings that comes through, compared with integrals over directions and with path tracing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, technique, units
from sssgen.lab.reference.eye_paths import Eye, Sky, readings
from sssgen.lab.reference.inside_lengths import first_exit, thickness
from sssgen.lab.reference.sampling import Sampling
from sssgen.material import library
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Ball, Geometry, Slab, Torus
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.view_points import points
from sssgen.targets.runtime.numpy_textures import Texture

NORMAL = np.array([0.0, 0.0, 1.0])
DIRECTIONS = units(200_000, 5)


def surroundings(name: str, **inputs: Any) -> Array:
    """The second function of a technique."""
    result: Array = technique(f"{library.index()[name]}:{name}_surroundings")(**inputs)
    return result


def summed(name: str, light: Array, **inputs: Any) -> Array:
    """The technique's own light of lamps in all directions; `light` is each one's."""
    through = technique(name)(L=DIRECTIONS, **inputs)
    mean: Array = 4.0 * (through * light[:, None]).mean(axis=0)
    return mean


@pytest.mark.parametrize(
    ("name", "inputs"),
    [
        ("lobe_gdc2011", {"N": NORMAL, "through": 0.6, "distortion": 0.0, "power": 6.0, "ambient": 0.1}),
        ("lobe_normalized", {"N": NORMAL, "through": 0.6, "distortion": 0.0, "power": 2.0}),
        ("lobe_exp2", {"N": NORMAL, "through": 0.6, "distortion": 0.0, "power": 5.0}),
        ("lobe_henyey_greenstein", {"through": 0.6, "anisotropy": 0.6}),
        ("lobe_henyey_greenstein", {"through": 0.6, "anisotropy": -0.3}),
        ("gltf_diffuse_transmission", {"N": NORMAL, "through": 0.6}),
        (
            "diffuse_transmission_map",
            {
                "N": NORMAL,
                "d": 0.1,
                "uv": np.array([0.5, 0.5]),
                "extinction": np.ones(3),
                "diffuse_transmission_texture": Texture(np.full((1, 1, 4), 0.7)),
            },
        ),
    ],
)
def test_lobes_have_the_light_of_the_half_sphere_behind(name: str, inputs: dict[str, Any]) -> None:
    """As that of lamps in all of its directions; the eye looks along the normal, and the normal does not bend light."""
    behind = (DIRECTIONS[:, 2] < 0.0).astype(float)
    lamps = summed(name, behind, V=NORMAL, **inputs)
    own = {key: value for key, value in inputs.items() if key not in ("N", "distortion")}
    own |= {"N": NORMAL, "V": NORMAL, "irradiance": np.zeros(3)} if "transmission" in name else {}
    close(surroundings(name, irradiance_behind=np.ones(3), **own), lamps, rtol=0.02)


def test_wrap_lighting_in_a_white_room() -> None:
    lamps = summed("wrap_lighting", np.ones(len(DIRECTIONS)), N=NORMAL, wrap=0.7)
    room = {"irradiance": np.ones(3), "irradiance_behind": np.ones(3)}
    close(surroundings("wrap_lighting", wrap=0.7, **room), lamps, rtol=0.02)


@pytest.mark.parametrize("name", ["interior_octaves", "fluence_fixed", "fluence_factored_8"])
def test_a_body_that_absorbs_nothing_is_as_bright_as_its_room(name: str) -> None:
    """Less the light that comes through without scattering."""
    lengths = np.geomspace(0.01, 100.0, 40)
    result = surroundings(
        name, d=lengths, N=NORMAL, V=NORMAL, extinction=np.full(3, 2.0), scattering_albedo=np.ones(3),
        irradiance=np.ones(3), irradiance_behind=np.ones(3),
    )  # fmt: skip
    close(result, (1.0 - np.exp(-2.0 * lengths))[:, None] * np.ones(3), atol=1e-9)


def test_a_boundary_lets_the_room_in_but_for_its_own_reflection() -> None:
    through = technique(f"{library.index()['interior_octaves_refracted']}:seen_through")
    view = np.array([0.6, 0.0, 0.8])
    inside = np.array([0.4, 0.0, np.sqrt(1.0 - 0.16)])
    bright = surroundings(
        "interior_octaves_refracted", d=100.0, N=NORMAL, V=view, extinction=np.full(3, 2.0),
        scattering_albedo=np.ones(3), ior=1.5, irradiance=np.ones(3), irradiance_behind=np.ones(3),
    )  # fmt: skip
    share = through(V=view, N=NORMAL, ior=1.5)
    close(bright, share * np.ones(3), rtol=1e-6)
    # Fresnel's equations; at the silhouette as at a cosine of 0.15
    across = (0.8 - 1.5 * inside[2]) / (0.8 + 1.5 * inside[2])
    along = (1.5 * 0.8 - inside[2]) / (1.5 * 0.8 + inside[2])
    close(share, 1.0 - 0.5 * (across**2 + along**2), rtol=1e-6)
    grazing = np.array([np.sqrt(1.0 - 0.15**2), 0.0, 0.15])
    close(through(V=np.array([1.0, 0.0, 0.0]), N=NORMAL, ior=1.5), through(V=grazing, N=NORMAL, ior=1.5), rtol=1e-9)


def test_absorption_and_order_of_the_sides() -> None:
    """A darker medium is darker; a thicker body has less of the light behind it."""
    given = {"N": NORMAL, "V": NORMAL, "extinction": np.full(3, 5.0), "scattering_albedo": np.array([0.99, 0.9, 0.8])}
    behind = [
        surroundings("interior_octaves", d=d, irradiance=np.zeros(3), irradiance_behind=np.ones(3), **given)
        for d in (0.5, 1.0, 3.0)
    ]
    assert (behind[0] > behind[1]).all() and (behind[1] > behind[2]).all() and behind[2].min() >= 0.0
    assert behind[1][0] > behind[1][1] > behind[1][2]
    close(surroundings("interior_octaves", d=0.0, irradiance=np.ones(3), irradiance_behind=np.ones(3), **given), 0.0)


BODIES: list[tuple[str, Geometry, Camera, Medium]] = [
    (
        "jade ball", Ball(0.35), Camera((0.0, 0.3, 2.0), (0.0, 0.0, 0.0), 26.0),
        Medium("jade", (7.5, 0.84, 4.18), (7.5, 5.16, 6.82)),
    ),
    (
        "jade ring", Torus(0.78, 0.3, rotation=(116.0, 0.0, 12.0)), Camera((0.0, 0.25, 4.2), (0.0, 0.0, 0.0), 34.0),
        Medium("jade", (7.5, 0.84, 4.18), (7.5, 5.16, 6.82)),
    ),
    (
        "wax slab", Slab(1.0, 1.0, 0.3), Camera((0.9, 0.7, 3.0), (0.0, 0.0, 0.0), 26.0),
        Medium("wax", (0.016, 0.276, 1.6), (3.184, 4.324, 6.4)),
    ),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("name", "geometry", "camera", "medium"), BODIES, ids=[body[0] for body in BODIES])
def test_a_body_in_a_white_room(name: str, geometry: Geometry, camera: Camera, medium: Medium) -> None:
    """The mean light that is scattered on its way is within 10 % of path tracing."""
    scene = MeasuredScene(name, name, geometry, camera, (), medium, None, (20, 20))
    place, normal, view = (np.ascontiguousarray(points(scene).inputs[key].T) for key in ("P", "N", "V"))
    eye = Eye(place, normal, -view)
    traced = readings(geometry, medium, eye, [], [Sky(lambda ways: np.ones((len(ways), 3)))], Sampling(100))
    straight = np.exp(-np.outer(thickness(geometry, place, -view), medium.extinction))
    lengths = first_exit(geometry, place, -view)
    light = surroundings(
        "interior_octaves", d=lengths, N=normal, V=view, extinction=np.array(medium.extinction),
        scattering_albedo=np.array(medium.albedo), irradiance=np.ones(3), irradiance_behind=np.ones(3),
    )  # fmt: skip
    ratio = light.mean() / (traced.mean[-1] - straight).mean()
    print(f"{name}: {ratio:.3f} of path tracing")
    assert 0.9 < ratio < 1.1
