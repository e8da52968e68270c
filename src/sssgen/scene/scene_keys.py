"""The keys of a scene's tables, and what each takes. The reader checks them, and the JSON schema states them."""

from __future__ import annotations

from collections.abc import Mapping

from sssgen.material.library import OF_SHELLS
from sssgen.scene.toml_table import NOT_NEGATIVE, POSITIVE, Key, number, other, text, vector, whole, wholes

MAX_LIGHTS = 4
MAX_PARTS = 64
MAX_BODIES = 512
MAX_SIDE = 8192
MAX_SAMPLES = 8
MAX_TEXELS = 256

MEASURED = {"title": text(), "medium": other(), "inlay": other(), "environment": other()}
"""Keys that describe the physical scene, for measuring materials; shells with an environment draw with its key."""

KEYS: Mapping[str, Key] = {
    "material": text(),
    "size": wholes(2, 1, MAX_SIDE),
    "samples": whole(1, MAX_SAMPLES),
    "time": number(),
    "background": vector(3, NOT_NEGATIVE),
    "ambient": vector(3, NOT_NEGATIVE),
    "exposure": number(POSITIVE),
    "geometry": other(),
    "bodies": other(),
    "camera": other(),
    "light": other(),
    "shell": other(),
    "parameters": other(),
    "textures": other(),
    **MEASURED,
}
"""The keys and sections of a scene."""

PLACE: Mapping[str, Key] = {"position": vector(3), "rotation": vector(3), "scale": number(POSITIVE)}
SHAPES: Mapping[str, Mapping[str, Key]] = {
    "ball": {"radius": number(POSITIVE)},
    "box": {"size": vector(3, POSITIVE)},
    "slab": {"width": number(POSITIVE), "height": number(POSITIVE), "thickness": number(POSITIVE)},
    "torus": {"major": number(POSITIVE), "minor": number(POSITIVE)},
    "capsule": {"radius": number(POSITIVE), "length": number(NOT_NEGATIVE)},
    "union": {"part": other(), "projection": text("parts", "planar")},
    "mesh": {"file": text()},
    "distance": {
        "technique": text(), "parameters": other(), "reach": number(POSITIVE),
        "projection": text("spherical", "planar"),
    },
}  # fmt: skip
"""Kind of geometry → its own keys."""

CAMERA: Mapping[str, Key] = {"position": vector(3), "target": vector(3), "field_of_view": number((1.0, 170.0))}
LIGHT: Mapping[str, Key] = {"position": vector(3), "direction": vector(3), "color": vector(3, NOT_NEGATIVE)}
SHELL: Mapping[str, Key] = {role: text() for role in OF_SHELLS}
PICTURE: Mapping[str, Key] = {"file": text(), "wrap": text("repeat", "clamp")}
DISTANCE_TEXTURE: Mapping[str, Key] = {
    "distance_of_geometry": wholes(3, 1, MAX_TEXELS),
    "box_min": vector(3),
    "box_max": vector(3),
    "range": number((0.001, 100.0)),
}

ENVIRONMENT: Mapping[str, Key] = {
    "color": vector(3, NOT_NEGATIVE), "file": text(), "intensity": number(NOT_NEGATIVE),
}  # fmt: skip
INLAY: Mapping[str, Key] = {
    "depth": number((1e-6, 1.0)), "ior": number((1.0, 3.0)), "outside_ior": number((1.0, 3.0)),
}  # fmt: skip
MEDIUM: Mapping[str, Key] = {
    "preset": text(),
    "unit_mm": number(POSITIVE),
    "absorption": vector(3, NOT_NEGATIVE),
    "scattering": vector(3, NOT_NEGATIVE),
    "color": vector(3, (0.0, 1.0)),
    "depth": vector(3, POSITIVE),
    "anisotropy": number((-0.95, 0.95)),
    "ior": number((1.0, 3.0)),
    "roughness": number((0.0, 1.0)),
}
