"""Replaces arrays of a stage's interface that a target cannot have: GLSL ES 3.00 has no attributes that are arrays, and
takes only constant indices into the outputs of a fragment shader, of arrays and of vectors.

Each element of an attribute becomes an attribute, `p[2]` becomes `p_0` and `p_1`, and main() begins with a copy of them
into a variable. An output with other indices is a variable that main() copies to the output at its ends. Place: before
`legalise`, to which the copies are ordinary code.
"""

from __future__ import annotations

from collections.abc import Iterator

from sssgen.ir import nodes as ir
from sssgen.ir.transform import rewrite_module
from sssgen.ir.types import INT, Array, Matrix
from sssgen.ir.walk import all_expressions, operands
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.scopes import claim, names_of
from sssgen.passes.stage.entry_copies import copies_last


def interface_arrays(module: ir.Module, kind: str, entry: str, can: Capabilities) -> ir.Module:
    """A whole shader of this kind with arrays in its interface that the target has; `entry` is the key of main()."""
    if kind == "vertex" and not can.array_attributes:
        attributes = [each for each in module.variables if each.storage == "in" and isinstance(each.type, Array)]
        return _with_single_attributes(module, attributes, entry) if attributes else module
    if kind == "fragment" and not can.dynamic_outputs:
        indexed = set(_varying_indices(module))
        outputs = [each for each in module.variables if each.storage == "out" and each.name in indexed]
        return _with_copied_outputs(module, outputs, entry) if outputs else module
    return module


def _with_single_attributes(module: ir.Module, attributes: list[ir.Variable], entry: str) -> ir.Module:
    taken = names_of(module)
    variables = list(module.variables)
    copies: list[ir.Stmt] = []
    for attribute in attributes:
        index = variables.index(attribute)
        assert isinstance(attribute.type, Array)
        element = attribute.type.element
        places = element.columns if isinstance(element, Matrix) else 1
        variables[index] = attribute._replace(storage="private", location=-1, interpolation="")
        for number in range(attribute.type.length):
            location = attribute.location + places * number if attribute.location >= 0 else -1
            name = claim(f"{attribute.name}_{number}", taken)
            single = attribute._replace(name=name, type=element, location=location)
            variables.insert(index + number, single)
            copies.append(_copy(_element(attribute, attribute.name, number), ir.Global(element, name, attribute.span)))
    functions = [
        function.begun_with(tuple(copies)) if function.key == entry else function for function in module.functions
    ]
    return module._replace(variables=tuple(variables), functions=tuple(functions))


def _with_copied_outputs(module: ir.Module, outputs: list[ir.Variable], entry: str) -> ir.Module:
    taken = names_of(module)
    names = {output.name: claim(f"{output.name}_values", taken) for output in outputs}

    def change(expr: ir.Expr) -> ir.Expr:
        is_output = isinstance(expr, ir.Global) and expr.name in names
        return expr._replace(name=names[expr.name]) if is_output and isinstance(expr, ir.Global) else expr

    module = rewrite_module(module, change)
    copies = tuple(
        [
            _copy(part, copied)
            for output in outputs
            for part, copied in zip(_parts(output, output.name), _parts(output, names[output.name]), strict=True)
        ]
    )

    functions = [copies_last(function, copies) if function.key == entry else function for function in module.functions]
    private = [
        output._replace(name=names[output.name], storage="private", location=-1, builtin="", interpolation="")
        for output in outputs
    ]
    return module._replace(variables=(*module.variables, *private), functions=tuple(functions))


def _varying_indices(module: ir.Module) -> Iterator[str]:
    """The names of variables with an index that is not constant, and of arrays that are read or written as a whole."""
    for function in module.functions:
        for expr in all_expressions(function.body or ()):
            for part in operands(expr):
                if not isinstance(part, ir.Global):
                    continue
                if isinstance(expr, ir.Index) and part is expr.value:
                    if not isinstance(expr.index, ir.Literal):
                        yield part.name
                elif isinstance(part.type, Array):
                    yield part.name


def _parts(output: ir.Variable, name: str) -> list[ir.Expr]:
    """The elements of an output, or of its copy with another name; a vector as a whole."""
    if isinstance(output.type, Array):
        return [_element(output, name, number) for number in range(output.type.length)]
    return [ir.Global(output.type, name, output.span)]


def _element(variable: ir.Variable, name: str, number: int) -> ir.Index:
    assert isinstance(variable.type, Array)
    span = variable.span
    index = ir.Literal(INT, number, span)
    return ir.Index(variable.type.element, ir.Global(variable.type, name, span), index, span)


def _copy(target: ir.Expr, value: ir.Expr) -> ir.Assign:
    return ir.Assign(target, "", value, target.span)
