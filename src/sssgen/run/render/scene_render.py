"""Renders a scene on a back end: draws the emitted shader and makes a picture.

    picture = render(scene_loading.load("lantern.toml"), backends.get("gl"))
    images.write_png("lantern.png", picture.encoded)

Every back end shades the same points with the same shader (see `pixel_mesh`), n × n samples per pixel, which are
averaged in linear light.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sssgen.material.material_loading import load_material
from sssgen.material.shell_stages import with_shell
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.run.backend_registry import check_draws
from sssgen.run.backends import Array, Backend
from sssgen.run.render import pixel_mesh
from sssgen.run.render.eye_pictures import with_eye_pictures
from sssgen.run.render.missing_textures import MissingTextures, missing_textures
from sssgen.run.render.picture_warnings import warnings_of
from sssgen.run.render.scene_values import shell_of
from sssgen.run.render.shade import shade
from sssgen.run.render.shell_values import Shell
from sssgen.scene.pictures.images import decode_srgb, encode_srgb
from sssgen.scene.scene import Scene
from sssgen.scene.scene_reader import MAX_COUNT
from sssgen.support.diagnostics import Diagnostic, failure
from sssgen.support.progress import Progress, silent
from sssgen.targets.descriptor import Target
from sssgen.targets.reflection_record import EntryRecord, Reflection

LARGEST = 8192
"""The largest number of samples along a side: the largest picture that every driver supports."""

STEPS = 3
"""Of a render: compile, cast rays, draw."""


class RenderedPicture(NamedTuple):
    """A picture, row 0 at the top."""

    linear: Array
    """(height, width, 3): linear light, exposed, over the background; not clamped."""
    covered: Array
    """(height, width): the share of each pixel that is not background, 0 to 1."""
    warnings: Sequence[Diagnostic] = ()
    """What makes the picture wrong, though it can be drawn"""

    @property
    def encoded(self) -> Array:
        """(height, width, 3): sRGB, 0..1."""
        return encode_srgb(self.linear)


def render(
    scene: Scene,
    backend: Backend,
    size: tuple[int, int] | None = None,
    time: float | None = None,
    guards: str = "auto",
    progress: Progress = silent,
) -> RenderedPicture:
    """The picture of a scene. `size` and `time` override the scene's; `guards` as in `compile`.

    Raises MissingTextures where a baked texture or a named file is missing, and SssgenError for a scene that does not
    fit its material, a picture that is too large, and a back end that draws no scenes or refuses this one.
    """
    check_draws(backend.name)
    if not scene.material:
        raise failure("the scene names no material", 'add: material = "…"', scene.document.reporter.file)
    scene = dataclasses.replace(scene, size=size or scene.size, time=scene.time if time is None else time)
    # an engine has its own shadows, surroundings and tone mapping
    shell_roles = [f"{role}={name}" for role, name in scene.shell.items() if role in backend.target.shell]
    material = with_shell(load_material(scene.material), shell_roles)
    progress(0, STEPS, "compiling the material")
    compiled = compile(material, backend.target.name, guards=guards)
    reflection = compiled.reflection
    width, height = (side * scene.samples for side in scene.size)
    if max(width, height) + 2 * pixel_mesh.BORDER > LARGEST or width * height > MAX_COUNT:
        raise failure(
            f"{scene.size[0]} × {scene.size[1]} pixels of {scene.samples} × {scene.samples} samples are too many",
            f"at most {LARGEST - 2 * pixel_mesh.BORDER} samples on a side, and {MAX_COUNT / 1e6:.0f} million in all",
        )
    raymarched = reflection["raymarched"] or any(_reads_rays(entry) for entry in reflection["entries"].values())
    if not raymarched and scene.geometry is None:
        raise failure(
            f"{material.name} needs a surface to be on", "add [geometry] to the scene", scene.document.reporter.file
        )
    shell = shell_of(scene, material, reflection)
    if missing := missing_textures(scene, material, reflection, shell.textures):
        raise MissingTextures(missing)
    if raymarched:
        progress(2, STEPS, f"drawing on {backend.name}")
        shell = dataclasses.replace(shell, view_projection=_matrix(scene, backend.target, width / height))
        samples = shade(backend, compiled, shell, (width, height), None)
        hit = front = np.ones((height, width), bool)
    else:
        samples, hit, front = _surface(scene, compiled, shell, backend, (width, height), progress)
    return _develop(scene, reflection, samples, hit)._replace(warnings=warnings_of(scene, reflection, hit, front))


def with_samples(scene: Scene, samples: int) -> Scene:
    """The scene with n × n samples per pixel."""
    return dataclasses.replace(scene, samples=samples)


def _reads_rays(entry: EntryRecord) -> bool:
    return bool({"ray_origin", "ray_direction"} & set(entry["inputs"]))


def _surface(
    scene: Scene, compiled: Compiled, shell: Shell, backend: Backend, size: tuple[int, int], progress: Progress
) -> tuple[Array, Array, Array]:
    """The samples of a surface, which of them hit it, and which show it from outside."""
    (width, height), edge = size, pixel_mesh.BORDER
    progress(1, STEPS, "casting the eye's rays")
    mesh = place_mesh(scene, compiled, shell, backend.target, size)
    inner = slice(edge, edge + height), slice(edge, edge + width)
    progress(2, STEPS, f"drawing on {backend.name}")
    picture = shade(backend, compiled, mesh.shell, mesh.size, mesh.points)
    if compiled.reflection["two_sided"] and not mesh.front.all():
        # which triangle covers a pixel's centre is the driver's choice, so each side is drawn on its own
        behind = shade(backend, compiled, dataclasses.replace(mesh.shell, front=False), mesh.size, mesh.points)
        picture = np.where(mesh.front[..., None], picture, behind)
    return picture[inner], mesh.hit[inner], mesh.front[inner]


class PlacedMesh(NamedTuple):
    """The points of a scene that a picture shows, as a mesh."""

    shell: Shell
    size: tuple[int, int]
    """Of the picture with its border."""
    points: Array
    """`pixel_mesh.vertices`."""
    hit: Array
    """(height, width): whether a pixel shows the surface."""
    front: Array
    """Likewise, whether it shows a front face."""


def place_mesh(scene: Scene, compiled: Compiled, shell: Shell, target: Target, size: tuple[int, int]) -> PlacedMesh:
    """The mesh of a scene's points, and the shell with its camera and what the program draws of it."""
    assert scene.geometry is not None
    (width, height), edge = size, pixel_mesh.BORDER
    padded = width + 2 * edge, height + 2 * edge
    half_angle = math.tan(math.radians(0.5 * scene.camera.field_of_view)) * padded[1] / height
    wider = dataclasses.replace(scene.camera, field_of_view=2.0 * math.degrees(math.atan(half_angle)))
    origin, directions = wider.rays(*padded)
    hits = scene.geometry.hits(origin, directions)
    points = pixel_mesh.vertices(hits, origin, directions, shell.model, padded)
    far = float(np.linalg.norm(points[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3] - origin, axis=1).max())
    deep = dataclasses.replace(scene, camera=dataclasses.replace(wider, near=1e-3 * far, far=2.0 * far))
    matrix = _matrix(deep, target, padded[0] / padded[1])
    shell = dataclasses.replace(shell, view_projection=matrix)
    shell = with_eye_pictures(shell, scene.geometry, compiled.reflection, wider, hits, padded)
    shape = padded[1], padded[0]
    return PlacedMesh(shell, padded, points, hits.hit.reshape(shape), (hits.front | ~hits.hit).reshape(shape))


