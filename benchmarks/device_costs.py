"""Measures what operators cost on this machine's GPU: python benchmarks/device_costs.py NAME [--check]

It times shaders of one kind of operator each, and writes src/sssgen/lab/gpu/devices/NAME.toml for `--device NAME` of
`sssgen chart` and `sssgen pick`. Then, or with --check from the stored file, it times whole materials and prints how
often the predicted order of two chains is the measured one.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import operator_times
from sssgen.lab.gpu import device_costs
from sssgen.lab.measure import candidates
from sssgen.lab.measure.candidates import Candidate
from sssgen.scene.measured import measured_scene
from sssgen.support.file_writer import write_files

SCENE = "cube"
"""The scene at whose points the programs run."""


def main() -> int:
    """Measures or loads the device, and prints its costs and the check."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("NAME")
    options.add_argument("--check", action="store_true", help="only check the stored costs")
    options.add_argument("--chains", type=int, default=40, help="chains to time for the check")
    options.add_argument("--width", type=int, default=1920)
    options.add_argument("--rounds", type=int, default=31)
    arguments = options.parse_args()
    size = (arguments.width, arguments.width * 9 // 16)
    scene = measured_scene.load(SCENE)
    if not arguments.check:
        operators = operator_times.time_chains(operator_times.operator_chains(), scene, size, arguments.rounds)
        measured = operator_times.measured_device(arguments.NAME, operators)
        write_files(device_costs.FOLDER, {f"{arguments.NAME}.toml": measured.text()})
        print(f"wrote {Path(device_costs.FOLDER) / arguments.NAME}.toml")
    device = device_costs.load(arguments.NAME)
    print(f"{device.renderer}, {device.driver}")
    for operator, ns in zip(device_costs.OPERATORS, device.ns, strict=True):
        print(f"  {operator.replace('_', ' '):22} {ns:8.4g} ns")
    lengths, views = candidates.thickness(), candidates.view_thickness()
    whole = candidates.materials(lengths, views, list(filter(candidates.fits_path, lengths)))
    chains = operator_times.time_chains(spread(whole, arguments.chains), scene, size, arguments.rounds)
    for title, predicted in (
        (f"predicted for {device.name}", [device.predict(counts) for counts in chains.counts]),
        ("static cost", [weighted(counts) for counts in chains.counts]),
    ):
        result = operator_times.order_of_pairs(chains, predicted)
        print(
            f"{title}: {result.agree} of {result.pairs} pairs in the measured order "
            f"({result.agree / max(result.pairs, 1):.1%}); of the pairs that the clock can tell apart "
            f"{result.distinct_agree} of {result.distinct} ({result.distinct_agree / max(result.distinct, 1):.1%})"
        )
    return 0


def weighted(counts: Mapping[str, int]) -> float:
    """The static cost of a chart."""
    return float(counts["operations"] + 8 * counts["transcendentals"] + 16 * counts["fetches"])


def spread(every: Sequence[Candidate], count: int) -> list[Candidate]:
    """At most `count` candidates with techniques, evenly spaced in the list."""
    charted = [candidate for candidate in every if candidate.techniques]
    step = max(len(charted) / count, 1.0)
    return [charted[int(index * step)] for index in range(min(count, len(charted)))]


if __name__ == "__main__":
    sys.exit(main())
