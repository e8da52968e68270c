"""The types of the facts in the JSON file next to a baked texture, by what is baked.

Lengths are in units of the mesh, and places in its object space, unless a docstring says otherwise. Shares are 0 to 1.
"""

from __future__ import annotations

from typing import Any, NotRequired, TypedDict

from sssgen.material.baked import ParameterValue
from sssgen.scene.body_identity import BodyIdentity, BodyMeasures
from sssgen.targets.reflection_record import ImportSettings

_Imported = TypedDict("_Imported", {"import": ImportSettings})  # a keyword cannot be the name of a field of a class


class BakeFacts(_Imported):
    """What all bakes have; `import` is of `targets.texture_import.import_settings`."""

    kind: str
    holds: str | None
    """The quantity type of its numbers, as `material.baked.BakeFile.holds`"""
    parameters: dict[str, ParameterValue]
    """The parameters of techniques that it needs, by name: TOML values"""
    texture: NotRequired[str]
    """The name of the texture in its technique, if a bake has several"""


class MeshFacts(BodyMeasures):
    """A mesh."""

    triangles: int
    inside_out: bool
    turned: int
    """How many triangles were turned, so that neighbours face the same way"""
    mixed_sides: bool
    """Whether its triangles disagree about its inside"""


class SolidFacts(MeshFacts):
    """A mesh of a distance texture."""

    closed: bool
    box_min: list[float]
    box_max: list[float]


class DistanceError(TypedDict):
    """The largest errors of a distance texture, as lengths."""

    at_texels: float
    between_texels: float
    but: NotRequired[str]
    """Where they do not hold"""


class DistanceFacts(BakeFacts):
    """A distance texture."""

    mesh: SolidFacts
    texels: list[int]
    """Along x, y and z"""
    voxel: list[float]
    """The size of a voxel along x, y and z"""
    box_min: list[float]
    box_max: list[float]
    encoding: str
    formula: str
    range: float
    """The distance of the largest stored number"""
    beyond_range: float
    """The share of texels"""
    sign: str
    error: DistanceError
    inside: float
    """The share of texels"""


class SurfaceFacts(MeshFacts):
    """A mesh of a map on its surface."""

    new_uv: bool
    """Whether the bake made its texture coordinates"""
    shared_texels: float
    """The share of texels with several surface points"""


class SurfaceMapFacts(BakeFacts):
    """What maps on the surface of a mesh have."""

    mesh: SurfaceFacts
    unit: str
    formula: str
    texels: int
    """Those on the surface"""
    rays: int
    """Per texel"""
    lost_rays: float
    """The share that leaves through holes"""


class ThicknessError(TypedDict):
    """Standard errors of a thickness map, or those of its quadrature, in the unit of its range."""

    mean_standard_error: float
    largest_standard_error: float


class ThicknessFacts(SurfaceMapFacts):
    """A map of thickness or transmittance."""

    mode: str
    by_rays: float
    """The share of texels whose values come from rays; those of the others are integrals"""
    light: dict[str, list[float]] | None
    """See `BakeLight.facts`"""
    range: list[float]
    """The values of the texels 0 and 1"""
    mean: float
    error: ThicknessError
    attenuation_distance: float | None


class ViewThicknessError(TypedDict):
    """Errors of the share of light that is absorbed, which is 0 to 1."""

    mean_of_fit: float
    """Root mean square"""
    largest_of_fit: float
    rounding: float
    """Root mean square"""
    relative_to: str


class ViewThicknessFacts(SurfaceMapFacts):
    """A map of lengths along the rays of an eye."""

    body: BodyIdentity
    mean_free_path: float
    error: ViewThicknessError


class DepthFacts(BakeFacts):
    """A depth map."""

    light: dict[str, list[float]]
    """See `BakeLight.facts`"""
    unit: str
    formula: str
    range: list[float]
    """The smallest and the largest depth of the mesh"""
    nothing: float
    """The depth of texels without the mesh"""
    covered: float
    """The share of texels with the mesh"""


class MediumFacts(TypedDict):
    """The medium of baked light."""

    name: str
    extinction: list[float]
    """Per world unit, for red, green and blue"""
    albedo: list[float]
    """Of single scattering, for red, green and blue"""
    anisotropy: float
    """The mean cosine of scattering, -1 to 1"""
    ior: float
    roughness: float
    """Of the boundary, 0 to 1"""


class FluenceError(TypedDict):
    """The error of a voxel of baked light."""

    standard_error: float
    relative_to: str


class FluenceFacts(BakeFacts):
    """Baked light in a body."""

    body: BodyIdentity
    medium: MediumFacts
    texels: list[int]
    voxel: float
    """The longest side of a voxel, in world units"""
    box_min: list[float]
    box_max: list[float]
    photons: int
    """Per direction"""
    directions: int
    seed: int
    error: FluenceError
    opaque_voxels: bool
    """Whether little light crosses a voxel in some channel"""
    object_to_volume: list[list[float]]
    """(4, 4), to 0..1 in the volume"""
    rank: NotRequired[int]
    """Numbers a voxel, of light from any direction"""
    light: NotRequired[dict[str, list[float]]]
    """See `BakeLight.facts`; of light from one direction"""
    technique: NotRequired[str]
    """The technique that reads it"""


class RelitFacts(FluenceFacts):
    """The response of a body to light from anywhere: see `sssgen.scene.light_response`."""

    arrays: dict[str, Any]
    """Name → type, shape, and the first byte in the file"""
    highest: float
    powers: list[float]
    largest: list[list[float]]


class CellFacts(BakeFacts):
    """A picture of cells; the values are options of `sssgen bake voronoi`."""

    feature: str
    cells: list[int]
    """Along x and y"""
    jitter: float
    seed: int
    tiles: bool
    bevel: float
    variation: float
    one_stands_for: float
    """The value of a texel of 1, in cells"""


class NormalFacts(BakeFacts):
    """A normal map."""

    strength: float
    green: str
    """opengl or directx"""
    tiles: bool


class PackedFacts(BakeFacts):
    """A texture of several sources."""

    channels: dict[str, str | None]
    """The source of each channel"""
