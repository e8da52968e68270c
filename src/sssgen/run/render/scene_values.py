"""The inputs of a material from a scene: lights, parameters and textures, those of baked files included."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from sssgen.ir.frame_passes import CUBES, DISTANT_VIEWS, IRRADIANCE, LIGHT_VIEWS, REFLECTIONS, VOLUMES
from sssgen.ir.nodes import Uniform
from sssgen.ir.types import with_article
from sssgen.material import baked
from sssgen.material.baked import BakeFile
from sssgen.material.chain_assembly import DETAIL_LEVEL
from sssgen.material.level_assembly import level_uniform
from sssgen.material.model import Material
from sssgen.material.values import WrongValue, read_value
from sssgen.run.evaluate import input_files as inputs
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render import baked_body
from sssgen.run.render.environment_maps import irradiance_map, reflection_map
from sssgen.run.render.inner_light import inner_light, is_response
from sssgen.run.render.shell_values import Shell
from sssgen.scene.arrays import Array
from sssgen.scene.bounds import world_corners
from sssgen.scene.drawn_views import light_depth, light_layers, shown_lights
from sssgen.scene.environment import Environment, read_environment
from sssgen.scene.geometry import Distance, Geometry
from sssgen.scene.scene import DistanceTexture, Picture, Scene
from sssgen.support.diagnostics import SssgenError, did_you_mean, failure
from sssgen.support.file_memo import CachedResult, note, remember
from sssgen.support.paths import posix
from sssgen.targets.reflection_record import DeclarationRecord, PassRecord, Reflection, TextureRecord, UniformRecord
from sssgen.targets.runtime.numpy_textures import Texture

MOST_TEXTURES = 16
"""The number of textures that are kept in memory."""
_kept_textures: dict[str, CachedResult] = {}
MOST_LIGHT_MAPS = 4
"""The number of light maps that are kept in memory."""
_kept_light_maps: dict[str, CachedResult] = {}


def shell_of(scene: Scene, material: Material, reflection: Reflection) -> Shell:
    """The shell's values for a scene. Raises SssgenError at the scene's own lines."""
    positions = [
        [*light.position, 1.0] if light.position else [*(light.direction or ()), 0.0] for light in scene.lights
    ]
    views = _light_views(scene, material, reflection, positions)
    surroundings = _surroundings(scene, material, reflection)
    maps = surroundings | {name: drawn.texture for name, drawn in views.items()}
    parameters = _parameters(scene, material, reflection, views, maps)
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
        textures=_textures(scene, material, reflection, maps),
    )


class DrawnLights(NamedTuple):
    """What a pass draws from lights."""

    matrices: Sequence[Array]
    """For each light the matrix (4, 4) from world space to the picture."""
    texture: Texture


def _light_views(
    scene: Scene, material: Material, reflection: Reflection, lights: list[list[float]]
) -> dict[str, DrawnLights]:
    """The depth maps that the program draws, by the name of the pass: of the first light that the map is for, or of the
    brightest lights.

    A texture of the scene or of the material is not drawn. Raises SssgenError without such a light.
    """
    views: dict[str, DrawnLights] = {}
    for drawn in _passes(scene, material, reflection):
        name = drawn["name"]
        if name not in LIGHT_VIEWS or scene.geometry is None:
            continue
        if not any(not (light[3] and name in DISTANT_VIEWS) for light in lights):
            hint = "add [[light]] with a direction" if name in DISTANT_VIEWS else "add [[light]]"
            file = scene.document.reporter.file
            raise failure(f"'{drawn['texture']}' is drawn from a light, and the scene has none", hint, file)
        colors = np.array([light.color for light in scene.lights], float)
        center = world_corners(scene.geometry).mean(axis=0)
        seen = [lights[index] for index in shown_lights(name, center, np.array(lights, float), colors)]
        views[name] = _drawn_lights(scene.geometry, seen, drawn["layers"], len(drawn["views"]) > 1)
    return views


def _passes(scene: Scene, material: Material, reflection: Reflection) -> list[PassRecord]:
    """The passes whose pictures neither the scene nor the material has as a file."""
    textures = {texture["source_name"]: texture for texture in reflection["textures"]}
    return [drawn for drawn in reflection["passes"] if not texture_file(scene, material, textures[drawn["texture"]])]


def _drawn_lights(geometry: Geometry, lights: list[list[float]], layers: list[str], tiled: bool) -> DrawnLights:
    """Lights' views of a body; those of slow bodies, distance functions, are kept until a file of theirs changes."""

    def make() -> DrawnLights:
        # the copy has no compiled function, so that the files of the function are read here
        body = copy.deepcopy(geometry) if slow else geometry
        if tiled:
            matrices, depth = light_layers(body, np.array(lights), layers)
        else:
            view, depth = light_depth(body, np.array(lights[0]), layers)
            matrices = [view.matrix]
        return DrawnLights(matrices, half(Texture(depth, wrap="clamp")))

    slow = isinstance(geometry, Distance)
    key = repr((geometry, lights, layers, tiled))
    return remember(_kept_light_maps, key, make, MOST_LIGHT_MAPS) if slow else make()


