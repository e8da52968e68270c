"""How fast emitting is, as ratios measured in one run: `make bench`, or python benchmarks/bench_emit.py.

Cold: a whole process of `sssgen emit` of one material to all targets, beside one `glslangValidator` process on the
GLSL it emitted, in turn, medians. `warm caches` means that the cache folder holds the grammar's tables, the parsed
techniques and the compiled templates; the material is another one each time, so no result is found there.
Warm: in one process, loaded materials whose parameters differ each time.
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import sssgen
from sssgen.lang.check import check
from sssgen.lang.parser import parse
from sssgen.material import parse_material

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "examples/paper_lantern/paper_lantern.toml").read_text("utf-8")
COLD_ROUNDS = 9
VARIANTS = 1000


def variant(index: int) -> str:
    """The material with one parameter changed."""
    assert "distortion = 0.15" in TEXT
    return TEXT.replace("distortion = 0.15", f"distortion = {0.1 + index / 100000:.5f}")


def milliseconds(run: Callable[[], object]) -> float:
    start = time.perf_counter()
    run()
    return (time.perf_counter() - start) * 1000


def process(command: list[str], cache: str) -> float:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"SSSGEN_CACHE": cache}
    return milliseconds(lambda: subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL))


def cold() -> None:
    with tempfile.TemporaryDirectory() as folder:
        source, out, cache = Path(folder, "lantern.toml"), str(Path(folder, "out")), str(Path(folder, "cache"))
        emit = [sys.executable, "-m", "sssgen", "emit", str(source), "--target", "all", "-o", out]
        validate = ["glslangValidator", str(Path(out, "paper_lantern.glsl-330.frag"))]
        source.write_text(variant(0), "utf-8")
        process(emit, cache)  # bytecode and caches
        rounds: dict[str, list[float]] = {"glslang": [], "warm": [], "same": [], "empty": [], "python": []}
        for index in range(1, COLD_ROUNDS + 1):
            rounds["glslang"].append(process(validate, cache))
            source.write_text(variant(index), "utf-8")
            rounds["warm"].append(process(emit, cache))
            rounds["same"].append(process(emit, cache))
            rounds["empty"].append(process(emit, str(Path(folder, f"cache{index}"))))
            rounds["python"].append(process([sys.executable, "-c", "pass"], cache))
        median = {name: statistics.median(times) for name, times in rounds.items()}
        for name, what in (
            ("warm", "cold process, warm caches, a changed material"),
            ("same", "cold process, warm caches, the same material"),
            ("empty", "cold process, an empty cache folder"),
            ("python", "(an empty Python process)"),
        ):
            print(f"{what:50} {median[name] / median['glslang']:5.2f} x glslangValidator ({median[name]:.0f} ms)")


def warm() -> None:
    targets = list(sssgen.all_targets())
    materials = [
        parse_material(variant(index), ROOT / "examples/paper_lantern/paper_lantern.toml") for index in range(VARIANTS)
    ]
    sssgen.compile(materials[0], "wgsl")
    for target in targets:
        sssgen.compile(materials[1], target)
    one = statistics.median(milliseconds(lambda m=m: sssgen.compile(m, "wgsl")) for m in materials[2:60])
    each = [milliseconds(lambda m=m: [sssgen.compile(m, target) for target in targets]) for m in materials[60:120]]
    print(f"{'warm, a changed material, one target':50} {one:5.2f} ms")
    print(f"{f'warm, a changed material, all {len(targets)} targets':50} {statistics.median(each):5.2f} ms")
    hit = milliseconds(lambda: [sssgen.compile("ice", "wgsl") for _ in range(1000)]) / 1000
    print(f"{'the same input again, by name':50} {hit:5.3f} ms")
    parts = []
    for start in range(0, VARIANTS, VARIANTS // 4):
        part = materials[start : start + VARIANTS // 4]
        parts.append(milliseconds(lambda part=part: [sssgen.compile(m, "hlsl") for m in part]))
    print(f"{f'{VARIANTS} variants, one target':50} {1000 * VARIANTS / sum(parts):5.0f} a second; quarters: "
          + ", ".join(f"{part / parts[0]:.2f}" for part in parts))  # fmt: skip
    files = [path.read_text("utf-8") for path in sorted((ROOT / "src/sssgen/techniques").glob("common/*.sss"))]
    text = "\n".join(part for part in files if "#include" not in part and "uniform" not in part) * 40
    spent = milliseconds(lambda: parse(text, "all.sss"))
    print(f"{'parsing':50} {len(text) / spent:5.0f} kB/s")
    one_file = files[0]
    spent = milliseconds(lambda: [check(parse(one_file, "one.sss"), one_file) for _ in range(20)])
    print(f"{'parsing and checking':50} {20 * len(one_file) / spent:5.0f} kB/s")


if __name__ == "__main__":
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    cold()
    warm()
