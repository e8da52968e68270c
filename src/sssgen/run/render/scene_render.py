"""Renders a scene on a back end: draws the emitted shader and makes a picture.

    picture = render(scene_loading.load("lantern.toml"), backends.get("gl"))
    images.write_png("lantern.png", picture.encoded)

Every back end shades the same points with the same shader (see `pixel_mesh`), n × n samples per pixel, which are
averaged in linear light.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.material.shell_stages import NONE, with_shell
from sssgen.pipeline.compiler import Compiled, compile
from sssgen.run.backend_registry import check_draws
from sssgen.run.backends import Array, Backend
from sssgen.run.render import pixel_mesh
from sssgen.run.render.bake_warnings import bake_warnings
from sssgen.run.render.environment_maps import reflection_map
from sssgen.run.render.eye_pictures import with_eye_pictures
from sssgen.run.render.mesh_needs import mesh_diagnostics
from sssgen.run.render.missing_textures import MissingTextures, missing_textures
from sssgen.run.render.picture_warnings import exposure_warnings, warnings_of
from sssgen.run.render.scene_values import environment_of, shell_of
from sssgen.run.render.screen_window import Window, whole_window, window_of
from sssgen.run.render.several_bodies import Body, Canvas, in_order
from sssgen.run.render.shade import shade
from sssgen.run.render.shell_values import Shell
from sssgen.run.render.texture_warnings import texture_warnings
from sssgen.scene.geometry import Hits
from sssgen.scene.pictures.images import decode_srgb, encode_srgb
from sssgen.scene.pictures.resizing import resized
from sssgen.scene.scene import Scene
from sssgen.scene.scene_loading import bodies_of
from sssgen.scene.scene_reader import MAX_COUNT
from sssgen.support.diagnostics import Diagnostic, failure
from sssgen.support.progress import Progress, silent
from sssgen.targets.descriptor import Target
from sssgen.targets.reflection_record import EntryRecord, Reflection

LARGEST = 8192
"""The largest number of samples along a side: the largest picture that every driver supports."""

_SOFTNESS = 4
"""Pixels along a texel of the environment that is shown: it is not sharp."""
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
    scene = dataclasses.replace(scene, size=size or scene.size, time=scene.time if time is None else time)
    width, height = (side * scene.samples for side in scene.size)
    if max(width, height) + 2 * pixel_mesh.BORDER > LARGEST or width * height > MAX_COUNT:
        raise failure(
            f"{scene.size[0]} × {scene.size[1]} pixels of {scene.samples} × {scene.samples} samples are too many",
            f"at most {LARGEST - 2 * pixel_mesh.BORDER} samples on a side, and {MAX_COUNT / 1e6:.0f} million in all",
        )
    if scene.bodies:
        return _render_bodies(scene, backend, guards, progress)
    if not scene.material:
        raise failure("the scene names no material", 'add: material = "…"', scene.document.reporter.file)
    progress(0, STEPS, "compiling the material")
    material, compiled = _compile(scene, scene.shell, backend, guards)
    reflection = compiled.reflection
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
    color, cover = _checked(reflection, samples, hit)
    warnings = _warnings(scene, material, reflection, hit, front)
    warnings += exposure_warnings(scene, scene.exposure * color * cover[..., None], hit)
    return _develop(scene, color, cover)._replace(warnings=warnings)


def _warnings(scene: Scene, material: Material, reflection: Reflection, hit: Array, front: Array) -> list[Diagnostic]:
    """What is doubtful of the picture of a body."""
    return [
        *warnings_of(scene, hit, front),
        *mesh_diagnostics(scene, material),
        *texture_warnings(scene, material, reflection),
        *bake_warnings(scene, material, reflection),
    ]


def with_samples(scene: Scene, samples: int) -> Scene:
    """The scene with n × n samples per pixel."""
    return dataclasses.replace(scene, samples=samples)


def _reads_rays(entry: EntryRecord) -> bool:
    return bool({"ray_origin", "ray_direction"} & set(entry["inputs"]))


def _compile(scene: Scene, shell: Mapping[str, str], backend: Backend, guards: str) -> tuple[Material, Compiled]:
    """The scene's material with the techniques of a shell, and its shader."""
    # an engine has its own shadows, surroundings and tone mapping
    roles = [f"{role}={name}" for role, name in shell.items() if role in backend.target.shell]
    material = with_shell(load_material(scene.material), roles)
    return material, compile(material, backend.target.name, guards=guards)


