"""The preprocessor compared with `cpp`: random macros, conditions and uses give the same tokens."""

from __future__ import annotations

import random
import shutil
import subprocess

import pytest

from preprocessed import run
from processes import HANG
from skips import or_skip
from sssgen.lang.syntax.lexer import scan
from sssgen.lang.syntax.tokens import Token
from sssgen.run.compilers import CompilerMissing
from sssgen.support.diagnostics import SssgenError

MACROS, FUNCTIONS = "ABCD", "fgh"
VALUES = ["1", "-2", "(1)", "(A + 1)", "(B * 2)", "A", "vec2(A)", "vec2(1, 2)"]
USES = ["x = A;", "y = B + A;", "f(B) + A;", "z(C) = A;", "int A;", "q = f(A, B);", "{", "}", "f(g(1)", ")"]


def cpp() -> str:
    result = shutil.which("cpp")
    if result is None:
        raise CompilerMissing("install gcc")
    return result


def program(chance: random.Random) -> str:
    """Definitions, conditions and uses of a few names, at random."""

    def body(params: tuple[str, ...]) -> str:
        result: list[str] = []
        for _ in range(chance.randint(0, 5)):
            after = "##" if params and result and result[-1] != "##" else "y"
            result.append(chance.choice([*MACROS, *FUNCTIONS, *params * 2, "1", "+", "x", "(", ")", ",", after]))
        return " ".join(result).removesuffix("##")

    def line() -> str:
        name, function = chance.choice(MACROS), chance.choice(FUNCTIONS)
        params = chance.choice([(), ("p",), ("p", "q")])
        return chance.choice(
            [
                f"#define {name} {body(())}",
                f"#define {name} {chance.choice(VALUES)}",
                f"#define {name} {chance.choice(VALUES)}",
                f"#define {function}({', '.join(params)}) {body(params)}",
                f"#undef {chance.choice(MACROS + FUNCTIONS)}",
                f"#if defined {function} && {name} {chance.choice('+-<')} 1\n{name} {function};\n#else\nz;\n#endif",
                chance.choice(USES),
                chance.choice(USES),
                " ".join(chance.choices([*MACROS, *FUNCTIONS, "f(", ")", ",", "g(1)", "+"], k=chance.randint(1, 8))),
            ]
        )

    head = [f"#define A {chance.choice(VALUES[:3])}", f"#define B {chance.choice(VALUES)}", "x = B;"]
    return "\n".join(head * chance.randint(0, 1) + [line() for _ in range(chance.randint(2, 14))]) + "\n;"


def spelled(tokens: list[Token]) -> list[str]:
    """The tokens with the preserved constants expanded."""
    values: dict[str, list[str]] = {}
    result: list[str] = []
    rest = [token.text for token in tokens]
    while rest:
        if rest[:2] == ["const", "auto"]:
            end = rest.index(";")
            values[rest[2]] = [word for named in rest[4:end] for word in values.get(named, [named])]
            rest = rest[end:]
        else:
            result += values.get(rest[0], [rest[0]])
        rest = rest[1:]
    return result


@pytest.mark.parametrize("seed", range(3))
def test_random_macros_expand_as_in_c(seed: int) -> None:
    command = [or_skip(lambda _: cpp(), "cpp"), "-P", "-undef", "-w", "-std=c99"]
    chance = random.Random(seed)
    compared = stored = 0
    for _ in range(80):
        text = program(chance)
        theirs = subprocess.run(command, input=text, capture_output=True, text=True, timeout=HANG, check=False)
        try:
            ours = run(text)
        except SssgenError:  # C has tokens that GLSL lacks (1B), and directives between arguments are refused here
            continue
        if theirs.returncode == 0:
            expected = [token.text for token in scan(theirs.stdout, "cpp")[0]]
            assert spelled(ours.tokens) == expected, text
            compared += 1
            stored += len(ours.macros)
    assert compared > 30 and stored > 10
