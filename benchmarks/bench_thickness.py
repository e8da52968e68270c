"""Compares the speed of `sssgen bake thickness` with rays whose intervals are merged: `make bench`, or see --help.

All compute the mean length below the same texels, in this process with one thread. The reference casts 256 rays per
texel and merges the intervals inside along each. The figures are ratios of processor time, for the integral of a closed
mesh and for the rays of open and overlapping ones, and the differences relative to the mean length.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as in the processes of a bake

import numpy as np
import numpy.typing as npt

from sssgen.bake.atlas import atlas
from sssgen.bake.chord_lengths import inward, mean
from sssgen.bake.mean_length import in_halves
from sssgen.bake.thickness_map import GROUP
from sssgen.lab.reference import inside_lengths
from sssgen.scene.geometry import Geometry
from sssgen.scene.inside_intervals import intervals
from sssgen.scene.mesh import Mesh

Array = npt.NDArray[np.float64]

SPOT = Path(__file__).resolve().parent.parent.parent / "shared/data/meshes/spot.obj"
RAYS = 256
ROUNDS = 3


def merged_lengths(geometry: Geometry, origins: Array, directions: Array) -> Array:
    """The lengths inside, in object space, by merged intervals: the reference."""
    parts = np.maximum(intervals(geometry, origins, directions), 0.0)
    lengths: Array = (parts[..., 1] - parts[..., 0]).sum(axis=1)
    return lengths


def timed(work: Callable[[], Array]) -> tuple[float, Array]:
    """The least processor time of some rounds, in seconds, and the result of the last."""
    times = []
    for _ in range(ROUNDS):
        start = time.process_time()
        result = work()
        times.append(time.process_time() - start)
    return min(times), result


def main() -> None:
    parser = argparse.ArgumentParser(description="Compares the speed of `sssgen bake thickness` with merged rays.")
    parser.add_argument("--mesh", type=Path, default=SPOT, help="with texture coordinates; default: Spot, in shared/")
    parser.add_argument("--size", type=int, default=512, help="texels along a side of the map (512)")
    parser.add_argument("--groups", type=int, default=4, help="groups of texels that are measured (4)")
    chosen = parser.parse_args()
    if not chosen.mesh.is_file():
        print(f"bench_thickness: no mesh at {chosen.mesh}: nothing was measured; set --mesh")
        return
    path = str(chosen.mesh)
    mesh = Mesh(path=path)
    if mesh.triangles.uv is None or not mesh.closed:
        print("bench_thickness: the mesh is open, or has no texture coordinates; set --mesh")
        return
    surface = atlas(mesh.triangles, mesh.triangles.uv, (chosen.size, chosen.size), path)
    groups = np.minimum(in_halves(surface.places, GROUP), len(surface.texels) - 1)
    groups = groups[:: max(1, len(groups) // chosen.groups)][: chosen.groups]
    places, flat = surface.places[groups], surface.flat[groups]
    points, normals = places.reshape(-1, 3), flat.reshape(-1, 3)
    inward(path, path, points[:8], normals[:8], RAYS, 0.0, (0, 0))  # reads the mesh
    mean(path, path, places[:1], flat[:1], RAYS, (0, 0))  # builds the tree

    of_integral, integral = timed(lambda: mean(path, path, places, flat, RAYS, (0, 0)).value)
    of_rays, rays = timed(lambda: inward(path, path, points, normals, RAYS, 0.0, (0, 0)).value)
    own, inside_lengths.lengths_ahead = inside_lengths.lengths_ahead, merged_lengths
    try:
        of_reference, reference = timed(lambda: inward(path, path, points, normals, RAYS, 0.0, (0, 0)).value)
    finally:
        inside_lengths.lengths_ahead = own
    error = inward(path, path, points, normals, RAYS, 0.0, (0, 0)).error

    print(f"{chosen.mesh.stem}, {len(mesh.triangles.corners)} triangles, {groups.size} of {len(surface.texels)} texels")
    print(f"| {'':24} | times faster | largest difference |     RMS |")
    print(f"|{'-' * 26}|-------------:|-------------------:|--------:|")
    for name, seconds, value in (
        ("merged rays (reference)", of_reference, reference),
        ("summed rays", of_rays, rays),
        ("integral", of_integral, integral),
    ):
        off = (value - reference) / reference.mean()
        root = np.sqrt((off**2).mean())
        print(f"| {name:24} | {of_reference / seconds:12.1f} | {np.abs(off).max():18.1e} | {root:7.1e} |")
    print(f"standard error of the reference: {error.mean() / reference.mean():.1e} on average, relative to the mean")


if __name__ == "__main__":
    main()
