"""Values that are computed when one is read."""

from __future__ import annotations

import pytest

from sssgen.lab.measure.deferred import Deferred


def test_a_value_is_computed_once_and_only_when_it_is_read() -> None:
    calls: list[str] = []

    def value(name: str) -> str:
        calls.append(name)
        return name

    first = Deferred({"a": "known"}, {"b": lambda: value("b"), "c": lambda: value("c")})
    both = first | {"c": "other"}
    assert sorted(both) == ["a", "b", "c"] and len(both) == 3 and "b" in both and not calls
    assert [both["a"], both["b"], both["c"], first["b"], both["b"]] == ["known", "b", "other", "b", "b"]
    assert calls == ["b"]


def test_an_error_in_a_computation_is_not_a_missing_name() -> None:
    values: Deferred[int] = Deferred({}, {"a": lambda: {}["no such key"]})
    assert values.get("b", 7) == 7
    with pytest.raises(KeyError, match="no such key"):
        values.get("a", 7)