def _surroundings(scene: Scene, material: Material, reflection: Reflection) -> dict[str, Texture]:
    """The cube maps of the scene's [environment], by the hint `drawn`."""
    makers = {IRRADIANCE: irradiance_map, REFLECTIONS: reflection_map}
    asked = {drawn["name"] for drawn in _passes(scene, material, reflection)}
    needed = [(name, maker) for name, maker in makers.items() if name in asked]
    environment = environment_of(scene) if needed else None
    return {name: half(maker(environment)) for name, maker in needed} if environment is not None else {}


def environment_of(scene: Scene) -> Environment | None:
    """The scene's surroundings, if it has some. Raises SssgenError for faults in their table."""
    environment = read_environment(scene) if "environment" in scene.measured else None
    scene.document.reporter.check()
    return environment


def _parameters(
    scene: Scene,
    material: Material,
    reflection: Reflection,
    views: Mapping[str, DrawnLights],
    maps: Mapping[str, Texture],
) -> dict[str, tuple[float, ...]]:
    """The scene's values for the material's uniforms, with the same checks as in a material."""
    uniforms = {uniform["source_name"]: uniform for uniform in reflection["uniforms"]}
    document, values = scene.document, _baked_parameters(scene, material, reflection)
    for drawn in reflection["passes"]:
        if (name := drawn["name"]) in views:
            values |= {
                view: (*matrix.T.ravel(),) for view, matrix in zip(drawn["views"], views[name].matrices, strict=False)
            }
        if name in maps and drawn["size"]:
            size = len(maps[name].levels) - 1.0 if name in CUBES else float(maps[name].size()[0])
            values[drawn["size"]] = (size,)
    for name, raw in scene.parameters.items():
        place = document.place("parameters", name)
        if name not in uniforms:
            hint = did_you_mean(name, uniforms) or f"it has: {', '.join(uniforms) or 'none'}"
            document.error(place.key, f"{material.name} has no parameter '{name}'", hint)
            continue
        try:
            value = read_value(_uniform(material, uniforms[name]), raw)
            _check_own(scene, material, reflection, uniforms[name], value)
            values[name] = value
        except WrongValue as wrong:
            document.error(place.value, wrong.message, wrong.hint)
        except SssgenError as error:
            for diagnostic in error.diagnostics:
                document.error(place.value, diagnostic.message, diagnostic.hint)
    document.reporter.check()
    if scene.geometry is not None:
        placed = {name: uniform["default"] for name, uniform in uniforms.items() if uniform["placed"]}
        values |= {name: _placed(values.get(name, start), scene.geometry) for name, start in placed.items()}
    return values


def _placed(value: Sequence[float], geometry: Geometry) -> tuple[float, ...]:
    """The value in world space of a parameter with the hint `placed`: a matrix from the world, or a length."""
    if len(value) == 1:
        return (value[0] * geometry.scale,)
    return (*(np.array(value).reshape(4, 4).T @ geometry.to_object()).T.ravel(),)


