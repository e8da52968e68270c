"""The passes, keywords and variables that Unity sets for an emitted shader (`shell_values` has the other languages).

A forward renderer without shadows, fog, probes and lightmaps. The first directional light is the main light. In URP the
others are additional lights of the same pass; in the built-in pipeline each is a ForwardAdd pass, whose picture is
added. An unlit shader has only the main light. Ambient light is uniform, and there are no reflections.
"""

from __future__ import annotations

import numpy as np

from sssgen.ir.types import BY_NAME, column_size
from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import VERTEX_SIZE, Array, Bound, Drawing, Place, file_text
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.render import pixel_mesh
from sssgen.run.render.shell_values import Shell, inverse, textures
from sssgen.targets.reflection_record import Reflection
from sssgen.targets.runtime.numpy_textures import Texture

_BASE = ("UNITY_PASS_FORWARDBASE=1", "DIRECTIONAL=1", "LIGHTPROBE_SH=1")
_ADD = {0.0: ("UNITY_PASS_FORWARDADD=1", "DIRECTIONAL=1"), 1.0: ("UNITY_PASS_FORWARDADD=1", "POINT=1")}
"""By a light position's w."""
_FALLOFF = 8192
"""Texels of the table of a point light's falloff."""
_NEAREST = 0.01
"""The shortest reach of a light, equal to that of the falloff in the other shells."""
_LARGEST = 6e4
"""Below the largest float16."""
_MOST_LIGHTS = 8
"""The limit of additional lights of an object in URP."""


def shade(compiled: Compiled, shell: Shell, backend: UnityHLSL, size: tuple[int, int], points: Array | None) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom. `points` are `pixel_mesh.vertices`, or None: the screen."""
    if points is None:
        points, triangles = screen_triangle(shell), np.array([[0, 1, 2]], np.uint32)
    else:
        triangles = pixel_mesh.triangles(size, shell.front)
    pictures = [
        backend.whole.draw(drawing._replace(vertices=points, triangles=triangles))
        for drawing in _passes(compiled, shell, backend, size, points)
    ]
    total: Array = np.stack(pictures).sum(axis=0)
    return total


def screen_triangle(shell: Shell) -> Array:
    """One triangle over the whole picture, in object space, as `pixel_mesh` has its vertices."""
    corners = np.array([[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]])
    clip = np.concatenate([corners, np.full((3, 1), 0.5), np.ones((3, 1))], axis=1)
    placed = clip @ inverse(shell.view_projection @ shell.model).T
    vertices = np.zeros((3, VERTEX_SIZE))
    vertices[:, :3] = placed[:, :3] / np.where(placed[:, 3:] == 0.0, 1.0, placed[:, 3:])
    vertices[:, 3:10] = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0]
    vertices[:, 10:12] = 0.5 * corners + 0.5
    vertices[:, 14:] = 1.0
    return vertices.astype(np.float32)


def _passes(
    compiled: Compiled, shell: Shell, backend: UnityHLSL, size: tuple[int, int], points: Array
) -> list[Drawing]:
    """The draws, whose pictures are added."""
    reflection = compiled.reflection
    (name,) = (file["name"] for file in reflection["files"] if file["stages"])
    shader, bound_textures = file_text(compiled, reflection, name), textures(reflection, shell)
    values = _engine(shell, size) | _properties(reflection, shell)

    def drawing(keywords: tuple[str, ...], light: dict[str, Array], falloff: Texture | None = None) -> Drawing:
        vertex, fragment = (backend.forward(shader, stage, keywords) for stage in ("vertex", "fragment"))
        bound = bound_textures | ({"_LightTexture0": Bound(falloff, Place(0, 0))} if falloff else {})
        return Drawing(size, fragment, vertex, floats=True, textures=bound, values=values | light)

    lights = list(zip(shell.light_positions, shell.light_colors, strict=True))
    main = next((light for light in lights if light[0][3] == 0.0), (np.array([0.0, 1.0, 0.0, 0.0]), np.zeros(3)))
    additional = [light for light in lights if light is not main]
    if backend.target.name == "unity-urp":
        return [drawing(("_ADDITIONAL_LIGHTS=1",) if additional else (), _urp_lights(main, additional))]
    if reflection["shading"] != "lit":
        return [drawing((), _builtin_light(*main))]
    passes = [drawing(_BASE, _builtin_light(*main))]
    for position, color in additional:
        reach = _reach(shell, position, points)
        light = _builtin_light(position, color if position[3] == 0.0 else color / reach**2, reach)
        passes.append(drawing(_ADD[float(position[3])], light, _falloff()))
    return passes


def _engine(shell: Shell, size: tuple[int, int]) -> dict[str, Array]:
    """The variables that the engine sets for every pass; a matrix as its columns."""
    width, height = size
    screen = np.array([width, height, 1.0 + 1.0 / width, 1.0 + 1.0 / height])
    values = {
        "unity_ObjectToWorld": shell.model.T,
        "unity_WorldToObject": inverse(shell.model).T,
        "unity_WorldTransformParams": np.ones(4) * np.sign(np.linalg.det(shell.model[:3, :3])),
        "unity_MatrixVP": shell.view_projection.T,
        "unity_MatrixInvVP": inverse(shell.view_projection).T,
        "_WorldSpaceCameraPos": np.array(shell.camera_position),
        "_Time": shell.time * np.array([0.05, 1.0, 2.0, 3.0]),
        "_ProjectionParams": np.array([1.0, 0.1, 100.0, 0.01]),
        "_ScreenParams": screen,
        "_ScaledScreenParams": screen,
        "_ScaleBiasRt": np.array([-1.0, 1.0, 0.0, 0.0]),  # screen-space uv count from the bottom
    }
    for channel, ambient in zip("rgb", shell.ambient, strict=True):
        values[f"unity_SHA{channel}"] = np.array([0.0, 0.0, 0.0, ambient])
    return values


def _properties(reflection: Reflection, shell: Shell) -> dict[str, Array]:
    """The material's properties, each as vectors: an array's elements or a matrix's columns."""
    properties = {}
    for uniform in reflection["uniforms"]:
        type_ = BY_NAME[uniform["type"].partition("[")[0]]
        size = column_size(type_)
        value = shell.parameters.get(uniform["source_name"], uniform["default"])
        properties[uniform["name"]] = np.asarray(value).reshape(-1, size)
    return properties


