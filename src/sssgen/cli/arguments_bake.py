"""The grammar of `sssgen bake` and what it bakes."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from typing import Any

MESHES = ".obj, .ply, .stl, .glb or .gltf"


def add_baking(command: Callable[..., ArgumentParser], add_where: Callable[[ArgumentParser], None]) -> None:
    """Adds the command and its own ones."""
    bake = command(
        "bake",
        "bake",
        "bake what techniques sample: distance textures, thickness and depth maps, cells, normals",
        "examples:\n"
        "  sssgen bake sdf bunny.glb -o bunny.npy\n"
        "  sssgen bake thickness bunny.glb -o bunny_thickness.png\n"
        "Beside each texture lies a JSON: what it holds, its errors, and the parameters that it goes with.",
    )
    kinds = bake.add_subparsers(metavar="TEXTURE", dest="TEXTURE", required=True)

    def kind(name: str, text: str, epilog: str = "") -> Any:
        made = kinds.add_parser(
            name, help=text, description=text[0].upper() + text[1:] + ".", epilog=epilog, allow_abbrev=False,
            formatter_class=bake.formatter_class,
        )  # fmt: skip
        made.add_argument("--json", action="store_true", help="print the result, or the errors, as JSON")
        return made

    def of_mesh(name: str, text: str, epilog: str, files: str) -> Any:
        made = kind(name, text, epilog)
        made.add_argument("MESH", help=f"a file that ends in {MESHES}")
        made.add_argument("-o", "--output", metavar="FILE", required=True, help=files)
        return made

    sdf = of_mesh(
        "sdf",
        "the signed distance to a mesh, as a 3-D texture",
        "Bind it to distance_map of the technique distance_texture.",
        "the texture's file",
    )
    sdf.add_argument(
        "--resolution", default="64", metavar="N|X,Y,Z", help="texels along the longest side, or each (default: 64)"
    )
    sdf.add_argument(
        "--padding", type=float, default=0.05, metavar="P", help="around the mesh, in parts of its longest side (0.05)"
    )
    sdf.add_argument("--format", metavar="F", help="npy, dds, ktx2, exr-slices or raw+json (default: by FILE's ending)")
    sdf.add_argument("--encode", default="r16", metavar="E", help="r8, r16 (default), r16f or r32f")
    sdf.add_argument(
        "--range", type=float, metavar="R", help="the distance at which the numbers end (default: the largest there is)"
    )
    sdf.add_argument("--thin", type=float, metavar="T", help="take the mesh as a sheet so thick, without an inside")

    thickness = of_mesh(
        "thickness",
        "how thick a body is below each texel of its texture coordinates",
        "The exact lengths inside the mesh along rays. Bind it to thickness_texture of thickness_map, or, for\n"
        "--mode transmittance, to transmittance_texture of transmittance_map.",
        "a .png (16 bit), .exr or .npy",
    )
    thickness.add_argument(
        "--mode", choices=("mean", "chord", "transmittance"), default="mean",
        help="the mean over inward directions, weighted by their cosine (default); the length straight in; "
        "or the share of light that passes, by Beer and Lambert's law",
    )  # fmt: skip
    thickness.add_argument(
        "--direction",
        metavar="LIGHT",
        help="towards a light instead: a .json with direction or position, or X,Y,Z",
    )
    thickness.add_argument("--size", default="512", metavar="N|WxH", help="of the map, in texels (default: 512)")
    thickness.add_argument("--rays", type=int, default=256, metavar="N", help="of each texel (default: 256)")
    thickness.add_argument(
        "--attenuation", type=float, metavar="D", help="of --mode transmittance: the length after which 1/e is left"
    )
    thickness.add_argument("--seed", type=int, default=0, metavar="N", help="of the rays' chance (default: 0)")
    thickness.add_argument(
        "--unwrap", action="store_true", help="make new texture coordinates; a mesh that has none gets them anyway"
    )
    add_where(thickness)

    depth = of_mesh(
        "depth",
        "how far the first surface is that a light meets, as a map from the light's view",
        "Bind it to light_depth_map of the technique depth_map_thickness.",
        "an .exr or .npy",
    )
    depth.add_argument(
        "--direction", metavar="LIGHT", required=True, help="the light: a .json with direction or position, or X,Y,Z"
    )
    depth.add_argument("--size", default="512", metavar="N|WxH", help="of the map, in texels (default: 512)")

    voronoi = kind("voronoi", "cells, as in cracked ice: a map of thickness or height")
    voronoi.add_argument("-o", "--output", metavar="FILE", required=True, help="a .png (16 bit), .exr or .npy")
    voronoi.add_argument("--size", default="512", metavar="N|WxH", help="in texels (default: 512)")
    voronoi.add_argument("--cells", default="8", metavar="N|X,Y", help="along each side (default: 8)")
    voronoi.add_argument("--jitter", type=float, default=1.0, metavar="J", help="0: a grid; 1 (default): anywhere")
    voronoi.add_argument("--seed", type=int, default=0, metavar="N", help="which cells (default: 0)")
    voronoi.add_argument(
        "--feature", choices=("faceted", "f1", "f2-f1"), default="faceted",
        help="levels with bevelled edges (default), the distance to the nearest site, or that to the edges",
    )  # fmt: skip
    voronoi.add_argument(
        "--bevel", type=float, default=0.35, metavar="B", help="of faceted: the slopes' width in cells"
    )
    voronoi.add_argument(
        "--variation", type=float, default=0.6, metavar="V", help="of faceted: how much the levels differ (0.6)"
    )
    voronoi.add_argument("--no-tile", action="store_true", help="need not repeat")

    normal = kind("normal", "the normal map of a height or thickness map")
    normal.add_argument("HEIGHT", help="a .png, .exr or .npy, bright = high")
    normal.add_argument("-o", "--output", metavar="FILE", required=True, help="a .png, .exr or .npy")
    normal.add_argument(
        "--strength", type=float, default=0.05, metavar="S",
        help="how far white rises above black, in parts of the picture's width (default: 0.05)",
    )  # fmt: skip
    normal.add_argument(
        "--green", choices=("opengl", "directx"), default="opengl", help="green is up (default), or down"
    )
    normal.add_argument("--bits", type=int, choices=(8, 16), default=8, help="a channel of a .png (default: 8)")
    normal.add_argument("--no-tile", action="store_true", help="the picture does not repeat")

    pack = kind(
        "pack",
        "channels of pictures into one texture",
        "A source is FILE, FILE:CHANNEL, 1-FILE (inverted) or a number from 0 to 1.",
    )
    pack.add_argument("-o", "--output", metavar="FILE", required=True, help="a .png, .exr or .npy")
    for channel in ("red", "green", "blue", "alpha"):
        pack.add_argument(f"--{channel}", metavar="SOURCE", help=f"what is in {channel}")
    pack.add_argument("--bits", type=int, choices=(8, 16), default=8, help="a channel of a .png (default: 8)")
