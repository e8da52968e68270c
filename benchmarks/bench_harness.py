"""The cost of the harness: `make bench`, or python benchmarks/bench_harness.py [COUNT].

Each technique is evaluated COUNT times (10,000) in one draw, on every back end, and the table has evaluations a second,
the share of the time that is spent outside the draw, and the time of the first call, which compiles, over that of the
later ones. Then each example's scene, at 640×360 with one sample a pixel: the share of the time that its draw takes,
and the draw's time beside that of the first scene. On a software driver that is the CPU's.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable

from sssgen.harness import backends
from sssgen.harness.backends import DrawingBackend
from sssgen.harness.evaluate import evaluation as evaluate
from sssgen.harness.evaluate.probes import subject
from sssgen.harness.evaluate.random_inputs import samples
from sssgen.harness.render import scene_render as render
from sssgen.harness.scenes import scene_loading
from sssgen.material.material_loading import examples

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
    """The table of techniques."""
    print(f"{count} evaluations of a technique in one draw")
    print(f"{'':14} " + "  ".join(f"{name:>34}" for name in TECHNIQUES))
    print(f"{'':14} " + "  ".join(f"{'a second    outside  first/later':>34}" for _ in TECHNIQUES))
    for backend in backends.available():
        cells = [cell(backend, name, count) for name in TECHNIQUES]
        print(f"{backend.name:14} " + "  ".join(f"{one:>34}" for one in cells))
    for name, how in backends.missing():
        print(f"{name:14} missing: {how}")


def cell(backend: backends.Backend, name: str, count: int) -> str:
    """One technique on one back end."""
    chosen = subject(name)
    inputs = evaluate.fitted(chosen, samples(chosen, count, 1))
    first = median(lambda: evaluate.run(chosen, inputs, backend), 1)
    outside = []

    def once() -> None:
        start = time.perf_counter()
        evaluate.run(chosen, inputs, backend)
        if isinstance(backend, DrawingBackend):
            outside.append(1.0 - backend.drew / (time.perf_counter() - start))

    later = median(once)
    share = f"{statistics.median(outside):8.0%}" if outside else f"{'–':>8}"
    return f"{count / later:12,.0f}   {share}     {first / later:6.1f} ×"


def frames(names: list[str]) -> None:
    """The scenes, one frame each."""
    print(f"\none frame of {SIZE[0]}×{SIZE[1]}: the draw's share of it, and the draw over that of the first scene")
    machines = [one for one in backends.available() if isinstance(one, DrawingBackend) and one.name in names]
    print(f"{'':14} " + "  ".join(f"{one.name:>16}" for one in machines))
    first: dict[str, float] = {}
    for name in examples():
        shown = render.with_samples(scene_loading.load(name), 1)
        cells = []
        for machine in machines:
            render.render(shown, machine, size=(64, 36))  # compiles
            start = time.perf_counter()
            render.render(shown, machine, size=SIZE)
            share = machine.drew / (time.perf_counter() - start)
            first.setdefault(machine.name, machine.drew)
            cells.append(f"{share:5.0%}  {machine.drew / first[machine.name]:6.1f} ×")
        print(f"{name:14} " + "  ".join(f"{one:>16}" for one in cells))


if __name__ == "__main__":
    evaluations(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
    frames(["gl", "webgpu"])
