"""The fluence of a scene's body as textures for measured chains, baked when a chain reads one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np

from sssgen.jobs.executor import Failure, Item, Progress, run
from sssgen.lab.fluence import fluence_field as field
from sssgen.lab.fluence import fluence_volumes as volumes
from sssgen.lab.fluence.traced_body import fitting_voxels, grid_in_box
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render.inner_light import surroundings
from sssgen.scene.bounds import world_corners
from sssgen.scene.environment import Environment
from sssgen.scene.light_response import LightResponse, from_light, volume
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.scene import Light
from sssgen.support.diagnostics import failure
from sssgen.targets.runtime.numpy_textures import Texture

PREFIX = "fluence_"
"""The names of the textures begin with it."""
RANKS = (4, 8)
"""The ranks of the techniques fluence_factored_N."""
LATENTS = 4
"""The numbers in a texel of a volume."""
INNER, RANK = "inner_light", 32
"""The volume of the technique fluence_relit, and the numbers in a voxel of its bake."""


def of_light(scene: MeasuredScene, light: Light) -> dict[str, Callable[[], Texture]]:
    """The textures of `sssgen bake fluence` by their names in techniques, for a white light."""
    if scene.medium is None:
        return {}
    white = dataclasses.replace(light, color=(1.0, 1.0, 1.0))
    computed: dict[str, Callable[[], Texture]] = {
        "fluence_volume": partial(_light_volume, scene, light), INNER: partial(inner_light, scene, (white,)),
    }  # fmt: skip
    for rank in RANKS:
        computed[f"fluence_table_{rank}"] = partial(_table, scene, rank)
        for number in range(rank // LATENTS):
            computed[f"fluence_latents_{rank}_{number + 1}"] = partial(_latents, scene, rank, number)
    return computed


def texels(name: str, scene: MeasuredScene) -> int:
    """The texels of a texture by its name in techniques; 0 for textures of other kinds."""
    if name.startswith("fluence_table_"):
        side = field.Settings().side + 2
        return side * side * volumes.tiles_of(int(name.rpartition("_")[2]))
    return grid_in_box(scene, fitting_voxels(scene)).voxels if name.startswith((PREFIX, INNER)) else 0


def reach(scene: MeasuredScene) -> float:
    """The largest distance in the volume of a fixed light, in world units."""
    return volumes.reach_of(grid_in_box(scene, fitting_voxels(scene))) * scene.geometry.scale


def prepare(
    scene: MeasuredScene, scheduler: str, processes: int | None, progress: Progress, directions: bool = True
) -> None:
    """Computes the fluence of a scene's body, of its lights and, with `directions`, of light from all directions.

    Chains of several processes find it in the store; otherwise each process would compute it. Raises SssgenError.
    """
    if scene.medium is None:
        return
    alone = _without_view(scene)
    settings = field.settings_for(alone)
    if directions:
        field.field(alone, settings, scheduler, processes, progress)
        run([_response_item(alone)], scheduler, processes, progress=progress)
    for light in scene.lights:
        field.of_light(alone, _towards(scene, light), settings, scheduler, processes, progress)


@lru_cache(4)
def _field(scene: MeasuredScene) -> field.Field:
    # this runs inside a worker already: in the process of the worker
    return field.field(scene, field.settings_for(scene), processes=0)


@lru_cache(8)
def _volumes(scene: MeasuredScene, rank: int) -> volumes.FactoredVolumes:
    return volumes.factor_field(_field(_without_view(scene)), rank)


def _without_view(scene: MeasuredScene) -> MeasuredScene:
    """The same scene for all of its views and lights, which do not change the fluence."""
    return scene.body_alone()


def _table(scene: MeasuredScene, rank: int) -> Texture:
    return Texture(_volumes(_without_view(scene), rank).table.astype(np.float16), wrap="clamp")


def _latents(scene: MeasuredScene, rank: int, number: int) -> Texture:
    stored = _volumes(_without_view(scene), rank).latents[..., LATENTS * number : LATENTS * (number + 1)]
    return Texture(stored / 255.0, wrap="clamp")


def _towards(scene: MeasuredScene, light: Light) -> Array:
    """The unit direction from the body's centre towards a light, in object space."""
    centre = world_corners(scene.geometry).mean(axis=0)
    towards = np.array(light.direction) if light.position is None else np.array(light.position) - centre
    turned = scene.geometry.to_object()[:3, :3] @ towards
    unit: Array = turned / np.linalg.norm(turned)
    return unit


@lru_cache(4)
def response_of(scene: MeasuredScene) -> LightResponse:
    """The response of a body to light from anywhere. Raises SssgenError."""
    (result,) = run([_response_item(scene)], processes=0)
    if isinstance(result, Failure):
        raise failure(f"{result.name}: {result.message}", result.hint)
    packed: LightResponse = result
    return packed


def _response_item(scene: MeasuredScene) -> Item:
    arguments = scene, RANK, field.settings_for(scene)
    return Item("sssgen.lab.fluence.response:packed", arguments, f"response of {scene.name}")


def inner_light(scene: MeasuredScene, lights: tuple[Light, ...], environment: Environment | None = None) -> Texture:
    """The light at each voxel, of all these lights and the surroundings."""
    return _lit(_without_view(scene), lights, environment)


@lru_cache(8)
def _lit(scene: MeasuredScene, lights: tuple[Light, ...], environment: Environment | None) -> Texture:
    to_object, body = scene.geometry.to_object(), response_of(scene)
    incoming = [from_light(body, light, to_object) for light in lights]
    return half(Texture(volume(body, incoming, surroundings(environment, to_object)), wrap="clamp"))


@lru_cache(8)
def _light_volume(scene: MeasuredScene, light: Light) -> Texture:
    """The light at each voxel; the scale is part of the texels, whose steps are those of the stored volume."""
    alone = _without_view(scene)
    traced = field.of_light(alone, _towards(scene, light), field.settings_for(alone), processes=0)
    stored = volumes.light_volume(traced)
    return Texture(stored.texels / 255.0 * np.append(np.sqrt(stored.scale), 1.0), wrap="clamp")
