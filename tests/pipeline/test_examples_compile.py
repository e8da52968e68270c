"""Every compiler accepts every example for every target in both forms; every process emits the same bytes."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

import sssgen
from carried import carrying
from example_cases import example_cases
from slow_cases import diagonal
from sssgen.material.material_loading import examples
from sssgen.run.check.compiler_inputs import sources
from sssgen.run.compilers import Source

FORMS = ("shader", "functions")
LACKING = {name: {"shadertoy"} for name in ("jade_ring", "marble_idol", "wax_mouse")}
"""The targets that cannot express an example: its textures are volumes, or a program draws them."""
CASES = diagonal(example_cases("resin_inlay", "ice_inlay", "jelly_cubes"), FORMS)


def emitted(name: str, form: str) -> dict[str, str]:
    """The files of an example for all targets of the project that can carry it."""
    files: dict[str, str] = {}
    for target in carrying(name):
        files |= sssgen.compile(name, target, form).files
    return files


@pytest.mark.parametrize(("name", "form"), CASES)
def test_every_target_compiles(name: str, form: str, assert_compiles: object) -> None:
    result: list[Source] = sources(emitted(name, form))
    targets = sssgen.all_targets().items()
    own = {name for name, target in targets if any(output.stages for output in target.files[form])}
    assert {source.language for source in result} == own - LACKING.get(name, set())
    for source in result:
        assert_compiles(source)  # type: ignore[operator]  # the fixture is a function


@pytest.mark.parametrize("name", examples())
def test_functions_stay_short_and_keep_their_names(name: str) -> None:
    text = sssgen.compile(name, "glsl-330").files[f"{name}.glsl-330.frag"]
    lines, start = text.splitlines(), 0
    longest = 0
    for number, line in enumerate(lines):
        if line and not line[0].isspace() and line.endswith("{"):
            start = number
        elif line == "}":
            longest = max(longest, number - start + 1)
    assert 5 < longest <= 60
    for stage in sssgen.load_material(name).stages:
        body = stage.technique.function.body or ()
        assert f" {stage.technique.name}(" in text or len(body) == 1, stage.technique.name


SCRIPT = """
import hashlib, sssgen, sys
from sssgen.support.diagnostics import UnsupportedError
digest = hashlib.sha256()
for name in sys.argv[1:]:
    for target in sssgen.all_targets():
        for form in ("shader", "functions"):
            try:
                files = sssgen.compile(name, target, form).files
            except UnsupportedError as error:
                files = {"error": str(error)}
            for file, text in files.items():
                digest.update(f"{file}\\0{text}\\0".encode())
print(digest.hexdigest())
"""


@pytest.mark.parametrize("names", [["ice"], pytest.param(examples(), marks=pytest.mark.slow)], ids=["ice", "all"])
def test_results_do_not_depend_on_the_process(names: list[str], tmp_path: Path) -> None:
    messages = []
    for seed in ("1", "2"):
        environment = os.environ | {"PYTHONHASHSEED": seed, "SSSGEN_CACHE": str(tmp_path / seed)}
        ran = subprocess.run(
            [sys.executable, "-c", SCRIPT, *names], env=environment, capture_output=True, text=True, check=True
        )
        messages.append(ran.stdout)
    assert len(messages[0]) == 2 * hashlib.sha256().digest_size + 1
    assert messages[0] == messages[1]
