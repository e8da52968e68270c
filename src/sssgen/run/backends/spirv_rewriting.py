"""Rewrites SPIR-V, without a change of its meaning, to forms that spirv-cross and Mesa's OpenGL compute right."""

from __future__ import annotations

from array import array
from collections import Counter
from enum import IntEnum

_HEADER, _BOUND = 5, 3
"""The words of the header, and the one among them that exceeds all ids."""

Instruction = tuple[int, ...]
"""Opcode and operands."""


class Op(IntEnum):
    TYPE_BOOL = 20
    CONSTANT_COMPOSITE = 44
    CONSTANT_NULL = 46
    STORE = 62
    COPY_OBJECT = 83
    LOGICAL_NOT = 168
    LOOP_MERGE = 246
    SELECTION_MERGE = 247
    BRANCH_CONDITIONAL = 250


def rewrite(module: bytes) -> bytes:
    """The module with two changes.

    - A constant is copied before it is stored in a variable with several stores. spirv-cross takes an array for a
      table of constants if the first store is a constant and a part is read before the next store, which it drops.
    - A condition that ends a loop where it is false is negated. spirv-cross writes `if (c) { … } else { break; }` for
      it, which Mesa 22.3 runs once if `c` is simplified to `true && i != 2`. It computes `if (!c) { break; }` right.
    """
    words = array("I", module)
    instructions = _instructions(words)
    constants = {
        operands[1]: operands[0]
        for code, *operands in instructions
        if code in (Op.CONSTANT_COMPOSITE, Op.CONSTANT_NULL)
    }
    bools = [operands[0] for code, *operands in instructions if code == Op.TYPE_BOOL]
    stores = Counter(operands[0] for code, *operands in instructions if code == Op.STORE)
    ends = {operands[0] for code, *operands in instructions if code == Op.LOOP_MERGE}
    bound = words[_BOUND]
    result: list[Instruction] = []
    for instruction in instructions:
        match instruction:
            case (Op.STORE, variable, value, *access) if stores[variable] > 1 and value in constants:
                result.append((Op.COPY_OBJECT, constants[value], bound, value))
                result.append((Op.STORE, variable, bound, *access))
                bound += 1
            case (Op.BRANCH_CONDITIONAL, condition, body, end) if end in ends and body not in ends:
                merge = [result.pop()] if result[-1][0] in (Op.LOOP_MERGE, Op.SELECTION_MERGE) else []
                result += [(Op.LOGICAL_NOT, bools[0], bound, condition), *merge]
                result.append((Op.BRANCH_CONDITIONAL, bound, end, body))
                bound += 1
            case _:
                result.append(instruction)
    header = words[:_HEADER]
    header[_BOUND] = bound
    return header.tobytes() + b"".join(
        array("I", (len(instruction) << 16 | instruction[0], *instruction[1:])).tobytes() for instruction in result
    )


def _instructions(words: array[int]) -> list[Instruction]:
    result, place = [], _HEADER
    while place < len(words):
        end = place + (words[place] >> 16)
        result.append((words[place] & 0xFFFF, *words[place + 1 : end]))
        place = end
    return result
