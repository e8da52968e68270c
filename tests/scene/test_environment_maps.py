"""The prefiltered cube maps of a scene's surroundings, against formulas and random samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sssgen.run.backends import Array
from sssgen.run.render.environment_maps import IRRADIANCE_SIDE, LEVELS, irradiance_map, reflection_map
from sssgen.scene.environment import Environment
from sssgen.support import cache
from sssgen.targets.runtime.numpy_textures import cube_directions


def surroundings(folder: Path, light: Array) -> Environment:
    path = folder / "sky.npy"
    np.save(path, np.flipud(light).astype(np.float32))
    return Environment((1.0, 1.0, 1.0), str(path), cache.digest(light.tobytes()))


def ways(height: int) -> Array:
    """The directions of the pixels of an equirectangular picture, (height, 2 height, 3)."""
    polar = np.pi * (np.arange(height) + 0.5)[:, None] / height
    around = np.pi * ((np.arange(2 * height) + 0.5) / height - 1.0)
    return np.stack(
        [np.sin(polar) * np.cos(around), np.cos(polar) + 0.0 * around, np.sin(polar) * np.sin(around)], axis=-1
    )


def test_uniform_light_stays() -> None:
    environment = Environment((0.5, 1.0, 2.0))
    for texture in (irradiance_map(environment), reflection_map(environment, 16)):
        for level in texture.levels:
            expected = np.broadcast_to([0.5, 1.0, 2.0], level[..., :3].shape)
            np.testing.assert_allclose(level[..., :3], expected, rtol=1e-5)


def test_irradiance_of_a_slope_of_light(tmp_path: Path) -> None:
    """Light a + b·w from the direction w: the mean weighted with the cosine is a + 2/3 b·n."""
    slope = np.array([0.3, -0.5, 0.2])
    light = 1.0 + ways(64) @ slope
    environment = surroundings(tmp_path, np.repeat(light[..., None], 3, axis=-1))
    texels = irradiance_map(environment).levels[0][..., :3]
    expected = 1.0 + cube_directions(IRRADIANCE_SIDE) @ slope * (2.0 / 3.0)
    np.testing.assert_allclose(texels, np.repeat(expected[..., None], 3, axis=-1), atol=4e-3)


@pytest.mark.parametrize("level", range(1, LEVELS))
def test_reflections_are_those_of_random_half_vectors(level: int, tmp_path: Path) -> None:
    """Karis's algorithm: half vectors by GGX around the direction, their mirrored light weighted with the cosine."""
    place = (4, 0, 0)  # a texel of the face +z
    direction = cube_directions(32 >> level)[place]
    bump = np.exp(6.0 * (ways(64) @ np.array([0.36, 0.48, 0.8]) - 1.0))
    environment = surroundings(tmp_path, np.stack([bump, 2.0 * bump, 0.1 + bump], axis=-1))
    alpha = (level / (LEVELS - 1)) ** 2
    u, v = np.random.default_rng(3).uniform(size=(2, 100_000))
    cos_half = np.sqrt((1.0 - v) / (1.0 + (alpha**2 - 1.0) * v))
    sin_half = np.sqrt(1.0 - cos_half**2)
    side = np.cross(direction, [0.0, 1.0, 0.0]) / np.linalg.norm(np.cross(direction, [0.0, 1.0, 0.0]))
    frame = np.stack([side, np.cross(direction, side), direction])
    around = 2.0 * np.pi * u
    half = np.stack([sin_half * np.cos(around), sin_half * np.sin(around), cos_half], axis=1) @ frame
    light = 2.0 * (half @ direction)[:, None] * half - direction
    weight = np.maximum(light @ direction, 0.0)
    expected = (environment.sky()(light) * weight[:, None]).sum(axis=0) / weight.sum()
    got = reflection_map(environment, 32).levels[level][place][:3]
    np.testing.assert_allclose(got, expected, rtol=0.03)


def test_the_first_level_is_the_light_itself(tmp_path: Path) -> None:
    light = np.zeros((64, 128, 3))
    light[:, :64] = [1.0, 0.0, 0.0]  # z < 0
    light[:, 64:] = [0.0, 0.0, 1.0]
    texture = reflection_map(surroundings(tmp_path, light), 16)
    seen = texture.sample(np.array([[0.3, 0.3], [0.2, 0.2], [-0.9, 0.9]]), 0.0)[:3].T
    np.testing.assert_allclose(seen, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], atol=1e-12)
