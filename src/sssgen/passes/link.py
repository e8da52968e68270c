"""Links the techniques of a material into one module: slots are bound, uniforms get one name each, without duplicates.

First of all passes: everything after it sees one closed module without slots. A function that two stages use alike
appears once, also where it is in a file of each; one that they use differently (for example with another distance
function bound to its slot) appears once for each. A constant of equal name and value appears once, too.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import NamedTuple

from sssgen.ir.frame_passes import pass_name
from sssgen.ir.nodes import Call, Constant, Expr, Function, Global, Module, Span, StructDecl, Uniform
from sssgen.ir.text import print_meaning
from sssgen.ir.transform import rewrite, rewrite_function
from sssgen.ir.types import Sampler, Struct, spell
from sssgen.ir.walk import all_expressions, subexpressions
from sssgen.passes.scopes import fresh
from sssgen.passes.struct_types import rename_structs

Bound = tuple[Module, Function]


class LinkInput(NamedTuple):
    """One stage of a chain, as the linker sees it."""

    technique: str
    role: str
    module: Module
    function: Function
    bindings: Mapping[str, Bound]
    """Slot name → the function that is bound to it, with its module."""
    values: Mapping[str, tuple[float, ...]]
    """Uniform → the default that the material gives it."""
    fixed: frozenset[str]
    """Uniforms that the material folds into the text."""
    number: int = 0
    """The stage of the material: functions with the same number share its parameters."""
    levels: tuple[int, ...] = ()
    """The levels of detail that it belongs to: those with the same levels share the parameters of included files."""
    files: Mapping[str, str] = {}
    """Texture → its file: levels of detail share a technique's texture where its file is the same."""


class LinkedModule(NamedTuple):
    """One module for all stages."""

    module: Module
    functions: tuple[Function, ...]
    """The linked function of each stage."""
    fixed: dict[str, tuple[float, ...]]
    """The uniforms to fold, by their name in `module`, with their values."""
    owners: dict[str, tuple[str, str]]
    """Each uniform's technique and its name there."""
    settings: dict[str, list[tuple[int, str]]]
    """The numbers of each uniform's stages, in their order, and its name there: the last one to give it a value
    decides."""


class LinkError(Exception):
    """The reason why techniques cannot be linked, with its place."""

    def __init__(self, message: str, span: Span, hint: str = "") -> None:
        super().__init__(message)
        self.message, self.span, self.hint = message, span, hint


def link(stages: Sequence[LinkInput], taken: Collection[str] = ()) -> LinkedModule:
    """Links the stages; no struct, uniform, constant or function gets a name that is `taken`.

    Raises LinkError for an unbound slot or two structs of one name.
    """
    linker = _Linker(taken)
    functions = tuple(linker.stage(stage) for stage in stages)
    module = Module(
        tuple(linker.structs.values()),
        tuple(linker.constants.values()),
        tuple(linker.uniforms.values()),
        tuple(linker.functions.values()),
    )
    return LinkedModule(module, functions, linker.fixed, linker.owners, linker.settings)


