"""Measures the speed of emitting: `make bench`, or python benchmarks/bench_emit.py [MATERIAL…].

Each time is the median of several rounds, divided by the time of a `glslangValidator` process on the emitted fragment
shader. The cases take turns in each round. A cold case is a process of `sssgen emit` that emits a material for all
targets: nothing has changed since the last process; the value of a parameter has changed; a parameter is folded to
another constant, so that every pass runs again; the cache folder is empty. The warm cases make the same changes in one
process, with materials that are already loaded.
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
from sssgen.lang.check.module_checker import check
from sssgen.lang.syntax.parser import parse
from sssgen.material.material_loading import examples, parse_material
from sssgen.material.model import Material

ROOT = Path(__file__).parent.parent
MATERIALS = ("paper_lantern", "ice")
ROUNDS = 9
VARIANTS = 1000

Case = Callable[[int], object]


def text_of(name: str, value: str) -> str:
    """The example with another value of its parameter `distortion`."""
    lines = Path(examples()[name]).read_text("utf-8").splitlines(keepends=True)
    assert any(line.startswith("distortion = ") for line in lines)
    return "".join(f"distortion = {value}\n" if line.startswith("distortion = ") else line for line in lines)


def variant(name: str, index: int) -> str:
    """The material with the parameter changed."""
    return text_of(name, f"{0.1 + index / 100000:.5f}")


def rebuilt(name: str, index: int) -> str:
    """The material with the parameter folded to another constant."""
    return text_of(name, f"{{ value = {0.1 + index / 100000:.5f}, fixed = true }}")


def process(command: list[str], cache: Path) -> None:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    environment["SSSGEN_CACHE"] = str(cache)
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)


def cold(name: str, folder: Path) -> dict[str, Case]:
    """The cases that start a process."""
    out, cache = folder / "out", folder / "cache"

    def emit(case: str, text: str, stored: Path = cache) -> None:
        source = folder / f"{case}.toml"
        source.write_text(text, "utf-8")
        process([sys.executable, "-m", "sssgen", "emit", str(source), "--target", "all", "-o", str(out)], stored)

    for case in ("same", "changed", "rebuilt"):  # fills the caches, that of the bytecode too
        emit(case, variant(name, 0))
    shader = folder / "shader.frag"
    shader.write_bytes((out / f"{name}.glsl-330.frag").read_bytes())
    return {
        "one glslangValidator process": lambda _: process(["glslangValidator", str(shader)], cache),
        "(an empty Python process)": lambda _: process([sys.executable, "-c", "pass"], cache),
        "cold, nothing changed": lambda _: emit("same", variant(name, 0)),
        "cold, a parameter changed": lambda index: emit("changed", variant(name, index + 1)),
        "cold, a constant changed": lambda index: emit("rebuilt", rebuilt(name, index + 1)),
        "cold, an empty cache folder": lambda index: emit("same", variant(name, 0), folder / f"cache {index}"),
    }


def warm(name: str) -> dict[str, Case]:
    """The cases in this process."""
    targets = list(sssgen.all_targets())
    path = examples()[name]

    def materials(text: Callable[[str, int], str], first: int) -> list[Material]:
        return [parse_material(text(name, first + index), path) for index in range(ROUNDS + 1)]

    for_wgsl, for_all = materials(variant, 1000), materials(variant, 2000)
    with_new_constants = materials(rebuilt, 1000)
    loaded = sssgen.load_material(path)
    for target in targets:
        sssgen.compile(loaded, target)
    return {
        "warm, a parameter changed, one target": lambda index: sssgen.compile(for_wgsl[index], "wgsl"),
        f"warm, a parameter changed, all {len(targets)}": lambda index: [
            sssgen.compile(for_all[index], t) for t in targets
        ],
        f"warm, a constant changed, all {len(targets)}": lambda index: [
            sssgen.compile(with_new_constants[index], t) for t in targets
        ],
        "unchanged, by its path": lambda _: sssgen.compile(path, "wgsl"),
        "unchanged, a loaded material": lambda _: sssgen.compile(loaded, "wgsl"),
    }


def measure(name: str) -> None:
    """Prints the table of one material."""
    with tempfile.TemporaryDirectory() as folder:
        cases = cold(name, Path(folder)) | warm(name)
        times: dict[str, list[float]] = {case: [] for case in cases}
        for index in range(ROUNDS + 1):
            for case, run in cases.items():
                start = time.perf_counter()
                run(index)
                times[case].append(time.perf_counter() - start)
    medians = {case: statistics.median(result[1:]) for case, result in times.items()}
    unit = medians["one glslangValidator process"]
    print(f"\n| {name:38} |  ratio |        ms |\n|{'-' * 40}|-------:|----------:|")
    for case, seconds in medians.items():
        print(f"| {case:38} | {seconds / unit:6.3f} | {seconds * 1000:9.3f} |")


def measure_variants(name: str) -> None:
    """Prints the number of variants a second, and whether the last are as fast as the first."""
    materials = [parse_material(variant(name, 5000 + index), examples()[name]) for index in range(VARIANTS)]
    parts = []
    for start in range(0, VARIANTS, VARIANTS // 4):
        began = time.perf_counter()
        for material in materials[start : start + VARIANTS // 4]:
            sssgen.compile(material, "hlsl")
        parts.append(time.perf_counter() - began)
    shares = ", ".join(f"{part / parts[0]:.2f}" for part in parts)
    print(
        f"\n{VARIANTS} variants of {name}, one target: {VARIANTS / sum(parts):.0f} a second; the quarters take {shares}"
    )


def measure_parsing() -> None:
    """Prints how fast the front end reads."""
    files = [path.read_text("utf-8") for path in sorted((ROOT / "src/sssgen/techniques").glob("common/*.sss"))]
    text = "\n".join(part for part in files if "#include" not in part and "uniform" not in part) * 40
    start = time.perf_counter()
    parse(text, "all.sss")
    parsed = time.perf_counter() - start
    start = time.perf_counter()
    for _ in range(20):
        check(parse(files[0], "one.sss"), files[0])
    checked = time.perf_counter() - start
    rates = len(text) / parsed / 1000, 20 * len(files[0]) / checked / 1000
    print(f"the front end: {rates[0]:.0f} kB/s; with the checker {rates[1]:.0f} kB/s")


def machine() -> str:
    """The machine in one line."""
    name = platform.machine()
    if Path("/proc/cpuinfo").is_file():
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
        name = next((line.partition(": ")[2] for line in lines if line.startswith("model name")), name)
    output = subprocess.run(["glslangValidator", "--version"], capture_output=True, text=True, check=True).stdout
    python = f"Python {platform.python_version()}"
    return f"{name}, {os.cpu_count()} cores, {platform.system()}, {python}, {output.splitlines()[0]}"


if __name__ == "__main__":
    print(machine())
    for chosen in sys.argv[1:] or MATERIALS:
        measure(chosen)
        measure_variants(chosen)
    measure_parsing()
