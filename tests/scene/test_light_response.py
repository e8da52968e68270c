"""The response of a body to light: sums of lights, surroundings, files, and the octahedral map."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracle import Array, close, rng, unit
from sssgen.scene import octahedron
from sssgen.scene.light_response import (
    LightResponse,
    arriving_shares,
    checksum,
    from_bytes,
    from_light,
    harmonics,
    lit,
    to_bytes,
)  # fmt: skip
from sssgen.scene.scene import Light

SIDE, RANK, SHAPE = 8, 3, (3, 4, 5)
IDENTITY = np.eye(4)


def example_response(seed: int = 1) -> LightResponse:
    """A response with random numbers, whose light varies smoothly with the direction."""
    random = rng(seed)
    cells = np.sort(random.choice(np.prod(SHAPE), 40, replace=False))
    nearest = random.integers(0, len(cells), SHAPE)
    nearest.ravel()[cells] = np.arange(len(cells))
    smooth = harmonics(octahedron.directions(SIDE)) @ random.uniform(-0.05, 0.05, (9, 3 * (1 + RANK)))
    table = (0.3 + smooth.reshape(-1, 1 + RANK, 3)).astype(np.float16)
    response = LightResponse(
        np.array([-1.0, -0.8, -0.6]), np.array([1.0, 0.8, 0.6]), cells.astype(np.uint16), nearest.astype(np.uint16),
        random.integers(0, 256, (RANK, len(cells))).astype(np.uint8), table,
        random.integers(0, 256, (len(cells), SIDE * SIDE)).astype(np.uint8), 1.1, np.array([0.8, 1.0, 1.3]),
        np.zeros((9, 3, len(cells)), np.int8), np.ones((9, 3)),
            random.integers(0, 256, nearest.shape).astype(np.uint8),
    )  # fmt: skip
    angles = octahedron.solid_angles(SIDE)[:, None] * harmonics(octahedron.directions(SIDE))
    around = np.einsum(
        "dk,dcv->kcv", angles, np.stack([white_light(response, way) for way in octahedron.directions(SIDE)])
    )
    largest = np.abs(around).max(axis=2)
    stored = np.rint(127.0 * around / largest[..., None]).astype(np.int8)
    return response._replace(surroundings=stored, largest=largest)


def white_light(response: LightResponse, way: Array) -> Array:
    """The light of the voxels that count for a white distant light, (3, voxels)."""
    volume = lit(response, [from_light(response, distant(way), IDENTITY)])
    result: Array = volume.reshape(-1, 3)[response.cells].T
    return result


def distant(way: Array, color: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Light:
    x, y, z = (float(value) for value in way)
    return Light(None, (x, y, z), color)


def test_lights_add_and_have_colours() -> None:
    response = example_response()
    first, second = unit(rng(3).normal(size=(2, 3)))
    volumes = [lit(response, [from_light(response, distant(way), IDENTITY)]) for way in (first, second)]
    colored = [distant(first, (1.0, 2.0, 0.5)), distant(second, (0.0, 0.3, 1.0))]
    both = lit(response, [from_light(response, light, IDENTITY) for light in colored])
    close(both, volumes[0] * (1.0, 2.0, 0.5) + volumes[1] * (0.0, 0.3, 1.0))


def test_light_that_a_surface_focuses_has_no_colour() -> None:
    """A power of a share above 1 would be a share above that of the light itself."""
    powers = np.array([0.5, 1.0, 4.0])
    close(arriving_shares(np.array([1.5]), powers), 2.25 * np.ones((1, 3)), 1e-12)
    roots = np.linspace(0.0, 2.0, 401)
    shares = arriving_shares(roots, powers)
    close(shares[:200], np.maximum(roots[:200, None], 3e-5) ** (2.0 * powers), 1e-12)
    assert (np.diff(shares, axis=0) >= 0.0).all() and np.abs(np.diff(shares, axis=0)).max() < 0.05


def test_a_far_lamp_is_a_distant_light_and_a_near_one_has_its_own_ways() -> None:
    response = example_response()
    way = np.array([0.36, 0.48, 0.8])
    far = Light(tuple(1e4 * way), None, (1e8,) * 3)
    expected = lit(response, [from_light(response, distant(way), IDENTITY)])
    close(lit(response, [from_light(response, far, IDENTITY)]), expected, rtol=2e-3)
    near = from_light(response, Light((0.0, 0.0, 2.0), None, (4.0, 4.0, 4.0)), IDENTITY)
    away = np.array([0.0, 0.0, 2.0]) - response.places()
    close(near.irradiance[:, 0], 4.0 / (away**2).sum(axis=1))
    close(np.cross(near.towards, away), 0.0, atol=1e-12)


def test_a_body_that_is_moved_has_the_light_in_its_own_space() -> None:
    """A turn and a scale of the body with its lamp change the fall-off alone, by the square of the scale."""
    response, scale = example_response(), 2.0
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    to_world = np.eye(4)
    to_world[:3, :3], to_world[:3, 3] = scale * turn, (3.0, -1.0, 2.0)
    lamp = np.array([0.5, 0.3, 1.7])
    own = from_light(response, Light(tuple(lamp), None, (1.0,) * 3), IDENTITY)
    moved = Light(tuple(to_world[:3, :3] @ lamp + to_world[:3, 3]), None, (scale**2,) * 3)
    to_object: Array = np.linalg.inv(to_world)
    placed = from_light(response, moved, to_object)
    close(placed.towards, own.towards)
    close(placed.irradiance, own.irradiance)


def test_harmonics_are_orthonormal() -> None:
    directions = octahedron.directions(96)
    values = harmonics(directions)
    close((values * octahedron.solid_angles(96)[:, None]).T @ values, np.eye(9), atol=2e-3)


def test_surroundings_are_many_lights() -> None:
    """Of light that has the harmonics up to order 2 alone, the sum over lights from everywhere."""
    response = example_response()
    ways, angles = octahedron.directions(SIDE), octahedron.solid_angles(SIDE)
    radiance = np.maximum(harmonics(ways) @ rng(5).uniform(-0.1, 0.1, (9, 3)) + 0.8, 0.0)
    expected = np.einsum("d,dc,dcv->cv", angles, radiance, np.stack([white_light(response, way) for way in ways]))
    # the response itself has higher harmonics: those of its random shares do not count
    coefficients = harmonics(ways).T @ (radiance * angles[:, None])
    found = lit(response, [], coefficients).reshape(-1, 3)[response.cells].T
    close(found, expected, rtol=0.06)


def test_the_bytes_of_a_file() -> None:
    response = example_response()
    data, arrays = to_bytes(response)
    facts: dict[str, Any] = {
        "arrays": arrays, "box_min": response.low.tolist(), "box_max": response.high.tolist(),
        "highest": response.highest, "powers": response.powers.tolist(), "largest": response.largest.tolist(),
        "file": {"bytes": len(data), "adler32": checksum(data)},
    }  # fmt: skip
    read = from_bytes(data, facts)
    for before, after in zip(response, read, strict=True):
        assert np.array_equal(np.asarray(before), np.asarray(after))
    with pytest.raises((KeyError, TypeError, ValueError)):
        from_bytes(data[:100], facts)
    with pytest.raises(KeyError):
        from_bytes(data, {})
    other, _ = to_bytes(response._replace(highest=2.0, distance=255 - response.distance))
    for file in (other, data + b"more"):
        with pytest.raises(ValueError, match="that of another file"):
            from_bytes(file, facts)
    for name, shape in {"latents": [2, 3], "surroundings": [1, 3, 9], "table": [1, 1, 3]}.items():
        changed = {**facts, "arrays": {**arrays, name: {**arrays[name], "shape": shape}}}
        with pytest.raises(ValueError, match="belong together"):
            from_bytes(data, changed)


def test_the_octahedral_map_is_continuous_and_exact_at_its_texels() -> None:
    ways = octahedron.directions(SIDE)
    texels, weights = octahedron.mix(ways, SIDE)
    close((weights * (texels == np.arange(SIDE * SIDE)[:, None])).sum(axis=1), 1.0)
    values = rng(2).uniform(0.0, 1.0, SIDE * SIDE)
    # directions on both sides of the map's edges and of its folds, but for -z, where its four corners meet
    edge = rng(9).normal(size=(400, 3))
    edge[:200, 2], edge[200:, 0] = 0.0, 0.0
    edge = unit(edge)
    edge = edge[edge[:, 2] > -0.95]
    step = np.where(edge[:, 2:] == 0.0, [0.0, 0.0, 1e-7], [1e-7, 0.0, 0.0])
    assert len(edge) > 350

    def look(directions: Array) -> Array:
        texels, weights = octahedron.mix(directions, SIDE)
        result: Array = (values[texels] * weights).sum(axis=1)
        return result

    close(look(edge + step), look(edge - step), atol=1e-5)
