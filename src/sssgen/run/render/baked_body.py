"""Whether a baked texture fits the body, the medium and the lights of a scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.material.baked import BakeFile
from sssgen.scene import body_identity
from sssgen.scene.bounds import bounds
from sssgen.scene.geometry import Geometry, Mesh
from sssgen.scene.geometry_base import unit
from sssgen.scene.scene import Light
from sssgen.support.diagnostics import failure

SAME_SIZE = 0.01
"""The difference of two boxes' corners, relative to the longest side, up to which the boxes are the same."""
SAME_DIRECTION = 0.02
"""The difference of two unit directions up to which lights from afar are the same."""
COARSER, FINER = 2.0, 0.2
"""The mean free path of a material, relative to that of a map of lengths, beyond which the map does not resolve it."""


def check_body(sidecar: BakeFile, geometry: Geometry, name: str) -> None:
    """Raises SssgenError if a texture is baked for another shape, or for another scale, than the scene's."""
    body = sidecar.facts.get("body")
    if not isinstance(body, dict):
        _check_mesh(sidecar, geometry, name)
        return
    if "key" in body and body["key"] != body_identity.key(geometry):
        raise _other_shape(body, geometry, name)
    if "scale" in body and body["scale"] != geometry.scale:
        raise failure(
            f"'{name}' is baked for the scale {body['scale']}, but the scene has {geometry.scale:g}",
            "bake it for this scene: light fades over other lengths in a body of another size",
        )


def _check_mesh(sidecar: BakeFile, geometry: Geometry, name: str) -> None:
    """Raises SssgenError if a thickness map is baked for another mesh; older JSONs have its number of triangles alone,
    and no area, volume and centre."""
    mesh = sidecar.facts.get("mesh")
    if sidecar.kind not in ("thickness", "transmittance") or not isinstance(mesh, dict):
        return
    if not isinstance(geometry, Mesh):
        return
    triangles, own_name = geometry.triangles, body_identity.name(geometry)
    count, own = mesh.get("triangles"), len(triangles.corners)
    if isinstance(count, int) and count != own:
        raise failure(
            f"'{name}' is baked for a mesh of {count} triangles; {own_name} has {own}", "bake it for the scene's mesh"
        )
    if not body_identity.has_measures(mesh, triangles.places, triangles.corners):
        raise failure(
            f"'{name}' is baked for another mesh than {own_name}, or for an older version of it: its triangles are "
            "elsewhere", "bake it for the scene's mesh"
        )  # fmt: skip


def _other_shape(body: Mapping[str, Any], geometry: Geometry, name: str) -> Exception:
    baked_name, own_name = str(body.get("name", "?")), body_identity.name(geometry)
    box = [corner.tolist() for corner in bounds(geometry)]
    baked_box = [corner for key in ("box_min", "box_max") if isinstance(corner := body.get(key), list)]
    if np.shape(baked_box) == (2, 3):
        longest = max(float(np.ptp(box, axis=0).max()), 1e-9)
        if np.abs(np.subtract(baked_box, box)).max() > SAME_SIZE * longest:
            baked_name += f" from {_corner(baked_box[0])} to {_corner(baked_box[1])}"
            own_name += f" from {_corner(box[0])} to {_corner(box[1])}"
    if baked_name == own_name:
        baked_name, own_name = f"{baked_name} with the key {body['key']}", f"the key {body_identity.key(geometry)}"
    return failure(
        f"'{name}' is baked for another body: {baked_name}; the scene has {own_name}", "bake it for the scene's body"
    )


def _corner(corner: Iterable[float]) -> str:
    return f"({', '.join(f'{component:.3g}' for component in corner)})"


def check_lights(sidecar: BakeFile, geometry: Geometry, lights: Iterable[Light], name: str) -> None:
    """Raises SssgenError if light, thickness or depth is baked for another direction than that of every light of the
    scene, or light for lights from afar while a light is inside the body.
    """
    lights = list(lights)
    for number in lights_inside(geometry, lights) if sidecar.kind == "fluence" else ():
        raise failure(
            f"'{name}' is baked for lights from afar, and light {number} is inside the body",
            "move the light out, or use a technique that needs no baked light",
        )
    _check_direction(sidecar, geometry.to_object()[:3, :3], lights, name)


def lights_inside(geometry: Geometry, lights: Iterable[Light]) -> Iterator[int]:
    """The numbers, from 1, of the lights that are inside a body."""
    to_object = geometry.to_object()
    for number, light in enumerate(lights, 1):
        if light.position is not None:
            place = (to_object[:3, :3] @ np.array(light.position) + to_object[:3, 3])[None]
            if geometry.distance(place)[0] <= 0.0:
                yield number


def _check_direction(sidecar: BakeFile, to_object: npt.NDArray[np.float64], lights: list[Light], name: str) -> None:
    fixed = sidecar.facts.get("light")
    if not isinstance(fixed, dict) or np.shape(fixed.get("direction", 0.0)) != (3,):
        return
    towards = [unit((to_object @ np.array(light.direction))[None])[0] for light in lights if light.direction]
    if not any(np.linalg.norm(direction - fixed["direction"]) < SAME_DIRECTION for direction in towards):
        own = ", ".join(map(_corner, towards)) or "none from afar"
        baked_for = f"a light from {_corner(fixed['direction'])} in the body's space"
        raise failure(
            f"'{name}' is baked for {baked_for}; the scene has {own}",
            "bake it for the scene's light, or use a technique for any light",
        )


def check_resolution(
    sidecar: BakeFile, geometry: Geometry, values: Iterable[Mapping[str, tuple[float, ...]]], name: str
) -> None:
    """Raises SssgenError if a map of lengths is baked for a mean free path far from that of the material."""
    baked_length, fade = sidecar.facts.get("mean_free_path"), sidecar.parameters.get("fade_length")
    if sidecar.kind != "view_thickness" or not isinstance(baked_length, float) or not isinstance(fade, float):
        return
    for stage in values:
        if "mean_free_path" not in stage:
            continue
        own = stage["mean_free_path"][0] / geometry.scale
        coarse = own > COARSER * fade and fade == baked_length
        if coarse or own < FINER * fade:
            raise failure(
                f"'{name}' is baked for the mean free path {baked_length:.4g} in units of the mesh, and the "
                f"material's is {own:.4g}",
                "bake it with the material's: lengths are stored relative to it",
            )
