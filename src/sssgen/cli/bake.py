"""`sssgen bake`: textures for techniques, from meshes, from pictures or computed."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from sssgen.cli import bake_fluence
from sssgen.cli.options import add_json, add_output, add_seed, add_workers
from sssgen.cli.output import OK, print_result
from sssgen.cli.sizes import pair, picture_size, whole_numbers
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix
from sssgen.support.progress import ProgressBar
from sssgen.targets.texture_import import import_settings

if TYPE_CHECKING:
    from sssgen.bake.bake_facts import BakeFacts, CellFacts, NormalFacts, PackedFacts, ViewThicknessFacts

CHANNELS = ("red", "green", "blue", "alpha")
GREEN = {"opengl": "OpenGL (up)", "directx": "DirectX (down)"}

Result: TypeAlias = "tuple[list[str], BakeFacts, list[str]]"
"""The files that were written, the content of their JSON, and the lines to print."""


class Kind(NamedTuple):
    """A kind of texture: its help, an example and a note for it, its options, and the function that bakes it."""

    help: str
    example: str
    note: str
    add_options: Callable[[ArgumentParser], None]
    bake: Callable[[Namespace], Result]


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen bake sdf bunny.glb -o bunny.npy\n"
        "  sssgen bake thickness bunny.glb -o bunny_thickness.png\n"
        "A JSON file next to each texture states what it holds, its errors, and the parameters that belong to it."
    )
    kinds = parser.add_subparsers(metavar="TEXTURE", dest="TEXTURE", required=True)
    for name, kind in KINDS.items():
        epilog = f"example:\n  sssgen bake {name} {kind.example}\n{kind.note}"
        options = kinds.add_parser(name, help=kind.help, description=kind.help, epilog=epilog)
        add_json(options)
        kind.add_options(options)


def run(arguments: Namespace) -> int:
    """Bakes one texture, writes it with its JSON, and prints its properties."""
    paths, facts, lines = KINDS[arguments.TEXTURE].bake(arguments)
    text = "\n".join([f"wrote {', '.join(map(posix, paths))}", *(f"  {line}" for line in lines)])
    print_result(arguments.json, {"files": paths, **facts}, text)
    return OK


def _add_mesh(parser: ArgumentParser) -> None:
    parser.add_argument("MESH", help="a file that ends in .obj, .ply, .stl, .glb or .gltf")


def _add_size(parser: ArgumentParser) -> None:
    parser.add_argument("--size", default="512", metavar="N|WxH", help="the size of the map in texels (default: 512)")


def _add_bits(parser: ArgumentParser) -> None:
    parser.add_argument("--bits", type=int, choices=(8, 16), default=8, help="bits per channel of a .png (default: 8)")


def _sdf_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    _add_mesh(parser)
    add_output(parser, "FILE", "the texture's file", required=True)
    add("--resolution", default="64", metavar="N|X,Y,Z", help="texels along the longest side, or each (default: 64)")
    add(
        "--padding", type=float, default=0.05, metavar="P",
        help="the margin around the mesh, relative to its longest side (default: 0.05)",
    )  # fmt: skip
    add("--format", metavar="F", help="npy, dds, ktx2, exr-slices or raw+json (default: from FILE's suffix)")
    add("--encode", default="r16", metavar="E", help="r8, r16 (default), r16f or r32f")
    add("--range", type=float, metavar="R", help="distances are clamped to ±R (default: the largest that occurs)")
    add("--thin", type=float, metavar="T", help="treat the mesh as a sheet of thickness T, without an inside")


def _sdf(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake.distance_texture import sdf
    from sssgen.bake.mesh_facts import side_warnings

    format = output.volume_format(arguments.output, arguments.format)
    output.check_apart(arguments.output, [arguments.MESH])
    with ProgressBar(one_line=True) as bar:
        baked = sdf(
            arguments.MESH,
            whole_numbers(arguments.resolution, "resolution"),
            arguments.padding,
            arguments.encode,
            arguments.range,
            arguments.thin,
            bar,
        )
    paths = output.write_volume(arguments.output, baked.texels, format, baked.facts)
    x, y, z = baked.grid.counts
    error = baked.facts["error"]
    mesh = baked.facts["mesh"]
    lines = [
        f"{x} × {y} × {z} texels of {baked.grid.voxel.max():.4g} units; {baked.facts['inside']:.1%} are inside",
        f"the largest error is {error['at_texels']:.2g} at texels, and {error['between_texels']:.2g} between them"
        + (f", but {error['but']}" if "but" in error else ""),
        f"the mesh is {'closed' if mesh['closed'] else 'open'}",
        *(f"warning: {warning}" for warning in side_warnings(mesh)),
    ]
    return paths, baked.facts, lines


def _thickness_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    _add_mesh(parser)
    add_output(parser, "FILE", "a .png (16 bit), .exr or .npy", required=True)
    add(
        "--mode", choices=("mean", "chord", "transmittance"), default="mean",
        help="the mean length over inward directions, weighted by their cosine (default); the length along the "
        "inward normal; or the transmitted share of light, by Beer and Lambert's law",
    )  # fmt: skip
    add("--direction", metavar="LIGHT", help="the length towards a light: a .json with direction or position, or X,Y,Z")
    _add_size(parser)
    add(
        "--rays", type=int, default=256, metavar="N",
        help="rays per texel (default: 256); the mean length in a closed mesh without overlaps needs none",
    )  # fmt: skip
    add("--attenuation", type=float, metavar="D", help="for --mode transmittance: the length that transmits 1/e")
    add_seed(parser, "the seed of the rays")
    add("--unwrap", action="store_true", help="compute new texture coordinates; a mesh without any always gets them")
    add_workers(parser)


def _thickness(arguments: Namespace) -> Result:
    from sssgen.bake import bake_light, baked_files
    from sssgen.bake.thickness_map import Request, thickness_map, warnings

    baked_files.picture_suffix(arguments.output)
    baked_files.check_apart(arguments.output, [arguments.MESH, arguments.direction or ""])
    request = Request(
        arguments.mode,
        bake_light.read_light(arguments.direction) if arguments.direction else None,
        arguments.rays,
        arguments.attenuation or 0.0,
        arguments.seed,
    )
    size = picture_size(arguments.size)
    with ProgressBar(one_line=True) as bar:
        baked = thickness_map(
            arguments.MESH, size, request, arguments.unwrap, arguments.processes, arguments.scheduler, bar
        )
    mesh = baked_files.mesh_beside(arguments.output)
    mesh_file = {os.path.basename(mesh): baked.mesh} if baked.mesh else {}
    paths = baked_files.write_picture(arguments.output, baked.values, baked.facts, beside=mesh_file)
    errors, top = baked.facts["error"], baked.facts["range"][1]
    lines = [
        f"{baked.facts['holds']} from 0 to {top:.4g}, mean {baked.facts['mean']:.4g}",
        f"standard error {errors['mean_standard_error']:.2g} on average, at most "
        f"{errors['largest_standard_error']:.2g}, {_method(baked.facts['rays'], baked.facts['by_rays'])}",
        *([f"{posix(mesh)} is the mesh with its new texture coordinates: use it"] if baked.mesh else []),
        *(f"warning: {warning}" for warning in warnings(baked.facts)),
    ]
    return paths, baked.facts, lines


def _method(rays: int, by_rays: float) -> str:
    if by_rays == 0.0:
        return "of an integral over the triangles"
    part = "" if by_rays == 1.0 else f" in {by_rays:.1%} of the texels, where parts overlap, and of an integral"
    return f"of {rays} rays per texel{part}"


def _depth_options(parser: ArgumentParser) -> None:
    _add_mesh(parser)
    add_output(parser, "FILE", "an .exr or .npy", required=True)
    help = "the light: a .json with direction or position, or X,Y,Z"
    parser.add_argument("--direction", metavar="LIGHT", required=True, help=help)
    _add_size(parser)


def _depth(arguments: Namespace) -> Result:
    from sssgen.bake import bake_light
    from sssgen.bake import baked_files as output
    from sssgen.bake.depth_map import depth_map

    output.picture_suffix(arguments.output, (".exr", ".npy"))
    output.check_apart(arguments.output, [arguments.MESH, arguments.direction])
    light, size = bake_light.read_light(arguments.direction), picture_size(arguments.size)
    with ProgressBar(one_line=True) as bar:
        values, facts = depth_map(arguments.MESH, light, size, bar)
    paths = output.write_picture(arguments.output, values, facts)
    low, high = facts["range"]
    lines = [f"depths from {low:.4g} to {high:.4g}; the mesh is in {facts['covered']:.0%} of the texels"]
    return paths, facts, lines if facts["covered"] else ["warning: no ray of the light hits the mesh"]


def _view_thickness_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("BODY", metavar="MESH|SCENE", help="a mesh, or a scene with [medium] whose body is a mesh")
    add_output(
        parser, "FILE", "a .png (8 bit), .exr or .npy; the names of three pictures are made of it", required=True
    )
    add("--mean-free-path", type=float, metavar="M", help="of the medium, in units of the mesh; lengths fade over it")
    add("--medium", default="", metavar="NAME", help="instead: the medium of a mesh, a name of `sssgen list media`")
    add("--unit-mm", type=float, default=10.0, metavar="U", help="millimetres in a unit of the mesh (default: 10)")
    _add_size(parser)
    add("--rays", type=int, default=64, metavar="N", help="rays per texel, in fixed directions (default: 64)")
    add("--unwrap", action="store_true", help="compute new texture coordinates; a mesh without any always gets them")
    add_workers(parser)


def _view_thickness(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake import fluence, view_thickness
    from sssgen.bake.thickness_map import warnings

    output.picture_suffix(arguments.output)
    mesh, length = view_thickness.body(arguments.BODY, arguments.mean_free_path, arguments.medium, arguments.unit_mm)
    output.check_apart(arguments.output, [arguments.BODY, mesh.path])
    size = picture_size(arguments.size)
    with ProgressBar(one_line=True) as bar:
        baked = view_thickness.bake(
            mesh, size, length, arguments.rays, arguments.unwrap, arguments.processes, arguments.scheduler, bar
        )
    written = output.mesh_beside(arguments.output)
    beside = {os.path.basename(written): baked.mesh} if baked.mesh else {}
    paths = []
    for number, picture in enumerate(baked.pictures, 1):
        facts: ViewThicknessFacts = {**baked.facts, "texture": f"{view_thickness.TEXTURE}_{number}"}
        path = fluence.part_path(arguments.output, f"_{number}")
        paths += output.write_picture(path, picture, facts, view_thickness.BITS, beside if number == 1 else None)
    error = baked.facts["error"]
    lines = [
        f"the light along the eye's ray is off by {error['mean_of_fit']:.2g} of all on average, at most "
        f"{error['largest_of_fit']:.2g}, and by {error['rounding']:.2g} for the rounding",
        *([f"{posix(written)} is the mesh with its new texture coordinates: use it"] if baked.mesh else []),
        *(f"warning: {warning}" for warning in warnings(baked.facts)),
    ]
    return paths, baked.facts, lines


def _voronoi_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add_output(parser, "FILE", "a .png (16 bit), .exr or .npy", required=True)
    _add_size(parser)
    add("--cells", default="8", metavar="N|X,Y", help="the number of cells along each side (default: 8)")
    add("--jitter", type=float, default=1.0, metavar="J", help="from 0, a grid, to 1 (default), anywhere")
    add_seed(parser, "the seed of the cells")
    add(
        "--feature", choices=("faceted", "f1", "f2-f1"), default="faceted",
        help="levels with bevelled edges (default), the distance to the nearest site, or the distance to the edges",
    )  # fmt: skip
    add(
        "--bevel",
        type=float,
        default=0.35,
        metavar="B",
        help="of faceted: the width of slopes, in cells (default: 0.35)",
    )
    add("--variation", type=float, default=0.6, metavar="V", help="of faceted: how much levels differ (default: 0.6)")
    add("--no-tile", action="store_true", help="the map need not tile")


def _voronoi(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake import cells

    output.picture_suffix(arguments.output)
    size, count, tiles = picture_size(arguments.size), pair(arguments.cells, "number of cells"), not arguments.no_tile
    pattern = cells.Pattern(
        size, count, arguments.jitter, arguments.seed, tiles, arguments.feature, arguments.bevel, arguments.variation
    )
    with ProgressBar(one_line=True) as bar:
        texels = cells.voronoi(pattern, bar)
        facts: CellFacts = {
            "kind": "cells", "holds": "thickness", "feature": arguments.feature,
            "cells": list(count), "jitter": arguments.jitter, "seed": arguments.seed, "tiles": tiles,
            "bevel": arguments.bevel, "variation": arguments.variation,
            "one_stands_for": cells.scale(arguments.feature, arguments.jitter), "parameters": {},
            "import": import_settings(wrap="repeat" if tiles else "clamp"),
        }  # fmt: skip
        paths = output.write_picture(arguments.output, texels, facts)
    return paths, facts, [f"{count[0]} × {count[1]} cells, {arguments.feature}{', tileable' if tiles else ''}"]


def _normal_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("HEIGHT", help="a .png, .exr or .npy; bright is high")
    add_output(parser, "FILE", "a .png, .exr or .npy", required=True)
    add(
        "--strength", type=float, default=0.05, metavar="S",
        help="the height of white above black, relative to the picture's width (default: 0.05)",
    )  # fmt: skip
    add("--green", choices=("opengl", "directx"), default="opengl", help="green points up (default), or down")
    _add_bits(parser)
    add("--no-tile", action="store_true", help="the picture does not tile")


def _normal(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake import normal_map as normals
    from sssgen.scene.pictures import images

    output.picture_suffix(arguments.output)
    output.check_apart(arguments.output, [arguments.HEIGHT])
    tiles = not arguments.no_tile
    with ProgressBar(one_line=True) as bar:
        bar(0, 3, f"reading {arguments.HEIGHT}")
        height = images.upright(arguments.HEIGHT)
        bar(1, 3, "normals")
        texels = normals.from_height(height[..., 0], arguments.strength, tiles, arguments.green)
        bar(2, 3, f"writing {arguments.output}")
        facts: NormalFacts = {
            "kind": "normal", "holds": None, "strength": arguments.strength,
            "green": arguments.green, "tiles": tiles, "parameters": {},
            "import": import_settings(wrap="repeat" if tiles else "clamp", normal_map=True),
        }  # fmt: skip
        paths = output.write_picture(arguments.output, texels, facts, arguments.bits)
    return paths, facts, [f"tangent-space normals, green as in {GREEN[arguments.green]}"]


def _pack_options(parser: ArgumentParser) -> None:
    add_output(parser, "FILE", "a .png, .exr or .npy", required=True)
    for channel in CHANNELS:
        parser.add_argument(f"--{channel}", metavar="SOURCE", help=f"the source of the {channel} channel")
    _add_bits(parser)


def _pack(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake import channel_packing as packing

    output.picture_suffix(arguments.output)
    sources_by_channel = {name: getattr(arguments, name) for name in CHANNELS}
    if not any(sources_by_channel.values()):
        raise failure("there is nothing to pack", "--red a.png --green b.png --blue 1-c.png")
    sources = [packing.parse(text) if text else None for text in sources_by_channel.values()]
    output.check_apart(arguments.output, [source.file for source in sources if source and source.file])
    with ProgressBar(one_line=True) as bar:
        texels = packing.pack(packing.load(sources, bar))
        facts: PackedFacts = {
            "kind": "packed", "holds": None, "channels": sources_by_channel, "parameters": {},
            "import": import_settings(),
        }  # fmt: skip
        paths = output.write_picture(arguments.output, texels, facts, arguments.bits)
    return paths, facts, [f"{name}: {text}" for name, text in sources_by_channel.items() if text]


def _environment_options(parser: ArgumentParser) -> None:
    parser.add_argument("SKY", help="an equirectangular .png, .exr or .npy; its top row is up, +y")
    add_output(parser, "FILE", "a .dds: NAME.dds for reflection_map, and NAME_irradiance.dds", required=True)
    parser.add_argument("--intensity", type=float, default=1.0, metavar="F", help="a factor of the light (default: 1)")


def _environment(arguments: Namespace) -> Result:
    from sssgen.bake import baked_files as output
    from sssgen.bake.cube_dds import cube_bytes
    from sssgen.run.evaluate.evaluation import half
    from sssgen.run.render import environment_maps as maps
    from sssgen.scene.environment import Environment, digest

    output.check_cube_path(arguments.output)
    output.check_apart(arguments.output, [arguments.SKY])
    if not 0.0 < arguments.intensity < float("inf"):
        raise failure(f"the intensity {arguments.intensity:g} is not a factor of light", "give a number above 0")
    environment = Environment((arguments.intensity,) * 3, arguments.SKY, digest(arguments.SKY))
    with ProgressBar(one_line=True) as bar:
        bar(0, 2, "reflections")
        reflections = half(maps.reflection_map(environment))
        bar(1, 2, "irradiance")
        irradiance = half(maps.irradiance_map(environment))
    facts: BakeFacts = {
        "kind": "environment", "holds": None, "parameters": {"reflection_levels": len(reflections.levels) - 1.0},
        "import": import_settings("Cube", "clamp"),
    }  # fmt: skip
    cubes = {"": cube_bytes(reflections.levels), "_irradiance": cube_bytes(irradiance.levels)}
    paths = output.write_cubes(arguments.output, cubes, facts)
    sides = [f"{texture.size()[0]}² texels a face" for texture in (reflections, irradiance)]
    return paths, facts, [f"reflections: {sides[0]}, {len(reflections.levels)} levels", f"irradiance: {sides[1]}"]


KINDS = {
    "sdf": Kind(
        "the signed distance to a mesh, as a 3-D texture",
        "bunny.glb -o bunny.ktx2 --resolution 96",
        "Bind it to distance_map of the technique distance_texture.",
        _sdf_options,
        _sdf,
    ),
    "thickness": Kind(
        "the thickness of a body below each texel of its texture coordinates",
        "bunny.glb -o bunny_thickness.png --size 1024",
        "The map has the exact lengths inside the mesh along rays. Bind it to thickness_texture of thickness_map,\n"
        "or, for --mode transmittance, to transmittance_texture of transmittance_map.",
        _thickness_options,
        _thickness,
    ),
    "depth": Kind(
        "the distance to the first surface that a light hits, as a map from the light's view",
        "bunny.glb -o bunny_depth.exr --direction 0.3,0.8,0.5",
        "Bind it to light_depth_map of the technique depth_map_thickness.",
        _depth_options,
        _depth,
    ),
    "fluence": Kind(
        "the light inside a body, as volumes for any distant light, or for one",
        "bunny.glb --medium marble --unit-mm 4 -o bunny.dds",
        "Bind the files to the textures of the technique that their JSON names: fluence_factored_8,\n"
        "fluence_factored_4 or fluence_fixed, each with the ending _refracted for a medium with an index.",
        bake_fluence.add_options,
        bake_fluence.bake,
    ),
    "view_thickness": Kind(
        "the length inside a body along any view ray, below each texel of its texture coordinates",
        "bunny.glb --medium marble -o bunny_view.png",
        "Bind the pictures to view_harmonics_1, _2 and _3 of the technique view_thickness_map.",
        _view_thickness_options,
        _view_thickness,
    ),
    "environment": Kind(
        "the light of the surroundings, prefiltered into cube maps",
        "sky.exr -o sky.dds",
        "Bind them to reflection_map and irradiance_map of the technique prefiltered_environment, and set\n"
        "reflection_levels to the number in the JSON. sssgen render needs no files: it makes both maps itself.",
        _environment_options,
        _environment,
    ),
    "voronoi": Kind(
        "cells, as in cracked ice: a map of thickness or height",
        "-o cells.png --size 256 --cells 6",
        "",
        _voronoi_options,
        _voronoi,
    ),
    "normal": Kind(
        "the normal map of a height or thickness map",
        "cells.png -o cells_normal.png --strength 0.03",
        "",
        _normal_options,
        _normal,
    ),
    "pack": Kind(
        "channels of pictures in one texture",
        "-o packed.png --red metal.png --green rough.png:g --blue 1-gloss.png",
        "A source is FILE, FILE:CHANNEL, 1-FILE (inverted) or a number from 0 to 1.",
        _pack_options,
        _pack,
    ),
}
"""The kinds of textures, by the name of the subcommand."""
