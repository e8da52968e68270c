"""Who disagrees with whom, where a translation and the driver give different results for the author's text.

Three witnesses read the same text: the driver, the translation to NumPy in float64, and the interpreter of the checked
program. Where the interpreter, NumPy and a translation agree against the driver, the translation is right if sssgen has
read the text right, as all of these share its front end. So the driver is asked again:

- with the inputs of one lane in all lanes. Where it then agrees with the others, it has two results for one input;
- with the text that glslang, another compiler, reads. Where the driver then agrees with the others, two readers of the
  text do, and the driver alone has misread or miscompiled it.

Else sssgen's reading is at fault, and the translations are what fails.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from sssgen.run.backends import Array
from sssgen.support.diagnostics import SssgenError

Outputs = Mapping[str, Array]
"""Each output, lanes first."""
ORACLE, INTERPRETER = "oracle", "interpreter"
ASKED = 4
"""The most lanes for which the driver is asked again."""


class Dispute(NamedTuple):
    """The results of all who take part."""

    driver: Outputs
    interpreter: Outputs
    oracle: Outputs
    translations: Mapping[str, Outputs]
    unexplained: Mapping[str, Array]
    """The lanes in which rounding does not explain the deviation of a translation from the driver."""
    agree: Callable[[Outputs, Outputs, Array], Array]
    """Of these lanes, those in which rounding explains how far two results are apart."""


class Second(NamedTuple):
    """The driver, asked again for one lane."""

    evidence: str
    """What it shows if it agrees with the others."""
    ask: Callable[[int], Outputs]
    """The outputs of a lane, alone. Raises SssgenError."""


class Verdict(NamedTuple):
    """What the witnesses say of all lanes."""

    driver: Array
    """The lanes in which the driver is at fault."""
    evidence: str = ""
    """Why it is; or, where the others agree against it in vain, why it is not."""
    agreeing: tuple[str, ...] = ()
    """Who agrees against the driver in the first of these lanes."""
    lane: int = -1
    """That lane; -1 where nobody agrees against the driver."""
    lanes: int = 0
    """The number of lanes in which they agree."""
    value: Outputs = MappingProxyType({})
    """The interpreter's results."""
    against: Mapping[str, tuple[str, ...]] = MappingProxyType({})
    """For each translation the witnesses that it disagrees with, in the lanes in which it is at fault."""

    @property
    def blames_driver(self) -> bool:
        return bool(self.driver.any())


def judge(dispute: Dispute, again: Sequence[Second]) -> Verdict:
    """The verdict; without disputed lanes, that nobody is at fault."""
    nobody = np.zeros(len(next(iter(dispute.driver.values()))), bool)
    disputed = np.any([nobody, *dispute.unexplained.values()], axis=0)
    if not disputed.any():
        return Verdict(nobody)
    oracle = dispute.agree(dispute.oracle, dispute.interpreter, disputed)
    driver = dispute.agree(dispute.driver, dispute.interpreter, disputed)
    sides = {
        name: dispute.agree(outputs, dispute.interpreter, disputed) for name, outputs in dispute.translations.items()
    }
    alone = oracle & ~driver
    suspects = np.any([nobody, *(alone & sides[name] & lanes for name, lanes in dispute.unexplained.items())], axis=0)
    verdict = Verdict(nobody)
    if suspects.any():
        lanes = np.flatnonzero(suspects)
        first = int(lanes[0])
        agreeing = (INTERPRETER, ORACLE, *(name for name, side in sides.items() if side[first] and name != ORACLE))
        chosen = lanes[:: -(-len(lanes) // ASKED)]
        confirmed, evidence = _asked_again(dispute, chosen.tolist(), again)
        verdict = Verdict(suspects if confirmed else nobody, evidence, agreeing, first, len(lanes), dispute.interpreter)
    return verdict._replace(against=_against(dispute, verdict.driver, {ORACLE: oracle, "driver": driver, **sides}))


def _asked_again(dispute: Dispute, lanes: Sequence[int], again: Sequence[Second]) -> tuple[bool, str]:
    """Whether the driver, asked again, agrees with the others in each of these lanes, and what that shows."""
    evidence: dict[str, None] = {}
    for lane in lanes:
        reasons: list[str] = []
        for second in again:
            try:
                outputs = second.ask(lane)
            except SssgenError as error:
                reasons.append(error.diagnostics[0].message)
                continue
            wide = {name: np.array(values) for name, values in dispute.driver.items()}
            for name, value in outputs.items():
                wide[name][lane] = value
            this = np.arange(len(next(iter(wide.values())))) == lane
            if dispute.agree(wide, dispute.interpreter, this)[lane]:
                evidence[second.evidence] = None
                break
        else:
            shown = "; ".join(reasons) or "glslang reads the text as the driver does"
            return False, f"so sssgen reads the text in another way: {shown}"
    return True, "; ".join(evidence)


def _against(dispute: Dispute, driver_lanes: Array, sides: Mapping[str, Array]) -> dict[str, tuple[str, ...]]:
    """For each translation at fault the witnesses that it disagrees with, in all of its lanes."""
    against: dict[str, tuple[str, ...]] = {}
    for name, lanes in dispute.unexplained.items():
        left = lanes & ~driver_lanes
        if not left.any():
            continue
        witnesses = ["driver"]
        if name != ORACLE and not dispute.agree(dispute.translations[name], dispute.oracle, left).any():
            witnesses.append(ORACLE)
        if not (sides[name] & left).any():
            witnesses.append(INTERPRETER)
        against[name] = tuple(witnesses)
    return against
