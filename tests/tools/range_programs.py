"""Random programs for the range pass, and an interpreter that checks every value against the range found for it.

The interpreter computes in float32 and does what the guards would do, so that a program goes on where an operation is
not proven safe. Where one is proven, it checks that nothing was to be guarded.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator
from random import Random
from typing import Any

import numpy as np

from ir_interpreter import Interpreter, Returned, Value, binary, flat
from random_programs import Programs
from sssgen.ir import nodes as ir
from sssgen.ir.formats import FLOAT32
from sssgen.ir.intervals import Range, widened
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.types import Array, Matrix, Scalar, Struct, Type, Vector, kind_of
from sssgen.ir.vector_ranges import Value as Known
from sssgen.passes.ranges.range_pass import RangeAnalysis
from sssgen.passes.ranges.range_state import SUMS
from sssgen.passes.ranges.scalar_parts import scalars
from sssgen.passes.ranges.sites import COUNT, SIGNED_COUNT
from sssgen.targets import numpy_runtime as runtime

LARGEST = FLOAT32.largest


class Recorder(RangeAnalysis):
    """The analysis, with the ranges that it found for each node."""

    def __init__(self, module: ir.Module) -> None:
        self.found: dict[int, tuple[Range, ...]] = {}
        self.lengths: dict[int, Range] = {}
        super().__init__(module, FLOAT32)

    def record(self, node: object, known: Known) -> None:
        old = self.found.get(id(node))
        self.found[id(node)] = (
            known.parts if old is None else tuple([a.joined(b) for a, b in zip(old, known.parts, strict=True)])
        )
        self.lengths[id(node)] = self.lengths.get(id(node), known.length).joined(known.length)

    def expr(self, node: ir.Expr) -> Known:
        known = super().expr(node)
        self.record(node, known)
        return known

    def operation(self, node: ir.Binary, left: Known, right: Known) -> Known:
        known = super().operation(node, left, right)
        if id(node) not in self.found or id(node) in {id(one) for one in self.compounds.values()}:
            self.record(node, known)
        return known


def recorded(module: ir.Module, *names: str) -> Recorder:
    """The analysis of a module whose functions of these names are called from outside."""
    analysis = Recorder(module)
    for function in module.functions:
        if function.name in names:
            analysis.root(function.key)
    return analysis


def single(value: float) -> float:
    """A number of float32; beyond the largest, the largest, as the guard of sums and products has it."""
    try:
        result: float = struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(LARGEST, value)
    return min(max(result, -LARGEST), LARGEST)


def rounded_up(value: float) -> float:
    """A number of float32; beyond the largest, infinity."""
    return value if value <= LARGEST else math.inf


def _each(function: Callable[[Any], Any], value: Value) -> Value:
    return tuple(map(function, value)) if isinstance(value, tuple) else function(value)


def rounded(value: Value) -> Value:
    if isinstance(value, tuple):
        return tuple(map(rounded, value))
    return single(value) if isinstance(value, float) else value


class Checker(Interpreter):
    """Runs a program in float32 and compares each value with the range of the analysis."""

    def __init__(self, module: ir.Module, analysis: Recorder, uniforms: dict[str, Value] | None = None) -> None:
        self.analysis = analysis
        self.checked = 0
        self.quantities: list[str] = []
        self.quiet = False
        self.module = module
        self.proven = {key: site.proven for key, site in analysis.sites.items()}
        super().__init__(module, uniforms)

    def value(self, expr: ir.Expr) -> Value:
        site = self.analysis.sites.get((id(expr), kind_of(expr.type))) if isinstance(expr, ir.Construct) else None
        if site is not None and not site.proven:  # a float as an integer
            low, high = site.limits
            assert isinstance(expr, ir.Construct)
            result = _each(lambda x: int(min(max(x, low), high)), self.value(expr.args[0]))
        elif isinstance(expr, ir.Intrinsic):
            result = rounded(self.intrinsic(expr, [self.value(arg) for arg in expr.args]))
        else:
            result = rounded(super().value(expr))
        if not isinstance(expr, ir.Literal) and not self.quiet:
            self.check(expr, result)
        return result

    def check(self, expr: ir.Expr, value: Value) -> None:
        ranges = self.analysis.found.get(id(expr))
        assert ranges is not None, f"{expr}: computed, but not reached by the analysis"
        for index, number in places(expr.type, value):
            part = ranges[index]
            assert _holds(part, number), f"{expr}\n: {number!r} is not in {part}, the range of component {index}"
            self.checked += 1
        if isinstance(expr.type, Vector) and expr.type.kind == "float":
            length, known = math.sqrt(sum(number * number for number in flat(value))), self.analysis.lengths[id(expr)]
            assert _holds(widened(known, 1e-12), length), f"{expr}\n: the length {length!r} is not in {known}"

    def call(self, key: str, *args: Value) -> tuple[Value, ...]:
        self.quantities.append(self.functions[key].quantity)
        result = super().call(key, *args)
        self.quantities.pop()
        return result

    def store(self, target: ir.Expr, value: Value) -> None:
        self.quiet, before = True, self.quiet
        super().store(target, value)
        self.quiet = before

    def pinned(self, place: ir.Expr) -> ir.Expr:
        self.quiet, before = True, self.quiet
        result = super().pinned(place)
        self.quiet = before
        return result

    def statement(self, stmt: ir.Stmt) -> None:
        if isinstance(stmt, ir.Return) and stmt.value is not None:
            quantity = self.quantities[-1]
            site = self.analysis.sites.get((id(stmt.value), quantity)) if quantity else None
            value = self.value(stmt.value)
            raise Returned(min(max(value, site.limits[0]), site.limits[1]) if site and not site.proven else value)
        if isinstance(stmt, ir.Assume):
            assert self.value(stmt.condition), f"{stmt} does not hold"
        elif isinstance(stmt, ir.Assign) and stmt.op:
            value, old = self.value(stmt.value), self.value(stmt.target)
            node = self.analysis.compounds[id(stmt)]
            result = self.operated(node, old, value)
            self.check(node, result)
            self.store(stmt.target, result)
        else:
            super().statement(stmt)

    def binary(self, expr: ir.Binary) -> Value:
        if expr.op in ("&&", "||"):
            return super().binary(expr)
        return self.operated(expr, self.value(expr.left), self.value(expr.right))

    def operated(self, node: ir.Binary, left: Value, right: Value) -> Value:
        if node.op == "/" and kind_of(node.type) == "float":
            site = self.analysis.sites[id(node), "/"]
            assert not site.proven or all(abs(part) >= FLOAT32.tiny for part in flat(right)), f"{node}: by {right}"
            if not site.proven:
                least = 1.0 if site.guard in (COUNT, SIGNED_COUNT) else FLOAT32.divisor
                right = self.nonzero(right, least, site.guard is COUNT)
        return rounded(binary(node.op, node.type, node.left.type, node.right.type, left, right))

    def direction(self, x: Value) -> Value:
        """`x * inversesqrt(max(dot(x, x), SQUARE))`."""
        square = rounded_up(sum(part * part for part in flat(x)))
        scale = single(1.0 / math.sqrt(max(square, FLOAT32.square)))
        return tuple(part * scale for part in x) if isinstance(x, tuple) else x * scale

    def nonzero(self, value: Value, least: float, positive: bool) -> Value:
        if isinstance(value, tuple):
            return tuple(self.nonzero(part, least, positive) for part in value)
        return math.copysign(max(abs(value), least), 1.0 if value >= 0.0 or positive else -1.0)

    def intrinsic(self, expr: ir.Intrinsic, args: list[Value]) -> Value:
        row = BUILTINS[expr.name]
        whole = not row.componentwise
        site = self.proven.get((id(expr), expr.name))
        if site is not None:
            lanes = 1 if whole else max(len(flat(arg)) for arg in args)
            for lane in range(lanes):
                points = [_point(arg, whole, lane) for arg in args]
                guards = [guard for guard in row.guards if guard.replaces != "y" or len(args) > 1]
                fits = all(guard.safe is not None and guard.safe(FLOAT32, *points) for guard in guards)
                assert not site or fits, f"{expr}\n: {args} is outside of the domain, which was proven"
        if expr.name == "normalize" and not site:
            return self.direction(args[0])
        with runtime.precision("float32"), np.errstate(all="ignore"):
            values = (SAFE[expr.name] if site is False else lambda *args: args)(*[_lane(arg) for arg in args])
            result = getattr(runtime, expr.name + "_" * (expr.name == "not"))(*values)
        result = np.asarray(result)
        over = self.analysis.sites.get((id(expr), "overflow"))
        return _back(np.nan_to_num(result, nan=0.0) if over and over.guard is SUMS else result, expr.type)


def _holds(part: Range, number: float) -> bool:
    # GPUs may flush subnormal numbers, and the ranges allow for that
    return part.low <= number <= part.high and abs(number) >= part.gap


def places(type_: Type, value: Value, start: int = 0) -> Iterator[tuple[int, Any]]:
    """Each scalar of a value, and which range is its own: an array's elements share those of one."""
    if isinstance(type_, Array):
        for element in value:
            yield from places(type_.element, element, start)
    elif isinstance(type_, Struct):
        for field, part in zip(type_.fields, value, strict=True):
            yield from places(field.type, part, start)
            start += scalars(field.type)
    else:
        yield from enumerate(flat(value), start)


