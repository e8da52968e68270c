"""What the page warns of where the mesh does not suit the material."""

from __future__ import annotations

from sssgen.material.model import Material, TechniqueUse
from sssgen.material.requirements import read_uniforms, requirements
from sssgen.preview.bodies import body_key, body_size
from sssgen.run.render.mesh_needs import mesh_needs
from sssgen.scene.geometry import Mesh
from sssgen.scene.mesh_suitability import mesh_warnings, size_warnings
from sssgen.scene.scene import Scene
from sssgen.support.file_memo import CachedResult, remember

_PATH = "mean_free_path"
_warnings: dict[str, CachedResult] = {}
_MOST = 6


def mesh_notes(scene: Scene, material: Material) -> list[str]:
    """The warnings for the mesh of a scene; [] for other bodies, which are closed. Raises SssgenError."""
    mesh = scene.geometry
    if not isinstance(mesh, Mesh):
        return []
    needs = mesh_needs(scene, material)
    own = remember(_warnings, f"{body_key(mesh)} {needs}", lambda: mesh_warnings(mesh, needs), _MOST)
    path = _mean_free_path(scene, material)
    if path is None or not needs.inside or "inner-light" in requirements(material.stages):
        return own
    return [*own, *size_warnings(body_size(mesh, 1.0).mean_chord / path)]


def _mean_free_path(scene: Scene, material: Material) -> float | None:
    """The mean free path of the medium that a stage computes light inside of; None where there is none."""
    for use in material.stages:
        if any(uniform.name == _PATH for uniform in read_uniforms(use)):
            given = scene.parameters.get(_PATH)
            return float(given) if isinstance(given, int | float) else _value(use)
    return None


def _value(use: TechniqueUse) -> float:
    """The mean free path that a stage sets, or else the technique's default."""
    defaults = {uniform.name: uniform.default for uniform in read_uniforms(use)}
    return {**defaults, **use.values}[_PATH][0]
