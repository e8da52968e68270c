"""`sssgen bake`: textures that techniques sample, from meshes and from nothing."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from typing import Any

from ..cli import OK, print_json
from ..harness.extras import need


def run(arguments: Namespace) -> int:
    """Bakes one texture, writes it with its JSON, and says what it is."""
    need("numpy", extra="bake")
    kinds: dict[str, Callable[[Namespace], tuple[list[str], dict[str, Any], list[str]]]] = {"sdf": _sdf}
    paths, facts, told = kinds[arguments.WHAT](arguments)
    if arguments.json:
        print_json({"ok": True, "files": paths, **facts})
    else:
        print("\n".join([f"wrote {', '.join(paths)}", *(f"  {line}" for line in told)]))
    return OK


def _sdf(arguments: Namespace) -> tuple[list[str], dict[str, Any], list[str]]:
    from ..bake import output
    from ..bake.sdf import sdf
    from ..lab.progress import Bar

    format = output.volume_format(arguments.output, arguments.format)
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
        f"a distance is right to {error['at_texels']:.2g} at texels, and to {error['between_texels']:.2g} between them",
        f"the mesh is {'closed' if mesh['closed'] else 'open'}"
        + (", and inside out: taken the other way round" if mesh["inside_out"] else ""),
    ]
    return paths, made.facts, told


def _wholes(text: str, name: str, separators: str = ",x×") -> list[int]:
    """Whole numbers with commas or crosses between them. Raises SssgenError."""
    from ..diagnostics import failure

    for separator in separators[1:]:
        text = text.replace(separator, separators[0])
    parts = text.split(separators[0])
    if not all(part.isdecimal() and len(part) < 6 for part in parts):
        raise failure(f"'{text}' is no {name}", "whole numbers, with a comma between them where there are several")
    return [int(part) for part in parts]
