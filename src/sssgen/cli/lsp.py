"""`sssgen lsp`: the language server, which an editor starts and talks to over standard input and output."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace

from sssgen.cli.output import OK


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen lsp\n"
        "Editors start it themselves: docs/editors.md has the settings of VS Code, Neovim and Helix. It ends when the "
        "editor closes its input."
    )
    parser.add_argument("--stdio", action="store_true", help="talk over standard input and output, as it always does")


def run(arguments: Namespace) -> int:
    """Answers an editor until it ends the session."""
    from sssgen.editor.server import make_server

    with os.fdopen(os.dup(0), "rb") as requests, os.fdopen(os.dup(1), "wb") as answers:
        os.dup2(2, 1)  # whatever else is printed must not be read as an answer
        make_server().start_io(requests, answers)
    return OK
