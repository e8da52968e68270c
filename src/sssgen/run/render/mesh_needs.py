"""What a material needs of the mesh of a scene, and the warnings where the mesh does not have it."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from sssgen.ir.spans import Span
from sssgen.ir.types import Sampler
from sssgen.material.model import Material
from sssgen.material.requirements import read_uniforms, requirements
from sssgen.scene.geometry import Mesh
from sssgen.scene.mesh_suitability import MeshNeeds, mesh_warnings
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic

_INSIDE = {"depth-map", "depth-layers", "back-faces", "eye-layers", "inner-light"}
"""The requirements of materials that follow light through the body."""


def mesh_needs(scene: Scene, material: Material) -> MeshNeeds:
    """What a material needs of the mesh of a scene, but for its size."""
    inside = bool(set(requirements(material.stages)) & _INSIDE)
    return MeshNeeds(inside, tuple(_readers(material, scene.textures)))


def mesh_diagnostics(scene: Scene, material: Material) -> list[Diagnostic]:
    """The warnings for the mesh of a scene; [] for other bodies, which are closed. Raises SssgenError."""
    mesh = scene.geometry
    if not isinstance(mesh, Mesh):
        return []
    place = Span(mesh.path, 0, 0, 0, 0)
    return [Diagnostic("warning", message, place) for message in mesh_warnings(mesh, mesh_needs(scene, material))]


def _readers(material: Material, textures: Collection[str]) -> Iterator[str]:
    """The techniques that read a texture by the mesh's coordinates, of those that a file names."""
    for use in material.stages:
        names = {uniform.name for uniform in read_uniforms(use) if isinstance(uniform.type, Sampler)}
        if names & {*use.textures, *textures} and any(param.name == "uv" for param in use.technique.function.params):
            yield use.technique.name