def _point(value: Value, whole: bool, lane: int) -> Range:
    numbers = [float(part) for part in flat(value)]
    number = math.sqrt(sum(part * part for part in numbers)) if whole else numbers[lane % len(numbers)]
    return Range(number, number)


def _lane(value: Value) -> Any:
    """A value as the runtime has it: component first, lane last."""
    numbers = flat(value)
    kind = type(numbers[0])
    dtype = {float: np.float32, bool: np.bool_}.get(kind, np.int32 if min(numbers) < 0 else np.int64)
    return np.array(value, dtype)[..., None]


def _back(array: Any, type_: Any) -> Value:
    if isinstance(type_, Matrix | Array):
        raise NotImplementedError  # the drawn programs hand no matrix and no array to a function of the runtime
    kind: Callable[[Any], Value] = {"float": float, "bool": bool}.get(kind_of(type_), int)
    numbers = np.asarray(array).reshape(-1)
    results = [kind(number) for number in numbers]
    if isinstance(type_, Scalar):
        return results[0]
    return tuple(results * type_.size if len(results) == 1 else results)


def _at_least(bound: float) -> Callable[..., Any]:
    return lambda x, *rest: (np.maximum(x, np.float32(bound)), *rest)


def _remainder(x: Any, y: Any) -> Any:
    return x, np.where(np.abs(y) < FLOAT32.divisor, np.where(y < 0, -1, 1) * np.float32(FLOAT32.divisor), y)


