"""The names of types."""

from __future__ import annotations

import pytest

from sssgen.ir.types import BY_NAME, spell, with_article


@pytest.mark.parametrize("name", sorted({spell(type_) for type_ in BY_NAME.values()}))
def test_article(name: str) -> None:
    assert with_article(name) == f"{'an' if name.startswith('i') else 'a'} {name}"
