"""The smallest material that shows a technique: with a checker as its texture, and with what gives its quantities."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler, spell
from sssgen.lab.measure.candidates import PROBES
from sssgen.material import library
from sssgen.material.library import Technique
from sssgen.material.material_text import MaterialSection
from sssgen.material.technique_facts import facts_of
from sssgen.run.backends import Array
from sssgen.scene.pictures.images import write_png
from sssgen.support.diagnostics import failure

BODY = "box"
"""The function in slots of a distance; the body is then the same."""
CHECKER, BUMPS, BUMPS_Y_DOWN = "checker.png", "bumps.png", "bumps_y_down.png"
TEXELS, SQUARES = 256, 8
_CARRIED = ("thickness", "view_thickness", "thinness", "transmittance")
"""The quantities that a stage may take from one before it."""


def write_pictures(folder: str) -> None:
    """Writes the pictures that the stages read into the material's folder."""
    bumps = _bumps()
    for name, texels in {CHECKER: _checker(), BUMPS: bumps, BUMPS_Y_DOWN: bumps * [1, -1, 1] + [0, 1, 0]}.items():
        write_png(os.path.join(folder, name), texels)


def textures_of(technique: Technique) -> list[Uniform]:
    """The textures that a technique declares."""
    return [uniform for uniform in technique.uniforms if isinstance(uniform.type, Sampler)]


def is_drawn(uniform: Uniform) -> bool:
    """Whether the renderer draws the texture for each picture."""
    return "drawn" in dict(uniform.hints)


def pictured_stage(technique: Technique, values: tuple[tuple[str, object], ...] = ()) -> MaterialSection:
    """The technique with a picture as each of its textures, and defaults for all but the given values."""
    given = [uniform for uniform in textures_of(technique) if not is_drawn(uniform)]
    return MaterialSection(
        technique.role, reference_to(technique), (*values, *((one.name, _picture_for(one)) for one in given))
    )


def checker_stage() -> MaterialSection:
    """The stage that gives the surface the colours of the checker."""
    return pictured_stage(library.load(library.setter("albedo")[0]))


def matte(color: tuple[float, float, float]) -> list[MaterialSection]:
    """The stages of a rough surface of one colour."""
    albedo, tint = library.setter("albedo")
    rough, roughness = library.setter("roughness")
    return [
        MaterialSection("surface", albedo, ((tint, (*color, 1.0)),)),
        MaterialSection("surface", rough, ((roughness, 1.0),)),
    ]


def quantity_stages(technique: Technique) -> list[MaterialSection]:
    """The technique, and stages that show the quantity that it gives or changes as a grey. Raises SssgenError."""
    changed = [param.quantity for param in technique.function.params if param.direction == "inout" and param.quantity]
    quantity = technique.function.quantity or next(iter(changed), "")
    probe = os.path.join(PROBES, f"shown_{quantity}.sss")
    if not os.path.isfile(probe):
        raise failure(
            f"'{technique.name}' gives no quantity that can be shown", "show it in a material", technique.path
        )
    shown = MaterialSection("translucency", probe)
    return [pictured_stage(technique), shown, *matte((0.0, 0.0, 0.0))]


def chain_of(technique: Technique) -> list[MaterialSection]:
    """The smallest chain that shows a technique: before it, what gives it its quantities; in slots, what fits.

    Raises SssgenError for a role that a material of a body does not have, and where nothing gives a quantity.
    """
    role = technique.role
    for texture in textures_of(technique):
        if role != "distance" and not is_drawn(texture) and spell(texture.type) != "sampler2D":
            message = f"'{technique.name}' reads '{texture.name}', a {spell(texture.type)}, which no picture can be"
            raise failure(message, "show it in a material with that texture", technique.path)
    if role in ("coordinates", "surface"):
        stages = [pictured_stage(technique)]
        if technique.name != library.setter("albedo")[0]:
            stages.insert(0 if role == "surface" else 1, checker_stage())
    elif role in ("thickness", "conversion"):
        stages = quantity_stages(technique)
        if role == "conversion":
            stages[0] = stages[0]._replace(section="thickness")
    elif role == "translucency":
        stages = [pictured_stage(technique), *matte((0.2, 0.2, 0.2))]
    elif role == "distance":
        return matte((0.6, 0.6, 0.6))
    else:
        hint = "use it in a material; sssgen render draws shells without an engine"
        raise failure(
            f"'{technique.name}' has the role {role}, which is no part of a body's material", hint, technique.path
        )
    own = next(index for index, stage in enumerate(stages) if stage.technique == reference_to(technique))
    stages[own] = stages[own]._replace(bind=tuple(bindings_of(technique).items()))
    return [*_suppliers(technique, ()), *stages]


