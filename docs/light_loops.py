"""Draws loops of bodies with light inside from a bake, beside path traced ones: docs/light_loops/NAME.webp and .json.

python docs/light_loops.py [SCENE...] [--frames N] [--size N] [--samples N] [--voxels N] [--index N] [-o FOLDER]: some
minutes for each scene; without scenes, those of the charts. In the upper half a lamp goes around the body once, in the
lower half the surroundings turn. What surfaces reflect is left out. The JSON has the error of the frames
without the noise of the reference, the median and the worst, which is printed, too.
"""

from __future__ import annotations

import argparse
import dataclasses
import io
import json
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from accuracy import scenes
from PIL import Image, ImageDraw, ImageFont

from sssgen.bake import baked_files, relit
from sssgen.lab.fluence.fluence_field import Settings
from sssgen.lab.fluence.traced_body import fitting_voxels
from sssgen.lab.measure import fluence_inputs
from sssgen.lab.reference.eye_paths import Eye, Sky, readings
from sssgen.lab.reference.first_light import Lamp
from sssgen.lab.reference.sampling import Sampling
from sssgen.run import backends
from sssgen.run.backends import Array
from sssgen.run.render.scene_render import render
from sssgen.scene import scene_loading
from sssgen.scene.bounds import world_corners
from sssgen.scene.environment import Environment, digest
from sssgen.scene.example_scenes import measured_scenes
from sssgen.scene.measured import measured_scene
from sssgen.scene.measured.measured_scene import MeasuredScene
from sssgen.scene.measured.view_points import points
from sssgen.scene.pictures.images import encode_srgb
from sssgen.scene.scene import Light, Scene
from sssgen.support.file_writer import write_files

FOLDER = Path(__file__).with_name("light_loops")
COLUMNS_OF_FRAME = 4
"""Of the picture of the surroundings: how far it turns from frame to frame."""
RAYS = 20_000
"""Of a lamp in one batch of the reference."""
LAMP = (1.0, 0.86, 0.66)
DISTANCE, HEIGHT = 1.7, 0.7
"""Of the lamp from the body's centre, relative to the body's radius."""
BACKGROUND = 0.02
HEAD, SECONDS = 16, 3.0
TITLES = (("a lamp, ours", "path traced"), ("surroundings, ours", "path traced"))
OPAQUE = """[material]
name = "loop"
[[surface]]
technique = "base_color"
tint = [0.0, 0.0, 0.0, 1.0]
[[surface]]
technique = "specular_level"
dielectric_specular = 0.0
"""
"""A black surface, which mirrors at grazing angles all the same: its picture is subtracted."""
TRANSLUCENT = """[translucency]
technique = "{technique}"
inner_light = "body.bin"
"""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("scenes", nargs="*", metavar="SCENE")
    options.add_argument("--frames", type=int, default=24)
    options.add_argument("--size", type=int, default=160)
    options.add_argument("--samples", type=int, default=64, help="paths of a pixel")
    options.add_argument("--voxels", type=int, help="along the longest side (default: about 4096 in the body)")
    options.add_argument("--index", type=float, help="the refractive index of the bodies (default: the scene's)")
    options.add_argument("-o", "--output", type=Path, default=FOLDER)
    arguments = options.parse_args()
    for name in arguments.scenes or scenes():
        path = measured_scenes().get(name, name)
        scene = scene_loading.load(path, draws=False)
        body = measured_scene.of_scene(scene, path)
        if body.medium is None:
            continue
        if arguments.index is not None:
            body = dataclasses.replace(body, medium=dataclasses.replace(body.medium, ior=arguments.index))
        body = dataclasses.replace(body, size=(arguments.size, arguments.size))
        with tempfile.TemporaryDirectory() as folder:
            loop = Loop(scene, body, arguments.frames, folder)
            ours = loop.draw(arguments.voxels or fitting_voxels(body.body_alone()))
            traced, noise = loop.trace(arguments.samples)
        measured = {}
        for title, *frames in zip(("lamp", "surroundings"), ours, traced, noise, strict=True):
            errors = [relative(*frame) for frame in zip(*frames, strict=True)]
            measured[title] = {"median": float(np.median(errors)), "worst": max(errors)}
            print(f"{body.name}, {title}: error {np.median(errors):.3f}, of the worst frame {max(errors):.3f}")
        label = Path(path).parent.name if Path(path).stem.startswith("scene") else body.name
        record = json.dumps(measured, indent=1) + "\n"
        write_files(str(arguments.output), {f"{label}.webp": animation(ours, traced), f"{label}.json": record})


