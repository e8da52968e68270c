"""Assembles a material's chain of stages into the functions that a shell calls.

- `evaluate_surface(…)` runs once per fragment and returns a `Surface` with the values for the engine and the lights;
- `evaluate_translucency(surface, …)` runs once per light and returns the factor on the light's colour;
- `evaluate_lighting(surface, …)` is the lighting of targets without their own;
- `evaluate_shadow(…)` is the share of the first light that arrives;
- `evaluate_environment(surface, …)` is the reflected light of the surroundings;
- `evaluate_irradiance(N)` is their light on a white matte surface, where it comes through the body;
- `evaluate_color(…)` is a complete unlit material;
- `evaluate_tone_mapping(color)` brings a colour into the range of a display;
- `evaluate_output(color)` encodes for the display.

Parameters are matched to values by name, scalar quantities by type. A value that no stage writes comes from the shell
(an input) or is the standard default. This is the second pass: it needs the signatures of the linked functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sssgen.ir.constant_expressions import literal
from sssgen.ir.nodes import (
    NOWHERE,
    Assign,
    Block,
    Call,
    Construct,
    Declare,
    Evaluate,
    Expr,
    Function,
    If,
    Intrinsic,
    Literal,
    Local,
    Member,
    Module,
    Param,
    Return,
    Span,
    Stmt,
    StructDecl,
)
from sssgen.ir.surface_fields import FIELDS, NAMES
from sssgen.ir.transform import rewrite, rewrite_block
from sssgen.ir.types import BOOL, FLOAT, VEC2, VEC3, VEC4, VOID, Field, Struct, Type
from sssgen.lang.check.quantities import SCALARS
from sssgen.passes.link import LinkError

IRRADIANCE, IRRADIANCE_BEHIND = "irradiance", "irradiance_behind"
SURROUNDINGS = "surroundings"
"""The role of the light of the surroundings that comes through. It is left out where a lamp decides a value that it
reads, as a length towards this lamp."""

INPUTS: dict[str, Type] = {
    "uv": VEC2, "P": VEC3, "N": VEC3, "V": VEC3, "T": VEC3, "B": VEC3, "L": VEC3,
    "P_object": VEC3, "N_object": VEC3, "V_object": VEC3, "L_object": VEC3,
    "screen_uv": VEC2, "eye_distance": FLOAT,
    "time": FLOAT, "light_color": VEC3, "light_nearness": FLOAT, "ray_origin": VEC3, "ray_direction": VEC3,
    "uv2": VEC2, "vertex_color": VEC4, IRRADIANCE: VEC3, IRRADIANCE_BEHIND: VEC3,
}  # fmt: skip
"""The inputs that a shell can supply."""

AT_REST = {"P": "P_rest", "N": "N_rest", "V": "V_rest"}
"""Inputs of a body that bones bend → the same in its rest pose. Some shells supply them: techniques read the former."""
_SUPPLIED = INPUTS | {rest: INPUTS[name] for name, rest in AT_REST.items()}

PER_LIGHT = frozenset({"L", "L_object", "light_color", "light_nearness"})

EYE_DISTANCE = "eye_distance"

DETAIL_LEVEL = "detail_level"
"""The uniform that chooses the level of detail, in a material with several ones."""

RAYS = frozenset({"ray_origin", "ray_direction"})
"""The inputs of a material that fills the screen, which has no mesh."""

OF_MESH = frozenset({
    "P", "N", "V", "T", "B", "P_object", "N_object", "V_object", "L_object", EYE_DISTANCE, "uv2", "vertex_color",
    IRRADIANCE, IRRADIANCE_BEHIND,
})  # fmt: skip
"""The inputs that a shell computes from a mesh."""

DEFAULTS: dict[str, tuple[Type, tuple[float, ...]]] = {
    **{field.name: (field.type, field.default) for field in FIELDS},
    "translucency": (VEC3, (0.0, 0.0, 0.0)),
    "color": (VEC3, (0.0, 0.0, 0.0)),
}
"""The values that a chain computes, with their defaults where no technique writes them."""

_RESULT_OF_ROLE = {
    "geometry": "hit", "lighting": "color", "shadow": "shadow", "environment": "color", IRRADIANCE: "color",
    "tone_mapping": "color", "output": "color",
}  # fmt: skip
_LAST = ("tone_mapping", "output")
"""The roles that change the final colour."""
_APART = ("lighting", "shadow", "environment", IRRADIANCE, *_LAST)
"""The roles with functions of their own."""


TAKEN = frozenset(
    {"Surface", "surface", "light", "shade_fragment", "MAX_LIGHTS", "safe_normalize", "tangent_frame", *_SUPPLIED}
    | {"facet_light", "reflected_light", "coated_light", "towards_light", "way_out_of_box", "light_entry"}
    | {"towards_area", "area_light"}
    | {f"evaluate_{kind}" for kind in ("surface", "translucency", "color", *_APART)}
    | {"entering_light", "fall_of_light", "share_that_passes", "is_free", "sky_light", "sky_light_matrix"}
    | {"occluder_map", "occluded_lights", DETAIL_LEVEL}
    | {"occluder_matrix", "occluder_matrix_2", "occluder_matrix_3", "occluder_matrix_4"}
)
"""The names of the assembled functions, their shell, inputs and surface, which no uniform may have. The other names
that a shell declares are reserved by its descriptor."""


class ChainFunction(NamedTuple):
    """A stage with its linked function."""

    role: str
    technique: str
    function: Function
    span: Span
    glows: bool = False
    """Whether its result is added once and not multiplied by a light's colour"""
    uv: str = "uv"
    """The value that its parameter `uv` is, and, of a coordinates stage, its result: `uv`, or `uv2`."""
    levels: tuple[int, ...] = ()
    """The levels of detail that it belongs to; () for all of them"""
    at_rest: bool = False
    """Whether it takes the values of the rest pose, `AT_REST`."""


