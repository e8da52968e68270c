"""The names of a language for tests: one with everything, but for overloads."""

from __future__ import annotations

from collections.abc import Iterable

from sssgen.passes.capabilities import Capabilities
from sssgen.passes.names import Rules


def rules_of(reserved: Iterable[str] = (), overloads: bool = True, folded: Iterable[str] = ()) -> Rules:
    """Rules with these reserved names; the `folded` ones are reserved in any case."""
    able = Capabilities(layout_overloads=True, loop_scope=True, member_types=True, hiding=True, overloads=overloads)
    return Rules(frozenset(reserved), frozenset(folded), capabilities=able)