def _check_own(
    scene: Scene,
    material: Material,
    reflection: Reflection,
    uniform: UniformRecord,
    value: tuple[float, ...],
) -> None:
    """Raises SssgenError if a scene's value for a uniform is not that of the medium of its technique's baked light."""
    for texture in reflection["textures"]:
        file = texture_file(scene, material, texture) if _reads(material, texture, uniform) else ""
        sidecar = baked.read_bake_file(file) if file else None
        if sidecar is not None:
            baked.check_medium(sidecar, {uniform["technique_name"]: value}, os.path.basename(file))


def _baked_parameters(scene: Scene, material: Material, reflection: Reflection) -> dict[str, tuple[float, ...]]:
    """The parameters of baked textures, for the transform of the scene's geometry."""
    parameters: dict[str, tuple[float, ...]] = {}
    for texture in reflection["textures"]:
        file = texture_file(scene, material, texture)
        try:
            sidecar = baked.read_bake_file(file) if file else None
            if sidecar is None:
                continue
            baked.check(sidecar, _uniform(material, texture), os.path.basename(file))
            stages = [stage for stage in material.stages if stage.technique.name == texture["technique"]]
            declared = [uniform.name for stage in stages for uniform in stage.technique.uniforms]
            matched = any(stage.technique.attributes.matched for stage in stages)
            baked.check_boundary(sidecar, declared, matched, os.path.basename(file))
            for stage in stages:
                baked.check_medium(sidecar, stage.values, os.path.basename(file))
            if scene.geometry is not None:
                _check_scene(sidecar, scene, scene.geometry, material, os.path.basename(file))
            values = _in_world_space(sidecar, scene.geometry)
        except SssgenError as error:
            if (name := texture["source_name"]) not in scene.textures:
                raise
            for diagnostic in error.diagnostics:
                place = scene.document.place("textures", name).value
                scene.document.error(place, diagnostic.message, diagnostic.hint)
            continue
        for entry in reflection["uniforms"]:
            if entry["technique_name"] in values and _reads(material, texture, entry):
                raw = values[entry["technique_name"]]
                try:
                    parameters[entry["source_name"]] = read_value(_uniform(material, entry), raw)
                except WrongValue as wrong:
                    hint = "; ".join(filter(None, (wrong.hint, baked.UNITS)))
                    raise failure(f"the baked parameters do not fit: {wrong.message}", hint, posix(file)) from None
    return parameters


def _check_scene(sidecar: BakeFile, scene: Scene, geometry: Geometry, material: Material, name: str) -> None:
    """Raises SssgenError if a texture is baked for another body, medium or light than the scene's."""
    baked_body.check_body(sidecar, geometry, name)
    baked_body.check_lights(sidecar, geometry, scene.lights, name)
    baked_body.check_resolution(sidecar, geometry, [stage.values for stage in material.stages], name)


def _in_world_space(sidecar: BakeFile, geometry: Geometry | None) -> dict[str, Any]:
    """The parameters of a JSON file, transformed from object space to world space where techniques need that and do not
    declare it by the hint `placed`.

    Raises SssgenError for a depth map of a body that the scene scales, as its lengths are in the units of the bake.
    """
    values = dict(sidecar.parameters)
    if geometry is None:
        return values
    to_object = geometry.to_object()
    if isinstance(factor := values.get("thickness_factor"), int | float) and sidecar.kind == "thickness":
        values["thickness_factor"] = factor * geometry.scale
    if isinstance(length := values.get("fade_length"), int | float) and sidecar.kind == "view_thickness":
        values["fade_length"] = length * geometry.scale
    if isinstance(matrix := values.get("light_matrix"), list) and sidecar.kind == "depth" and len(matrix) == 16:
        if geometry.scale != 1.0:
            raise failure("the depth map is for the unscaled body, but the scene scales it", "scale the mesh itself")
        values["light_matrix"] = [*(np.array(matrix).reshape(4, 4).T @ to_object).T.ravel()]
    return values


def _reads(material: Material, texture: TextureRecord, entry: UniformRecord) -> bool:
    """Whether a parameter is of the technique of a texture, alone or shared with others."""
    if entry["technique"] == texture["technique"]:
        return True
    stages = [stage for stage in material.stages if stage.technique.name == texture["technique"]]
    span = _uniform(material, entry).span
    return any(uniform.span == span for stage in stages for uniform in stage.technique.uniforms)


