"""The declarations that names refer to, and the scopes of a function."""

from __future__ import annotations

from collections.abc import Container
from typing import NamedTuple

from sssgen.ir.constant_evaluation import Value
from sssgen.ir.nodes import Span
from sssgen.ir.types import Struct, Type


class Variable(NamedTuple):
    """A parameter or local variable. `ir_name` differs from the written name where that hides an outer variable."""

    ir_name: str
    type: Type
    quantity: str
    writable: bool
    faulty: bool = False
    """Its declaration has an error. Its uses are not reported."""
    value: Value | None = None
    """The value of a constant, as in `constant_values`."""
    constant: bool = False
    """Whether it is declared as const; a parameter is not, as its value is another one in each call."""


class GlobalValue(NamedTuple):
    """A uniform, texture, constant or module variable; `value` is that of a constant, as in `constant_values`."""

    type: Type
    quantity: str
    value: Value | None = None
    constant: bool = False
    writable: bool = False
    extent: tuple[float, float] = (float("-inf"), float("inf"))
    """The least and the largest component of a uniform."""


class Signature(NamedTuple):
    """The signature of a function, for its calls."""

    key: str
    names: tuple[str, ...]
    types: tuple[Type, ...]
    directions: tuple[str, ...]
    quantities: tuple[str, ...]
    result: Type
    quantity: str
    span: Span
    constants: tuple[bool, ...] = ()
    """In GLSL ES: which parameters are const"""


class Scopes:
    """The nested scopes of one function."""

    def __init__(self) -> None:
        self.stack: list[dict[str, Variable]] = [{}]
        self.structs: list[dict[str, Struct]] = [{}]
        """The structs that each scope declares."""
        self.visible: dict[str, Variable] = {}
        """The variables of all scopes by their names in the IR."""
        self.taken: list[list[str]] = [[]]
        """For each scope, the IR names of its variables."""
        self.counters: list[dict[str, Type]] = [{}]
        """For each scope, the variables of the loops in it: HLSL declares those in the scope around the loop."""

    def push(self) -> None:
        self.stack.append({})
        self.structs.append({})
        self.taken.append([])
        self.counters.append({})

    def pop(self, dissolve: bool = False, loop: bool = False) -> None:
        """Leaves a scope. `dissolve`: it is not a scope in the IR, so its names stay taken in the enclosing scope.

        `loop`: it is the scope of a loop's head.
        """
        self.stack.pop()
        self.structs.pop()
        names = self.taken.pop()
        self.counters.pop()
        if loop:
            self.counters[-1] |= {name: self.visible[name].type for name in names}
        if dissolve:
            self.taken[-1] += names
        else:
            for name in names:
                del self.visible[name]

    def find(self, name: str) -> Variable | None:
        for scope in reversed(self.stack):
            if name in scope:
                return scope[name]
        return None

    def hides(self, name: str) -> bool:
        """Whether a variable hides the functions and structs of its name that are declared outside of its scope."""
        for variables, structs in zip(reversed(self.stack), reversed(self.structs), strict=True):
            if name in variables or name in structs:
                return name not in structs
        return False

    def find_struct(self, name: str) -> Struct | None:
        for scope in reversed(self.structs):
            if name in scope:
                return scope[name]
        return None

    def declare(
        self,
        name: str,
        type: Type,
        quantity: str,
        writable: bool,
        faulty: bool = False,
        value: Value | None = None,
        constant: bool = False,
    ) -> Variable | None:
        """Adds a variable to the innermost scope; None if this scope has the name already."""
        if name in self.stack[-1]:
            return None
        variable = Variable(self.unused(name, type), type, quantity, writable, faulty, value, constant)
        self.stack[-1][name] = variable
        return self.add(variable)

    def invent(self, name: str, type: Type, taken: Container[str] = (), constant: bool = False) -> Variable:
        """Adds a variable of the compiler to the innermost scope: no name that the author writes refers to it.

        `taken` are names of variables that will be in its scope in the IR.
        """
        return self.add(Variable(self.unused(name, type, taken), type, "", True, constant=constant))

    def unused(self, name: str, type: Type, taken: Container[str] = ()) -> str:
        """`name`, with a number where the IR has a visible variable of that name."""
        unused, count = name, 2
        while unused in self.visible or unused in taken or self.counters[-1].get(unused, type) != type:
            unused, count = f"{name}_{count}", count + 1
        return unused

    def add(self, variable: Variable) -> Variable:
        """Makes a variable's IR name visible in the innermost scope."""
        self.visible[variable.ir_name] = variable
        self.taken[-1].append(variable.ir_name)
        return variable

    def forget(self, ir_name: str) -> None:
        """Makes the name of a variable of the compiler free again, which no statement has."""
        del self.visible[ir_name]
        self.taken[-1].remove(ir_name)

    def names(self) -> list[str]:
        return [name for scope in self.stack for name in scope]
