"""The reference's renderer: Mitsuba 3 traces given rays through one homogeneous body, for one colour channel at a time.

It uses the variant `scalar_rgb`, which needs neither a GPU nor LLVM, and the integrator `volpath` without a limit of
path depth.
"""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sssgen.scene.geometry import Ball, Box, Geometry, Slab
from sssgen.scene.geometry_mesh import RESOLUTION, box_size, mesh_of
from sssgen.support.diagnostics import failure
from sssgen.support.installation import install_hint

Array = npt.NDArray[np.float64]

_BLOCK = 32
"""The side of a render block in pixels. Mitsuba's own choice depends on the number of threads."""

_FAINT = 1e-3
"""The weight below which Russian roulette ends paths: so low that surviving paths with a large weight are rare."""

_ROULETTE_ALBEDO = 0.95
"""The largest albedo for Russian roulette. Mitsuba continues at most 95 % of the paths, so that above it their weights
grow without bound."""

_NEVER = 2**30

_FAR = 1000.0
"""The distance of a light with a radius, in radii of the body."""


@dataclass(frozen=True)
class Body:
    """A geometry for Mitsuba, in world space: one of its shapes with a matrix, or triangles."""

    kind: str
    """sphere, cube (from −1 to 1) or mesh"""
    matrix: Array
    """(4, 4): to world space; the identity for a mesh"""
    vertices: Array
    """(v, 3)"""
    faces: npt.NDArray[np.int64]
    """(f, 3)"""
    centre: Array
    """(3,): with `radius` a ball that encloses the body"""
    radius: float

    def content(self) -> bytes:
        """The bytes that identify it."""
        return b"".join([self.kind.encode(), self.matrix.tobytes(), self.vertices.tobytes(), self.faces.tobytes()])


def body_of(geometry: Geometry, resolution: int = RESOLUTION) -> Body:
    """Ball, box and slab are exact; other shapes become triangles, see `geometry_mesh`, with its SssgenError."""
    empty = np.zeros((0, 3))
    if isinstance(geometry, Ball | Box | Slab):
        half = np.full(3, geometry.radius) if isinstance(geometry, Ball) else 0.5 * np.array(box_size(geometry))
        reach = geometry.radius if isinstance(geometry, Ball) else float(np.linalg.norm(half))
        matrix = geometry.to_world() @ np.diag([*half, 1.0])
        kind = "sphere" if isinstance(geometry, Ball) else "cube"
        centre = np.array(geometry.position, np.float64)
        return Body(kind, matrix, empty, empty.astype(np.int64), centre, reach * geometry.scale)
    vertices, faces = mesh_of(geometry, resolution)
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    radius = float(np.linalg.norm(vertices - centre, axis=1).max())
    return Body("mesh", np.eye(4), vertices, faces, centre, radius)


@dataclass(frozen=True)
class Channel:
    """A medium in one colour channel."""

    extinction: float
    albedo: float
    anisotropy: float
    ior: float


@dataclass(frozen=True)
class Light:
    """The only light: an irradiance of 1 on a plane that faces it."""

    direction: tuple[float, float, float] | None
    """Unit, world space, towards the light; None for uniform light from everywhere"""
    radius: float = 0.0
    """In degrees, as seen from the body: 0 for a directional light, otherwise a disc; below 90"""


