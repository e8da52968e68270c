"""The `formula:` of a technique as MathML, which browsers typeset without anything being fetched.

Each clause is a line. A line is several formulas beside each other, cut at relations and at the outermost operators,
so that the browser can wrap it where the page is narrow.
"""

from __future__ import annotations

import functools
import html
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from lark import Lark, Token
from lark.exceptions import UnexpectedInput

Node = Any
"""A tree or a token of lark: the grammar says which of them a rule has."""

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "eta": "η", "theta": "θ", "lambda": "λ", "mu": "μ",
    "pi": "π", "rho": "ρ", "sigma": "σ", "phi": "φ", "omega": "ω",
}  # fmt: skip
OPERATORS = {"<=": "≤", ">=": "≥", "..": "…", "-": "−", "-=": "−="}
PRIME = "′"
_SPACE = '<mspace width="0.2em"></mspace>'
"""Between factors, so that the words of a product stay apart."""

_SUBSCRIPT = re.compile(rf"([^\W\d_]|[a-z]+(?=_[a-z0-9](?:[+-]1)?$)|{'|'.join(GREEK)})_?(\d+|(?<=_).+)")
"""A letter or a Greek letter with anything below it, or a word with one letter or digit: w_i, sigma_t, F2, map_k."""
_NEXT = re.compile(r"([a-z])([+-])1")


_NO_NAMES = re.compile("and|as|at|by|for|from|in|is|of|on|or|over|the|then|to|until|up|where|with")
"""Words that are no names, so that words outside of quotes are found."""


class FormulaError(ValueError):
    """A formula that is not in the notation."""


@functools.cache
def _parser() -> Lark:
    return Lark(Path(__file__).with_name("formula.lark").read_text(encoding="utf-8"), parser="lalr")


def typeset(formula: str) -> str:
    """A piece of HTML: one line for each clause of the formula."""
    text = " ".join(formula.split())
    try:
        tree: Node = _parser().parse(text)
    except UnexpectedInput as error:
        raise _error(text, error.pos_in_stream or 0) from None
    for token in tree.scan_values(lambda value: _NO_NAMES.fullmatch(value) is not None):
        raise _error(text, token.start_pos)
    return "\n".join(['<div class="formula">', *(f"<div>{line}</div>" for line in _lines(tree)), "</div>"])


def _error(text: str, place: int) -> FormulaError:
    return FormulaError(
        f"this formula is not in the notation of docs/language.md: {text[:place]}⟨here⟩{text[place:]}; "
        "write words that are not names in double quotes"
    )


def _lines(tree: Node) -> Iterator[str]:
    """A clause begins a line if it has a relation or begins with words; others continue a list such as k = 1, 2."""
    line = ""
    for part in tree.children:
        if part.data == "clause":
            begins = isinstance(part.children[0], Token) or part.children[0].data == "chain"
            if line and (begins or line.endswith(";")):
                yield line.rstrip(",;")
                line = ""
            line += (" " if line else "") + _clause(part)
        else:
            line += "," if part.data == "comma" else ";"
    yield line


def _clause(clause: Node) -> str:
    text = " ".join(
        html.escape(piece[1:-1], quote=False) if isinstance(piece, Token) else "<wbr/>".join(_pieces(piece))
        for piece in clause.children
    )
    return re.sub(r" (?=[,;)]|\.(?!\d))", "", text)


def _pieces(node: Node) -> Iterator[str]:
    """The formula in pieces, between which a line may be broken; each but the first begins with an operator."""
    for begin, end in _cuts(node):
        yield f'<math displaystyle="true">{begin}{end}</math>'


