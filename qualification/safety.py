"""How safe the library is, and what that costs: operations proven and guarded, and the operations that guards add."""

from __future__ import annotations

from typing import NamedTuple

from sssgen.lang.polyfills import guard as guard_source
from sssgen.lang.polyfills import polyfill
from sssgen.passes.cost import Cost, cost_of
from sssgen.passes.guards import guard
from sssgen.pipeline.compiler import GUARDS
from sssgen.pipeline.programs import plain_module
from sssgen.run.evaluate.probes import Subject


class Safety(NamedTuple):
    """Of one technique, called with anything that its contract allows."""

    name: str
    proven: int
    guarded: int
    costs: dict[str, Cost]
    """With guards none, auto and all."""

    def added(self, mode: str) -> int:
        """The operations that guards add."""
        return self.costs[mode].operations - self.costs["none"].operations


def safety(subject: Subject) -> Safety:
    """The counts and the static costs of a technique's functions, one call of each."""
    module, _, _ = plain_module(subject.module)
    compiled = {
        mode: guard(module, subject.called, mode, guard_source, polyfill, chained=subject.chained) for mode in GUARDS
    }
    costs = {}
    for mode, guarded in compiled.items():
        total = Cost()
        for key in subject.called:
            total = total.plus(cost_of(guarded.module, key))
        costs[mode] = total
    sites = compiled["auto"].sites
    proven = sum(site.proven for site in sites)
    return Safety(subject.name, proven, len(sites) - proven, costs)
