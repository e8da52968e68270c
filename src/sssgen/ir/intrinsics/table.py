"""The types of the intrinsic table: a row, and its parts.

Annotations are not postponed here: NamedTuple compiles each postponed one, which takes 0.5 ms of every cold emit.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from sssgen.ir import component_ranges, vector_ranges
from sssgen.ir.formats import Format
from sssgen.ir.intervals import INF, Range, clip
from sssgen.ir.types import Matrix, Type, kind_of, spell

Interval = tuple[float, float]


Kind = Literal["nan", "division", "undefined", "range", "overflow"]
"""What an operation gives where it fails: see `KINDS`."""
KINDS: Mapping[Kind, str] = MappingProxyType({
    "nan": "NaN",
    "division": "division by 0",
    "undefined": "undefined by the language",
    "range": "out of range",
    "overflow": "overflow",
})  # fmt: skip
"""The kinds of failures, the worst first, with their names for people."""


class Guard(NamedTuple):
    """What makes a call safe, and what replaces it where the range pass cannot prove that it is safe."""

    safe: Callable[..., bool] | None
    """Whether nothing can go wrong, for the format F and the ranges x, y, z of the arguments (of their lengths, if the
    builtin is not componentwise). None: never proven here."""
    kind: Kind
    """What the result is otherwise on common devices: NaN, infinity after a division by 0, any number where the language
    defines none, a number outside of what others rely on, or infinity after an overflow."""
    problem: str
    """What goes wrong otherwise, for people."""
    text: str
    """An expression of the language in x, y, z, or a function's body, with the constants TINY (smallest normal number),
    DIVISOR, SQUARE, EPSILON, EXPONENT (the largest of exp2), LARGEST and ROOT (its square root). '' means the polyfill
    with its own divisions guarded."""
    replaces: str = ""
    """The argument that `text` replaces; `result`: the call's own, as x; '' means the whole call."""
    scalar: str = ""
    """The text for a single number, where that reads better."""
    doc: str = ""
    """The comment of the function that it becomes where it is too long for an expression."""
    function: str = ""
    """The name of that function; '' means `safe_` and the builtin's name."""
    ordered: tuple[int, int] | None = None
    """Two arguments: the call is also safe if the first is known to be no larger than the second."""
    argument: Callable[[Format, Range], Range] | None = None
    """The range of the replaced argument after the guard, where the row's range function needs it."""
    result: Callable[[Format, Range], Range] = lambda F, range: clip(range, -F.largest, F.largest)
    """The range of the call's result after the guard: by default it is finite."""
    advice: Callable[..., str] | None = None
    """What an author writes instead, for people, for the ranges of the arguments; where more than `text` is to be said."""
    succeeds: Callable[[Format, Range], Range] | None = None
    """The range of the first argument (of its length) where the call does not fail, if its result tells of that."""


def with_constants(text: str, format: Format, limits: Interval, shown: Callable[[float], str] = repr) -> str:
    """A guard's text with the format's numbers for its constants, multiplied by the factor before one.

    LOW and HIGH are the `limits` of the operation, LAST the upper one as an int.
    """
    numbers = {
        "TINY": format.tiny, "DIVISOR": format.divisor, "SQUARE": format.square, "EPSILON": format.epsilon,
        "EXPONENT": format.exponent, "LARGEST": format.largest, "ROOT": format.largest**0.5,
        "LOW": limits[0], "HIGH": limits[1],
    }  # fmt: skip

    def number(match: re.Match[str]) -> str:
        factor, name = match.groups()
        return str(int(limits[1])) if name == "LAST" else shown(float(factor or 1.0) * numbers[name])

    return re.sub(rf"(?:([\d.]+) \* )?\b({'|'.join(numbers)}|LAST)\b", number, text)


def by_column(text: str, matrix: Matrix, letters: str) -> str:
    """A guard's text, which is one of vectors, for matrices: of each column of the `letters`, as no builtin of guards
    takes a matrix."""
    columns = [re.sub(rf"\b([{letters}])\b", rf"\1[{column}]", text) for column in range(matrix.columns)]
    return f"{spell(matrix)}({', '.join(columns)})".replace("genF", f"vec{matrix.rows}")


