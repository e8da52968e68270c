"""Fluence volumes of a body: the files for the techniques fluence_factored_4, fluence_factored_8 and fluence_fixed, and
for those with the ending _refracted if the medium has a refractive index.

The light is traced through the body with its boundary (see `sssgen.lab.fluence`); the JSON states its standard error.
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sssgen.bake import memory_check as memory
from sssgen.bake.bake_facts import FluenceFacts, MediumFacts
from sssgen.bake.bake_light import BakeLight
from sssgen.jobs.executor import Progress
from sssgen.lab.fluence import fluence_field
from sssgen.lab.fluence import fluence_volumes as volumes
from sssgen.lab.fluence.exchange import solver_bytes
from sssgen.lab.fluence.fluence_field import Field, Settings
from sssgen.lab.fluence.traced_body import grid_in_box, projection_of
from sssgen.lab.fluence.voxels import Grid
from sssgen.scene import body_identity, geometry_mesh
from sssgen.scene.camera import Camera
from sssgen.scene.geometry import Mesh
from sssgen.scene.measured import measured_scene, media
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.mesh_files import SUFFIXES
from sssgen.scene.mesh_suitability import overlap
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix, stem
from sssgen.support.text_files import refuse_folder
from sssgen.targets.texture_import import import_settings

RANKS = (4, 8)
OPAQUE = 3.0
"""The optical depth of a voxel above which light does not reach from one voxel to the next: the bake warns."""
MOST_OPAQUE = 10.0
"""The optical depth of a voxel above which a bake is refused: all light ends in the first voxel."""
LEAST_SCATTERING = 0.05
"""The scattering along the longest side, in mean free paths, below which a bake is refused: nearly no path scatters, so
that the noise of the few that do is larger than the light."""
MOST_OVERLAP = 0.01
"""The share of a mesh's surface inside other parts of it above which a bake is refused."""
BYTES = 3 * 6 * 8
"""Bytes of memory for each voxel and direction: three channels, of the field and of its factors."""


class Part(NamedTuple):
    """One texture of a bake."""

    suffix: str
    """Of the file's name, before its ending"""
    texels: npt.NDArray[Any]
    """(z, y, x, 4) bytes, or the table (height, width, 4)"""
    texture: str
    """Its name in the technique"""


class FluenceBake(NamedTuple):
    """The textures of a bake, and their facts for the JSON files."""

    parts: list[Part]
    facts: FluenceFacts


def body(path: str, medium: str, unit_mm: float) -> MeasuredScene:
    """The scene of a .toml file with [medium], or a mesh with a medium by name. Raises SssgenError."""
    if path.endswith(".toml"):
        if medium:
            raise failure("the scene has its own medium", "leave --medium out", posix(path))
        return measured_scene.load(path).body_alone()
    if not medium:
        raise failure("a mesh has no medium", "name one with --medium", posix(path))
    refuse_folder(path, SUFFIXES)
    if not os.path.isfile(path):
        raise failure("there is no such file", "name a mesh", posix(path))
    geometry = Mesh(path=path)
    name = stem(path)
    preset = media.preset(medium, unit_mm)
    contents = body_identity.contents(geometry)
    return MeasuredScene(name, name, geometry, Camera(), (), preset, None, contents=contents).body_alone()


def bake(
    scene: MeasuredScene, rank: int, light: BakeLight | None, settings: Settings, scheduler: str = "",
    processes: int | None = None, progress: Progress = lambda *_: None,
) -> FluenceBake:  # fmt: skip
    """The fluence as `rank` numbers a voxel for lights from afar, or for one `light`. Raises SssgenError."""
    if rank not in RANKS:
        raise failure(f"there is no technique of rank {rank}", f"ranks: {', '.join(map(str, RANKS))}")
    if light is not None and not light.afar:
        raise failure("the light has a position", 'a fluence volume is baked for a light from afar: {"direction": …}')
    check(scene, settings)
    assert scene.medium is not None
    if light is None:
        traced = fluence_field.field(scene, settings, scheduler, processes, progress)
        return FluenceBake(
            _factor(traced, rank),
            {
                **facts_of(scene, settings, traced),
                "rank": rank,
                "technique": f"fluence_factored_{rank}{variant(scene.medium)}",
            },
        )
    traced = fluence_field.of_light(scene, light.place, settings, scheduler, processes, progress)
    stored = volumes.light_volume(traced)
    facts: FluenceFacts = {
        **facts_of(scene, settings, traced), "light": light.facts(),
        "technique": f"fluence_fixed{variant(scene.medium)}",
    }  # fmt: skip
    facts["parameters"]["fluence_scale"] = [float(value) for value in stored.scale]
    facts["parameters"]["fluence_reach"] = stored.reach * scene.geometry.scale
    return FluenceBake([Part("", stored.texels, "fluence_volume")], facts)


def variant(medium: Medium) -> str:
    """The end of the name of the technique that reads a bake: behind a refracting surface it is another one."""
    return "_refracted" if medium.ior != 1.0 else ""


