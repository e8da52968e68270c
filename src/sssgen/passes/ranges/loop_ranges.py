"""Ranges through loops.

The first iteration of a loop is interpreted alone, then all others together until the ranges no longer grow. The range
of a variable that is only added to is what is added, times the number of iterations.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.intervals import INF, Range, clip
from sssgen.ir.types import kind_of
from sssgen.ir.vector_ranges import Value, length_of
from sssgen.ir.walk import calls_of, statements, written_root
from sssgen.passes.ranges.expression_ranges import ExpressionRanges
from sssgen.passes.ranges.range_state import Loop, State, variable_key
from sssgen.passes.ranges.scalar_parts import scalars

_JOINS = 3
"""How often a loop's state is joined before it is widened."""
_UNROLLED = 8
"""The largest number of iterations that are interpreted one by one."""
_STEPS = (0.0, 1.0, 10.0, 1e3, 1e6, 1e12, 1e20, 1e30)


class LoopRanges(ExpressionRanges):
    """The part of the analysis for loops."""

    def loop(self, stmt: ir.For | ir.While) -> State | None:
        state: State | None = self.state
        if isinstance(stmt, ir.For) and stmt.init is not None:
            state = self.block((stmt.init,), state)
        assert state is not None
        trips = self.trips(stmt)
        ways: list[State | None] = []
        # the first iteration alone, as what it adds keeps sums away from 0; of a short loop, all iterations
        for _ in range(int(trips) if trips <= _UNROLLED else 1):
            frame, after, left = self.iteration(stmt, state.copy(), trips)
            ways += [left, *frame.break_states]
            if after is None:
                return self.join_all(ways)
            state = after
        return self.join_all([*ways, *self.iterations(stmt, state, max(trips - 1.0, 1.0))])

    def iteration(self, stmt: ir.For | ir.While, state: State, trips: float) -> tuple[Loop, State | None, State | None]:
        """One iteration: the loop's exits, the state at its end, and the state in which it does not run."""
        loop = Loop(trips)
        self.state = state
        left: State | None = None
        inside: State | None = state
        if stmt.condition is not None:
            condition = self.expr(stmt.condition)
            state, truth_range = self.state, condition.parts[0]
            if truth_range.low < 1.0:
                self.state = state.copy()
                self.learn(condition.numbers[0], False)
                left = self.state
            inside = state.copy() if truth_range.high > 0.0 else None
            if inside is not None:
                self.state = inside
                self.learn(condition.numbers[0], True)
        if inside is None:
            return loop, None, left
        self.loops.append(loop)
        after = self.join_all([self.block(stmt.body, inside), *loop.continued])
        if isinstance(stmt, ir.For) and stmt.step is not None:
            after = self.block((stmt.step,), after)
        self.loops.pop()
        return loop, after, left

    def iterations(self, stmt: ir.For | ir.While, entry: State, trips: float) -> list[State | None]:
        """Any number of iterations from `entry`: the states at the exits."""
        block = (*stmt.body, *((stmt.step,) if isinstance(stmt, ir.For) and stmt.step is not None else ()))
        if stmt.condition is not None:  # its calls may write
            block = (*block, ir.Return(stmt.condition, stmt.span))
        written = self.writes_of(block)
        sums = {name: self.sum_kind(name, block) for name in written if name in entry.env}
        numbers = {name: [self.numbers.fresh() for _ in value.parts] for name, value in entry.env.items()}
        ranges = {name: entry.env[name].parts for name in written if name in entry.env}
        for attempt in range(24):
            head = self.head(entry, ranges, numbers)
            # a wider attempt finds all that a narrower one finds, so each may record sites
            loop, after, left = self.iteration(stmt, head, trips + 1.0)
            if after is None:
                return [left, *loop.break_states]
            new_ranges = {
                name: self.growth(entry.env[name].parts, loop.added.get(name, {}), trips, sums[name])
                if sums[name]
                else self.at_end(after, name, ranges[name])
                for name in ranges
            }
            if all(a.within(b) for name in ranges for a, b in zip(new_ranges[name], ranges[name], strict=True)):
                return [left, *loop.break_states]
            ranges = {
                name: tuple([
                    self.wider(old, new, attempt) for old, new in zip(ranges[name], new_ranges[name], strict=True)
                ])
                for name in ranges
            }  # fmt: skip
        anything = Range(-self.format.largest, self.format.largest)
        ranges = {name: (anything,) * len(parts) for name, parts in ranges.items()}
        loop, _, left = self.iteration(stmt, self.head(entry, ranges, numbers), trips + 1.0)
        return [left, *loop.break_states]

    def head(self, entry: State, ranges: dict[str, tuple[Range, ...]], numbers: dict[str, list[int]]) -> State:
        """The state at the start of a later iteration."""
        env = dict(entry.env)
        for name, parts in ranges.items():
            env[name] = Value(parts, tuple(numbers[name]), length_of(parts))
        return State(env, entry.facts.copy())

    def at_end(self, state: State, name: str, before: tuple[Range, ...]) -> tuple[Range, ...]:
        """A variable's ranges at the end of an iteration, joined with those at its start."""
        facts, value = state.facts.ranges, state.env[name]
        parts = [p.met(facts[n]) if n in facts else p for p, n in zip(value.parts, value.numbers, strict=True)]
        return tuple([part.joined(old) for part, old in zip(parts, before, strict=True)])

    def growth(
        self, start: tuple[Range, ...], added: dict[int, tuple[list[Range], float]], trips: float, kind: str
    ) -> tuple[Range, ...]:
        """The ranges of a sum after any number of iterations."""
        sums = list(start)
        grows = [(False, False)] * len(sums)
        total = 0.0
        for parts, times in added.values():
            for index, part in enumerate(parts):
                low, high = min(part.low, 0.0), max(part.high, 0.0)
                count = trips * times
                sums[index] += Range(low * count if low else 0.0, high * count if high else 0.0)
                grows[index] = grows[index][0] or low < 0.0, grows[index][1] or high > 0.0
            total += trips * times
        if kind != "float":
            limits = self.limits(kind)  # beyond these it wraps
            return tuple([part if part.low >= limits.low and part.high <= limits.high else limits for part in sums])
        # each sum rounds; a sum that grows in one direction keeps its other end
        error = min(self.format.epsilon * total, 1.0)
        for index, (part, (falls, rises)) in enumerate(zip(sums, grows, strict=True)):
            off = error * min(part.size, self.format.largest)
            sums[index] = self.finite(Range(part.low - off * falls, part.high + off * rises))
        return tuple(sums)

    def finite(self, part: Range) -> Range:
        return clip(part, -self.format.largest, self.format.largest)

    def wider(self, old: Range, new: Range, attempt: int) -> Range:
        """A range for the next attempt: the joined one, later a wider one."""
        both = old.joined(new)
        if attempt < _JOINS:
            return both
        largest = max(self.format.largest, 2.0**32)
        low = old.low if new.low >= old.low else next((-s for s in _STEPS if -s <= new.low), -largest)
        if 0.0 <= new.low < old.low:
            low = 0.0
        high = old.high if new.high <= old.high else next((s for s in _STEPS if s >= new.high), largest)
        gap = old.gap if new.gap >= old.gap and low != 0.0 and high != 0.0 else 0.0
        return Range(low, high, gap)

    def add(self, name: str, stmt: ir.Assign, value: Value) -> None:
        """Records what a statement adds to a variable, for every enclosing loop."""
        parts = [-part for part in value.parts] if stmt.op == "-" else list(value.parts)
        parts = parts * (scalars(stmt.target.type) // len(parts))
        times = 1.0
        for loop in reversed(self.loops):
            earlier = loop.added.setdefault(name, {}).get(id(stmt))
            joined = parts if earlier is None else [a.joined(b) for a, b in zip(earlier[0], parts, strict=True)]
            loop.added[name][id(stmt)] = joined, max(times, earlier[1] if earlier else 0.0)
            times *= loop.trips

    def writes_of(self, block: ir.Block) -> set[str]:
        names: set[str] = set()
        for stmt in statements(block):
            if isinstance(stmt, ir.Assign) and (key := variable_key(stmt.target)) is not None:
                names.add(key)
        return names | self.writes_of_calls(block)

    def writes_of_calls(self, block: ir.Block) -> set[str]:
        """The variables that the calls in a block write, through out parameters or as module variables."""
        names: set[str] = set()
        for call in calls_of(block):
            names |= self.changed.get(call.function, frozenset())
            for param, arg in zip(self.functions[call.function].params, call.args, strict=True):
                if param.direction != "in" and (key := variable_key(arg)) is not None:
                    names.add(key)
        return names

    def sum_kind(self, name: str, block: ir.Block) -> str:
        """The kind of a variable that a block only adds to; '' for any other."""
        kind = ""
        for stmt in statements(block):
            if isinstance(stmt, ir.Assign):
                variable = written_root(stmt.target)
                if variable_key(stmt.target) == name and variable is not None:
                    if stmt.op not in ("+", "-") or variable is not stmt.target:
                        return ""
                    kind = kind_of(variable.type)
        return "" if kind and name in self.writes_of_calls(block) else kind

    def trips(self, stmt: ir.For | ir.While) -> float:
        """The largest number of iterations that a loop's header allows; infinite if it states none."""
        if not isinstance(stmt, ir.For) or not isinstance(stmt.step, ir.Assign) or stmt.step.op not in ("+", "-"):
            return INF
        counter = stmt.step.target
        step = self.expr(stmt.step.value).parts[0]
        if stmt.step.op == "-":
            step = -step
        most = INF
        conditions = [stmt.condition]
        while conditions:
            condition = conditions.pop()
            if isinstance(condition, ir.Binary) and condition.op == "&&":
                conditions += [condition.left, condition.right]
            elif isinstance(condition, ir.Binary) and isinstance(counter, ir.Local):
                swapped = condition.op.translate(str.maketrans("<>", "><"))
                for near, op, far in (
                    (condition.left, condition.op, condition.right), (condition.right, swapped, condition.left),
                ):  # fmt: skip
                    if isinstance(near, ir.Local) and near.name == counter.name:
                        most = min(most, self.steps(self.expr(near).parts[0], op, self.expr(far).parts[0], step))
        return most

    def steps(self, start: Range, op: str, end: Range, step: Range) -> float:
        """How often `counter op end` may hold if the counter changes by `step` each time; infinite if unknown."""
        if step.high < 0.0:
            start, end, step, op = -start, -end, -step, op.translate(str.maketrans("<>", "><"))
        if step.low <= 0.0 or op not in ("<", "<=", "!=") or (op == "!=" and end.low < start.high):
            return INF
        way = max(end.high - start.low, 0.0)
        return float(int(way / step.low)) + 1.0
