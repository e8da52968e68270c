"""Renders templates: the user's folder stands before a plug-in's, and that before ours.

Our own and plug-ins' templates are translated to Python once (`template_code.py`) and kept; Jinja renders a user's, in
its sandbox, and whatever the translation has not understood.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from .. import cache
from ..data import folder
from ..diagnostics import failure
from ..ir.typed import TYPE_CHECKING, Any
from .template_runtime import Template, namespace

if TYPE_CHECKING:
    from jinja2 import Environment

_environments: dict[tuple[Path | None, Path], Environment] = {}
_translated: dict[Path, dict[str, Template]] = {}


def render(template: str, context: dict[str, Any], templates: Path | None, beside: Path) -> str:
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


def by_jinja(template: str, context: dict[str, Any], templates: Path | None, beside: Path) -> str:
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


def translated(beside: Path) -> dict[str, Template]:
    """The functions of the templates beside a descriptor and of ours."""
    found = _translated.get(beside)
    if found is None:
        places = [str(beside / "templates"), str(folder("templates"))]
        stamp = [sys.version, *(cache.stamp(place) for place in (*places, str(Path(__file__).parent)))]
        code = cache.kept(f"templates-{cache.digest(str(beside))}", stamp, lambda: _translate(places))
        found, space = namespace()
        exec(code, space)
        _translated[beside] = found
    return found


def _translate(places: list[str]) -> Any:
    """The code that defines the functions of all templates of these folders."""
    from .template_code import translate

    sources: dict[str, str] = {}
    for place in reversed(places):
        for root, _, names in os.walk(place):
            for name in sorted(names):
                if name.endswith(".j2"):
                    path = Path(root, name)
                    sources[path.relative_to(place).as_posix()] = path.read_text("utf-8")
    return compile(translate(_environment(None, Path(places[0]).parent), sources), "<templates>", "exec")


def _environment(templates: Path | None, beside: Path) -> Environment:
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
            loader=FileSystemLoader([*places, beside / "templates", folder("templates")]),
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
            bytecode_cache=FileSystemBytecodeCache(str(kept)) if kept else None,
            auto_reload=templates is not None,
        )
    return _environments[key]
