"""Compares the speed and accuracy of baked distance textures with other tools: `make bench`, or see --help.

All tools get the same triangles and the same voxel centres, and take turns. The time is from triangles to signed
float32 distances; it includes building trees. Tools that are not installed are reported and skipped: `pip install
open3d mesh-to-sdf` installs them. The errors are relative to brute force, at a sample of the voxels. --growth runs the
command in separate processes and prints how its time and memory grow.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeAlias

import igl
import numpy as np
import numpy.typing as npt

from sssgen.bake.voxel_distance import distances, inside
from sssgen.bake.voxel_grid import Grid, around
from sssgen.scene.mesh import Mesh
from sssgen.scene.mesh_distance import MeshDistance

Array: TypeAlias = npt.NDArray[np.float64]
Indices: TypeAlias = npt.NDArray[np.int64]
Bake: TypeAlias = Callable[[Array, Indices, Grid, Array], npt.NDArray[np.float32]]
"""From places (v, 3), corners (f, 3), the grid and its voxels' centres (n, 3) to signed distances (n,)"""

SPOT = Path(__file__).resolve().parent.parent.parent / "shared/data/meshes/spot.obj"
SAMPLE = 2000
"""The number of voxels that are compared with brute force; it is smaller for many triangles."""
PAIRS = 2**25
"""The largest number of distances between a point and a triangle that brute force computes."""
GROWTH = (64, 128, 256)


def sssgen_distances(places: Array, corners: Indices, grid: Grid, _: Array) -> npt.NDArray[np.float32]:
    solid = MeshDistance(places, corners)
    unsigned = distances(solid, grid)
    return np.where(inside(solid, grid, unsigned), -unsigned, unsigned).ravel()


def by_libigl(sign: igl.SignedDistanceType) -> Bake:
    def bake(places: Array, corners: Indices, _: Grid, points: Array) -> npt.NDArray[np.float32]:
        return igl.signed_distance(points, places, corners, sign_type=sign)[0].astype(np.float32)

    return bake


def by_open3d() -> Bake:
    import open3d

    tensor = open3d.core.Tensor

    def bake(places: Array, corners: Indices, _: Grid, points: Array) -> npt.NDArray[np.float32]:
        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(tensor(places.astype(np.float32)), tensor(corners.astype(np.uint32)))
        result: npt.NDArray[np.float32] = scene.compute_signed_distance(tensor(points.astype(np.float32))).numpy()
        return result

    return bake


def by_mesh_to_sdf(surface: str, sign: str) -> Bake:
    if sys.platform == "linux" and "DISPLAY" not in os.environ:
        os.environ.setdefault("PYOPENGL_PLATFORM", "egl")  # mesh_to_sdf renders its scans
    import mesh_to_sdf
    import trimesh

    def bake(places: Array, corners: Indices, _: Grid, points: Array) -> npt.NDArray[np.float32]:
        mesh = trimesh.Trimesh(places, corners, process=False)
        result = mesh_to_sdf.mesh_to_sdf(mesh, points, surface_point_method=surface, sign_method=sign)
        return np.asarray(result, np.float32)

    return bake


OURS = "sssgen bake sdf"
TOOLS: dict[str, Callable[[], Bake]] = {
    OURS: lambda: sssgen_distances,
    "libigl signed_distance": lambda: by_libigl(igl.SIGNED_DISTANCE_TYPE_DEFAULT),
    "  fast winding number": lambda: by_libigl(igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER),
    "Open3D RaycastingScene": by_open3d,
    "mesh-to-sdf, scan, normal": lambda: by_mesh_to_sdf("scan", "normal"),
    "  scan, depth": lambda: by_mesh_to_sdf("scan", "depth"),
    "  sample, normal": lambda: by_mesh_to_sdf("sample", "normal"),
}


def installed() -> Iterator[tuple[str, Bake]]:
    """The available tools; the others are reported."""
    for name, tool in TOOLS.items():
        try:
            yield name, tool()
        except ImportError as error:
            print(f"not installed: {name.strip()} ({error})")


