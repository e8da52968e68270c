"""Passes uniforms and textures to functions as parameters, for targets whose text cannot declare
them.

Why: a function library to paste, or an engine's custom-function node, gets its parameters from its caller.
Place: after `prune` and `hoist`, so that only uniforms that are read are passed; before `legalise` and `names`, which
legalise the new parameters and their names.
"""

from __future__ import annotations

from collections.abc import Container, Mapping

from sssgen.ir.nodes import Call, Expr, Function, Global, Local, Module, Param, function_key
from sssgen.ir.transform import rewrite_function
from sssgen.ir.types import Sampler
from sssgen.ir.walk import callees
from sssgen.passes.scopes import declared, fresh, globals_of, rename_locals


def uniforms_to_parameters(module: Module, textures: bool = True) -> Module:
    """The module with the uniforms that each function or its callees read as parameters of the function.

    They come after its own parameters, in the order of the uniforms' declarations, with their names; a
    variable of that name is renamed. `module.uniforms` stays for the documentation. Without `textures` these
    remain global. The keys of functions change with their parameters.
    """
    uniforms = {
        uniform.name: uniform for uniform in module.uniforms if textures or not isinstance(uniform.type, Sampler)
    }
    parameters = {
        name: Param(name, uniform.type, "in", uniform.quantity, uniform.span, name)
        for name, uniform in uniforms.items()
    }
    if not parameters:
        return module
    closer = Closer(module, parameters, {})
    return module._replace(functions=closer.run())


class Closer:
    """Gives functions parameters for the globals that they or their callees use.

    `parameters` are the globals with their parameters; `written` has those that a function writes, by its key: they
    are inout there.
    """

    def __init__(self, module: Module, parameters: Mapping[str, Param], written: Mapping[str, Container[str]]) -> None:
        self.parameters, self.written = parameters, written
        self.functions = {function.key: function for function in module.functions}
        self.order = {name: position for position, name in enumerate(parameters)}
        self.reads: dict[str, list[str]] = {}
        self.names: dict[str, str] = {}
        """The new name of each function, by its old key: another overload may have the new parameter types."""
        self.keys: dict[str, str] = {}
        taken = set[str]()
        # unchanged functions come first, so that the others avoid their names
        for key, function in sorted(self.functions.items(), key=lambda item: bool(self.uses(item[0]))):
            types = [param.type for param in function.params]
            types += [parameters[name].type for name in self.uses(key)]
            name, count = function.name, 2
            while function_key(name, types) in taken:
                name, count = f"{function.name}_{count}", count + 1
            self.names[key], self.keys[key] = name, function_key(name, types)
            taken.add(self.keys[key])

    def run(self) -> tuple[Function, ...]:
        """The functions with their new parameters, in the order they had."""
        return tuple([self.function(key, function) for key, function in self.functions.items()])

    def uses(self, key: str) -> list[str]:
        """The globals that a function uses, in the order of their declaration."""
        ordered = self.reads.get(key)
        if ordered is None:
            names, self.reads[key] = set[str](), []
            if key in self.functions:
                names = globals_of(self.functions[key]) & self.parameters.keys()
                names.update(*map(self.uses, callees(self.functions[key])))
            ordered = self.reads[key] = sorted(names, key=self.order.__getitem__)
        return ordered

    def function(self, key: str, function: Function) -> Function:
        names = self.uses(key)
        if not names:
            return function
        hidden = set(names) & set(declared(function))
        if hidden:
            function, _ = rename_locals(function, hidden, fresh, taken=names)

        def change(node: Expr) -> Expr:
            if type(node) is Global and node.name in self.parameters:
                return Local(node.type, node.name, node.span)
            if type(node) is Call and self.reads.get(node.function):
                extra = [Local(self.parameters[name].type, name, node.span) for name in self.uses(node.function)]
                return Call(node.type, self.keys[node.function], (*node.args, *extra), node.span)
            return node

        function = rewrite_function(function, change)
        written = self.written.get(key, ())
        params = [self.parameters[name]._replace(direction="inout" if name in written else "in") for name in names]
        return function._replace(name=self.names[key], params=(*function.params, *params))
