"""Builds the syntax tree: one method for each rule of grammar.lark, which gets the rule's children."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from sssgen.ir.operators import PRECEDENCE
from sssgen.ir.spans import Span
from sssgen.lang.syntax import tree as s
from sssgen.lang.syntax.tokens import Token

_NOT_OF_PARAMETERS = frozenset({"uniform", "varying", "attribute", "buffer", "shared", "invariant", "flat"})
_NOT_OF_RESULTS = _NOT_OF_PARAMETERS | {"in", "out", "inout", "const"}


class Builder:
    """Builds one file's tree. `too_deep` is the first place that nests more than `limit` levels deep."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.too_deep: Span | None = None
        self.wrong: list[tuple[Span, str]] = []
        """Errors that the grammar accepts: place and message."""
        self.unnamed_structs = 0
        self.methods: dict[str, Callable[[list[Any]], Any]] = {
            name: getattr(self, name) for name in vars(Builder) if not name.startswith("__")
        }

    def deeper(self, span: Span, *parts: Any) -> int:
        depth = 0
        for part in parts:
            inner = getattr(part, "depth", 0)
            if inner > depth:
                depth = inner
        if depth >= self.limit and self.too_deep is None:
            self.too_deep = span
        return depth + 1

    def only(self, children: list[Any]) -> Any:
        return children[0]

    # Declarations

    def start(self, children: list[Any]) -> list[Any]:
        return [child for child in children if child is not None]

    def nothing(self, children: list[Any]) -> None:
        return None

    default_precision = empty = nothing

    def qualifiers_alone(self, children: list[Any]) -> s.LayoutSyntax:
        return s.LayoutSyntax(children[0], s.Name("", children[0].span))

    def head(self, children: list[Any]) -> tuple[s.Qualifiers, s.TypeName, s.Name]:
        qualifiers, type_, token = children
        self.refuse(qualifiers, _NOT_OF_RESULTS, "a function")
        return qualifiers, type_, s.Name(token.text, token.span)

    def function(self, children: list[Any]) -> s.FunctionSyntax:
        (_, result, name), params, body = children
        return s.FunctionSyntax(result, name, params or (), body, "")

    def prototype(self, children: list[Any]) -> s.FunctionSyntax:
        (_, result, name), params = children
        return s.FunctionSyntax(result, name, params or (), None, "")

    def params(self, children: list[Any]) -> tuple[s.Parameter, ...]:
        if len(children) == 1 and children[0].name is None and children[0].type.name == "void":
            return ()
        return tuple(children)

    def param(self, children: list[Any]) -> s.Parameter:
        qualifiers, type_, name, lengths = children
        self.refuse(qualifiers, _NOT_OF_PARAMETERS, "a parameter")
        direction = next((keyword for keyword in qualifiers.keywords if keyword in ("in", "out", "inout")), "in")
        label = s.Name(name.text, name.span) if name is not None else None
        return s.Parameter(direction, type_, label, lengths or (), "const" in qualifiers.keywords)

    def global_(self, children: list[Any]) -> s.GlobalSyntax:
        qualifiers, type_, declarators = children
        return s.GlobalSyntax(s.Declaration(qualifiers, type_, declarators, type_.span), "")

    def requalified(self, children: list[Any]) -> s.GlobalSyntax:
        qualifiers, name, *_ = children
        return s.GlobalSyntax(s.Declaration(qualifiers, s.TypeName(name.text, (), name.span), (), name.span), "")

    def struct_alone(self, children: list[Any]) -> s.StructSyntax:
        struct: s.StructSyntax = children[1].struct
        return struct

    def block_of(self, children: list[Any]) -> s.BlockSyntax:
        qualifiers, name, _, *members, _, instance, lengths = children
        label = s.Name(instance.text, instance.span) if instance is not None else None
        return s.BlockSyntax(qualifiers, s.Name(name.text, name.span), tuple(members), label, lengths or (), "")

    def qualifiers(self, children: list[Any]) -> s.Qualifiers:
        if not children:
            return s.PLAIN
        keywords = tuple([child.text for child in children if isinstance(child, Token)])
        layout = tuple([item for child in children if not isinstance(child, Token) for item in child])
        span = next((child.span for child in children if isinstance(child, Token)), s.PLAIN.span)
        return s.Qualifiers(keywords, layout, span)

    local_qualifiers = qualifiers

    def layout(self, children: list[Any]) -> list[tuple[str, s.Expression | None]]:
        return children[1:]

    def layout_item(self, children: list[Any]) -> tuple[str, s.Expression | None]:
        name, sign, value = children
        self.require_equals(sign)
        return name.text.lower(), value  # older GLSL and GLSL ES do not tell case apart here

    def refuse(self, qualifiers: s.Qualifiers, keywords: frozenset[str], what: str) -> None:
        """Reports qualifiers that cannot be before `what`."""
        for keyword in keywords.intersection(qualifiers.keywords):
            self.wrong.append((qualifiers.span, f"{what} cannot be '{keyword}'"))

    def require_equals(self, sign: Token | None) -> None:
        """Reports an assignment operator other than '='."""
        if sign is not None and sign.text != "=":
            self.wrong.append((sign.span, f"'{sign.text}' is not expected here; expected '='"))

    def named_type(self, children: list[Any]) -> s.TypeName:
        token, lengths = children
        return s.TypeName(token.text, lengths, token.span)

    def struct(self, children: list[Any]) -> s.TypeName:
        keyword, name, _, *members, _ = children
        label = s.Name(name.text, name.span) if name is not None else s.Name(self.unnamed(), keyword.span)
        return s.TypeName(label.text, (), label.span, s.StructSyntax(label, tuple(members), ""))

    def unnamed(self) -> str:
        """A name for a struct without one: the other languages need a name."""
        self.unnamed_structs += 1
        return "Unnamed" if self.unnamed_structs == 1 else f"Unnamed_{self.unnamed_structs}"

    def member(self, children: list[Any]) -> s.Declaration:
        qualifiers, type_, declarators = children
        return s.Declaration(qualifiers, type_, declarators, type_.span)

    def arrays(self, children: list[Any]) -> tuple[s.Expression, ...]:
        return tuple(children)

    def array(self, children: list[Any]) -> s.Expression:
        start, length, end = children
        return length if length is not None else s.Unsized(_join(start.span, end.span))

    def declarators(self, children: list[Any]) -> tuple[s.Declarator, ...]:
        return tuple(children)

    def declarator(self, children: list[Any]) -> s.Declarator:
        name, lengths, hints, sign, value = children
        self.require_equals(sign)
        return s.Declarator(s.Name(name.text, name.span), lengths, value, hints or ())

    def listed(self, children: list[Any]) -> s.Listed:
        start, *items, end = children
        values = tuple([item for item in items if item is not None])
        span = _join(start.span, end.span)
        return s.Listed(values, span, self.deeper(span, *values))

    def hints(self, children: list[Any]) -> tuple[s.Hint, ...]:
        return tuple(children)

    def hint(self, children: list[Any]) -> s.Hint:
        name, *args = children
        return s.Hint(s.Name(name.text, name.span), tuple([arg for arg in args if arg is not None]))

    def hint_arg(self, children: list[Any]) -> float | str:
        token = children[-1]
        text: str = token.text
        if token.type == "STRING":
            return text[1:-1]
        if token.type == "NAME":
            return text
        hexadecimal = text[:2] in ("0x", "0X")
        value = float(int(text[:40].rstrip("uU"), 16)) if hexadecimal else float(text.rstrip("fFuUlL"))
        return -value if children[0] is not None and children[0].text == "-" else value

    # Statements

    def block(self, children: list[Any]) -> s.Compound:
        start, *inner, end = children
        statements = tuple([self.as_statement(child) for child in _filled(inner) if child is not None])
        span = _join(start.span, end.span)
        return s.Compound(statements, span, self.deeper(span, *statements))

    def as_statement(self, child: Any) -> Any:
        if child is None or isinstance(child, s.Statement):
            return child
        if isinstance(child, s.Comma) and (declaration := _without_first(child)):
            return declaration
        return s.ExpressionStatement(child, child.span, getattr(child, "depth", 0))

    def declaration(self, children: list[Any]) -> s.Declaration:
        qualifiers, type_, declarators = children
        type_ = as_type(type_)
        span = _join(type_.span, declarators[-1].name.span)
        depth = self.deeper(span, *[declarator.value for declarator in declarators])
        return s.Declaration(qualifiers or s.PLAIN, type_, declarators, span, depth)

    def local_struct(self, children: list[Any]) -> s.Declaration:
        qualifiers, type_, declarators = children
        return s.Declaration(qualifiers or s.PLAIN, type_, declarators or (), type_.span)

    def if_(self, children: list[Any]) -> s.IfStatement:
        keyword, condition, then, *rest = children
        span = keyword.span
        then, otherwise = self.body(then, span), self.as_statement(rest[0]) if rest else None
        return s.IfStatement(condition, then, otherwise, span, self.deeper(span, condition, then, otherwise))

    def body(self, child: Any, span: Span) -> Any:
        return s.Compound((), span, 0) if child is None else self.as_statement(child)

    def for_(self, children: list[Any]) -> s.ForStatement:
        keyword, init, condition, step, body = children
        span = keyword.span
        body, init = self.body(body, span), self.as_statement(init)
        return s.ForStatement(init, condition, step, body, span, self.deeper(span, init, condition, step, body))

    def while_(self, children: list[Any]) -> s.WhileStatement:
        keyword, condition, body = children
        body = self.body(body, keyword.span)
        return s.WhileStatement(condition, body, keyword.span, self.deeper(keyword.span, condition, body))

    def do_(self, children: list[Any]) -> s.DoStatement:
        keyword, body, condition = children
        body = self.body(body, keyword.span)
        return s.DoStatement(body, condition, keyword.span, self.deeper(keyword.span, condition, body))

    def switch_(self, children: list[Any]) -> s.SwitchStatement:
        keyword, value, body = children
        return s.SwitchStatement(value, body, keyword.span, self.deeper(keyword.span, value, body))

    def case(self, children: list[Any]) -> s.Label:
        return s.Label(children[1], children[0].span)

    def default(self, children: list[Any]) -> s.Label:
        return s.Label(None, children[0].span)

    def jump(self, children: list[Any]) -> s.Jump:
        token, value = children if len(children) > 1 else (children[0], None)
        span = _join(token.span, value.span) if value is not None else token.span
        return s.Jump(token.text, value, span, self.deeper(token.span, value))

    return_ = break_ = continue_ = discard_ = jump

    # Expressions

    def comma(self, children: list[Any]) -> s.Comma:
        span = _join(children[0].span, children[-1].span)
        return s.Comma(tuple(children), span, self.deeper(span, *children))

    def assign(self, children: list[Any]) -> s.Assignment:
        target, op, value = children
        span = _join(target.span, value.span)
        return s.Assignment(target, op.text[:-1], value, span, self.deeper(span, target, value))

    def step_before(self, children: list[Any]) -> s.Assignment:
        token, target = children
        span = _join(token.span, target.span)
        return s.Assignment(target, token.text[0], None, span, self.deeper(span, target))

    def step_after(self, children: list[Any]) -> s.Assignment:
        target, token = children
        span = _join(target.span, token.span)
        return s.Assignment(target, token.text[0], None, span, self.deeper(span, target), True)

    def binary(self, children: list[Any]) -> Any:
        """Groups `unary (operator unary)*` by precedence."""
        operands: list[Any] = [children[0]]
        operators: list[str] = []

        def reduce() -> None:
            right, left, op = operands.pop(), operands.pop(), operators.pop()
            span = _join(left.span, right.span)
            operands.append(s.Infix(op, left, right, span, self.deeper(span, left, right)))

        for index in range(1, len(children), 2):
            op = children[index].text
            while operators and PRECEDENCE[operators[-1]] >= PRECEDENCE[op]:
                reduce()
            operators.append(op)
            operands.append(children[index + 1])
        while operators:
            reduce()
        return operands[0]

    def conditional(self, children: list[Any]) -> s.Conditional:
        condition, yes, no = children
        span = _join(condition.span, no.span)
        return s.Conditional(condition, yes, no, span, self.deeper(span, condition, yes, no))

    def prefix(self, children: list[Any]) -> s.Prefix:
        token, operand = children
        span = _join(token.span, operand.span)
        return s.Prefix(token.text, operand, span, self.deeper(span, operand))

    def index(self, children: list[Any]) -> s.IndexOf:
        value, index, end = children
        span = _join(value.span, end.span)
        index = s.Unsized(end.span) if index is None else index
        return s.IndexOf(value, index, span, self.deeper(span, value, index))

    def member_of(self, children: list[Any]) -> s.MemberOf:
        value, token = children
        span = _join(value.span, token.span)
        return s.MemberOf(value, s.Name(token.text, token.span), span, self.deeper(span, value))

    def call(self, children: list[Any]) -> s.CallOf:
        callee, arguments, end = children
        if isinstance(callee, s.IndexOf):
            callee = as_type(callee)
        args: tuple[Any, ...] = arguments or ()
        if len(args) == 1 and isinstance(args[0], s.TypeName) and args[0].name == "void":
            args = ()
        span = _join(callee.span, end.span)
        return s.CallOf(callee, args, span, self.deeper(span, callee, *args))

    def arguments(self, children: list[Any]) -> tuple[s.Expression, ...]:
        return tuple(children)

    def integer(self, children: list[Any]) -> s.Number:
        return s.Number(children[0].text, False, children[0].span)

    def number(self, children: list[Any]) -> s.Number:
        return s.Number(children[0].text, True, children[0].span)

    def boolean(self, children: list[Any]) -> s.Boolean:
        return s.Boolean(children[0].text == "true", children[0].span)

    def name(self, children: list[Any]) -> s.Name:
        return s.Name(children[0].text, children[0].span)

    def type_name(self, children: list[Any]) -> s.TypeName:
        return s.TypeName(children[0].text, (), children[0].span)


