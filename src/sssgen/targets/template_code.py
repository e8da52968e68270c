"""Translates Jinja templates to Python functions, which the cache keeps: rendering then needs no Jinja at all.

Importing Jinja takes longer than all the rest of an emit. The functions follow its rules for the part of the language
that templates of shaders use; a template with anything else is left to Jinja itself. Whatever is undefined raises
LookupError or AttributeError here, and the caller then has Jinja render the template, and say what is wrong with it.
"""

from __future__ import annotations

from collections.abc import Iterable

from jinja2 import Environment, TemplateError, nodes

_OPERATORS = {
    "eq": "==", "ne": "!=", "gt": ">", "gteq": ">=", "lt": "<", "lteq": "<=", "in": "in", "notin": "not in",
    "Add": "+", "Sub": "-", "Mul": "*", "Div": "/", "FloorDiv": "//", "Mod": "%", "Pow": "**", "And": "and", "Or": "or",
}  # fmt: skip
_FILTERS = {"indent", "join", "length", "list", "lower", "map", "replace", "title", "trim", "upper"}


def translate(environment: Environment, sources: dict[str, str]) -> str:
    """The text of a Python module that defines TEMPLATES: a template's name → its function, for those it can."""
    parts: list[str] = []
    names: list[str] = []
    for name, source in sources.items():
        try:
            text = _Translator(f"template_{len(names)}").template(environment.parse(source))
        except (TemplateError, _Unsupported):
            continue
        parts.append(text)
        names.append(f"    {name!r}: template_{len(names)},\n")
    return "\n".join([*parts, "TEMPLATES.update({\n" + "".join(names) + "})\n"])


class _Unsupported(Exception):
    """Something that is left to Jinja."""


