"""Measures what operators cost on this machine's GPU: python benchmarks/device_costs.py NAME [--check]

It times shaders of one kind of operator each, and whole materials, those that read volumes included. From the operators
and every second material it writes src/sssgen/lab/gpu/devices/NAME.toml, for `--device NAME` of `sssgen chart` and
`sssgen pick`. For the other materials, or with --check for all of them from the stored file, it prints how often the
predicted order of two chains is the measured one, and the ratios of predicted and measured times.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import operator_times
from gpu import chains_inside
from sssgen.lab.gpu import device_costs
from sssgen.lab.measure import candidates
from sssgen.lab.measure.candidates import Candidate
from sssgen.passes.cost import Cost
from sssgen.scene.measured import measured_scene

SCENE = "cube"
"""The scene at whose points the programs run."""


def main() -> int:
    """Measures or loads the device, and prints its costs and the check."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("NAME")
    options.add_argument("--check", action="store_true", help="only check the stored costs")
    options.add_argument("--chains", type=int, default=110, help="whole materials without volumes")
    options.add_argument("--width", type=int, default=1920)
    options.add_argument("--rounds", type=int, default=31)
    arguments = options.parse_args()
    size = (arguments.width, arguments.width * 9 // 16)
    scene = measured_scene.load(SCENE)
    lengths, views = candidates.thickness(), candidates.view_thickness()
    whole = candidates.materials(lengths, views, list(filter(candidates.fits_path, lengths)))
    materials = [*spread(whole, arguments.chains), *chains_inside()]
    chains = operator_times.time_chains(materials, scene, size, arguments.rounds)
    if not arguments.check:
        operators = operator_times.time_chains(operator_times.operator_chains(), scene, size, arguments.rounds)
        fitted = [number for number in range(0, len(materials), 2) if chains.typical[number] > 0.0]
        both = operator_times.union(operators, operator_times.subset(chains, fitted))
        measured = operator_times.measured_device(arguments.NAME, both)
        chains = operator_times.subset(chains, range(1, len(materials), 2))
        # not by file_writer, which protects the files of an installation: this program makes them
        path = Path(device_costs.FOLDER) / f"{arguments.NAME}.toml"
        path.write_text(measured.text(), encoding="utf-8")
        print(f"wrote {path}")
    device = device_costs.load(arguments.NAME)
    print(f"{device.renderer}, {device.driver}")
    for operator, ns in zip(device_costs.OPERATORS, device.ns, strict=True):
        print(f"  {operator.replace('_', ' '):22} {ns:8.4g} ns")
    for title, predicted in (
        (f"predicted for {device.name}", [device.predict(counts) for counts in chains.counts]),
        ("static cost", [float(Cost(**counts).weight) for counts in chains.counts]),
    ):
        result = operator_times.order_of_pairs(chains, predicted)
        print(
            f"{title}: {result.agree} of {result.pairs} pairs in the measured order "
            f"({result.agree / max(result.pairs, 1):.1%}); of the pairs that the clock can tell apart "
            f"{result.distinct_agree} of {result.distinct} ({result.distinct_agree / max(result.distinct, 1):.1%})"
        )
    ratios = [device.predict(counts) / ns for counts, ns in zip(chains.counts, chains.typical, strict=True)]
    low, median, high = np.percentile(ratios, [10.0, 50.0, 90.0])
    print(f"predicted times relative to measured ones: median {median:.2f}, 10th percentile {low:.2f}, 90th {high:.2f}")
    return 0


def spread(every: Sequence[Candidate], count: int) -> list[Candidate]:
    """At most `count` candidates with techniques, evenly spaced in the list."""
    charted = [candidate for candidate in every if candidate.techniques]
    step = max(len(charted) / count, 1.0)
    return [charted[int(index * step)] for index in range(min(count, len(charted)))]


if __name__ == "__main__":
    sys.exit(main())
