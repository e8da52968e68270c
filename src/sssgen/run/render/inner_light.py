"""The volume of the light inside a scene's body, from the file of `sssgen bake fluence --relit`."""

from __future__ import annotations

import os

import numpy as np

from sssgen.material import baked
from sssgen.run.evaluate.evaluation import half
from sssgen.scene.arrays import Array
from sssgen.scene.environment import Environment
from sssgen.scene.light_response import SUFFIX, from_bytes, from_light, harmonics, volume
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import failure
from sssgen.support.file_memo import note
from sssgen.support.paths import posix
from sssgen.targets.runtime.numpy_textures import Texture

ROWS = 32
"""The rows of directions at which surroundings are evaluated."""


def inner_light(file: str, scene: Scene, environment: Environment | None) -> Texture:
    """The volume for a scene's lights, `ambient` and surroundings, in half floats.

    Raises SssgenError for a file that is no response of a body.
    """
    assert scene.geometry is not None
    note(file)
    sidecar = baked.read_bake_file(file)
    if sidecar is None:
        hint = "both come from `sssgen bake fluence --relit`: copy them together"
        raise failure(
            f"the response of a body lacks the JSON beside it, {posix(baked.sidecar(file))}", hint, posix(file)
        )
    try:
        with open(file, "rb") as opened:
            response = from_bytes(opened.read(), sidecar.facts)
    except (KeyError, TypeError, ValueError) as error:
        reason = f": {error}" if isinstance(error, ValueError) else ""
        raise failure(
            f"this and {posix(baked.sidecar(file))} are not the response of a body to light{reason}",
            "bake again with `sssgen bake fluence --relit`, or copy both files together", posix(file),
        ) from None  # fmt: skip
    to_object = scene.geometry.to_object()
    lights = [from_light(response, light, to_object) for light in scene.lights]
    around = surroundings(environment, to_object) + np.outer(_SAME_FROM_EVERYWHERE, scene.ambient)
    return half(Texture(volume(response, lights, around), wrap="clamp"))


_SAME_FROM_EVERYWHERE = np.eye(9)[0] / (np.pi * harmonics(np.array([[0.0, 0.0, 1.0]]))[0, 0])
"""The harmonics of light that a white matt surface shows as 1."""


def surroundings(environment: Environment | None, to_object: Array) -> Array:
    """The integrals of the light times the harmonics in object space, (9, 3): see `lit`."""
    if environment is None:
        return np.zeros((9, 3))
    height = max(ROWS, environment.values().shape[0])
    width = 2 * height
    rows, columns = np.indices((height, width)).reshape(2, -1) + 0.5
    polar, around = np.pi * rows / height, 2.0 * np.pi * (columns / width - 0.5)
    ways = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=1)
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    angles = np.repeat((edges[:-1] - edges[1:]) * (2.0 * np.pi / width), width)
    turned = ways @ to_object[:3, :3].T
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    weights = harmonics(turned) * (angles / np.pi)[:, None]
    result: Array = weights.T @ environment.sky()(ways)
    return result


def is_response(file: str) -> bool:
    """Whether a file's name is that of a response."""
    return os.path.splitext(file)[1].lower() == SUFFIX