def _builtin_light(position: Array, color: Array, reach: float = 1.0) -> dict[str, Array]:
    """A light of one pass. `reach` is the distance at which a point light's falloff table ends."""
    to_light = np.eye(4)
    to_light[:3, 3] = -position[:3]
    to_light[:3] /= reach
    return {
        "_WorldSpaceLightPos0": position,
        "_LightColor0": np.append(color, 1.0),
        "unity_WorldToLight": to_light.T,
    }


def _reach(shell: Shell, position: Array, points: Array) -> float:
    """The largest distance of a point from a light, at least `_NEAREST`."""
    placed = points[:, :3] @ shell.model[:3, :3].T + shell.model[:3, 3]
    return max(1.01 * float(np.linalg.norm(placed - position[:3], axis=1).max()), _NEAREST)


def _falloff() -> Texture:
    """1/x over x = (distance / reach)², the falloff of the other shells instead of the engine's own table."""
    x = (np.arange(_FALLOFF) + 0.5) / _FALLOFF
    return Texture(np.repeat(np.minimum(1.0 / x, _LARGEST)[None, :, None], 4, axis=2), wrap="clamp")


def _urp_lights(main: tuple[Array, Array], additional: list[tuple[Array, Array]]) -> dict[str, Array]:
    """The main light and the additional lights, without the engine's fade-out at their range."""
    shown = additional[:_MOST_LIGHTS]
    count = float(len(shown))
    return {
        "_MainLightPosition": main[0],
        "_MainLightColor": np.append(main[1], 1.0),
        "_AdditionalLightsCount": np.array([count, 0.0, 0.0, 0.0]),
        "_AdditionalLightsPosition": np.array([position for position, _ in shown]).reshape(-1, 4),
        "_AdditionalLightsColor": np.array([np.append(color, 1.0) for _, color in shown]).reshape(-1, 4),
        "_AdditionalLightsAttenuation": np.tile([0.0, 1.0, 0.0, 1.0], (len(shown), 1)),
        "unity_LightData": np.array([0.0, count, 1.0, 0.0]),
        "unity_LightIndices": np.arange(8.0).reshape(2, 4),
        "unity_ProbesOcclusion": np.ones(4),
    }