class Entry(NamedTuple):
    """An assembled function and the shell inputs that it takes, in order (without a leading `surface`)."""

    function: Function
    inputs: tuple[str, ...]


class Chain(NamedTuple):
    """The module with its entries, by kind: surface, translucency, lighting, shadow, environment, color, …"""

    module: Module
    entries: dict[str, Entry]
    surface: Struct | None


def assemble(module: Module, stages: Sequence[ChainFunction], lit: bool, opaque: bool = False) -> Chain:
    """Adds the entries; an opaque material has no alpha.

    Raises LinkError for a value that nothing supplies, and for one of the surface that depends on a light.
    """
    if not lit:
        entry = _color_entry(stages, opaque)
        return Chain(module._replace(functions=(*module.functions, entry.function)), {"color": entry}, None)
    chained = [stage for stage in stages if stage.role not in _APART]
    reads = zip(chained, _per_light(chained), strict=True)
    chained = [stage for stage, names in reads if not (stage.role == SURROUNDINGS and names)]
    per_light = _per_light(chained)
    surface = _Body("evaluate_surface", lit=True)
    for stage, late in zip(chained, per_light, strict=True):
        if not late:
            surface.add(stage)
    light = _Body("evaluate_translucency", surface, lit=True)
    if "translucency" in surface.values:  # the same for every light; each multiplies it by its colour
        light.take_over("translucency")
    for stage, names in zip(chained, per_light, strict=True):
        if names:
            _check_late(stage, names)
            light.add(stage)
    apart = {role: _Body(f"evaluate_{role}", surface) for role in ("lighting", "shadow", "environment")}
    if IRRADIANCE_BEHIND in surface.inputs:
        apart[IRRADIANCE] = _Body(f"evaluate_{IRRADIANCE}")
    for role in _LAST:
        apart[role] = _Body(f"evaluate_{role}")
        apart[role].supply("color", VEC3)
    for stage in stages:
        if stage.role in apart:
            apart[stage.role].add(stage)
    named = [name for body in (light, *apart.values()) for name in body.crossing]
    crossing = [name for name in named if name not in NAMES]
    own = [name for name in NAMES if name in surface.values and not (opaque and name == "alpha")]
    fields = own + list(dict.fromkeys(crossing))
    if not fields:  # no shading language has empty structs
        surface.store("albedo", literal(*DEFAULTS["albedo"], surface.span), surface.statements, False, surface.span)
        fields = ["albedo"]
    struct = Struct("Surface", tuple(Field(name, surface.values[name].type) for name in fields))
    entries: dict[str, Entry] = {"surface": surface.finish_surface(struct)}
    if light.statements:
        entries["translucency"] = light.finish("translucency", VEC3, struct)
    for role, body in apart.items():
        if body.statements:
            value, type_ = ("shadow", FLOAT) if role == "shadow" else ("color", VEC3)
            entries[role] = body.finish(value, type_, struct if body.crossing or role == "lighting" else None)
    declared = StructDecl(struct, "Surface values that the techniques compute.", NOWHERE)
    functions = module.functions + tuple(entry.function for entry in entries.values())
    return Chain(module._replace(structs=(*module.structs, declared), functions=functions), entries, struct)


