"""Pictures of techniques, drawn with OpenGL by the shaders that sssgen emits.

A technique of transmitted light is drawn on the cube of examples/lab, in the most accurate charted chain that has it
and needs no baked texture. Others are drawn on a ball with a checker; a distance function is drawn as the body, a
quantity as a grey. What none of these shows is a curve. There is no picture where no rule applies: for a technique that
needs a bake, and for cameras and marches; the page says why.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from picture import Picture
from records import best_point
from sssgen.lab.chart.picked_material import stages_of
from sssgen.lab.chart.record import Point
from sssgen.lab.measure.technique_chain import (
    BODY,
    is_drawn,
    pictured_stage,
    quantity_stages,
    textures_of,
    write_pictures,
)
from sssgen.material import library
from sssgen.material.library import Technique
from sssgen.material.material_text import MaterialSection, material_text
from sssgen.material.technique_facts import facts_of
from sssgen.run.backends import Array, Backend
from sssgen.run.render.missing_textures import MissingTextures
from sssgen.run.render.scene_render import RenderedPicture, render
from sssgen.scene import scene_loading
from sssgen.scene.example_scenes import measured_scenes
from sssgen.scene.measured import measured_scene, scene_body
from sssgen.scene.pictures.images import encode_srgb
from sssgen.support.diagnostics import SssgenError
from technique_curves import default_curve

SIZE = 200, 150
SAMPLES = 2
"""The scene of the chart."""
BACKGROUND = 0.05
BRIGHT = 0.7
"""The linear light of the brightest hundredth of a measured body: the scales of its fits differ."""
VISIBLE = 0.02
"""The least difference in sRGB between a picture with a technique and one without."""
SATURATED = 0.25
"""The largest share of a body that may be white."""
ON_A_BALL = ("coordinates", "surface", "shadow", "environment", "tone_mapping")

SCENE = """
material = "material.toml"
background = [[0.05, 0.05, 0.05], [0.05, 0.05, 0.05]]
ambient = [0.12, 0.12, 0.13]
[camera]
position = {}
field_of_view = 36.0
[[light]]
direction = [0.6, 0.9, 0.8]
color = [1.8, 1.75, 1.7]
[environment]
color = [0.5, 0.6, 0.8]
"""
BALL = """[geometry]
kind = "ball"
radius = 1.0
"""
FRONT, CORNER = [0.0, 0.5, 3.4], [2.0, 1.4, 2.6]
"""Positions of the camera."""
FUNCTION = """[geometry]
kind = "distance"
technique = "{}"
"""


def draw(technique: Technique, backend: Backend) -> Picture | None:
    """The picture of a technique; None if there is none."""
    if point := best_point(technique.name):
        with contextlib.suppress(MissingTextures):  # its chain reads a baked distance
            return _measured(point, backend)
    return _drawn(technique, backend) or default_curve(technique)


def _drawn(technique: Technique, backend: Backend) -> Picture | None:
    try:
        if technique.role == "distance":
            return _body(technique, backend)
        if technique.role in ON_A_BALL:
            return _on_a_ball(technique, backend)
        if technique.role == "thickness":
            return _quantity(technique, backend)
    except SssgenError:  # it needs more than a ball has
        return None
    return None


def why_none(technique: Technique) -> str:
    """Why a technique has no picture."""
    for param in technique.function.params:
        if param.direction == "inout" and param.quantity:
            return f"It has no picture here: it changes the {param.quantity} that other techniques give."
    if baked := [texture.name for texture in textures_of(technique) if not is_drawn(texture)]:
        return f"It has no picture here: it reads `{baked[0]}`, which is made for one body or one surface."
    if technique.role == "geometry":
        return "It has no picture here: it makes the rays of a whole picture."
    if technique.slots:
        return "It has no picture here: what it shows is that of the function in its slot."
    return "It has no picture here: on a ball with the defaults of all other techniques it changes nothing."


def _measured(point: Point, backend: Backend) -> Picture:
    scene = measured_scene.load(point["scene"])
    body = scene_body.body(scene.geometry)
    albedo, color = library.setter("albedo")
    matte = MaterialSection("surface", albedo, ((color, [*point["matte"], 1.0]),))
    rough, roughness = library.setter("roughness")
    stages = [*stages_of(point, body, scene.medium), matte, MaterialSection("surface", rough, ((roughness, 1.0),))]
    with tempfile.TemporaryDirectory() as folder:
        for file, text in {"material.toml": material_text("material", stages), **body.files}.items():
            Path(folder, file).write_text(text, encoding="utf-8")
        drawn = dataclasses.replace(
            scene_loading.load(measured_scenes()[point["scene"]]),
            material=str(Path(folder, "material.toml")), background=((0.0,) * 3,) * 2, ambient=(0.0,) * 3,
            size=SIZE, samples=SAMPLES,
        )  # fmt: skip
        rendered = render(drawn, backend)
    chain = " → ".join(point["chain"]) + (f" with {point['path']}" if point.get("path") else "")
    return Picture(_scaled(rendered), f"{scene.title}, scaled to the same brightness on each page: {chain}")


def _body(technique: Technique, backend: Backend) -> Picture | None:
    if textures_of(technique):
        return None
    name, color = library.setter("albedo")
    stages = [MaterialSection("surface", name, ((color, [0.6, 0.6, 0.6, 1.0]),))]
    with tempfile.TemporaryDirectory() as folder:
        scene = SCENE.format(CORNER) + FUNCTION.format(technique.name)
        rendered = _rendered(Path(folder), stages, scene, backend)
    return Picture(rendered.encoded, "The body whose distance it is") if rendered.covered.any() else None


def _on_a_ball(technique: Technique, backend: Backend) -> Picture | None:
    """The technique on a checkered ball, with its defaults, or with the first parameter that shows it.

    None if every picture is that of the ball without it.
    """
    name, _ = library.setter("albedo")
    checker = pictured_stage(library.load(name))
    for settings, with_what in (((), "its defaults"), *_tried(technique)):
        stages = [] if technique.name == name else [pictured_stage(technique, settings)]
        stages.insert(0 if technique.role != "coordinates" else len(stages), checker)
        rendered = _ball(tuple(stages), backend)
        alone = len(stages) == 1
        if not alone and np.abs(rendered.encoded - _ball((checker,), backend).encoded).max() < VISIBLE:
            continue
        caption = f"A ball with a checker, and the technique with {with_what}"
        if (rendered.encoded[rendered.covered > 0.5].min(axis=-1) > 0.99).mean() > SATURATED:
            return Picture(_scaled(rendered), caption + ", darkened")
        return Picture(rendered.encoded, caption)
    return None


def ball_at_the_ends(technique: Technique, backend: Backend) -> Picture | None:
    """The ball with the first number that changes it at the lowest and at the highest value of its range."""
    if technique.role not in ON_A_BALL:
        return None
    name, _ = library.setter("albedo")
    for parameter in facts_of(technique)["parameters"]:
        if parameter["type"] != "float" or "range" not in parameter:
            continue
        low, high = (float(end) for end in parameter["range"][:2])
        pair = []
        for value in (low, high):
            stages = [pictured_stage(technique, ((parameter["name"], value),))]
            if technique.name != name:
                stages.insert(0 if technique.role != "coordinates" else 1, pictured_stage(library.load(name)))
            try:
                pair.append(_ball(tuple(stages), backend).encoded)
            except SssgenError:  # it needs more than a ball has
                return None
        if np.abs(pair[0] - pair[1]).max() >= VISIBLE:
            caption = (
                f"The ball with {parameter['name']} at {low:g} (left) and at {high:g} (right), the ends of its range"
            )
            return Picture(np.concatenate(pair, axis=1), caption)
    return None


def _tried(technique: Technique) -> Iterator[tuple[tuple[tuple[str, object], ...], str]]:
    """Parameters that may show a technique whose defaults change nothing: numbers as they can be, colours as white."""
    for parameter in facts_of(technique)["parameters"]:
        name = parameter["name"]
        if parameter["type"] == "float" and "range" in parameter:
            highest = float(parameter["range"][1])
            yield ((name, highest),), f"{name} at {highest:g}, the highest value of its range"
            yield ((name, highest / 8),), f"{name} at {highest / 8:g}"
        elif "source_color" in parameter.get("hints", ()) and parameter["type"] == "vec3":
            yield ((name, (1.0, 1.0, 1.0)),), f"{name} white"


def _quantity(technique: Technique, backend: Backend) -> Picture | None:
    """The quantity as a grey, scaled: on a ball with a checker as each texture, or on the body in the slot."""
    quantity = technique.function.quantity
    given = [texture for texture in textures_of(technique) if not is_drawn(texture)]
    if not quantity or len(given) > 1:  # several textures hold the parts of one number: a checker says nothing
        return None
    stages = quantity_stages(technique)
    what = quantity.replace("_", " ")
    if not technique.slots:
        return Picture(_scaled(_ball(tuple(stages), backend)), f"The {what} on a ball with a checker, brighter is more")
    body = next(one for one in library.load_all() if one.attributes.shape == BODY)
    stages[0] = stages[0]._replace(bind=tuple((slot.name, body.name) for slot in technique.slots))
    with tempfile.TemporaryDirectory() as folder:
        scene = SCENE.format(CORNER) + FUNCTION.format(body.name)
        rendered = _rendered(Path(folder), stages, scene, backend)
    return Picture(_scaled(rendered), f"The {what} of a cube, brighter is more")


def _scaled(rendered: RenderedPicture) -> Array:
    """The picture of light with the brightest hundredth of the body at the same brightness for all."""
    light = rendered.linear * (BRIGHT / max(float(np.percentile(rendered.linear[rendered.covered > 0.5], 99)), 1e-3))
    return encode_srgb(light * rendered.covered[..., None] + BACKGROUND * (1.0 - rendered.covered[..., None]))


@functools.cache
def _ball(stages: tuple[MaterialSection, ...], backend: Backend) -> RenderedPicture:
    with tempfile.TemporaryDirectory() as folder:
        write_pictures(folder)
        return _rendered(Path(folder), stages, SCENE.format(FRONT) + BALL, backend)


def _rendered(folder: Path, stages: Sequence[MaterialSection], scene: str, backend: Backend) -> RenderedPicture:
    (folder / "material.toml").write_text(material_text("material", stages), encoding="utf-8")
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    loaded = scene_loading.load(str(folder / "scene.toml"))
    return render(dataclasses.replace(loaded, size=SIZE, samples=SAMPLES), backend)
