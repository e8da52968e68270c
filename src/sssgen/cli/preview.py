"""`sssgen preview`: a page that shows a material while its files change."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import json
import os
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING

from sssgen.cli.output import OK
from sssgen.support.paths import folder
from sssgen.support.text_files import refuse_other_kinds

if TYPE_CHECKING:
    from sssgen.preview.page_messages import PageMessages


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen preview ice\n  sssgen preview mine.toml --mesh bust.glb\n"
        "  sssgen preview ice ice_body\n"
        "  sssgen preview clouds.glsl"
    )
    parser.add_argument("NAME", help="a material's or scene's .toml, a technique, plain GLSL, or an example")
    parser.add_argument("OTHER", nargs="?", help="another one, which is shown beside it")
    parser.add_argument("--mesh", metavar="FILE", help="a mesh (.glb, .obj, …) to show the material on")
    parser.add_argument("--port", type=int, default=0, metavar="N", help="the port on 127.0.0.1 (default: a free one)")
    parser.add_argument("--no-browser", action="store_true", help="print the address, and open no browser")


def run(arguments: Namespace) -> int:
    """Serves the page until Ctrl-C."""
    from sssgen.preview.preview_server import PreviewServer

    for name in filter(None, (arguments.NAME, arguments.OTHER)):  # before the address is printed
        refuse_other_kinds(name)

    def announce(line: str) -> None:
        if not arguments.json:
            print(line, flush=True)
        elif line.startswith("http"):
            print(json.dumps({"ok": True, "address": line}), flush=True)

    async def serve() -> None:
        # a name that stands for no file may be a wrong one, as a mesh may be: no page is opened for it; a program
        # reads one answer
        named = os.path.isfile(arguments.NAME) or os.path.isdir(os.path.join(folder("examples"), arguments.NAME))
        early = named and not arguments.json and not arguments.mesh
        make = functools.partial(_pictures, arguments)
        server = PreviewServer() if early else PreviewServer(make())
        await server.run(arguments.port, not arguments.no_browser, announce, make if early else None)

    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(serve())
    return OK


def _pictures(arguments: Namespace) -> PageMessages:
    """The pictures of the command's names. Raises SssgenError."""
    from sssgen.preview.bodies import checked_mesh
    from sssgen.preview.page_messages import PageMessages
    from sssgen.preview.pane import Pane
    from sssgen.scene.geometry import Mesh

    mesh = checked_mesh(Mesh(path=arguments.mesh)) if arguments.mesh else None
    other = Pane(arguments.OTHER, mesh) if arguments.OTHER else None
    return PageMessages(Pane(arguments.NAME, mesh), other)
