"""`sssgen list`: the techniques, the targets, the example materials and scenes, and so on."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import Any

from sssgen.cli.layout import print_rows
from sssgen.cli.options import unknown_name
from sssgen.cli.output import OK, print_json
from sssgen.ir.intrinsics import BUILTINS
from sssgen.material import library
from sssgen.material.material_loading import examples, load_material
from sssgen.material.requirements import requirements
from sssgen.pipeline.compiler import all_targets
from sssgen.run.backend_registry import BACKENDS
from sssgen.scene.example_scenes import all_scenes, summary
from sssgen.support.diagnostics import failure
from sssgen.support.paths import display_name, posix, source_name
from sssgen.targets import registry

LISTS = ("techniques", "targets", "materials", "presets", "scenes", "media", "builtins", "backends")


def add_options(parser: ArgumentParser) -> None:
    parser.epilog = (
        "examples:\n  sssgen list techniques --role thickness\n  sssgen list materials\n  sssgen list targets"
    )
    parser.add_argument(
        "KIND", metavar="KIND", choices=LISTS, help=f"{', '.join(LISTS)}; `sssgen show NAME` explains one"
    )
    parser.add_argument("--role", metavar="R", help="list only the techniques of this role")


def run(arguments: Namespace) -> int:
    """Prints one list, as a table or as JSON."""
    kind = arguments.KIND
    if arguments.role is not None:
        if kind != "techniques":
            raise failure(f"{kind} have no role", "write: sssgen list techniques --role R")
        if arguments.role not in library.ROLES:
            raise unknown_name("role", arguments.role, library.ROLES)
    rows = {
        "techniques": _techniques, "targets": _targets, "materials": _materials, "presets": _presets,
        "scenes": _scenes, "media": _media, "builtins": _builtins, "backends": _backends,
    }[kind]()  # fmt: skip
    if arguments.role is not None:
        rows = [row for row in rows if row["role"] == arguments.role]
    if arguments.json:
        print_json({"ok": True, kind: rows})
        return OK
    longest = max((len(row["name"]) for row in rows), default=0)
    role = ""
    for row in rows:
        if row.get("role", "") != role:
            print(f"{chr(10) if role else ''}{row['role']}")
            role = row["role"]
        required = f" Requires: {', '.join(row['requires'])}." if row.get("requires") else ""
        print_rows([(row["name"], row["summary"] + required)], longest)
    return OK


def _techniques() -> list[dict[str, Any]]:
    techniques = sorted(
        library.load_all(),
        key=lambda technique: (library.ROLES.index(technique.role), technique.baseline, technique.name),
    )
    return [
        {
            "name": technique.name,
            "role": technique.role,
            "summary": technique.doc.get("summary", ""),
            "baseline": technique.baseline,
            "file": display_name(source_name(technique.path)),
        }
        for technique in techniques
    ]


def _targets() -> list[dict[str, Any]]:
    """All targets; a plug-in that cannot be read has the reason as its summary."""
    broken = {name: f"cannot be read: {error.diagnostics[0].message}" for name, error in registry.faults().items()}
    titles = {name: target.title for name, target in all_targets().items()}
    return [{"name": name, "summary": summary} for name, summary in {**titles, **broken}.items()]


def _materials() -> list[dict[str, Any]]:
    materials = [load_material(name) for name in examples()]
    return [
        {
            "name": material.name,
            "title": material.title,
            "summary": material.doc,
            "shading": material.shading,
            "requires": list(requirements(material.stages)),
            "file": posix(material.file),
        }
        for material in materials
    ]


def _media() -> list[dict[str, Any]]:
    from sssgen.scene.measured import media

    return [{"name": name, "summary": medium.source} for name, medium in media.media().items()]


def _presets() -> list[dict[str, Any]]:
    from sssgen.presets import preset

    return [{"name": name, "summary": row.doc, "size_mm": row.size_mm} for name, row in preset.presets().items()]


def _scenes() -> list[dict[str, Any]]:
    return [{"name": name, "summary": summary(path), "file": posix(path)} for name, path in all_scenes().items()]


def _builtins() -> list[dict[str, Any]]:
    return [{"name": name, "summary": row.doc} for name, row in BUILTINS.items()]


def _backends() -> list[dict[str, Any]]:
    return [{"name": name, "summary": record.description, "target": record.target} for name, record in BACKENDS.items()]