def true_distances(points: Array, triangles: Array) -> Array:
    """The distance from points (n, 3) to the nearest of all triangles (f, 3, 3), in float64 without a tree: (n,)."""
    edges = np.roll(triangles, -1, axis=1) - triangles
    normals = np.cross(edges[:, 0], edges[:, 1])
    tiny = np.finfo(np.float64).tiny
    result = np.empty(len(points))
    for index, point in enumerate(points):
        ways = point - triangles
        along = np.einsum("fkc,fkc->fk", ways, edges) / np.maximum(np.einsum("fkc,fkc->fk", edges, edges), tiny)
        to_edges = ways - np.clip(along, 0.0, 1.0)[..., None] * edges
        squares = np.einsum("fkc,fkc->fk", to_edges, to_edges).min(axis=1)
        over = (np.einsum("fkc,fkc->fk", np.cross(normals[:, None], edges), ways) >= 0.0).all(axis=1)
        heights = np.einsum("fc,fc->f", ways[:, 0], normals) ** 2
        planes = heights / np.maximum(np.einsum("fc,fc->f", normals, normals), tiny)
        result[index] = np.sqrt(np.where(over, planes, squares).min())
    return result


def rounds(first: float) -> int:
    """The number of rounds for a tool whose first round took `first` seconds."""
    return 5 if first < 3.0 else 3 if first < 60.0 else 1


