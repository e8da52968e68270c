"""`sssgen new`: writes a commented material to start from, or copies an example."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from pathlib import Path

from sssgen.cli.options import unknown_name
from sssgen.cli.output import OK, print_result
from sssgen.material.material_loading import examples
from sssgen.material.model import wrong_name
from sssgen.support.diagnostics import failure
from sssgen.support.file_writer import write_files

STARTER = """\
# A material for sssgen. Write its shaders with:
#     sssgen emit {file} --target all -o out
# All techniques: sssgen list techniques
# What a technique does, and its parameters: sssgen show beer_lambert

[material]
name = "{name}"
title = "{title}"
doc = "What it is, in one or two sentences."
shading = "lit"  # lit: the engine lights it; unlit: a [lighting] stage gives the color

# The position of the textures: here below a refracting surface, as if embedded.
# [coordinates]
# technique = "parallax_refracted"
# depth = 0.02
# ior = 1.5

# The thickness that the light has to pass: a constant here; thickness_map reads it from a map that is baked from the
# body (sssgen bake thickness), and march_light measures it in a distance function.
[[thickness]]
technique = "constant_thickness"
thickness_factor = 0.3  # a parameter: a uniform of the shader, and this is its default

# The share of the light that is transmitted. The translucency stage needs it, so the thickness is converted.
[[thickness]]
technique = "beer_lambert"
attenuation_distance = 0.2

# The appearance of the surface. A section with several stages has double brackets; they run in order.
[[surface]]
technique = "base_color"

[[surface]]
technique = "pbr_constants"
surface_roughness = 0.4
metalness = {{ value = 0.0, fixed = true }}  # folded into the text: no uniform

# The transmitted light, for each light.
[translucency]
technique = "lobe_normalized"
distortion = 0.2
power = 6.0
subsurface_color = "#ffb36b"  # sRGB, as color pickers show it; a list [1.0, 0.45, 0.15] is linear RGB
"""


_ELSEWHERE = re.compile(r'"(\.\./\w+/)([\w./]+)"')
"""The name of a file in the folder of another example, in two parts: a copy has the file at the second part."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen new wood\n  sssgen new materials/soap.toml\n  sssgen new my_ring --copy jade_ring\n"
        "The copy of an example is a folder with its material, scene, techniques and textures."
    )
    parser.add_argument("MATERIAL", help="the material's name, or a .toml file; no file is overwritten")
    parser.add_argument("--copy", metavar="EXAMPLE", help="copy this example into the new folder MATERIAL")


def run(arguments: Namespace) -> int:
    """Writes the starter, or copies an example; refuses to overwrite a file."""
    to, example = arguments.MATERIAL, arguments.copy
    written = _write_starter(to) if example is None else _copy(example, to)
    text = "\n".join(f"wrote {file}" for file in written)
    print_result(arguments.json, {"file": written[0], "files": written}, text)
    return OK


def _copy(name: str, to: str) -> list[str]:
    """Copies the files of an example into a new folder; the first one is the material."""
    if name not in examples():
        raise unknown_name("example", name, examples())
    folder, source = Path(to), Path(examples()[name]).parent
    if folder.exists():
        raise failure("the folder already exists", "choose another name, or remove it first", folder.as_posix())
    paths = [path for path in source.rglob("*") if path.is_file()]
    files: dict[str, str | bytes] = {path.relative_to(source).as_posix(): path.read_bytes() for path in paths}
    for path in source.glob("*.toml"):
        text = path.read_text(encoding="utf-8")
        files |= {inside: (source / outside / inside).read_bytes() for outside, inside in _ELSEWHERE.findall(text)}
        files[path.name] = _ELSEWHERE.sub(r'"\2"', text)
    write_files(folder, files)
    names = sorted(files, key=lambda file: (file != f"{name}.toml", file))
    return [(folder / file).as_posix() for file in names]


def _write_starter(argument: str) -> list[str]:
    path = Path(argument)
    if path.suffix != ".toml":
        path = path.with_name(f"{path.name}.toml") if path.name else path / "material.toml"
    name, shown = path.stem, path.as_posix()
    if problem := wrong_name(name):
        raise failure(*problem)
    text = STARTER.format(file=shown, name=name, title=name.replace("_", " ").capitalize())
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise failure("the file already exists", "choose another name, or remove it first", shown) from None
    except OSError as error:
        hint = "make the folder first" if isinstance(error, FileNotFoundError) else "choose another folder"
        raise failure(f"cannot write: {error.strerror or error}", hint, shown) from None
    return [shown]