class _Linker:
    def __init__(self, taken: Collection[str]) -> None:
        self.taken = taken
        self.structs: dict[str, StructDecl] = {}
        self.constants: dict[str, Constant] = {}
        self.uniforms: dict[str, Uniform] = {}
        self.functions: dict[str, Function] = {}
        self.fixed: dict[str, tuple[float, ...]] = {}
        self.owners: dict[str, tuple[str, str]] = {}
        self.settings: dict[str, list[tuple[int, str]]] = {}
        self.instances: dict[object, Function] = {}
        """By what makes them: the place in the source, the functions called and the names read."""
        self.same: dict[str, Function] = {}
        """The same by their meaning, under their own names."""
        self.global_names: dict[object, str] = {}
        """The linked name of each uniform and constant, by its place, and of each constant by its meaning, too."""
        self.sharers: dict[tuple[Span, int], int] = {}
        """By the place of a texture and the number of a stage of some levels: the first stage that has this texture."""
        self.levels_with: dict[tuple[Span, str], dict[int, set[int]]] = {}
        """By the place of a texture: the first stage → the levels of the stages that share it."""
        self.modules: dict[int, tuple[Module, Module]] = {}
        """By its id: a module with structs of taken names, and the same without."""

    def stage(self, stage: LinkInput) -> Function:
        return self.function(stage.function, stage.module, stage.number, stage)

    def function(self, function: Function, module: Module, index: int, stage: LinkInput) -> Function:
        """The linked instance of a function as this stage uses it."""
        if module.variables:
            variable = module.variables[0]
            raise LinkError(f"a technique has no variables outside its functions, as '{variable.name}'", variable.span)
        if any(spell(struct.type) in self.taken for struct in module.structs):
            module = self.with_free_structs(module)
            function = next(other for other in module.functions if other.span == function.span)
        if function.body is None:
            bound = stage.bindings.get(function.name)
            if bound is None:
                raise LinkError(f"slot '{function.name}' of {stage.technique} is not bound", function.span)
            return self.function(bound[1], bound[0], index, stage)
        by_key = {callee.key: callee for callee in module.functions}
        calls: dict[str, str] = {}
        names: dict[str, str] = {}
        for expr in all_expressions(function.body):
            if type(expr) is Call and expr.function not in calls:
                calls[expr.function] = self.function(by_key[expr.function], module, index, stage).key
            elif type(expr) is Global and expr.name not in names:
                names[expr.name] = self.global_name(expr.name, module, index, stage)
        identity = (function.span, tuple(calls.items()), tuple(names.items()))
        if identity in self.instances:
            return self.instances[identity]
        for struct in module.structs:
            self.struct(struct)
        linked = rewrite_function(function, _renaming(calls, names))
        text = print_meaning(linked)
        if text not in self.same:
            name, count = function.name, 2
            while name in self.taken or function._replace(name=name).key in self.functions:
                name, count = f"{function.name}_{count}", count + 1
            linked = linked._replace(name=name)
            self.same[text] = self.functions[linked.key] = linked
        self.instances[identity] = self.same[text]
        return self.same[text]

    def with_free_structs(self, module: Module) -> Module:
        """A module without structs of taken names; the same for each stage that has it."""
        key = id(module)
        if key not in self.modules:
            names = {spell(struct.type) for struct in module.structs}
            new: dict[str, str] = {}
            for name in names & set(self.taken):
                new[name] = fresh(f"{name}_2", names | set(self.taken))
            self.modules[key] = module, rename_structs(module, new)
        return self.modules[key][1]

    def struct(self, struct: StructDecl) -> None:
        assert isinstance(struct.type, Struct)
        first = self.structs.setdefault(struct.type.name, struct)
        if first.type != struct.type:
            raise LinkError(f"two different structs are called '{struct.type.name}'", struct.span)

    def global_name(self, name: str, module: Module, index: int, stage: LinkInput) -> str:
        """The name that a uniform or constant of `module` has in the linked module."""
        for uniform in module.uniforms:
            if uniform.name == name:
                return self.uniform(uniform, index, stage)
        constant = next(constant for constant in module.constants if constant.name == name)
        if constant.span not in self.global_names:
            value = constant.value
            inner = {
                expr.name: self.global_name(expr.name, module, index, stage)
                for expr in subexpressions(value)
                if type(expr) is Global
            }
            if any(old != new for old, new in inner.items()):
                value = rewrite(value, _renaming({}, inner))
            text = print_meaning(constant._replace(value=value))
            if text not in self.global_names:
                linked_name = self.global_names[text] = self.free_name(name, stage.technique)
                self.constants[linked_name] = constant._replace(name=linked_name, value=value)
            self.global_names[constant.span] = self.global_names[text]
        return self.global_names[constant.span]

    def uniform(self, uniform: Uniform, index: int, stage: LinkInput) -> str:
        """A technique's own uniforms are the stage's; those of shared files and bound functions are common.

        All stages share what a pass draws. Levels of detail share textures, but not numbers.
        """
        sharing: int | tuple[int, ...] = () if isinstance(uniform.type, Sampler) else stage.levels
        if pass_name(uniform):
            sharing = ()
        elif uniform.span.file == stage.function.span.file:
            sharing = self.texture_sharer(uniform, index, stage)
        identity = (uniform.span, sharing)
        name = self.global_names.get(identity)
        if name is None:
            name = self.free_name(uniform.name, stage.technique)
            self.global_names[identity] = name
            self.uniforms[name] = uniform._replace(name=name)
            self.owners[name] = (stage.technique, uniform.name)
            self.settings[name] = []
        if (index, uniform.name) not in self.settings[name]:
            self.settings[name].append((index, uniform.name))
        value = stage.values.get(uniform.name)
        if value is not None:
            self.uniforms[name] = self.uniforms[name]._replace(default=value)
        if uniform.name in stage.fixed:
            self.fixed[name] = self.uniforms[name].default
        return name

    def texture_sharer(self, uniform: Uniform, index: int, stage: LinkInput) -> int:
        """The first stage with a technique's own uniform: for a texture one of the same technique and with the same
        file in another level."""
        if not isinstance(uniform.type, Sampler) or not stage.levels:
            return index
        if (uniform.span, index) not in self.sharers:
            groups = self.levels_with.setdefault((uniform.span, stage.files.get(uniform.name, "")), {})
            first = next((first for first, levels in groups.items() if levels.isdisjoint(stage.levels)), index)
            groups.setdefault(first, set()).update(stage.levels)
            self.sharers[uniform.span, index] = first
        return self.sharers[uniform.span, index]

    def free_name(self, name: str, technique: str) -> str:
        taken = self.uniforms.keys() | self.constants.keys() | set(self.taken)
        candidates = [name, f"{technique}_{name}"]
        count = 2
        while candidates[0] in taken:
            candidates.pop(0)
            if not candidates:
                candidates.append(f"{technique}_{name}_{count}")
                count += 1
        return candidates[0]


def _renaming(calls: Mapping[str, str], names: Mapping[str, str]) -> Callable[[Expr], Expr]:
    def change(expr: Expr) -> Expr:
        if type(expr) is Call and calls.get(expr.function, expr.function) != expr.function:
            return expr._replace(function=calls[expr.function])
        if type(expr) is Global and names.get(expr.name, expr.name) != expr.name:
            return expr._replace(name=names[expr.name])
        return expr

    return change
