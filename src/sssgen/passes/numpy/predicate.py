"""If-conversion: turns control flow that differs from lane to lane into straight-line code under masks.

Why: NumPy computes all lanes of a batch at once, so `if (c) x = a;` becomes `x = select(c, a, x)`, and a loop
runs while any lane is in it. Place: after all other passes but `names`, as its result is for targets without
control flow per lane; no other pass expects it. Uniform control flow (see `uniformity`) is kept.

The result is ordinary IR with these conventions:
- a mask is a bool variable: `mask` (the lanes in the arm of an if), `running` (those still in the loop), `active`
  (those still in this iteration of the loop, where it has a continue), `returned` (those that have returned; `result`
  is their value);
- `if`, `for` and `while` remain only where their condition is the same in all lanes, `for` only where it counts
  (`uniformity.count`); a loop that lanes leave one by one runs `while (any_lane(running))`, with an intrinsic for this;
- a call that writes is a statement by itself (see `lift_calls`), and a function reports in `out bool discarded` which
  lanes are discarded;
- an assignment is masked only where lanes outside the mask may still read the variable. A variable that is declared
  under a mask, or that is not read after a return, is assigned without a mask and has arbitrary values in the other
  lanes. Reads and builtins run for all lanes, so they accept any value: indices are clamped, a division by 0 gives
  infinity or NaN.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.constant_expressions import zero
from sssgen.ir.types import BOOL, VOID, Type
from sssgen.ir.walk import root, statements
from sssgen.passes.lift_calls import DISCARDED, Functions, lift_calls, out_arguments
from sssgen.passes.numpy.masks import Mask, without_not
from sssgen.passes.numpy.settle import settle
from sssgen.passes.numpy.tidy import renumber, tidy
from sssgen.passes.numpy.uniformity import Uniformity, uniform_constants
from sssgen.passes.numpy.variable_uses import may_change, written_outside
from sssgen.passes.scopes import claim, declared, separate


def predicate(module: ir.Module) -> ir.Module:
    """The module without control flow per lane. Its functions come after those they call."""
    module = lift_calls(module)
    functions = {function.key: function for function in module.functions}
    constants = uniform_constants(module.constants)
    converted = tuple([_Converter(function, functions, constants).run() for function in module.functions])
    return module._replace(functions=converted)


class _Frame:
    """Code that runs for some lanes only: the function, the arm of an if, or the body of a loop."""

    def __init__(self, mask: Mask | None, running: str = "", active: str = "") -> None:
        self.mask = mask
        """The lanes that run this code; None: all. It may be wrong for lanes outside the frame of `base`."""
        self.running, self.active = running, active
        """A loop's masks, '' if it has none."""
        self.more = False
        """Whether statements of this frame follow."""
        self.branches = 0
        """How many uniform ifs and loops of this frame enclose the current statement."""


_OUTSIDE = -1
"""The depth of variables that are read after the function has returned."""


