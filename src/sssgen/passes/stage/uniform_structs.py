"""Splits uniforms that are structs, or arrays of them: each member becomes a uniform of its own.

An array of arrays becomes one array, element after element, which has the same layout.

Why: the layout of a struct in a uniform block differs between languages, and an engine's material has no such
parameters. `uniform Light lights[4]` gives `uniform vec3 lights_color[4]`: arrays of members. A nested member's name is
formed the same way. A struct that is read as a whole
is constructed. Place: first of all, as no other pass handles these.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import prod
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite, rewrite_module
from sssgen.ir.types import INT, Array, Struct, Type, components
from sssgen.ir.walk import operands, subexpressions, with_operands
from sssgen.passes.scopes import claim, names_of
from sssgen.passes.unsupported import Unsupported

Path = tuple[str, ...]
"""A uniform's name and those of its members, down to one of them."""


class _Leaf(NamedTuple):
    """A member that holds no struct: the uniform that replaces it."""

    name: str
    lengths: tuple[int, ...]
    """Of the arrays around it, its own last."""
    element: Type

    @property
    def type(self) -> Type:
        return Array(self.element, prod(self.lengths)) if self.lengths else self.element


def uniform_structs(module: ir.Module, kept: bool = False) -> ir.Module:
    """The module without uniforms that hold structs. Raises Unsupported.

    Where structs are `kept`, those are split that have arrays of arrays, a value, or a block around them.
    """
    split = {
        uniform.name: uniform.type
        for uniform in module.uniforms
        if _is_split(uniform.type)
        and (not kept or uniform.block or any(uniform.default) or _nests_arrays(uniform.type))
    }
    return _Splitter(module, split).run() if split else module


def members(uniform: ir.Uniform) -> Iterator[ir.Uniform]:
    """A uniform, or its members that hold no struct, each as a uniform with the name that a program gives it."""
    if not _is_split(uniform.type):
        yield uniform
        return
    numbers = uniform.default or (0.0,) * components(uniform.type)
    for path, lengths, element, default in _members((uniform.source,), uniform.type, (), [numbers]):
        leaf = _Leaf("", lengths, element)
        spelt = _host_name(path, uniform.type)
        yield uniform._replace(name=spelt, type=leaf.type, default=default, path=spelt)


def _is_split(type_: Type) -> bool:
    """Whether it is a struct, or an array of structs or arrays."""
    return isinstance(type_, Struct) or (isinstance(type_, Array) and isinstance(type_.element, Array | Struct))


def _nests_arrays(type_: Type) -> bool:
    """Whether it is an array of arrays, or has a member that is."""
    if isinstance(type_, Array):
        return isinstance(type_.element, Array) or _nests_arrays(type_.element)
    return isinstance(type_, Struct) and any(_nests_arrays(field.type) for field in type_.fields)


