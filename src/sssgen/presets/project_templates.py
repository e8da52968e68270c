"""The templates of the projects that `sssgen use` writes: `templates/projects/`."""

from __future__ import annotations

import os
from functools import cache

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from sssgen.support.paths import place

Files = dict[str, str | bytes]
"""Name of a file → its content."""


def folder_names(folder: str) -> list[str]:
    """The files of a folder of templates, as they are called in a project."""
    return sorted(name.removesuffix(".j2") for name in os.listdir(os.path.join(_root(), folder)))


def render(file: str, /, **values: object) -> str:
    """The text of a file, such as `threejs/main.js`."""
    return _environment().get_template(f"{file}.j2").render(**values)


def _root() -> str:
    return os.path.join(place("templates"), "projects")


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(_root()), undefined=StrictUndefined, trim_blocks=True, keep_trailing_newline=True,
        autoescape=False,
    )  # fmt: skip
