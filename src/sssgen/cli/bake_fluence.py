"""`sssgen bake fluence`: the light inside a body, for any lights or for one."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, TypeAlias

from sssgen.cli.options import add_output, add_seed, add_workers
from sssgen.support.diagnostics import failure
from sssgen.support.progress import ProgressBar
from sssgen.targets.texture_import import import_settings

if TYPE_CHECKING:
    from sssgen.bake.bake_facts import FluenceFacts, MediumFacts
    from sssgen.lab.fluence.fluence_field import Settings
    from sssgen.scene.measured.measured_scene import MeasuredScene

Result: TypeAlias = "tuple[list[str], FluenceFacts, list[str]]"
"""The files that were written, the content of their JSON, and the lines to print."""
NOISY = 1.0
"""The standard error of a voxel, relative to the mean, from which the bake warns."""


def add_options(parser: ArgumentParser) -> None:
    add = parser.add_argument
    add("BODY", metavar="SCENE|MESH", help="a scene with [medium], or a mesh, for which --medium names the medium")
    output = "a .npy, .dds or .ktx2, with --relit a .bin; the names of several files are made of it"
    add_output(parser, "FILE", output, required=True)
    add("--medium", default="", metavar="NAME", help="the medium of a mesh: a name of `sssgen list media`")
    add("--unit-mm", type=float, default=10.0, metavar="U", help="millimetres in a unit of the mesh (default: 10)")
    add("--rank", type=int, metavar="K", help="numbers in a voxel, for any distant light: 4 or 8 (default)")
    add("--relit", type=int, metavar="K", help="K numbers in a voxel, for all lights and surroundings: a .bin; 8 to 32")
    add("--light", metavar="LIGHT", help="one light that is fixed to the body: a .json with direction, or X,Y,Z")
    add("--voxels", type=int, metavar="N", help="voxels along the longest side (default: about 4096 in the body)")
    add("--photons", type=int, default=24000, metavar="N", help="for each direction and channel (default: 24000)")
    add("--format", metavar="F", help="npy, dds, ktx2 or raw+json (default: from FILE's suffix)")
    add_seed(parser, "the seed of the photons")
    add_workers(parser)


def bake(arguments: Namespace) -> Result:
    """Bakes the light inside a body and writes its files. Raises SssgenError."""
    from sssgen.bake import bake_light, fluence
    from sssgen.bake import baked_files as output
    from sssgen.lab.fluence.fluence_field import Settings
    from sssgen.lab.fluence.traced_body import fitting_voxels
    from sssgen.scene.light_response import SUFFIX

    relit = arguments.relit is not None
    if relit:
        output.check_response_path(arguments.output)
    elif arguments.output.lower().endswith(SUFFIX):
        raise failure(f"a {SUFFIX} is for all lights and surroundings", "add --relit 16, or end FILE in .dds")
    format = "" if relit else output.volume_format(arguments.output, arguments.format)
    output.check_apart(arguments.output, [arguments.BODY, arguments.light or ""])
    scene = fluence.body(arguments.BODY, arguments.medium, arguments.unit_mm)
    voxels = fitting_voxels(scene) if arguments.voxels is None else arguments.voxels
    settings = Settings(voxels, photons=arguments.photons, seed=arguments.seed)
    if relit:
        others = {"--light": arguments.light, "--format": arguments.format, "--rank": arguments.rank}
        option = next((name for name, value in others.items() if value is not None), "")
        if option:
            raise failure(f"--relit and {option} exclude each other", f"leave {option} out: a .bin serves all lights")
        return _relit(arguments, scene, settings)
    light = bake_light.read_light(arguments.light) if arguments.light else None
    rank = 8 if arguments.rank is None else arguments.rank
    with ProgressBar(one_line=True) as bar:
        baked = fluence.bake(scene, rank, light, settings, arguments.scheduler, arguments.processes, bar)
    paths = []
    for part in baked.parts:
        facts: FluenceFacts = {**baked.facts, "texture": part.texture}
        if part.texels.ndim == 4:
            path = fluence.part_path(arguments.output, part.suffix)
            paths += output.write_volume(path, part.texels, format, facts)
        else:
            path = fluence.part_path(arguments.output, part.suffix, ".exr")
            facts["import"] = import_settings(wrap="clamp")
            paths += output.write_picture(path, part.texels[::-1], facts)
    return paths, baked.facts, _lines(scene, baked.facts)


def _relit(arguments: Namespace, scene: MeasuredScene, settings: Settings) -> Result:
    from sssgen.bake import baked_files, relit

    with ProgressBar(one_line=True) as bar:
        data, facts = relit.bake(scene, arguments.relit, settings, arguments.scheduler, arguments.processes, bar)
    paths = baked_files.write_response(arguments.output, data, facts)
    return paths, facts, [*_lines(scene, facts), f"{len(data) / 1024:.0f} KiB"]


def boundary(medium: MediumFacts) -> str:
    """What the surface of a baked body does, and how a scene states the other boundary of a measured medium."""
    from sssgen.scene.measured import media

    name, index, presets = medium["name"], medium["ior"], media.media()
    measured = presets[name].ior if name in presets else index
    if index != 1.0:
        return f"the surface refracts, which a scene states by ior = {index:g} in [medium]"
    other = "" if measured == 1.0 else f"; for that of {name} write ior = {measured:g} in [medium]"
    return f"the surface does not refract{other}"


def _lines(scene: MeasuredScene, facts: FluenceFacts) -> list[str]:
    from sssgen.scene.mesh import Mesh

    x, y, z = facts["texels"]
    lines = [
        f"{x} × {y} × {z} voxels; {facts['photons']} photons for each of {facts['directions']} "
        f"direction{'s' if facts['directions'] > 1 else ''}",
        f"for the technique {facts['technique']}: {boundary(facts['medium'])}",
        f"standard error of a voxel {facts['error']['standard_error']:.2g} of the mean, before it is averaged",
    ]
    if isinstance(body := scene.geometry, Mesh) and (body.triangles.reversed or body.inside_out):
        lines.append("the mesh is inside out: it was reversed")
    if facts["error"]["standard_error"] > NOISY:
        lines.append("warning: the noise is as large as the light: use more --photons, or a medium that scatters more")
    if facts["opaque_voxels"]:
        lines.append("warning: a voxel is opaque in one channel: use more voxels, or a smaller --unit-mm")
    return lines
