"""The camera and the lights of a glTF file's scene (KHR_lights_punctual)."""

from __future__ import annotations

import math

import numpy as np

from sssgen.interchange.gltf_container import open_file
from sssgen.interchange.gltf_json import JsonElement
from sssgen.interchange.gltf_nodes import node_transforms
from sssgen.interchange.imported_view import ImportedView
from sssgen.interchange.mapping_report import Report
from sssgen.scene.arrays import Array
from sssgen.scene.camera import Camera
from sssgen.scene.scene import Light
from sssgen.scene.scene_keys import MAX_LIGHTS

LIGHTS = "KHR_lights_punctual"
_NARROW = 4.0
"""The field of view in degrees that stands for a parallel projection."""
_FIELDS = (1.0, 170.0)
"""The smallest and the largest field of view of a scene."""
_MOST_ROLL = math.radians(1.0)
_ASPECTS = (0.25, 4.0)


def read_view(path: str, report: Report, top: str = "") -> ImportedView:
    """The camera and the lights of a file; adds to the report what is approximated and left out. Raises SssgenError."""
    root = open_file(path, top).root
    nodes = node_transforms(root)
    camera, aspect = None, ImportedView().aspect
    cameras = root.objects("cameras")
    for node, matrix in nodes:
        if node.has("camera"):
            element = node.reference("camera", cameras, "camera")
            if camera is None:
                camera, aspect = _camera(element, node, matrix, report)
            else:
                report.add_omission(f"{node.path}/camera", element.path, "the picture is that of the first camera")
    return ImportedView(camera, aspect, _lights(root, nodes, report))


def _camera(element: JsonElement, node: JsonElement, matrix: Array, report: Report) -> tuple[Camera, float]:
    """A camera of a node, and the picture's width over its height."""
    axes = matrix[:3, :3] / np.maximum(np.linalg.norm(matrix[:3, :3], axis=0), 1e-12)
    place, forward = matrix[:3, 3], -axes[:, 2]
    aspect = ImportedView().aspect
    if (parallel := element.child("orthographic")) is not None:
        half = max(parallel.number("ymag", 1.0, 0.0), 1e-6)
        aspect = max(parallel.number("xmag", half * aspect, 0.0), 1e-6) / half
        field, ahead = _NARROW, half / math.tan(math.radians(0.5 * _NARROW))
        middle = place + forward * 0.5 * parallel.number("zfar", 2.0 * ahead, 0.0)
        place = middle - forward * ahead
        report.add_approximation(parallel.path, "parallel", f"a perspective of {_NARROW:g} degrees from far away")
    else:
        lens = element.child("perspective") or JsonElement({}, f"{element.path}/perspective", element.file)
        field = math.degrees(lens.number("yfov", math.radians(40.0), 0.0))
        aspect = lens.number("aspectRatio", aspect, 0.0)
        report.add_mapping(element.path, f"{field:.4g} degrees", "camera")
        field = min(max(field, _FIELDS[0]), _FIELDS[1])
    camera = Camera(_vector(place), _vector(place + forward), field)
    roll = math.atan2(float(axes[:, 1] @ camera.axes()[0]), float(axes[:, 1] @ camera.axes()[1]))
    if abs(roll) > _MOST_ROLL:
        report.add_approximation(f"{node.path}/camera", f"rolled by {math.degrees(roll):.3g} degrees", "upright")
    return camera, min(max(aspect, _ASPECTS[0]), _ASPECTS[1])


def _lights(root: JsonElement, nodes: list[tuple[JsonElement, Array]], report: Report) -> tuple[Light, ...]:
    extension = root.extension(LIGHTS)
    elements = [] if extension is None else extension.objects("lights")
    lights: list[Light] = []
    for node, matrix in nodes:
        if (placed := node.extension(LIGHTS)) is None:
            continue
        element = placed.reference("light", elements, "light")
        if len(lights) == MAX_LIGHTS:
            report.add_omission(node.path, element.path, f"a scene has at most {MAX_LIGHTS} lights")
        elif (light := _light(element, matrix, report)) is not None:
            lights.append(light)
    return tuple(lights)


def _light(element: JsonElement, matrix: Array, report: Report) -> Light | None:
    """A light of a node: its colour is what a white matte surface shows, which reflects the share 1 / pi to the eye."""
    kind = element.text("type")
    strength = element.number("intensity", 1.0, 0.0) / math.pi
    color = _vector(strength * np.array(element.vector("color", (1.0, 1.0, 1.0), 0.0)))
    if not any(color):
        report.add_omission(element.path, 0, "the light is black")
        return None
    if element.has("range"):
        report.add_approximation(f"{element.path}/range", element.value["range"], "no end: it falls off by its square")
    backward = matrix[:3, 2] / max(float(np.linalg.norm(matrix[:3, 2])), 1e-12)
    if kind == "directional":
        report.add_mapping(element.path, kind, "a light from afar")
        return Light(None, _vector(backward), color)
    if kind == "spot":
        report.add_approximation(element.path, kind, "a light in all directions from its place")
    elif kind == "point":
        report.add_mapping(element.path, kind, "a light at a place")
    else:
        raise element.require("type").fault(f"unknown light '{kind[:20]}'", "directional, point or spot")
    return Light(_vector(matrix[:3, 3]), None, color)


def _vector(values: Array) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z
