"""Draws bodies by the default shading of engines, by their material, and path traced.

Run: python docs/before_after.py [PICTURE …]

All three have the same highlight, light and tone mapping. The path-traced medium is that of the material's numbers. The
pictures in docs/accuracy/ are before_after.png and gallery_traced.png, which has the other scenes of the gallery whose
materials describe a medium.
"""

from __future__ import annotations

import dataclasses
import io
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from sssgen.lab.measure import scene_references
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.run import backends
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene import scene_loading
from sssgen.scene.environment import Environment, digest
from sssgen.scene.geometry import Distance
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.media import Medium
from sssgen.scene.measured.view_points import points
from sssgen.scene.pictures.images import encode_srgb
from sssgen.scene.scene import Scene

FOLDER = Path(__file__).parent / "accuracy"
PANEL = (256, 192)
"""The size in pixels of a picture of the comparison; the path traced one has half of it along each side."""
GAP, HEAD = 6, 24
"""Between the pictures, and above them for the titles."""
BLACK = (0.0, 0.0, 0.0)
SKY_ROWS = 64
"""The height of the picture of the surroundings that a technique computes, for path tracing."""


class Compared(NamedTuple):
    """A row of the comparison."""

    scene: str
    body: str
    """The distance function of what is path traced; "" for the scene's."""
    samples: int
    """The number of paths of a pixel."""
    left_out: tuple[str, ...] = ()
    """Strengths of what is not in the medium: 0 in all columns."""
    sky: str = ""
    """The function, FILE:FUNCTION, of the surroundings that are seen through the body; "" where none are."""
    sky_colors: tuple[str, ...] = ()
    """Its colours among the parameters: black where the body is opaque."""


PICTURES = {
    "before_after.png": (Compared("skin_ear", "", 256), Compared("candle", "candle.sss:wax", 256)),
    "gallery_traced.png": (
        Compared("jade_ring", "", 256),
        Compared("soap", "bar.sss:bar", 256),
        Compared("milk_glass", "lamp.sss:dome", 256),
        Compared(
            "ice_body", "", 256, ("fracture_strength",), "clear_view.sss:surroundings",
            ("sky_above", "sky_below", "sky_bright"),
        ),
    ),
}  # fmt: skip
"""The rows of each picture."""
COLUMNS = ("engine default: Lambert + GGX", "sssgen", "path traced")


def drawn(name: str) -> bytes:
    """A PNG with a row for each compared scene, and a column for each way to shade it."""
    rows = [panels(compared) for compared in PICTURES[name]]
    width = len(COLUMNS) * (PANEL[0] + GAP) - GAP
    sheet = Image.new("RGB", (width, HEAD + len(rows) * (PANEL[1] + GAP) - GAP), (18, 18, 20))
    font = ImageFont.load_default(13)
    for column, title in enumerate(COLUMNS):
        ImageDraw.Draw(sheet).text((column * (PANEL[0] + GAP) + 6, 4), title, (225, 225, 225), font)
    for row, pictures in enumerate(rows):
        for column, picture in enumerate(pictures):
            sheet.paste(_image(picture), (column * (PANEL[0] + GAP), HEAD + row * (PANEL[1] + GAP)))
    file = io.BytesIO()
    sheet.save(file, "PNG", optimize=True)
    return file.getvalue()


def panels(compared: Compared) -> list[Array]:
    """The pictures of a row, encoded. All have the same highlight and tone mapping."""
    scene = scene_loading.load(compared.scene)
    scene = dataclasses.replace(scene, size=PANEL, samples=2, shell={}, ambient=BLACK)
    medium = medium_of(load_material(scene.material))
    left_out: dict[str, object] = dict.fromkeys(compared.left_out, 0.0)
    opaque: dict[str, object] = {**left_out, **{name: [*BLACK] for name in compared.sky_colors}, "octaves": [0.0] * 4}
    default = _drawn(scene, {**opaque, "tint": [*half_space(medium), 1.0]})
    ours = _drawn(scene, left_out)
    surface = _drawn(scene, {**opaque, "tint": [*BLACK, 1.0]})
    body, share = traced(scene, compared, medium)
    path_traced = surface.linear + surface.covered[..., None] * body * np.clip((share - 0.15) / 0.3, 0.0, 1.0)
    return [encode_srgb(mapped(picture)) for picture in (default.linear, ours.linear, path_traced)]