def _raised(x: Any, y: Any) -> Any:
    base = np.maximum(x, np.float32(FLOAT32.tiny)).astype(np.float64)
    most = FLOAT32.exponent / np.where(np.abs(np.log2(base)) < 1e-30, 1e-30, np.log2(base))
    high = np.where(most > 0.0, np.minimum(y, most), y)
    return base.astype(np.float32), np.where(most < 0.0, np.maximum(high, most), high).astype(np.float32)


SAFE: dict[str, Callable[..., Any]] = {
    "sqrt": _at_least(0.0), "inversesqrt": _at_least(FLOAT32.tiny), "log": _at_least(FLOAT32.tiny),
    "log2": _at_least(FLOAT32.tiny), "mod": _remainder, "pow": _raised,
    "clamp": lambda *args: args, "atan": lambda x, y: (x, np.where((x == 0) & (y == 0), np.float32(1), y)),
    "asin": lambda x: (np.clip(x, -1, 1),), "acos": lambda x: (np.clip(x, -1, 1),),
    "exp": lambda x: (np.minimum(x, np.float32(0.69 * FLOAT32.exponent)),),
    "exp2": lambda x: (np.minimum(x, np.float32(FLOAT32.exponent)),),
    "smoothstep": lambda x, y, z: (x, np.where(x < y, y, np.nextafter(x, np.float32(np.inf))), z),
}  # fmt: skip
"""What guards do to the arguments, for the runtime's own functions."""


