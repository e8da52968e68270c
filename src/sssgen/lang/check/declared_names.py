"""The names that a file may declare, and the structs that it declares."""

from __future__ import annotations

import re

from sssgen.ir import nodes as ir
from sssgen.ir.types import VOID, Field, Sampler, Struct
from sssgen.lang.check import quantities as q
from sssgen.lang.check.builtin_variables import BUILTIN_VARIABLES
from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.type_names import array_type, named_type
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

# GLSL ES 3.00, section 3.8. Names that only other targets reserve are renamed when those are emitted.
_RESERVED = frozenset(
    """attribute varying coherent volatile restrict readonly writeonly resource atomic_uint noperspective patch sample
    subroutine common partition active asm class union enum typedef template this goto inline noinline public
    static extern external interface long short double half fixed unsigned superp input output filter
    sizeof cast namespace using switch case default do layout centroid flat smooth invariant buffer shared
    precise packed const uniform in out inout if else for while break continue return discard struct true
    false precision highp mediump lowp void float int uint bool vec2 vec3 vec4 ivec2 ivec3 ivec4 uvec2 uvec3
    uvec4 bvec2 bvec3 bvec4 dvec2 dvec3 dvec4 fvec2 fvec3 fvec4 hvec2 hvec3 hvec4 mat2 mat3 mat4 mat2x2 mat2x3
    mat2x4 mat3x2 mat3x3 mat3x4 mat4x2 mat4x3 mat4x4""".split()  # noqa: SIM905 - eighty names
)
_RESERVED_TYPES = re.compile(r"[iu]?(sampler|image)([123]D|Cube|Buffer)")


def check_not_reserved(context: CheckContext, name: s.Name) -> None:
    """Reports a name that GLSL reserves."""
    text = name.text
    if context.plain:
        if text.startswith("gl_") and text not in BUILTIN_VARIABLES:
            raise context.fail(name.span, f"'{text}' is reserved in GLSL")
        return
    if text in _RESERVED or _RESERVED_TYPES.match(text) or text.startswith("gl_") or "__" in text:
        other = re.sub("_+", "_", f"{text.removeprefix('gl_')}_value")
        raise context.fail(name.span, f"'{text}' is reserved in GLSL", f"choose another name, such as '{other}'")


def check_global_name(context: CheckContext, name: s.Name, overloads: bool = False) -> None:
    """Reports a name at file scope that is reserved or taken; `overloads` allows the name of another function."""
    check_not_reserved(context, name)
    taken = name.text in context.globals or name.text in context.structs or name.text in context.aliases
    taken = taken or name.text in context.blocks or name.text in context.uniform_blocks
    taken = taken or name.text in context.buffer_members
    taken = taken or (name.text in q.QUANTITIES and not context.plain)
    if taken or (not overloads and name.text in context.functions):
        raise context.fail(name.span, f"'{name.text}' is already declared")


def unused_global_name(context: CheckContext, name: str) -> str:
    """`name`, with a number where the file uses it at file scope, also later."""
    count, candidate = 2, name
    while candidate in context.globals or candidate in context.file_names or candidate in context.structs:
        candidate, count = f"{name}_{count}", count + 1
    return candidate


def names_of_file(file: s.File) -> set[str]:
    """The names that a file declares at file scope."""
    names: set[str] = set()
    for external in file.externals:
        declarations: tuple[s.Declaration, ...] = ()
        if isinstance(external, s.GlobalSyntax):
            declarations = (external.declaration,)
        else:
            names.add(external.name.text)
        if isinstance(external, s.BlockSyntax):
            declarations = external.members if external.instance is None else ()
        for declaration in declarations:
            names.update([declarator.name.text for declarator in declaration.declarators])
            if declaration.type.struct is not None:
                names.add(declaration.type.struct.name.text)
    return names


def precision_of(context: CheckContext, type_: s.TypeName) -> str:
    """The precision of a type in GLSL ES, of a struct those of its members; '' where it is unknown."""
    return context.language.precisions.get(type_.span) or context.struct_precisions.get(type_.name, "")


_NOT_OF_MEMBERS = ("const", "uniform", "in", "out", "inout", "attribute", "varying", "buffer", "shared")
"""Qualifiers of variables, which members of structs do not have."""


def declare_struct(context: CheckContext, struct: s.StructSyntax, local: bool = False) -> None:
    """Declares a struct. One of a function is at file scope in the IR, as most languages have no local structs."""
    name, scope = struct.name.text, context.function.scopes.structs[-1]
    if not local:
        check_global_name(context, struct.name)
    else:
        check_not_reserved(context, struct.name)
        if name in scope:
            raise context.fail(struct.name.span, f"'{name}' is already declared in this block")
        name = unused_global_name(context, name)
    fields: dict[str, Field] = {}
    for member in struct.members:
        if member.type.struct is not None:
            if context.es:
                message = "GLSL ES has no structs that are declared inside of structs"
                raise context.fail(member.type.span, message, "declare it before this one")
            declare_struct(context, member.type.struct, local)
        type_, quantity = named_type(context, member.type)
        if words := [word for word in member.qualifiers.keywords if word in _NOT_OF_MEMBERS]:
            raise context.fail(member.qualifiers.span, f"a member cannot be {words[0]}", "write it before a variable")
        for declarator in member.declarators:
            label = declarator.name
            if declarator.value is not None:
                raise context.fail(declarator.value.span, "a member has no initial value", "write it in a constructor")
            if label.text in fields:
                raise context.fail(label.span, f"member '{label.text}' is declared twice")
            check_not_reserved(context, label)
            field_type = array_type(context, type_, declarator.lengths)
            if isinstance(field_type, Sampler) or field_type == VOID:
                raise context.fail(label.span, f"a member cannot be {a_type(field_type)}")
            fields[label.text] = Field(label.text, field_type, quantity)
    context.struct_precisions[name] = " ".join([precision_of(context, member.type) for member in struct.members])
    struct_type = Struct(name, tuple(fields.values()))
    if local:
        scope[struct.name.text] = struct_type
        context.file_names.add(name)
    else:
        context.structs[name] = struct_type
    context.struct_declarations.append(ir.StructDecl(struct_type, struct.doc, struct.name.span))
