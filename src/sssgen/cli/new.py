"""`sssgen new`: writes a commented material to start from."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from sssgen.cli.output import OK, print_json
from sssgen.material.model import wrong_name
from sssgen.support.diagnostics import failure

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

# The thickness that the light has to pass: from a map, from a distance function, or a constant.
[[thickness]]
technique = "thickness_map"
thickness_factor = 0.3  # a parameter: a uniform of the shader, and this is its default
# thickness_texture = "thickness.png"  # the picture for previews

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


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = "examples:\n  sssgen new wood\n  sssgen new materials/soap.toml"
    parser.add_argument("MATERIAL", help="the material's name, or a .toml file; no file is overwritten")


def run(arguments: Namespace) -> int:
    """Writes the starter; refuses to overwrite a file."""
    path = Path(arguments.MATERIAL)
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
    if arguments.json:
        print_json({"ok": True, "file": shown})
    else:
        print(f"wrote {shown}")
    return OK
