"""`sssgen new`: writes a commented material to start from, or copies an example."""

from __future__ import annotations

import re
from argparse import ArgumentParser, Namespace
from pathlib import Path
from string import Template

from sssgen.cli.options import unknown_name
from sssgen.cli.output import OK, print_result
from sssgen.material.material_loading import examples, preset_hint
from sssgen.material.model import wrong_name
from sssgen.support.diagnostics import failure
from sssgen.support.file_writer import write_files

STARTER = Path(__file__).with_name("starter.toml")
"""The material to start from, with `$file`, `$name` and `$title`."""

_ELSEWHERE = re.compile(r'"(\.\./\w+/)([\w./]+)"')
"""The name of a file in the folder of another example, in two parts: a copy has the file at the second part."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen new wood\n  sssgen new materials/soap.toml\n  sssgen new my_ring --copy jade_ring\n"
        "  sssgen new my_wax --from wax\n"
        "The copy of an example is a folder with its material, scene, techniques and textures."
    )
    parser.add_argument("MATERIAL", help="the material's name, or a .toml file; no file is overwritten")
    parser.add_argument("--copy", metavar="EXAMPLE", help="copy this example into the new folder MATERIAL")
    parser.add_argument(
        "--from", dest="preset", metavar="PRESET",
        help="begin with a ready material of `sssgen list presets`, for a body that is two units large",
    )  # fmt: skip


def run(arguments: Namespace) -> int:
    """Writes the starter, or copies an example; refuses to overwrite a file."""
    to, example = arguments.MATERIAL, arguments.copy
    if example is not None and arguments.preset is not None:
        raise failure("--copy and --from exclude each other", "an example is a folder, a preset is one file")
    written = [_write_material(to, arguments.preset)] if example is None else _copy(example, to)
    text = "\n".join(f"wrote {file}" for file in written)
    print_result(arguments.json, {"file": written[0], "files": written}, text)
    return OK


def _copy(name: str, to: str) -> list[str]:
    """Copies the files of an example into a new folder; the first one is the material."""
    if name not in examples():
        if hint := preset_hint(name):
            raise failure(f"unknown example '{name}'", hint)
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


def _write_material(argument: str, preset: str | None) -> str:
    """Writes the file of a preset, or the starter without one; returns its path."""
    path = Path(argument)
    if path.suffix != ".toml":
        path = path.with_name(f"{path.name}.toml") if path.name else path / "material.toml"
    name, shown = path.stem, path.as_posix()
    if problem := wrong_name(name):
        raise failure(*problem)
    text = _preset(preset, name) if preset is not None else _starter(shown, name)
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise failure("the file already exists", "choose another name, or remove it first", shown) from None
    except OSError as error:
        hint = "make the folder first" if isinstance(error, FileNotFoundError) else "choose another folder"
        raise failure(f"cannot write: {error.strerror or error}", hint, shown) from None
    return shown


def _starter(file: str, name: str) -> str:
    starter = Template(STARTER.read_text(encoding="utf-8"))
    return starter.substitute(file=file, name=name, title=name.replace("_", " ").capitalize())


def _preset(preset: str, name: str) -> str:
    """The material of a preset, with the quality that needs no bake."""
    from sssgen.presets.preset import preset as named
    from sssgen.presets.preset_stages import two_units_text

    return two_units_text(named(preset), name)