def _uniform(material: Material, entry: DeclarationRecord) -> Uniform:
    """The uniform that an entry of the reflection comes from."""
    if entry["source_name"] == DETAIL_LEVEL:
        return level_uniform(material.levels)
    for stage in material.stages:
        modules = [stage.technique.module, *(binding.module for binding in stage.bindings.values())]
        for uniform in (uniform for module in modules for uniform in module.uniforms):
            if uniform.name == entry["technique_name"] and stage.technique.name == entry["technique"]:
                return uniform
    own = (uniform for stage in material.stages for uniform in stage.technique.module.uniforms)
    return next(uniform for uniform in own if uniform.name == entry["technique_name"])


def _textures(
    scene: Scene,
    material: Material,
    reflection: Reflection,
    maps: Mapping[str, Texture],
) -> dict[str, Texture]:
    """The scene's textures; for the others those that the material suggests, or that the program draws.

    A file that is not there is left out: `missing_textures` reports it.
    """
    entries = {texture["source_name"]: texture for texture in reflection["textures"]}
    document, textures = scene.document, {}
    for name in scene.textures:
        if name not in entries:
            hint = did_you_mean(name, entries) or f"it has: {', '.join(entries) or 'none'}"
            document.error(document.place("textures", name).key, f"{material.name} has no texture '{name}'", hint)
    document.reporter.check()
    for name, texture in entries.items():
        chosen = scene.textures.get(name)
        if isinstance(chosen, DistanceTexture):
            if scene.geometry is None:
                raise failure(f"texture '{name}' is the distance to the scene's geometry, but the scene has none")
            textures[name] = _distances(chosen, scene.geometry)
        elif not (file := texture_file(scene, material, texture)):
            if (drawn := texture["drawn"] or "") in maps:
                textures[name] = maps[drawn]
        elif not os.path.isfile(file):
            note(file)
        elif texture["drawn"] in VOLUMES and is_response(file):
            textures[name] = inner_light(file, scene, environment_of(scene))
        else:
            wrap = getattr(chosen, "wrap", "") or texture["import"]["wrap"]
            textures[name] = _picture(file, wrap, texture)
    return textures


def texture_file(scene: Scene, material: Material, texture: TextureRecord) -> str:
    """The file of a texture: the scene's, or else the one that the material suggests; '' if there is none."""
    chosen = scene.textures.get(texture["source_name"])
    if chosen is not None:
        return chosen.file if isinstance(chosen, Picture) else ""
    return _suggestion(material, texture)


def _suggestion(material: Material, texture: TextureRecord) -> str:
    for stage in material.stages:
        if stage.technique.name == texture["technique"] and texture["technique_name"] in stage.textures:
            return str(material.path.parent / stage.textures[texture["technique_name"]])
    return ""


def _distances(chosen: DistanceTexture, geometry: Geometry) -> Texture:
    """The texture of the distance; the last ones are kept until a file of the geometry changes."""

    def make() -> Texture:
        return half(Texture(chosen.values(copy.deepcopy(geometry)), wrap="clamp"))

    return remember(_kept_textures, repr((chosen, geometry)), make, MOST_TEXTURES)


def _picture(file: str, wrap: str, texture: TextureRecord) -> Texture:
    """The texture of a file; the last ones are kept until their files change."""
    declared = [texture["source_name"], texture["type"], texture["color_space"]]
    key = repr((os.path.abspath(file), wrap, declared))
    return remember(_kept_textures, key, lambda: _read_picture(file, wrap, texture), MOST_TEXTURES)


def _read_picture(file: str, wrap: str, texture: TextureRecord) -> Texture:
    picture = inputs.texture(file, wrap, srgb=texture["color_space"] == "sRGB")
    if picture.dim != texture["type"].removeprefix("sampler"):
        type_ = with_article(texture["type"])
        raise failure(f"this is a {picture.dim} texture, and '{texture['source_name']}' is {type_}", file=file)
    return half(picture, posix(file))