def check(scene: MeasuredScene, settings: Settings) -> None:
    """Raises SssgenError for a scene without a medium, settings out of range, or a body that they do not resolve."""
    if scene.medium is None:
        raise failure(f"'{scene.name}' has no medium", "add [medium] to the scene")
    if not 4 <= settings.voxels <= 128:
        raise failure(f"{settings.voxels} voxels are not between 4 and 128", "24 to 32 are enough")
    if not 2 <= settings.photons <= 10**7:
        raise failure(f"{settings.photons} photons are not between 2 and 10,000,000", "some thousands are enough")
    if settings.seed < 0:
        raise failure(f"{settings.seed} is not a seed", "0 or a larger integer")
    grid = grid_in_box(scene, settings.voxels)
    if isinstance(scene.geometry, Mesh):
        geometry_mesh.mesh_of(scene.geometry)  # refuses an open mesh before the work
        if (share := overlap(scene.geometry)) > MOST_OVERLAP:
            raise failure(
                f"{share:.0%} of the surface is inside another part of the mesh: light inside needs one surface",
                "make one surface of the parts, or delete the inner ones", posix(scene.geometry.path),
            )  # fmt: skip
    depth = max(scene.medium.extinction) * _voxel(scene, grid)
    if depth > MOST_OPAQUE:
        raise failure(
            f"a voxel is {depth:.3g} mean free paths long in one channel, and at most {MOST_OPAQUE:g} are traced",
            "use more voxels, or a smaller unit: --unit-mm, unit_mm of [medium]",
        )
    scattering = max(scene.medium.scattering) * _voxel(scene, grid) * max(grid.shape)
    if scattering < LEAST_SCATTERING:
        raise failure(
            f"the body is nearly clear: its longest side is {scattering:.2g} mean free paths of scattering, and at "
            f"least {LEAST_SCATTERING:g} are traced",
            "use the technique seen_through, which needs no bake, or a medium that scatters more",
        )
    inside = int(projection_of(scene, settings.voxels).counting.sum())
    if fluence_field.by_flights(scene):
        memory.check(inside * settings.side**2 * BYTES + solver_bytes(inside), "use fewer voxels")
    else:  # photons have estimates for all voxels of the grid
        memory.check(grid.voxels * settings.side**2 * BYTES, "use fewer voxels")


def _factor(traced: Field, rank: int) -> list[Part]:
    stored = volumes.factor_field(traced, rank)
    latents = [
        Part(
            f"_latents_{number + 1}", np.ascontiguousarray(stored.latents[..., 4 * number : 4 * number + 4]),
            f"fluence_latents_{rank}_{number + 1}",
        )
        for number in range(rank // 4)
    ]  # fmt: skip
    return [*latents, Part("_table", stored.table, f"fluence_table_{rank}")]


def facts_of(scene: MeasuredScene, settings: Settings, traced: Field) -> FluenceFacts:
    """What the JSON of every fluence bake has."""
    medium = scene.medium
    assert medium is not None
    voxel = _voxel(scene, traced.grid)
    matrix = np.eye(4)
    size = traced.grid.high - traced.grid.low
    matrix[[0, 1, 2], [0, 1, 2]] = 1.0 / size
    matrix[:3, 3] = -traced.grid.low / size
    return {
        "kind": "fluence", "holds": None,
        "body": body_identity.identity(scene.geometry, scaled=True),
        "medium": medium_facts(medium),
        "texels": list(traced.grid.shape), "voxel": voxel,
        "box_min": traced.grid.low.tolist(), "box_max": traced.grid.high.tolist(),
        "photons": settings.photons, "directions": len(traced.directions), "seed": settings.seed,
        "error": {"standard_error": traced.noise, "relative_to": "the mean value, before the factors average it"},
        "opaque_voxels": bool(max(medium.extinction) * voxel > OPAQUE),
        "object_to_volume": matrix.tolist(),
        # of a body that is not moved; an engine multiplies the matrix with world space to object space
        "parameters": {**medium.parameters, "world_to_volume": matrix.T.ravel().tolist()},
        "import": import_settings("3D", "clamp", mipmaps=False),
    }  # fmt: skip


def medium_facts(medium: Medium) -> MediumFacts:
    """The entry `medium` of a JSON file."""
    return {
        "name": medium.name, "extinction": [*medium.extinction], "albedo": [*medium.albedo],
        "anisotropy": medium.anisotropy, "ior": medium.ior, "roughness": medium.roughness,
    }  # fmt: skip


def _voxel(scene: MeasuredScene, grid: Grid) -> float:
    """The longest side of a voxel in world units."""
    return float(((grid.high - grid.low) / np.array(grid.shape)).max()) * scene.geometry.scale


def part_path(path: str, suffix: str, ending: str = "") -> str:
    """The path of a part's file: `wax.dds` with the suffix `_latents_1` is `wax_latents_1.dds`."""
    base, own = os.path.splitext(path)
    return f"{base}{suffix}{ending or own}"