class Renderer:
    """Renders of n rays through one body, in one channel; the calls of `batch` are independent."""

    def __init__(
        self, body: Body, channel: Channel, light: Light, rays: tuple[Array, Array], base: int, scatterings: int
    ) -> None:
        """`rays` are origins and unit directions, (n, 3) each; `base` is the seed of the random stream.

        With `scatterings` above 0, only light with at most that many scatterings counts.
        """
        self._mitsuba = mitsuba()
        # Mitsuba seeds pixel i of block b in render s with  base + s · (pixels) + b · (a block's pixels) + i.  The
        # film is one line high, and blocks extend beyond it: renders this far apart never share a seed.
        blocks = -(-len(rays[0]) // _BLOCK)
        self._stride = -(-blocks * _BLOCK * _BLOCK // len(rays[0]))
        self._scene = self._load(body, channel, light, rays, base, scatterings)

    def batch(self, number: int, samples: int) -> Array:
        """π times the radiance along each ray, (n,), by `samples` paths each."""
        mi = self._mitsuba
        image = np.array(mi.render(self._scene, spp=samples, seed=(number * self._stride) % 2**32))
        return np.pi * image[0, :, 0].astype(np.float64)

    def _load(
        self, body: Body, channel: Channel, light: Light, rays: tuple[Array, Array], base: int, scatterings: int
    ) -> Any:
        mi = self._mitsuba
        line = {"type": "hdrfilm", "height": 1, "rfilter": {"type": "box"}, "component_format": "float32"}
        sensors: dict[str, Any] = {
            f"ray{i:07}": {
                "type": "radiancemeter",
                "origin": origin,
                "direction": direction,
                "film": {**line, "width": 1},
            }
            for i, (origin, direction) in enumerate(zip(rays[0].tolist(), rays[1].tolist(), strict=True))
        }
        film = {**line, "width": len(rays[0]), "pixel_format": "rgb"}
        return mi.load_dict(
            {
                "type": "scene",
                "integrator": {
                    "type": "volpath",
                    "max_depth": 1 + scatterings if scatterings else -1,
                    "rr_depth": _roulette_depth(channel.albedo),
                    "block_size": _BLOCK,
                },
                "sensor": {"type": "batch", "film": film, "sampler": {"type": "independent", "seed": base}, **sensors},
                "body": self._shape(body, channel),
                "light": self._light(body, light),
            }
        )

    def _shape(self, body: Body, channel: Channel) -> Any:
        mi = self._mitsuba
        medium = {
            "type": "homogeneous",
            "sigma_t": channel.extinction,
            "albedo": channel.albedo,
            "has_spectral_extinction": False,
            "phase": {"type": "hg", "g": channel.anisotropy} if channel.anisotropy else {"type": "isotropic"},
        }
        boundary = (
            {"type": "null"} if channel.ior == 1.0 else {"type": "dielectric", "int_ior": channel.ior, "ext_ior": 1.0}
        )
        if body.kind != "mesh":
            to_world = mi.ScalarTransform4f(body.matrix)
            return {"type": body.kind, "to_world": to_world, "bsdf": boundary, "interior": medium}
        properties = mi.Properties()
        properties["mesh_bsdf"], properties["interior"] = mi.load_dict(boundary), mi.load_dict(medium)
        mesh = mi.Mesh("body", len(body.vertices), len(body.faces), props=properties)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = np.ravel(body.vertices).astype(np.float32)
        parameters["faces"] = np.ravel(body.faces).astype(np.uint32)
        parameters.update()
        return mesh

    def _light(self, body: Body, light: Light) -> Any:
        mi = self._mitsuba
        if light.direction is None:
            return {"type": "constant", "radiance": float(1.0 / np.pi)}
        if light.radius == 0.0:
            return {"type": "directional", "direction": [-x for x in light.direction], "irradiance": 1.0}
        distance = _FAR * body.radius
        middle = body.centre + distance * np.array(light.direction)
        to_world = mi.ScalarTransform4f().look_at(
            origin=middle.tolist(), target=body.centre.tolist(), up=_perpendicular(np.array(light.direction)).tolist()
        )
        radius = np.tan(np.radians(light.radius)) * distance
        radiance = float(1.0 / (np.pi * np.sin(np.radians(light.radius)) ** 2))
        emitter = {"type": "area", "radiance": radiance}
        return {"type": "disk", "to_world": to_world @ mi.ScalarTransform4f().scale(float(radius)), "emitter": emitter}


def _roulette_depth(albedo: float) -> int:
    """The number of collisions after which a path's weight is below _FAINT; _NEVER without roulette."""
    if albedo > _ROULETTE_ALBEDO:
        return _NEVER
    return 1 + (math.ceil(math.log(_FAINT) / math.log(albedo)) if albedo > 0.0 else 0)


def _perpendicular(direction: Array) -> Array:
    """A direction perpendicular to another."""
    return np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])


def mitsuba() -> Any:
    """Mitsuba with its variant set. Raises SssgenError if it is missing."""
    try:
        module = importlib.import_module("mitsuba")
    except ImportError as error:
        raise failure(f"the package 'mitsuba' is missing: {error}", install_hint("reference")) from None
    module.set_variant("scalar_rgb")
    return module
