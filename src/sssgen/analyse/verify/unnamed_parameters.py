"""Names for parameters that have none: drivers refuse definitions with them, although GLSL allows them."""

from __future__ import annotations

from collections.abc import Iterable

from sssgen.ir.nodes import Function, Span


def with_names(text: str, functions: Iterable[Function]) -> str:
    """The text of these functions with a name behind the type of each parameter that has none; lines stay."""
    name = "unnamed"
    while name in text:
        name += "_"
    lines = text.split("\n")
    # the place of a parameter is its name, or its type where it has none
    spans = {param.span: param.name for function in functions for param in function.params}
    unnamed = [
        span
        for span, chosen in spans.items()
        # the name that the front end invents does not begin with what is written there, unlike one that it changes
        if chosen.startswith("unnamed_") and not chosen.startswith(_at(lines, span))
    ]
    for number, span in enumerate(sorted(unnamed, reverse=True)):  # from the end: the others stay where they are
        line, end = lines[span.end_line - 1], span.end_column - 1
        lines[span.end_line - 1] = f"{line[:end]} {name}_{number}{line[end:]}"
    return "\n".join(lines)


def _at(lines: list[str], span: Span) -> str:
    return lines[span.line - 1][span.column - 1 : span.end_column - 1]
