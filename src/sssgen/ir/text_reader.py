"""Reads the IR's text form, which `ir.text` describes and prints."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isfinite

from sssgen.ir import nodes as ir
from sssgen.ir.memory_operations import MEMORY
from sssgen.ir.rules import inferred
from sssgen.ir.types import BOOL, BY_NAME, FLOAT, INT, UINT, VOID, Array, Field, Struct, Type


class TextError(ValueError):
    """A text that is not a module, with the 1-based position of the fault."""

    def __init__(self, message: str, line: int, column: int) -> None:
        super().__init__(f"{line}:{column}: {message}")
        self.message, self.line, self.column = message, line, column


def read_module(text: str) -> ir.Module:
    """The module in the text form. Raises TextError."""
    return _Reader(text).module()


_TOKEN = re.compile(
    r"""(?P<space>\s+|//[^\n]*)
    | (?P<span>@\d+:\d+:\d+-\d+(?::\d+)?)
    | (?P<number>-?\d+(?:\.\d+)?(?:e[+-]?\d+)?u?)
    | (?P<name>\$?[A-Za-z_]\w*)
    | (?P<text>"(?:[^"\\\n]|\\["\\]|\\[0-9a-f]{1,6};)*")
    | (?P<op>(?:<<|>>|[-+*/%&|^])=|&&|\|\||\^\^|==|!=|<=|>=|<<|>>|[-+*/%&|^<>!~?:=.,;()\[\]{}])""",
    re.VERBOSE | re.ASCII,
)
_MAX_NUMBER = 400
"""The longest number, and the longest span; the largest float32 has 39 digits."""

_MAX_MESSAGE = 500
"""The longest message, as it may quote a name."""

_ESCAPE = re.compile(r'\\(["\\]|[0-9a-f]+;)')


class _Reader:
    """Reads by recursive descent. Functions' bodies are read last, when the results of all functions are known."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.tokens: list[tuple[str, str, int]] = []
        self.next = 0
        self.files: dict[str, str] = {}
        self.types: dict[str, Type] = dict(BY_NAME)
        self.globals: dict[str, Type] = {}
        self.locals: dict[str, Type] = {}
        self.results: dict[str, Type] = {}
        self.workgroup: tuple[int, ...] = ()
        position = 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                raise self.error(f"{text[position]!r} is unexpected here", position)
            if match.lastgroup in ("number", "span") and len(match.group()) > _MAX_NUMBER:
                raise self.error("this number is too long", position)
            if match.lastgroup != "space":
                self.tokens.append((str(match.lastgroup), match.group(), position))
            position = match.end()
        self.tokens.append(("end", "", len(text)))

    def error(self, message: str, position: int) -> TextError:
        line = self.text.count("\n", 0, position) + 1
        return TextError(message[:_MAX_MESSAGE], line, position - self.text.rfind("\n", 0, position))

    def fail(self, message: str, back: int = 0) -> TextError:
        """An error at the next token, or at one before it."""
        return self.error(message, self.tokens[max(0, self.next - back)][2])

    # Tokens

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[min(self.next + ahead, len(self.tokens) - 1)][1]

    def take(self, text: str) -> bool:
        """Consumes the next token if it is this one."""
        matches = self.peek() == text
        self.next += matches
        return matches

    def expect(self, text: str) -> None:
        if not self.take(text):
            raise self.fail(f"'{text}' is expected here, not '{self.peek()}'")

    def kind(self, kind: str) -> str:
        """Consumes the next token, which must be of this kind."""
        actual, text, _ = self.tokens[self.next]
        if actual != kind:
            raise self.fail(f"a {kind} is expected here, not '{text}'")
        self.next += 1
        return text

    def name(self) -> str:
        if self.peek().startswith("$"):
            raise self.fail("'$' is not part of a declared name")
        return self.kind("name")

    def string(self) -> str:
        def character(match: re.Match[str]) -> str:
            code = match[1]
            if code in '"\\':
                return code
            if int(code[:-1], 16) > 0x10FFFF:
                raise self.fail(f"there is no character {code[:-1]}", 1)
            return chr(int(code[:-1], 16))

        return _ESCAPE.sub(character, self.kind("text")[1:-1])

    def number(self) -> float:
        text = self.kind("number")
        value = float(text.rstrip("u"))
        if not isfinite(value):
            raise self.fail(f"{text} is not finite", 1)
        return value

    def span(self) -> ir.Span:
        if self.tokens[self.next][0] != "span":
            return ir.NOWHERE
        file, line, start, *end = self.kind("span")[1:].replace("-", ":").split(":")
        if file not in self.files:
            raise self.fail(f"there is no file {file}", 1)
        return ir.Span(self.files[file], int(line), int(start), int(end[0] if end[1:] else line), int(end[-1]))

    def type(self) -> Type:
        name = self.name()
        if name not in self.types:
            raise self.fail(f"there is no type '{name}'", 1)
        return self.array_of(self.types[name])

    def array_of(self, element: Type) -> Type:
        if not self.take("["):
            return element
        length = 0 if self.peek() == "]" else int(self.number())
        self.expect("]")
        return Array(self.array_of(element), length)

    def quantity(self) -> str:
        return self.name() if self.take(":") else ""

    # Declarations

    def module(self) -> ir.Module:
        declarations: dict[str, list[object]] = {
            "struct": [],
            "const": [],
            "uniform": [],
            "function": [],
            "variable": [],
        }
        bodies: dict[int, int] = {}
        try:
            while self.take("file"):
                number = self.kind("number")
                self.files[number] = self.string()
            while self.tokens[self.next][0] != "end":
                doc = [self.string()] if self.take("doc") else []
                while self.tokens[self.next][0] == "text":
                    doc.append(self.string())
                keyword = self.kind("name")
                if keyword == "workgroup":
                    self.workgroup = tuple([int(self.number()) for _ in range(3)])
                    continue
                if keyword not in declarations:
                    raise self.fail(f"a declaration is expected here, not '{keyword}'", 1)
                read = getattr(self, keyword)
                declarations[keyword].append(read("\n".join(doc), self.span()))
                if keyword == "function" and not self.take("slot"):
                    bodies[len(declarations[keyword]) - 1] = self.next
                    self.skip_block()
            functions: list[ir.Function] = declarations["function"]  # type: ignore[assignment]  # what `function` returns
            for index, start in bodies.items():
                function, self.next = functions[index], start
                self.locals = {param.name: param.type for param in function.params}
                functions[index] = function._replace(body=self.block())
        except RecursionError:
            raise self.fail("nested too deeply") from None
        module = ir.Module(*(tuple(of_one_kind) for of_one_kind in declarations.values()))  # type: ignore[arg-type]  # its fields, in order
        return module._replace(workgroup=self.workgroup)

    def skip_block(self) -> None:
        self.expect("{")
        depth = 1
        while depth:
            depth += (self.peek() == "{") - (self.peek() == "}")
            if self.tokens[self.next][0] == "end":
                raise self.fail("a '}' is missing")
            self.next += 1

    def struct(self, doc: str, span: ir.Span) -> ir.StructDecl:
        name, fields = self.name(), []
        self.expect("{")
        while not self.take("}"):
            fields.append(Field(type=self.type(), name=self.name(), quantity=self.quantity()))
            self.expect(";")
        self.types[name] = Struct(name, tuple(fields))
        return ir.StructDecl(self.types[name], doc, span)

    def const(self, doc: str, span: ir.Span) -> ir.Constant:
        type_, name = self.type(), self.name()
        self.expect("=")
        self.globals[name] = type_
        return ir.Constant(name, type_, self.expr(), span)

    def uniform(self, doc: str, span: ir.Span) -> ir.Uniform:
        type_, name, quantity = self.type(), self.name(), self.quantity()
        self.globals[name] = type_
        default = []
        if self.take("="):
            self.expect("(")
            default.append(self.number())
            while self.take(","):
                default.append(self.number())
            self.expect(")")
        return ir.Uniform(name, type_, tuple(default), self.hints(), quantity, doc, span)

    def variable(self, doc: str, span: ir.Span) -> ir.Variable:
        storage, type_, name = self.name(), self.type(), self.name()
        values: dict[str, float | str] = {
            "builtin": "", "interpolation": "", "location": -1.0, "access": "", "layout": ""
        }  # fmt: skip
        for hint, args in self.hints():
            if hint not in values or len(args) != 1 or type(args[0]) is not type(values[hint]):
                raise self.fail(f"a variable has no hint '{hint}'", 1)
            values[hint] = args[0]
        value = self.expr() if self.take("=") else None
        self.globals[name] = type_
        builtin, interpolation, location, access, layout = values.values()
        return ir.Variable(
            name, type_, storage, value, str(builtin), str(interpolation), int(location), doc, span, str(access),
            str(layout),
        )  # fmt: skip

    def hints(self) -> tuple[tuple[str, tuple[float | str, ...]], ...]:
        hints = []
        if self.take("["):
            hints.append(self.hint())
            while self.take(","):
                hints.append(self.hint())
            self.expect("]")
        return tuple(hints)

    def hint(self) -> tuple[str, tuple[float | str, ...]]:
        name, args = self.name(), []
        self.expect("(")
        while not self.take(")"):
            args.append(self.string() if self.tokens[self.next][0] == "text" else self.number())
            if self.peek() != ")":
                self.expect(",")
        return name, tuple(args)

    def function(self, doc: str, span: ir.Span) -> ir.Function:
        result, name, params = self.type(), self.name(), []
        self.expect("(")
        while not self.take(")"):
            direction, place = self.name(), self.span()
            type_, param = self.type(), self.name()
            quantity = self.quantity()
            passes = self.name() if self.take("passes") else ""
            params.append(ir.Param(param, type_, direction, quantity, place, passes))
            if self.peek() != ")":
                self.expect(",")
        function = ir.Function(name, tuple(params), result, self.quantity(), None, doc, span)
        self.results[function.key] = result
        return function

    # Statements

    def block(self) -> ir.Block:
        self.expect("{")
        stmts: list[ir.Stmt] = []
        while not self.take("}"):
            stmts.append(self.stmt())
        return tuple(stmts)

    def stmt(self) -> ir.Stmt:
        keyword = self.name()
        span = self.span()
        stmt: ir.Stmt
        if keyword == "if":
            condition = self.expr()
            self.expect("then")
            then = self.block()
            return ir.If(condition, then, self.block() if self.take("else") else (), span)
        if keyword == "while":
            condition = self.expr()
            self.expect("do")
            return ir.While(condition, self.block(), span)
        if keyword == "for":
            return self.loop(span)
        if keyword == "var":
            type_, name = self.type(), self.name()
            stmt = ir.Declare(name, type_, self.expr() if self.take("=") else None, span)
            self.locals[name] = type_
        elif keyword == "set":
            target, op = self.expr(), self.kind("op")
            if op[-1] != "=" or op in ("==", "!=", "<=", ">="):
                raise self.fail(f"an assignment is expected here, not '{op}'", 1)
            stmt = ir.Assign(target, op[:-1], self.expr(), span)
        elif keyword == "call":
            stmt = ir.Evaluate(self.expr(), span)
        elif keyword == "memory":
            stmt = self.memory(span)
        elif keyword == "assume":
            stmt = ir.Assume(self.expr(), span)
        elif keyword == "return":
            stmt = ir.Return(None if self.peek() == ";" else self.expr(), span)
        elif keyword in _JUMPS:
            stmt = _JUMPS[keyword](span)
        else:
            raise self.fail(f"a statement is expected here, not '{keyword}'", 1)
        self.expect(";")
        return stmt

    def memory(self, span: ir.Span) -> ir.MemoryOperation:
        name = self.name()
        if name not in MEMORY:
            raise self.fail(f"there is no operation '{name}'", 1)
        args = self.list("(", ")")
        if self.peek() != "-":
            return ir.MemoryOperation(name, args, None, span)
        self.expect("-")
        self.expect(">")
        return ir.MemoryOperation(name, args, self.expr(), span)

    def loop(self, span: ir.Span) -> ir.For:
        self.expect("(")
        init = None if self.take(";") else self.stmt()
        condition = None if self.peek() == ";" else self.expr()
        self.expect(";")
        step = None if self.take(";") else self.stmt()
        self.expect(")")
        return ir.For(init, condition, step, self.block(), span)

    # Expressions

    def expr(self) -> ir.Expr:
        kind, text, _ = self.tokens[self.next]
        self.next += 1
        expr: ir.Expr
        if kind == "number":
            expr = self.literal(text)
        elif text in ("true", "false"):
            expr = ir.Literal(BOOL, text == "true", ir.NOWHERE)
        elif text == "(":
            expr = self.operation()
        elif kind == "name" and text.startswith("$"):
            expr = self.of_module(text[1:])
        elif kind == "name" and (self.peek() == "{" or (self.peek() == "[" and self.peek(3) == "{")):
            self.next -= 1
            expr = ir.Construct(self.type(), self.list("{", "}"), ir.NOWHERE)
        elif kind == "name" and self.peek() == "(":
            expr = self.infer(ir.Intrinsic(VOID, text, self.list("(", ")"), ir.NOWHERE), text)
        elif kind == "name":
            expr = ir.Local(self.type_of(self.locals, text), text, ir.NOWHERE)
        else:
            raise self.fail(f"an expression is expected here, not '{text}'", 1)
        expr = expr._replace(span=self.span())
        while self.peek() in (".", "["):
            if self.take("."):
                name = self.name()
                is_struct = isinstance(expr.type, Struct)
                expr = (ir.Member if is_struct else ir.Swizzle)(VOID, expr, name, ir.NOWHERE)
                expr = self.infer(expr, f".{name}")
            else:
                self.expect("[")
                expr = self.infer(ir.Index(VOID, expr, self.expr(), ir.NOWHERE), "an index")
                self.expect("]")
            expr = expr._replace(span=self.span())
        return expr

    def literal(self, text: str) -> ir.Literal:
        if text.endswith("u"):
            return ir.Literal(UINT, int(text[:-1]), ir.NOWHERE) if text[:-1].isdigit() else self.no_number(text)
        if text.lstrip("-").isdigit():
            return ir.Literal(INT, int(text), ir.NOWHERE)
        return ir.Literal(FLOAT, float(text), ir.NOWHERE) if isfinite(float(text)) else self.no_number(text)

    def no_number(self, text: str) -> ir.Literal:
        raise self.fail(f"{text} is not a number", 1)

    def operation(self) -> ir.Expr:
        """The expression after an opening parenthesis: a negation, a binary operator, or a choice."""
        if self.peek() in ("-", "!", "~"):
            op = self.kind("op")
            return self.close(ir.Unary(VOID, op, self.expr(), ir.NOWHERE), op)
        left = self.expr()
        op = self.kind("op")
        if op == "?":
            yes = self.expr()
            self.expect(":")
            return self.close(ir.Select(VOID, left, yes, self.expr(), ir.NOWHERE), op)
        return self.close(ir.Binary(VOID, op, left, self.expr(), ir.NOWHERE), op)

    def close(self, expr: ir.Expr, op: str) -> ir.Expr:
        expr = self.infer(expr, f"'{op}'")
        self.expect(")")
        return expr

    def of_module(self, name: str) -> ir.Expr:
        if self.peek() != "(":
            return ir.Global(self.type_of(self.globals, name), name, ir.NOWHERE)
        args = self.list("(", ")")
        key = ir.function_key(name, [arg.type for arg in args])
        return ir.Call(self.type_of(self.results, key), key, args, ir.NOWHERE)

    def type_of(self, among: dict[str, Type], name: str) -> Type:
        if name not in among:
            raise self.fail(f"'{name}' is not declared", 1)
        return among[name]

    def infer(self, expr: ir.Expr, subject: str) -> ir.Expr:
        """The expression with the type that follows from its operands."""
        type_ = inferred(expr)
        if type_ is None:
            raise self.fail(f"{subject} is not defined for these operands", 1)
        return expr._replace(type=type_)

    def list(self, opening: str, closing: str) -> tuple[ir.Expr, ...]:
        exprs: list[ir.Expr] = []
        self.expect(opening)
        while not self.take(closing):
            exprs.append(self.expr())
            if self.peek() != closing:
                self.expect(",")
        return tuple(exprs)


_JUMPS: dict[str, Callable[[ir.Span], ir.Stmt]] = {"break": ir.Break, "continue": ir.Continue, "discard": ir.Discard}