def _cuts(node: Node) -> Iterator[tuple[str, str]]:
    if node.data == "chain":
        operator = ""
        for part in node.children:
            if part.data == "relation":
                operator = _operator(part.children[0], "infix")
            else:
                for first, (begin, end) in enumerate(_cuts(part)):
                    yield (begin if first else operator + begin), end
    elif node.data == "sum":
        sign = ""
        for number, part in enumerate(node.children):
            if part.data in ("plus", "minus"):
                sign = _sign(part, "infix" if number else "prefix")
            else:
                for first, (begin, end) in enumerate(_cuts(part)):
                    yield (begin if first else sign + begin), end
    elif node.data == "term":
        for number, part in enumerate(part for part in node.children if part.data != "star"):
            for first, (begin, end) in enumerate(_cuts(part) if part.data == "product" else [("", _tight(part))]):
                yield (_SPACE if number and not first else begin), end
    elif node.data == "product":
        left, right = node.children
        yield from _cuts(left) if left.data == "product" else [("", _tight(left))]
        yield _SPACE, _tight(right)
    else:
        yield "", _math(node)


def _operator(text: str, form: str = "infix") -> str:
    return f'<mo form="{form}">{html.escape(OPERATORS.get(text, text))}</mo>'


def _sign(node: Node, form: str) -> str:
    return _operator("+" if node.data == "plus" else "-", form)


def _row(text: str) -> str:
    return f"<mrow>{text}</mrow>"


def _fence(text: str, left: str = "(", right: str = ")") -> str:
    """Brackets that are taller than a letter only around what is: without a mathematical font they would all be."""
    stretchy = "true" if re.search("<(?:mfrac|munder|mtable|msubsup|msqrt)>", text) else "false"
    attributes = f'fence="true" stretchy="{stretchy}"'
    return _row(f"<mo {attributes}>{left}</mo>{text}<mo {attributes}>{right}</mo>")


def _math(node: Node) -> str:
    """Elements of MathML, in a row."""
    return _RULES[str(node.data)](*node.children)


def _tight(node: Node) -> str:
    """As a factor: in parentheses if it would fall apart."""
    return _fence(_math(node)) if node.data in ("sum", "chain") or _is_call(node, "dot") else _math(node)


def _bare(node: Node) -> str:
    """Without the parentheses that a fraction bar, a root or a raised place replaces."""
    if node.data == "group" and len(node.children[0].children) == 1:
        return _math(node.children[0])
    return _math(node)


def _is_call(node: Node, name: str) -> bool:
    return bool(node.data == "call" and node.children[0] == name)


def _chain(*parts: Node) -> str:
    return "".join(_operator(part.children[0]) if part.data == "relation" else _math(part) for part in parts)


def _sum(*parts: Node) -> str:
    return "".join(
        _sign(part, "infix" if number else "prefix") if part.data in ("plus", "minus") else _math(part)
        for number, part in enumerate(parts)
    )


def _term(*parts: Node) -> str:
    return _SPACE.join(_tight(part) for part in parts if part.data != "star")


def _product(left: Node, right: Node) -> str:
    return _tight(left) + _SPACE + _tight(right)


def _fraction(top: Node, *below: Node) -> str:
    """a / b / c is a / (b c)."""
    divisors = [below]
    while top.data == "fraction":
        top, *rest = top.children
        divisors.insert(0, tuple(rest))
    texts = []
    for *sign, divisor in divisors:
        alone = len(divisors) == 1
        texts.append(("<mo>−</mo>" if sign else "") + (_bare(divisor) if alone and not sign else _tight(divisor)))
    return f"<mfrac>{_row(_bare(top))}{_row(_SPACE.join(texts))}</mfrac>"


def _power(base: Node, exponent: Node) -> str:
    return f"<msup>{_row(_tight(base))}{_row(_exponent(exponent))}</msup>"


def _exponent(exponent: Node) -> str:
    *sign, value = exponent.children
    return ("<mo>−</mo>" if sign else "") + (_math(value) if sign else _bare(value))


def _primed(base: Node, primes: Token) -> str:
    return f"<msup>{_row(_math(base))}<mo>{PRIME * len(primes)}</mo></msup>"