def _surface(
    scene: Scene, compiled: Compiled, shell: Shell, backend: Backend, size: tuple[int, int], progress: Progress
) -> tuple[Array, Array, Array]:
    """The samples of a surface, which of them hit it, and which show it from outside."""
    progress(1, STEPS, "casting the eye's rays")
    mesh = place_mesh(scene, compiled, shell, backend.target, size)
    progress(2, STEPS, f"drawing on {backend.name}")
    picture = _shade_mesh(backend, compiled, mesh)
    return _without_border(picture), _without_border(mesh.hit), _without_border(mesh.front)


def _shade_mesh(backend: Backend, compiled: Compiled, mesh: PlacedMesh) -> Array:
    """The picture with its border, (height, width, 4), row 0 at the bottom."""
    picture = shade(backend, compiled, mesh.shell, mesh.size, mesh.points)
    if compiled.reflection["two_sided"] and not mesh.front.all():
        # which triangle covers a pixel's centre is the driver's choice, so each side is drawn on its own
        behind = shade(backend, compiled, dataclasses.replace(mesh.shell, front=False), mesh.size, mesh.points)
        picture = np.where(mesh.front[..., None], picture, behind)
    return picture


def _without_border(picture: Array) -> Array:
    edge = pixel_mesh.BORDER
    return picture[edge:-edge, edge:-edge]


def _render_bodies(scene: Scene, backend: Backend, guards: str, progress: Progress) -> RenderedPicture:
    """The picture of a scene with several bodies. Raises SssgenError as `render`."""
    if "tone_mapping" not in backend.target.shell:
        hint = "choose gl, webgpu or another back end without an engine"
        raise failure(f"{backend.name} draws one body in a picture", hint, scene.document.reporter.file)
    size = scene.size[0] * scene.samples, scene.size[1] * scene.samples
    wider, padded = _with_border(scene, size)
    canvas = Canvas(backdrop(wider, padded) / scene.exposure)
    bodies = []
    shell = {**scene.shell, "tone_mapping": NONE}
    for part in bodies_of(scene):
        material, compiled = _compile(part, shell, backend, guards)
        values = shell_of(part, material, compiled.reflection)
        if missing := missing_textures(part, material, compiled.reflection, values.textures):
            raise MissingTextures(missing)
        if compiled.reflection["raymarched"]:
            raise failure(f"{material.name} marches its own rays: it is drawn alone", "", part.document.reporter.file)
        bodies.append(Body(part, material, compiled, values))
    warnings: list[Diagnostic] = []
    for number, body in enumerate(in_order(bodies, scene.camera)):
        progress(number, len(bodies), f"drawing {body.compiled.reflection['material']}")
        window = window_of(body.corners, wider.camera, padded)
        if window is None:
            continue
        mesh = place_window(body.scene, body.compiled, body.shell, backend.target, window, lambda: canvas.color)
        if not canvas.shows(window, mesh.distance):
            continue
        color, cover = _checked(body.compiled.reflection, _shade_mesh(backend, body.compiled, mesh), mesh.hit)
        canvas.draw(body, window, color, cover, mesh.distance)
        noted = _warnings(body.scene, body.material, body.compiled.reflection, mesh.hit, mesh.front)
        warnings += [warning for warning in noted if warning not in warnings]  # those of lights are of all bodies
    linear = canvas.tone_mapped(scene.shell) * scene.exposure
    warnings += exposure_warnings(scene, linear, canvas.covered)
    return RenderedPicture(
        _average(_without_border(linear), scene.samples)[::-1],
        _average(_without_border(canvas.covered[..., None].astype(float)), scene.samples)[::-1, :, 0],
        warnings,
    )


class PlacedMesh(NamedTuple):
    """The points of a scene that a window of a picture shows, as a mesh."""

    shell: Shell
    window: Window
    points: Array
    """`pixel_mesh.vertices`."""
    hits: Hits

    @property
    def size(self) -> tuple[int, int]:
        """Of the window."""
        return self.window.size

    @property
    def hit(self) -> Array:
        """(height, width): whether a pixel shows the surface."""
        return self.hits.hit.reshape(self.size[::-1])

    @property
    def front(self) -> Array:
        """Likewise, whether it shows a front face."""
        return (self.hits.front | ~self.hits.hit).reshape(self.size[::-1])

    @property
    def distance(self) -> Array:
        """Likewise, the distance from the eye; inf where there is no surface, and on the border."""
        length = np.linalg.norm(self.hits.position - self.window.camera.position, axis=1)
        distance = np.where(self.hits.hit, length, np.inf).reshape(self.size[::-1])
        border = np.ones_like(distance, bool)
        border[pixel_mesh.BORDER : -pixel_mesh.BORDER, pixel_mesh.BORDER : -pixel_mesh.BORDER] = False
        return np.where(border, np.inf, distance)


