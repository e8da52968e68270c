"""The expressions of #if and #elif: integers with C's operators (GLSL 4.60, section 3.3; C11, section 6.10.1).

They are evaluated while they are read. A Fault can be a value: `defined(X) && 1 / X` is correct where X is not defined,
as the right side is then ignored.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sssgen.ir.operators import PRECEDENCE
from sssgen.ir.spans import Span
from sssgen.lang.syntax.tokens import Token

MAX_NESTED = 100
"""How deeply parentheses and `?:` may nest in one expression."""

_BITS = 64


class Fault(Exception):
    """An error in a directive: its place, the message, what to do."""

    def __init__(self, span: Span, message: str, hint: str = "") -> None:
        super().__init__(span, message, hint)
        self.details = (span, message, hint)


_Value = int | Fault


def evaluate(tokens: Sequence[Token], is_defined: Callable[[str], bool], place: Span, strict: bool = False) -> int:
    """The value of an expression after macro expansion, as a signed 64-bit integer.

    A remaining name is 0, and an error if the expression is `strict`, as in GLSL ES. `is_defined`
    evaluates `defined X`; `place` is the directive's, for errors at the end. Raises Fault.
    """
    reader = _Reader(tokens, is_defined, place, strict)
    value = reader.choice(0)
    if reader.text:
        raise reader.unexpected()
    if isinstance(value, Fault):
        raise value
    return value


class _Reader:
    """Reads an expression from left to right."""

    def __init__(self, tokens: Sequence[Token], is_defined: Callable[[str], bool], place: Span, strict: bool) -> None:
        self.tokens = tokens
        self.is_defined = is_defined
        self.strict = strict
        self.place = place
        self.index = 0

    @property
    def text(self) -> str:
        """The text of the next token, '' at the end."""
        return self.tokens[self.index].text if self.index < len(self.tokens) else ""

    def take(self) -> Token:
        if not self.text:
            raise Fault(self.place, "the expression ends too early")
        self.index += 1
        return self.tokens[self.index - 1]

    def expect(self, text: str) -> None:
        if self.text != text:
            raise self.unexpected(f"; expected '{text}'") if self.text else Fault(self.place, f"a '{text}' is missing")
        self.index += 1

    def unexpected(self, wanted: str = "") -> Fault:
        token = self.tokens[self.index]
        return Fault(token.span, f"'{token.text}' is not expected here{wanted}")

    def choice(self, depth: int) -> _Value:
        if depth > MAX_NESTED:
            raise Fault(self.place, f"this expression nests more than {MAX_NESTED} levels deep")
        condition = self.binary(depth)
        if self.text != "?":
            return condition
        self.index += 1
        first = self.choice(depth + 1)
        self.expect(":")
        second = self.choice(depth + 1)
        if isinstance(condition, Fault):
            return condition
        return first if condition else second

    def binary(self, depth: int) -> _Value:
        """Groups `unary (operator unary)*` by precedence."""
        operands = [self.unary(depth)]
        operators: list[Token] = []

        def reduce() -> None:
            right, left = operands.pop(), operands.pop()
            operands.append(_combine(operators.pop(), left, right))

        while self.text in PRECEDENCE and self.text != "^^":
            operator = self.take()
            while operators and PRECEDENCE[operators[-1].text] >= PRECEDENCE[operator.text]:
                reduce()
            operators.append(operator)
            operands.append(self.unary(depth))
        while operators:
            reduce()
        return operands[0]

    def unary(self, depth: int) -> _Value:
        signs: list[str] = []
        while self.text in ("+", "-", "!", "~"):
            signs.append(self.take().text)
        value = self.primary(depth)
        for sign in reversed(signs):
            if isinstance(value, int):
                value = _wrapped({"+": value, "-": -value, "!": int(not value), "~": ~value}[sign])
        return value

    def primary(self, depth: int) -> _Value:
        token = self.take()
        if token.text == "(":
            value = self.choice(depth + 1)
            self.expect(")")
            return value
        if token.text == "defined":
            return int(self.is_defined(self.name()))
        if token.type == "INT":
            return _wrapped(_number(token))
        if token.type == "FLOAT":
            raise Fault(token.span, f"'{token.text}' is not an integer", "#if compares integers only")
        if token.text.isidentifier():
            hint = "GLSL ES has no default for it: define it, or ask for it with defined()"
            return Fault(token.span, f"'{token.text}' is not defined", hint) if self.strict else 0
        self.index -= 1
        raise self.unexpected()

    def name(self) -> str:
        """The operand of `defined`: `X` or `(X)`."""
        bracketed = self.text == "("
        if bracketed:
            self.index += 1
        token = self.take()
        if not token.text.isidentifier():
            raise Fault(token.span, "'defined' needs the name of a macro")
        if bracketed:
            self.expect(")")
        return token.text


def _number(token: Token) -> int:
    digits = token.text.rstrip("uU").lower()
    try:
        if len(digits) > 100:
            raise ValueError
        octal = digits.startswith("0") and digits.isdecimal()
        return int(digits, 16 if digits.startswith("0x") else 8 if octal else 10)
    except ValueError:
        raise Fault(token.span, f"'{token.text}' is not a number") from None


def _wrapped(value: int) -> int:
    """The value wrapped to 64 bits, in two's complement."""
    half = 1 << (_BITS - 1)
    return ((value + half) & (2 * half - 1)) - half


def _combine(operator: Token, left: _Value, right: _Value) -> _Value:
    sign = operator.text
    if isinstance(left, Fault):
        return left
    if sign == "&&" and not left:
        return 0
    if sign == "||" and left:
        return 1
    if isinstance(right, Fault):
        return right
    if sign in ("/", "%"):
        if right == 0:
            return Fault(operator.span, "division by 0")
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)  # towards 0, as in C
        return _wrapped(quotient if sign == "/" else left - quotient * right)
    if sign in ("<<", ">>"):
        if not 0 <= right < _BITS:
            return Fault(operator.span, f"a shift by {right} bits: it must be 0 to {_BITS - 1}")
        return _wrapped(left << right if sign == "<<" else left >> right)
    return _wrapped(int(_PLAIN[sign](left, right)))


_PLAIN: dict[str, Callable[[int, int], int]] = {
    "*": lambda a, b: a * b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "&": lambda a, b: a & b,
    "^": lambda a, b: a ^ b,
    "|": lambda a, b: a | b,
    "&&": lambda a, b: bool(a and b),
    "||": lambda a, b: bool(a or b),
}