def medium_of(material: Material) -> Medium:
    """The medium whose light a material computes, from the values of its stages."""
    values: dict[str, Any] = {}
    for stage in material.stages:
        values |= stage.values
    red, green, blue = values["extinction"]
    red_albedo, green_albedo, blue_albedo = values["scattering_albedo"]
    absorption = (red * (1.0 - red_albedo), green * (1.0 - green_albedo), blue * (1.0 - blue_albedo))
    scattering = (red * red_albedo, green * green_albedo, blue * blue_albedo)
    return Medium(material.name, absorption, scattering, ior=values.get("ior", (1.0,))[0])


def half_space(medium: Medium) -> Array:
    """The share of light that a deep body of a medium reflects: the base colour that an artist would take.

    Van de Hulst's fit for isotropic scattering (Multiple Light Scattering, 1980).
    """
    s = np.sqrt(1.0 - np.array(medium.albedo))
    result: Array = (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s)
    return result


def traced(scene: Scene, compared: Compared, medium: Medium) -> tuple[Array, Array]:
    """The light from inside the body, (height, width, 3), and the share of each pixel that shows the body, (…, 1)."""
    width, height = PANEL[0] // 2, PANEL[1] // 2
    body = scene.geometry
    assert body is not None
    if isinstance(body, Distance):
        body = dataclasses.replace(body, technique=compared.body or body.technique)
    with tempfile.TemporaryDirectory() as folder:
        sky = surroundings(compared, scene.folder, folder) if compared.sky else None
        measured = MeasuredScene(
            scene.material, scene.title, body, scene.camera, scene.lights, medium, None, (width, height), "", sky
        )
        readings = scene_references.trace(measured, compared.samples, 0)
    colors = [light.color for light in scene.lights] + ([(1.0, 1.0, 1.0)] if sky else [])
    light = sum(mean * np.array(color)[:, None] for (mean, _), color in zip(readings, colors, strict=True))
    visible = points(measured)
    shown = visible.picture(np.ones((1, visible.count)))
    share = _enlarged(shown)
    return _enlarged(visible.picture(np.asarray(light))) / np.maximum(share, 1e-3), share


def surroundings(compared: Compared, scene_folder: str, folder: str) -> Environment:
    """The surroundings that a technique computes, as a picture in a folder; with the values of the technique."""
    v, u = np.mgrid[0:SKY_ROWS, 0 : 2 * SKY_ROWS]
    polar, around = np.pi * (v.ravel() + 0.5) / SKY_ROWS, np.pi * ((u.ravel() + 0.5) / SKY_ROWS - 1.0)
    ways = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=1)
    function = subject(str(Path(scene_folder, compared.sky)))
    light = evaluate(function, {"way": ways}, backends.get("numpy"))["result"]
    file = str(Path(folder, "surroundings.npy"))
    np.save(file, light.reshape(SKY_ROWS, 2 * SKY_ROWS, 3)[::-1])  # row 0 of the file is at the bottom
    return Environment((1.0, 1.0, 1.0), file, digest(file))


def mapped(picture: Array) -> Array:
    """The picture in the range of a display."""
    colors = evaluate(subject("khronos_neutral"), {"color": picture.reshape(-1, 3)}, backends.get("numpy"))["result"]
    result: Array = colors.reshape(picture.shape)
    return result


def _drawn(scene: Scene, parameters: dict[str, object]) -> RenderedPicture:
    return render(dataclasses.replace(scene, parameters={**scene.parameters, **parameters}), backends.get("gl"))


def _enlarged(picture: Array) -> Array:
    """The picture with the pixels of a panel, by bilinear filtering."""
    channels = [
        Image.fromarray(picture[..., channel].astype(np.float32)).resize(PANEL, Image.Resampling.BILINEAR)
        for channel in range(picture.shape[2])
    ]
    result: Array = np.stack([np.asarray(channel, np.float64) for channel in channels], axis=-1)
    return result


def _image(encoded: Array) -> Image.Image:
    return Image.fromarray(np.rint(255.0 * encoded).astype(np.uint8))


if __name__ == "__main__":
    for name in sys.argv[1:] or PICTURES:
        (FOLDER / name).write_bytes(drawn(name))
