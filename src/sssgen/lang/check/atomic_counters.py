"""Atomic counters of GLSL (`uniform atomic_uint hits;`): storage buffers with a uint, as other languages lack them.

Each counter, or array of counters, is a buffer of its own; a call of a counter's function is one of an atomic.
"""

from __future__ import annotations

from sssgen.lang.check.context import CheckContext
from sssgen.lang.check.declared_names import unused_global_name
from sssgen.lang.syntax import tree as s

TYPE = "atomic_uint"
_STEPS = {"atomicCounterIncrement": "1u", "atomicCounterDecrement": "0xffffffffu"}
_ATOMICS = {
    f"atomicCounter{operation}": f"atomic{operation}"
    for operation in ("Add", "Min", "Max", "And", "Or", "Xor", "Exchange", "CompSwap")
}


def buffers(context: CheckContext, declaration: s.Declaration, doc: str) -> list[s.BlockSyntax]:
    """The buffers of a declaration's counters. Their bindings are not those of buffers, so that they get others."""
    if any(item == "location" for item, _ in declaration.qualifiers.layout):
        hint = "write layout(binding = 0)"
        raise context.fail(declaration.qualifiers.span, "an atomic counter has a binding, but no location", hint)
    blocks = []
    for declarator in declaration.declarators:
        name, span = declarator.name.text, declarator.name.span
        if declarator.value is not None:
            hint = "the program that draws sets it"
            raise context.fail(span, "an atomic counter has no initial value", hint)
        label = s.Name(unused_global_name(context, f"{name[0].upper()}{name[1:]}Counter"), span)
        context.file_names.add(label.text)  # those of `hits` and `Hits` differ
        context.counters.add(name)
        member = s.Declaration(s.PLAIN, s.TypeName("uint", declaration.type.lengths, span), (declarator,), span)
        blocks.append(s.BlockSyntax(s.Qualifiers(("buffer",), (), span), label, (member,), None, (), doc))
    return blocks


def counter_name(context: CheckContext, function: str, place: s.Expression) -> s.Name:
    """The counter, or array of counters, of an argument. Reports any other argument."""
    root = place
    while isinstance(root, s.IndexOf):
        root = root.value
    if not isinstance(root, s.Name) or root.text not in context.counters:
        hint = "declare one: layout(binding = 0) uniform atomic_uint count;"
        raise context.fail(place.span, f"{function} takes an atomic counter", hint)
    return root


def atomic(name: str, call: s.CallOf) -> s.Expression | None:
    """A call of a counter's function as an expression with an atomic; None for any other call."""
    span, depth = call.span, call.depth

    def called(operation: str, *args: s.Expression) -> s.CallOf:
        return s.CallOf(s.Name(operation, span), args, span, depth)

    if name == "atomicCounter" and len(call.args) == 1:
        return call.args[0]
    if name in _STEPS and len(call.args) == 1:
        old = called("atomicAdd", *call.args, s.Number(_STEPS[name], False, span))
        # the old value of an increment, the new one of a decrement
        return old if name == "atomicCounterIncrement" else s.Infix("-", old, s.Number("1u", False, span), span, depth)
    if name == "atomicCounterSubtract" and len(call.args) == 2:
        place, value = call.args
        return called("atomicAdd", place, s.Prefix("-", value, span, depth))
    return called(_ATOMICS[name], *call.args) if name in _ATOMICS and call.args else None
