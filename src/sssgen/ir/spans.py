"""Positions in source texts. They are apart from the nodes, as diagnostics need nothing else of the IR."""

from __future__ import annotations

from typing import NamedTuple


class Span(NamedTuple):
    """The position of a node in its source: 1-based lines and columns, the end exclusive."""

    file: str
    line: int
    column: int
    end_line: int
    end_column: int


NOWHERE = Span("", 0, 0, 0, 0)
