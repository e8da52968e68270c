"""The inputs of a material from a scene: lights, parameters and textures, those of baked files included."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from sssgen.harness.evaluate import input_files as inputs
from sssgen.harness.evaluate.evaluation import half
from sssgen.harness.render.shell_values import Shell
from sssgen.harness.scenes.geometry import Geometry
from sssgen.harness.scenes.scene import DistanceTexture, Picture, Scene, placement
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import with_article
from sssgen.material import baked
from sssgen.material.baked import Baked
from sssgen.material.model import Material
from sssgen.material.values import WrongValue, read_value
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.paths import posix
from sssgen.targets.runtime.numpy_textures import Texture


def shell_of(scene: Scene, material: Material, reflection: Mapping[str, Any]) -> Shell:
    """The shell's values for a scene. Raises SssgenError at the scene's own lines."""
    positions = [
        [*light.position, 1.0] if light.position else [*(light.direction or ()), 0.0] for light in scene.lights
    ]
    parameters = _parameters(scene, material, reflection)
    if any(uniform["source_name"] == "aspect" for uniform in reflection["uniforms"]):  # of a camera in the chain
        parameters.setdefault("aspect", (scene.size[0] / scene.size[1],))
    return Shell(
        view_projection=np.eye(4),
        camera_position=scene.camera.position,
        time=scene.time,
        ambient=scene.ambient,
        light_positions=np.array(positions, float).reshape(-1, 4),
        light_colors=np.array([light.color for light in scene.lights], float).reshape(-1, 3),
        model=scene.geometry.to_world() if scene.geometry else np.eye(4),
        parameters=parameters,
        textures=_textures(scene, material, reflection),
    )


def _parameters(scene: Scene, material: Material, reflection: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    """The scene's values for the material's uniforms, with the same checks as in a material."""
    known = {uniform["source_name"]: uniform for uniform in reflection["uniforms"]}
    document, found = scene.document, _of_baked(scene, material, reflection)
    for name, raw in scene.parameters.items():
        place = document.place("parameters", name)
        if name not in known:
            hint = did_you_mean(name, known) or f"it has: {', '.join(known) or 'none'}"
            document.error(place.key, f"{material.name} has no parameter '{name}'", hint)
            continue
        try:
            found[name] = read_value(_uniform(material, known[name]), raw)
        except WrongValue as wrong:
            document.error(place.value, wrong.message, wrong.hint)
    document.reporter.check()
    return found


def _of_baked(scene: Scene, material: Material, reflection: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    """The parameters that come with baked textures, where the scene's body stands."""
    found: dict[str, tuple[float, ...]] = {}
    for texture in reflection["textures"]:
        file = _file(scene, material, texture)
        try:
            made = baked.read(file) if file else None
            if made is None:
                continue
            baked.check(made, _uniform(material, texture), os.path.basename(file))
            values = _placed(made, scene.geometry)
        except SssgenError as wrong:
            if (name := texture["source_name"]) not in scene.textures:
                raise
            for one in wrong.diagnostics:
                scene.document.error(scene.document.place("textures", name).value, one.message, one.hint)
            continue
        for entry in reflection["uniforms"]:
            if entry["technique"] == texture["technique"] and entry["technique_name"] in values:
                raw = values[entry["technique_name"]]
                try:
                    found[entry["source_name"]] = read_value(_uniform(material, entry), raw)
                except WrongValue as wrong:
                    hint = "; ".join(filter(None, (wrong.hint, baked.UNITS)))
                    raise failure(f"the baked parameters do not fit: {wrong.message}", hint, posix(file)) from None
    return found


def _placed(made: Baked, geometry: Geometry | None) -> dict[str, Any]:
    """The parameters as the JSON has them, in the body's own space, brought to the world's where techniques want that.

    Raises SssgenError for a depth map of a body that the scene scales: its lengths are those of the bake.
    """
    values = dict(made.parameters)
    if geometry is None:
        return values
    inwards = geometry.to_object()
    if made.kind == "distance":
        values |= placement(geometry)
    if isinstance(factor := values.get("thickness_factor"), int | float) and made.kind == "thickness":
        values["thickness_factor"] = factor * geometry.scale
    if isinstance(matrix := values.get("light_matrix"), list) and made.kind == "depth" and len(matrix) == 16:
        if geometry.scale != 1.0:
            raise failure("the depth map is of the body's own size, and the scene scales it", "scale the mesh itself")
        values["light_matrix"] = [*(np.array(matrix).reshape(4, 4).T @ inwards).T.ravel()]
    return values


def _uniform(material: Material, entry: Mapping[str, Any]) -> Uniform:
    """The uniform that an entry of the reflection comes from."""
    for stage in material.stages:
        modules = [stage.technique.module, *(binding.module for binding in stage.bindings.values())]
        for uniform in (uniform for module in modules for uniform in module.uniforms):
            if uniform.name == entry["technique_name"] and stage.technique.name == entry["technique"]:
                return uniform
    every = (uniform for stage in material.stages for uniform in stage.technique.module.uniforms)
    return next(uniform for uniform in every if uniform.name == entry["technique_name"])


def _textures(scene: Scene, material: Material, reflection: Mapping[str, Any]) -> dict[str, Texture]:
    """The scene's textures, and where it has none those that the material suggests."""
    known = {texture["source_name"]: texture for texture in reflection["textures"]}
    document, found = scene.document, {}
    for name in scene.textures:
        if name not in known:
            hint = did_you_mean(name, known) or f"it has: {', '.join(known) or 'none'}"
            document.error(document.place("textures", name).key, f"{material.name} has no texture '{name}'", hint)
    document.reporter.check()
    for name, texture in known.items():
        given = scene.textures.get(name)
        if isinstance(given, DistanceTexture):
            if scene.geometry is None:
                raise failure(f"texture '{name}' is the distance to the scene's geometry, and it has none")
            found[name] = half(Texture(given.values(scene.geometry), wrap="clamp"))
        elif file := _file(scene, material, texture):
            wrap = getattr(given, "wrap", "") or str(texture["import"]["wrap"])
            found[name] = _picture(file, wrap, texture)
    return found


def _file(scene: Scene, material: Material, texture: Mapping[str, Any]) -> str:
    """The file of a texture: the scene's, or where it has none that which the material suggests."""
    given = scene.textures.get(texture["source_name"])
    if given is not None:
        return given.file if isinstance(given, Picture) else ""
    return _suggested(material, texture)


def _suggested(material: Material, texture: Mapping[str, Any]) -> str:
    for stage in material.stages:
        if stage.technique.name == texture["technique"] and texture["technique_name"] in stage.textures:
            return str(material.path.parent / stage.textures[texture["technique_name"]])
    return ""


def _picture(file: str, wrap: str, texture: Mapping[str, Any]) -> Texture:
    made = inputs.texture(file, wrap, srgb=texture["color_space"] == "sRGB")
    if made.dim != texture["type"].removeprefix("sampler"):
        type_ = with_article(texture["type"])
        raise failure(f"this is a {made.dim} texture, and '{texture['source_name']}' is {type_}", file=file)
    return half(made)
