"""What a whole shader has beside functions: inputs, outputs, variables of its own, blocks, and the gl_ variables."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from sssgen.ir import nodes as ir
from sssgen.ir.types import BOOL, FLOAT, INT, VEC2, VEC4, VOID, Array, Sampler, Type
from sssgen.ir.walk import subexpressions
from sssgen.lang.check.expression_checker import Typed
from sssgen.lang.check.name_scope import GlobalValue
from sssgen.lang.check.wording import a_type
from sssgen.lang.syntax import tree as s

if TYPE_CHECKING:
    from sssgen.lang.check.statement_checker import StatementChecker

BUILTIN_VARIABLES: dict[str, tuple[Type, str]] = {
    "gl_FragCoord": (VEC4, "in"),
    "gl_FrontFacing": (BOOL, "in"),
    "gl_PointCoord": (VEC2, "in"),
    "gl_VertexID": (INT, "in"),
    "gl_VertexIndex": (INT, "in"),
    "gl_InstanceID": (INT, "in"),
    "gl_InstanceIndex": (INT, "in"),
    "gl_Position": (VEC4, "out"),
    "gl_PointSize": (FLOAT, "out"),
    "gl_FragDepth": (FLOAT, "out"),
    "gl_FragDepthEXT": (FLOAT, "out"),
    "gl_FragColor": (VEC4, "out"),
    "gl_FragData": (Array(VEC4, 8), "out"),
}
"""The variables of GLSL that other languages have, too, and whether a stage reads or gives them."""

MAXIMA = {
    "gl_MaxDrawBuffers": 8, "gl_MaxTextureImageUnits": 16, "gl_MaxVertexAttribs": 16, "gl_MaxVertexUniformVectors": 256,
    "gl_MaxFragmentUniformVectors": 256, "gl_MaxVaryingVectors": 15, "gl_MaxCombinedTextureImageUnits": 32,
    "gl_MaxVertexTextureImageUnits": 16,
}  # fmt: skip
"""GLSL's constants, as WebGPU guarantees them."""

_SAME = {"gl_FragDepthEXT": "gl_FragDepth", "gl_VertexIndex": "gl_VertexID", "gl_InstanceIndex": "gl_InstanceID"}


