"""The LALR(1) tables of grammar.lark: built by lark, shipped as JSON beside the grammar so that no run builds them.

After a change of the grammar `python -m sssgen.lang.syntax.grammar_tables` writes the JSON file again; until then each
process builds the tables itself.
"""

from __future__ import annotations

import json
import os
from typing import Any

from sssgen.lang.syntax.lalr import Action, Reduction, Tables
from sssgen.support.cache import digest
from sssgen.support.diagnostics import failure

GRAMMAR = os.path.join(os.path.dirname(__file__), "grammar.lark")
SHIPPED = os.path.join(os.path.dirname(__file__), "grammar_tables.json")

LARK_VERSIONS = (1, 1, 9), (1, 4)
"""The first lark version whose parse table `build` reads, and the first one that it does not: the table is private to
lark and can change in any release."""

_loaded: Tables | None = None


def load() -> Tables:
    """The tables of the grammar of this installation, read once a process."""
    global _loaded
    if _loaded is None:
        grammar = _read(GRAMMAR)
        _loaded = from_json(_read(SHIPPED), digest(grammar)) or build(grammar)
    return _loaded


def build(grammar: str) -> Tables:
    """The tables of a grammar whose terminals are only declared. Raises SssgenError for a lark too old or too new."""
    import lark
    from lark.lexer import Lexer

    first, end = LARK_VERSIONS
    version = tuple(int(part) for part in lark.__version__.split(".")[:3] if part.isdigit())
    if not first <= version < end:
        wanted = f"lark>={'.'.join(map(str, first))},<{'.'.join(map(str, end))}"
        raise failure(f"cannot build the parser's tables with lark {lark.__version__}", f"pip install '{wanted}'")

    class NoLexer(Lexer):
        """The tokens do not come from lark."""

        def __init__(self, *_: Any) -> None: ...

        def lex(self, *_: Any) -> Any: ...

    parser: Any = lark.Lark(grammar, parser="lalr", lexer=NoLexer).parser.parser
    table = parser._parse_table
    start = table.start_states["start"]
    number = {state: index for index, state in enumerate(_reachable(table.states, start))}
    actions: list[dict[str, Action]] = []
    goto: list[dict[str, int]] = []
    for state in number:
        terminals: dict[str, Action] = {}
        rules: dict[str, int] = {}
        for symbol, (kind, argument) in sorted(table.states[state].items()):
            name = str(symbol)  # lark's own string class compares slowly
            if kind.name == "Reduce":
                terminals[name] = _reduction(argument)
            elif name[0].isupper() or name[0] == "$" or name.startswith("__ANON"):
                terminals[name] = number[argument]
            else:
                rules[name] = number[argument]
        actions.append(terminals)
        goto.append(rules)
    return Tables(actions, goto, number[start], number[table.end_states["start"]], {})


def _reachable(states: Any, start: Any) -> list[Any]:
    """The states in the order in which they are reached by sorted symbols: lark's own order differs from run to run."""
    order = {start: None}
    waiting = [start]
    while waiting:
        for _, (kind, argument) in sorted(states[waiting.pop()].items()):
            if kind.name == "Shift" and argument not in order:
                order[argument] = None
                waiting.append(argument)
    return list(order)


def _reduction(rule: Any) -> Action:
    """What lark's tree builder would do for a rule, as data."""
    name = str(rule.origin.name)
    options = rule.options
    absent = [0] * (len(rule.expansion) + 1)
    if options.empty_indices:
        absent = [len(run) for run in "".join("01"[flag] for flag in options.empty_indices).split("0")]
    children, pending = [], 0
    for index, symbol in enumerate(rule.expansion):
        pending += absent[index]
        if not (symbol.is_term and symbol.filter_out):
            children.append((index, not symbol.is_term and symbol.name.startswith("_"), pending))
            pending = 0
    pending += absent[-1]
    whole = not pending and children == [(index, False, 0) for index in range(len(rule.expansion))]
    kept = None if whole else tuple(children)
    helper = name.startswith("_")
    single = len(children) == 1 and not pending and not children[0][2]
    if options.expand1 and not rule.alias and single and not children[0][1]:
        if len(rule.expansion) == 1:
            return name
        return Reduction(len(rule.expansion), name, "only", tuple(children), 0)
    return Reduction(len(rule.expansion), name, "" if helper else str(rule.alias or name), kept, pending)


def to_json(tables: Tables, grammar: str) -> str:
    """The tables as JSON. Equal rows and reductions are written once; a reduction is a list of its number."""
    reductions: dict[Reduction, int] = {}
    rows: dict[str, int] = {}

    def encode(action: Action) -> object:
        return [reductions.setdefault(action, len(reductions))] if isinstance(action, Reduction) else action

    def row(entries: dict[str, Any]) -> int:
        text = json.dumps({name: encode(action) for name, action in entries.items()})
        return rows.setdefault(text, len(rows))

    actions, goto = [row(entries) for entries in tables.actions], [row(entries) for entries in tables.goto]
    lines = [
        f'{{"grammar": "{digest(grammar)}", "start": {tables.start}, "end": {tables.end},',
        f'"actions": {json.dumps(actions)},',
        f'"goto": {json.dumps(goto)},',
        '"reductions": [\n' + ",\n".join(json.dumps(reduction) for reduction in reductions) + "\n],",
        '"rows": [\n' + ",\n".join(rows) + "\n]}",
    ]
    return "\n".join(lines) + "\n"


def from_json(text: str, grammar_digest: str) -> Tables | None:
    """The tables that `to_json` wrote; None where they are those of another grammar."""
    data = json.loads(text)
    if data["grammar"] != grammar_digest:
        return None
    reductions = [
        Reduction(size, origin, callback, None if kept is None else tuple([tuple(child) for child in kept]), absent)
        for size, origin, callback, kept, absent in data["reductions"]
    ]
    rows = [
        {name: reductions[action[0]] if action.__class__ is list else action for name, action in row.items()}
        for row in data["rows"]
    ]
    return Tables(
        [rows[index] for index in data["actions"]], [rows[index] for index in data["goto"]],
        data["start"], data["end"], {},
    )  # fmt: skip


def _read(path: str) -> str:
    with open(path, encoding="utf-8") as file:
        return file.read()


def main() -> None:
    """Writes the shipped tables."""
    grammar = _read(GRAMMAR)
    with open(SHIPPED, "w", encoding="utf-8", newline="\n") as file:
        file.write(to_json(build(grammar), grammar))


if __name__ == "__main__":
    main()
