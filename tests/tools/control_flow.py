"""Nested loops, switches and jumps: their GLSL, and their result by a direct reading of GLSL's rules.

A statement is a tuple: `("add", 3)`, `("break",)`, `("continue",)`, `("return",)`, `("if", test, body)`,
`("for", count, body)`, `("while", count, body)`, `("do", count, body)`, or `("switch", value, cases)`, where each case
is (labels, body) and the label None is the default. Tests and the values of switches are GLSL of `a`, `b` and `r`, and
Python as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from random import Random
from typing import Any, TypeAlias

Stmt: TypeAlias = tuple[Any, ...]
Body: TypeAlias = list[Stmt]

LOOPS = ("for", "while", "do")
NESTS = (*LOOPS, "switch")
JUMPS = ("break", "continue", "return")
TESTS = ("a > 1", "b > 2", "(r & 1) == 0", "r > 9", "a == b", "(a & 1) == 1")
SELECTORS = ("a & 3", "b & 3", "r & 3", "(a + b) & 3")


class _Jump(Exception):
    """The exception's argument is the kind of jump."""


class _Program:
    """One run."""

    def __init__(self, a: int, b: int) -> None:
        self.values = {"a": a, "b": b, "r": 0}

    def block(self, body: Body) -> None:
        for stmt in body:
            self.statement(stmt)

    def statement(self, stmt: Stmt) -> None:
        kind = stmt[0]
        if kind == "add":
            self.values["r"] = (self.values["r"] * 3 + stmt[1]) % 1009
        elif kind in JUMPS:
            raise _Jump(kind)
        elif kind == "if":
            if eval(stmt[1], {}, self.values):
                self.block(stmt[2])
        elif kind == "switch":
            self.switch(eval(stmt[1], {}, self.values), stmt[2])
        else:
            self.loop(kind, stmt[1], stmt[2])

    def loop(self, kind: str, count: int, body: Body) -> None:
        for _ in range(max(count, 1) if kind == "do" else count):
            try:
                self.block(body)
            except _Jump as jump:
                if jump.args[0] == "break":
                    return
                if jump.args[0] == "return":
                    raise

    def switch(self, value: int, cases: list[tuple[list[int | None], Body]]) -> None:
        labels = [label for each, _ in cases for label in each]
        wanted = value if value in labels else None
        start = next((index for index, (each, _) in enumerate(cases) if wanted in each), len(cases))
        try:
            for _, body in cases[start:]:
                self.block(body)
        except _Jump as jump:
            if jump.args[0] != "break":
                raise


def result(body: Body, a: int, b: int) -> int:
    """The value of `r` at the end."""
    program = _Program(a, b)
    with suppress(_Jump):
        program.block(body)
    return program.values["r"]


def glsl(name: str, body: Body) -> str:
    """A function of `a` and `b` that returns `r`."""
    return f"int {name}(int a, int b) {{\n    int r = 0;\n{_text(body, 1)}    return r;\n}}\n"


def _text(body: Body, depth: int) -> str:
    return "".join([_statement(stmt, depth) for stmt in body])


def _statement(stmt: Stmt, depth: int) -> str:
    indent, kind = "    " * depth, stmt[0]
    if kind == "add":
        return f"{indent}r = (r * 3 + {stmt[1]}) % 1009;\n"
    if kind in JUMPS:
        return f"{indent}{'return r' if kind == 'return' else kind};\n"
    inner = "" if kind == "switch" else _text(stmt[2], depth + 1)
    if kind == "if":
        return f"{indent}if ({stmt[1]}) {{\n{inner}{indent}}}\n"
    if kind == "switch":
        cases = ""
        for labels, body in stmt[2]:
            cases += "".join([f"{indent}default:\n" if at is None else f"{indent}case {at}:\n" for at in labels])
            cases += _text(body, depth + 1)
        return f"{indent}switch ({stmt[1]}) {{\n{cases}{indent}}}\n"
    i = f"{kind[0]}{depth}"
    if kind == "for":
        return f"{indent}for (int {i} = 0; {i} < {stmt[1]}; {i}++) {{\n{inner}{indent}}}\n"
    head = f"{indent}{{ int {i} = 0;\n"
    if kind == "while":
        return f"{head}{indent}while ({i}++ < {stmt[1]}) {{\n{inner}{indent}}} }}\n"
    return f"{head}{indent}do {{\n{inner}{indent}}} while (++{i} < {stmt[1]}); }}\n"


def pairs() -> Iterator[tuple[str, Body]]:
    """Each construct inside each, with each jump in the inner one: at its end or in an if."""
    for outer in NESTS:
        for inner in NESTS:
            for jump in JUMPS:
                if jump == "continue" and outer == inner == "switch":
                    continue
                for title, last in (("", [(jump,)]), ("_if", [("if", TESTS[0], [(jump,)]), ("add", 5)])):
                    nested = _nest(inner, 1, [("add", 1), *last])
                    yield f"{outer}_{inner}_{jump}{title}", [_nest(outer, 0, [("add", 2), nested, ("add", 3)])]
                    both = [("if", TESTS[1], [nested, ("add", 7)]), ("if", TESTS[2], [(_fits(jump, outer),)])]
                    yield f"{outer}_{inner}_{jump}{title}_twice", [_nest(outer, 0, [*both, nested, ("add", 4)])]


def _fits(jump: str, nest: str) -> str:
    return "break" if jump == "continue" and nest == "switch" else jump


def _nest(kind: str, selector: int, body: Body) -> Stmt:
    """A loop with this body, or a switch with this body in one case, in the default, or falling through."""
    if kind != "switch":
        return (kind, 3, body)
    last = [("add", 6)]
    return ("switch", SELECTORS[selector], [([None], [("break",)]), ([1], body), ([2, 3], [*body[:-1], *last])])


def random_body(rng: Random, depth: int, loops: int = 0, switches: int = 0) -> Body:
    """Statements of random kinds, in which each jump is allowed."""
    body: Body = []
    for _ in range(rng.randint(1, 3)):
        kind = rng.choice(("add", "add", "if", *NESTS, *JUMPS)) if depth else "add"
        if kind == "add" or (kind in JUMPS and rng.random() < 0.7):
            body.append(("add", rng.randint(0, 9)))
        elif kind in JUMPS:
            allowed = kind == "return" or loops or (kind == "break" and switches)
            body.append((kind,) if allowed else ("add", 8))
        elif kind == "if":
            body.append(("if", rng.choice(TESTS), random_body(rng, depth - 1, loops, switches)))
        elif kind == "switch":
            labels: list[int | None] = [None, 0, 1, 2, 3]
            rng.shuffle(labels)
            inner = [random_body(rng, depth - 1, loops, switches + 1) for _ in range(3)]
            ends = [[("break",)] if rng.random() < 0.5 else [] for _ in range(3)]
            split = [labels[:1], labels[1:3], labels[3:4]]
            body.append(("switch", rng.choice(SELECTORS), [(split[at], inner[at] + ends[at]) for at in range(3)]))
        else:
            body.append((kind, rng.randint(1, 3), random_body(rng, depth - 1, loops + 1, 0)))
        if body[-1][0] in JUMPS:
            break
    return body