def reference_to(technique: Technique) -> str:
    """The technique as a material of any folder names it."""
    own = library.index().get(technique.name)
    return (
        technique.name if own is not None and os.path.samefile(own, technique.path) else os.path.abspath(technique.path)
    )


def _quantities_taken(technique: Technique) -> list[str]:
    params = technique.function.params
    return [param.quantity for param in params if param.direction != "out" and param.quantity in _CARRIED]


def _suppliers(technique: Technique, given: tuple[str, ...]) -> list[MaterialSection]:
    """The stages that give the quantities that a technique takes."""
    stages: list[MaterialSection] = []
    for quantity in dict.fromkeys(_quantities_taken(technique)):
        if quantity in given:
            continue
        supplier = min(
            _givers(quantity), key=lambda item: (len(_quantities_taken(item)), len(item.function.params)), default=None
        )
        if supplier is None:
            raise failure(
                f"nothing in the library gives the {quantity} that '{technique.name}' takes", "", technique.path
            )
        stages += _suppliers(supplier, (*given, quantity))
        stages.append(MaterialSection("thickness", supplier.name))
    return stages


def _givers(quantity: str) -> Iterator[Technique]:
    """The techniques that give a quantity and need no body, no bake and no picture for it."""
    for technique in library.load_all():
        simple = not technique.slots and all(map(is_drawn, textures_of(technique))) and not technique.baseline
        if technique.role in ("thickness", "conversion") and technique.function.quantity == quantity and simple:
            yield technique


def bindings_of(technique: Technique, given: Mapping[str, str] = MappingProxyType({})) -> dict[str, str]:
    """A function for each slot, and for the slots of these: the `given` one of a slot, or one of the library.

    Raises SssgenError for a slot that nothing in the library fits.
    """
    bound: dict[str, str] = {}
    waiting = [technique]
    while waiting:
        for slot in facts_of(waiting.pop())["slots"]:
            if slot["name"] in bound:
                continue
            if not slot["functions"] and slot["name"] not in given:
                raise failure(f"nothing in the library fits the slot {slot['signature']}", "", technique.path)
            name = given.get(slot["name"]) or (BODY if BODY in slot["functions"] else _least(slot["functions"]))
            bound[slot["name"]] = name
            if name in library.index():
                waiting.append(library.load(name))
    return bound


def _least(names: list[str]) -> str:
    """The function that reads the fewest textures which somebody has to bake, then the first."""
    return min(
        names, key=lambda name: sum(not is_drawn(one) for one in textures_of(library.load(name.partition(":")[0])))
    )


def _picture_for(texture: Uniform) -> str:
    if "normal_map" not in dict(texture.hints):
        return CHECKER
    return BUMPS_Y_DOWN if texture.name.endswith("y_down") else BUMPS


def _checker() -> Array:
    """Squares of two colours: (texels, texels, 3)."""
    rows, columns = np.indices((TEXELS, TEXELS)) * SQUARES // TEXELS
    even = ((rows + columns) % 2 == 0)[..., None]
    return np.where(even, [0.8, 0.5, 0.3], [0.25, 0.4, 0.55])


def _bumps() -> Array:
    """A normal map with y up: a dome in each square."""
    place = (np.arange(TEXELS) + 0.5) * SQUARES / TEXELS % 1.0 * 2.0 - 1.0
    x, y = np.meshgrid(place, -place)
    inside = x * x + y * y < 1.0
    normals = np.stack([x * inside, y * inside, np.full_like(x, 1.0)], axis=-1)
    unit: Array = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return 0.5 + 0.5 * unit
