"""Random inputs for a technique, in the declared meaning of each of its parameters.

The numbers of each parameter depend only on its name and the seed: directions are unit vectors (some nearly parallel or
opposite to one another), a scalar quantity is in its range (including exactly 0 and 1), a uniform is in its
`sample_range` (its `bound_range` if another technique's file declares it), its `hint_range`, or around its default if
it has neither. Textures hold float16 numbers, smooth in one half and random steps in the other; 3-D textures are
distance fields.
"""

from __future__ import annotations

from typing import Any
from zlib import crc32

import numpy as np

from sssgen.ir.nodes import Param, Uniform
from sssgen.ir.types import Matrix, Sampler, Scalar, Vector, kind_of
from sssgen.run.backends import Array
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.run.evaluate.probes import Subject
from sssgen.support.paths import stem
from sssgen.targets.runtime.numpy_textures import Texture

ENDS = 0.04
"""The share of numbers that are exactly an end of their range."""
ALIGNED = 0.2
"""The share of directions that lie nearly along one line."""
AIMED = 0.9
"""The share of rays that go towards the middle of the scene."""
MISSING = 0.2
"""The share of lanes without a view, where a view may be missing."""
TEXELS = 16
"""Texels along each side of a texture."""

RANGES = {
    "uv_position": (-1.0, 2.0), "world_position": (-2.0, 2.0), "object_position": (-1.0, 1.0), "thickness": (0.0, 2.0),
    "view_thickness": (0.0, 2.0),
    "thinness": (0.0, 1.0), "transmittance": (0.0, 1.0), "time": (0.0, 60.0), "light_color": (0.0, 4.0),
}  # fmt: skip
"""The ranges of parameters, by quantity or name; all others have 0 to 1."""


def samples(subject: Subject, count: int, seed: int = 0) -> dict[str, Any]:
    """`count` inputs, lanes first, as `evaluation.fitted` takes them; arrays, which it does not take, are left out."""
    inputs: dict[str, Any] = {}
    for name, param in subject.params.items():
        if isinstance(param.type, Sampler):
            inputs[name] = texture(param.type.dim, _rng(name, seed))
        elif isinstance(param.type, Scalar | Vector | Matrix):
            uniform = subject.uniforms.get(name)
            inputs[name] = _uniform(subject, uniform, count, seed) if uniform else _parameter(param, count, seed)
    return inputs


def texture(dim: str, rng: np.random.Generator) -> Texture:
    """A float16 texture: one half smooth, the other with random steps; in 3-D the distance field of a ball."""
    centers = (np.arange(TEXELS) + 0.5) / TEXELS
    if dim == "3D":
        z, y, x = np.meshgrid(centers, centers, centers, indexing="ij")
        distance = np.sqrt((x - 0.45) ** 2 + (y - 0.5) ** 2 + (z - 0.55) ** 2) - 0.3
        return Texture((0.5 + 0.5 * distance)[..., None].astype(np.float16), wrap="clamp")
    size = (6, TEXELS, TEXELS, 4) if dim == "Cube" else (TEXELS, TEXELS, 4)
    waves = 0.5 + 0.5 * np.sin(2.0 * np.pi * (centers[:, None, None] + centers[:, None] + rng.random(4)))
    hard = rng.choice([0.0, 1.0, 0.25, 0.7], size)
    return Texture(np.where(centers[:, None] < 0.5, waves, hard).astype(np.float16), dim=dim)


def _parameter(param: Param, count: int, seed: int) -> Array:
    name, quantity, shape = param.name, param.quantity, shape_of(param.type)
    if quantity.endswith("_direction") or (shape == (3,) and name in ("N", "V", "L", "T", "B")):
        return _direction(name, quantity, (count, *shape), seed)
    rng = _rng(name, seed)
    if kind_of(param.type) == "bool":
        return rng.random((count, *shape)) < 0.5
    if kind_of(param.type) != "float":
        return rng.integers(0, 10, (count, *shape))
    return _within(rng, (count, *shape), *RANGES.get(quantity or name, (0.0, 1.0)))