class Interface:
    """Collects the uniforms and variables of one file."""

    def __init__(self, checker: StatementChecker, vertex: bool) -> None:
        self.checker = checker
        self.vertex = vertex
        self.uniforms: list[ir.Uniform] = []
        self.variables: dict[str, ir.Variable] = {}

    def declare(self, declaration: s.Declaration, doc: str) -> None:
        """Inputs, outputs, and variables of the module."""
        checker, words = self.checker, declaration.qualifiers.words
        if "buffer" in words or "shared" in words:
            message = "storage buffers and shared memory belong to compute shaders"
            raise checker.fail(declaration.qualifiers.span, message)
        storage = self.storage(words)
        element, quantity = checker.type_named(replace(declaration.type, lengths=()))
        for declarator in declaration.declarators:
            name, span = declarator.name.text, declarator.name.span
            if name in BUILTIN_VARIABLES:
                if any(item == "origin_upper_left" for item, _ in declaration.qualifiers.layout):
                    hint = "take the picture's height minus it"
                    raise checker.fail(span, "gl_FragCoord cannot be made to count from the top", hint)
                self.builtin(declarator.name)  # declared again for its qualifiers
                continue
            checker.new_name(declarator.name)
            type_ = checker.declared_type(element, declaration.type, declarator)
            if type_ == VOID or isinstance(type_, Sampler):
                hint = "write uniform before it" if isinstance(type_, Sampler) else ""
                raise checker.fail(declaration.type.span, f"a variable cannot be {a_type(type_)}", hint)
            value = None
            if declarator.value is not None:
                value, before = checker.apart(
                    declarator.value,
                    lambda given: checker.check_as(given, type_, quantity, f"'{name}'"),  # noqa: B023
                )
                if before or any(isinstance(part, ir.Call) for part in subexpressions(value)):
                    hint = "set it at the beginning of main()"
                    raise checker.fail(
                        declarator.value.span, "a variable of the module begins with a plain value", hint
                    )
            interpolation = next((word for word in words if word in ("flat", "noperspective", "centroid")), "")
            location = self.location(declaration.qualifiers)
            if storage == "private":
                interpolation, location = "", -1
            self.variables[name] = ir.Variable(name, type_, storage, value, "", interpolation, location, doc, span)
            checker.globals[name] = GlobalValue(type_, quantity, writable=storage != "in")

    def textures(self, declaration: s.Declaration, declarator: s.Declarator) -> list[s.Declarator]:
        """A uniform as it is, but an array of textures as a uniform for each."""
        checker, name = self.checker, declarator.name
        lengths = (*declarator.lengths, *declaration.type.lengths)
        if not checker.plain or len(lengths) != 1 or "sampler" not in declaration.type.name:
            return [declarator]
        count = checker.constant_int(lengths[0])
        if count is None or not 1 <= count <= 64:
            raise checker.fail(lengths[0].span, "an array of textures has a constant length from 1 to 64")
        names = [self.free(f"{name.text}_{index}") for index in range(count)]
        checker.texture_arrays[name.text] = names
        return [replace(declarator, name=replace(name, text=one), lengths=()) for one in names]

    def storage(self, words: tuple[str, ...]) -> str:
        """private, in or out: what an attribute and a varying are depends on the stage."""
        if "attribute" in words:
            return "in"
        if "varying" in words:
            return "out" if self.vertex else "in"
        return next((word for word in words if word in ("in", "out")), "private")

    def location(self, qualifiers: s.Qualifiers) -> int:
        """What `layout(location = n)` says, or -1."""
        for name, value in qualifiers.layout:
            if name == "location" and value is not None:
                number = self.checker.constant_int(value)
                if number is None or not 0 <= number < 64:
                    raise self.checker.fail(value.span, "a location is a whole number from 0 to 63")
                return number
        return -1

    def members(self, block: s.BlockSyntax) -> list[s.GlobalSyntax]:
        """The members of a block, as uniforms, inputs or outputs of their own."""
        checker, words = self.checker, block.qualifiers.words
        if not checker.plain:
            raise checker.fail(block.name.span, "there are no blocks in the language of techniques", "write uniform …;")
        if "buffer" in words:
            raise checker.fail(block.name.span, "storage buffers belong to compute shaders")
        if block.lengths:
            raise checker.fail(block.lengths[0].span, "there are no arrays of blocks", "declare one block of arrays")
        if block.name.text == "gl_PerVertex":
            return []
        members: list[s.GlobalSyntax] = []
        for member in block.members:
            renamed = []
            for declarator in member.declarators:
                label = declarator.name
                if block.instance is not None:
                    label = replace(label, text=self.free(f"{block.instance.text}_{label.text}"))
                renamed.append(replace(declarator, name=label))
            own = [word for word in member.qualifiers.words if word not in words]
            location = member.qualifiers.layout or block.qualifiers.layout
            qualifiers = s.Qualifiers((*words, *own), location, block.qualifiers.span)
            declaration = replace(member, qualifiers=qualifiers, declarators=tuple(renamed))
            members.append(s.GlobalSyntax(declaration, block.doc))
        return members

    def name_instance(self, block: s.BlockSyntax, members: list[s.GlobalSyntax]) -> None:
        """Makes the declared members of a block known by its instance name."""
        if block.instance is None:
            return
        globals_, instance = self.checker.globals, self.checker.instances.setdefault(block.instance.text, {})
        for written, member in zip(block.members, members, strict=True):
            for declarator, renamed in zip(written.declarators, member.declaration.declarators, strict=True):
                label = renamed.name
                value = ir.Global(globals_[label.text].type, label.text, label.span)
                instance[declarator.name.text] = Typed(value)

    def free(self, name: str) -> str:
        """A name for a member of a block that nothing else has."""
        taken, count, chosen = self.checker, 2, name
        while chosen in taken.globals or chosen in taken.functions or chosen in taken.structs:
            chosen, count = f"{name}_{count}", count + 1
        return chosen

    def builtin(self, name: s.Name) -> GlobalValue | None:
        """What a gl_ name stands for; it is declared when it is first used."""
        text = name.text
        if text in MAXIMA:
            return GlobalValue(INT, "", MAXIMA[text], True)
        if text not in BUILTIN_VARIABLES:
            return None
        type_, storage = BUILTIN_VARIABLES[text]
        self.variables[text] = ir.Variable(text, type_, storage, None, _SAME.get(text, text), "", -1, "", name.span)
        value = self.checker.globals[text] = GlobalValue(type_, "", writable=storage == "out")
        return value