def _with_border(scene: Scene, size: tuple[int, int]) -> tuple[Scene, tuple[int, int]]:
    """The scene with a camera that sees the border too, and the size with it."""
    (width, height), edge = size, pixel_mesh.BORDER
    padded = width + 2 * edge, height + 2 * edge
    half_angle = math.tan(math.radians(0.5 * scene.camera.field_of_view)) * padded[1] / height
    wider = dataclasses.replace(scene.camera, field_of_view=2.0 * math.degrees(math.atan(half_angle)))
    return dataclasses.replace(scene, camera=wider), padded


def place_mesh(scene: Scene, compiled: Compiled, shell: Shell, target: Target, size: tuple[int, int]) -> PlacedMesh:
    """The mesh of a scene's points, with the border, and the shell with its camera and what the program draws of it."""
    wider, padded = _with_border(scene, size)
    behind = lambda: backdrop(wider, padded) / scene.exposure  # noqa: E731
    return place_window(wider, compiled, shell, target, whole_window(wider.camera, padded), behind)


def place_window(
    scene: Scene, compiled: Compiled, shell: Shell, target: Target, window: Window, behind: Callable[[], Array]
) -> PlacedMesh:
    """The same for a window; `behind` makes the linear picture of all else, of the whole screen."""
    assert scene.geometry is not None
    origin, directions = window.rays()
    hits = scene.geometry.hits(origin, directions)
    points = pixel_mesh.vertices(hits, origin, directions, shell.model, window.size)
    far = float(np.linalg.norm(points[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3] - origin, axis=1).max())
    deep = dataclasses.replace(scene, camera=dataclasses.replace(window.camera, near=1e-3 * far, far=2.0 * far))
    matrix = window.to_clip() @ _matrix(deep, target, window.whole[0] / window.whole[1])
    shell = dataclasses.replace(shell, view_projection=matrix)
    return PlacedMesh(
        with_eye_pictures(shell, scene.geometry, compiled.reflection, window, hits, behind), window, points, hits
    )


def _matrix(scene: Scene, target: Target, aspect: float) -> Array:
    """World to clip space in the target's depth range."""
    low = (target.conventions.clip_z or (-1.0,))[0]
    return scene.camera.view_projection(aspect, zero_to_one=low == 0.0)


def _develop(scene: Scene, color: Array, cover: Array) -> RenderedPicture:
    """Composites samples over the background, averages them to pixels, and flips rows so that row 0 is at the top."""
    height, width = cover.shape
    exposed = color * scene.exposure
    mixed = exposed * cover[..., None] + backdrop(scene, (width, height)) * (1.0 - cover[..., None])
    return RenderedPicture(_average(mixed, scene.samples)[::-1], _average(cover[..., None], scene.samples)[::-1, :, 0])


def _checked(reflection: Reflection, samples: Array, hit: Array) -> tuple[Array, Array]:
    """The linear colours (height, width, 3) of samples, and how much each covers, both 0 beside the body. Raises
    SssgenError for NaN."""
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
    return np.where(hit[..., None], color, 0.0), np.where(hit, solid[reflection["alpha_mode"]], 0.0)


def backdrop(scene: Scene, size: tuple[int, int]) -> Array:
    """What a picture of this size shows beside the bodies, (height, width, 3), row 0 at the bottom."""
    width, height = size
    environment = environment_of(scene) if scene.shows_environment else None
    if environment is not None:
        coarse = -(-width // _SOFTNESS), -(-height // _SOFTNESS)
        _, directions = scene.camera.rays(*coarse)
        light = reflection_map(environment).sample(directions.T)[:3].T.reshape(*coarse[::-1], 3)
        return scene.exposure * resized(light, width, height)
    up = ((np.arange(height) + 0.5) / height)[:, None, None]
    colors = np.array(scene.background[0]) * (1.0 - up) + np.array(scene.background[1]) * up
    return np.broadcast_to(colors, (height, width, 3))


def _average(samples: Array, n: int) -> Array:
    height, width, channels = samples.shape
    pixels: Array = samples.reshape(height // n, n, width // n, n, channels).mean(axis=(1, 3))
    return pixels