def _matrix(scene: Scene, target: Target, aspect: float) -> Array:
    """World to clip space in the target's depth range."""
    low = (target.conventions.clip_z or (-1.0,))[0]
    return scene.camera.view_projection(aspect, zero_to_one=low == 0.0)


def _develop(scene: Scene, reflection: Reflection, samples: Array, hit: Array) -> RenderedPicture:
    """Composites samples over the background, averages them to pixels, and flips rows so that row 0 is at the top."""
    height, width = hit.shape
    color, alpha = samples[..., :3].astype(np.float64), samples[..., 3].astype(np.float64)
    if reflection["color"] == "encoded":
        color = decode_srgb(color)
    if not (np.isfinite(color) | ~hit[..., None]).all():
        bad = int((~np.isfinite(color) & hit[..., None]).any(axis=-1).sum())
        raise failure(
            f"{bad} of {hit.size} samples are NaN or infinite",
            "a guard is missing: find the operation with sssgen eval",
        )
    solid = {"opaque": np.ones_like(alpha), "mask": (alpha > 0.0).astype(float), "blend": np.clip(alpha, 0.0, 1.0)}
    cover = np.where(hit, solid[reflection["alpha_mode"]], 0.0)
    up = ((np.arange(height) + 0.5) / height)[:, None, None]
    behind = np.array(scene.background[0]) * (1.0 - up) + np.array(scene.background[1]) * up
    exposed = np.where(hit[..., None], color, 0.0) * scene.exposure
    mixed = exposed * cover[..., None] + np.broadcast_to(behind, (height, width, 3)) * (1.0 - cover[..., None])
    return RenderedPicture(_average(mixed, scene.samples)[::-1], _average(cover[..., None], scene.samples)[::-1, :, 0])


def _average(samples: Array, n: int) -> Array:
    height, width, channels = samples.shape
    pixels: Array = samples.reshape(height // n, n, width // n, n, channels).mean(axis=(1, 3))
    return pixels
