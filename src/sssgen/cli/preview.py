"""`sssgen preview`: a page that shows a material while its files change."""

from __future__ import annotations

import asyncio
import contextlib
import json
from argparse import ArgumentParser, Namespace

from sssgen.cli.output import OK


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
    from sssgen.preview.bodies import checked_mesh
    from sssgen.preview.pane import Pane
    from sssgen.preview.preview_server import PreviewServer
    from sssgen.scene.geometry import Mesh

    mesh = checked_mesh(Mesh(path=arguments.mesh)) if arguments.mesh else None

    def announce(line: str) -> None:
        if not arguments.json:
            print(line, flush=True)
        elif line.startswith("http"):
            print(json.dumps({"ok": True, "address": line}), flush=True)

    async def serve() -> None:
        other = Pane(arguments.OTHER, mesh) if arguments.OTHER else None
        server = PreviewServer(Pane(arguments.NAME, mesh), other)
        await server.run(arguments.port, not arguments.no_browser, announce)

    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(serve())
    return OK
