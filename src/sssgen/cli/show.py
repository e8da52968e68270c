"""`sssgen show`: what a name stands for: a technique, a material, a target, a builtin, a scene and so on."""

from __future__ import annotations

import importlib
import os
from argparse import ArgumentParser, Namespace
from collections.abc import Collection
from typing import Any, NamedTuple

from sssgen.cli.layout import text_width
from sssgen.cli.output import OK, print_json
from sssgen.material import library
from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets import registry


class Kind(NamedTuple):
    """A kind of thing with a name."""

    title: str
    module: str
    """Of `sssgen.cli.shown`"""

    def about(self) -> Any:
        """The module that describes it."""
        return importlib.import_module(f"sssgen.cli.shown.{self.module}")


KINDS = {
    "material": Kind("material", "shown_material"),
    "technique": Kind("technique", "shown_technique"),
    "target": Kind("target", "shown_target"),
    "builtin": Kind("builtin function", "shown_builtin"),
    "scene": Kind("scene", "shown_scene"),
    "backend": Kind("back end", "shown_backend"),
    "medium": Kind("medium", "shown_medium"),
}
"""The kinds: a name of several is shown as the first of them."""


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
    about = KINDS[kinds[0]].about()
    facts = about.describe(name)
    if arguments.json:
        print_json({"ok": True, "kind": kinds[0], "other_kinds": kinds[1:], **facts})
        return OK
    text = about.lines(facts, text_width())
    if len(kinds) > 1:
        text += ["", *(f"also a {KINDS[kind].title}: sssgen show --kind {kind} {name}" for kind in kinds[1:])]
    print("\n".join(text))
    return OK


def names_of(kind: str) -> Collection[str]:
    """The names of one kind."""
    names: Collection[str] = KINDS[kind].about().names()
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
    """Whether a file describes a material, in a table; a scene names one, in a text."""
    from sssgen.support.paths import posix
    from sssgen.support.text_files import read_text
    from sssgen.support.toml_source import parse

    return not isinstance(parse(read_text(path, posix(path)), posix(path)).data.get("material", {}), str)
