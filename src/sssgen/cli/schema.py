"""`sssgen schema`: the JSON schema of materials or scenes, for editors that check TOML by one."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace

from sssgen.cli.options import add_output
from sssgen.cli.output import OK, write_text
from sssgen.editor import schemas

KINDS = ("material", "scene")


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen schema material -o material.schema.json\n  sssgen schema scene -o scene.schema.json\n"
        "In a TOML file, `#:schema material.schema.json` on the first line names it (docs/editors.md). `sssgen lsp` "
        "checks more and needs no schema."
    )
    parser.add_argument("KIND", choices=KINDS, help="material or scene")
    add_output(parser, "FILE", "write it to a file, and print nothing")


def run(arguments: Namespace) -> int:
    """Prints or writes the schema."""
    schema = schemas.material_schema() if arguments.KIND == "material" else schemas.scene_schema()
    text = json.dumps(schema, ensure_ascii=False, indent=1) + "\n"
    if arguments.output:
        write_text(arguments.output, text)
    else:
        print(text, end="")
    return OK
