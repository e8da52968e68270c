"""The verifier: it accepts well-typed modules and names type errors."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir_sample import SAMPLE_MODULE
from sssgen.ir import nodes as ir
from sssgen.ir.rules import constructs, inferred, operator_type
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import (
    BOOL,
    FLOAT,
    INT,
    UINT,
    VEC2,
    VEC3,
    VEC4,
    VOID,
    Array,
    Field,
    Matrix,
    Sampler,
    Scalar,
    Struct,
    Type,
    Vector,
    spell,
)
from sssgen.ir.verify import InvalidIR, check_module, verify
from sssgen.ir.walk import all_expressions
from strategies import modules

NOWHERE = ir.NOWHERE


@settings(max_examples=60)
@given(modules(), st.data())
def test_verifier_accepts_well_typed_modules_and_sees_a_wrong_type(module: ir.Module, data: st.DataObject) -> None:
    """No expression can claim another type unnoticed (a constructor can, where the context accepts either)."""
    assert verify(module) == []
    bound = all(function.body is not None for function in module.functions)
    assert (verify(module, linked=True) == []) == bound
    nodes = [
        node
        for function in module.functions
        for node in all_expressions(function.body or ())
        if not isinstance(node, ir.Construct)
    ]
    if not nodes:
        return
    chosen = data.draw(st.sampled_from(nodes))
    remaining = [type_ for type_ in (FLOAT, INT, UINT, BOOL, VEC3, Matrix(2, 2)) if type_ != chosen.type]
    other = data.draw(st.sampled_from(remaining))
    changed = rewrite_module(module, lambda node: node._replace(type=other) if node is chosen else node)
    assert verify(changed), f"{chosen} as {spell(other)}"


def body(*stmts: ir.Stmt, result: Type = VOID, params: tuple[ir.Param, ...] = ()) -> ir.Module:
    """The sample with one more function, which must be wrong."""
    function = ir.Function("wrong", params, result, "", stmts, "", ir.Span("wrong.sss", 1, 2, 1, 3))
    return SAMPLE_MODULE._replace(functions=(*SAMPLE_MODULE.functions, function))


def evaluated(expr: ir.Expr) -> ir.Module:
    """The sample with a function that declares a variable of this value."""
    return body(ir.Declare("v", expr.type, expr, NOWHERE))


def number(value: float) -> ir.Expr:
    return ir.Literal(FLOAT, value, NOWHERE)


def integer(value: int, type_: Type = INT) -> ir.Expr:
    return ir.Literal(type_, value, NOWHERE)


def local(type_: Type, name: str = "p") -> ir.Expr:
    return ir.Local(type_, name, NOWHERE)


def param(type_: Type, direction: str = "in", name: str = "p") -> ir.Param:
    return ir.Param(name, type_, direction, "", NOWHERE)


def module_global(type_: Type, name: str) -> ir.Expr:
    return ir.Global(type_, name, NOWHERE)


def assigned(target: ir.Expr, value: ir.Expr, op: str = "") -> ir.Stmt:
    return ir.Assign(target, op, value, NOWHERE)


def function(*stmts: ir.Stmt, name: str = "f", result: Type = VOID) -> ir.Function:
    return ir.Function(name, (), result, "", stmts, "", NOWHERE)


def call_of(key: str, *args: ir.Expr, type_: Type = VOID) -> ir.Expr:
    return ir.Call(type_, key, args, NOWHERE)


RED = module_global(VEC3, "RED")
TRUE: ir.Expr = ir.Literal(BOOL, True, NOWHERE)
ONES: ir.Expr = ir.Construct(VEC2, (number(1.0),), NOWHERE)
LEFT = "left(vec3,vec3,vec2)"
MAP = Sampler("2D")
UNIFORM = SAMPLE_MODULE.uniforms[0]
STRUCT = SAMPLE_MODULE.structs[0]

WRONG: dict[str, tuple[Callable[[], ir.Module], str]] = {
    # Literals
    "infinite": (lambda: evaluated(number(float("inf"))), "inf is not a value of type float"),
    "nan": (lambda: evaluated(number(float("nan"))), "nan is not a value of type float"),
    "beyond float32": (lambda: evaluated(number(3.5e38)), "3.5e+38 is not a value of type float"),
    "int as float": (lambda: evaluated(ir.Literal(FLOAT, 1, NOWHERE)), "1 is not a value of type float"),
    "float as int": (lambda: evaluated(ir.Literal(INT, 1.0, NOWHERE)), "1.0 is not a value of type int"),
    "bool as int": (lambda: evaluated(ir.Literal(INT, True, NOWHERE)), "True is not a value of type int"),
    "int as bool": (lambda: evaluated(ir.Literal(BOOL, 1, NOWHERE)), "1 is not a value of type bool"),
    "int too large": (lambda: evaluated(integer(2**31)), "2147483648 is not a value of type int"),
    "uint below 0": (lambda: evaluated(integer(-1, UINT)), "-1 is not a value of type uint"),
    "vector literal": (lambda: evaluated(ir.Literal(VEC2, 1.0, NOWHERE)), "1.0 is not a value of type vec2"),
    # Names
    "unknown local": (lambda: evaluated(local(FLOAT)), "'p' is not declared here"),
    "local of another type": (
        lambda: body(ir.Declare("q", INT, local(INT), NOWHERE), params=(param(FLOAT),)), "'p' is a float, not an int"),
    "unknown global": (lambda: evaluated(module_global(FLOAT, "zork")), "'zork' is not declared here"),
    "global of another type": (lambda: evaluated(module_global(VEC2, "density")), "'density' is a float, not a vec2"),
    "used before it is declared": (
        lambda: body(ir.Declare("p", FLOAT, local(FLOAT), NOWHERE)), "'p' is not declared here"),
    "used after its block": (
        lambda: body(
            ir.If(TRUE, (ir.Declare("p", FLOAT, None, NOWHERE),), (), NOWHERE), assigned(local(FLOAT), number(1.0))),
        "'p' is not declared here"),
    "counter after its loop": (
        lambda: body(
            ir.For(ir.Declare("p", INT, None, NOWHERE), TRUE, None, (), NOWHERE), assigned(local(INT), integer(1))),
        "'p' is not declared here"),
    "hidden": (
        lambda: body(ir.If(TRUE, (ir.Declare("p", INT, None, NOWHERE),), (), NOWHERE), params=(param(FLOAT),)),
        "'p' hides a variable"),
    # Operators
    "unknown operator": (lambda: evaluated(ir.Binary(FLOAT, "**", number(1.0), number(1.0), NOWHERE)), "'**' is not"),
    "operator on mixed types": (
        lambda: evaluated(ir.Binary(FLOAT, "+", number(1.0), integer(1), NOWHERE)),
        "'+' is not defined for (float, int)"),
    "operator's result": (
        lambda: evaluated(ir.Binary(FLOAT, "<", number(1.0), number(2.0), NOWHERE)),
        "'<' of (float, float) is a bool, not a float"),
    "negated bool": (lambda: evaluated(ir.Unary(BOOL, "-", TRUE, NOWHERE)), "'-' is not defined for (bool)"),
    "plus sign": (lambda: evaluated(ir.Unary(FLOAT, "+", number(1.0), NOWHERE)), "'+' is not defined for (float)"),
    "arms that differ": (
        lambda: evaluated(ir.Select(FLOAT, TRUE, number(1.0), integer(1), NOWHERE)), "a choice is not defined for"),
    "choice by a number": (
        lambda: evaluated(ir.Select(FLOAT, integer(1), number(1.0), number(1.0), NOWHERE)), "a choice is not defined"),
    # Parts
    "swizzle of a scalar": (lambda: evaluated(ir.Swizzle(FLOAT, number(1.0), "x", NOWHERE)), "'.x' is not defined"),
    "swizzle out of the vector": (lambda: evaluated(ir.Swizzle(FLOAT, ONES, "z", NOWHERE)), "'.z' is not defined"),
    "swizzle by colour": (lambda: evaluated(ir.Swizzle(FLOAT, ONES, "r", NOWHERE)), "'.r' is not defined"),
    "swizzle of five": (lambda: evaluated(ir.Swizzle(VEC4, ONES, "xxxxx", NOWHERE)), "'.xxxxx' is not defined"),
    "index by a float": (lambda: evaluated(ir.Index(FLOAT, ONES, number(0.0), NOWHERE)), "an index is not defined"),
    "index outside": (lambda: evaluated(ir.Index(FLOAT, ONES, integer(2), NOWHERE)), "index 2 is outside vec2"),
    "index of a scalar": (
        lambda: evaluated(ir.Index(FLOAT, number(1.0), integer(0), NOWHERE)), "an index is not defined"),
    "unknown member": (
        lambda: body(ir.Declare("q", FLOAT, ir.Member(FLOAT, local(STRUCT.type), "zork", NOWHERE), NOWHERE),
                     params=(param(STRUCT.type),)),
        "'.zork' is not defined for (Body)"),
    # Calls and constructors
    "unknown function": (lambda: evaluated(call_of("zork()", type_=FLOAT)), "there is no function zork()"),
    "wrong arguments": (lambda: evaluated(call_of(LEFT, ONES, type_=FLOAT)), f"{LEFT} is called with (vec2)"),
    "wrong result": (lambda: evaluated(call_of("body_distance(vec3)", type_=VEC2)), "returns a float, not a vec2"),
    "constant as out": (
        lambda: body(ir.Evaluate(call_of("step_into(vec3,vec3,bool)", RED, RED, TRUE), NOWHERE)),
        "a Global of type vec3 cannot be assigned to"),
    "nothing as a value": (
        lambda: body(ir.Declare("q", FLOAT, ir.Construct(FLOAT, (call_of("f()"),), NOWHERE), NOWHERE))._replace(
            functions=(function(), function(ir.Declare("q", VOID, call_of("f()"), NOWHERE), name="g"))),
        "a call without a result is used as a value"),
    "nothing in a constructor": (
        lambda: ir.Module(functions=(
            function(), function(ir.Evaluate(ir.Construct(FLOAT, (call_of("f()"),), NOWHERE), NOWHERE), name="g"))),
        "a call without a result is used as a value"),
    "builtin's overload": (
        lambda: evaluated(ir.Intrinsic(FLOAT, "sin", (integer(1),), NOWHERE)), "sin is not defined for (int)"),
    "unknown builtin": (lambda: evaluated(ir.Intrinsic(FLOAT, "zork", (), NOWHERE)), "zork is not defined for ()"),
    "builtin's result": (
        lambda: evaluated(ir.Intrinsic(VEC2, "length", (ONES,), NOWHERE)), "length of (vec2) is a float, not a vec2"),
    "constructor of mixed kinds": (
        lambda: evaluated(ir.Construct(VEC2, (number(1.0), integer(1)), NOWHERE)), "vec2 cannot be constructed"),
    "constructor of too few": (
        lambda: evaluated(ir.Construct(VEC3, (number(1.0), number(1.0)), NOWHERE)), "vec3 cannot be constructed"),
    "constructor that does nothing": (
        lambda: evaluated(ir.Construct(FLOAT, (number(1.0),), NOWHERE)), "float cannot be constructed from (float)"),
    "constructor that cuts": (
        lambda: evaluated(ir.Construct(VEC2, (ir.Construct(VEC3, (number(1.0),), NOWHERE),), NOWHERE)),
        "vec2 cannot be constructed from (vec3)"),
    "constructor of an array": (
        lambda: evaluated(ir.Construct(Array(FLOAT, 2), (number(1.0),), NOWHERE)), "float[2] cannot be constructed"),
    "constructor of a struct": (
        lambda: evaluated(ir.Construct(STRUCT.type, (number(1.0),), NOWHERE)), "Body cannot be constructed"),
    "sampler as a value": (
        lambda: evaluated(ir.Select(MAP, TRUE, module_global(MAP, "map"), module_global(MAP, "map"), NOWHERE)),
        "a sampler can only be named"),
    # Statements
    "declared value": (lambda: body(ir.Declare("q", FLOAT, integer(1), NOWHERE)), "'q' is a float, but gets an int"),
    "variable of nothing": (lambda: body(ir.Declare("q", VOID, None, NOWHERE)), "this cannot be Void()"),
    "variable of a sampler": (lambda: body(ir.Declare("q", MAP, None, NOWHERE)), "this cannot be Sampler"),
    "assigned value": (
        lambda: body(assigned(local(FLOAT), integer(1)), params=(param(FLOAT),)),
        "an assignment is a float, but gets an int"),
    "assigned global": (
        lambda: body(assigned(module_global(FLOAT, "density"), number(1.0))), "a Global of type float cannot be"),
    "assigned literal": (lambda: body(assigned(number(1.0), number(1.0))), "a Literal of type float cannot be"),
    "assigned sampler": (
        lambda: body(assigned(local(MAP), module_global(MAP, "map")), params=(param(MAP),)),
        "a Local of type sampler2D"),
    "assigned twice at once": (
        lambda: body(assigned(ir.Swizzle(VEC2, local(VEC2), "xx", NOWHERE), ONES), params=(param(VEC2),)),
        "'.xx' is assigned to, and names a component twice"),
    "assigned by an operator that widens": (
        lambda: body(assigned(local(FLOAT), ONES, "*"), params=(param(FLOAT),)),
        "'*=' is not defined for float and vec2"),
    "assigned by a comparison": (
        lambda: body(assigned(local(BOOL), TRUE, "=="), params=(param(BOOL),)),
        "'===' is not defined for bool and bool"),
    "evaluated operator": (lambda: body(ir.Evaluate(number(1.0), NOWHERE)), "a Literal is evaluated and dropped"),
    "if by a number": (lambda: body(ir.If(number(1.0), (), (), NOWHERE)), "a condition is a bool, but gets a float"),
    "while by a number": (lambda: body(ir.While(number(1.0), (), NOWHERE)), "a condition is a bool, but gets a float"),
    "for by a number": (lambda: body(ir.For(None, number(1.0), None, (), NOWHERE)), "a condition is a bool"),
    "for with a declaring step": (
        lambda: body(ir.For(None, TRUE, ir.Declare("q", INT, None, NOWHERE), (), NOWHERE)),
        "a Declare in the head of a for"),
    "for with a return": (
        lambda: body(ir.For(ir.Return(None, NOWHERE), TRUE, None, (), NOWHERE)), "a Return in the head of a for"),
    "break outside": (lambda: body(ir.Break(NOWHERE)), "break outside a loop"),
    "continue outside": (lambda: body(ir.If(TRUE, (ir.Continue(NOWHERE),), (), NOWHERE)), "continue outside a loop"),
    "returned value": (
        lambda: body(ir.Return(integer(1), NOWHERE), result=FLOAT), "the return is a float, but gets an int"),
    "returned nothing": (
        lambda: body(ir.Return(None, NOWHERE), result=FLOAT), "the return is a float, but gets a void"),
    "returned from nothing": (lambda: body(ir.Return(number(1.0), NOWHERE)), "the return is a void, but gets a float"),
    "no return": (
        lambda: body(ir.If(TRUE, (ir.Return(number(1.0), NOWHERE),), (), NOWHERE), result=FLOAT),
        "the end is reachable without a return"),
    # Declarations
    "function twice": (lambda: ir.Module(functions=(function(), function())), "'f()' is defined twice"),
    "two names alike": (
        lambda: SAMPLE_MODULE._replace(functions=(function(name="density"),)), "'density' is declared twice"),
    "uniform twice": (lambda: ir.Module(uniforms=(UNIFORM, UNIFORM)), "'density' is declared twice"),
    "parameter twice": (lambda: body(params=(param(FLOAT), param(FLOAT))), "'p' hides a variable"),
    "parameter of nothing": (lambda: body(params=(param(VOID),)), "this cannot be Void()"),
    "parameter's direction": (lambda: body(params=(param(FLOAT, "outin"),)), "'outin' is not a direction"),
    "sampler out": (lambda: body(params=(param(MAP, "out"),)), "a sampler cannot be out"),
    "sampler returned": (lambda: body(result=MAP), "this cannot be Sampler"),
    "unknown struct": (
        lambda: body(params=(param(Struct("Zork", (Field("x", FLOAT),))),)),
        "struct 'Zork' is not declared with these fields"),
    "struct with other fields": (
        lambda: body(params=(param(Struct("Body", (Field("x", FLOAT),))),)),
        "struct 'Body' is not declared with these fields"),
    "empty struct": (
        lambda: ir.Module(structs=(ir.StructDecl(Struct("S", ()), "", NOWHERE),)), "not a struct type"),
    "field twice": (
        lambda: ir.Module(structs=(ir.StructDecl(Struct("S", (Field("x", FLOAT), Field("x", INT))), "", NOWHERE),)),
        "not a struct type"),
    "struct later than its use": (
        lambda: ir.Module(structs=(ir.StructDecl(Struct("S", (Field("x", STRUCT.type),)), "", NOWHERE), STRUCT)),
        "struct 'Body' is not declared with these fields"),
    "vector of five": (lambda: body(params=(param(Vector("float", 5)),)), "not a type: Vector"),
    "vector of doubles": (lambda: body(params=(param(Vector("double", 2)),)), "not a type: Vector"),
    "double": (lambda: body(ir.Declare("q", Scalar("double"), None, NOWHERE)), "this cannot be Scalar"),
    "integer matrix": (lambda: body(result=Matrix(2, 2, "int")), "not a type: Matrix"),
    "array of nothing": (lambda: evaluated(local(Array(FLOAT, 0))), "this cannot be Array"),
    "operator on no types": (
        lambda: evaluated(ir.Unary(FLOAT, "-", local(Scalar("half")), NOWHERE)), "'-' is not defined for (Scalar"),
    "too few defaults": (
        lambda: ir.Module(uniforms=(UNIFORM._replace(type=VEC2),)), "'density' has 1 defaults, not 2"),
    "default of a texture": (
        lambda: ir.Module(uniforms=(UNIFORM._replace(type=MAP),)), "'density' has 1 defaults, not 0"),
    "infinite default": (
        lambda: ir.Module(uniforms=(UNIFORM._replace(default=(float("inf"),)),)),
        "a default that is not a value of float"),
    "default between integers": (
        lambda: ir.Module(uniforms=(UNIFORM._replace(type=INT),)), "a default that is not a value of int"),
    "constant's value": (
        lambda: ir.Module(constants=(ir.Constant("x", FLOAT, integer(1), NOWHERE),)),
        "'x' is a float, but gets an int",
    ),
    "constant of a uniform": (
        lambda: ir.Module(constants=(ir.Constant("x", FLOAT, module_global(FLOAT, "density"), NOWHERE),),
                          uniforms=(UNIFORM,)),
        "the value of 'x' is not constant"),
    "constant of a call": (
        lambda: SAMPLE_MODULE._replace(constants=(
            ir.Constant("x", FLOAT, call_of("body_distance(vec3)", RED, type_=FLOAT), NOWHERE),)),
        "the value of 'x' is not constant"),
    "constant of a derivative": (
        lambda: ir.Module(constants=(
            ir.Constant("x", FLOAT, ir.Intrinsic(FLOAT, "dFdx", (number(1.0),), NOWHERE), NOWHERE),)),
        "the value of 'x' is not constant"),
    "constant of a later one": (
        lambda: ir.Module(constants=(ir.Constant("x", FLOAT, module_global(FLOAT, "y"), NOWHERE),
                                     ir.Constant("y", FLOAT, number(1.0), NOWHERE))),
        "'y' is not declared here"),
    "recursion": (
        lambda: ir.Module(functions=(
            function(ir.Evaluate(call_of("g()"), NOWHERE)), function(ir.Evaluate(call_of("f()"), NOWHERE), name="g"))),
        "f() is recursive, or calls a recursive function"),
    "not a statement": (lambda: body(number(1.0)), "not a statement"),  # type: ignore[arg-type]
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_verifier_rejects(name: str) -> None:
    make, message = WRONG[name]
    problems = verify(make())
    assert any(message in problem for problem in problems), problems


def test_verifier_names_the_place() -> None:
    problems = verify(body(ir.Return(integer(1), ir.Span("a.sss", 7, 3, 7, 9)), result=FLOAT))
    assert problems == ["a.sss:7:3: the return is a float, but gets an int (in wrong())"]
    with pytest.raises(InvalidIR, match=r"a\.sss:7:3"):
        check_module(body(ir.Return(integer(1), ir.Span("a.sss", 7, 3, 7, 9)), result=FLOAT))
    check_module(SAMPLE_MODULE)


def test_linked_modules_have_no_slots_and_an_order() -> None:
    caller = function(ir.Evaluate(call_of("g()"), NOWHERE))
    assert verify(ir.Module(functions=(function(name="g"), caller)), linked=True) == []
    late = ir.Module(functions=(caller, function(name="g")))
    assert verify(late) == []
    assert verify(late, linked=True) == ["f() calls g(), which is declared after it"]
    assert any("slot body_distance(vec3) is not bound" in one for one in verify(SAMPLE_MODULE, linked=True))
    for type_ in (STRUCT.type, Array(STRUCT.type, 2)):
        module = ir.Module(structs=(STRUCT,), uniforms=(UNIFORM._replace(type=type_),))
        assert verify(module) == []
        assert "uniform 'density' is made of structs" in verify(module, linked=True)[0]


def test_long_chains_of_calls() -> None:
    """The verifier does not recurse along calls."""
    calls = [ir.Evaluate(call_of(f"f{index}()"), NOWHERE) for index in range(1500)]
    chain = [function(call, name=f"f{index + 1}") for index, call in enumerate(calls)]
    assert verify(ir.Module(functions=(function(name="f0"), *chain)), linked=True) == []


# The rules


IVEC2, UVEC2, BVEC2, MAT2, MAT3, ARRAY = (
    Vector("int", 2), Vector("uint", 2), Vector("bool", 2), Matrix(2, 2), Matrix(3, 3), Array(FLOAT, 2),
)  # fmt: skip
BODY = STRUCT.type

OPERATORS: list[tuple[str, Type, Type, Type | None]] = [
    ("+", FLOAT, FLOAT, FLOAT), ("+", FLOAT, INT, None), ("+", VEC2, FLOAT, VEC2), ("-", FLOAT, VEC2, VEC2),
    ("+", VEC2, VEC3, None), ("+", BOOL, BOOL, None), ("+", MAT2, MAT2, MAT2), ("+", MAT2, FLOAT, MAT2),
    ("+", MAT2, VEC2, None), ("*", MAT2, VEC2, VEC2), ("*", VEC2, MAT2, VEC2), ("*", MAT3, VEC2, None),
    ("*", MAT2, MAT3, None), ("/", MAT2, MAT2, MAT2), ("/", FLOAT, MAT2, MAT2), ("/", VEC2, MAT2, None),
    ("%", FLOAT, FLOAT, None), ("%", INT, INT, INT), ("%", IVEC2, INT, IVEC2), ("%", INT, UINT, None),
    ("<<", INT, UINT, INT), ("<<", IVEC2, UVEC2, IVEC2), ("<<", IVEC2, UINT, IVEC2), ("<<", INT, IVEC2, None),
    ("<<", FLOAT, INT, None), ("&", UINT, UINT, UINT), ("&", BOOL, BOOL, None), ("|", IVEC2, INT, IVEC2),
    ("<", FLOAT, FLOAT, BOOL), ("<", VEC2, VEC2, None), ("<", BOOL, BOOL, None), ("<", INT, UINT, None),
    ("==", VEC2, VEC2, BOOL), ("==", MAT2, MAT2, BOOL), ("==", BODY, BODY, BOOL), ("==", MAP, MAP, None),
    ("==", ARRAY, ARRAY, BOOL), ("!=", FLOAT, INT, None), ("==", VOID, VOID, None), ("&&", BOOL, BOOL, BOOL),
    ("^^", BOOL, BOOL, BOOL), ("||", BVEC2, BVEC2, None), ("&&", INT, INT, None), ("+", MAP, MAP, None),
    ("+", BODY, BODY, None), ("+", ARRAY, ARRAY, None), ("=", FLOAT, FLOAT, None), ("", FLOAT, FLOAT, None),
]  # fmt: skip


def test_operators_by_hand() -> None:
    """A few of each rule, as GLSL ES 3.00 states them; everything else is refused."""
    for op, left, right, result in OPERATORS:
        assert operator_type(op, left, right) == result, f"{spell(left)} {op} {spell(right)}"


CONSTRUCTORS: list[tuple[Type, list[Type], bool]] = [
    (VEC2, [FLOAT], True), (VEC2, [INT], False), (VEC2, [FLOAT, FLOAT], True), (VEC2, [IVEC2], True),
    (VEC2, [VEC2], False), (VEC2, [VEC3], False), (VEC3, [VEC2, FLOAT], True), (VEC3, [VEC2, VEC2], False),
    (FLOAT, [INT], True), (FLOAT, [BOOL], True), (FLOAT, [FLOAT], False), (FLOAT, [VEC2], False), (FLOAT, [], False),
    (MAT2, [FLOAT], True), (MAT2, [VEC2, VEC2], True), (MAT2, [VEC3, FLOAT], True), (MAT2, [MAT3], True),
    (MAT2, [MAT2], False), (MAT2, [MAT2, MAT2], False), (MAT2, [INT], False), (MAT2, [VEC4], False),
    (ARRAY, [FLOAT, FLOAT], True), (ARRAY, [FLOAT], False), (VOID, [], False), (MAP, [MAP], False),
]  # fmt: skip


def test_constructors_by_hand() -> None:
    for type_, args, fits in CONSTRUCTORS:
        assert constructs(type_, args) == fits, f"{spell(type_)} {args}"


def test_only_expressions_without_an_own_type_have_rules() -> None:
    with pytest.raises(TypeError):
        inferred(number(1.0))
