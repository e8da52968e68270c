"""The state of the range analysis: variables and facts at one point of the program, and the sites found so far."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple, cast

from sssgen.ir import contracts
from sssgen.ir import nodes as ir
from sssgen.ir.contracts import INTEGERS, Assumed
from sssgen.ir.formats import Format
from sssgen.ir.intervals import ANY, INF, Range, clip, rounded
from sssgen.ir.intrinsics import BUILTINS, FINITE, Guard
from sssgen.ir.types import Matrix, Sampler, Scalar, Struct, Type, kind_of
from sssgen.ir.vector_ranges import Contract, Value, length_of
from sssgen.ir.walk import written_root
from sssgen.passes.ranges.facts import Facts, Numbers
from sssgen.passes.ranges.polynomials import Polynomial
from sssgen.passes.ranges.scalar_parts import hull_of, innermost, scalar_kinds, scalars
from sssgen.passes.ranges.sites import OVERFLOW, Site
from sssgen.passes.variable_effects import effects

SUMS = OVERFLOW._replace(text=FINITE, doc="A finite number in place of infinity; 0 in place of NaN.")
"""For operations with sums of products, which may give infinity minus infinity."""


def _is_sum(node: ir.Expr) -> bool:
    if isinstance(node, ir.Intrinsic):
        return BUILTINS[node.name].overflow_is_nan
    if not isinstance(node, ir.Binary) or node.op != "*":
        return False
    types = {type(node.left.type), type(node.right.type)}
    return Matrix in types and Scalar not in types


def variable_key(target: ir.Expr) -> str | None:
    """The key of the variable that an assignment to `target` changes; None if it is none."""
    variable = written_root(target)
    if variable is None:
        return None
    return variable.name if isinstance(variable, ir.Local) else global_key(variable.name)


def global_key(name: str) -> str:
    """The key of a module variable: no local one has an @ in its name."""
    return f"@{name}"


class State(NamedTuple):
    """What is known at one point of the program."""

    env: dict[str, Value]
    """The variables by their keys; a module variable that is not in it can be any number."""
    facts: Facts

    def copy(self) -> State:
        return State(dict(self.env), self.facts.copy())


class Frame(NamedTuple):
    """The exits of the function that is being interpreted."""

    function: ir.Function
    returned: list[tuple[State, Value | None]]


class Loop:
    """A loop's exits, and what its iterations add to variables."""

    def __init__(self, trips: float) -> None:
        self.trips = trips
        self.break_states: list[State] = []
        self.continued: list[State] = []
        self.added: dict[str, dict[int, tuple[list[Range], float]]] = {}
        """A variable → each statement that adds to it: the ranges added, and how often in one iteration."""