def _filled(statements: list[Any]) -> list[Any]:
    """The statements of a block; an empty one behind a label stays: it makes the label's case one with statements."""
    return [
        s.Compound((), before.span, 0) if statement is None and isinstance(before, s.Label) else statement
        for before, statement in zip([None, *statements], statements, strict=False)
    ]


def _without_first(comma: s.Comma) -> s.Declaration | None:
    """`float, a = 1.0;`, which has the form of a sequence: GLSL lets a declaration begin without a name."""
    type_, *parts = map(as_type, comma.parts)
    names = [as_type(part.target) if isinstance(part, s.Assignment) and not part.op else part for part in parts]
    if not isinstance(comma.parts[0], s.TypeName) or not all(isinstance(name, s.TypeName) for name in names):
        return None
    values = [part.value if isinstance(part, s.Assignment) else None for part in parts]
    declarators = [
        s.Declarator(s.Name(name.name, name.span), name.lengths, value)
        for name, value in zip(names, values, strict=True)
    ]
    return s.Declaration(s.PLAIN, type_, tuple(declarators), comma.span, comma.depth)


def as_type(expression: Any) -> Any:
    """An expression such as `Light` or `float[3]` as a type; any other expression unchanged."""
    lengths: list[s.Expression] = []
    inner = expression
    while isinstance(inner, s.IndexOf):
        lengths.insert(0, inner.index)
        inner = inner.value
    if isinstance(inner, s.TypeName):
        return inner if not lengths else replace(inner, lengths=inner.lengths + tuple(lengths))
    if isinstance(inner, s.Name):
        return s.TypeName(inner.text, tuple(lengths), inner.span)
    return expression


def _join(first: Span, last: Span) -> Span:
    if first[0] != last[0]:
        return first  # they are in different files
    return Span(first[0], first[1], first[2], last[3], last[4])
