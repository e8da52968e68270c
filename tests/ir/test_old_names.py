"""Old names of functions: each means a function that there is, with as many arguments."""

from __future__ import annotations

import pytest

from sssgen.ir.old_names import OLD_NAMES, new_name
from sssgen.ir.out_builtins import is_out_builtin, out_builtin
from sssgen.ir.projective_reads import PROJECTIVE_READS, kept_components
from sssgen.ir.signatures import overloads
from sssgen.ir.types import FLOAT, INT, VEC2, VEC3, VEC4, Sampler, Type, Vector, vector_of

IVEC2, IVEC3 = Vector("int", 2), Vector("int", 3)
PLACES: dict[str, tuple[Type, Type, Type]] = {
    "2DArray": (VEC3, IVEC3, VEC2), "2D": (VEC2, IVEC2, VEC2), "3D": (VEC3, IVEC3, VEC3), "Cube": (VEC3, IVEC3, VEC3),
}  # fmt: skip
"""Dimension → the types of a coordinate, of a texel's place, and of a derivative."""


def arguments(old: str, new: str, count: int) -> list[Type]:
    """The types with which an old name was called."""
    dim = next(dim for dim in PLACES if dim in old.replace("1D", "2D"))  # a texture of one row
    coord, texel, slope = PLACES[dim]
    shadow = old.startswith("shadow")
    sampler = Sampler(dim.removesuffix("Array"), array=dim.endswith("Array"), shadow=shadow)
    coord = VEC3 if shadow else coord
    place = VEC4 if "Proj" in new else texel if "Fetch" in new else coord
    rest: list[Type] = [slope, slope] if "Grad" in new else [INT if "Fetch" in new else FLOAT]
    return [sampler, INT] if "Size" in new else [sampler, place, *rest][:count]


@pytest.mark.parametrize("old", OLD_NAMES)
def test_an_old_name_means_a_function_with_these_arguments(old: str) -> None:
    new, counts = OLD_NAMES[old]
    for count in counts:
        assert new_name(old, count) == new
        types = arguments(old, new, count)
        assert len(types) == count
        name = PROJECTIVE_READS.get(new, new)
        if name != new:
            kept = kept_components(types[0], types[1])
            assert kept is not None
            types[1] = vector_of("float", kept)
        known = out_builtin(name, types) is not None if is_out_builtin(name) else tuple(types) in overloads(name)
        assert known, (old, new, types)
        assert old not in (new, *overloads(old))


def test_other_names_and_argument_counts_are_unchanged() -> None:
    assert new_name("texture2D", 4) is None
    assert new_name("texture2DLod", 2) is None
    assert new_name("texture", 2) is None
    assert new_name("mix", 3) is None
