"""The reference of the Python API, from the docstrings of what `sssgen` makes public."""

from __future__ import annotations

import inspect

import sssgen

PAGE = "docs/reference/python.md"


def page() -> str:
    """Every public name; Sphinx inserts the docstrings."""
    overview = inspect.getdoc(sssgen) or ""
    title, _, rest = overview.partition("\n\n")
    session, _, rest = rest.partition("\n\n")
    lines = ["# Python", "", title, "", "```pycon", session, "```", "", rest, ""]
    for name in sorted(sssgen.__all__):
        value = getattr(sssgen, name)
        if name.startswith("__"):
            continue
        lines += [f"## {name}", "", "```{eval-rst}"]
        if inspect.isclass(value):
            lines += [f".. autoclass:: sssgen.{name}", "   :members:"]
        else:
            lines += [f".. autofunction:: sssgen.{name}"]
        lines += ["```", ""]
    return "\n".join(lines)
