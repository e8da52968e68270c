"""Arrays of arrays as arrays of structs that hold an array, for languages without the former.

Why: GLSL 3.30 and ES 3.00 have none. A struct can be copied, passed and indexed everywhere, so `a[i]` becomes
`a[i].items`, and nothing else changes. Place: before `legalise`, which sees the structs.
"""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite, rewrite_block
from sssgen.ir.types import Array, Field, Struct, Type, spell, unnested
from sssgen.ir.walk import all_expressions, statements
from sssgen.passes.scopes import claim, names_of

ITEMS = "items"


def nested_arrays(module: ir.Module) -> ir.Module:
    """The module without arrays of arrays."""
    return _Wrapper(module).run() if any(_is_nested(type_) for type_ in _types(module)) else module


def _is_nested(type_: Type) -> bool:
    return isinstance(type_, Array) and isinstance(type_.element, Array)


def _types(module: ir.Module) -> list[Type]:
    """The types of all declarations and values that may be arrays of arrays."""
    types = [field.type for struct in module.structs if isinstance(struct.type, Struct) for field in struct.type.fields]
    types += [declaration.type for declaration in (*module.constants, *module.variables)]
    for function in module.functions:
        types += [function.result, *[param.type for param in function.params]]
        types += [stmt.type for stmt in statements(function.body or ()) if isinstance(stmt, ir.Declare)]
        types += [expr.type for expr in all_expressions(function.body or ()) if isinstance(expr, ir.Construct)]
    return types


class _Wrapper:
    def __init__(self, module: ir.Module) -> None:
        self.module = module
        self.taken = names_of(module)
        self.rows: dict[Type, Struct] = {}
        """The struct for each array that is an element of another."""
        self.structs: list[ir.StructDecl] = []
        self.changed: dict[Type, Type] = {}
        """The structs of the module by their old types."""
        self.keys: dict[str, str] = {}

    def run(self) -> ir.Module:
        module = self.module
        for declaration in module.structs:
            struct = declaration.type
            assert isinstance(struct, Struct)
            fields = tuple([field._replace(type=self.type(field.type)) for field in struct.fields])
            self.changed[struct] = Struct(struct.name, fields)
            self.structs.append(declaration._replace(type=self.changed[struct]))
        for function in module.functions:
            types = [self.type(param.type) for param in function.params]
            self.keys[function.key] = ir.function_key(function.name, types)
        constants = [
            each._replace(type=self.type(each.type), value=rewrite(each.value, self.node)) for each in module.constants
        ]
        variables = [
            each._replace(type=self.type(each.type), value=each.value and rewrite(each.value, self.node))
            for each in module.variables
        ]
        functions = tuple(map(self.function, module.functions))
        return module._replace(
            structs=tuple(self.structs), constants=tuple(constants), variables=tuple(variables), functions=functions
        )

    def type(self, type_: Type) -> Type:
        """A type without arrays of arrays."""
        if not isinstance(type_, Array):
            return self.changed.get(type_, type_)
        element = self.type(type_.element)
        return Array(self.row(element) if isinstance(element, Array) else element, type_.length)

    def row(self, array: Array) -> Struct:
        """The struct that holds an array."""
        if array not in self.rows:
            innermost, lengths = unnested(array)
            name = spell(innermost)
            name = claim(f"{name[0].upper()}{name[1:]}Row{'x'.join(map(str, lengths))}", self.taken)
            self.rows[array] = Struct(name, (Field(ITEMS, array),))
            self.structs.append(ir.StructDecl(self.rows[array], "", ir.NOWHERE))
        return self.rows[array]

    def function(self, function: ir.Function) -> ir.Function:
        params = tuple([param._replace(type=self.type(param.type)) for param in function.params])
        body = rewrite_block(function.body, self.node, self.restate) if function.body is not None else None
        return function._replace(params=params, result=self.type(function.result), body=body)

    def restate(self, stmt: ir.Stmt) -> ir.Block | None:
        return (stmt._replace(type=self.type(stmt.type)),) if isinstance(stmt, ir.Declare) else None

    def node(self, node: ir.Expr) -> ir.Expr:
        """A node whose operands are rewritten."""
        type_ = self.type(node.type)
        if isinstance(node, ir.Call):
            node = node._replace(function=self.keys.get(node.function, node.function))
        elif isinstance(node, ir.Construct) and _is_nested(node.type) and isinstance(type_, Array):
            args = tuple([ir.Construct(type_.element, (arg,), arg.span) for arg in node.args])
            return ir.Construct(type_, args, node.span)
        elif isinstance(node, ir.Index) and isinstance(node.type, Array) and isinstance(node.value.type, Array):
            row = node._replace(type=node.value.type.element)
            return ir.Member(type_, row, ITEMS, node.span)
        return node._replace(type=type_)