class Loop:
    """A body under light that moves; pictures have linear light, (frames, height, width, 3), row 0 at the top."""

    def __init__(self, scene: Scene, body: MeasuredScene, frames: int, folder: str) -> None:
        """`folder` gets the files of the material and of the surroundings."""
        self.scene, self.body, self.folder = scene, body, folder
        corners = world_corners(body.geometry)
        middle, radius = corners.mean(axis=0), 0.5 * float(np.ptp(corners, axis=0).max())
        turns = 2.0 * np.pi * np.arange(frames) / frames
        around = [np.array([np.sin(turn), HEIGHT, np.cos(turn)]) * DISTANCE * radius for turn in turns]
        strength = (DISTANCE * radius) ** 2
        self.lamps = [
            Light((float(x), float(y), float(z)), None, (strength * LAMP[0], strength * LAMP[1], strength * LAMP[2]))
            for x, y, z in (middle + place for place in around)
        ]
        self.skies = [self._sky(number, frames) for number in range(frames)]

    def _sky(self, number: int, frames: int) -> Environment:
        """A bright window in a dim room, turned."""
        rows, columns = np.indices((COLUMNS_OF_FRAME * frames // 2, COLUMNS_OF_FRAME * frames)) + 0.5
        polar, around = np.pi * rows / len(rows), 2.0 * np.pi * columns / columns.shape[1]
        toward = np.sin(polar) * np.cos(around) * 0.94 + np.cos(polar) * 0.34
        window = np.clip((toward - 0.6) / 0.2, 0.0, 1.0)[..., None] * [5.0, 4.3, 3.4]
        room = (0.5 + 0.3 * np.cos(polar))[..., None] * [0.16, 0.2, 0.26]
        file = str(Path(self.folder, f"sky_{number}.npy"))
        np.save(file, np.roll(window + room, COLUMNS_OF_FRAME * number, axis=1)[::-1])  # row 0 is at the bottom
        return Environment((1.0, 1.0, 1.0), file, digest(file))

    def draw(self, voxels: int) -> list[Array]:
        """Ours, for the lamp and for the surroundings."""
        data, facts = relit.bake(self.body.body_alone(), fluence_inputs.RANK, Settings(voxels=voxels))
        baked_files.write_response(str(Path(self.folder, "body.bin")), data, facts)
        material, opaque = Path(self.folder, "loop.toml"), Path(self.folder, "opaque.toml")
        material.write_text(OPAQUE + TRANSLUCENT.format(technique=facts["technique"]), "utf-8")
        opaque.write_text(OPAQUE, "utf-8")
        assert self.body.medium is not None
        medium = {**self.scene.measured["medium"], "ior": self.body.medium.ior}
        scene = dataclasses.replace(
            self.scene, material=str(material), size=self.body.size, samples=1, ambient=(0.0,) * 3, exposure=1.0,
            background=((0.0,) * 3,) * 2, shell={}, lights=(), parameters={}, textures={}, measured={"medium": medium},
        )  # fmt: skip
        under_lamps = [dataclasses.replace(scene, lights=(lamp,)) for lamp in self.lamps]
        skies = [{**scene.measured, "environment": {"file": sky.file}} for sky in self.skies]
        under_skies = [dataclasses.replace(scene, measured=measured) for measured in skies]
        black = [dataclasses.replace(frame, material=str(opaque)) for frame in under_lamps]
        backend = backends.get("gl")
        lit, around, mirrored = (
            np.stack([render(frame, backend).linear for frame in frames])
            for frames in (under_lamps, under_skies, black)
        )
        return [lit - mirrored, around]

    def trace(self, samples: int) -> tuple[list[Array], list[Array]]:
        """The reference, likewise, and its standard error: the same paths for all lamps and all surroundings."""
        visible = points(self.body)
        inputs, medium = visible.inputs, self.body.medium
        assert medium is not None
        eye = Eye(*(np.ascontiguousarray(part.T) for part in (inputs["P"], inputs["N"], -inputs["V"])))
        lamps = [Lamp(None, lamp.position) for lamp in self.lamps]
        skies = [Sky(sky.sky(), seen_through=False) for sky in self.skies]
        light, noise = readings(self.body.geometry, medium, eye, lamps, skies, Sampling(samples), RAYS)
        colors = [lamp.color for lamp in self.lamps] + [(1.0, 1.0, 1.0)] * len(skies)
        of_all = []
        for values in (light, noise):
            pictures = [visible.picture((part * color).T) for part, color in zip(values, colors, strict=True)]
            of_all.append([np.stack(pictures[: len(lamps)]), np.stack(pictures[len(lamps) :])])
        return of_all[0], of_all[1]


def relative(picture: Array, reference: Array, noise: Array) -> float:
    """The root mean square of the difference on the body, relative to the reference, whose noise is left out."""
    body = reference.any(axis=-1)
    square = ((picture - reference)[body] ** 2).mean() - (noise[body] ** 2).mean()
    return float(np.sqrt(max(square, 0.0) / (reference[body] ** 2).mean()))


def animation(ours: Sequence[Array], traced: Sequence[Array]) -> bytes:
    """An animated WebP: a row of ours and the reference for each light, which all frames expose alike."""
    scales = [0.8 / max(float(np.percentile(part[part.any(axis=-1)], 98.0)), 1e-9) for part in traced]
    count, height, width = ours[0].shape[:3]
    font, sheets = ImageFont.load_default(11), []
    for number in range(count):
        sheet = Image.new("RGB", (2 * width, 2 * (height + HEAD)), (18, 18, 20))
        for row, pair in enumerate(zip(ours, traced, strict=True)):
            for column, pictures in enumerate(pair):
                shown = pictures[number] * scales[row]
                shown = np.where(shown.any(axis=-1, keepdims=True), shown, BACKGROUND)
                corner = column * width, row * (height + HEAD)
                image = Image.fromarray(np.rint(255.0 * encode_srgb(np.clip(shown, 0.0, 1.0))).astype(np.uint8))
                sheet.paste(image, (corner[0], corner[1] + HEAD))
                place = corner[0] + 4, corner[1] + 1
                ImageDraw.Draw(sheet).text(place, TITLES[row][column], (225, 225, 225), font)
        sheets.append(sheet)
    file = io.BytesIO()
    sheets[0].save(
        file, "WEBP", save_all=True, append_images=sheets[1:], duration=round(1000.0 * SECONDS / count), loop=0,
        quality=90, method=6,
    )  # fmt: skip
    return file.getvalue()


if __name__ == "__main__":
    main()
