"""Renders templates: the user's folder stands before a plug-in's, and that before ours.

Our own and plug-ins' templates are translated to Python once (`template_code.py`) and kept; Jinja renders a user's, in
its sandbox, and whatever the translation has not understood.
"""

from __future__ import annotations

import marshal
import os
import sys

from .. import cache
from ..data import place
from ..diagnostics import failure
from ..ir.typed import TYPE_CHECKING, Any
from .template_runtime import Template, namespace

if TYPE_CHECKING:
    from jinja2 import Environment

_environments: dict[tuple[str | None, str], Environment] = {}
_translated: dict[str, dict[str, Template]] = {}


def render(template: str, context: dict[str, Any], templates: str | None, beside: str) -> str:
    """A template's text. Raises SssgenError for a faulty template.

    `templates` is the user's folder, `beside` that of the target's descriptor.
    """
    if templates is None:
        function = translated(beside).get(template)
        if function is not None:
            try:
                return function({"range": range, **context})[0]
            except Exception:  # Jinja finds the same fault, or knows better
                pass
    return by_jinja(template, context, templates, beside)


def by_jinja(template: str, context: dict[str, Any], templates: str | None, beside: str) -> str:
    """The same by Jinja itself."""
    from jinja2 import TemplateError, TemplateNotFound, TemplateSyntaxError

    try:
        return _environment(templates, beside).get_template(template).render(context)
    except TemplateNotFound as error:
        raise failure(f"there is no template '{error.name}'", file=template) from None
    except TemplateSyntaxError as error:
        raise failure(f"line {error.lineno}: {error.message}", file=error.name or template) from None
    except TemplateError as error:
        raise failure(f"the template cannot be rendered: {error.message}", "docs/templates.md lists what a template may use", file=template) from None  # fmt: skip
    except (TypeError, ValueError, KeyError, ArithmeticError, RecursionError) as error:
        raise failure(f"the template cannot be rendered: {error}", file=template) from None


def translated(beside: str) -> dict[str, Template]:
    """The functions of the templates beside a descriptor and of ours."""
    found = _translated.get(beside)
    if found is None:
        places = [os.path.join(beside, "templates"), place("templates")]
        stamp = [sys.version, *map(cache.stamp, (*places, os.path.dirname(__file__)))]
        code = cache.kept(f"templates-{cache.digest(beside)}", stamp, lambda: _translate(places))
        found, space = namespace()
        exec(marshal.loads(code), space)
        _translated[beside] = found
    return found


def _translate(places: list[str]) -> bytes:
    """The code that defines the functions of all templates of these folders."""
    from pathlib import Path

    from .template_code import translate

    sources: dict[str, str] = {}
    for folder in map(Path, reversed(places)):
        for path in sorted(folder.glob("**/*.j2")):
            sources[path.relative_to(folder).as_posix()] = path.read_text("utf-8")
    text = translate(_environment(None, os.path.dirname(places[0])), sources)
    return marshal.dumps(compile(text, "<templates>", "exec"))


def _environment(templates: str | None, beside: str) -> Environment:
    """Jinja's environment; its compiled templates are kept on disk."""
    key = (templates, beside)
    if key not in _environments:
        from jinja2 import FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

        if templates is not None:
            from jinja2.sandbox import SandboxedEnvironment as Chosen
        else:
            from jinja2 import Environment as Chosen  # type: ignore[assignment]  # the same without the sandbox
        places = [templates] if templates is not None else []
        kept = cache.folder()
        _environments[key] = Chosen(
            loader=FileSystemLoader([*places, os.path.join(beside, "templates"), place("templates")]),
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
            bytecode_cache=FileSystemBytecodeCache(str(kept)) if kept else None,
            auto_reload=templates is not None,
        )
    return _environments[key]