class Samples(NamedTuple):
    """The arguments for which the parity is measured; whatever is not limited here: every finite number."""

    floats: tuple[Interval, ...] = ()
    """The interval of all float arguments, or one for each argument."""
    integers: Mapping[int, tuple[int, int]] = MappingProxyType({})
    """The position of an integer argument → its lowest and highest value."""
    unit: tuple[int, ...] = ()
    """The positions of arguments that are unit vectors."""
    invertible: bool = False
    """Matrices are well-conditioned."""
    special: bool = False
    """NaN and infinity are among the floats."""
    halves: bool = False
    """Floats are rounded to float16."""

    def interval(self, index: int) -> Interval | None:
        """The interval of one float argument; None: every finite number."""
        return self.floats[index if len(self.floats) > 1 else 0] if self.floats else None


class Level(NamedTuple):
    """The builtin that reads the same at a given level."""

    name: str
    position: int
    """The position of the level among its arguments."""
    explicit: bool = True
    """False: the level is 0, without an argument."""


class ConstantArgument(NamedTuple):
    """An argument that must be a constant expression, as languages choose a name by it or have no other form."""

    position: int
    types: tuple[str, ...]
    """Of these types alone: another overload may have something else at the same position."""
    what: str
    """What it is, for messages."""
    lowest: int
    highest: int
    """The range of each component."""


