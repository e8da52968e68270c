"""Checks accesses to parts of values: indices, struct members, swizzles, block members, arrays of textures."""

from __future__ import annotations

from dataclasses import replace

from sssgen.ir import nodes as ir
from sssgen.ir.rules import element_type, swizzle_type
from sssgen.ir.types import INT, UINT, Array, Scalar, Struct, Vector, spell, vector_of
from sssgen.lang.check import quantities as q
from sssgen.lang.check.constant_values import constant_int, integer
from sssgen.lang.check.context import Typed
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s
from sssgen.support.diagnostics import did_you_mean

_SWIZZLES = {letters: str.maketrans(letters, "xyzw") for letters in ("xyzw", "rgba", "stpq")}
_OF_SCALARS = frozenset(letters[0] * count for letters in _SWIZZLES for count in (1, 2, 3, 4))
"""The swizzles of a number (GLSL 4.20, section 5.5)."""


class AccessChecker:
    """Checks the accesses of one file."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        expressions.methods[s.IndexOf] = self.index
        expressions.methods[s.MemberOf] = self.member

    def index(self, index: s.IndexOf) -> Typed:
        if isinstance(index.value, s.Name) and index.value.text in self.context.texture_arrays:
            return self.texture_of(index.value, index)
        outs = (0,) if id(index) in self.expressions.places else ()
        value, position = self.expressions.operands((index.value, index.index), outs)
        if position.expr.type not in (INT, UINT):
            raise self.context.fail(
                index.index.span, f"an index must be an int, but this is {a_type(position.expr.type)}"
            )
        type_ = value.expr.type
        element = element_type(type_)
        if element is None:
            raise self.context.fail(index.span, f"{a_type(type_)} has no elements to index")
        result, length = element
        constant = integer(self.context, position.expr)
        if constant is not None and not 0 <= constant < (length or constant + 1):  # 0: a buffer's own length
            raise self.context.fail(index.index.span, f"index {constant} is outside {spell(type_)}: 0 to {length - 1}")
        if self.context.es == 100 and constant and isinstance(value.expr, ir.Global):
            self.check_color(value.expr.name, index.index.span)
        quantity = value.quantity if isinstance(type_, Array) else ""
        return Typed(ir.Index(result, value.expr, position.expr, index.span), quantity)

    def check_color(self, variable: str, span: ir.Span) -> None:
        """Reports a colour behind the first one in GLSL ES 1.00, which has them only by an extension."""
        if variable == "gl_FragData" and not self.context.language.extensions & {"GL_EXT_draw_buffers", "all"}:
            hint = "write #extension GL_EXT_draw_buffers : enable"
            raise self.context.fail(span, "GLSL ES 1.00 has one colour, gl_FragData[0]", hint)

    def texture_of(self, name: s.Name, index: s.IndexOf) -> Typed:
        """One texture of an array of textures, which are separate textures in the IR."""
        textures = self.context.texture_arrays[name.text]
        position = constant_int(self.context, index.index)
        if position is None or not 0 <= position < len(textures):
            message = f"a texture of '{name.text}' must be selected by a constant from 0 to {len(textures) - 1}"
            raise self.context.fail(
                index.index.span,
                message,
                "WebGPU has no arrays of textures: write a switch with a case for each texture",
            )
        texture = self.context.globals[textures[position]]
        return Typed(ir.Global(texture.type, textures[position], index.span), texture.quantity)

    def in_block(self, member: s.MemberOf, index: s.IndexOf, name: s.Name) -> s.MemberOf:
        """A member of an element of an array of blocks as one of the block in its place."""
        context = self.context
        if name.text not in context.block_arrays or context.function.scopes.find(name.text) is not None:
            return member
        blocks = context.block_arrays[name.text]
        position = constant_int(context, index.index)
        if position is None or not 0 <= position < len(blocks):
            message = f"a block of '{name.text}' must be selected by a constant from 0 to {len(blocks) - 1}"
            hint = "WebGPU has no arrays of buffers: write a switch with a case for each block"
            raise context.fail(index.index.span, message, hint)
        return replace(member, value=s.Name(blocks[position], index.span))

    def member(self, member: s.MemberOf) -> Typed:
        context = self.context
        if isinstance(member.value, s.IndexOf) and isinstance(member.value.value, s.Name):
            member = self.in_block(member, member.value, member.value.value)
        if isinstance(member.value, s.Name) and member.value.text in context.blocks:
            block, label = member.value.text, member.name
            if context.function.scopes.find(block) is None:
                members = context.blocks[block]
                if label.text not in members:
                    hint = did_you_mean(label.text, members)
                    raise context.fail(label.span, f"block '{block}' has no member '{label.text}'", hint)
                typed = members[label.text]
                return typed._replace(expr=typed.expr._replace(span=member.span))
        value = self.expressions.check(member.value)
        type_, name = value.expr.type, member.name.text
        if isinstance(type_, Struct):
            for field in type_.fields:
                if field.name == name:
                    return Typed(ir.Member(field.type, value.expr, name, member.span), field.quantity)
            hint = did_you_mean(name, [field.name for field in type_.fields])
            raise context.fail(member.name.span, f"struct '{type_.name}' has no member '{name}'", hint)
        if isinstance(type_, Scalar) and context.plain and not context.es and name in _OF_SCALARS:
            repeated = vector_of(type_.kind, len(name))
            return value if repeated == type_ else Typed(ir.Construct(repeated, (value.expr,), member.span))
        if not isinstance(type_, Vector):
            raise context.fail(member.name.span, f"{a_type(type_)} has no member '{name}'")
        for letters, to_xyzw in _SWIZZLES.items():
            parts = name.translate(to_xyzw) if set(name) <= set(letters) else ""
            result = swizzle_type(type_, parts)
            if result is not None:
                if isinstance(member.value, s.Name) and member.value.text == "gl_WorkGroupSize" and len(parts) == 1:
                    return Typed(ir.Literal(UINT, context.workgroup["xyz".index(parts)], member.span))
                quantity = q.channel_of(value.quantity) if len(parts) == 1 else ""
                return Typed(ir.Swizzle(result, value.expr, parts, member.span), quantity)
        letters = "xyzw"[: type_.size]
        hint = f"its components are {letters}"
        raise context.fail(member.name.span, f"'{name}' is not a swizzle of {a_type(type_)}", hint)