def measure(tools: dict[str, Bake], name: str, places: Array, corners: Indices, resolution: int) -> None:
    """Prints the table of one mesh and resolution."""
    grid = around(places.min(axis=0), places.max(axis=0), (resolution,), 0.05)
    points = grid.slab(0, grid.counts[2])
    sample = min(SAMPLE, max(50, PAIRS // len(corners)))
    chosen = np.random.default_rng(0).choice(len(points), min(sample, len(points)), replace=False)
    lengths = true_distances(points[chosen], places[corners])
    within = igl.winding_number(places, corners, points[chosen]) > 0.5

    print(f"\n{name}, {len(corners)} triangles, {' x '.join(map(str, grid.counts))} voxels; errors in parts of a voxel")
    times: dict[str, list[float]] = {}
    errors: dict[str, tuple[float, float, float]] = {}
    tools = dict(tools)
    for turn in range(rounds(0.0)):
        for tool, bake in list(tools.items()):
            if turn and turn >= rounds(times[tool][0]):
                continue
            start = time.perf_counter()
            try:
                result = bake(places, corners, grid, points)
            except Exception as error:  # any failure of another tool
                print(f"fails: {tool.strip()} ({type(error).__name__}: {error})")
                del tools[tool]
                continue
            times.setdefault(tool, []).append(time.perf_counter() - start)
            off = np.abs(np.abs(result[chosen].astype(np.float64)) - lengths) / grid.voxel.max()
            wrong = float(((result[chosen] < 0.0) != within).mean())
            errors[tool] = float(off.max()), float(off.mean()), wrong

    unit = statistics.median(times[OURS])
    print(f"| {'':26} |  ratio | seconds |  least to most | largest error | mean error | wrong signs |")
    print(f"|{'-' * 28}|-------:|--------:|---------------:|--------------:|-----------:|------------:|")
    for tool in tools:
        middle, (largest, mean, wrong) = statistics.median(times[tool]), errors[tool]
        spread = f"{min(times[tool]):.2f} to {max(times[tool]):.2f}"
        print(f"| {tool:26} | {middle / unit:6.2f} | {middle:7.2f} | {spread:>14} ", end="")
        print(f"| {largest:13.1e} | {mean:10.1e} | {wrong:11.2%} |")
    print(f"medians of up to {rounds(0.0)} rounds in turns; errors and signs at {len(chosen)} voxels")


def with_a_hole(places: Array, corners: Indices) -> Indices:
    """The triangles without those in the top fifth of the mesh."""
    height = places[corners].mean(axis=1)[:, 1]
    return corners[height < height.min() + 0.8 * np.ptp(height)]


def subdivided(places: Array, corners: Indices) -> tuple[Array, Indices]:
    """The same surface with 90 times as many triangles: each in 64, and every fifth of these in three."""
    import trimesh

    for _ in range(3):
        places, corners = trimesh.remesh.subdivide(places, corners)
    split, stored = corners[::5], np.delete(corners, np.s_[::5], axis=0)
    middle = len(places) + np.arange(len(split))
    fans = [np.stack([split[:, k], split[:, (k + 1) % 3], middle], axis=1) for k in range(3)]
    return np.concatenate([places, places[split].mean(axis=1)]), np.concatenate([stored, *fans])


PEAK = (
    "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL); "
    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
)
"""Runs a command and prints its peak memory. It is a separate process because a child's peak includes the size of its
parent."""


def command(mesh: Path, resolution: int, output: Path) -> tuple[float, float]:
    """Seconds and MiB of one `sssgen bake sdf`."""
    baking = [sys.executable, "-m", "sssgen", "bake", "sdf", str(mesh), "--resolution", str(resolution)]
    start = time.perf_counter()
    message = subprocess.run([sys.executable, "-c", PEAK, *baking, "-o", str(output)], capture_output=True, check=True)
    seconds = time.perf_counter() - start
    return seconds, int(message.stdout) / (2**20 if sys.platform == "darwin" else 2**10)


def measure_growth(name: str, places: Array, corners: Indices) -> None:
    """Prints how the command's time and memory grow with the resolution and with the triangles."""
    import trimesh

    print(f"\n| {name:>20}, triangles | voxels a side | seconds | ratio |  MiB | ratio |")
    print(f"|{'-' * 33}|--------------:|--------:|------:|-----:|------:|")
    with tempfile.TemporaryDirectory() as folder:
        for shape in ((places, corners), subdivided(places, corners)):
            mesh = Path(folder) / "mesh.ply"
            trimesh.Trimesh(*shape, process=False).export(mesh)
            before: tuple[float, float] | None = None
            for resolution in GROWTH:
                seconds, memory = command(mesh, resolution, Path(folder) / "sdf.npy")
                before = before or (seconds, memory)
                print(f"| {len(shape[1]):31} | {resolution:13} | {seconds:7.2f} | {seconds / before[0]:5.2f} ", end="")
                print(f"| {memory:4.0f} | {memory / before[1]:5.2f} |", flush=True)
                before = seconds, memory
    print("each line is a separate process, imports included; ratios to the line above")


def main() -> None:
    parser = argparse.ArgumentParser(description="Compares the speed of `sssgen bake sdf` with other tools.")
    parser.add_argument("--mesh", type=Path, default=SPOT, help="default: Spot, in shared/ next to the repository")
    parser.add_argument("--resolutions", default="64,128", help="voxels along the longest side (64,128)")
    parser.add_argument("--hole", action="store_true", help="also measure the mesh with a hole")
    parser.add_argument(
        "--growth", action="store_true", help="measure only the time and memory of the command, up to 256 voxels"
    )
    chosen = parser.parse_args()
    if not chosen.mesh.is_file():
        print(f"bench_bake: no mesh at {chosen.mesh}: nothing was measured; set --mesh")
        return
    print(f"{platform.machine()}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}")
    solid = Mesh(path=str(chosen.mesh)).solid
    places, corners, name = solid.places, solid.corners, chosen.mesh.stem
    if chosen.growth:
        measure_growth(name, places, corners)
        return
    tools = dict(installed())
    for resolution in map(int, chosen.resolutions.split(",")):
        measure(tools, name, places, corners, resolution)
        if chosen.hole:
            measure(tools, f"{name} with a hole", places, with_a_hole(places, corners), resolution)


if __name__ == "__main__":
    main()
