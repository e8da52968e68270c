"""Counts how many random hazard programs give a number that is not finite, though they are guarded.

    python tests/fuzz/hazards.py --programs 50000 --seed 1 --processes 2

Each program runs with `--guards auto` on hostile inputs within the contracts. It prints the programs, the operations
that are proven safe or guarded, and every fault with the seed that makes its text.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path
from random import Random
from typing import NamedTuple

import numpy as np

sys.path[:0] = [str(Path(__file__).parents[1] / "tools")]

# After the line above, because tests/tools is not on the path of a script.
from hazard_programs import PARAMETERS, source  # noqa: E402
from sssgen.ir import contracts  # noqa: E402
from sssgen.ir.types import BY_NAME, Matrix, Type, kind_of  # noqa: E402
from sssgen.lang.loader import load_text  # noqa: E402
from sssgen.pipeline.compiler import transpile  # noqa: E402
from sssgen.run.backends import Array, Backend, Call, Text, get  # noqa: E402
from sssgen.run.evaluate.evaluation import shape_of  # noqa: E402

BATCH = 40
"""Programs in one text."""
LANES = 64
_SIZES = [0.0, 1e-45, 1e-40, 1.2e-38, 1e-37, 1e-30, 1e-20, 1e-12, 1e-6, 1e-3, 0.25, 0.5, 1.0, 1.0, 1.5, 2.0, 3.0, 8.0,
          87.0, 130.0, 1e3, 1e4, 1e6]  # fmt: skip
_BITS = [0, 1, 2, 3, 5, 31, 32, 255, 0x7F800000, 0x7FC00000, 0x7F800001, 0x3F800000, 0x7F7FFFFF, 0x7C007C00, 0x7FFFFFFF]
MAT4 = Matrix(4, 4)


class Count(NamedTuple):
    """What a number of programs gave."""

    programs: int
    proven: int
    guarded: int
    faults: list[str]


@cache
def types() -> tuple[Type, ...]:
    return tuple([BY_NAME[param.split()[0]] for param in PARAMETERS.split(", ")])


@cache
def arguments(seed: int) -> tuple[Array, ...]:
    """Hostile arguments within the contracts, one for each parameter."""
    rng = np.random.default_rng(seed)
    return tuple([_hostile(rng, type_) for type_ in types()])


def _hostile(rng: np.random.Generator, type_: Type) -> Array:
    shape = (*shape_of(type_), LANES)
    kind = kind_of(type_)
    if kind != "float":
        bits = np.array([*_BITS, *(bits ^ 0xFFFFFFFF for bits in _BITS)], np.uint32)
        values = np.where(rng.random(shape) < 0.7, rng.choice(bits, shape), rng.integers(0, 1 << 32, shape, np.uint32))
        return values.astype(np.uint32).view(np.int32 if kind == "int" else np.uint32)
    limit = (contracts.MATRIX if isinstance(type_, Matrix) else contracts.POSITION)["float"]
    sizes = np.array([number for number in _SIZES if number <= limit])
    values = rng.choice([1.0, -1.0], shape) * rng.choice(sizes, shape)
    share = LANES // 8
    values[..., :share] = values[(0,) * (len(shape) - 1)][:share]  # all components alike
    values[..., share : 3 * share] = rng.uniform(-4.0, 4.0, (*shape[:-1], 2 * share))
    values[..., 3 * share : 4 * share] = 10.0 ** rng.uniform(-30.0, np.log10(limit), (*shape[:-1], share))
    values[..., 4 * share : 5 * share] = rng.choice([limit, -limit], (*shape[:-1], share))
    result: Array = np.clip(values, -limit, limit).astype(np.float32)
    return result


def run(text: str, count: int, backend: Backend, seed: int = 0, guards: str = "auto") -> tuple[Count, list[Array]]:
    """The faults of the programs of a text on a back end, and their results."""
    names = [f"program_{number}" for number in range(count)]
    module = load_text(text, "hazards.sss")
    called = [function.key for function in module.functions if function.name in names]
    compiled = transpile(module, backend.target.name, "hazards", guards=guards, called=called)
    shader = next(text for name, text in compiled.files.items() if not name.endswith(".json"))
    renames = compiled.reflection["renames"]
    inputs = arguments(seed)
    calls = [Call(renames.get(name, name), types(), MAT4, inputs) for name in names]
    results = backend.run(Text(shader), calls)
    faults = []
    for name, result in zip(names, results, strict=True):
        flat = np.broadcast_to(result, (4, 4, LANES)).reshape(16, LANES)
        if len(wrong := np.flatnonzero(~np.isfinite(flat).all(axis=0))):
            shown = {
                param: value[..., wrong[0]].tolist()
                for param, value in zip(PARAMETERS.split(", "), inputs, strict=True)
            }
            faults.append(f"{name} at {shown}: {flat[:12, wrong[0]].tolist()} on {backend.name}")
    about = compiled.reflection
    return Count(count, about["proven_safe"], len(about["guards"]), faults), results


def batch(backend: str, size: int, count: int, seed: int) -> Count:
    """The programs of one seed."""
    result, _ = run(source(Random(seed), count, size), count, get(backend), seed % 16)
    return result._replace(faults=[f"seed {seed}, {fault}" for fault in result.faults])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--backend", default="numpy-f32")
    parser.add_argument("--batch", type=int, default=BATCH, help="programs in one text")
    parser.add_argument("--size", type=int, default=2, help="statements in a block, at most")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="start no more programs after this time")
    options = parser.parse_args()
    start = time.monotonic()
    seeds = range(options.seed * 1_000_000, options.seed * 1_000_000 + -(-options.programs // options.batch))
    work = partial(batch, options.backend, options.size, options.batch)
    total = Count(0, 0, 0, [])
    with ProcessPoolExecutor(options.processes) as pool:
        for count in pool.map(work, seeds):
            total = _added(total, count)
            if time.monotonic() - start > options.seconds:
                pool.shutdown(cancel_futures=True)
                break
    seconds = time.monotonic() - start
    print(
        f"{total.programs} programs of {LANES} lanes on {options.backend}: {total.proven} operations proven safe, ",
        end="",
    )
    print(f"{total.guarded} guarded, {len(total.faults)} programs with a number that is not finite, {seconds:.0f} s")
    return 1 if total.faults else 0


def _added(total: Count, count: Count) -> Count:
    for fault in count.faults:
        print(fault, flush=True)
    return Count(
        total.programs + count.programs, total.proven + count.proven, total.guarded + count.guarded,
        total.faults + count.faults,
    )  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