class _Converter:
    """Converts one function."""

    def __init__(self, function: ir.Function, functions: Functions, constants: frozenset[str]) -> None:
        self.function, self.functions = function, functions
        self.facts = Uniformity(function, constants, functions)
        self.names = set(declared(function)) | constants | {other.name for other in functions.values()}
        self.temporaries: set[str] = set()
        """The masks and results that this pass adds."""
        self.depths = {param.name: 0 if param.direction == "in" else _OUTSIDE for param in function.params}
        """The frame that each variable belongs to."""
        self.frames = [_Frame(None)]
        self.loops: list[int] = []
        """The depth of the frame of each enclosing loop, 0 for a loop without one."""
        self.out: list[ir.Stmt] = []
        self.python_depth = 0
        """How many loops and ifs of the result enclose the current statement."""
        self.diverges = "return" in self.facts.jumps(function.body or (), False)
        self.returned, self.result = "", ""
        self.arms_to_come = 0

    def run(self) -> ir.Function:
        function = self.function
        self.block(function.body or ())
        if self.result and not (self.out and isinstance(self.out[-1], ir.Return)):
            self.out.append(ir.Return(ir.Local(function.result, self.result, function.span), function.span))
        body = renumber(tidy(tuple(self.out), self.temporaries, self.functions), self.temporaries, self.names)
        return separate(function._replace(body=settle(body, function, self.functions)))

    # Names

    def new(self, name: str) -> str:
        name = claim(name, self.names)
        self.temporaries.add(name)
        return name

    def mask(self, value: ir.Expr, name: str = "mask") -> Mask:
        """Stores a condition in a mask."""
        name = self.new(name)
        self.out.append(ir.Declare(name, BOOL, value, value.span))
        return Mask(name)

    @property
    def frame(self) -> _Frame:
        return self.frames[-1]

    @property
    def depth(self) -> int:
        return len(self.frames) - 1

    # Statements

    def block(self, block: ir.Block) -> bool:
        """Converts statements; returns whether no lane of the frame reaches their end."""
        frame = self.frame
        outer = frame.more
        ended = False
        for index, stmt in enumerate(block):
            frame.more = outer or index + 1 < len(block)
            ended = self.statement(stmt)
            if ended:
                break
        frame.more = outer
        return ended

    def nested(self, block: ir.Block) -> tuple[ir.Block, bool]:
        """Converts statements into the block of a statement of the result; returns also what `block` does."""
        outer, self.out = self.out, []
        self.python_depth += 1
        ended = self.block(block)
        self.python_depth -= 1
        statements, self.out = self.out, outer
        return tuple(statements), ended

    def statement(self, stmt: ir.Stmt) -> bool:
        """Converts a statement; returns whether no lane of the frame reaches its end."""
        if isinstance(stmt, ir.Declare):
            self.depths[stmt.name] = self.depth
            if isinstance(stmt.value, ir.Call):
                self.call(stmt, stmt.value)
            else:
                self.out.append(stmt)
        elif isinstance(stmt, ir.Assign):
            if isinstance(stmt.value, ir.Call):
                self.call(stmt, stmt.value)
            else:
                self.assign(stmt)
        elif isinstance(stmt, ir.Evaluate):
            if isinstance(stmt.call, ir.Call):
                self.call(stmt, stmt.call)
        elif isinstance(stmt, ir.If):
            return self.branch(stmt)
        elif isinstance(stmt, ir.For | ir.While):
            self.loop(stmt)
        elif isinstance(stmt, ir.Return):
            self.leave_function(stmt.value, stmt.span)
            return True
        elif isinstance(stmt, ir.Discard):
            self.discard(stmt)
            return True
        elif isinstance(stmt, ir.Break | ir.Continue):
            self.leave_loop(stmt)
            return True
        return False

    def mask_for(self, name: str) -> Mask | None:
        """The lanes in which a variable may change here; None: all."""
        return self.frame.mask if self.depths[name] < self.depth else None

    def assign(self, stmt: ir.Assign) -> None:
        target, span = stmt.target, stmt.span
        variable = root(target)
        assert variable is not None
        mask = self.mask_for(variable.name)
        if mask is None:
            self.out.append(stmt)
            return
        value = ir.Binary(target.type, stmt.op, target, stmt.value, span) if stmt.op else stmt.value
        self.out.append(ir.Assign(target, "", mask.choose(value, target, span), span))

    def call(self, stmt: ir.Declare | ir.Assign | ir.Evaluate, call: ir.Call) -> None:
        """A call that may write: under a mask it writes to temporary variables, which are then copied."""
        args = list(call.args)
        after: list[ir.Stmt] = []
        for index, param in enumerate(self.functions[call.function].params):
            arg = args[index]
            if param.direction != "in":
                assert isinstance(arg, ir.Local)
                mask = self.mask_for(arg.name)
                if mask is not None:
                    temporary = args[index] = ir.Local(arg.type, self.new(arg.name), arg.span)
                    value = arg if param.direction == "inout" else None
                    self.out.append(ir.Declare(temporary.name, arg.type, value, arg.span))
                    after.append(ir.Assign(arg, "", mask.choose(temporary, arg, arg.span), arg.span))
        call = call._replace(args=tuple(args))
        if isinstance(stmt, ir.Evaluate):
            self.out.append(stmt._replace(call=call))
        elif isinstance(stmt, ir.Assign):
            variable = root(stmt.target)
            assert variable is not None
            if out_arguments(call, self.functions) and self.mask_for(variable.name) is not None:
                temporary = ir.Local(stmt.target.type, self.new(variable.name), stmt.span)
                self.out.append(ir.Declare(temporary.name, temporary.type, call, stmt.span))
                self.assign(stmt._replace(value=temporary))
            else:
                self.assign(stmt._replace(value=call))
        else:
            self.out.append(stmt._replace(value=call))
        self.out += after

    # Ifs

    def branch(self, stmt: ir.If) -> bool:
        frame = self.frame
        if self.facts.is_uniform(stmt.condition):
            self.prepare_return(stmt)
            frame.branches += 1
            then, then_ends = self.nested(stmt.then)
            otherwise, else_ends = self.nested(stmt.otherwise)
            frame.branches -= 1
            self.out.append(ir.If(stmt.condition, then, otherwise, stmt.span))
            return then_ends and else_ends
        condition, inverted = without_not(stmt.condition)
        outer = frame.mask if self.base(stmt) < self.depth else None
        shared = outer is None and not _jumps_inside(stmt.then)
        if outer is None and isinstance(condition, ir.Local) and self.constant_in(condition.name, stmt):
            mask = Mask(condition.name)
        else:
            mask = self.mask(condition)
        then_mask, else_mask = Mask(mask.name, inverted), Mask(mask.name, not inverted)
        if outer is not None:
            then_mask = self.mask(outer.also(then_mask.expr(stmt.span)))
        if stmt.otherwise and outer is not None:
            else_mask = self.mask(outer.also(else_mask.expr(stmt.span)))
        elif stmt.otherwise and not shared:
            else_mask = self.mask(else_mask.expr(stmt.span))
        self.arms_to_come += bool(stmt.otherwise)
        then_ends = self.arm(stmt.then, then_mask)
        self.arms_to_come -= bool(stmt.otherwise)
        return self.arm(stmt.otherwise, else_mask) and then_ends

    def arm(self, block: ir.Block, mask: Mask) -> bool:
        self.frames.append(_Frame(mask))
        ended = self.block(block)
        self.frames.pop()
        return ended

    def constant_in(self, name: str, stmt: ir.If) -> bool:
        """Whether a variable can be the mask of an if: no statement inside changes it."""
        if any(_jumps_inside(arm) for arm in (stmt.then, stmt.otherwise)):
            return False
        return name not in written_outside(stmt, self.functions)

    def base(self, stmt: ir.If) -> int:
        """The depth of the outermost frame whose variables or masks the if changes.

        The mask of the if must be right only for the lanes of that frame, so it need not include the masks further out.
        """
        depths = [self.depth]
        depths += [self.depths[name] for name in written_outside(stmt, self.functions) if name in self.depths]
        for inner in statements((stmt,)):
            if isinstance(inner, ir.Return):
                depths.append(0)
            elif isinstance(inner, ir.Break | ir.Continue) and self.loops:
                target = self.loops[-1]  # or an inner loop; a lane that continues must not break
                depths.append(target - 1 if self.frames[target].active and isinstance(inner, ir.Break) else target)
            elif isinstance(inner, ir.Discard) or (
                isinstance(inner, ir.For | ir.While) and self.facts.loops[id(inner)].diverges
            ):
                depths.append(_OUTSIDE)
        return min(depths)

    # Loops

    def loop(self, loop: ir.For | ir.While) -> None:
        facts = self.facts.loops[id(loop)]
        if facts.diverges:
            self.diverging_loop(loop, facts.masked, facts.jumps)
            return
        self.prepare_return(loop)
        frame, span = self.frame, loop.span
        if isinstance(loop, ir.For) and isinstance(loop.init, ir.Declare):
            self.depths[loop.init.name] = self.depth
        if isinstance(loop, ir.For) and not facts.counted and loop.init is not None:
            self.statement(loop.init)
        more, frame.more = frame.more, True
        frame.branches += 1
        self.loops.append(0)
        if isinstance(loop, ir.For) and facts.counted:
            self.out.append(loop._replace(body=self.nested(loop.body)[0]))
        else:
            step = (loop.step,) if isinstance(loop, ir.For) and loop.step is not None else ()
            body, _ = self.nested(loop.body + step)
            assert loop.condition is not None
            self.out.append(ir.While(loop.condition, body, span))
        self.loops.pop()
        frame.branches -= 1
        frame.more = more

    def diverging_loop(self, loop: ir.For | ir.While, masked: bool, jumps: frozenset[str]) -> None:
        """A loop with a mask of the lanes still in it, and where needed one of those still in this iteration."""
        outer, span = self.frame, loop.span
        init, step = (loop.init, loop.step) if isinstance(loop, ir.For) else (None, None)
        if isinstance(init, ir.Declare):
            # lanes that have left the loop need no counter, but those that continue with the next iteration do
            steps = "continue" in jumps and may_change(loop.body, init.name)
            self.depths[init.name] = self.depth + (0 if steps else 1)
            if masked:
                self.out.append(init)
        elif init is not None:
            self.statement(init)
        everyone: ir.Expr = ir.Literal(BOOL, True, span)
        always = isinstance(loop.condition, ir.Literal) and loop.condition.value
        test = loop.condition if masked and not always else None
        start = everyone if outer.mask is None else outer.mask.expr(span)
        running = ""
        if masked or jumps - {"continue"}:
            first = start if test is None else test if outer.mask is None else outer.mask.also(test)
            running = self.mask(first, "running").name
            start = ir.Local(BOOL, running, span)
        self.prepare_return(loop)
        active = self.new("active") if "continue" in jumps else ""
        frame = _Frame(Mask(active or running), running, active)
        self.frames.append(frame)
        self.loops.append(self.depth)
        statements, self.out = self.out, []
        self.python_depth += 1
        if active:
            self.out.append(ir.Declare(active, BOOL, start, span))
        self.block(loop.body)
        ended = bool(self.out) and isinstance(self.out[-1], ir.Break)
        frame.mask = Mask(running)
        if masked and not ended:
            if step is not None:
                self.statement(step)
            if test is not None:
                self.update(running, "&&", test)
        elif running and not ended:
            left = ir.Unary(BOOL, "!", _any_lane(running, span), span)
            self.out.append(ir.If(left, (ir.Break(span),), (), span))
        self.python_depth -= 1
        body, self.out = tuple(self.out), statements
        self.loops.pop()
        self.frames.pop()
        if masked:
            self.out.append(ir.While(_any_lane(running, span), body, span))
        else:
            assert isinstance(loop, ir.For)
            self.out.append(loop._replace(body=body))

    # Jumps

    def update(self, name: str, op: str, value: ir.Expr) -> None:
        local = ir.Local(BOOL, name, value.span)
        self.out.append(ir.Assign(local, "", ir.Binary(BOOL, op, local, value, value.span), value.span))

    def clear(self, mask: Mask, condition: Mask | None, span: ir.Span) -> None:
        """Removes lanes from a mask; None: all of them."""
        if condition is None:
            self.out.append(ir.Assign(ir.Local(BOOL, mask.name, span), "", ir.Literal(BOOL, mask.inverted, span), span))
        elif mask.inverted:
            self.update(mask.name, "||", condition.expr(span))
        else:
            self.update(mask.name, "&&", Mask(condition.name, not condition.inverted).expr(span))

    def leave(self, target: int, kind: str, span: ir.Span) -> None:
        """Removes the lanes of this frame from the masks of the enclosing frames, up to that at depth `target`."""
        leaving = self.frame.mask
        assert leaving is not None
        for depth in range(max(target, 1), self.depth):
            frame = self.frames[depth]
            if frame.running and not (kind == "continue" and depth == target):
                self.clear(Mask(frame.running), leaving, span)
            if frame.more and frame.mask is not None and frame.mask.name != frame.running:
                self.clear(frame.mask, leaving, span)
        frame = self.frame
        if kind != "continue" and frame.running:
            if not frame.active:
                self.out.append(ir.Break(span))
                return
            self.clear(Mask(frame.running), leaving, span)
        if frame.more and (frame.branches or frame.active):
            self.clear(leaving, None, span)

    def leave_loop(self, stmt: ir.Break | ir.Continue) -> None:
        kind = "break" if isinstance(stmt, ir.Break) else "continue"
        target = self.loops[-1]
        uniform = target == 0 or (target == self.depth and not self.frame.active)
        if uniform:
            self.out.append(stmt)
        else:
            self.leave(target, kind, stmt.span)

    def prepare_return(self, stmt: ir.Stmt) -> None:
        """Declares that no lane has returned yet, before a loop or if of the result in which lanes may return."""
        may_return = any(isinstance(inner, ir.Return | ir.Discard) for inner in statements((stmt,)))
        if self.diverges and may_return and not self.returned and self.python_depth == 0:
            self.start_return(ir.Literal(BOOL, False, stmt.span), None, stmt.span)

    def start_return(self, returned: ir.Expr, result: ir.Expr | None, span: ir.Span) -> None:
        """Declares which lanes have returned, and their results."""
        type_: Type = self.function.result
        if type_ != VOID:
            self.result = self.new("result")
            self.out.append(ir.Declare(self.result, type_, result, span))
        self.returned = self.new("returned")
        self.out.append(ir.Declare(self.returned, BOOL, returned, span))
        self.frames[0].mask = Mask(self.returned, True)

    def leave_function(self, value: ir.Expr | None, span: ir.Span) -> None:
        if value is not None and self.returned:
            value = ir.Select(
                value.type,
                ir.Local(BOOL, self.returned, span),
                ir.Local(value.type, self.result, span),
                value,
                span,
            )
        if self.depth == 0:
            self.out.append(ir.Return(value, span))
            return
        leaving = self.frame.mask
        assert leaving is not None
        if not self.returned:
            self.start_return(leaving.expr(span), value, span)
        else:
            if value is not None:
                self.out.append(ir.Assign(ir.Local(value.type, self.result, span), "", value, span))
            if self.loops or self.arms_to_come or any(frame.more for frame in self.frames):
                self.update(self.returned, "||", leaving.expr(span))
        self.leave(0, "return", span)

    def discard(self, stmt: ir.Discard) -> None:
        span = stmt.span
        mask = self.frame.mask
        discarded = ir.Local(BOOL, DISCARDED, span)
        self.out.append(ir.Assign(discarded, "", ir.Literal(BOOL, True, span), span))
        if mask is not None:
            self.out.pop()
            self.update(DISCARDED, "||", mask.expr(span))
        type_ = self.function.result
        self.leave_function(None if type_ == VOID else zero(type_, span), span)


def _any_lane(mask: str, span: ir.Span) -> ir.Expr:
    return ir.Intrinsic(BOOL, "any_lane", (ir.Local(BOOL, mask, span),), span)


def _jumps_inside(block: ir.Block) -> bool:
    """Whether a statement inside the block's statements is a jump; jumps of the block itself do not count."""
    jumps = (ir.Break, ir.Continue, ir.Return, ir.Discard)
    return any(
        isinstance(inner, jumps) for stmt in block if not isinstance(stmt, jumps) for inner in statements((stmt,))
    )