HELPERS = """
uniform float reach : hint_range(0.0, 4.0) = 1.0;
uniform vec3 tint : source_color = vec3(0.5);
uniform int taps : hint_range(1, 9) = 3;
struct Body { vec3 at; float size[2]; mat2 turn; };

float grow(inout vec3 v, inout int k, float by) { v += by; k += 1; if (by < 0.0) return v.x; v *= 0.5; return by; }
thickness deep(float x) { return thickness(x); }
float over(float x, out float rest) { rest = x - floor(x); if (rest > 0.5) return 1.0; return x / (1.0 + rest); }
"""


class RangePrograms(Programs):
    """Programs `f(float a, float b, int n, inout float c, out float d, vec3 N, world_position P)` full of domains."""

    def program(self) -> str:
        text = super().program()
        start = text.index("float f(")
        head = "float f(float a, float b, int n, inout float c, out float d, vec3 N, vec3 P) {\n"
        body = text[text.index("{\n", start) + 2 :]
        return HELPERS + text[:start] + head + START + body

    def program_floats(self) -> list[str]:
        return ["N.y", "P.z", "w.x", "w.y", "w.z", "m[1].x", "m[0][1]", "body.at.y", "body.size[1]", "body.turn[0].y"]

    def small(self) -> str:
        """An index, which may be out of bounds where it is computed."""
        return self.random.choice(["0", "1", *self.counters, *self.ints, "n", "k"])

    def place(self) -> str:
        extra = ["w.y", "m[1].x", "body.at.y", f"body.size[{self.small()}]", f"w[{self.small()}]",
                 f"m[{self.small()}].y", f"m[{self.small()}][{self.small()}]", "w.x"]  # fmt: skip
        return self.random.choice(extra) if self.chance(40) else super().place()

    def number(self, depth: int = 2) -> str:
        if depth == 0:
            if self.chance(30):
                return self.random.choice(["reach", "tint.y", "P.x", "N.z", *self.program_floats()])
            return super().number(depth)
        if self.chance(45):
            return self.operation(depth - 1)
        return super().number(depth)

    def operation(self, depth: int) -> str:
        x, y, z = (self.number(depth) for _ in range(3))
        v, u = self.vector(depth), self.vector(depth)
        return self.random.choice([
            f"({x} / {y})", f"({x} / {y})", f"sqrt({x})", f"inversesqrt({x})", f"abs({x})", f"({x} - {x})",
            f"clamp({x}, {y}, {z})", f"clamp({x}, 0.0, 1.0)", f"mix({x}, {y}, clamp({z}, 0.0, 1.0))", f"fract({x})",
            f"mod({x}, {y})", f"pow({x}, {y})", f"exp(-abs({x}))", f"log({x})", f"pow(abs({x}), 0.5)",
            f"pow(max({x}, 0.0), {y})", f"max(w, {v}).z", f"atan({x}, {y})", f"asin({x})", f"step({x}, {y})",
            f"sign({x})",
            f"smoothstep({x}, {y}, {z})", f"dot({v}, {u})", f"dot({v}, {v})", f"length({v})", f"normalize({v}).x",
            f"distance({v}, {u})", f"{v}.y", f"{v}[{self.whole(1)}]", f"grow(w, k, {x})", f"over({x}, {self.place()})",
            f"(m * {v}.xy).x", f"({v}.zx * m).y", f"m[{self.whole(1)}].x", "(m * m)[0].y",
            f"body.size[{self.whole(1)}]",
            f"sqrt(1.0 - {v}.x * {v}.x)", f"(1.0 / (1.0 + {x} * {x}))", f"floor({x})", f"float(deep({x}))",
            f"(float(deep({x})) >= 0.0 ? sqrt({x}) : {y})", f"max({x}, 0.001)", f"-{x}",
        ])  # fmt: skip

    def vector(self, depth: int) -> str:
        if depth <= 0 or self.chance(40):
            return self.random.choice(["N", "P", "w", "w.zyx", "w.xxy", "N.xxx", "v", "tint", "body.at", "(P - w)"])
        v, u, x = self.vector(depth - 1), self.vector(depth - 1), self.number(depth - 1)
        return self.random.choice([
            f"({v} + {u})", f"({v} - {u})", f"({v} * {u})", f"({v} * {x})", f"({x} * {v})", f"({v} / {x})",
            f"normalize({v})", f"cross({v}, {u})", f"reflect({v}, {u})", f"abs({v})", f"mix({v}, {u}, 0.25)", f"-{v}",
            f"faceforward({v}, {u}, {v})", f"refract({v}, {u}, 0.7)", f"vec3({x})", f"min({v}, {u})", f"{v}.yyx",
            f"({self.condition(1)} ? {v} : {u})", f"normalize({v} - {u})",
        ])  # fmt: skip

    def statement(self, indent: int, size: int) -> str:
        pad = "    " * indent
        if indent < 4 and self.chance(8):  # loops in loops
            return self.counting_for(pad, indent, 3)
        if self.chance(25):
            x = self.number(1)
            return self.random.choice([
                f"{pad}w += {x};\n", f"{pad}w -= {self.vector(1)};\n", f"{pad}w = {self.vector(2)};\n",
                f"{pad}total += {x};\n", f"{pad}total += 0.5;\n", f"{pad}total += abs({x});\n", f"{pad}m *= {x};\n",
                f"{pad}m[{self.small()}] = {self.vector(1)}.xz;\n", f"{pad}body.at.x = {x};\n", f"{pad}w *= 0.5;\n",
                f"{pad}grow(w, k, {x});\n", f"{pad}if (abs({x}) < 0.001) return {x};\n", f"{pad}w /= {x};\n",
                f"{pad}count += 1;\n", f"{pad}count += 1 + k * k;\n", f"{pad}body.at = {self.vector(1)};\n",
                f"{pad}total -= float(count);\n", f"{pad}m = transposed(m);\n".replace("transposed(m)", "mat2(total)"),
            ])  # fmt: skip
        return super().statement(indent, size)

    def counting_for(self, pad: str, indent: int, size: int) -> str:
        text = super().counting_for(pad, indent, size)
        new = self.random.choice(["<= 9", "< taps", "< 12", "<= taps", "!= 3", "< 9 && {0} >= 0", "< 6"])
        name = text.split("int ", 1)[1].split(" ", 1)[0]
        return text.replace(f"{name} < 2;", f"{name} {new.format(name)};", 1)


START = """    vec3 w = P * 0.25;
    mat2 m = mat2(a, 1.0, N.xy);
    float size[2] = float[2](a, 0.5);
    Body body = Body(P + N, size, m);
    float total = 0.0;
    int count = 0;
"""


def inputs(random: Random) -> tuple[list[Value], dict[str, Value]]:
    """Arguments of `f` and uniforms, within their contracts."""

    def number() -> float:
        size = random.choice([0.0, 1.0, 1.0, 1e-30, 1e-3, 10.0, 1e6])
        return single(random.choice([size, -size, random.uniform(-size, size), random.uniform(-2.0, 2.0)]))

    direction = [random.gauss(0.0, 1.0) for _ in range(3)]
    long = math.sqrt(sum(part * part for part in direction))
    unit = tuple(single(part / long) for part in direction)
    normal = random.choice([unit, unit, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)])
    arguments = [number(), number(), random.randint(-2, 9), number(), normal, (number(), number(), number())]
    tint = tuple(single(random.random()) for _ in range(3))
    return arguments, {"reach": single(random.choice([0.0, 4.0, 4.0 * random.random()])), "tint": tint,
                   "taps": random.randint(1, 9)}  # fmt: skip
