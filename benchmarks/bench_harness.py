"""Measures the cost of the harness: `make bench`, or python benchmarks/bench_harness.py [COUNT].

The first table evaluates each technique COUNT times (default: 10,000) in one draw on every back end. It shows the
evaluations per second, the share of the time outside the draw, and the ratio of the first call, which compiles, to a
later call. The second table renders the scene of each example at 640×360 with one sample per pixel. It shows the share
of the time inside the draw, and the ratio of the draw to that of the first scene. A software driver draws on the CPU.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable

from sssgen.material.material_loading import examples
from sssgen.run import backends
from sssgen.run.backends import DrawingBackend
from sssgen.run.evaluate import evaluation as evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.run.evaluate.random_inputs import samples
from sssgen.run.render import scene_render as render
from sssgen.scene import scene_loading

TECHNIQUES = ("lobe_gdc2011", "standard", "thinness_uniform")
ROUNDS = 7
SIZE = (640, 360)


def median(work: Callable[[], object], rounds: int = ROUNDS) -> float:
    """Seconds of one call."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def evaluations(count: int) -> None:
    """Prints the table of techniques."""
    print(f"{count} evaluations of each technique in one draw")
    print(f"{'':14} " + "  ".join(f"{name:>34}" for name in TECHNIQUES))
    print(f"{'':14} " + "  ".join(f"{'per second    outside  first/later':>34}" for _ in TECHNIQUES))
    for backend in backends.available():
        cells = [cell(backend, name, count) for name in TECHNIQUES]
        print(f"{backend.name:14} " + "  ".join(f"{text:>34}" for text in cells))
    for name, instruction in backends.missing():
        print(f"{name:14} missing: {instruction}")


def cell(backend: backends.Backend, name: str, count: int) -> str:
    """The cell of a technique and a back end."""
    chosen = subject(name)
    inputs = evaluate.fit_inputs(chosen, samples(chosen, count, 1))
    first = median(lambda: evaluate.run(chosen, inputs, backend), 1)
    outside = []

    def evaluation() -> None:
        start = time.perf_counter()
        evaluate.run(chosen, inputs, backend)
        if isinstance(backend, DrawingBackend):
            outside.append(1.0 - backend.drew / (time.perf_counter() - start))

    later = median(evaluation)
    share = f"{statistics.median(outside):8.0%}" if outside else f"{'–':>8}"
    return f"{count / later:12,.0f}   {share}     {first / later:6.1f} ×"


def frames(names: list[str]) -> None:
    """Prints the table of scenes, each drawn once."""
    print(f"\nA frame of {SIZE[0]}×{SIZE[1]}: the share of the draw, and its ratio to the draw of the first scene")
    machines = [
        backend for backend in backends.available() if isinstance(backend, DrawingBackend) and backend.name in names
    ]
    print(f"{'':14} " + "  ".join(f"{machine.name:>16}" for machine in machines))
    first: dict[str, float] = {}
    for name in examples():
        scene = render.with_samples(scene_loading.load(name), 1)
        cells = []
        for machine in machines:
            render.render(scene, machine, size=(64, 36))  # compiles
            start = time.perf_counter()
            render.render(scene, machine, size=SIZE)
            share = machine.drew / (time.perf_counter() - start)
            first.setdefault(machine.name, machine.drew)
            cells.append(f"{share:5.0%}  {machine.drew / first[machine.name]:6.1f} ×")
        print(f"{name:14} " + "  ".join(f"{text:>16}" for text in cells))


if __name__ == "__main__":
    evaluations(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
    frames(["gl", "webgpu"])
