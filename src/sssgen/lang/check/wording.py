"""Parts of the checker's messages: types with articles, declarations, hints for mismatches."""

from __future__ import annotations

import re

from sssgen.ir import nodes as ir
from sssgen.ir.signatures import candidates, resolve
from sssgen.ir.types import (
    FLOAT,
    INT,
    Scalar,
    Struct,
    Type,
    Vector,
    components,
    kind_of,
    spell,
    vector_of,
    with_article,
)
from sssgen.lang.check.name_scope import Signature


def a_type(type_: Type) -> str:
    """A type with its article."""
    return with_article(spell(type_))


def signature_text(name: str, signature: Signature) -> str:
    """A function as it was declared."""
    return f"{name}({', '.join(map(spell, signature.types))})"


def type_hint(value: ir.Expr, target: Type) -> str:
    """How to convert `value` to the type `target`; '' if there is no simple way."""
    if target == FLOAT and value.type == INT:
        return f"write {value.value}.0" if isinstance(value, ir.Literal) else "write float(…)"
    if isinstance(target, Vector) and value.type == Scalar(target.kind):
        return f"write {spell(target)}(…)"
    if isinstance(target, Vector) and isinstance(value.type, Vector) and value.type.size > target.size:
        return f"write .{'xyzw'[: target.size]}"
    return ""


def mixed_hint(left: ir.Expr, right: ir.Expr, op: str = "") -> str:
    """How to make two operands match; '' if there is no simple way."""
    for value, other in ((left, right), (right, left)):
        kinds = kind_of(value.type), kind_of(other.type)
        if kinds == ("int", "float"):
            return type_hint(value, FLOAT) or "there is no implicit conversion: write float(…)"
        if kinds == ("int", "uint") and isinstance(value.type, Scalar):
            return f"write {value.value}u" if isinstance(value, ir.Literal) else "write uint(…)"
    if isinstance(left.type, Vector) and isinstance(right.type, Vector) and op in ("<", ">", "<=", ">="):
        return "for a componentwise comparison, use lessThan(…), equal(…), …"
    return "for the remainder of floats, use mod(…)" if op == "%" and kind_of(left.type) == "float" else ""


def constructor_hint(type_: Type) -> str:
    """The members of a struct, for a call of its constructor."""
    if isinstance(type_, Struct):
        return "its members are: " + ", ".join(f"{spell(f.type)} {f.name}" for f in type_.fields)
    return ""


def overload_hint(name: str, args: list[ir.Expr]) -> str:
    """The overloads of a builtin, or the advice to write floats."""
    as_floats = [vector_of("float", components(arg.type)) if kind_of(arg.type) == "int" else arg.type for arg in args]
    if resolve(name, as_floats) is not None:
        return "there is no implicit conversion: write 1.0 for 1"
    listed = ", ".join(candidates(name))
    type_lists = {
        "gen": "float, vec2, vec3 or vec4, the same throughout",
        "vec": "vec2, vec3 or vec4, the same throughout",
    }
    families = [f"{family}F is {words}" for family, words in type_lists.items() if f"{family}F" in listed]
    return "; ".join([f"its overloads are: {listed}", *families])


_UNSUPPORTED = (
    (r"double|d(vec|mat)[234](x[234])?", "WGSL has no floats of 64 bits"),
    (r"[iu]?image\w+", "images are image2D, image3D and image2DArray here, of float, int and uint"),
    (r"[iu]?sampler2DRect\w*", "WebGPU has no such textures; write sampler2D, and divide coordinates by textureSize"),
    (r"[iu]?samplerBuffer", "WebGPU has no such textures; write a readonly storage buffer, or sampler2D"),
    (r"[iu]?sampler2DMSArray", "WebGPU has no such textures; write a sampler2DMS for each layer"),
    (r"atomic_uint", "an atomic counter is a uniform at file scope"),
)


def why_not(name: str) -> str:
    """Why a type of GLSL is not supported; '' for other names."""
    return next((why for pattern, why in _UNSUPPORTED if re.fullmatch(pattern, name)), "")
