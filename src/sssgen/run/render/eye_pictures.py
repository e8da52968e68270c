"""The pictures that a program draws of the body as the eye sees it (ir/frame_passes.py), cast on the CPU."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from sssgen.ir.frame_passes import BEHIND, EYE_PICTURES, FAR, FRAME_PASSES, IRRADIANCE, MATT
from sssgen.run.evaluate.evaluation import half
from sssgen.run.render.screen_window import Window
from sssgen.run.render.shell_values import Shell
from sssgen.scene.arrays import Array
from sssgen.scene.bounds import world_corners
from sssgen.scene.camera import Camera
from sssgen.scene.drawn_views import eye_layers, matt_light
from sssgen.scene.geometry import Geometry, Hits
from sssgen.scene.pictures.resizing import resized
from sssgen.targets.reflection_record import Reflection
from sssgen.targets.runtime.numpy_textures import Texture

MOST_TEXELS = 1024
"""Along a side of the picture of the scene behind a body."""


def with_eye_pictures(
    shell: Shell, geometry: Geometry, reflection: Reflection, window: Window, hits: Hits, behind: Callable[[], Array]
) -> Shell:
    """The shell with the pictures that its material reads; `hits` are those of the window's rays, row 0 at the bottom.

    `behind` makes the linear picture (height, width, 3) of the scene without the body, of the whole screen, row 0 at
    the bottom. A picture that the shell has already is not drawn.
    """
    origin, directions = window.rays()
    width, height = window.size
    shown = np.flatnonzero(hits.hit)
    parameters, textures, screens = dict(shell.parameters), dict(shell.textures), dict(shell.screens)
    names = {drawn["name"]: drawn["texture"] for drawn in reflection["passes"]}
    for drawn in reflection["passes"]:
        name, picture = drawn["name"], drawn["texture"]
        if picture in textures:
            continue
        if name in EYE_PICTURES:
            distances = np.zeros((len(directions), len(FRAME_PASSES[name].layers)))
            distances[shown] = eye_layers(geometry, origin, directions[shown], name)
            # a filter would mix distances with those of other surfaces, and with FAR
            screens[picture] = half(Texture(distances.reshape(height, width, -1), "nearest", "clamp"))
        if name == MATT:
            texels = np.tile([0.0, 0.0, 0.0, FAR], (len(directions), 1))
            points, normals = hits.position[shown], hits.normal[shown]
            texels[shown, :3] = matt_light(geometry, points, normals, shell.light_positions, shell.light_colors)
            texels[shown, :3] += shell.ambient
            if (surroundings := textures.get(names.get(IRRADIANCE, ""))) is not None:
                texels[shown, :3] += surroundings.sample(normals.T)[:3].T
            matrix = _to_picture(window.camera, window.whole, window.to_clip(), geometry)
            texels[shown, 3] = points @ matrix[2, :3] + matrix[2, 3]
            textures[picture] = half(Texture(texels.reshape(height, width, 4), wrap="clamp"))
            parameters |= dict.fromkeys(drawn["views"], (*matrix.T.ravel(),))
        if name == BEHIND:
            texture = _square(behind())
            textures[picture] = half(texture)
            matrix = _to_picture(window.camera, window.whole, np.eye(4), geometry)
            parameters |= dict.fromkeys(drawn["views"], (*matrix.T.ravel(),))
            parameters |= {drawn["size"]: (len(texture.levels) - 1.0,)} if drawn["size"] else {}
    return dataclasses.replace(shell, parameters=parameters, textures=textures, screens=screens)


def _square(picture: Array) -> Texture:
    """A picture as a square whose side is a power of two, with levels."""
    side = min(1 << (max(picture.shape[:2]).bit_length() - 1), MOST_TEXELS)
    return Texture(resized(picture, side, side), wrap="clamp", mipmaps=True)


def _to_picture(camera: Camera, size: tuple[int, int], to_clip: Array, geometry: Geometry) -> Array:
    """World space to (u w, v w, distance from the plane across the view through the body's middle, w)."""
    middle = world_corners(geometry).mean(axis=0)
    x, y, _, w = to_clip @ camera.view_projection(size[0] / size[1])
    depth = w - [0.0, 0.0, 0.0, w[:3] @ middle + w[3]]
    return np.stack([0.5 * (x + w), 0.5 * (y + w), depth, w])
