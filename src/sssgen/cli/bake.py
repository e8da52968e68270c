"""`sssgen bake`: textures that techniques sample, from meshes and from nothing."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Callable
from typing import Any

from sssgen.cli.main import OK, print_json
from sssgen.support.diagnostics import failure
from sssgen.support.extras import need
from sssgen.support.paths import posix
from sssgen.targets.texture_import import import_settings

GREEN = {"opengl": "OpenGL (up)", "directx": "DirectX (down)"}

Done = tuple[list[str], dict[str, Any], list[str]]
"""The files that were written, what their JSON says, and what people are told."""


def run(arguments: Namespace) -> int:
    """Bakes one texture, writes it with its JSON, and says what it is."""
    need("numpy", extra="bake")
    kinds: dict[str, Callable[[Namespace], Done]] = {
        "sdf": _sdf, "thickness": _thickness, "depth": _depth, "voronoi": _voronoi, "normal": _normal, "pack": _pack,
    }  # fmt: skip
    paths, facts, told = kinds[arguments.TEXTURE](arguments)
    if arguments.json:
        print_json({"ok": True, "files": paths, **facts})
    else:
        print("\n".join([f"wrote {', '.join(map(posix, paths))}", *(f"  {line}" for line in told)]))
    return OK


def _sdf(arguments: Namespace) -> Done:
    from sssgen.bake import baked_files as output
    from sssgen.bake.distance_texture import sdf
    from sssgen.harness.scenes.mesh_distance import MIXED
    from sssgen.support.progress import Bar

    format = output.volume_format(arguments.output, arguments.format)
    output.check_apart(arguments.output, [arguments.MESH])
    with Bar() as bar:
        made = sdf(
            arguments.MESH,
            _wholes(arguments.resolution, "resolution"),
            arguments.padding,
            arguments.encode,
            arguments.range,
            arguments.thin,
            bar,
        )
    paths = output.write_volume(arguments.output, made.texels, format, made.facts)
    x, y, z = made.grid.counts
    error = made.facts["error"]
    mesh = made.facts["mesh"]
    told = [
        f"{x} × {y} × {z} texels of {made.grid.voxel.max():.4g} units; {made.facts['inside']:.1%} are inside",
        f"a distance is right to {error['at_texels']:.2g} at texels, and to {error['between_texels']:.2g} between them"
        + (f", but {error['but']}" if "but" in error else ""),
        f"the mesh is {'closed' if mesh['closed'] else 'open'}"
        + (", and inside out: taken the other way round" if mesh["inside_out"] else ""),
        *([f"warning: {MIXED}"] if mesh["mixed_sides"] else []),
    ]
    return paths, made.facts, told


def _thickness(arguments: Namespace) -> Done:
    from sssgen.bake import bake_light as light
    from sssgen.bake import baked_files as output
    from sssgen.bake.thickness_map import Request, thickness_map, warnings
    from sssgen.support.progress import Bar

    output.picture_suffix(arguments.output)
    output.check_apart(arguments.output, [arguments.MESH, arguments.direction or ""])
    wanted = Request(
        arguments.mode,
        light.read(arguments.direction) if arguments.direction else None,
        arguments.rays,
        arguments.attenuation or 0.0,
        arguments.seed,
    )
    size = _size(arguments.size)
    with Bar() as bar:
        made = thickness_map(
            arguments.MESH, size, wanted, arguments.unwrap, arguments.processes, arguments.scheduler, bar
        )
    mesh = output.mesh_beside(arguments.output)
    beside = {os.path.basename(mesh): made.mesh} if made.mesh else {}
    paths = output.write_picture(arguments.output, made.values, made.facts, beside=beside)
    errors, top = made.facts["error"], made.facts["range"][1]
    told = [
        f"{made.facts['holds']} from 0 to {top:.4g}, in the mean {made.facts['mean']:.4g}",
        f"standard error {errors['mean_standard_error']:.2g} in the mean, at most "
        f"{errors['largest_standard_error']:.2g}, of {made.facts['rays']} rays a texel",
        *([f"{posix(mesh)} is the mesh with its new texture coordinates: use that"] if made.mesh else []),
        *(f"warning: {one}" for one in warnings(made.facts)),
    ]
    return paths, made.facts, told


def _depth(arguments: Namespace) -> Done:
    from sssgen.bake import bake_light as light
    from sssgen.bake import baked_files as output
    from sssgen.bake.depth_map import depth_map
    from sssgen.support.progress import Bar

    output.picture_suffix(arguments.output, (".exr", ".npy"))
    output.check_apart(arguments.output, [arguments.MESH, arguments.direction])
    towards, size = light.read(arguments.direction), _size(arguments.size)
    with Bar() as bar:
        values, facts = depth_map(arguments.MESH, towards, size, bar)
    paths = output.write_picture(arguments.output, values, facts)
    low, high = facts["range"]
    told = [f"depths from {low:.4g} to {high:.4g}; the mesh is in {facts['covered']:.0%} of the texels"]
    return paths, facts, told if facts["covered"] else ["warning: the light meets nothing"]


def _voronoi(arguments: Namespace) -> Done:
    from sssgen.bake import baked_files as output
    from sssgen.bake import cells

    output.picture_suffix(arguments.output)
    size, count, tiles = _size(arguments.size), _pair(arguments.cells, "number of cells"), not arguments.no_tile
    made = cells.voronoi(
        size, count, arguments.jitter, arguments.seed, tiles, arguments.feature, arguments.bevel, arguments.variation
    )
    facts = {
        "kind": "cells", "holds": "thickness", "feature": arguments.feature,
        "cells": list(count), "jitter": arguments.jitter, "seed": arguments.seed, "tiles": tiles,
        "bevel": arguments.bevel, "variation": arguments.variation,
        "one_stands_for": cells.scale(arguments.feature, arguments.jitter), "parameters": {},
        "import": import_settings(wrap="repeat" if tiles else "clamp"),
    }  # fmt: skip
    paths = output.write_picture(arguments.output, made, facts)
    return paths, facts, [f"{count[0]} × {count[1]} cells, {arguments.feature}{', tileable' if tiles else ''}"]


def _normal(arguments: Namespace) -> Done:
    from sssgen.bake import baked_files as output
    from sssgen.bake import normal_map as normals
    from sssgen.harness.pictures import images

    output.picture_suffix(arguments.output)
    output.check_apart(arguments.output, [arguments.HEIGHT])
    height = images.upright(arguments.HEIGHT)
    tiles = not arguments.no_tile
    made = normals.from_height(height[..., 0], arguments.strength, tiles, arguments.green)
    facts = {
        "kind": "normal", "holds": None, "strength": arguments.strength,
        "green": arguments.green, "tiles": tiles, "parameters": {},
        "import": import_settings(wrap="repeat" if tiles else "clamp", normal_map=True),
    }  # fmt: skip
    paths = output.write_picture(arguments.output, made, facts, arguments.bits)
    return paths, facts, [f"tangent-space normals, green as in {GREEN[arguments.green]}"]


def _pack(arguments: Namespace) -> Done:
    from sssgen.bake import baked_files as output
    from sssgen.bake import channel_packing as packing

    output.picture_suffix(arguments.output)
    given = {name: getattr(arguments, name) for name in ("red", "green", "blue", "alpha")}
    if not any(given.values()):
        raise failure("there is nothing to pack", "--red a.png --green b.png --blue 1-c.png")
    sources = [packing.parse(text) if text else None for text in given.values()]
    output.check_apart(arguments.output, [source.file for source in sources if source and source.file])
    made = packing.pack(packing.load(sources))
    facts = {
        "kind": "packed", "holds": None, "channels": given, "parameters": {},
        "import": import_settings(),
    }  # fmt: skip
    paths = output.write_picture(arguments.output, made, facts, arguments.bits)
    return paths, facts, [f"{name}: {text}" for name, text in given.items() if text]


def _size(text: str) -> tuple[int, int]:
    """A picture's width and height. Raises SssgenError."""
    from sssgen.harness.pictures.images import LARGEST_SIDE

    found = _pair(text, "size")
    if not all(1 <= side <= LARGEST_SIDE for side in found):
        raise failure(f"'{text}' is no size", f"N or WIDTHxHEIGHT in texels, each from 1 to {LARGEST_SIDE}")
    return found


def _pair(text: str, name: str) -> tuple[int, int]:
    found = _wholes(text, name)
    if len(found) > 2:
        raise failure(f"'{text}' is no {name}", "one whole number, or two")
    return found[0], found[-1]


def _wholes(text: str, name: str) -> list[int]:
    """Whole numbers with commas or crosses between them. Raises SssgenError."""
    parts = text.replace("x", ",").replace("×", ",").split(",")
    if not all(part.isdecimal() and len(part) < 10 for part in parts):
        raise failure(f"'{text}' is no {name}", "whole numbers, with a comma or x between them where there are several")
    return [int(part) for part in parts]
