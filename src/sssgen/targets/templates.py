"""Renders templates: a file in the user's folder comes before that of a plug-in, and this before the project's own.

A user's templates are rendered in Jinja's sandbox: they reach neither Python's internals nor other files. Nothing
bounds their time and memory. What Jinja compiles is kept in the cache folder.
"""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any

from sssgen.ir.spans import Span
from sssgen.support import cache
from sssgen.support.diagnostics import MAX_MESSAGE, Diagnostic, SssgenError
from sssgen.support.file_memo import FileState, note, noted_files
from sssgen.support.paths import place, posix

if TYPE_CHECKING:
    from jinja2 import Environment

_REMOVED = (
    "common/needs.j2", "common/unit_vector.j2", "godot/functions.j2", "unreal/interface.j2", "unreal/sources.j2",
)  # fmt: skip
"""Templates of earlier versions, which a user's own template may import."""

NO_LINES = "\x04"
"""The mark of a line that is removed from the finished file."""

_environments: dict[tuple[str | None, str], Environment] = {}

_user_files: dict[str, dict[str, FileState]] = {}
"""The user's folder → its templates, as they were when Jinja read them."""


def render(template: str, context: dict[str, Any], templates: str | None, folder: str) -> str:
    """A template's text. Raises SssgenError for a faulty template.

    `templates` is the user's folder, `folder` that of the descriptor.
    """
    from jinja2 import TemplateNotFound, TemplateSyntaxError

    environment = _environment(templates, folder)
    if templates is not None:
        _drop_changed(templates)
    if templates is not None:
        from copy import deepcopy

        context = deepcopy(context)  # the template may change it, the target must stay the same
    try:
        return environment.get_template(template).render(context)
    except TemplateNotFound as error:
        hint = "the target's frame replaces it: see docs/templates.md" if error.name in _REMOVED else ""
        raise _failure(f"there is no template '{error.name}'", hint, _place(error) or (template, 0)) from None
    except TemplateSyntaxError as error:
        raise _failure(str(error.message), "", (error.filename or template, error.lineno)) from None
    except Exception as error:  # a template's expressions may fail in any way
        message = f"the template cannot be rendered: {str(error) or type(error).__name__}"
        hint = "docs/templates.md lists what a template may use"
        raise _failure(message, hint, _place(error) or (template, 0)) from None


def words(template: str, folder: str) -> set[str]:
    """The words of a template and of all those that it includes or imports."""
    from jinja2.meta import find_referenced_templates

    environment = _environment(None, folder)
    pending, texts = [template], dict[str, str]()
    while pending:
        name = pending.pop()
        if name not in texts and environment.loader is not None:
            texts[name] = environment.loader.get_source(environment, name)[0]
            pending += filter(None, find_referenced_templates(environment.parse(texts[name])))
    return {word for text in texts.values() for word in re.findall(r"\w+", text)}


def _drop_changed(templates: str) -> None:
    """Empties Jinja's memory if one of the user's templates has changed, or one is new in place of another.

    The text depends on all of them, and on those that may yet be written in place of the project's.
    """
    with noted_files() as files:
        for top in (templates, place("templates")):
            for folder, _, names in os.walk(top):
                for name in names:
                    if name.endswith(".j2"):
                        note(os.path.join(templates, os.path.relpath(folder, top), name))
    if _user_files.get(templates) != files:
        for (folder_of_user, _), environment in _environments.items():
            if folder_of_user == templates and environment.cache is not None:
                environment.cache.clear()
    _user_files[templates] = files


def _failure(message: str, hint: str, place: tuple[str, int]) -> SssgenError:
    file, line = place
    return SssgenError([Diagnostic("error", message[:MAX_MESSAGE], Span(posix(file), line, 1, line, 2), hint)])


def _place(error: BaseException) -> tuple[str, int] | None:
    """The template and the line of an error: the innermost frame of a template in its traceback."""
    innermost, frames = None, error.__traceback__
    while frames is not None:
        name = frames.tb_frame.f_code.co_filename
        if name.endswith(".j2"):
            innermost = name, frames.tb_lineno
        frames = frames.tb_next
    return innermost


def _environment(templates: str | None, folder: str) -> Environment:
    """Jinja's environment; its compiled templates are kept on disk."""
    key = (templates, folder)
    if key not in _environments:
        from jinja2 import FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

        if templates is not None:
            from jinja2.sandbox import SandboxedEnvironment as Chosen
        else:
            from jinja2 import Environment as Chosen  # type: ignore[assignment]  # the base class
        users = [templates] if templates is not None else []
        cached = cache.folder()
        pattern = f"{Chosen.__name__.lower()}_%s.cache"
        environment = Chosen(
            loader=FileSystemLoader([*users, os.path.join(folder, "templates"), place("templates")]),
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
            bytecode_cache=FileSystemBytecodeCache(cached, pattern) if cached else None,
            auto_reload=False,
        )
        environment.filters["digest"] = digest
        environment.filters["lines"] = _lines
        _environments[key] = environment
    return _environments[key]


def _lines(text: str, width: int = 0) -> str:
    """The lines of a place, indented. Without any, the line of the template that asks for them is removed."""
    from textwrap import indent

    return indent(text.strip("\n"), " " * width) or NO_LINES


def digest(text: str) -> str:
    """32 hexadecimal digits that follow from a text: an identifier that is the same each time."""
    from hashlib import blake2b

    return blake2b(text.encode(), digest_size=16).hexdigest()
