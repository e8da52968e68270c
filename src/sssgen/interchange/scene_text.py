"""The scene of an imported material: its mesh or a ball, in front of surroundings, with a lamp on each side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sssgen.interchange.surface_model import SurfaceModel
from sssgen.interchange.technique_choice import Choice
from sssgen.material.material_text import toml_value
from sssgen.scene.arrays import Array
from sssgen.scene.mesh_files import FileContent

_BALL_RADIUS, _SCATTERED_RADIUS, _CLEAR_RADIUS = 1.0, 6.0, 0.75
"""The largest radius of the ball of a material without a mesh: metres, and mean free paths of media with and without
scattering, so that light comes through."""
_BELOW, _ABOVE = (0.25, 0.25, 0.27), (0.75, 0.8, 0.9)
"""The background: the defaults of the technique `seen_through`."""
_VIEW = (0.45, 0.35, 1.0)
"""The direction towards the camera."""
_FIELD_OF_VIEW = 35.0
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
    centre, radius = (np.zeros(3), ball_radius(model)) if mesh is None else _bounds(mesh)
    centre, radius = centre / choice.metres, radius / choice.metres
    distance = 1.15 * radius / np.sin(np.radians(0.5 * _FIELD_OF_VIEW))
    eye = centre + distance * np.array(_VIEW) / np.linalg.norm(_VIEW)
    title = "".join(filter(str.isprintable, " ".join(model.name.split())))
    lines = [
        f"# {title or name}, imported. A world unit is {choice.metres:g} m.",
        "",
        *_keys(material=f"{name}.toml", size=[480, 480], samples=2, background=[_BELOW, _ABOVE]),
        *_section("shell", tone_mapping="khronos_neutral", **({} if model.unlit else _LIT)),
        *_section("environment", file=f"../{surroundings}", intensity=1.5),
    ]
    if mesh is None:
        lines += _section("geometry", kind="ball", radius=radius)
    else:
        lines += _section("geometry", kind="mesh", file="mesh.glb", scale=1.0 / choice.metres)
    lines += _section("camera", position=eye.tolist(), target=centre.tolist(), field_of_view=_FIELD_OF_VIEW)
    lines += ["", "# behind the body"]
    lines += _section("[light]", direction=[-0.6, 0.5, -0.6], color=[2.0, 1.9, 1.8])[1:]
    lines += ["", "# in front of it"]
    lines += _section("[light]", direction=[0.7, 0.6, 0.5], color=[1.2, 1.2, 1.25])[1:]
    if model.interior is not None:
        lines += _medium(model, choice.metres)
    if choice.clamped:
        lines += ["", "[textures]"]
        lines += [f'{key} = {{ file = {toml_value(file)}, wrap = "clamp" }}' for key, file in choice.clamped.items()]
    return "\n".join(lines) + "\n"


_LIT: Mapping[str, object] = {"environment": "prefiltered_environment"}


def _bounds(mesh: FileContent) -> tuple[Array, float]:
    used = mesh.vertices[np.unique(mesh.faces)]
    low, high = used.min(axis=0), used.max(axis=0)
    return 0.5 * (low + high), max(0.5 * float(np.linalg.norm(high - low)), 1e-6)


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