def _direction(name: str, quantity: str, size: tuple[int, ...], seed: int) -> Array:
    """Unit vectors. T and B are nearly perpendicular to N, as in a mesh; a tangent-space normal points outwards."""
    rng, each = _rng(name, seed), (size[0], 1)
    if name in ("T", "B"):
        normal = _direction("N", quantity, size, seed)
        tangent = np.cross(normal, np.roll(normal, 1, axis=1) * [1.0, -1.0, 1.0])
        sign = np.where(_rng("handedness", seed).random(each) < 0.3, -1.0, 1.0)
        square = tangent if name == "T" else sign * np.cross(normal, tangent)
        return _unit(_unit(square) + rng.uniform(-0.2, 0.2, size))
    anywhere = rng.normal(size=size)
    if name == "ray_direction":
        origin = _within(_rng("ray_origin", seed), size, *RANGES["world_position"])
        aimed = rng.random(each) < AIMED
        return _unit(np.where(aimed, rng.uniform(-0.25, 0.25, size) - origin, anywhere))
    line = _unit(_rng("line", seed).normal(size=size)) * rng.choice([-1.0, 1.0], each)
    aligned = _rng("aligned", seed).random(each) < ALIGNED
    directions = _unit(np.where(aligned, line + 10.0 ** rng.uniform(-4.0, -0.5, each) * anywhere, anywhere))
    if quantity == "tangent_direction":
        directions[:, -1] = np.abs(directions[:, -1])
    return directions


def _uniform(subject: Subject, uniform: Uniform, count: int, seed: int) -> Array:
    rng, hints = _rng(uniform.name, seed), dict(uniform.hints)
    size = (count, *shape_of(uniform.type))
    default = np.array(uniform.default, np.float64).reshape(size[1:])
    ends = _ends(subject, uniform)
    if ends or "source_color" in hints:
        low, high = (float(end) for end in (ends or (0.0, 1.0))[:2])
    kind = kind_of(uniform.type)
    if kind == "bool":
        return rng.random(size) < 0.5
    if kind != "float":
        # more than twice the default steps only takes longer
        most = max(low, min(high, 2.0 * float(default.max()))) if ends else 9.0
        return rng.integers(int(low) if ends else 0, int(most) + 1, size)
    if ends or "source_color" in hints:
        return _within(rng, size, low, high)
    if isinstance(uniform.type, Matrix) and not default.any():
        # a view that may be missing: in some lanes it is
        views = rng.uniform(-0.5, 0.5, size)
        views[..., -1] = np.eye(size[-1])[-1]
        return np.where(rng.random(count)[:, None, None] < MISSING, 0.0, views)
    if isinstance(uniform.type, Matrix):
        moved = default + rng.uniform(-0.1, 0.1, size)
        moved[..., -1] = default[..., -1]  # the last row stays, so that no point lies at infinity
        return moved
    spread = min(0.5 * np.abs(default).max(), 0.25) or 0.25
    return np.asarray(default + rng.uniform(-spread, spread, size))


def _ends(subject: Subject, uniform: Uniform) -> tuple[float | str, ...]:
    """The declared range of a uniform's random values, () for none; its own technique takes the whole `hint_range`."""
    hints = dict(uniform.hints)
    if "bound_range" in hints and stem(uniform.span.file) != subject.name:
        return hints["bound_range"]
    return hints.get("sample_range") or hints.get("hint_range") or ()


def _within(rng: np.random.Generator, size: tuple[int, ...], low: float, high: float) -> Array:
    """Numbers over a range, some at its ends. A range over several powers of ten is drawn by its logarithm."""
    if low > 0.0 and high >= 100.0 * low:
        samples = np.exp(rng.uniform(np.log(low), np.log(high), size))
    else:
        samples = rng.uniform(low, high, size)
    chance = rng.random(size)
    numbers: Array = np.where(chance < 0.5 * ENDS, low, np.where(chance > 1.0 - 0.5 * ENDS, high, samples))
    return numbers


def _unit(vectors: Array) -> Array:
    lengths: Array = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: Array = vectors / lengths
    return unit


def _rng(name: str, seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, crc32(name.encode())])
