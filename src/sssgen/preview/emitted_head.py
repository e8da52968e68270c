"""What a page shows of a material and that follows from its text alone: the module, the parameters, the texture slots.

It needs no NumPy, so that it is made anew for each edit, also where a browser runs Python.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from sssgen.ir.view_textures import BACK_FACES, DISTANT, LIGHT
from sssgen.material.model import Material
from sssgen.pipeline.compiler import Compiled

TARGET = "threejs"
DRAWN_BY_PAGE = (BACK_FACES, LIGHT, DISTANT)
"""The textures that the page draws for each frame; the others are made once, for the scene's own light."""
PARTS = ("name", "title", "module", "controls", "textures", "two_sided", "cost")
"""The parts of a head that `emitted_head` makes."""


def emitted_head(
    material: Material, compiled: Compiled, values: Mapping[str, Sequence[float]], in_scene: Collection[str]
) -> dict[str, Any]:
    """The part of a picture's head for a material that is compiled for `TARGET`.

    `values` are the parameters that the scene gives, baked files among them; `in_scene` are those that a scene's file
    sets.
    """
    reflection = compiled.reflection
    return {
        "name": material.name,
        "title": material.title,
        "module": next(text for name, text in compiled.files.items() if name.endswith(".js")),
        "controls": controls(reflection, values, in_scene),
        "textures": [
            {
                "property": texture["property"],
                "source_name": texture["source_name"],
                "technique": texture["technique"],
                "name": texture["technique_name"],
                "type": texture["type"],
                "color": texture["color"],
                "doc": texture["doc"],
                "drawn": texture["drawn"] or "",
                "page_draws": texture["drawn"] in DRAWN_BY_PAGE,
            }
            for texture in reflection["textures"]
        ],
        "two_sided": reflection["two_sided"],
        "cost": {kind: entry["cost"] for kind, entry in reflection["entries"].items() if "cost" in entry},
    }


def controls(
    reflection: Mapping[str, Any], values: Mapping[str, Sequence[float]], in_scene: Collection[str]
) -> list[dict[str, Any]]:
    """The parameters that a person may change, with what a control needs to know."""
    return [
        {
            "property": uniform["property"],
            "technique": uniform["technique"],
            "name": uniform["technique_name"],
            "label": uniform["source_name"],
            "doc": uniform["doc"],
            "type": uniform["type"],
            "range": uniform["range"],
            "unit": uniform["unit"],
            "color": uniform["color"],
            "default": [float(number) for number in uniform["default"]],
            "value": [float(number) for number in values.get(uniform["source_name"], uniform["default"])],
            "drawn": uniform["drawn"],
            "in_scene": uniform["source_name"] in in_scene,
        }
        for uniform in reflection["uniforms"]
    ]
