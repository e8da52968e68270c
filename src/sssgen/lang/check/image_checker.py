"""Checks images: their declarations as uniforms, and the builtins that load and store their texels."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.image_formats import FORMATS
from sssgen.ir.memory_operations import MemoryRow
from sssgen.ir.types import IMAGES, INT, UINT, Image, Type, spell, vector_of
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.declared_names import check_global_name
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

_ACCESS = ("readonly", "writeonly")
_PLACE = "declare it at file scope as a uniform, and name it where it is read or written"


def declare_image(expressions: ExpressionChecker, declaration: s.Declaration, doc: str) -> None:
    """`layout(rgba8, binding = 0) writeonly uniform image2D picture;`."""
    context, qualifiers = expressions.context, declaration.qualifiers
    image = IMAGES[declaration.type.name]
    access = [word for word in qualifiers.keywords if word in _ACCESS]
    items = dict(qualifiers.layout)
    formats = [name for name in items if name in FORMATS]
    if formats and FORMATS[formats[0]].kind != image.kind:
        message = f"{formats[0]} is no format of {a_type(image)}"
        raise context.fail(qualifiers.span, message, f"its formats hold numbers of {image.kind}")
    if not formats and access != ["writeonly"]:
        message = f"{a_type(image)} that is read needs a format"
        raise context.fail(declaration.type.span, message, "write layout(rgba8), or writeonly")
    binding = constant_int(context, value) if (value := items.get("binding")) is not None else -1
    if binding is None or not -1 <= binding < 1000:
        raise context.fail(qualifiers.span, "a binding must be an integer from 0 to 999")
    for declarator in declaration.declarators:
        name = declarator.name
        if declarator.lengths or declaration.type.lengths:
            hint = "declare each image on its own"
            raise context.fail(name.span, f"there are no arrays of {spell(image)} here", hint)
        check_global_name(context, name)
        allowed = access[0] if len(access) == 1 else ""
        context.variables[name.text] = ir.Variable(
            name.text, image, "image", None, "", "", binding, doc, name.span, allowed, formats[0] if formats else ""
        )
        context.globals[name.text] = GlobalValue(image, "")


def image_arguments(expressions: ExpressionChecker, row: MemoryRow, call: s.CallOf) -> tuple[tuple[ir.Expr, ...], Type]:
    """The arguments of a builtin of images, and the type of its result."""
    context = expressions.context
    args = expressions.operands(call.args)
    first = args[0].expr
    if not isinstance(first, ir.Global) or not isinstance(first.type, Image):
        raise context.fail(call.args[0].span, f"the first argument of {row.name} must be an image", _PLACE)
    image, variable = first.type, context.variables[first.name]
    check_access(expressions, row, variable, call)
    size: Type = vector_of("int", 3 if image.dim == "3D" or image.array else 2)
    if not row.values:
        return (first,), size
    atomic = row.is_image_atomic
    texel: Type = vector_of(image.kind, 1 if atomic else 4)
    if atomic and (texel not in (INT, UINT) or variable.layout not in ("r32i", "r32ui")):
        raise context.fail(call.args[0].span, f"{row.name} needs an image of the format r32i or r32ui")
    values: list[ir.Expr] = [first]
    for index, (arg, written) in enumerate(zip(args[1:], call.args[1:], strict=True)):
        wanted = texel if index else size
        value = expressions.require(arg, wanted, "", written.span, f"argument {index + 2} of {row.name}")
        if index == 0 and image.array and not isinstance(value, ir.Local):  # languages pass the layer on its own
            value = context.function.temporary("texel", value)
        values.append(value)
    return tuple(values), texel


def check_access(expressions: ExpressionChecker, row: MemoryRow, variable: ir.Variable, call: s.CallOf) -> None:
    """Reports a load of what is writeonly and a store into what is readonly."""
    span = call.args[0].span
    if variable.access == "readonly" and not row.reads_only:
        raise expressions.context.fail(span, f"'{variable.name}' is readonly", "leave readonly out")
    if variable.access == "writeonly" and row.loads_texel:
        raise expressions.context.fail(span, f"'{variable.name}' is writeonly", "leave writeonly out")
