"""Makes names legal for a target, and keeps those of the author where possible.

Why: every target reserves different words, and some have no overloads; a shader's author should recognise their
names.
Place: last, just before printing, as every pass before it may bring new names and new overloads.

A name is changed if the target reserves it, if no shading language allows it (`__` inside, `gl_` in front),
if it is taken, or if it hides something that its function uses. A changed name gets `_` at its end, or a
number if that is taken too. A name that ends in digits is not special.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Mapping
from typing import NamedTuple

from sssgen.ir import nodes as ir
from sssgen.ir.intrinsics import BUILTINS
from sssgen.ir.transform import rewrite
from sssgen.ir.types import VEC4, Field, Matrix, Struct, Type, component_kinds, spell, unnested
from sssgen.ir.walk import all_expressions, statements, subexpressions
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.scopes import Renamer, declared, rename_locals
from sssgen.passes.struct_types import Retyper
from sssgen.support.diagnostics import failure

LONGEST = 1000
"""The most letters of a name: GLSL allows 1,024 (GLSL ES 3.20, section 3.8), and compilers add some of their own."""


class Rules(NamedTuple):
    """Which names a target has."""

    reserved: Container[str] = ()
    reserved_folded: Container[str] = ()
    """Names that are reserved in any case, in lower case."""
    reserved_at_file_scope: Container[str] = ()
    """Names that only local names may have."""
    capabilities: Capabilities = Capabilities()
    """`overloads`, `layout_overloads`, `loop_scope`, `member_types` and `hiding` of the language."""
    uniform_name: Callable[[str], str] = str
    """Gives a uniform's name in the target's style."""
    uniforms_declared: bool = True
    """Whether the text declares the uniforms, so that they can be hidden."""
    prefix: str = ""
    """Begins the name of every declaration."""
    uniform_ports: bool = False
    """Whether uniforms are ports of a node, which have no prefix."""


def rename(module: ir.Module, rules: Rules) -> tuple[ir.Module, dict[str, str]]:
    """The module with legal names, and what was renamed, as old → new.

    Overloads that got other names are listed under their key (as in `box(vec3)`), local names under `function.name`,
    members under `struct.name`.
    """
    return _Namer(module, rules).run()


def check_prefix(prefix: str, reserved: tuple[str, ...]) -> str:
    """The prefix, if global names can begin with it. Raises SssgenError."""
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", prefix) or "__" in prefix:
        hint = "letters, digits and single underscores, after a letter: --prefix wax_"
        raise failure(f"'{prefix}' cannot begin a name", hint)
    if prefix.startswith(reserved):
        raise failure(f"names that begin with '{prefix}' are reserved", "choose another prefix, such as wax_")
    return prefix


class _Namer:
    def __init__(self, module: ir.Module, rules: Rules) -> None:
        self.module, self.rules = module, rules
        self.keyed = [(function.key, function) for function in module.functions]
        self.values: set[str] = set()
        """The new names of uniforms, constants and variables, where no local variable may have them."""
        self.legality: dict[str, bool] = {}
        """Whether a name is legal."""
        self.renamed: dict[str, str] = {}
        self.structs: dict[Type, Type] = {}
        self.members: dict[tuple[str, str], str] = {}
        """New names of members, by the struct's new name and the member's old one."""
        self.retyper = Retyper(self.structs, self.members)
        self.globals: dict[str, str] = {}
        self.keys: dict[str, str] = {}
        self.function_names: dict[str, str] = {}
        """The new name of each function, by its old key."""
        self.taken: set[str] = set()
        """The new names of the module's declarations."""
        self.constant_values = {constant.name: constant.value for constant in module.constants}
        self.uses: dict[str, set[str]] = {}
        """What `used_by` has found."""

    def run(self) -> tuple[ir.Module, dict[str, str]]:
        self.name_declarations()
        module = self.module
        structs, constants = module.structs, module.constants
        if self.structs:
            structs = tuple([struct._replace(type=self.retyper.type(struct.type)) for struct in structs])
        if self.structs or self.globals:
            constants = tuple([self.constant(constant) for constant in constants])
        uniforms, variables = module.uniforms, module.variables
        if self.globals:
            uniforms = tuple(
                [uniform._replace(name=self.globals.get(uniform.name, uniform.name)) for uniform in uniforms]
            )
        if self.structs or self.globals:
            variables = tuple([self.variable(variable) for variable in variables])
        functions = tuple([self.function(key, function) for key, function in self.keyed])
        return ir.Module(structs, constants, uniforms, functions, variables, module.workgroup), self.renamed

    # The module's own names

    def legal(self, name: str) -> bool:
        cached = self.legality.get(name)
        if cached is None:
            cached = self.legality[name] = not (
                name in self.rules.reserved
                or "__" in name
                or name == "_"
                or name.startswith("gl_")
                or name.lower() in self.rules.reserved_folded
                or len(name) > LONGEST
            )
        return cached

    def choose(self, name: str, taken: Container[str]) -> str:
        """A legal name that is like `name` and is not taken."""
        base = re.sub(r"__+", "_", name.removeprefix("gl_"))[: LONGEST - 8]
        if not base.strip("_") or base[0].isdigit():  # of `gl_2`, the name of a second `gl`
            base = f"value_{base}".rstrip("_")
        if self.free(base, taken):
            return base
        if not base.endswith("_") and self.free(f"{base}_", taken):
            return f"{base}_"
        base, count = base.rstrip("_"), 2
        if not self.legal(f"{base}_{count}"):  # its beginning is reserved, so that no ending helps
            base = f"own_{base.lstrip('_')}"
            if self.free(base, taken):
                return base
        while not self.free(f"{base}_{count}", taken):
            count += 1
        return f"{base}_{count}"

    def free(self, name: str, taken: Container[str]) -> bool:
        return name not in taken and name not in self.taken and self.legal(name)

    def name_declarations(self) -> None:
        """Names structs, constants, uniforms, variables and functions: they share one scope.

        First come those that can have the name they want, so that as few as possible are changed.
        """
        module = self.module
        wanted = {("struct", spell(struct.type)): spell(struct.type) for struct in module.structs}
        wanted |= {("global", constant.name): constant.name for constant in module.constants}
        wanted |= {("global", uniform.name): self.rules.uniform_name(uniform.name) for uniform in module.uniforms}
        wanted |= {("global", variable.name): variable.name for variable in module.variables}
        mangled = self.overload_names()
        for key, function in self.keyed:
            if key in mangled:
                wanted["key", key] = mangled[key]
            else:
                wanted["function", function.name] = function.name
        if self.rules.prefix:
            ports = {("global", uniform.name) for uniform in module.uniforms} if self.rules.uniform_ports else set()
            wanted = {old: name if old in ports else f"{self.rules.prefix}{name}" for old, name in wanted.items()}
        names: dict[tuple[str, str], str] = {}
        # another stage must choose the same names for the interface
        passed = [variable for variable in module.variables if variable.storage != "private" and not variable.builtin]
        for name in sorted([variable.name for variable in passed], key=lambda name: (not self.legal(name), name)):
            names["global", name] = self.choose(name, self.rules.reserved_at_file_scope)
            self.taken.add(names["global", name])
        for old, name in wanted.items():
            if old not in names and self.free(name, self.rules.reserved_at_file_scope):
                names[old] = name
                self.taken.add(name)
        for old, name in wanted.items():
            if old not in names:
                names[old] = self.choose(name, self.rules.reserved_at_file_scope)
                self.taken.add(names[old])
        self.renamed = {old[1]: new for old, new in names.items() if old[1] != new}
        self.globals = {old[1]: new for old, new in names.items() if old[0] == "global" and old[1] != new}
        if not self.rules.capabilities.hiding:
            undeclared = set() if self.rules.uniforms_declared else {uniform.name for uniform in module.uniforms}
            self.values = {new for (kind, old), new in names.items() if kind == "global" and old not in undeclared}
        self.name_structs(names)
        for key, function in self.keyed:
            new = names["key", key] if key in mangled else names["function", function.name]
            self.function_names[key] = new
            if new != function.name or self.structs:
                types = [self.retyper.type(param.type) for param in function.params]
                self.keys[key] = ir.function_key(new, types)

    def overload_names(self) -> dict[str, str]:
        """Names for overloads: the fewest parameter types that distinguish them."""
        overloads: dict[str, list[tuple[str, ir.Function]]] = {}
        for key, function in self.keyed:
            overloads.setdefault(function.name, []).append((key, function))
        result: dict[str, str] = {}
        for name, functions in overloads.items():
            if len(functions) > 1 and (
                not self.rules.capabilities.overloads or self.is_ambiguous([function for _, function in functions])
            ):
                types = [[_word(param.type) for param in function.params] for _, function in functions]
                for count in range(1, max(map(len, types)) + 1):
                    spelled = ["_".join([name, *words[:count]]) for words in types]
                    if len(set(spelled)) == len(spelled):
                        break
                result |= {key: word for (key, _), word in zip(functions, spelled, strict=True)}
        return result

    def is_ambiguous(self, overloads: list[ir.Function]) -> bool:
        """Whether the target cannot distinguish these: HLSL a vec4 from a mat2, and structs of the same numbers."""
        if self.rules.capabilities.layout_overloads:
            return False
        signatures = [[_layout(param.type) for param in function.params] for function in overloads]
        return any(types in signatures[:index] for index, types in enumerate(signatures))

    def name_structs(self, names: Mapping[tuple[str, str], str]) -> None:
        """Finds the structs that change: by name, by a member's name, or by a member's type."""
        types = (
            set()
            if self.rules.capabilities.member_types
            else {name for (kind, _), name in names.items() if kind == "struct"}
        )
        for declaration in self.module.structs:
            struct = declaration.type
            assert isinstance(struct, Struct)
            members = {field.name for field in struct.fields} | types
            fields = []
            for field in struct.fields:
                new = field.name
                if not self.legal(new) or new in types:
                    new = self.member(new, members)
                    self.renamed[f"{struct.name}.{field.name}"] = new
                    self.members[names["struct", struct.name], field.name] = new
                fields.append(Field(new, self.retyper.type(field.type), field.quantity))
            changed = Struct(names["struct", struct.name], tuple(fields))
            if changed != struct:
                self.structs[struct] = changed

    def member(self, name: str, members: set[str]) -> str:
        outer, self.taken = self.taken, members
        new = self.choose(name, ())
        self.taken = outer
        members.add(new)
        return new

    # What uses the names

    def constant(self, constant: ir.Constant) -> ir.Constant:
        name = self.globals.get(constant.name, constant.name)
        return ir.Constant(name, self.retyper.type(constant.type), self.value(constant.value), constant.span)

    def variable(self, variable: ir.Variable) -> ir.Variable:
        name = self.globals.get(variable.name, variable.name)
        value = self.value(variable.value) if variable.value is not None else None
        return variable._replace(name=name, type=self.retyper.type(variable.type), value=value)

    def value(self, value: ir.Expr) -> ir.Expr:
        """A declaration's value with the new names."""
        value = rewrite(value, self.retyper.node) if self.structs else value
        renamed: ir.Expr = Renamer(self.globals, self.keys).expression(value)
        return renamed

    def function(self, key: str, function: ir.Function) -> ir.Function:
        name = self.function_names[key]
        names = set(declared(function))
        bad = [local for local in names if not self.legal(local)]
        bad += self.clashes(function, names) | (names & self.values)
        if self.structs:
            function = self.retyper.function(function)
        new, renamed = rename_locals(
            function, bad, self.choose, self.globals, self.keys, self.rules.capabilities.loop_scope
        )
        for old, local in renamed.items():
            self.renamed[f"{function.name}.{old}"] = local
        if not self.globals.keys().isdisjoint([param.passes for param in new.params]):
            passed = [param._replace(passes=self.globals.get(param.passes, param.passes)) for param in new.params]
            new = new._replace(params=tuple(passed))
        return new if name == new.name else new._replace(name=name)

    def clashes(self, function: ir.Function, names: set[str]) -> set[str]:
        """The names of a function's variables that are also those of declarations or builtins it uses."""
        names = {name for name in names if name in self.taken or name in BUILTINS}
        return names & self.names_in(function) if names else names

    def names_behind(self, name: str) -> set[str]:
        """The new names of a declaration and of what a constant's value uses, as a function may compute it (NumPy)."""
        if name not in self.uses:
            self.uses[name] = {self.globals.get(name, name)}
            if name in self.constant_values:
                for part in subexpressions(self.constant_values[name]):
                    if isinstance(part, ir.Global):
                        self.uses[name] |= self.names_behind(part.name)
                    elif isinstance(part, ir.Intrinsic):
                        self.uses[name].add(part.name)
        return self.uses[name]

    def names_in(self, function: ir.Function) -> set[str]:
        """The new names of what a function uses of the module, and of the builtins it calls."""
        used: set[str] = set()
        types = [function.result, *(param.type for param in function.params)]
        for expr in all_expressions(function.body or ()):
            if isinstance(expr, ir.Global):
                used |= self.names_behind(expr.name)
            elif isinstance(expr, ir.Call):
                used.add(self.function_names[expr.function])
            elif isinstance(expr, ir.Intrinsic):
                used.add(expr.name)
            elif isinstance(expr, ir.Construct):
                types.append(expr.type)
        types += [stmt.type for stmt in statements(function.body or ()) if isinstance(stmt, ir.Declare)]
        structs = [inner for inner, _ in map(unnested, types) if isinstance(inner, Struct)]
        used.update(spell(self.retyper.type(struct)) for struct in structs)
        return used


def _layout(type: Type) -> object:
    """What HLSL distinguishes of a type: a struct is the sequence of its numbers there."""
    if isinstance(unnested(type)[0], Struct):
        return tuple(component_kinds(type))
    return VEC4 if type == Matrix(2, 2) else type


def _word(type: Type) -> str:
    """A type as a part of a name."""
    return re.sub(r"\W+", "", spell(type))
