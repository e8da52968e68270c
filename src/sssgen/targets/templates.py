"""Renders templates: the user's folder stands before a plug-in's, and that before ours.

What Jinja compiles from them is kept in the cache folder.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from .. import cache
from ..data import place
from ..diagnostics import failure

if TYPE_CHECKING:
    from jinja2 import Environment

_environments: dict[tuple[str | None, str], Environment] = {}


def render(template: str, context: dict[str, Any], templates: str | None, beside: str) -> str:
    """A template's text. Raises SssgenError for a faulty template.

    `templates` is the user's folder, whose templates are rendered in Jinja's sandbox; `beside` that of the descriptor.
    """
    from jinja2 import TemplateError, TemplateNotFound, TemplateSyntaxError

    try:
        return _environment(templates, beside).get_template(template).render(context)
    except TemplateNotFound as error:
        raise failure(f"there is no template '{error.name}'", file=template) from None
    except TemplateSyntaxError as error:
        raise failure(f"line {error.lineno}: {error.message}", file=error.name or template) from None
    except TemplateError as error:
        raise failure(
            f"the template cannot be rendered: {error.message}",
            "docs/templates.md lists what a template may use",
            file=template,
        ) from None
    except (TypeError, ValueError, KeyError, ArithmeticError, RecursionError) as error:
        raise failure(f"the template cannot be rendered: {error}", file=template) from None


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
