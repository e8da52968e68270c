"""Evaluates the tree of a random program by GLSL's rules, one lane at a time, from left to right.

It shares nothing with the compiler: a program is translated to Python closures over a frame of slots. Where GLSL leaves
the order open, operands, and `out` parameters when a call returns, go from left to right.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from glsl_builtins import WRITES, computed, writing
from glsl_places import UNSET, Place, each, element_at, inside, load, require_defined, store
from glsl_tree import COMPONENTS, NONE, Function, Macro, Node, Program
from glsl_values import Undefined, Value, construct, exact, kind, matrix_size, operation, vector_size, wrapped, zero

STEPS = 3000
"""The most rounds of loops and calls in one lane."""

Run = Callable[[list[Any]], Any]
NEXT, BREAK, CONTINUE, RETURN = range(4)


class Interpreter:
    """One program; `run` evaluates its entry."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.steps = 0
        self.globals: list[Any] = []
        self.slots = [{variable.name: index for index, variable in enumerate(program.variables)}]
        self.types = [{variable.name: variable.type for variable in program.variables}]
        self.functions: dict[str, list[tuple[Function, Callable[[list[Any]], Any], int]]] = {}
        self.size = 0
        self.values = [
            None if variable.value is None else self.expression(variable.value) for variable in program.variables
        ]
        for function in program.functions:
            self.functions.setdefault(function.name, []).append((function, *self.function(function)))

    def run(self, args: list[Value], uniforms: dict[str, Value]) -> Value:
        """The result of the entry. Raises Undefined."""
        self.steps = 0
        self.globals = [UNSET] * len(self.values)
        for index, (variable, value) in enumerate(zip(self.program.variables, self.values, strict=True)):
            if variable.qualifier == "uniform":
                self.globals[index] = uniforms[variable.name]
            elif value is not None:
                self.globals[index] = value([])
        function, body, size = self.functions[self.program.entry][-1]
        frame = [*args, *[UNSET] * (size - len(args))]
        return self.returned(function, body(frame))

    def returned(self, function: Function, outcome: tuple[int, Any]) -> Value:
        if outcome[0] != RETURN and function.result != "void":
            raise Undefined("no return")
        return require_defined(outcome[1])

    def count(self) -> None:
        self.steps += 1
        if self.steps > STEPS:
            raise Undefined("too many steps")

    # Scopes

    def declare(self, name: str, type_: str) -> int:
        self.slots[-1][name] = self.size
        self.types[-1][name] = type_
        self.size += 1
        return self.size - 1

    def find(self, name: str) -> tuple[bool, int]:
        """Whether a name is global, and its slot."""
        for depth in range(len(self.slots) - 1, -1, -1):
            if name in self.slots[depth]:
                return depth == 0, self.slots[depth][name]
        raise KeyError(name)

    def function(self, function: Function) -> tuple[Run, int]:
        self.slots.append({})
        self.types.append({})
        self.size = 0
        for param in function.params:
            self.declare(param.name, param.type)
        body = self.statements(function.body.parts)
        self.slots.pop()
        self.types.pop()
        return body, self.size

    # Expressions

    def expression(self, node: Node) -> Run:
        return getattr(self, f"_{node.kind}")(node)

    def _literal(self, node: Node) -> Run:
        value = node.data[0]
        return lambda frame: value

    def _name(self, node: Node) -> Run:
        shared, slot = self.find(node.data)
        if shared:
            return lambda frame: require_defined(self.globals[slot])
        return lambda frame: require_defined(frame[slot])

    def _brackets(self, node: Node) -> Run:
        return self.expression(node.parts[0])

    def _macro(self, node: Node) -> Run:
        return self.expression(expanded(self.program.macros[node.data], node.parts))

    def _unary(self, node: Node) -> Run:
        value, kind_ = self.expression(node.parts[0]), kind(node.type)
        if node.data == "!":
            return lambda frame: not value(frame)
        if node.data == "+":
            return value
        rounded = node.type.startswith("~")

        def scalar(x: Any) -> Any:
            if node.data == "~":
                return wrapped(kind_, ~x)
            return wrapped(kind_, -x) if kind_ != "float" else -x if rounded else exact(-x)

        return lambda frame: each(scalar, value(frame))

    def _binary(self, node: Node) -> Run:
        left, right = (self.converted(part, node) for part in node.parts)
        if node.data == "&&":
            return lambda frame: left(frame) and right(frame)
        if node.data == "||":
            return lambda frame: left(frame) or right(frame)
        compute = operation(node.data, node.type, node.parts[0].type, node.parts[1].type)
        return lambda frame: compute(left(frame), right(frame))

    def converted(self, operand: Node, node: Node) -> Run:
        """An operand with the implicit conversion that its operator needs."""
        if node.data in ("<<", ">>", "&&", "||"):
            return self.expression(operand)
        kinds = [kind(part.type) for part in node.parts if part.type not in self.program.structs]
        for wanted in ("float", "uint"):
            if wanted in kinds:
                return self.implicitly(operand, wanted)
        return self.expression(operand)

    def implicitly(self, operand: Node, wanted: str) -> Run:
        value, from_ = self.expression(operand), kind(operand.type)
        if from_ == wanted or from_ == "bool" or operand.type in self.program.structs:
            return value
        if wanted == "float":
            return lambda frame: each(lambda x: exact(float(x)), value(frame))
        return lambda frame: each(lambda x: wrapped(wanted, x), value(frame))

    def as_type(self, operand: Node, type_: str) -> Run:
        """A value that is stored in a variable of the type."""
        simple = not type_.endswith("]") and type_ not in self.program.structs
        return self.implicitly(operand, kind(type_)) if simple else self.expression(operand)

    def _choice(self, node: Node) -> Run:
        test, yes, no = self.expression(node.parts[0]), *(self.as_type(part, node.type) for part in node.parts[1:])
        return lambda frame: yes(frame) if test(frame) else no(frame)

    def _comma(self, node: Node) -> Run:
        first, second = (self.expression(part) for part in node.parts)
        return lambda frame: (first(frame), second(frame))[1]

    def _assign(self, node: Node) -> Run:
        target, type_ = self.place(node.parts[0]), node.parts[0].type
        if node.data == "=":
            value = self.as_type(node.parts[1], type_)
            return lambda frame: store(target(frame), value(frame))
        op = node.data[:-1]
        compute = operation(op, type_, type_, node.parts[1].type)
        right = self.expression(node.parts[1]) if op in ("<<", ">>") else self.implicitly(node.parts[1], kind(type_))

        def run(frame: list[Any]) -> Value:
            place = target(frame)
            old = load(place)
            return store(place, compute(old, right(frame)))

        return run

    def _step(self, node: Node) -> Run:
        target, (operator, is_prefix) = self.place(node.parts[0]), node.data
        kind_, amount = kind(node.type), 1 if operator == "++" else -1

        def scalar(x: Any) -> Any:
            return exact(x + amount) if kind_ == "float" else wrapped(kind_, x + amount)

        def run(frame: list[Any]) -> Value:
            place = target(frame)
            old = load(place)
            new = store(place, each(scalar, old))
            return new if is_prefix else old

        return run

    def _construct(self, node: Node) -> Run:
        type_ = node.type
        if type_ in self.program.structs:
            types = [field for field, _ in self.program.structs[type_]]
        elif type_.endswith("]"):
            types = [type_.partition("[")[0]] * len(node.parts)
        else:
            values = [(part.type, self.expression(part)) for part in node.parts]
            return lambda frame: construct(type_, [(part_type, value(frame)) for part_type, value in values])
        parts = [self.as_type(part, target_type) for part, target_type in zip(node.parts, types, strict=True)]
        return lambda frame: tuple([part(frame) for part in parts])

    _list = _construct

    def _builtin(self, node: Node) -> Run:
        if node.data in WRITES:
            return self.writing_builtin(node)
        wanted = "float" if any(kind(part.type) == "float" for part in node.parts) and node.data != "ldexp" else ""
        compute = computed(node.data, kind(node.parts[0].type), node.type.startswith("~"))
        if node.type.startswith("~") or node.data == "mix":
            wanted = ""
        args = [self.implicitly(part, wanted) if wanted else self.expression(part) for part in node.parts]
        return lambda frame: compute(*[arg(frame) for arg in args])

    def writing_builtin(self, node: Node) -> Run:
        first = 1 if node.data in ("modf", "frexp") else 2
        args = [self.expression(part) for part in node.parts[:first]]
        targets = [self.place(part) for part in node.parts[first:]]

        def run(frame: list[Any]) -> Value:
            values = [arg(frame) for arg in args]
            places = [target(frame) for target in targets]
            result, *written = writing(node.data, *values)
            for place, value in zip(places, written, strict=True):
                store(place, value)
            return result

        return run

    def _call(self, node: Node) -> Run:
        function, body, size = self.overload(node)
        args: list[tuple[str, Run, Run]] = []
        for param, part in zip(function.params, node.parts, strict=True):
            writes = param.direction in ("out", "inout")
            if writes:
                args.append((param.direction, self.place(part), nothing))
            else:
                args.append((param.direction, nothing, self.as_type(part, param.type)))

        def run(frame: list[Any]) -> Value:
            self.count()
            inner: list[Any] = [UNSET] * size
            places: list[tuple[int, Place]] = []
            for index, (direction, place, value) in enumerate(args):
                if direction in ("out", "inout"):
                    places.append((index, place(frame)))
                else:
                    inner[index] = value(frame)
            for index, target in places:
                inner[index] = load(target) if args[index][0] == "inout" else UNSET
            result = self.returned(function, body(inner))
            for index, target in places:
                store(target, inner[index])
            return result

        return run

    def overload(self, node: Node) -> tuple[Function, Run, int]:
        """The function with exactly the arguments' types, else the only one of its name."""
        types = [part.type for part in node.parts]
        candidates = [candidate for candidate in self.functions[node.data] if len(candidate[0].params) == len(types)]
        for candidate in candidates:
            if [param.type for param in candidate[0].params] == types:
                return candidate
        return candidates[0]

    def _swizzle(self, node: Node) -> Run:
        value = self.expression(node.parts[0])
        indices = [COMPONENTS[letter] for letter in node.data]
        if len(indices) == 1:
            index = indices[0]
            return lambda frame: value(frame)[index]
        return lambda frame: (lambda v: tuple([v[i] for i in indices]))(value(frame))

    def _member(self, node: Node) -> Run:
        value, index = self.expression(node.parts[0]), self.field(node)
        return lambda frame: require_defined(value(frame)[index])

    def field(self, node: Node) -> int:
        return [name for _, name in self.program.structs[node.parts[0].type]].index(node.data)

    def _index(self, node: Node) -> Run:
        value, index = self.expression(node.parts[0]), self.expression(node.parts[1])
        return lambda frame: require_defined(element_at(value(frame), index(frame)))

    def _length(self, node: Node) -> Run:
        type_ = node.parts[0].type
        length = int(type_.partition("[")[2][:-1]) if type_.endswith("]") else vector_size(type_) or matrix_size(type_)
        return lambda frame: length

    # Places

    def place(self, node: Node) -> Callable[[list[Any]], Place]:
        if node.kind == "name":
            shared, slot = self.find(node.data)
            if shared:
                return lambda frame: (self.globals, slot, ())
            return lambda frame: (frame, slot, ())
        if node.kind in ("brackets", "macro"):
            return self.place(node.parts[0])
        base = self.place(node.parts[0])
        if node.kind == "member":
            field = self.field(node)
            return lambda frame: inside(base(frame), field)
        if node.kind == "swizzle":
            indices: Any = tuple(COMPONENTS[letter] for letter in node.data)
            part = indices[0] if len(indices) == 1 else indices
            return lambda frame: inside(base(frame), part)
        assert node.kind == "index", node.kind
        index = self.expression(node.parts[1])
        return lambda frame: (lambda place: inside(place, index(frame)))(base(frame))

    # Statements

    def statements(self, nodes: list[Node]) -> Run:
        steps = [self.statement(node) for node in nodes]

        def run(frame: list[Any]) -> tuple[int, Any]:
            for step in steps:
                outcome = step(frame)
                if outcome[0]:
                    return outcome
            return NEXT, None

        return run

    def scoped(self, nodes: list[Node]) -> Run:
        self.slots.append({})
        self.types.append({})
        run = self.statements(nodes)
        self.slots.pop()
        self.types.pop()
        return run

    def statement(self, node: Node) -> Run:
        return getattr(self, f"_run_{node.kind}")(node)

    def _run_block(self, node: Node) -> Run:
        return self.scoped(node.parts)

    def _run_empty(self, node: Node) -> Run:
        return lambda frame: (NEXT, None)

    _run_none = _run_empty

    def _run_break(self, node: Node) -> Run:
        return lambda frame: (BREAK, None)

    def _run_continue(self, node: Node) -> Run:
        return lambda frame: (CONTINUE, None)

    def _run_return(self, node: Node) -> Run:
        if not node.parts:
            return lambda frame: (RETURN, None)
        value = self.as_type(node.parts[0], node.type)
        return lambda frame: (RETURN, value(frame))

    def _run_do_expression(self, node: Node) -> Run:
        value = self.expression(node.parts[0])

        def run(frame: list[Any]) -> tuple[int, Any]:
            value(frame)
            return NEXT, None

        return run

    def _run_declare(self, node: Node) -> Run:
        runs = []
        for name, part in zip(node.data[1], node.parts, strict=True):
            value = None if part.kind == NONE else self.as_type(part, node.type)
            runs.append((self.declare(name, node.type), value))

        def run(frame: list[Any]) -> tuple[int, Any]:
            for slot, value in runs:
                frame[slot] = value(frame) if value else self.unset(node.type)
            return NEXT, None

        return run

    def unset(self, type_: str) -> Value:
        """A value whose scalars and vectors have none yet, so that parts can be stored one by one."""
        simple = type_ not in self.program.structs and not type_.endswith("]")
        if simple:
            return UNSET
        return each(lambda _: UNSET, zero(type_, self.program.structs))

    def _run_if(self, node: Node) -> Run:
        test = self.expression(node.parts[0])
        yes = self.scoped([node.parts[1]])
        no = self.scoped(node.parts[2:])
        return lambda frame: yes(frame) if test(frame) else no(frame)

    def loop(self, test: Run, body: Run, step: Run, body_first: bool) -> Run:
        def run(frame: list[Any]) -> tuple[int, Any]:
            is_first = body_first
            while is_first or test(frame):
                is_first = False
                self.count()
                outcome = body(frame)
                if outcome[0] == BREAK:
                    break
                if outcome[0] == RETURN:
                    return outcome
                step(frame)
            return NEXT, None

        return run

    def _run_for(self, node: Node) -> Run:
        self.slots.append({})
        self.types.append({})
        start = self.statement(node.parts[0])
        test = always if node.parts[1].kind == NONE else self.expression(node.parts[1])
        step = nothing if node.parts[2].kind == NONE else self.expression(node.parts[2])
        run = self.loop(test, self.scoped([node.parts[3]]), step, body_first=False)
        self.slots.pop()
        self.types.pop()
        return lambda frame: (start(frame), run(frame))[1]

    def _run_while(self, node: Node) -> Run:
        return self.loop(self.expression(node.parts[0]), self.scoped([node.parts[1]]), nothing, body_first=False)

    def _run_do(self, node: Node) -> Run:
        body = self.scoped([node.parts[0]])
        return self.loop(self.expression(node.parts[1]), body, nothing, body_first=True)

    def _run_switch(self, node: Node) -> Run:
        selector = self.expression(node.parts[0])
        targets: dict[Any, int] = {}
        default = len(node.parts) - 1
        self.slots.append({})
        self.types.append({})
        bodies = []
        for index, case in enumerate(node.parts[1:]):
            for label in case.data:
                if label is None:
                    default = index
                else:
                    targets[self.expression(label)([])] = index
            bodies.append(self.statements(case.parts))
        self.slots.pop()
        self.types.pop()

        def run(frame: list[Any]) -> tuple[int, Any]:
            for body in bodies[targets.get(selector(frame), default) :]:
                outcome = body(frame)
                if outcome[0] == BREAK:
                    break
                if outcome[0]:
                    return outcome
            return NEXT, None

        return run


def nothing(frame: list[Any]) -> Any:
    """Nothing."""


def always(frame: list[Any]) -> bool:
    """True."""
    return True


def expanded(macro: Macro, args: list[Node]) -> Node:
    """The body of a macro with its arguments in place of its parameters."""

    def copied(node: Node) -> Node:
        if node.kind == "hole":
            return args[macro.params.index(node.data)]
        return Node(node.kind, node.type, [copied(part) for part in node.parts], node.data)

    return copied(macro.body)