class _Splitter:
    def __init__(self, module: ir.Module, split: Mapping[str, Type]) -> None:
        self.module = module
        self.taken = names_of(module)
        self.split = split
        self.leaves: dict[Path, _Leaf] = {}

    def run(self) -> ir.Module:
        uniforms = tuple([part for uniform in self.module.uniforms for part in self.parts(uniform)])
        variables = [
            variable._replace(value=self.whole(rewrite(variable.value, self.change))) if variable.value else variable
            for variable in self.module.variables
        ]
        module = self.module._replace(uniforms=uniforms, variables=tuple(variables))
        return rewrite_module(module, self.change, self.restate)

    def parts(self, uniform: ir.Uniform) -> Iterator[ir.Uniform]:
        """The uniforms that replace one."""
        if uniform.name not in self.split:
            yield uniform
            return
        numbers = uniform.default or (0.0,) * components(uniform.type)
        for path, lengths, element, default in _members((uniform.name,), uniform.type, (), [numbers]):
            name = claim("_".join(path), self.taken) if len(path) > 1 else uniform.name
            leaf = self.leaves[path] = _Leaf(name, lengths, element)
            spelt = _host_name((uniform.path or uniform.name, *path[1:]), uniform.type)
            yield uniform._replace(name=name, type=leaf.type, default=default, path=spelt)

    # Rewriting, from the leaves up: a chain of members and indices is rewritten as a whole, at its end

    def change(self, node: ir.Expr) -> ir.Expr:
        """A node whose operands are rewritten."""
        if self.waits(node):
            return node if isinstance(node.type, Struct | Array) else self.read(node)
        old = operands(node)
        if not any(map(self.waits, old)):
            return node
        return with_operands(node, tuple([self.whole(operand) for operand in old]))

    def restate(self, stmt: ir.Stmt) -> ir.Block | None:
        """A statement whose value is a whole struct or array."""
        if isinstance(stmt, ir.For) and stmt.init is not None:
            init = self.restate(stmt.init)
            return None if init is None else (stmt._replace(init=init[0]),)
        if isinstance(stmt, ir.Declare | ir.Assign | ir.Return) and stmt.value is not None and self.waits(stmt.value):
            return (stmt._replace(value=self.whole(stmt.value)),)
        return None

    def waits(self, node: ir.Expr) -> bool:
        """Whether it is a split uniform, or a member or element of one."""
        while isinstance(node, ir.Member | ir.Index):
            node = node.value
        # the new uniform may have its name
        return isinstance(node, ir.Global) and self.split.get(node.name) == node.type

    def whole(self, node: ir.Expr) -> ir.Expr:
        """The value of a chain; any other expression unchanged."""
        return self.read(node) if self.waits(node) else node

    def read(self, node: ir.Expr) -> ir.Expr:
        path, indices = _split_chain(node)
        leaf = self.leaves.get(path)
        whole = not indices and leaf is not None and len(leaf.lengths) == 1
        if leaf is not None and (len(indices) == len(leaf.lengths) or whole):
            return self.element(leaf, indices, node.span)
        for index in indices:
            if any(isinstance(part, ir.Call) for part in subexpressions(index)):
                raise Unsupported("this index is used more than once: store it in a variable first", index.span)
        if isinstance(node.type, Struct):
            values = [self.read(ir.Member(field.type, node, field.name, node.span)) for field in node.type.fields]
            return ir.Construct(node.type, tuple(values), node.span)
        assert isinstance(node.type, Array)
        positions = [ir.Literal(INT, index, node.span) for index in range(node.type.length)]
        values = [self.read(ir.Index(node.type.element, node, position, node.span)) for position in positions]
        return ir.Construct(node.type, tuple(values), node.span)

    def element(self, leaf: _Leaf, indices: list[ir.Expr], span: ir.Span) -> ir.Expr:
        """One element of a leaf; all of it where there are no indices."""
        value = ir.Global(leaf.type, leaf.name, span)
        if not indices:
            return value
        position = indices[0]
        for length, index in zip(leaf.lengths[1:], indices[1:], strict=True):
            position = _sum(_product(_whole_number(position), length), _whole_number(index))
        return ir.Index(leaf.element, value, position, span)


def _split_chain(node: ir.Expr) -> tuple[Path, list[ir.Expr]]:
    """The path of a chain, and its indices from the outermost array on."""
    names: list[str] = []
    indices: list[ir.Expr] = []
    while isinstance(node, ir.Member | ir.Index):
        if isinstance(node, ir.Member):
            names.append(node.field)
        else:
            indices.append(node.index)
        node = node.value
    assert isinstance(node, ir.Global)
    return (node.name, *reversed(names)), indices[::-1]


def _members(
    path: Path, type_: Type, lengths: tuple[int, ...], numbers: list[tuple[float, ...]]
) -> Iterator[tuple[Path, tuple[int, ...], Type, tuple[float, ...]]]:
    """Each leaf with the arrays around it and its default. `numbers` are those of each element of the outer arrays."""
    if isinstance(type_, Struct):
        start = 0
        for field in type_.fields:
            end = start + components(field.type)
            yield from _members((*path, field.name), field.type, lengths, [element[start:end] for element in numbers])
            start = end
    elif isinstance(type_, Array):
        size = components(type_.element)
        parts = [
            element[start_ : start_ + size] for element in numbers for start_ in range(0, size * type_.length, size)
        ]
        yield from _members(path, type_.element, (*lengths, type_.length), parts)
    else:
        yield path, lengths, type_, tuple([number for element in numbers for number in element])


def _host_name(path: Path, type_: Type) -> str:
    """A member as a program names it, with the lengths of the arrays: `lights[2].color`."""
    text = path[0]
    for field in (*path[1:], ""):
        while isinstance(type_, Array):
            text += f"[{type_.length}]"
            type_ = type_.element
        if field:
            assert isinstance(type_, Struct)
            text += f".{field}"
            type_ = next(member.type for member in type_.fields if member.name == field)
    return text


def _whole_number(index: ir.Expr) -> ir.Expr:
    return index if index.type == INT else ir.Construct(INT, (index,), index.span)


def _product(left: ir.Expr, right: int) -> ir.Expr:
    if isinstance(left, ir.Literal):
        return left._replace(value=int(left.value) * right)
    return ir.Binary(INT, "*", left, ir.Literal(INT, right, left.span), left.span)


def _sum(left: ir.Expr, right: ir.Expr) -> ir.Expr:
    if isinstance(left, ir.Literal) and isinstance(right, ir.Literal):
        return left._replace(value=int(left.value) + int(right.value))
    for first, second in ((left, right), (right, left)):
        if isinstance(first, ir.Literal) and first.value == 0:
            return second
    return ir.Binary(INT, "+", left, right, right.span)
