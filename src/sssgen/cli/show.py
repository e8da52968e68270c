"""`sssgen show`: what a name stands for: a technique, a material, a target, a builtin, a scene and so on."""

from __future__ import annotations

import importlib
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Collection
from typing import Any

from sssgen.cli.layout import text_width
from sssgen.cli.output import OK, print_result
from sssgen.material import library
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets import registry

KINDS = {
    "material": "material",
    "technique": "technique",
    "target": "target",
    "builtin": "builtin function",
    "scene": "scene",
    "backend": "back end",
    "preset": "preset",
    "medium": "medium",
}
"""Kind, which is also the module of `cli/facts` → its title. A name of several kinds is shown as the first of them."""


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n"
        "  sssgen show beer_lambert\n"
        "  sssgen show mine.sss --json\n"
        "  sssgen show ice\n"
        "  sssgen show --kind scene ice\n"
        "  sssgen show unity-urp\n"
        "  sssgen show normalize\n"
        f"A name of several kinds is shown as the first of: {', '.join(KINDS)}."
    )
    parser.add_argument(
        "NAME", help="a name from `sssgen list`, a technique's .sss file, or the .toml file of a material or scene"
    )
    help = f"what the name stands for, if several have it: {', '.join(KINDS)}"
    parser.add_argument("--kind", metavar="KIND", choices=tuple(KINDS), help=help)


def run(arguments: Namespace) -> int:
    """Prints the facts, and the other kinds that have the name."""
    name = arguments.NAME
    kinds = [arguments.kind] if arguments.kind else _kinds_of(name)
    module = facts_module(kinds[0])
    facts = module.describe(name)
    text = module.lines(facts, text_width())
    if len(kinds) > 1:
        text += ["", *(f"also a {KINDS[kind]}: sssgen show --kind {kind} {name}" for kind in kinds[1:])]
    print_result(arguments.json, {"kind": kinds[0], "other_kinds": kinds[1:], **facts}, "\n".join(text))
    return OK


def facts_module(kind: str) -> Any:
    """The module of `cli/facts` that describes a kind."""
    return importlib.import_module(f"sssgen.cli.facts.{kind}")


def names_of(kind: str) -> Collection[str]:
    """The names of one kind."""
    names: Collection[str] = facts_module(kind).names()
    return names


def _kinds_of(name: str) -> list[str]:
    """The kinds that have the name, in the order of KINDS. Raises SssgenError for an unknown name."""
    if name.endswith((".sss", ".glsl")):
        return ["technique"]
    if name.endswith(".toml"):
        return ["material" if _is_material(name) else "scene"]
    names = {kind: names_of(kind) for kind in KINDS}
    kinds = [kind for kind, listed in names.items() if name in listed]
    if not kinds:
        from sssgen.support.text_files import refuse_folder

        refuse_folder(name)
        file = f"did you mean the file '{name}.toml'?" if os.path.isfile(f"{name}.toml") else library.file_meant(name)
        every = dict.fromkeys(one for listed in names.values() for one in listed)
        hint = file or registry.found_under(name) or did_you_mean(name, every)
        raise failure(f"nothing is called '{name}'", hint or "see: sssgen list materials, or sssgen help list")
    return kinds


def _is_material(path: str) -> bool:
    """Whether a file describes a material, in a table; a scene names one, in a text, or bodies."""
    from sssgen.support.paths import posix
    from sssgen.support.text_files import read_text
    from sssgen.support.toml_source import parse

    data = parse(read_text(path, posix(path)), posix(path)).data
    return "bodies" not in data and not isinstance(data.get("material", {}), str)
