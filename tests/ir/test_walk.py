"""Walking IR: the calls of a block, which are kept."""

from __future__ import annotations

from sssgen.ir import nodes as ir
from sssgen.ir import walk
from sssgen.ir.types import FLOAT

NOWHERE = ir.NOWHERE


def call(name: str, *args: ir.Expr) -> ir.Call:
    return ir.Call(FLOAT, f"{name}()", args, NOWHERE)


def names(block: ir.Block) -> list[str]:
    return [part.function for part in walk.calls_of(block)]


def test_calls_are_in_the_order_of_the_text() -> None:
    sum_ = ir.Binary(FLOAT, "+", call("outer", call("inner")), call("last"), NOWHERE)
    block: ir.Block = (ir.Declare("x", FLOAT, call("first"), NOWHERE), ir.Return(sum_, NOWHERE))
    assert names(block) == ["first()", "outer()", "inner()", "last()"]


def test_equal_and_short_lived_blocks_have_their_own_calls() -> None:
    # A block that is gone must not leave its calls to another one with its id, also once the table is full.
    for number in range(walk._KEPT + 10):
        block: ir.Block = (ir.Return(call(f"f{number}"), NOWHERE),)
        assert names(block) == [f"f{number}()"]
        assert walk.calls_of(block) is walk.calls_of(block)
    assert len(walk._calls) <= walk._KEPT
