"""Sphinx's settings for the documents; build_site.py runs it. Nothing on a page is fetched from another place."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

project = "sssgen"
copyright = "The sssgen authors"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "README"
source_suffix = {".md": "markdown"}

html_theme = "furo"
html_title = "sssgen"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#a8430f", "color-brand-content": "#a8430f"},
    "dark_css_variables": {"color-brand-primary": "#ff9a52", "color-brand-content": "#ff9a52"},
}
html_js_files = [("search.js", {"defer": "defer"})]
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_favicon = "static/icon.svg"
html_extra_path = ["404.html"]
templates_path = ["templates"]

myst_heading_anchors = 6
myst_enable_extensions = ["html_image"]
suppress_warnings = [
    "misc.highlighting_failure",  # outputs and excerpts are not always whole programs
    "myst.header",  # generated pages can begin below the first level
]

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
default_role = "code"


def setup(app: Any) -> None:
    """Omits the docstrings that Python itself gives the fields of a NamedTuple; pictures load when they are seen."""
    app.connect("autodoc-process-docstring", _without_aliases)
    app.connect("html-page-context", _with_lazy_pictures)


def _with_lazy_pictures(app: Any, page: str, template: str, context: dict[str, Any], tree: Any) -> None:
    if "body" in context:
        context["body"] = re.sub(r"<img (?![^>]*loading=)", '<img loading="lazy" ', context["body"])


def _without_aliases(app: Any, what: str, name: str, value: Any, options: Any, lines: list[str]) -> None:
    if lines and re.fullmatch(r"Alias for field number \d+", lines[0]):
        lines.clear()