class AnalysisState:
    """The state of an analysis, and what every part of the analysis needs."""

    def __init__(
        self, module: ir.Module, format: Format, chained: bool = True, assumed: Assumed | None = None,
        unguarded: bool = False,
    ) -> None:  # fmt: skip
        self.assumed = assumed
        self.unguarded = unguarded
        """Whether an operation that may fail has no guard: the analysis then continues as if it did not fail."""
        self.functions = {function.key: function for function in module.functions}
        self.format = format
        self.chained = chained
        """Whether the names of parameters have the meaning that they have in a chain."""
        self.floats = Range(-format.largest, format.largest)
        self.integers = {kind: Range(low, high) for kind, (low, high) in INTEGERS.items()}
        self.numbers = Numbers(format.tiny)
        self.polynomials: dict[int, Polynomial] = {}
        """Numbers that are sums and products, as polynomials of others; used where no guards are inserted."""
        self.spans: dict[int, Range] = {}
        """The hull of the ranges in which the operands of these were."""
        self.lengths: dict[int, tuple[tuple[int, ...], Range]] = {}
        """The first number of a vector in an input that is a struct or an array → all its numbers, and its length."""
        self.sites: dict[tuple[int, str], Site] = {}
        self.compounds: dict[int, ir.Binary] = {}
        self.frames: list[Frame] = []
        self.loops: list[Loop] = []
        self.globals: dict[str, Value] = {}
        self.memories = {
            global_key(variable.name) for variable in module.variables if variable.storage in ("shared", "buffer")
        }
        """The keys of what other invocations may write at any time: each read is another value."""
        self.variables = {variable.name: variable for variable in module.variables if variable.storage != "in"}
        """The module variables that functions change."""
        self.changed = {key: frozenset(map(global_key, effect.writes)) for key, effect in effects(module).items()}
        """A function's key → the keys of the module variables that it may change."""
        self.assumed_facts = Facts({}, {})
        """What holds everywhere."""
        self.state = State({}, Facts({}, {}))
        for uniform in module.uniforms:
            value = self.uniform(uniform)
            if (at := contracts.alpha_at(uniform)) is not None:
                value = self.value((*value.parts[:at], Range(0.0, 1.0)), value.numbers, value.length)
            self.globals[uniform.name] = value
        for variable in module.variables:
            if variable.storage == "in":
                limits = contracts.of_invocation(variable, module.workgroup)
                value = self.stage_input(variable)
                self.globals[variable.name] = self.value(limits, value.numbers) if limits else value
        for constant in module.constants:
            self.globals[constant.name] = self.expr(constant.value)

    # Values

    def uniform(self, uniform: ir.Uniform) -> Value:
        """A uniform within its contract."""

        def read(name: str, type_: Type) -> Value:
            contract = contracts.of_uniform(uniform._replace(name=name, type=type_), self.format)
            return self.input(type_, contract, "uniform", name)

        return self.by_fields(uniform.name, uniform.type, read)

    def stage_input(self, variable: ir.Variable) -> Value:
        """An input of the stage within its contract."""

        def read(name: str, type_: Type) -> Value:
            contract = contracts.of_stage_input(variable._replace(name=name, type=type_), self.format)
            return self.input(type_, contract, "input", name)

        return self.by_fields(variable.name, variable.type, read)

    def by_fields(self, name: str, type_: Type, read: Callable[[str, Type], Value]) -> Value:
        """What `read` has for a name and its type; of a struct, for each of its fields by its path."""
        inner = innermost(type_)
        if not isinstance(inner, Struct):
            return read(name, inner)
        return self.assemble([self.by_fields(f"{name}.{field.name}", field.type, read) for field in inner.fields])

    def assemble(self, fields: Sequence[Value]) -> Value:
        """A struct of these fields."""
        parts = tuple([part for field in fields for part in field.parts])
        return self.value(parts, tuple([number for field in fields for number in field.numbers]))

    def input(self, type_: Type, contract: Contract, storage: str, name: str) -> Value:
        """An input within its contract, or within what is assumed of it."""
        assumption = self.assumed(storage, name, type_) if self.assumed is not None else None
        if assumption is not None:
            contract = assumption.applied(contract)
        if isinstance(type_, Sampler):
            return Value((), (), ANY, contract._replace(channels=self.channels(type_, contract, storage, name)))
        count = scalars(type_)
        low, high = max(contract.low, -contract.length), min(contract.high, contract.length)
        parts = tuple([Range(low, high, contract.shortest if count == 1 else 0.0)] * count)
        size = ANY
        if contract.length < INF or contract.shortest > 0.0:
            size = Range(contract.shortest, contract.length)
        is_matrix = isinstance(type_, Matrix)
        value = self.value(parts, tuple([self.numbers.fresh() for _ in parts]), ANY if is_matrix else size)
        if count > 1 and size is not ANY and not is_matrix:
            self.lengths[value.numbers[0]] = value.numbers, size
        is_square = isinstance(type_, Matrix) and type_.columns == type_.rows
        return value._replace(stretch=size) if is_square else value

    def channels(self, type_: Sampler, contract: Contract, storage: str, name: str) -> tuple[Range, ...]:
        """The ranges of a texture's channels, if something is assumed of one: `name.r`."""
        if self.assumed is None:
            return ()
        assumptions = [self.assumed(storage, f"{name}.{letter}", type_) for letter in "rgba"]
        if all(own is None for own in assumptions):
            return ()
        contracts = [contract if own is None else own.applied(contract) for own in assumptions]
        return tuple([Range(own.low, own.high) for own in contracts])

    def unknown(self, type_: Type) -> Value:
        """A value of which only the type is known."""
        parts = tuple([self.limits(kind) for kind in scalar_kinds(type_)])
        return self.value(parts, tuple([self.numbers.fresh() for _ in parts]))

    def limits(self, kind: str) -> Range:
        return self.integers.get(kind, self.floats)

    def value(self, parts: tuple[Range, ...], numbers: tuple[int, ...], length: Range = ANY) -> Value:
        """A value, refined by the facts about its components and its length."""
        facts = self.state.facts.ranges
        if facts and not facts.keys().isdisjoint(numbers):
            parts = tuple([part.met(facts[n]) if n in facts else part for part, n in zip(parts, numbers, strict=True)])
        if parts:
            length = length.met(length_of(parts)) if length is not ANY else length_of(parts)
            fact = self.length_fact(numbers)
            if fact is not None:
                length = length.met(fact)
                parts = tuple([clip(part, -length.high, length.high) for part in parts])
                if len(parts) == 1 and length.low > 0.0:
                    parts = (Range(parts[0].low, parts[0].high, max(parts[0].gap, length.low)),)
        return Value(parts, numbers, length)

    def refine(self, value: Value) -> Value:
        """A value with the facts at this point."""
        facts = self.state.facts.ranges
        if not facts or (facts.keys().isdisjoint(value.numbers) and self.length_fact(value.numbers) is None):
            return value
        new = self.value(value.parts, value.numbers, value.length)
        return new._replace(stretch=value.stretch, head=value.head)

    def length_fact(self, numbers: tuple[int, ...]) -> Range | None:
        """The fact about the length of a vector, if any, from one about its rounded length."""
        facts = self.state.facts.ranges
        fact = facts.get(self.numbers.existing.get(("length", *numbers), -1)) if facts and numbers else None
        if fact is None:
            return None
        slack = 16.0 * self.format.epsilon
        # the squares of small components may be flushed to 0
        high = max(fact.high, 0.0) + self.format.tiny**0.5
        return Range(max(fact.low, 0.0) * (1.0 - slack), high * (1.0 + slack))

    def computed(self, node: ir.Expr, parts: Sequence[Range], numbers: Sequence[int], length: Range = ANY) -> Value:
        """The result of an operation: rounded, and checked for overflow."""
        kind = kind_of(node.type)
        if kind != "float":
            limits = self.limits(kind)
            bounded = [part if part.low >= limits.low and part.high <= limits.high else limits for part in parts]
            return self.value(tuple(bounded), tuple(numbers))
        bounded = [rounded(part, self.format) for part in parts]
        largest = self.format.largest
        if any(part.low < -largest or part.high > largest for part in bounded):
            guard = SUMS if _is_sum(node) else OVERFLOW
            self.note(node, "overflow", (guard,), guard, (hull_of(tuple(bounded)),))
            bounded = [clip(part, -largest, largest) for part in bounded]
        return self.value(tuple(bounded), tuple(numbers), length)

    def note(
        self, node: ir.Expr, operation: str, failures: bool | tuple[Guard, ...], guard: Guard, args: tuple[Range, ...],
        limits: tuple[float, float] = (0.0, 0.0),
    ) -> None:  # fmt: skip
        """Records what was found about an operation; a second visit widens it.

        `failures` are the guards of what may fail; True means that of `guard`, False that nothing may fail.
        """
        if isinstance(failures, bool):
            failures = (guard,) if failures else ()
        function = self.frames[-1].function.name if self.frames else ""
        site = Site(node, operation, failures, guard, args, limits, function)
        earlier = self.sites.get((id(node), operation))
        self.sites[id(node), operation] = site if earlier is None else earlier.joined(site)

    # Joins

    def joined(self, first: Value, second: Value, first_facts: Facts, second_facts: Facts) -> Value:
        """A value that comes from either of two ways."""
        if first is second:
            return first
        parts, numbers = [], []
        for a, b, m, n in zip(first.parts, second.parts, first.numbers, second.numbers, strict=True):
            if m == n:
                numbers.append(m)
                parts.append(a.joined(b))
                continue
            numbers.append(self.numbers.fresh())
            a = a.met(first_facts.ranges[m]) if m in first_facts.ranges else a
            b = b.met(second_facts.ranges[n]) if n in second_facts.ranges else b
            parts.append(a.joined(b))
        length = first.length.joined(second.length)
        return Value(
            tuple(parts), tuple(numbers), length.met(length_of(parts)) if parts else length, first.texel,
            first.stretch.joined(second.stretch), first.head.joined(second.head),
        )  # fmt: skip

    def join(self, first: State, second: State) -> State:
        if first is second:
            return first
        env = {  # what has another number of parts is a variable of the same name in another block
            name: self.joined(value, second.env[name], first.facts, second.facts)
            for name, value in first.env.items()
            if name in second.env and len(second.env[name].parts) == len(value.parts)
        }
        return State(env, first.facts.joined(second.facts))

    def join_all(self, states: Iterable[State | None]) -> State | None:
        joined: State | None = None
        for state in states:
            if state is not None:
                joined = state if joined is None else self.join(joined, state)
        return joined

    # Conditions

    def learn(self, number: int, truth: bool) -> None:
        """Adds the facts that follow from a condition's truth value."""
        key = self.numbers.definitions[number]
        facts = self.state.facts
        facts.ranges[number] = Range(float(truth), float(truth))
        if key[0] == "!":
            self.learn(cast(int, key[1]), not truth)
        elif (key[0] == "&&" and truth) or (key[0] == "||" and not truth):
            self.learn(cast(int, key[1]), truth)
            self.learn(cast(int, key[2]), truth)
        elif key[0] == "compare":
            _, op, left, right, whole, x, y = cast("tuple[str, str, int, int, bool, Range, Range]", key)
            if not truth:
                op = {"<": ">=", ">": "<=", "<=": ">", ">=": "<", "==": "!=", "!=": "=="}[op]
            facts.compare(self.numbers, (left, x), op, (right, y), whole)

    # Defined by subclasses, which call each other

    def expr(self, node: ir.Expr) -> Value:
        """The value of an expression."""
        raise NotImplementedError

    def call(self, node: ir.Call) -> Value:
        """The result of a call."""
        raise NotImplementedError

    def block(self, block: ir.Block, state: State | None) -> State | None:
        """The state at a block's end; None if that is unreachable."""
        raise NotImplementedError
