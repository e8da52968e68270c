"""The parser's tables that are shipped are those of the grammar, for each lark that the project allows."""

from pathlib import Path

import lark
import pytest

from sssgen.lang.syntax import grammar_tables
from sssgen.lang.syntax.lalr import Tables
from sssgen.lang.syntax.parser import parse
from sssgen.support.cache import digest
from sssgen.support.diagnostics import SssgenError

GRAMMAR = Path(grammar_tables.GRAMMAR).read_text("utf-8")
SHIPPED = Path(grammar_tables.SHIPPED).read_text("utf-8")


def test_the_shipped_tables_are_those_of_the_grammar() -> None:
    built = grammar_tables.to_json(grammar_tables.build(GRAMMAR), GRAMMAR)
    assert built == SHIPPED, "run: python -m sssgen.lang.syntax.grammar_tables"


def test_tables_survive_json() -> None:
    built = grammar_tables.build(GRAMMAR)
    assert grammar_tables.from_json(grammar_tables.to_json(built, GRAMMAR), digest(GRAMMAR)) == built


def test_tables_of_another_grammar_are_ignored() -> None:
    assert grammar_tables.from_json(SHIPPED, digest(GRAMMAR + "\n")) is None


def test_a_changed_grammar_is_built(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    changed = tmp_path / "grammar.lark"
    changed.write_text(GRAMMAR + "\n// a comment\n", "utf-8")
    monkeypatch.setattr(grammar_tables, "GRAMMAR", str(changed))
    monkeypatch.setattr(grammar_tables, "_loaded", None)
    tables: Tables = grammar_tables.load()
    assert tables == grammar_tables.build(GRAMMAR)
    assert parse("float f() { return 1.0; }", "f.sss").externals


@pytest.mark.parametrize("version", ["1.1.8", "1.4.0", "2.0.0b1"])
def test_another_lark_version_is_refused(monkeypatch: pytest.MonkeyPatch, version: str) -> None:
    monkeypatch.setattr(lark, "__version__", version)
    with pytest.raises(SssgenError) as error:
        grammar_tables.build(GRAMMAR)
    (diagnostic,) = error.value.diagnostics
    assert version in diagnostic.message
    assert diagnostic.hint == "pip install 'lark>=1.1.9,<1.4'"
