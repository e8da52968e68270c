"""Light from baked fluence volumes, compared with the numbers in the volumes and with closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from oracle import close, technique
from sssgen.harness.scenes.camera import Camera
from sssgen.harness.scenes.geometry import Ball
from sssgen.lab.fluence import fluence_field as field
from sssgen.lab.fluence import fluence_volumes as volumes
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.lab.scene.measured_scene import MeasuredScene
from sssgen.lab.scene.media import Medium
from sssgen.targets.runtime.numpy_textures import Texture


@pytest.mark.parametrize("name", ["fluence_factored_4", "fluence_factored_8"])
def test_the_techniques_read_what_the_bake_writes(name: str) -> None:
    rank = int(name[-1])
    medium = Medium("test", (0.6,) * 3, (5.4,) * 3, 0.0, 1.0, "the test")
    scene = MeasuredScene("body", "body", Ball(0.5), Camera(), (), medium, None)
    traced = field.field(scene, Settings(voxels=8, side=16, photons=300), processes=0)
    stored = volumes.factored(traced, rank)
    names = {f"fluence_table_{rank}": Texture(stored.table, wrap="clamp")}
    for number in range(rank // 4):
        latents = stored.latents[..., 4 * number : 4 * number + 4] / 255.0
        names[f"fluence_latents_{rank}_{number + 1}"] = Texture(latents, "nearest", "clamp")
    size = traced.grid.high - traced.grid.low
    matrix = np.eye(4)
    matrix[[0, 1, 2], [0, 1, 2]], matrix[:3, 3] = 1.0 / size, -traced.grid.low / size
    constant = "thickness blocked(world_position p, world_direction l) { return thickness(1000.0); }"
    lit = technique(name, light_path=constant)
    centres = traced.grid.centres()[:, 0]
    chosen = np.flatnonzero(np.linalg.norm(centres, axis=1) < 0.3)[::7]
    light = traced.directions[100]
    zeros = np.zeros((len(chosen), 3))
    result = lit(
        d=np.full(len(chosen), 1e9), P=centres[chosen], V=zeros, L=zeros, L_object=np.tile(light, (len(chosen), 1)),
        extinction=(6.0,) * 3, scattering_albedo=(0.9,) * 3, world_to_volume=matrix, **names,
    )  # fmt: skip
    numbers = stored.latents.reshape(-1, rank)[chosen] / 255.0
    tiles = stored.table.reshape(18, rank + 1, 18, 3)[1 + 100 // 16, :, 1 + 100 % 16]
    close(result, 0.9 * np.maximum(tiles[0] + numbers @ tiles[1:], 0.0), rtol=1e-6)
    exact = 0.9 * traced.smooth[:, 100][:, traced.nearest[chosen]].T
    assert np.median(np.abs(result / exact - 1.0)) < 0.25


def test_the_technique_of_a_fixed_light() -> None:
    """Where the volume is even, the light is the part of the eye's ray that is seen times what is there."""
    constant = "thickness fixed_length(world_position p, world_direction l) { return thickness(0.3); }"
    lit = technique("fluence_fixed", light_path=constant)
    sigma, albedo, length = np.array([1.0, 3.0, 5.0]), np.array([0.9, 0.5, 0.1]), np.array([0.0, 0.1, 0.7, 1e9])
    zeros = np.zeros((4, 3))
    result = lit(
        d=length, P=zeros, V=zeros, L=zeros, extinction=sigma, scattering_albedo=albedo, mean_free_path=1.0 / 3.0,
        fluence_volume=Texture(np.full((2, 2, 2, 3), 0.5), wrap="clamp"), fluence_scale=(1.0, 2.0, 4.0),
        world_to_volume=np.eye(4),
    )  # fmt: skip
    light = 0.25 * np.exp(-0.3 * sigma) + 0.25 * np.array([1.0, 2.0, 4.0])
    close(result, albedo * (1.0 - np.exp(-sigma * length[:, None])) * light, rtol=1e-9)
