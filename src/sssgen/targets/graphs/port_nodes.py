"""The nodes that supply a port, as a descriptor lists them: `Distance A=#0 B=#1.4 Mode=2`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class PortNode(NamedTuple):
    """One node of an engine."""

    kind: str
    """Its class, as the descriptor calls it."""
    properties: tuple[tuple[str, str], ...]
    inputs: tuple[tuple[str, int, int], ...]
    """Each the name, and the node and the output that it reads, by number: of the list, and of the node."""


def port_nodes(texts: Sequence[str]) -> list[PortNode]:
    """The nodes of a port; the last one supplies the value."""
    nodes = []
    for text in texts:
        kind, *words = text.split()
        pairs = [(name, value) for name, _, value in (word.partition("=") for word in words)]
        inputs = [(name, value[1:].partition(".")) for name, value in pairs if value.startswith("#")]
        nodes.append(
            PortNode(
                kind,
                tuple([pair for pair in pairs if not pair[1].startswith("#")]),
                tuple([(name, int(node), int(output or 0)) for name, (node, _, output) in inputs]),
            )
        )
    return nodes