class _Translator:
    """Writes one template's function. A scope's variables are a dict, `v0` for the template's own."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.lines: list[str] = []
        self.depth = 0
        self.scope = 0
        self.out = 0

    def template(self, template: nodes.Template) -> str:
        """`def NAME(v): …` that gives the text and, for imports, the template's variables."""
        self.line(f"def {self.name}(v):")
        self.depth = 1
        self.line("v0 = {**v}; o0 = []")
        self.block(template.body)
        self.line("return ''.join(o0), v0")
        return "\n".join([*self.lines, ""])

    def line(self, text: str) -> None:
        self.lines.append("    " * self.depth + text)

    def block(self, body: Iterable[nodes.Node]) -> None:
        """Statements."""
        for node in body:
            method = getattr(self, f"write_{type(node).__name__}", None)
            if method is None or self.depth > 60:
                raise _Unsupported(type(node).__name__)
            method(node)

    def inner(self, body: Iterable[nodes.Node]) -> None:
        """Statements one level deeper."""
        self.depth += 1
        self.line("pass")
        self.block(body)
        self.depth -= 1

    # Statements

    def write_Output(self, output: nodes.Output) -> None:
        for node in output.nodes:
            text = repr(node.data) if isinstance(node, nodes.TemplateData) else f"str({self.expr(node)})"
            self.line(f"o{self.out}.append({text})")

    def write_If(self, node: nodes.If) -> None:
        self.line(f"if {self.expr(node.test)}:")
        self.inner(node.body)
        for other in node.elif_:
            self.line(f"elif {self.expr(other.test)}:")
            self.inner(other.body)
        if node.else_:
            self.line("else:")
            self.inner(node.else_)

    def write_For(self, node: nodes.For) -> None:
        if node.else_ or node.recursive:
            raise _Unsupported("for")
        outer, self.scope = self.scope, self.scope + 1
        scope = f"v{self.scope}"
        self.line(f"{scope} = {{**v{outer}}}")
        target = self.target(node.target)
        chosen = f"[0 for {target} in [x] if {self.expr(node.test)}]" if node.test is not None else "True"
        self.scope = outer
        items = self.expr(node.iter)
        self.scope += 1
        self.line(f"i{self.scope} = [x for x in {items} if {chosen}]")
        self.line(f"for n{self.scope}, x in enumerate(i{self.scope}):")
        self.depth += 1
        self.line(f"{scope} = {{**v{outer}, 'loop': loop(n{self.scope}, i{self.scope})}}")
        self.line(f"{target} = x")
        self.block(node.body)
        self.depth -= 1
        self.scope = outer

    def write_Assign(self, node: nodes.Assign) -> None:
        self.line(f"{self.target(node.target)} = {self.expr(node.node)}")

    def write_Macro(self, node: nodes.Macro) -> None:
        names = [argument.name for argument in node.args]
        outer, before = self.scope, self.out
        self.scope = self.out = scope = self.scope + 1
        self.line("def macro(*given, **named):")
        self.depth += 1
        self.line(f"b{scope} = bind({names!r}, given, named)")
        self.line(f"v{scope} = {{**v{outer}, **b{scope}}}; o{scope} = []")
        for name, default in zip(names[len(names) - len(node.defaults) :], node.defaults, strict=True):
            self.line(f"if {name!r} not in b{scope}: v{scope}[{name!r}] = {self.expr(default)}")
        self.block(node.body)
        self.line(f"return ''.join(o{scope})")
        self.depth -= 1
        self.scope, self.out = outer, before
        self.line(f"v{outer}[{node.name!r}] = macro")

    def write_FilterBlock(self, node: nodes.FilterBlock) -> None:
        outer, before = self.scope, self.out
        self.scope = self.out = self.scope + 1
        self.line(f"v{self.scope} = {{**v{outer}}}; o{self.out} = []")
        self.block(node.body)
        text = self.filtered(node.filter, f"''.join(o{self.out})")
        self.scope, self.out = outer, before
        self.line(f"o{self.out}.append(str({text}))")

    def write_Include(self, node: nodes.Include) -> None:
        if not node.with_context or node.ignore_missing:
            raise _Unsupported("include")
        self.line(f"o{self.out}.append(TEMPLATES[{self.expr(node.template)}](v{self.scope})[0])")

    def write_FromImport(self, node: nodes.FromImport) -> None:
        given = f"v{self.scope}" if node.with_context else "{}"
        names = [name if isinstance(name, tuple) else (name, name) for name in node.names]
        self.line(f"take(v{self.scope}, TEMPLATES[{self.expr(node.template)}]({given})[1], {names!r})")

    def target(self, node: nodes.Node) -> str:
        """What is assigned to."""
        if isinstance(node, nodes.Name):
            return f"v{self.scope}[{node.name!r}]"
        if isinstance(node, nodes.Tuple):
            return f"({', '.join(self.target(item) for item in node.items)},)"
        raise _Unsupported("assignment")

    # Expressions

    def expr(self, node: nodes.Node | None) -> str:
        """An expression's Python text; it can stand anywhere."""
        method = getattr(self, f"expr_{type(node).__name__}", None)
        if method is not None:
            return str(method(node))
        if isinstance(node, nodes.BinExpr):
            return f"({self.expr(node.left)} {_OPERATORS[type(node).__name__]} {self.expr(node.right)})"
        raise _Unsupported(type(node).__name__)

    def all(self, items: Iterable[nodes.Node]) -> str:
        return "".join(f"{self.expr(item)}, " for item in items)

    def expr_Const(self, node: nodes.Const) -> str:
        return f"({node.value!r})"

    def expr_Name(self, node: nodes.Name) -> str:
        return f"v{self.scope}[{node.name!r}]"

    def expr_List(self, node: nodes.List) -> str:
        return f"[{self.all(node.items)}]"

    def expr_Tuple(self, node: nodes.Tuple) -> str:
        return f"({self.all(node.items)})"

    def expr_Dict(self, node: nodes.Dict) -> str:
        return f"{{{''.join(f'{self.expr(pair.key)}: {self.expr(pair.value)}, ' for pair in node.items)}}}"

    def expr_Getattr(self, node: nodes.Getattr) -> str:
        return f"attribute({self.expr(node.node)}, {node.attr!r})"

    def expr_Getitem(self, node: nodes.Getitem) -> str:
        if isinstance(node.arg, nodes.Slice):
            bounds = (node.arg.start, node.arg.stop, node.arg.step)
            return f"{self.expr(node.node)}[{':'.join(self.expr(bound) if bound else '' for bound in bounds)}]"
        return f"{self.expr(node.node)}[{self.expr(node.arg)}]"

    def expr_Call(self, node: nodes.Call) -> str:
        return f"{self.expr(node.node)}({self.arguments(node)})"

    def arguments(self, node: nodes.Call | nodes.Filter) -> str:
        if node.dyn_args is not None or node.dyn_kwargs is not None:
            raise _Unsupported("call")
        return self.all(node.args) + "".join(f"{pair.key}={self.expr(pair.value)}, " for pair in node.kwargs)

    def expr_Filter(self, node: nodes.Filter) -> str:
        if node.name == "default":
            if len(node.args) != 1 or node.kwargs:
                raise _Unsupported("default")
            return self.optional(node.node, self.expr(node.args[0]))
        return self.filtered(node, self.expr(node.node))

    def filtered(self, node: nodes.Filter, value: str) -> str:
        if node.name not in _FILTERS:
            raise _Unsupported(node.name)
        return f"filter_{node.name}({value}, {self.arguments(node)})"

    def optional(self, node: nodes.Node | None, default: str) -> str:
        """A variable or attribute that need not be there."""
        if isinstance(node, nodes.Name):
            return f"v{self.scope}.get({node.name!r}, {default})"
        if isinstance(node, nodes.Getattr):
            return f"attribute({self.expr(node.node)}, {node.attr!r}, {default})"
        raise _Unsupported("undefined")

    def expr_Test(self, node: nodes.Test) -> str:
        if node.name not in ("defined", "undefined"):
            raise _Unsupported(node.name)
        return f"({self.optional(node.node, 'MISSING')} is {'not ' * (node.name == 'defined')}MISSING)"

    def expr_Concat(self, node: nodes.Concat) -> str:
        return f"''.join(map(str, ({self.all(node.nodes)})))"

    def expr_CondExpr(self, node: nodes.CondExpr) -> str:
        otherwise = self.expr(node.expr2) if node.expr2 is not None else "''"
        return f"({self.expr(node.expr1)} if {self.expr(node.test)} else {otherwise})"

    def expr_Compare(self, node: nodes.Compare) -> str:
        rest = " ".join(f"{_OPERATORS[part.op]} {self.expr(part.expr)}" for part in node.ops)
        return f"({self.expr(node.expr)} {rest})"

    def expr_Not(self, node: nodes.Not) -> str:
        return f"(not {self.expr(node.node)})"

    def expr_Neg(self, node: nodes.Neg) -> str:
        return f"(-{self.expr(node.node)})"
