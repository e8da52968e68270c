"""The commands, in the groups in which the help lists them, and the parser of each.

Only the module of the command that is called is imported.
"""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple

from sssgen.cli.layout import help_width, table_rows, wrap
from sssgen.cli.options import add_json
from sssgen.cli.parser import Parser
from sssgen.version import VERSION

GROUPS = {
    "make": "make shaders and textures",
    "see": "see what there is, and pictures of it",
    "check": "check shaders",
    "measure": "measure accuracy against cost",
    "import": "bring in materials and GLSL, take materials out",
    "tool": "sssgen itself",
}
"""The groups of commands, and their titles in the help."""


class Command(NamedTuple):
    """A command. Its module has `add_options(parser)`, and `run(arguments)` which returns the exit status."""

    module: str
    group: str
    help: str
    extra: str = "numpy"
    """The extra of the distribution that installs the packages that the command needs, or several as `a,b`."""


COMMANDS = {
    "use": Command("use", "make", "put a ready material on a mesh, as a project that an engine opens", "import"),
    "new": Command("new", "make", "write a commented material to start from, or copy an example"),
    "emit": Command("emit", "make", "write the shaders of materials"),
    "watch": Command("watch", "make", "write the shaders of materials after every change", "preview"),
    "bake": Command("bake", "make", "bake textures: distances, thickness, depth, light, cells, normals", "bake"),
    "list": Command("list_names", "see", "list techniques, targets, materials, scenes, builtins and so on"),
    "show": Command("show", "see", "explain what a name stands for: a technique, a material, a target"),
    "preview": Command("preview", "see", "show a material in a browser while its files change", "preview"),
    "render": Command("render", "see", "render a scene, or compare two pictures", "render"),
    "check": Command("check", "check", "compile shaders with the compilers of this machine"),
    "fmt": Command("fmt", "check", "lay out techniques and TOML files"),
    "lint": Command("lint", "check", "report operations that may divide by 0, overflow or give NaN"),
    "eval": Command("eval", "check", "evaluate a technique on arrays of inputs, on one or all back ends"),
    "stress": Command("stress", "check", "run techniques on dangerous, boundary and random inputs"),
    "ci": Command("ci", "check", "check all materials of a folder, and its scenes' golden pictures", "render"),
    "chart": Command("chart", "measure", "chart error against cost of every technique and baseline", "chart,reference"),
    "pick": Command(
        "pick", "measure", "pick the cheapest techniques that are good enough for a scene", "chart,reference"
    ),
    "fit": Command("fit", "measure", "fit the parameters of techniques to a scene's medium", "chart,reference"),
    "import": Command("import_materials", "import", "import materials of glTF, MaterialX and Unity files", "import"),
    "export-gltf": Command("export_gltf", "import", "write a material as glTF, with Khronos' extensions", "import"),
    "transpile": Command("transpile", "import", "translate functions or whole shaders to a target's language"),
    "lsp": Command("lsp", "tool", "run the language server that an editor starts", "lsp"),
    "schema": Command("schema", "tool", "print the JSON schema of materials or scenes, for editors"),
    "doctor": Command("doctor", "tool", "print versions, and the compilers and back ends found and missing"),
    "completion": Command("completion", "tool", "print the script that makes a shell complete commands and names"),
    "help": Command("help", "tool", "print the list of commands, or the help of one"),
}


def command_parser(name: str) -> Parser:
    """The parser of one command's arguments."""
    command = COMMANDS[name]
    parser = Parser(f"sssgen {name}", command.help)
    add_json(parser)
    command_module(command).add_options(parser)
    return parser


def command_module(command: Command) -> Any:
    """Imports the module of a command."""
    return importlib.import_module(f"{__package__}.{command.module}")


class Overview(Parser):
    """The parser of arguments that do not begin with a command. Its help lists the commands."""

    def __init__(self) -> None:
        super().__init__(
            "sssgen",
            "generates shaders for translucent and parallax materials from one description",
            "examples:\n  sssgen emit ice --target wgsl -o out\n  sssgen list materials\n  sssgen help emit\n"
            "Exit status: 0 done, 1 a check failed, 2 wrong input.",
            usage="sssgen COMMAND ...",
        )
        self.add_argument("--version", action="version", version=f"sssgen {VERSION}", help="show the version")
        commands = self.add_subparsers(metavar="COMMAND", dest="COMMAND", required=True, parser_class=Parser)
        for name in COMMANDS:
            commands.add_parser(name, prog=f"sssgen {name}", description=name, add_help=False)

    def format_help(self) -> str:
        longest, width = max(map(len, COMMANDS)), help_width()
        lines = [f"usage: {self.usage}", "", *wrap(self.description or "", width)]
        for group, title in GROUPS.items():
            rows = [(name, command.help) for name, command in COMMANDS.items() if command.group == group]
            lines += ["", f"{title}:", *table_rows(rows, longest, width)]
        options = [("--help", "print this help"), ("--version", "print the version")]
        lines += ["", "options:", *table_rows(options, longest, width)]
        formatter = self._get_formatter()
        formatter.add_text(self.epilog)
        return "\n".join([*lines, "", formatter.format_help()])