def _per_light(stages: Sequence[ChainFunction]) -> list[set[str]]:
    """What each stage reads that depends on the light."""
    late: set[str] = set(PER_LIGHT)
    result = []
    for stage in stages:
        reads = {_value_name(param, stage) for param in stage.function.params if param.direction != "out"}
        written = _outputs(stage)
        result.append(reads & late)
        late = late | written if reads & late else late - (written - reads)
    return result


def _check_late(stage: ChainFunction, reads: set[str]) -> None:
    """Raises LinkError if a stage that runs once per light writes what the surface has once for all lights."""
    written = _outputs(stage) | ({"emission"} if stage.glows else set())
    if lost := [name for name in NAMES if name in written]:
        names, why = " and ".join(lost), " and ".join(sorted(reads))
        message = f"'{stage.technique}' writes {names} once per light, as it reads {why}; all lights share the surface"
        raise LinkError(message, stage.span, f"write {names} in a technique that does not read {why}")


def _outputs(stage: ChainFunction) -> set[str]:
    names = {_value_name(param, stage) for param in stage.function.params if param.direction != "in"}
    result = _result_name(stage)
    return names | {result} if result else names


def _result_name(stage: ChainFunction) -> str:
    """The name of the value that a stage's result becomes."""
    if stage.function.result == VOID:
        return ""
    if stage.role == "coordinates":
        return stage.uv
    return _RESULT_OF_ROLE.get(stage.role) or stage.function.quantity or "translucency"


def _value_name(param: Param, stage: ChainFunction) -> str:
    name = param.quantity if param.quantity in SCALARS else param.name
    if stage.at_rest and param.direction == "in":
        name = AT_REST.get(name, name)
    return stage.uv if name == "uv" else name


def _color_entry(stages: Sequence[ChainFunction], opaque: bool) -> Entry:
    """The entry of an unlit material: all stages in order; those that need a hit are inside its `if`."""
    body = _Body("evaluate_color")
    first: dict[str, ChainFunction] = {}
    for stage in stages:
        body.add(stage)
        for name in body.inputs:
            first.setdefault(name, stage)
    if RAYS & first.keys() or any(stage.role == "geometry" for stage in stages):
        for name in sorted(OF_MESH & first.keys()):
            stage = first[name]
            reason = "a raymarched material has no mesh: P, N, V and eye_distance exist after the ray's hit"
            raise LinkError(f"{stage.technique} reads {name}, but {reason}", stage.span)
    return body.finish_color(opaque)


class _Value(NamedTuple):
    """A value of the chain: its type, and whether it exists only where a ray has hit."""

    type: Type
    behind_hit: bool


