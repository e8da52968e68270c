"""What a shell offers for the word at the cursor: commands, options, and the names that an argument takes."""

from __future__ import annotations

import functools
import os
from argparse import Action, ArgumentParser
from collections.abc import Callable, Iterable
from typing import NamedTuple

import argcomplete

from sssgen.cli.commands import COMMANDS, command_module
from sssgen.cli.options import add_json
from sssgen.cli.parser import Parser
from sssgen.cli.show import KINDS, names_of
from sssgen.material import library
from sssgen.run.backend_registry import FUNCTIONS, SCENES
from sssgen.run.compiler_registry import COMPILERS
from sssgen.scene.example_scenes import drawn_scenes, measured_scenes


class Values(NamedTuple):
    """The values of an argument: names, and files with these endings."""

    names: Callable[[], Iterable[str]] = tuple
    suffixes: tuple[str, ...] = ()
    listed: bool = False
    """Whether it takes several, separated by commas."""


def _of(*kinds: str) -> Callable[[], Iterable[str]]:
    return lambda: [name for kind in kinds for name in names_of(kind)]


def _stages_of_shells() -> Iterable[str]:
    """`ROLE=TECHNIQUE` for the roles that add to a shell."""
    names = {role: ["none"] for role in library.OF_SHELLS}
    for name, path in library.index().items():
        if library.folder_of(path) in names:
            names[library.folder_of(path)].append(name)
    return [f"{role}={name}" for role, listed in names.items() for name in listed]


_TARGETS = Values(lambda: [*names_of("target"), "all"], listed=True)
_SCENE, _MATERIAL, _TECHNIQUE, _MESH = (".toml",), (".toml",), (".sss",), (".obj", ".ply", ".stl", ".glb", ".gltf")

VALUES = {
    "target": _TARGETS,
    "backend": Values(lambda: [*FUNCTIONS, "all"], listed=True),
    "render backend": Values(lambda: SCENES),
    "ci backend": Values(lambda: names_of("backend"), listed=True),
    "compiler": Values(lambda: COMPILERS, listed=True),
    "role": Values(lambda: library.ROLES, listed=True),
    "shell": Values(_stages_of_shells),
    "medium": Values(_of("medium")),
    "emit MATERIAL": Values(_of("material"), _MATERIAL),
    "watch MATERIAL": Values(_of("material"), _MATERIAL),
    "TECHNIQUE": Values(_of("technique"), _TECHNIQUE),
    "show NAME": Values(_of(*KINDS), (*_TECHNIQUE, *_MATERIAL)),
    "lint NAME": Values(_of("technique", "material"), (*_TECHNIQUE, *_MATERIAL, ".glsl", ".frag", ".vert")),
    "stress NAME": Values(_of("technique", "material"), (*_TECHNIQUE, *_MATERIAL)),
    "check FILE": Values(_of("material"), ("",)),
    "SCENE": Values(measured_scenes, _SCENE),
    "render SCENE": Values(drawn_scenes, _SCENE),
    "bake BODY": Values(suffixes=(*_SCENE, *_MESH)),
    "bake MESH": Values(suffixes=_MESH),
    "help COMMAND": Values(lambda: COMMANDS),
}
"""An argument, after its command where commands differ → its values. Others take a file, or what their help says."""


def complete() -> None:
    """Answers the shell, which has put its line into variables, and ends the process."""
    line = os.environ.get("COMP_LINE", "")
    argcomplete.autocomplete(completed_parser(line), always_complete_options=False)


def completed_parser(line: str) -> ArgumentParser:
    """The parser of a whole command line, with the options of the command that the line has."""
    words = line.split()
    parser = Parser("sssgen", "completes the line")
    commands = parser.add_subparsers(metavar="COMMAND", dest="COMMAND")
    for name, command in COMMANDS.items():
        options = commands.add_parser(name, prog=f"sssgen {name}", help=command.help, description=command.help)
        if len(words) > 1 and words[1] == name:
            add_json(options)
            command_module(command).add_options(options)
            _add_completers(options, name)
    return parser


def _add_completers(parser: ArgumentParser, command: str) -> None:
    for action in parser._actions:
        if isinstance(action.choices, dict):  # kinds of textures, each with its own options
            for inner in action.choices.values():
                _add_completers(inner, command)
        elif action.choices is None and action.nargs != 0:
            # argcomplete reads this attribute, which argparse's own type does not declare
            action.completer = functools.partial(_candidates, values_of(action, command))  # type: ignore[attr-defined]


def values_of(action: Action, command: str) -> Values:
    """The values of one argument of a command."""
    return VALUES.get(f"{command} {action.dest}") or VALUES.get(action.dest) or Values(suffixes=("",))


def _candidates(values: Values, prefix: str, **_: object) -> list[str]:
    """The names and files that begin with the prefix; after a comma, those of the list's last part."""
    before, comma, last = prefix.rpartition(",") if values.listed else ("", "", prefix)
    names = [f"{before}{comma}{name}" for name in values.names() if name.startswith(last)]
    return names + _files(prefix, values.suffixes)


def _files(prefix: str, suffixes: tuple[str, ...]) -> list[str]:
    """The folders and the files of these endings whose paths begin with the prefix."""
    folder, start = os.path.split(prefix)
    try:
        entries = sorted(os.scandir(folder or "."), key=lambda entry: entry.name)
    except OSError:
        return []
    paths = []
    for entry in entries if suffixes else ():
        if entry.name.startswith(start) and (start or not entry.name.startswith(".")):
            path = os.path.join(folder, entry.name)
            if entry.is_dir():
                paths.append(f"{path}/")
            elif entry.name.endswith(suffixes):
                paths.append(path)
    return paths
