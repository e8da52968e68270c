"""The scene of an imported material: its mesh or a ball, in front of surroundings, with a lamp on each side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sssgen.interchange.imported_view import ImportedView
from sssgen.interchange.surface_model import SurfaceModel
from sssgen.interchange.technique_choice import Choice
from sssgen.material.material_text import toml_value
from sssgen.scene.arrays import Array
from sssgen.scene.camera import Camera
from sssgen.scene.mesh_files import FileContent
from sssgen.scene.scene import Light

_BALL_RADIUS, _SCATTERED_RADIUS, _CLEAR_RADIUS = 1.0, 6.0, 0.75
"""The largest radius of the ball of a material without a mesh: metres, and mean free paths of media with and without
scattering, so that light comes through."""
_VIEW = (0.45, 0.35, 1.0)
"""The direction towards the camera."""
_FIELD_OF_VIEW = 35.0
_MARGIN = 0.88
"""The share of the picture that the bodies fill."""
_HEIGHT = 480
_INTENSITY = 1.6
"""Of the surroundings."""
_LAMPS = (
    Light(None, (-0.6, 0.5, -0.6), (2.0, 1.9, 1.8)),
    Light(None, (0.7, 0.6, 0.5), (1.2, 1.2, 1.25)),
)
"""One behind the body, one in front of it."""
_LARGEST_ANISOTROPY = 0.95
"""Of the section [medium]."""


def ball_radius(model: SurfaceModel) -> float:
    """The radius in metres of the ball of a material without a mesh."""
    interior = model.interior
    if interior is None or not any(interior.extinction):
        return _BALL_RADIUS
    paths = _SCATTERED_RADIUS if any(interior.scattering) else _CLEAR_RADIUS
    return min(_BALL_RADIUS, paths * interior.mean_free_path)


def scene_text(model: SurfaceModel, choice: Choice, name: str, mesh: FileContent | None, surroundings: str) -> str:
    """The scene file beside the material; its unit is that of the material."""
    title = "".join(filter(str.isprintable, " ".join(model.name.split())))
    radius = ball_radius(model)
    camera = framed(radius * np.concatenate([np.eye(3), -np.eye(3)]) if mesh is None else _used(mesh), 1.0)
    lines = [
        f"# {title or name}, imported. A world unit is {choice.metres:g} m.",
        "",
        *_keys(material=f"{name}.toml", size=[480, 480], samples=2, background="environment"),
        *_section("shell", tone_mapping="khronos_neutral", **({} if model.unlit else _LIT)),
        *_section("environment", file=f"../{surroundings}", intensity=_INTENSITY),
    ]
    if mesh is None:
        lines += _section("geometry", kind="ball", radius=radius / choice.metres)
    else:
        lines += _section("geometry", kind="mesh", file="mesh.glb", scale=1.0 / choice.metres)
    lines += _view(camera, _LAMPS, choice.metres)
    if model.interior is not None:
        lines += _medium(model, choice.metres)
    if choice.clamped:
        lines += ["", "[textures]"]
        lines += [f'{key} = {{ file = {toml_value(file)}, wrap = "clamp" }}' for key, file in choice.clamped.items()]
    return "\n".join(lines) + "\n"


def whole_scene_text(
    source: str, scenes: Sequence[str], meshes: Sequence[FileContent], view: ImportedView, metres: float,
    surroundings: str,
) -> str:  # fmt: skip
    """The scene of all bodies of a file together: those of `scenes`, whose triangles are `meshes`."""
    camera = view.camera or framed(np.concatenate([_used(mesh) for mesh in meshes]), view.aspect)
    lines = [
        f"# {source}, imported: all its bodies. A world unit is {metres:g} m.",
        "",
        "bodies = [",
        *(f"    {toml_value(scene)}," for scene in scenes),
        "]",
        *_keys(size=[round(_HEIGHT * view.aspect), _HEIGHT], samples=2, background="environment"),
        *_section("shell", tone_mapping="khronos_neutral", **_LIT),
        *_section("environment", file=surroundings, intensity=_INTENSITY),
        *_view(camera, view.lights or _LAMPS, metres),
    ]
    return "\n".join(lines) + "\n"


def framed(points: Array, aspect: float) -> Camera:
    """The camera that sees all points (n, 3) in a picture of this width over its height, from the front and above."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre, size = 0.5 * (low + high), max(float(np.linalg.norm(high - low)), 1e-6)
    away = np.array(_VIEW) / np.linalg.norm(_VIEW)
    right, up, forward = Camera(tuple(away), (0.0, 0.0, 0.0)).axes()
    x, y, z = np.stack([right, up, forward]) @ (points - centre).T
    half_height = _MARGIN * np.tan(np.radians(0.5 * _FIELD_OF_VIEW))
    needed = np.maximum(np.abs(y) / half_height, np.abs(x) / (half_height * aspect)) - z
    distance = max(float(needed.max()), 0.01 * size)
    return Camera(_vector(centre + distance * away), _vector(centre), _FIELD_OF_VIEW)


def _view(camera: Camera, lights: Sequence[Light], metres: float) -> list[str]:
    """The sections of a camera and of lights that are in metres."""
    position, target = (np.array(place) / metres for place in (camera.position, camera.target))
    lines = _section(
        "camera", position=position.tolist(), target=target.tolist(), field_of_view=float(camera.field_of_view)
    )
    for light in lights:
        if light.direction is not None:
            lines += _section("[light]", direction=[*light.direction], color=[*light.color])
        elif light.position is not None:
            place, color = np.array(light.position) / metres, np.array(light.color) / metres**2
            lines += _section("[light]", position=place.tolist(), color=color.tolist())
    return lines


def _used(mesh: FileContent) -> Array:
    """The vertices that triangles have."""
    used: Array = mesh.vertices[np.unique(mesh.faces)]
    return used


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z


_LIT: Mapping[str, object] = {"environment": "prefiltered_environment"}


def _medium(model: SurfaceModel, metres: float) -> list[str]:
    """The section of the physical medium, which `sssgen fit`, `chart` and `pick` read."""
    assert model.interior is not None
    interior = model.interior
    return _section(
        "medium",
        absorption=[part * metres for part in interior.absorption],
        scattering=[part * metres for part in interior.scattering],
        anisotropy=float(np.clip(interior.anisotropy, -_LARGEST_ANISOTROPY, _LARGEST_ANISOTROPY)),
        ior=min(max(model.ior, 1.0), 3.0),
    )


def _section(title: str, **values: object) -> list[str]:
    return ["", f"[{title}]", *_keys(**values)]


def _keys(**values: object) -> Sequence[str]:
    return [f"{key} = {toml_value(value)}" for key, value in values.items()]
