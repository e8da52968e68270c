"""Checks the locations that a text gives its uniforms. The targets choose them anew; in OpenGL they may not overlap."""

from __future__ import annotations

from sssgen.ir.types import Type, uniform_locations
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.context import CheckContext
from sssgen.lang.syntax import tree as s

MOST = 1024
"""How many locations every OpenGL has for uniforms (GLSL ES 3.10, gl_MaxUniformLocations)."""


def uniform_location(context: CheckContext, qualifiers: s.Qualifiers, name: s.Name, type_: Type, element: int) -> int:
    """The location of a uniform, or of an element of an array of textures; -1 where the text states none."""
    stated = next((value for key, value in qualifiers.layout if key == "location" and value is not None), None)
    if stated is None:
        return -1
    first, count = constant_int(context, stated), uniform_locations(type_)
    if first is None or not 0 <= first <= MOST - count - element:
        message = f"the locations of '{name.text}' must be integers from 0 to {MOST - 1}"
        raise context.fail(stated.span, message)
    first += element
    for location in range(first, first + count):
        owner = context.uniform_locations.setdefault(location, name.text)
        if owner != name.text:
            message = f"the location {location} of '{name.text}' belongs to '{owner}'"
            hint = "an array and a struct take a location for each element and member"
            raise context.fail(stated.span, message, hint)
    return first
