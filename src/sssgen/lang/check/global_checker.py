"""Checks declarations at file scope: constants, uniforms and their default values."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.contracts import of_uniform
from sssgen.ir.types import IMAGES, VOID, Array, Matrix, Sampler, Struct, Type, components, kind_of, unnested
from sssgen.lang.check import atomic_counters
from sssgen.lang.check.constant_values import constant_value, is_constant
from sssgen.lang.check.declared_names import check_global_name, declare_struct, precision_of
from sssgen.lang.check.expression_checker import ExpressionChecker
from sssgen.lang.check.image_checker import declare_image
from sssgen.lang.check.memory_checker import MemoryChecker
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.check.shader_interface import ShaderInterface
from sssgen.lang.check.type_names import check_sequences, named_element, names_type
from sssgen.lang.check.uniform_hints import check_hints
from sssgen.lang.check.uniform_locations import uniform_location
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s


class GlobalChecker:
    """Checks and collects the constants, uniforms and interface variables of one file."""

    def __init__(self, expressions: ExpressionChecker, interface: ShaderInterface, memory: MemoryChecker) -> None:
        self.context = expressions.context
        self.expressions = expressions
        self.interface, self.memory = interface, memory
        self.constants: list[ir.Constant] = []
        self.uniforms: list[ir.Uniform] = []

    def block(self, block: s.BlockSyntax, location: int = -1) -> int:
        """Declares the members of a block as separate globals; `location` is that of the first where the block states
        none. Gives the location after the last."""
        if block.lengths and self.context.plain:
            for element in self.interface.elements(block):
                location = self.block(element, location)
            return location
        if "buffer" in block.qualifiers.keywords and self.context.plain:
            self.memory.buffer(block)
            return -1
        members = self.interface.members(block)
        count = len(self.uniforms)
        for member in members:
            self.global_(member, block.name.text)
        location = self.interface.place_members(block, members, location)
        self.interface.name_instance(block, members)
        self.uniforms[count:] = self.interface.uniforms_of(block, members, self.uniforms[count:])
        return location

    def global_(self, external: s.GlobalSyntax, block: str = "") -> None:
        """Declares variables; `block` is the block that they are members of, or ''."""
        context, declaration = self.context, external.declaration
        keywords = declaration.qualifiers.keywords
        if not declaration.declarators and declaration.type.struct is None:
            if "invariant" in keywords or "precise" in keywords:
                return  # no other language has these
            if context.plain and names_type(context, declaration.type.name):
                return  # `float;`
            raise context.fail(declaration.type.span, "this declares nothing", "write a type and a name")
        if declaration.type.struct is not None:
            declare_struct(context, declaration.type.struct)
        if "invariant" in keywords and ("uniform" in keywords or "const" in keywords):
            raise context.fail(declaration.qualifiers.span, "only what stages pass can be invariant")
        if "uniform" in keywords and context.plain and declaration.type.name in IMAGES:
            declare_image(self.expressions, declaration, external.doc)
        elif "uniform" in keywords and context.plain and declaration.type.name == atomic_counters.TYPE:
            if block:
                hint = "declare it outside of the block"
                raise context.fail(declaration.type.span, "a block cannot have an atomic counter as a member", hint)
            for counter in atomic_counters.buffers(context, declaration, external.doc):
                self.memory.buffer(counter)
        elif "uniform" in keywords:
            self.interface.check_uniform(declaration.qualifiers)
            for declarator in declaration.declarators:
                elements = self.interface.textures(declaration, declarator)
                for index, element in enumerate(elements):
                    path = "" if element is declarator else f"{declarator.name.text}[{index}]"
                    self.uniform(declaration, element, external.doc, path, index)
        elif "const" in keywords:
            for declarator in declaration.declarators:
                self.constant(declaration, declarator)
        elif context.plain:
            self.interface.declare(declaration, external.doc, block)
        else:
            message = "a technique cannot declare global variables"
            raise context.fail(declaration.type.span, message, "make it const, a uniform, or a parameter")

    def uniform(self, declaration: s.Declaration, declarator: s.Declarator, doc: str, path: str, element: int) -> None:
        context, name = self.context, declarator.name
        check_global_name(context, name)
        element_type, quantity = named_element(context, declaration.type)
        type_ = self.expressions.declared_type(element_type, declaration.type, declarator)
        has_struct = isinstance(unnested(type_)[0], Struct)
        if type_ == VOID or (has_struct and not context.plain):
            raise context.fail(declaration.type.span, f"a uniform cannot be {a_type(type_)}")
        default = self.default(declarator, type_)
        hints, texel_quantity = check_hints(context, declarator, type_, default)
        quantity = quantity or texel_quantity
        location = uniform_location(context, declaration.qualifiers, name, type_, element)
        precision = precision_of(context, declaration.type)
        uniform = ir.Uniform(
            name.text, type_, default, hints, quantity, doc, name.span, path, location=location, precision=precision
        )
        context.globals[name.text] = GlobalValue(type_, quantity, extent=of_uniform(uniform)[:2])
        self.uniforms.append(uniform)
        if isinstance(type_, Sampler) and type_.line:
            message = f"'{name.text}' becomes {a_type(type_._replace(line=False))}: bind a texture of one row"
            context.reporter.warn(name.span, message)

    def default(self, declarator: s.Declarator, type_: Type) -> tuple[float, ...]:
        """The components of a uniform's default value; () for a texture."""
        value = declarator.value
        if value is None:
            return () if isinstance(type_, Sampler) else _identity(type_)
        if self.context.es:
            raise self.context.fail(value.span, "a uniform of GLSL ES has no initial value", "the program sets it")
        if isinstance(type_, Sampler):
            hint = "use default_white, default_black, default_gray or default_bump"
            raise self.context.fail(value.span, "a texture has no default value", hint)
        what = f"'{declarator.name.text}'"
        if isinstance(value, s.Listed):
            numbers = _components(self.expressions.check_as(value, type_, "", what))
        else:
            typed = self.expressions.check(value)._replace(quantity="")
            numbers = _components(self.expressions.require(typed, type_, "", value.span, what))
        if numbers is None:
            hint = "write it as 0.2 or vec3(1.0, 0.5, 0.0)"
            raise self.context.fail(value.span, "a default value must consist of literals", hint)
        return numbers

    def constant(self, declaration: s.Declaration, declarator: s.Declarator) -> None:
        context, name = self.context, declarator.name
        is_macro = declaration.type.name == "auto"
        element, quantity = (VOID, "") if is_macro else named_element(context, declaration.type)
        check_global_name(context, name)
        if declarator.value is None:
            raise context.fail(name.span, f"const '{name.text}' needs a value")
        sequences = context.sequences
        if is_macro:
            value, prelude = self.expressions.with_prelude(
                declarator.value, lambda value: self.expressions.check(value).expr
            )
            type_ = value.type
        else:
            type_ = self.expressions.declared_type(element, declaration.type, declarator)
            value, prelude = self.expressions.with_prelude(
                declarator.value, lambda value: self.expressions.check_as(value, type_, quantity, f"'{name.text}'")
            )
        check_sequences(context, sequences, declarator.value.span)
        if prelude or not is_constant(context, value):
            message = f"the value of const '{name.text}' is not constant"
            raise context.fail(declarator.value.span, message, "use literals, other constants and builtins")
        context.globals[name.text] = GlobalValue(type_, quantity, constant_value(context, value), True)
        self.constants.append(ir.Constant(name.text, type_, value, name.span))


def _components(value: ir.Expr) -> tuple[float, ...] | None:
    """The numbers of a constant made of literals, or None."""
    if isinstance(value, ir.Literal):
        return (float(value.value),)
    if not isinstance(value, ir.Construct) or not value.args:
        return None
    parts = [_components(arg) for arg in value.args]
    flat = tuple(number for part in parts if part is not None for number in part)
    if None in parts or (kind_of(value.type) and kind_of(value.type) != kind_of(value.args[0].type)):
        return None
    if len(flat) == 1 and isinstance(value.type, Matrix):
        return tuple(flat[0] * entry for entry in _identity(value.type))
    if len(flat) == 1:
        flat *= components(value.type)
    return flat if len(flat) == components(value.type) else None


def _identity(type_: Type) -> tuple[float, ...]:
    """The default of a uniform without one: zeros, or the identity matrix."""
    if isinstance(type_, Matrix):
        return tuple(1.0 if row == column else 0.0 for column in range(type_.columns) for row in range(type_.rows))
    if isinstance(type_, Array):
        return _identity(type_.element) * type_.length
    return (0.0,) * components(type_)
