"""Fuzzes for a given time: rounds of the tests here, each with other inputs, then atheris if it is installed.

    python tests/fuzz/long.py --minutes 10

It ends at the first failure, which says the input or the seed, and tells what it has done.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import secrets
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

HERE = Path(__file__).parent
EXAMPLES = 300
"""Examples of each test in a round; of programs a tenth."""
ATHERIS = ("source", "material", "scene", "module", "ci table", "png")
SHARE = 0.25
"""The part of the time that atheris has."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    seconds = 60.0 * parser.parse_args().minutes
    atheris = importlib.util.find_spec("atheris") is not None
    work = Path("build", "fuzz")
    work.mkdir(parents=True, exist_ok=True)
    end = time.monotonic() + seconds * (1.0 - SHARE if atheris else 1.0)
    counted: Counter[str] = Counter()
    rounds = status = 0
    while not status and (not rounds or time.monotonic() < end):
        rounds += 1
        status = tests(work, secrets.randbelow(1 << 32), counted)
    if not atheris:
        print("atheris is not installed: pip install atheris")
    for name in ATHERIS if atheris and not status else ():
        status = status or hunt(work, name, max(5, int(seconds * SHARE / len(ATHERIS))))
    message = ", ".join(f"{count} × {what}" for what, count in sorted(counted.items()))
    print(f"{rounds} rounds: {message}{'; it FAILED' if status else ''}")
    return status


def tests(work: Path, seed: int, counted: Counter[str]) -> int:
    """One round of the tests; its exit status."""
    counts = work / "counts.json"
    counts.unlink(missing_ok=True)
    environment = {"FUZZ_EXAMPLES": str(EXAMPLES), **os.environ, "FUZZ_COUNTS": str(counts)}
    command = [sys.executable, "-m", "pytest", "-q", "-x", str(HERE), f"--hypothesis-seed={seed}"]
    print(f"seed {seed}", flush=True)
    status = subprocess.run(command, env=environment, check=False).returncode
    if counts.is_file():
        counted.update(json.loads(counts.read_text(encoding="utf-8")))
    return status


def hunt(work: Path, name: str, seconds: int) -> int:
    """Atheris at one front end; its exit status."""
    corpus = work / name.replace(" ", "_")
    options = [
        f"-max_total_time={seconds}",
        f"-artifact_prefix={corpus}-",
        "-max_len=8192",
        "-verbosity=0",
        "-print_final_stats=1",
    ]
    print(f"atheris: {name}, {seconds} s", flush=True)
    command = [sys.executable, str(HERE / "atheris_front_ends.py"), name, str(corpus), *options]
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
