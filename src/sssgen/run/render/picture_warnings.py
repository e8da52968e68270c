"""Warnings about a picture that was drawn and is probably not the one that was meant: each at its line of the scene."""

from __future__ import annotations

import numpy as np

from sssgen.ir.spans import Span
from sssgen.run.backends import Array
from sssgen.scene.geometry import Geometry, Mesh
from sssgen.scene.geometry_mesh import is_closed
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic, Reporter

BLACK = 1e-3
"""The linear value up to which a sample is black: it is shown as 0 to 3 of 255."""
WHITE, MOST = 0.99, 0.95
"""The linear value from which a sample is white, and the share of such samples that makes a picture white."""


def warnings_of(scene: Scene, hit: Array, front: Array) -> list[Diagnostic]:
    """The warnings about a picture. `hit` is whether a sample shows the surface, `front` whether from outside."""
    reporter = Reporter(scene.document.reporter.file, "\n".join(scene.document.reporter.lines))
    if scene.geometry is not None:
        if not hit.any():
            hint = "change target or position of [camera], or position of [geometry]"
            reporter.warn(_camera_key(scene, "target"), "the camera does not see the body", hint)
        elif _is_seen_from_inside(scene, scene.geometry, hit, front):
            hint = "move it out: materials are made for the outside of a body"
            reporter.warn(_camera_key(scene, "position"), "the camera is inside the body", hint)
    for number, light in enumerate(scene.lights):
        if not any(light.color):
            place = scene.document.place("light", number, "color").value
            reporter.warn(place, "this light is black", "give it a colour, or remove it")
    return reporter.warnings


def exposure_warnings(scene: Scene, color: Array, shown: Array) -> list[Diagnostic]:
    """The warning about a picture with black or white bodies. `color` (h, w, 3) is linear and as it is shown, `shown`
    (h, w) where they are."""
    if not shown.any():
        return []
    reporter = scene.document.reporter
    if (color[shown].min(axis=1) >= WHITE).mean() > MOST:
        message = "the picture is white: it is overexposed, or its colours are above 1"
        hint = "lower `exposure` of the scene, the light, or the colours of the material: 1 is white"
        return [Diagnostic("warning", message, Span(reporter.file, 0, 0, 0, 0), hint)]
    if color[shown].max() > BLACK:
        return []
    if not scene.lights and not any(scene.ambient) and "environment" not in scene.measured:
        message, hint = "the picture is black: the scene has no light", "add [[light]], or [environment]"
        return [Diagnostic("warning", message, Span(reporter.file, 0, 0, 0, 0), hint)]
    span = scene.document.place("light").value
    message, hint = "the picture is black: no light reaches what the camera sees", "move a light, or make it brighter"
    return [Diagnostic("warning", message, span, hint, reporter.line(span))]


def _is_seen_from_inside(scene: Scene, geometry: Geometry, hit: Array, front: Array) -> bool:
    if isinstance(geometry, Mesh):  # whose distance would need libigl
        return is_closed(geometry) and not (hit & front).any()
    to_object = geometry.to_object()
    place = to_object[:3, :3] @ np.array(scene.camera.position) + to_object[:3, 3]
    return bool(geometry.distance(place[None])[0] < 0.0)


def _camera_key(scene: Scene, key: str) -> Span:
    """Where a key of the camera is, or else the camera, or the file."""
    return scene.document.place("camera", key).value