class Builtin(NamedTuple):
    """One row of the table."""

    name: str
    signatures: tuple[str, ...]
    doc: str
    # What it computes
    domain: str = ""
    """Where the result is defined, for people, with x, y, z for the arguments; '' means everywhere."""
    componentwise: bool = True
    """Each component of the result depends only on the same component of the arguments; `range`, `fold` and the guards'
    `safe` are then functions of components, otherwise of whole values."""
    fold: Callable[..., Any] | None = None
    """The result for constants, in float64: a number (not componentwise: a sequence of them) from numbers (sequences).
    It may raise ArithmeticError or ValueError outside of the domain. None: constants are not folded."""
    fold_uint: Callable[..., Any] | None = None
    """The same where the result is a uint, if that differs."""
    vectors: tuple[tuple[tuple[object, ...], object], ...] = ()
    """At least three test vectors: (arguments, result); vectors are tuples, matrices tuples of columns."""
    # Value ranges and guards
    range: Callable[..., Any] | None = None
    """The range of the result from the format and those of the arguments: a function as in `ir.component_ranges`, or,
    if not componentwise, in `ir.vector_ranges`. Every row has one; `any_number` and `any_numbers` state nothing."""
    guards: tuple[Guard, ...] = ()
    """Where it may give inf or NaN, or what languages leave undefined; the first one that is needed is inserted."""
    exact_bounds: Interval = (-INF, INF)
    """(low, high): where the exact result is not below `low` (not above `high`), no device's result is."""
    overflow_is_nan: bool = False
    """Terms of opposite signs may overflow in it, so that an overflow may give NaN."""
    relation: Literal["", "abs", "min", "max", "length", "squares"] = ""
    """What a condition on the result implies for the arguments (`passes.ranges.facts`); `squares`: of dot(x, x)."""
    # How languages have it
    es: int = 0
    """The first version of GLSL ES that has it, such as 300; 0: none has it."""
    not_es: tuple[str, ...] = ()
    """The parameters of signatures that GLSL ES lacks, as in `genF,float`."""
    texts: Mapping[str, str] = MappingProxyType({})
    polyfill: str = ""
    later_glsl: bool = False
    """Whether GLSL 3.30 lacks it: a whole shader then is GLSL 4.30."""
    constant: tuple[ConstantArgument, ...] = ()
    """The arguments that must be constant expressions."""
    splat: tuple[str, ...] = ("wgsl",)
    """Languages in which a scalar among vectors must be widened to a vector first."""
    explicit_type: tuple[str, ...] = ()
    """Languages in which a call of literals alone is constant only if one of them has an explicit type."""
    not_constant: tuple[str, ...] = ()
    """Languages of which some compiler does not compute it in a constant at file scope."""
    chooses: bool = False
    """With bools as its last argument, it chooses between the first two, as `?:` does."""
    float32_bits: bool = False
    """It converts from or to the bits of a number, which WGSL has for float32 only."""
    # What it costs
    kind: Literal["alu", "transcendental", "fetch", "derivative"] = "alu"
    cost: int = 1
    """Operations per component, for the static cost."""
    once: int = 0
    """Operations in addition to these, once a call: the one root of a length."""
    # Where it may be called
    uniform_flow: bool = False
    """It compares neighbouring pixels, so control flow must be uniform."""
    axis: str = ""
    """The screen axis, x or y, of a derivative that has a sign."""
    with_level: Level | None = None
    with_gradients: str = ""
    """The builtin that reads the same with given derivatives, which come directly behind the coordinates."""
    size_query: bool = False
    """It asks for a texture's size, which is the same in all pixels."""
    by_texel: bool = False
    """It reads one texel of a texture, without a sampler."""
    # Quantities
    same_quantity: int = 0
    """How many arguments, from the first, must be of the same quantity."""
    quantity: Literal["", "argument", "direction", "blend"] = ""
    """The quantity of the result: none; that of the arguments; the same if all are directions; that of the first two
    arguments if they agree."""
    # How exact it is
    ulp: float = 4.0
    """The float32 error allowed against the float64 oracle, in units in the last place of the result's magnitude."""
    absolute: float = 0.0
    """The absolute error allowed instead, where that is larger."""
    clause: str = ""
    """Where a specification allows more than 4 ulp: which one, and what it says."""
    defined: Callable[..., Any] | None = None
    """Where GLSL defines a result that is finite in any case, as `inside` from `rt` and the arguments; `transpile
    --verify` excludes the other inputs. None: wherever the result is finite."""
    checked: tuple[int, ...] = ()
    """The arguments whose constants WGSL's compilers hold against `defined`, whatever the other arguments are."""
    inside: Callable[..., Any] | None = None
    """Where the parity is measured: for each component, from the module `rt` of the NumPy runtime and the arguments. It
    leaves out where intermediate results overflow or underflow. None: every finite number."""
    size: Callable[..., Any] | None = None
    """The magnitude that `ulp` refers to, from the same arguments, where terms may cancel. None: the result's."""
    samples: Samples = Samples()

    @property
    def reads_neighbours_or_textures(self) -> bool:
        """Whether the result depends on more than the arguments' values."""
        return self.kind in ("fetch", "derivative")

    def constants(self, types: Sequence[Type]) -> dict[int, ConstantArgument]:
        """The arguments that must be constant expressions in a call with these types, by their positions."""
        return {
            argument.position: argument
            for argument in self.constant
            if argument.position < len(types) and spell(types[argument.position]) in argument.types
        }

    def is_choice(self, types: Sequence[Type]) -> bool:
        """Whether a call with these types chooses by a bool or by bools."""
        return self.chooses and kind_of(types[-1]) == "bool"

    @property
    def reads_texels(self) -> bool:
        return self.range is vector_ranges.texels

    @property
    def unbounded(self) -> bool:
        """Whether nothing is known about the range of the result."""
        return self.range in (component_ranges.any_number, vector_ranges.any_numbers)


NONZERO = "max(abs(y), DIVISOR) * (2.0 * step(0.0, y) - 1.0)"
"""A divisor of the same sign (0 counts as positive) that is not 0."""
FINITE = "mix(clamp(x, -LARGEST, LARGEST), genF(0.0), isnan(x))"
"""The largest number in place of infinity, 0 in place of NaN."""
NOT_FINITE_BITS = Guard(None, "range", "bits of a number that is not finite", FINITE, "result")

F1 = ("genF(genF)",)
F2 = ("genF(genF, genF)",)
NAN = float("nan")
HALF_PI, PI = 1.5707963267948966, 3.141592653589793
LARGEST = 2.0**128 - 2.0**104
"""The largest float32."""


def check_domain(condition: bool, value: Any) -> Any:
    """For `fold`: the value; ValueError where a condition of the domain does not hold."""
    if not condition:
        raise ValueError
    return value