class _Body:
    """One entry function during its assembly."""

    def __init__(self, name: str, surface: _Body | None = None, lit: bool = False) -> None:
        self.name = name
        self.surface = surface
        self.lit = lit
        self.inputs: dict[str, Type] = {}
        self.values: dict[str, _Value] = {}
        self.statements: list[Stmt] = []
        self.after_hit: list[Stmt] = []
        self.after: list[Stmt] = []
        self.crossing: dict[str, None] = {}
        self.span = NOWHERE

    def supply(self, name: str, type_: Type) -> None:
        """Makes a value a parameter."""
        self.inputs[name] = type_
        self.values[name] = _Value(type_, False)

    def add(self, stage: ChainFunction) -> None:
        """Adds the call of one stage."""
        function, span = stage.function, stage.span
        self.span = span
        if any(_value_name(param, stage) == EYE_DISTANCE for param in function.params):
            self.measure_hit(stage)
        waits = "hit" in self.values and any(
            self.values[name].behind_hit
            for param in function.params
            if param.direction != "out" and (name := _value_name(param, stage)) in self.values
        )
        target = self.after_hit if waits else self.statements
        if stage.role in _LAST and "hit" in self.values:
            target = self.after
        args = tuple([self.argument(param, stage, target, waits) for param in function.params])
        call = Call(function.result, function.key, args, span)
        result = _result_name(stage)
        if not result:
            target.append(Evaluate(call, span))
        elif result == "translucency":
            self.add_light("emission" if self.lit and stage.glows else "translucency", call, target, waits, span)
        else:
            self.store(result, call, target, waits, span)
        if stage.role == "geometry" and result == "hit":
            for param in function.params:
                if param.direction == "out":
                    self.values[param.name] = _Value(param.type, True)

    def measure_hit(self, stage: ChainFunction) -> None:
        """Declares the distance from the eye to the place where the ray has hit, if there is a ray."""
        if "hit" not in self.values or EYE_DISTANCE in self.values or "P" not in self.values:
            return
        eye = self.read("ray_origin", Param("ray_origin", VEC3, "in", "", stage.span), stage)
        distance = Intrinsic(FLOAT, "distance", (eye, Local(VEC3, "P", stage.span)), stage.span)
        self.store(EYE_DISTANCE, distance, self.after_hit, True, stage.span)

    def argument(self, param: Param, stage: ChainFunction, target: list[Stmt], waits: bool) -> Expr:
        """The argument for a parameter."""
        name = _value_name(param, stage)
        if param.direction == "out":
            if name not in self.values:
                self.values[name] = _Value(param.type, waits)
                target.append(Declare(name, param.type, None, stage.span))
            return Local(param.type, name, stage.span)
        value = self.read(name, param, stage)
        if param.direction == "inout" and not isinstance(value, Local):
            target.append(Declare(name, param.type, value, stage.span))
            self.values[name] = _Value(param.type, waits)
            return Local(param.type, name, stage.span)
        return value

    def read(self, name: str, param: Param, stage: ChainFunction) -> Expr:
        """A value of the chain, as an expression."""
        span = stage.span
        if name in self.values:
            return Local(param.type, name, span)
        if self.surface is not None and self.surface.hands_over(name):
            self.crossing[name] = None
            return Member(param.type, Local(_SURFACE, "surface", span), name, span)
        if name in _SUPPLIED:
            self.supply(name, _SUPPLIED[name])
            return Local(param.type, name, span)
        if name in DEFAULTS:
            return literal(*DEFAULTS[name], span)
        raise LinkError(_missing_value_message(name, param, stage), span)

    def hands_over(self, name: str) -> bool:
        """Whether the lights read this value from the surface because a stage computed or changed it."""
        is_computed = name in self.values and name not in ("N", *PER_LIGHT)
        return is_computed and (name not in self.inputs or name in self.overwrites())

    def overwrites(self) -> set[str]:
        """The inputs that a stage has overwritten."""
        return {
            stmt.target.name
            for stmt in self.statements
            if isinstance(stmt, Assign) and isinstance(stmt.target, Local) and stmt.target.name in self.inputs
        }

    def store(self, name: str, value: Expr, target: list[Stmt], waits: bool, span: Span) -> None:
        """Sets a value; declares it if it is new."""
        if name in self.values:
            target.append(Assign(Local(value.type, name, span), "", value, span))
        elif waits and name in DEFAULTS:  # needed after the `if` too
            type_, default = DEFAULTS[name]
            self.statements.append(Declare(name, type_, literal(type_, default, span), span))
            self.values[name] = _Value(type_, False)
            target.append(Assign(Local(type_, name, span), "", value, span))
        else:
            self.values[name] = _Value(value.type, waits)
            target.append(Declare(name, value.type, value, span))

    def add_light(self, name: str, call: Call, target: list[Stmt], waits: bool, span: Span) -> None:
        """Adds to the translucency, or to the emission."""
        value: Expr = call if call.type == VEC3 else Construct(VEC3, (call,), span)
        if name in self.values:
            target.append(Assign(Local(VEC3, name, span), "+", value, span))
        else:
            self.values[name] = _Value(VEC3, waits)
            target.append(Declare(name, VEC3, value, span))

    def take_over(self, name: str) -> None:
        """Starts with a value of the surface, to which later stages add."""
        assert self.surface is not None
        self.span = span = self.surface.span
        self.crossing[name] = None
        member = Member(self.surface.values[name].type, Local(_SURFACE, "surface", span), name, span)
        self.store(name, member, self.statements, False, span)

    # Finishing

    def function(self, result: Type, body: Block, doc: str, struct: Struct | None) -> Function:
        leading = (Param("surface", struct, "in", "", self.span),) if struct is not None else ()
        inputs = tuple(Param(name, type_, "in", "", self.span) for name, type_ in self.inputs.items())
        return Function(self.name, leading + inputs, result, "", body, doc, self.span)

    def finish_surface(self, struct: Struct) -> Entry:
        span = self.span
        fields = tuple(Local(field.type, field.name, span) for field in struct.fields)
        body = (*self.statements, Return(Construct(struct, fields, span), span))
        doc = "The values of the surface that do not depend on a light."
        return Entry(self.function(struct, body, doc, None), tuple(self.inputs))

    def finish(self, name: str, type_: Type, struct: Struct | None) -> Entry:
        """The entry that returns one value; if the last statement only sets that value, it returns the expression."""
        value: Expr = Local(type_, name, self.span)
        statements = self.statements
        assigned = _assigned_value(statements[-1], name)
        if assigned is not None:
            value, statements = assigned, statements[:-1]
        if struct is not None:
            statements = _with_surface_type(statements, struct)
            value = _retype(value, struct)
        doc = {
            "translucency": "The transmitted light of one light, as a factor on its colour.",
            "evaluate_lighting": "The reflected light of one light.",
            "evaluate_shadow": "The share of the first light that arrives, 0 to 1.",
            "evaluate_environment": "The reflected light of the surroundings.",
            "evaluate_irradiance": "The light of the surroundings on a white matte surface.",
            "evaluate_tone_mapping": "Brings a linear colour into the range of a display.",
            "evaluate_output": "Encodes a linear colour for the display.",
        }.get(name if name == "translucency" else self.name, "")
        return Entry(self.function(type_, (*statements, Return(value, self.span)), doc, struct), tuple(self.inputs))

    def finish_color(self, opaque: bool) -> Entry:
        span = self.span
        if "color" not in self.values:
            raise LinkError("an unlit material needs a lighting technique that gives its color", span)
        statements = list(self.statements)
        if self.after_hit:
            statements.append(If(Local(BOOL, "hit", span), tuple(self.after_hit), (), span))
        statements += self.after
        has_alpha = "alpha" in self.values and not opaque
        alpha: Expr = Local(FLOAT, "alpha", span) if has_alpha else Literal(FLOAT, 1.0, span)
        result = Construct(VEC4, (Local(VEC3, "color", span), alpha), span)
        body = (*statements, Return(result, span))
        return Entry(self.function(VEC4, body, "The colour of one fragment.", None), tuple(self.inputs))


def _assigned_value(last: Stmt, name: str) -> Expr | None:
    """The value that a statement assigns to the variable `name`; None if it does anything else."""
    if isinstance(last, Declare) and last.name == name:
        return last.value
    if isinstance(last, Assign) and last.op == "" and isinstance(last.target, Local) and last.target.name == name:
        return last.value
    return None


_SURFACE = Struct("Surface", ())


def _retype(expr: Expr, struct: Struct) -> Expr:
    """Gives references to the surface their type, which is known only once every stage has been added."""
    return rewrite(expr, lambda node: node._replace(type=struct) if node.type == _SURFACE else node)


def _with_surface_type(statements: Sequence[Stmt], struct: Struct) -> list[Stmt]:
    change = lambda node: node._replace(type=struct) if node.type == _SURFACE else node  # noqa: E731
    return list(rewrite_block(tuple(statements), change))


def _missing_value_message(name: str, param: Param, stage: ChainFunction) -> str:
    value = f"a {name}" if param.quantity in SCALARS else f"'{name}'"
    return f"{stage.technique} reads {value}, which no stage before it gives"
