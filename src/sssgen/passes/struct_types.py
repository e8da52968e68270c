"""Replaces struct types, which are in the type of every node. Used by the passes that rename structs."""

from __future__ import annotations

from collections.abc import Mapping

from sssgen.ir.nodes import Block, Call, Declare, Expr, Function, Member, Module, Stmt, function_key
from sssgen.ir.transform import rewrite, rewrite_block
from sssgen.ir.types import Array, Struct, Type, spell


class Retyper:
    """Replaces the types in `structs`; `members`: the new struct's name and a member's old name → its new name."""

    def __init__(self, structs: Mapping[Type, Type], members: Mapping[tuple[str, str], str]) -> None:
        self.structs, self.members = structs, members

    def type(self, type: Type) -> Type:
        """A type with the new structs."""
        if isinstance(type, Array):
            element = self.type(type.element)
            return type if element is type.element else Array(element, type.length)
        return self.structs.get(type, type)

    def node(self, node: Expr) -> Expr:
        """A node with the new structs, after those inside it."""
        if isinstance(node, Member):
            node = node._replace(field=self.members.get((spell(node.value.type), node.field), node.field))
        type_ = self.type(node.type)
        return node if type_ is node.type else node._replace(type=type_)

    def function(self, function: Function) -> Function:
        """A function with the new structs; its calls keep their old keys."""
        params = tuple([param._replace(type=self.type(param.type)) for param in function.params])

        def restate(stmt: Stmt) -> Block | None:
            return (stmt._replace(type=self.type(stmt.type)),) if isinstance(stmt, Declare) else None

        body = rewrite_block(function.body, self.node, restate) if function.body is not None else None
        return function._replace(params=params, result=self.type(function.result), body=body)


def rename_structs(module: Module, names: Mapping[str, str]) -> Module:
    """The module with structs renamed: old name → new name. Its uniforms and variables hold no structs."""
    structs: dict[Type, Type] = {}
    retyper = Retyper(structs, {})
    for declaration in module.structs:
        struct = declaration.type
        assert isinstance(struct, Struct)
        fields = tuple([field._replace(type=retyper.type(field.type)) for field in struct.fields])
        changed = Struct(names.get(struct.name, struct.name), fields)
        if changed != struct:
            structs[struct] = changed
    keys = {
        function.key: function_key(function.name, [retyper.type(param.type) for param in function.params])
        for function in module.functions
    }

    def recall(node: Expr) -> Expr:
        node = retyper.node(node)
        return node._replace(function=keys.get(node.function, node.function)) if isinstance(node, Call) else node

    functions = []
    for function in map(retyper.function, module.functions):
        body = rewrite_block(function.body, recall) if function.body is not None else None
        functions.append(function._replace(body=body))
    constants = [
        constant._replace(type=retyper.type(constant.type), value=rewrite(constant.value, retyper.node))
        for constant in module.constants
    ]
    declarations = [declaration._replace(type=retyper.type(declaration.type)) for declaration in module.structs]
    return module._replace(structs=tuple(declarations), constants=tuple(constants), functions=tuple(functions))