def _power_of_primed(base: Node, primes: Token, exponent: Node) -> str:
    return f"<msup>{_row(_math(base))}{_row(f'<mo>{PRIME * len(primes)}</mo>{_exponent(exponent)}')}</msup>"


def _number(text: str) -> str:
    return f"<mn>{'0' if text.startswith('.') else ''}{text}</mn>"


def _name(text: str) -> str:
    if text == "sum":
        return "<mo>∑</mo>"
    if text.startswith("sum_"):
        return f"<munder><mo>∑</mo>{_index(text.removeprefix('sum_'))}</munder>"
    if match := _SUBSCRIPT.fullmatch(text):
        return f"<msub>{_name(match[1])}{_index(match[2])}</msub>"
    return f"<mi>{GREEK.get(text, text)}</mi>"


def _index(text: str) -> str:
    if match := _NEXT.fullmatch(text):
        return _row(f"<mi>{match[1]}</mi>{_operator(match[2])}<mn>1</mn>")
    return f"<mn>{text}</mn>" if text.isdigit() else f"<mi>{text.replace('_', ' ')}</mi>"


def _arguments(*clauses: Node) -> str:
    return "<mo>,</mo>".join(map(_math, clauses))


def _within(*pieces: Node) -> str:
    return "".join(
        f"<mtext>&#160;{html.escape(piece[1:-1])}&#160;</mtext>" if isinstance(piece, Token) else _math(piece)
        for piece in pieces
    )


def _call(name: Token, arguments: Node) -> str:
    called = name.rstrip("'")
    given = arguments.children
    if called == "sqrt":
        return f"<msqrt>{_math(arguments)}</msqrt>"
    if called == "dot":
        return _row('<mo form="infix">·</mo>'.join(_tight(_only(one)) for one in given))
    if called == "pow":
        base, exponent = map(_only, given)
        return f"<msup>{_row(_tight(base))}{_row(_math(exponent))}</msup>"
    if called == "integral":
        value, variable, low, high = map(_only, given)
        return _row(
            f"<msubsup><mo>∫</mo>{_row(_math(low))}{_row(_math(high))}</msubsup>{_math(value)}{_SPACE}"
            f"<mi>d</mi>{_math(variable)}"
        )
    if called.partition("_")[0] == "sum":
        return _row(_name(called) + _tight(_only(given[0])))
    primes = f"<mo>{PRIME * (len(name) - len(called))}</mo>"
    head = f"<msup>{_name(called)}{primes}</msup>" if called != name else _name(called)
    return _row(head + "<mo>&#x2061;</mo>" + _fence(_math(arguments)))


def _only(clause: Node) -> Node:
    (found,) = clause.children
    return found


def _group(arguments: Node) -> str:
    return _fence(_math(arguments))


def _bars(arguments: Node) -> str:
    return _fence(_math(arguments), "|", "|")


def _bracket(clause: Node) -> str:
    return _fence(_math(clause), "[", "]")


def _choice(condition: Node, yes: Node, no: Node) -> str:
    rows = ((yes, "if", _math(condition)), (no, "otherwise", ""))
    cells = "".join(
        f"<mtr><mtd>{_math(value)}</mtd><mtd><mtext>{word}&#160;</mtext>{when}</mtd></mtr>"
        for value, word, when in rows
    )
    return _row(f"<mo>{{</mo><mtable>{cells}</mtable>")


_RULES: dict[str, Callable[..., str]] = {
    "chain": _chain,
    "sum": _sum,
    "term": _term,
    "product": _product,
    "fraction": _fraction,
    "power": _power,
    "primed": _primed,
    "power_of_primed": _power_of_primed,
    "number": _number,
    "degrees": _number,
    "name": _name,
    "call": _call,
    "group": _group,
    "choice": _choice,
    "bracket": _bracket,
    "bars": _bars,
    "arguments": _arguments,
    "clause": _within,
}
"""Each rule of the grammar that has a form of its own."""
