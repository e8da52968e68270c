"""Random programs of plain GLSL: statements, functions, and declarations at file scope."""

from __future__ import annotations

from random import Random

from glsl_floats import Expressions
from glsl_names import FUNCTIONS, MACROS, TYPES
from glsl_scope import Symbol, binary, literal
from glsl_tree import NONE, Function, Macro, Node, Parameter, Program, Variable
from glsl_values import element, kind, matrix_size, vector_size

INPUTS = ("int", "int", "uint", "uint", "float", "float", "bool", "ivec2", "vec3")
"""The types of the entry's parameters."""

TYPES_OF_VARIABLES = (
    "int", "int", "int", "int", "uint", "uint", "float", "float", "bool", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3",
    "vec2", "vec3", "vec4", "bvec2", "bvec3", "mat2", "mat3", "mat4", "int[3]", "uint[2]", "float[4]", "vec2[2]",
    "ivec3[2]", "bool[2]", "mat2[2]",
)  # fmt: skip


class Programs(Expressions):
    """Makes one program; `make` returns it."""

    def __init__(self, random: Random, used_globals: set[str]) -> None:
        super().__init__(random)
        self.used_globals = used_globals
        self.loops = 0
        self.switches = 0
        self.result = ""
        self.rounds = 1
        """How often the statement here may run, at most."""

    def make(self, entry: str) -> Program:
        program = self.program
        program.entry, program.smooth = entry, self.chance(18)
        self.constants = set()
        for _ in range(self.random.choice((0, 0, 0, 1, 2))):
            self.struct()
        for _ in range(self.random.choice((0, 0, 1, 2))):
            self.file_constant()
        for _ in range(self.random.choice((0, 0, 0, 1, 2))):
            self.macro()
        for _ in range(self.random.choice((0, 0, 0, 1, 2))):
            self.file_variable()
        for _ in range(self.random.choice((0, 0, 0, 1))):
            self.uniform()
        for _ in range(self.random.choice((0, 0, 1, 1, 2))):
            self.function()
        self.entry(entry)
        return program

    # File scope

    def file_name(self, names: tuple[str, ...]) -> str:
        name = self.new_name(names)
        self.used_globals.add(name)
        return name

    def type(self, simple: bool = False) -> str:
        types = list(TYPES_OF_VARIABLES) + ([] if simple else [name for name in self.program.structs for _ in range(4)])
        if simple:
            types = [type_ for type_ in types if "[" not in type_]
        return self.random.choice(types)

    def struct(self) -> None:
        name = self.file_name(TYPES)
        fields: list[tuple[str, str]] = []
        for _ in range(self.random.randint(1, 4)):
            field = self.random.choice(self.names)
            if all(field != other for _, other in fields) and field not in self.program.macros:
                fields.append((self.type(), field))
        self.program.structs[name] = fields or [("int", "x")]
        self.scopes[0][name] = Symbol(name, "", False)

    def constant_value(self, type_: str) -> Node:
        self.constant = True
        self.quiet += 1
        value = self.value(type_, 2)
        self.constant = False
        self.quiet -= 1
        return value

    def file_constant(self) -> None:
        type_ = self.type()
        value = self.constant_value(type_)
        name = self.file_name(self.names)
        self.program.variables.append(Variable(type_, name, value, "const"))
        self.declare(name, type_, writable=False)
        self.constants = {*self.constants, name}

    def file_variable(self) -> None:
        type_ = self.type()
        value = self.constant_value(type_) if self.chance(70) else None
        name = self.file_name(self.names)
        self.program.variables.append(Variable(type_, name, value, ""))
        self.declare(name, type_)

    def uniform(self) -> None:
        type_ = self.type(simple=True)
        name = self.file_name(self.names)
        self.program.variables.append(Variable(type_, name, None, "uniform"))
        self.declare(name, type_, writable=False)

    def macro(self) -> None:
        name = self.file_name(MACROS)
        type_ = self.random.choice(("int", "uint"))
        if self.chance(50):
            constants, self.constants = self.constants, set()  # where the macro is used, a name may mean something else
            body = self.constant_value(type_)
            self.constants = constants
            body = body if self.chance(30) and body.kind == "literal" else Node("brackets", type_, [body])
            params: list[str] = []
        else:
            params = self.random.choice((["x"], ["a", "b"], ["x", "selected"]))
            holes = [Node("hole", type_, [], self.random.choice(params)) for _ in range(3)]
            first = self.random.choice((holes[0], Node("brackets", type_, [holes[0]])))
            op, other = self.random.sample(("+", "*", "-", "&", "^", "|"), 2)
            body = binary(op, type_, Node("brackets", type_, [first]), Node("brackets", type_, [holes[1]]))
            body = binary(other, type_, Node("brackets", type_, [body]), Node("brackets", type_, [holes[2]]))
            body = Node("brackets", type_, [body])
        self.program.macros[name] = Macro(name, params, body)

    # Functions

    def function(self) -> None:
        name = self.new_name(FUNCTIONS)
        if self.callable and self.chance(25):
            name = self.callable[0].name
        result = self.random.choice(("int", "int", "uint", "float", "bool", "void", self.type()))
        params = self.parameters(self.random.randint(0, 4))
        types = [param.type for param in params]
        if any(
            function.name == name and [param.type for param in function.params] == types for function in self.callable
        ):
            name = self.new_name(FUNCTIONS)
        self.used_globals.add(name)
        self.scopes[0][name] = Symbol(name, "", False)
        body = self.body(params, result, self.random.randint(0, 3))
        function = Function(name, result, params, body, self.chance(15))
        self.program.functions.append(function)
        self.callable.append(function)

    def parameters(self, count: int) -> list[Parameter]:
        params: list[Parameter] = []
        self.scopes.append({})
        for _ in range(count):
            type_ = self.type()
            direction = self.random.choice(("", "", "in", "out", "inout", "inout", "const in"))
            name = self.new_name()
            self.declare(name, type_)
            params.append(Parameter(type_, name, direction))
        self.scopes.pop()
        return params

    def body(self, params: list[Parameter], result: str, size: int) -> Node:
        self.result, self.rounds = result, 1
        self.scopes.append(
            {param.name: Symbol(param.name, param.type, param.direction != "const in") for param in params}
        )
        stmts = []
        outs = [param for param in params if param.direction == "out"]
        for param in outs:  # each hides a global of its name also while it has no value
            self.scopes[-1][param.name] = Symbol(param.name, "unset", False)
        for param in outs:
            self.quiet += 1
            value = self.value(param.type, 1)
            self.scopes[-1][param.name] = Symbol(param.name, param.type, True)
            self.quiet -= 1
            target = Node("name", param.type, [], param.name)
            stmts.append(Node("do_expression", parts=[Node("assign", param.type, [target, value], "=")]))
        stmts += self.statements(size, self.random.choice((0, 1, 2)))
        if result != "void":
            stmts.append(Node("return", result, [self.stored(result, 2)]))
        self.scopes.pop()
        return Node("block", parts=stmts)

    def entry(self, name: str) -> None:
        self.scopes.append({})
        params = []
        for type_ in INPUTS:
            param = self.new_name()
            self.declare(param, type_, writable=True)
            params.append(Parameter(type_, param, ""))
        self.result, self.rounds = ("vec4" if self.program.smooth else "ivec4"), 1
        stmts = self.unset_variables()
        if self.program.smooth:
            for type_ in ("~float", "~vec3", "~float"):
                stmts.append(self.declaration(type_, 2))
        stmts += self.statements(self.random.choice((1, 2, 2, 3, 3, 4, 6)), self.random.choice((2, 2, 3)))
        if self.program.smooth:
            values = [self.smooth("~float", 3) for _ in range(4)]
            stmts.append(Node("return", "~vec4", [Node("construct", "~vec4", values, "~vec4")]))
        else:
            stmts.append(Node("return", "ivec4", [self.digest()]))
        self.scopes.pop()
        self.program.functions.append(Function(name, self.result, params, Node("block", parts=stmts)))

    def unset_variables(self) -> list[Node]:
        """Assignments to the variables at file scope that have no value."""
        assignments = []
        for variable in self.program.variables:
            if variable.value is None and not variable.qualifier:
                self.quiet += 1
                self.constant = True
                value = self.value(variable.type, 1)
                self.constant = False
                self.quiet -= 1
                if self.visible()[variable.name].type != variable.type or variable.name in self.scopes[-1]:
                    continue
                target = Node("name", variable.type, [], variable.name)
                assignments.append(Node("do_expression", parts=[Node("assign", variable.type, [target, value], "=")]))
        return assignments

    def digest(self) -> Node:
        """Four numbers of everything in scope."""
        terms: list[list[Node]] = [[], [], [], []]
        symbols = [symbol for symbol in self.visible().values() if symbol.type]
        self.random.shuffle(symbols)
        for number, symbol in enumerate(symbols[:8]):
            node = Node("name", symbol.type, [], symbol.name)
            for part in self.scalars(node)[:3]:
                terms[number % 4].append(part)
        parts = []
        for column in terms:
            total = self.integer("int", 1)
            for term in column:
                total = binary("+", "int", binary("*", "int", total, literal("int", 31)), term)
            parts.append(total)
        return Node("construct", "ivec4", parts, "ivec4")

    def scalars(self, node: Node) -> list[Node]:
        """Every number in a value, as an int."""
        type_ = node.type
        if type_ == "int":
            return [node]
        if type_ == "float":
            return [Node("construct", "int", [binary("*", "float", node, literal("float", 8.0))], "int")]
        if type_ in ("uint", "bool"):
            return [Node("construct", "int", [node], "int")]
        if type_ in self.program.structs:
            inner = [Node("member", part_type, [node], name) for part_type, name in self.program.structs[type_]]
        elif "[" in type_:
            part_type, length = element(type_)
            inner = [Node("index", part_type, [node, literal("int", index)]) for index in range(length)]
        elif size := matrix_size(type_):
            inner = [Node("index", f"vec{size}", [node, literal("int", index)]) for index in range(size)]
        else:
            inner = [Node("swizzle", kind(type_), [node], letter) for letter in "xyzw"[: vector_size(type_)]]
        return [part for child in inner for part in self.scalars(child)]

    # Statements

    def statements(self, count: int, depth: int) -> list[Node]:
        nodes: list[Node] = []
        for _ in range(count):
            nodes += self.statement(depth)
        return nodes

    def block(self, depth: int) -> Node:
        self.scopes.append({})
        stmts = self.statements(self.random.randint(1, 3), depth)
        self.scopes.pop()
        if len(stmts) == 1 and stmts[0].kind not in ("declare", "if", "switch") and self.chance(40):
            return stmts[0]
        return Node("block", parts=stmts)

    def statement(self, depth: int) -> list[Node]:
        rule = self.random.randrange(100)
        if depth > 0 and rule < 38:
            if rule < 14:
                return [self.branch(depth - 1)]
            if rule < 24:
                return self.counting_loop(depth - 1)
            if rule < 34:
                return [self.switch(depth - 1)]
            return [Node("block", parts=[self.block(depth - 1)])] if rule < 36 else [self.do_once(depth - 1)]
        if rule < 60:
            return [self.declaration(self.type(), 2)]
        if rule < 66 and (jump := self.jump()) is not None:
            return [jump]
        if rule < 72 and (call := self.call_statement()) is not None:
            return [call]
        return [self.store()]

    def store(self) -> Node:
        for _ in range(5):
            type_ = self.type() if self.chance(60) else self.random.choice(("int", "uint", "float", "bool"))
            if self.program.smooth and self.chance(20):
                type_ = self.random.choice(("~float", "~vec3"))
            place = self.target(type_)
            if place is None:
                continue
            kind_ = kind(type_)
            if kind_ in ("int", "uint") and "[" not in type_ and type_ not in self.program.structs and self.chance(15):
                step = Node("step", type_, [place], (self.random.choice(("++", "--")), self.chance(50)))
                return Node("do_expression", parts=[step])
            expression = self.assignment(place, 2)
            if self.chance(6):
                other = self.target("int")
                if other is not None:
                    expression = Node("comma", "int", [expression, self.assignment(other, 1)])
            return Node("do_expression", parts=[expression])
        return Node("empty")

    def declaration(self, type_: str, depth: int) -> Node:
        count = 1 if "[" in type_ or self.chance(80) else 2
        names, values = [], []
        is_constant = self.chance(12)
        fixed = is_constant and self.chance(50) and not type_.startswith("~")
        for _ in range(count):
            value = self.constant_value(type_) if fixed else self.stored(type_, depth)
            if value.kind == "construct" and self.chance(25) and ("[" in type_ or type_ in self.program.structs):
                value = Node("list", type_, value.parts)
            name = self.new_name()
            while name in [param for scope in self.scopes[-1:] for param in scope]:
                name = self.new_name()
            self.declare(name, type_, writable=not is_constant)
            self.constants = {*self.constants, name} if fixed else {*self.constants} - {name}
            names.append(name)
            values.append(value)
        qualifier = "const" if is_constant else self.random.choice(("",) * 12 + ("highp", "precise"))
        if qualifier == "highp" and (kind(type_) == "bool" or type_ in self.program.structs):
            qualifier = ""
        return Node("declare", type_, values, (qualifier, names))

    def call_statement(self) -> Node | None:
        visible = self.visible()
        functions = [
            function for function in self.callable if visible.get(function.name, Symbol("", "x", False)).type == ""
        ]
        if not functions:
            return None
        call = self.call_of(self.random.choice(functions), 2)
        return None if call is None else Node("do_expression", parts=[call])

    def jump(self) -> Node | None:
        options = ["return"]
        if self.loops:
            options += ["break", "continue", "break", "continue"]
        elif self.switches:
            options += ["break", "break"]
        chosen = self.random.choice(options)
        node = Node(chosen)
        if chosen == "return":
            if len(self.scopes) <= 2:
                return None
            node = Node("return", self.result)
            if self.result == "vec4" and self.program.smooth:
                node = Node("return", "~vec4", [Node("construct", "~vec4", [self.smooth("~float", 1)], "~vec4")])
            elif self.result != "void":
                node = Node("return", self.result, [self.value(self.result, 2)])
        if self.chance(12):
            return node
        return Node("if", parts=[self.boolean("bool", 2), node])

    def branch(self, depth: int) -> Node:
        parts = [self.boolean("bool", 2), self.block(depth)]
        if self.chance(50):
            parts.append(self.branch(depth) if self.chance(25) else self.block(depth))
        if len(parts) == 3 and parts[1].kind != "block":
            parts[1] = Node("block", parts=[parts[1]])
        return Node("if", parts=parts)

    def counting_loop(self, depth: int) -> list[Node]:
        self.scopes.append({})
        type_ = "uint" if self.chance(20) else "int"
        name = self.new_name()
        self.declare(name, type_, writable=False)
        start: Node = Node("declare", type_, [literal(type_, 0)], ("", [name]))
        form = self.random.randrange(100)
        if form < 62 and self.chance(15):
            other = self.new_name()
            start.data[1].append(other)
            start.parts.append(self.value(type_, 1))
            self.declare(other, type_)
        count = literal(type_, self.random.randint(1, 4))
        if self.chance(30):
            count = binary("&", type_, self.integer(type_, 1), literal(type_, 3))
        counter = Node("name", type_, [], name)
        test = binary(self.random.choice(("<", "!=")) if count.kind == "literal" else "<", "bool", counter, count)
        if self.chance(25):
            others = self.boolean("bool", 1)
            test = binary("&&", "bool", test, others) if self.chance(70) else binary("&&", "bool", others, test)
        step = Node("step", type_, [counter], ("++", self.chance(50)))
        if self.chance(15):
            step = Node("assign", type_, [counter, literal(type_, 1)], "+=")
        outer = self.loops, self.switches
        self.loops, self.switches = self.loops + 1, 0
        nodes: list[Node]
        if form < 62:
            if self.chance(20) and (place := self.target("int")) is not None:
                step = Node("comma", "int", [step, self.assignment(place, 1)])
            body = self.block(depth)
            nodes = [Node("for", parts=[start, test, step, body])]
        elif form < 72:
            body = self.block(depth)
            leave = Node("if", parts=[Node("unary", "bool", [Node("brackets", "bool", [test])], "!"), Node("break")])
            first = [leave, Node("do_expression", parts=[step])]
            body = Node("block", parts=first + (body.parts if body.kind == "block" else [body]))
            nodes = [start, Node("for", parts=[Node(NONE), Node(NONE), Node(NONE), body])]
        else:
            test = binary("<", "bool", Node("step", type_, [counter], ("++", self.chance(50))), count)
            test = test if self.chance(70) else binary("&&", "bool", test, self.boolean("bool", 1))
            body = self.block(depth)
            nodes = [start, Node("while", parts=[test, body]) if form < 88 else Node("do", parts=[body, test])]
        self.loops, self.switches = outer
        self.scopes.pop()
        return nodes if nodes[0].kind == "for" else [Node("block", parts=nodes)]

    def do_once(self, depth: int) -> Node:
        outer = self.loops, self.switches
        self.loops, self.switches = self.loops + 1, 0
        body = self.block(depth)
        self.loops, self.switches = outer
        return Node("do", parts=[body, literal("bool", False)])

    def switch(self, depth: int) -> Node:
        type_ = "uint" if self.chance(25) else "int"
        mask = self.random.choice((1, 3, 3, 7))
        selector = binary("&", type_, self.integer(type_, 2), literal(type_, mask))
        offset = 0
        if type_ == "int" and self.chance(20):
            offset = self.random.choice((1, 2, 100, -5, 0x7FFFFFF0))
            selector = binary("-", type_, selector, literal(type_, offset))
        elif self.chance(15):
            selector = self.integer(type_, 2)
        labels: list[int | None] = list(range(mask + 1))
        self.random.shuffle(labels)
        labels = labels[: self.random.randint(1, 4)]
        if self.chance(70):
            labels.insert(self.random.randint(0, len(labels)), None)
        cases = []
        self.switches += 1
        self.scopes.append({})
        position = 0
        while position < len(labels):
            take = 2 if self.chance(20) else 1
            group = labels[position : position + take]
            position += take
            names = set(self.scopes[-1])
            stmts = self.statements(self.random.randint(0, 2), depth)
            is_last = position >= len(labels)
            if is_last or self.chance(70):
                stmts.append(
                    Node("break")
                    if self.result == "void" or self.chance(88)
                    else Node("return", self.result_type(), [self.returned()])
                )
            for name in set(self.scopes[-1]) - names:  # a case must not use what another one declares
                self.scopes[-1][name] = Symbol(name, "", False)
            cases.append(
                Node(
                    "case",
                    parts=stmts,
                    data=[None if label is None else self.label(type_, label - offset) for label in group],
                )
            )
        self.scopes.pop()
        self.switches -= 1
        return Node("switch", parts=[selector, *cases])

    def result_type(self) -> str:
        return "~vec4" if self.program.smooth and self.result == "vec4" else self.result

    def returned(self) -> Node:
        if self.result_type() == "~vec4":
            return Node("construct", "~vec4", [self.smooth("~float", 1)], "~vec4")
        return self.value(self.result, 1)

    def label(self, type_: str, number: int) -> Node:
        if type_ == "int" and self.chance(12):
            return binary("+", type_, literal(type_, number - 1), literal(type_, 1))
        if type_ == "int" and number < 0:
            return Node("literal", type_, [], (number, str(number)))
        return literal(type_, number)


def programs(random: Random, count: int) -> list[Program]:
    """Programs that can stand in one text; their entries are `entry_0` and so on."""
    used: set[str] = {f"sssgen_entry_{number}" for number in range(count)}
    return [Programs(random, used).make(f"sssgen_entry_{number}") for number in range(count)]
