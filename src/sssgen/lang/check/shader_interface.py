"""The variables of a whole shader at file scope: inputs, outputs, private variables, blocks, arrays of textures."""

from __future__ import annotations

from dataclasses import replace

from sssgen.ir import nodes as ir
from sssgen.ir.types import VOID, Array, Matrix, Sampler, Struct, Type, kind_of, passed_locations, unnested
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.builtin_variables import BUILTIN_VARIABLES, builtin_variable
from sssgen.lang.check.constant_values import constant_int
from sssgen.lang.check.context import Typed
from sssgen.lang.check.declared_names import check_global_name, unused_global_name
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.memory_checker import holds
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.check.type_names import named_element
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

_MEMBER = {"uniform", "lowp", "mediump", "highp"}
_MEMBER_LAYOUT = frozenset({"row_major", "column_major", "offset", "align"})
_INTERPOLATION = ("flat", "smooth", "centroid", "noperspective")
_STORED = ("std140", "shared", "packed")
_BLOCK_LAYOUT = _MEMBER_LAYOUT | {*_STORED, "scalar", "binding", "set", "push_constant", "location"}
"""What `layout(…)` may say of a uniform block and its members, in OpenGL or Vulkan."""


class ShaderInterface:
    """Checks these variables of one file."""

    def __init__(self, expressions: ExpressionChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        self.vertex = self.context.language.vertex
        self.starts: list[ir.Assign] = []
        """What main() sets first: the variables whose values call functions, and later ones that are not constant."""

    def declare(self, declaration: s.Declaration, doc: str, block: str) -> None:
        """Declares inputs, outputs or private variables; `block` is the block that they are members of, or ''."""
        context, keywords = self.context, declaration.qualifiers.keywords
        if "buffer" in keywords:
            raise context.fail(declaration.qualifiers.span, "a storage buffer is a block: buffer Name { … };")
        if "patch" in keywords:
            message = "patch belongs to tessellation shaders, which are not translated"
            raise context.fail(declaration.qualifiers.span, message)
        storage = self.storage(keywords)
        element, quantity = named_element(context, declaration.type)
        self.check_passed(declaration, storage, element)
        for declarator in declaration.declarators:
            name, span = declarator.name.text, declarator.name.span
            if name in BUILTIN_VARIABLES:
                if any(item == "origin_upper_left" for item, _ in declaration.qualifiers.layout):
                    hint = "subtract gl_FragCoord.y from the height of the picture"
                    raise context.fail(
                        span, "gl_FragCoord counts from the bottom: origin_upper_left is not possible", hint
                    )
                if name in ("gl_FragColor", "gl_FragData") and declaration.type.name != name:
                    raise context.fail(span, f"'{name}' cannot be declared again", "leave the declaration out")
                builtin_variable(context, declarator.name)  # redeclared for its qualifiers
                continue
            type_ = self.expressions.declared_type(element, declaration.type, declarator)
            if name in context.declared_without_length and context.globals[name].type == type_:
                context.declared_without_length.remove(name)
                continue
            check_global_name(context, declarator.name)
            if declarator.value is None and any(isinstance(length, s.Unsized) for length in declarator.lengths):
                context.declared_without_length.add(name)
            if type_ == VOID or isinstance(type_, Sampler):
                hint = "write uniform before it" if isinstance(type_, Sampler) else ""
                raise context.fail(declaration.type.span, f"a variable cannot be {a_type(type_)}", hint)
            if context.es and storage == "in" and self.vertex and isinstance(type_, Array):
                message = "GLSL ES has no arrays of attributes"
                raise context.fail(span, message, "declare an input for each element")
            if storage in ("in", "out") and isinstance(unnested(type_)[0], Struct):
                self.check_struct(type_, storage, span, bool(block))
            value = None
            if declarator.value is not None:
                value = self.initial_value(declarator.value, type_, quantity, name)
            interpolation = next(
                (keyword for keyword in keywords if keyword in ("flat", "noperspective", "centroid")), ""
            )
            location = self.location(declaration.qualifiers)
            if any(item in ("component", "index") for item, _ in declaration.qualifiers.layout):
                context.sharing.add(name)
            if value is not None and (storage == "in" or (storage == "out" and context.es)):
                raise context.fail(span, "what stages pass on has no initial value", "write it in main()")
            if value is not None and storage == "shared":
                raise context.fail(span, "shared memory has no initial value", "write it in main(), before a barrier()")
            if value is not None and (self.starts or _calls(value)) and not _is_constant(value):
                self.starts.append(ir.Assign(ir.Global(type_, name, span), "", value, span))
                value = None
            if storage in ("private", "shared"):
                interpolation, location = "", -1
            variable = ir.Variable(name, type_, storage, value, "", interpolation, location, doc, span)
            context.variables[name] = variable._replace(block=block)
            context.globals[name] = GlobalValue(type_, quantity, writable=storage != "in")

    def check_passed(self, declaration: s.Declaration, storage: str, element: Type) -> None:
        """Reports what GLSL does not pass to or between stages; the rest are rules of GLSL ES."""
        context, keywords = self.context, declaration.qualifiers.keywords
        if storage not in ("in", "out"):
            return
        span, kind = declaration.qualifiers.span, kind_of(element)
        if kind == "bool" and not isinstance(element, Struct):
            raise context.fail(span, "stages pass no bools", "pass a float of 0 or 1")
        if not context.es and not context.language.desktop:
            return
        if storage == "out" and not self.vertex and isinstance(element, Matrix):
            raise context.fail(span, "a colour cannot be a matrix", "declare an output for each column")
        is_input = "in" in keywords and not self.vertex
        if is_input and kind in ("int", "uint") and "flat" not in keywords:
            raise context.fail(span, "an integer input of a fragment shader must be flat", "write flat in …")
        if not context.es:
            return
        is_passed = storage == ("out" if self.vertex else "in")
        if context.es < 310 and is_passed and any(item == "location" for item, _ in declaration.qualifiers.layout):
            message = "what stages pass on has no location before GLSL ES 3.10"
            raise context.fail(span, message, "leave the layout out: its name connects the stages")
        if context.es == 100 and "attribute" in keywords and kind != "float":
            raise context.fail(span, f"an attribute is a float, a vector or a matrix, but this is {a_type(element)}")
        if "attribute" in keywords and not self.vertex:
            raise context.fail(span, "a fragment shader has no attributes", "pass it on by a varying")
        if "invariant" in keywords and storage == "in" and context.es >= 300:
            raise context.fail(span, "an input cannot be invariant", "write it before the output of the other stage")
        if "varying" in keywords and kind != "float":
            raise context.fail(span, f"a varying is a float, a vector or a matrix, but this is {a_type(element)}")
        word = next((word for word in keywords if word in ("flat", "smooth", "centroid")), "")
        if word and storage == "out" and not self.vertex:
            raise context.fail(span, f"'{word}' belongs to what stages pass on, not to a colour")

    def check_struct(self, type_: Type, storage: str, span: ir.Span, in_block: bool) -> None:
        """Reports a struct that a stage cannot have as an input or output."""
        context = self.context
        if storage != ("out" if self.vertex else "in"):
            what = "an attribute" if storage == "in" else "a colour"
            raise context.fail(span, f"{what} cannot be {a_type(type_)}", "declare its members one by one")
        if holds(type_, "bool"):
            raise context.fail(span, "stages pass no bools", "make the member a float of 0 or 1")
        if context.es < 300 or in_block:
            return
        parts = [field.type for field in type_.fields] if isinstance(type_, Struct) else []
        parts += [type_.element] if isinstance(type_, Array) else []
        if any(isinstance(part, Struct | Array) for part in parts):
            message = f"GLSL ES does not pass {a_type(type_)} between stages"
            hint = "pass a struct alone, with neither structs nor arrays in it, or an array of numbers or vectors"
            raise context.fail(span, message, hint)

    def initial_value(self, value: s.Expression, type_: Type, quantity: str, name: str) -> ir.Expr:
        """The value of a variable before main()."""

        def check(value: s.Expression) -> ir.Expr:
            return self.expressions.check_as(value, type_, quantity, f"'{name}'")

        expr, prelude = self.expressions.with_prelude(value, check)
        if prelude or (self.context.es and _calls(expr)):
            hint = "set it at the beginning of main()"
            raise self.context.fail(value.span, "the initial value of a global variable cannot call functions", hint)
        return expr

    def with_starts(self, functions: dict[str, ir.Function]) -> dict[str, ir.Function]:
        """The functions with the values at the beginning of main() that call functions, and those after them."""
        main = functions.get("main()")
        if not self.starts:
            return functions
        if main is None:
            message = (
                "the initial value of a global variable calls a function, and there is no main() that could set it"
            )
            raise self.context.fail(self.starts[0].span, message)
        return functions | {"main()": main.begun_with(tuple(self.starts))}

    def storage(self, keywords: tuple[str, ...]) -> str:
        """private, in or out, from the qualifiers; for a varying also from the stage."""
        if "attribute" in keywords:
            return "in"
        if "varying" in keywords:
            return "out" if self.vertex else "in"
        return next((keyword for keyword in keywords if keyword in ("in", "out", "shared")), "private")

    def location(self, qualifiers: s.Qualifiers) -> int:
        """The n of `layout(location = n)`, or -1."""
        for name, value in qualifiers.layout:
            if name == "location" and value is not None:
                number = constant_int(self.context, value)
                if number is None or not 0 <= number < 64:
                    raise self.context.fail(value.span, "a location must be an integer from 0 to 63")
                return number
        return -1

    # Uniforms

    def textures(self, declaration: s.Declaration, declarator: s.Declarator) -> list[s.Declarator]:
        """The declarator of a uniform; for an array of textures one declarator for each texture."""
        context, name = self.context, declarator.name
        lengths = (*declarator.lengths, *declaration.type.lengths)
        if not context.plain or len(lengths) != 1 or "sampler" not in declaration.type.name:
            return [declarator]
        count = constant_int(context, lengths[0])
        if count is None or not 1 <= count <= 64:
            raise context.fail(lengths[0].span, "the length of an array of textures must be a constant from 1 to 64")
        names = [unused_global_name(context, f"{name.text}_{index}") for index in range(count)]
        context.texture_arrays[name.text] = names
        return [replace(declarator, name=replace(name, text=element), lengths=()) for element in names]

    def check_uniform(self, qualifiers: s.Qualifiers) -> None:
        """Reports what a uniform of GLSL ES cannot be."""
        context = self.context
        if not context.es:
            return
        if word := next((word for word in qualifiers.keywords if word in _INTERPOLATION), ""):
            raise context.fail(qualifiers.span, f"'{word}' belongs to what stages pass on, not to a uniform")
        if context.es < 310 and any(item == "binding" for item, _ in qualifiers.layout):
            hint = "leave it out: the program sets the binding"
            raise context.fail(qualifiers.span, "a uniform has no binding before GLSL ES 3.10", hint)

    # Blocks

    def members(self, block: s.BlockSyntax) -> list[s.GlobalSyntax]:
        """The members of a block, as separate uniforms, inputs or outputs."""
        context, keywords = self.context, block.qualifiers.keywords
        if not context.plain:
            raise context.fail(block.name.span, "a technique cannot declare blocks", "write uniform …;")
        if block.name.text == "gl_PerVertex":
            return []
        if "uniform" in keywords:
            self.check_uniform(block.qualifiers)
            self.check_uniform_block(block)
        members: list[s.GlobalSyntax] = []
        # both stages of a program know the names of the block and of its members
        head = block.name if {"in", "out"} & set(keywords) else block.instance
        for member in block.members:
            renamed = []
            for declarator in member.declarators:
                label = declarator.name
                if head is not None:
                    name = unused_global_name(context, f"{head.text}_{label.text}")
                    label = replace(label, text=name)
                renamed.append(replace(declarator, name=label))
            own = [keyword for keyword in member.qualifiers.keywords if keyword not in keywords]
            layout = () if "uniform" in keywords else member.qualifiers.layout
            qualifiers = s.Qualifiers((*keywords, *own), layout, block.qualifiers.span)
            declaration = replace(member, qualifiers=qualifiers, declarators=tuple(renamed))
            members.append(s.GlobalSyntax(declaration, block.doc))
        return members

    def check_uniform_block(self, block: s.BlockSyntax) -> None:
        context, name = self.context, block.name
        if name.text in context.uniform_blocks:
            hint = "a block is declared once: give the other one another name"
            raise context.fail(name.span, f"the block '{name.text}' is already declared", hint)
        check_global_name(context, name)
        context.uniform_blocks.add(name.text)
        pushed = any(item == "push_constant" for item, _ in block.qualifiers.layout)
        layouts = _BLOCK_LAYOUT | {"std430"} if pushed else _BLOCK_LAYOUT
        self.check_qualifiers(block.qualifiers, "a uniform block", {"uniform"}, layouts)
        for member in block.members:
            if "sampler" in member.type.name:
                hint = "declare it outside of the block, as a uniform"
                raise context.fail(member.type.span, "a block cannot contain textures", hint)
            if member.type.struct is not None:
                raise context.fail(member.type.span, "a block cannot declare a struct", "declare it before the block")
            layouts = _MEMBER_LAYOUT - {"offset", "align"} if 0 < context.es < 310 else _MEMBER_LAYOUT
            qualifiers = replace(member.qualifiers, span=member.type.span)
            self.check_qualifiers(qualifiers, "a member of a uniform block", _MEMBER, layouts)

    def check_qualifiers(self, qualifiers: s.Qualifiers, what: str, keywords: set[str], layout: frozenset[str]) -> None:
        """Reports a qualifier that `what` cannot have."""
        for keyword in qualifiers.keywords:
            if keyword not in keywords:
                raise self.context.fail(qualifiers.span, f"{what} cannot be '{keyword}'")
        for item, _ in qualifiers.layout:
            if item not in layout:
                raise self.context.fail(qualifiers.span, f"{what} has no layout '{item}'")

    def uniforms_of(
        self, block: s.BlockSyntax, members: list[s.GlobalSyntax], uniforms: list[ir.Uniform]
    ) -> list[ir.Uniform]:
        """The uniforms that the members of a block became, with what a program knows of them."""
        by_rows: dict[str, bool] = {}
        written: dict[str, str] = {}
        for member, renamed in zip(block.members if members else (), members, strict=True):
            orders = [
                name
                for qualifiers in (self.context.uniform_layout, block.qualifiers.layout, member.qualifiers.layout)
                for name, _ in qualifiers
                if name in ("row_major", "column_major")
            ]
            for declarator, now in zip(member.declarators, renamed.declaration.declarators, strict=True):
                by_rows[now.name.text] = orders[-1:] == ["row_major"]
                written[now.name.text] = declarator.name.text
        layouts = [
            name
            for items in (self.context.uniform_layout, block.qualifiers.layout)
            for name, _ in items
            if name in _STORED
        ]
        head = f"{block.name.text}." if block.instance is not None else ""
        return [
            uniform._replace(
                path=head + written.get(uniform.name, uniform.name) if head else uniform.path,
                block=block.name.text,
                row_major=by_rows.get(uniform.name, False),
                layout=layouts[-1] if layouts else "",
            )
            for uniform in uniforms
        ]

    def elements(self, block: s.BlockSyntax) -> list[s.BlockSyntax]:
        """The blocks that replace an array of blocks, one for each element."""
        context, (length, *others) = self.context, block.lengths
        count = constant_int(context, length) if not isinstance(length, s.Unsized) else None
        if others or count is None or not 1 <= count <= 64 or block.instance is None:
            raise context.fail(length.span, "an array of blocks has one length, a constant from 1 to 64")
        names = [unused_global_name(context, f"{block.instance.text}_{index}") for index in range(count)]
        context.block_arrays[block.instance.text] = names
        keywords, items = block.qualifiers.keywords, dict(block.qualifiers.layout)
        first = constant_int(context, value) if (value := items.get("binding")) is not None else None
        blocks = []
        for index, name in enumerate(names):
            label = f"{block.name.text}[{index}]" if "uniform" in keywords else f"{block.name.text}_{index}"
            if first is not None:
                items["binding"] = s.Number(str(first + index), False, length.span)
            if index:
                items.pop("location", None)  # it follows the element before
            qualifiers = replace(block.qualifiers, layout=tuple(items.items()))
            instance = replace(block.instance, text=name)
            named = replace(block, name=replace(block.name, text=label), instance=instance)
            blocks.append(replace(named, lengths=(), qualifiers=qualifiers))
        return blocks

    def place_members(self, block: s.BlockSyntax, members: list[s.GlobalSyntax], location: int) -> int:
        """Gives the members of an input or output block with a location theirs: each follows the one before it.

        `location` is that of a block that states none, or -1. Gives the location after the last member.
        """
        stated = self.location(block.qualifiers)
        location = stated if stated >= 0 else location
        if location < 0 or "uniform" in block.qualifiers.keywords:
            return -1
        variables = self.context.variables
        for member in members:
            for declarator in member.declaration.declarators:
                variable = variables[declarator.name.text]
                location = variable.location if variable.location >= 0 else location
                variables[variable.name] = variable._replace(location=location)
                location += passed_locations(variable.type)
        return location

    def name_instance(self, block: s.BlockSyntax, members: list[s.GlobalSyntax]) -> None:
        """Makes the members of a block, which are declared by now, accessible by the block's instance name, if it has
        one, or by their own."""
        context = self.context
        instance: dict[str, Typed] = {}
        if block.instance is not None and members:
            check_global_name(context, block.instance)
            context.blocks[block.instance.text] = instance
        for written, member in zip(block.members if members else (), members, strict=True):
            for declarator, renamed in zip(written.declarators, member.declaration.declarators, strict=True):
                label = renamed.name
                value = ir.Global(context.globals[label.text].type, label.text, label.span)
                instance[declarator.name.text] = Typed(value)
                if block.instance is None and label.text != declarator.name.text:
                    if declarator.name.text in {*context.aliases, *context.globals}:
                        message = f"'{declarator.name.text}' is already declared"
                        raise context.fail(declarator.name.span, message, "give the block an instance name")
                    context.aliases[declarator.name.text] = label.text


def _calls(value: ir.Expr) -> bool:
    return any(isinstance(part, ir.Call) for part in subexpressions(value))


def _is_constant(value: ir.Expr) -> bool:
    return not any(isinstance(part, ir.Call | ir.Global) for part in subexpressions(value))
