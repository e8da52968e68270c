"""What the JSON of a bake says of its mesh, and the warnings about it."""

from __future__ import annotations

from sssgen.bake.bake_facts import MeshFacts, SolidFacts, SurfaceFacts
from sssgen.scene.body_identity import measures
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import MIXED, mixed_sides, turned_text


def _mesh_facts(mesh: Mesh) -> MeshFacts:
    triangles = mesh.triangles
    return {
        "triangles": len(triangles.corners), **measures(triangles.places, triangles.corners),
        "inside_out": triangles.reversed or mesh.inside_out, "turned": triangles.turned,
        "mixed_sides": mixed_sides(triangles.corners),
    }  # fmt: skip


def solid_facts(mesh: Mesh) -> SolidFacts:
    """The facts for a distance texture."""
    low, high = mesh.bounds()
    return {**_mesh_facts(mesh), "closed": mesh.closed, "box_min": low.tolist(), "box_max": high.tolist()}


def surface_facts(mesh: Mesh, new_uv: bool, shared: float) -> SurfaceFacts:
    """The facts for a map on the surface."""
    return {**_mesh_facts(mesh), "new_uv": new_uv, "shared_texels": round(shared, 6)}


def side_warnings(facts: MeshFacts) -> list[str]:
    """Warnings for the user about the sides of the triangles."""
    messages = []
    if turned := facts["turned"]:
        messages.append(f"{turned_text(turned)}: turned for the bake; do so in the file for engines")
    if facts["inside_out"]:
        messages.append("the mesh is inside out: its normals are reversed for the bake")
    return messages + ([MIXED] if facts["mixed_sides"] else [])
