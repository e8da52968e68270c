"""The picture of a hero by Mitsuba 3: path tracing of the same meshes, media, lamps and surroundings, denoised by OIDN.

A body has a rough dielectric boundary around a homogeneous medium; its vertices' colours are factors of the light that
passes the boundary, and a volume of the model is a factor of the medium's albedo.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from hero_stage.hero import Body, Hero, Lamp, Prop
from hero_stage.mesh import Mesh
from hero_stage.prepare import Prepared

VARIANT = "scalar_rgb"
_PASS = 8
"""The paths of a pixel in one render, which the memory limits."""
_DEEPEST = 160
"""The events of a path; what is left then is less than the noise."""
_STEPS = 16
"""Of the colours of what shines."""
_BRIGHTEST = 60.0
"""The largest radiance of a pixel in one render: brighter ones are the noise of rare paths."""


def trace(prepared: Prepared, size: tuple[int, int], samples: int) -> np.ndarray:
    """Linear light, (height, width, 3), row 0 above. What was traced is kept: a larger count continues it."""
    import mitsuba as mi

    mi.set_variant(VARIANT)
    scene = mi.load_dict(_scene(mi, prepared, size))
    kept = prepared.folder / f"traced_{size[0]}.npz"
    total, passes = np.zeros((size[1], size[0], 9), np.float32), 0
    if kept.is_file():
        with np.load(kept) as data:
            total, passes = data["total"], int(data["passes"])
    for seed in range(passes, samples // _PASS):
        total = total + np.minimum(np.array(mi.render(scene, spp=_PASS, seed=seed)), _BRIGHTEST)
        np.savez(kept, total=total, passes=seed + 1)
    layers = total / max(samples // _PASS, passes, 1)
    return _denoised(layers[..., :3], layers[..., 3:6], layers[..., 6:9])


def _denoised(color: np.ndarray, albedo: np.ndarray, normals: np.ndarray) -> np.ndarray:
    import pyoidn

    parts = [np.ascontiguousarray(part, np.float32) for part in (color, np.clip(albedo, 0, 1), np.clip(normals, -1, 1))]
    return np.array(pyoidn.denoise(parts[0], albedo=parts[1], normal=parts[2], hdr=True))


def _scene(mi: Any, prepared: Prepared, size: tuple[int, int]) -> dict[str, Any]:
    hero = prepared.hero
    sky = np.roll(prepared.sky, -prepared.sky.shape[1] // 4, axis=1)
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {
            "type": "aov", "aovs": "albedo:albedo,normal:sh_normal",
            "light": {"type": "volpath", "max_depth": _DEEPEST, "rr_depth": 24, "hide_emitters": False},
        },
        "sensor": _sensor(mi, hero, size),
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(sky, np.float32))},
    }  # fmt: skip
    scene |= {f"lamp{number}": _lamp(lamp) for number, lamp in enumerate(hero.lamps) if lamp.shown}
    for number, body in enumerate(hero.bodies):
        for place, to_world in enumerate(_matrices(body.places)):
            scene[f"body{number}_{place}"] = _body(mi, prepared, body, to_world)
    for number, prop in enumerate(hero.props):
        for place, to_world in enumerate(_matrices(prop.places)):
            parts = (_shining if max(prop.emission) > 0.0 else _opaque)(mi, prepared, prop, to_world)
            scene |= {f"prop{number}_{place}_{part}": mesh for part, mesh in enumerate(parts)}
    return scene


def _sensor(mi: Any, hero: Hero, size: tuple[int, int]) -> dict[str, Any]:
    camera, (width, height) = hero.camera, size
    forward = np.subtract(camera.target, camera.position)
    focus = float(np.subtract(camera.focus, camera.position) @ forward / np.linalg.norm(forward))
    lens = {"type": "thinlens", "aperture_radius": camera.aperture, "focus_distance": focus}
    return {
        **(lens if camera.aperture else {"type": "perspective"}),
        "to_world": mi.ScalarTransform4f().look_at(list(camera.position), list(camera.target), [0.0, 1.0, 0.0]),
        "fov": camera.field_of_view, "fov_axis": "y", "near_clip": 0.05, "far_clip": 200.0,
        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
        "sampler": {"type": "independent"},
    }  # fmt: skip


def _lamp(lamp: Lamp) -> dict[str, Any]:
    radiance = [part / (math.pi * lamp.radius**2) for part in lamp.intensity]
    emitter = {"type": "area", "radiance": {"type": "rgb", "value": radiance}}
    return {"type": "sphere", "center": list(lamp.position), "radius": lamp.radius, "emitter": emitter}


def _matrices(places: Any) -> list[np.ndarray]:
    """(4, 4) to world space, of position, turn, scale, tilt and roll."""
    from scipy.spatial.transform import Rotation

    matrices = []
    for x, y, z, *rest in places:
        turn, scale, tilt, roll = [*rest, *(0.0, 1.0, 0.0, 0.0)[len(rest) :]]
        matrix = np.eye(4)
        matrix[:3, :3] = scale * Rotation.from_euler("YXZ", [turn, tilt, roll], degrees=True).as_matrix()
        matrix[:3, 3] = x, y, z
        matrices.append(matrix)
    return matrices


def _mesh(mi: Any, mesh: Mesh, to_world: np.ndarray, bsdf: Any, **more: Any) -> Any:
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf)
    for name, value in more.items():
        properties[name] = mi.load_dict(value)
    made = mi.Mesh(
        "mesh", len(mesh.vertices), len(mesh.faces), has_vertex_normals=True, has_vertex_texcoords=bool(len(mesh.uv)),
        props=properties,
    )  # fmt: skip
    turn = to_world[:3, :3] / np.cbrt(np.linalg.det(to_world[:3, :3]))
    if len(mesh.colors):
        made.add_attribute("vertex_tint", 3, np.ravel(mesh.colors[:, :3]).astype(np.float32))
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = np.ravel(mesh.vertices @ to_world[:3, :3].T + to_world[:3, 3]).astype(np.float32)
    parameters["vertex_normals"] = np.ravel(mesh.normals @ turn.T).astype(np.float32)
    parameters["faces"] = np.ravel(mesh.faces).astype(np.uint32)
    if len(mesh.uv):
        parameters["vertex_texcoords"] = np.ravel(mesh.uv * [1.0, 1.0]).astype(np.float32)
    parameters.update()
    return made


def _body(mi: Any, prepared: Prepared, body: Body, to_world: np.ndarray) -> Any:
    mesh, medium = prepared.model.meshes[body.mesh], body.medium
    if "passed" in medium:
        return _sheet(mi, prepared, body, to_world)
    absorption, scattering = np.array(medium["absorption"]), np.array(medium["scattering"])
    scale = float(np.cbrt(np.linalg.det(to_world[:3, :3])))
    extinction = (absorption + scattering) / scale
    albedo: dict[str, Any] = {"type": "rgb", "value": (scattering / (absorption + scattering)).tolist()}
    if body.inclusions:
        volume = prepared.model.volumes[body.inclusions]
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        inside = np.eye(4)
        inside[:3, :3], inside[:3, 3] = np.diag(high - low), low
        grid = mi.VolumeGrid(np.ascontiguousarray(volume * albedo["value"], np.float32))
        albedo = {"type": "gridvolume", "grid": grid, "to_world": mi.ScalarTransform4f(to_world @ inside), "raw": True}
    densest = float(extinction.max())
    shares: dict[str, Any] = {"type": "rgb", "value": (extinction / densest).tolist()}
    interior = {"type": "homogeneous", "albedo": albedo, "sigma_t": shares, "scale": densest}
    boundary = {
        "type": "roughdielectric", "distribution": "ggx", "alpha": max(body.roughness**2, 1e-3),
        "int_ior": float(medium["ior"]), "ext_ior": 1.0,
    }  # fmt: skip
    if len(mesh.colors) and not np.allclose(mesh.colors[:, :3], 1.0):
        boundary["specular_transmittance"] = {"type": "mesh_attribute", "name": "vertex_tint"}
    return _mesh(mi, mesh, to_world, boundary, interior=interior)


def _sheet(mi: Any, prepared: Prepared, body: Body, to_world: np.ndarray) -> Any:
    """A thin sheet: Lambert lobes on both sides. Mitsuba shares the colour of the picture out as 2 - x and x."""
    medium = body.medium
    both = medium["passed"] + medium["reflected"]
    picture = prepared.model.pictures[next(iter(body.pictures.values()))]
    color = np.ascontiguousarray(np.clip(picture * both, 0.0, 1.0), np.float32)
    texture = {"type": "bitmap", "bitmap": mi.Bitmap(color), "raw": True}
    thin = {
        "type": "principledthin", "base_color": texture, "roughness": body.roughness,
        "diff_trans": 2.0 * medium["passed"] / both,
    }  # fmt: skip
    return _mesh(mi, prepared.model.meshes[body.mesh], to_world, thin)


def _shining(mi: Any, prepared: Prepared, prop: Prop, to_world: np.ndarray) -> list[Any]:
    parts = []
    for color, piece in pieces_of_one_color(prepared.model.meshes[prop.mesh]):
        emitter = {"type": "area", "radiance": {"type": "rgb", "value": (color * prop.emission).tolist()}}
        parts.append(_mesh(mi, piece, to_world, {"type": "diffuse", "reflectance": 0.0}, emitter=emitter))
    return parts


def pieces_of_one_color(mesh: Mesh) -> list[tuple[np.ndarray, Mesh]]:
    """A mesh as colours and meshes: Mitsuba ends with a segmentation fault for an area emitter with vertex colours."""
    colors = mesh.colors[:, :3] if len(mesh.colors) else np.ones_like(mesh.vertices)
    steps, part_of = np.unique(np.rint(_STEPS * colors[mesh.faces].mean(axis=1)), axis=0, return_inverse=True)
    pieces = [dataclasses.replace(mesh, faces=mesh.faces[part_of.ravel() == part]) for part in range(len(steps))]
    return [
        (step / _STEPS, dataclasses.replace(piece, colors=np.ones((0, 4))))
        for step, piece in zip(steps, pieces, strict=True)
    ]


def _opaque(mi: Any, prepared: Prepared, prop: Prop, to_world: np.ndarray) -> list[Any]:
    mesh = prepared.model.meshes[prop.mesh]
    color: dict[str, Any] = {"type": "rgb", "value": list(prop.color)}
    if prop.picture:
        picture = np.ascontiguousarray(prepared.model.pictures[prop.picture] * prop.color, np.float32)
        color = {"type": "bitmap", "bitmap": mi.Bitmap(picture), "raw": True, "wrap_mode": "repeat"}
    elif len(mesh.colors):
        mesh = dataclasses.replace(mesh, colors=mesh.colors * [*prop.color, 1.0])
        color = {"type": "mesh_attribute", "name": "vertex_tint"}
    surface = {"type": "principled", "base_color": color, "roughness": prop.roughness, "metallic": prop.metalness}
    return [_mesh(mi, mesh, to_world, {"type": "twosided", "surface": surface})]
