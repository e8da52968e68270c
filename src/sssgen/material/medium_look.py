"""The look of a medium: its colour and its depth, which a stage takes in place of its albedo and its extinction.

Artists choose what a thick body reflects and how deep light reaches; techniques take the coefficients of light
transport. Each key of the look sets one of these parameters, and the mean free path follows from the depth.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from sssgen.ir.nodes import Uniform
from sssgen.ir.spans import NOWHERE
from sssgen.ir.types import VEC3
from sssgen.material.scatter_color import albedo_of_color

COLOR, DEPTH = "color", "depth"
DEPTHS = (1e-4, 100.0)
"""The range of a depth, in world units."""
_ALBEDO, _EXTINCTION, _PATH = "scattering_albedo", "extinction", "mean_free_path"

KEYS: Mapping[str, Uniform] = {
    COLOR: Uniform(
        COLOR, VEC3, (0.8, 0.6, 0.4), (("source_color", ()), ("hint_range", (0.0, 1.0)), ("unit", ("1",))), "",
        f"What a thick body of the medium reflects of diffuse light, in place of {_ALBEDO}.", NOWHERE,
    ),
    DEPTH: Uniform(
        DEPTH, VEC3, (0.2, 0.2, 0.2), (("hint_range", DEPTHS), ("unit", ("m",))), "",
        f"The mean free path of light in the medium, per channel, in place of {_EXTINCTION}.", NOWHERE,
    ),
}  # fmt: skip
"""The keys of the look, declared as parameters are."""
REPLACED: Mapping[str, tuple[str, ...]] = {COLOR: (_ALBEDO,), DEPTH: (_EXTINCTION, _PATH)}
"""Key → the parameters that follow from it."""


def look_keys(uniforms: Iterable[Uniform]) -> dict[str, Uniform]:
    """The keys that a stage with these parameters takes. A parameter of its own with that name comes first."""
    names = {uniform.name for uniform in uniforms}
    return {key: KEYS[key] for key, replaced in REPLACED.items() if key not in names and names & {*replaced}}


def medium_parameters(key: str, numbers: Sequence[float]) -> dict[str, list[float]]:
    """Parameter → its components, for a key of the look with three numbers in its range."""
    if key == COLOR:
        return {_ALBEDO: [albedo_of_color(part) for part in numbers]}
    extinction = [1.0 / part for part in numbers]
    return {_EXTINCTION: extinction, _PATH: [len(extinction) / sum(extinction)]}
