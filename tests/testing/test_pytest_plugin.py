"""The pytest plug-in: its fixtures and options, in small test runs inside this one."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.run.backends import Backend, missing

# pytester removes modules that a run imports first: their classes and contexts would then exist twice.
# So this file imports the renderer, and `_start_back_ends` starts every back end.
from sssgen.run.render import scene_render as render  # noqa: F401

pytest.importorskip("flip_evaluator", reason="flip-evaluator is missing: pip install -e '.[render]'")

pytest_plugins = ["pytester"]


@pytest.fixture(scope="module", autouse=True)
def _start_back_ends() -> None:
    missing()


SCENE = """\
material = "lamp.toml"
size = [24, 18]
samples = 1
[geometry]
kind = "ball"
[[light]]
direction = [0.0, 0.0, 1.0]
"""
MATERIAL = '[material]\nname = "lamp"\ndoc = "A lamp."\nshading = "lit"\n[[surface]]\ntechnique = "base_color"\n'
LOOKS = "def test_looks(sssgen_golden):\n    sssgen_golden('scene.toml', 'lamp')\n"

Run = Callable[..., pytest.RunResult]


@pytest.fixture
def run(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, backend: Callable[[str], Backend]
) -> Callable[..., pytest.RunResult]:
    """`run(test, *options)` runs the text of a test file, in a folder with scene.toml and lamp.toml."""
    backend("gl")
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.delenv("CI", raising=False)
    pytester.path.joinpath("scene.toml").write_text(SCENE, encoding="utf-8")
    pytester.path.joinpath("lamp.toml").write_text(MATERIAL, encoding="utf-8")

    def call(test: str, *options: str) -> pytest.RunResult:
        pytester.makepyfile(test)
        return pytester.runpytest_inprocess("-p", "sssgen.testing.pytest_plugin", *options)

    return call


def test_compile(run: Run) -> None:
    result = run("def test_it(sssgen_compile):\n    sssgen_compile('lamp.toml', targets='wgsl,glsl-330')\n")
    result.assert_outcomes(passed=1)


def test_a_compiler_s_error_is_at_the_technique_s_line(run: Run, pytester: pytest.Pytester) -> None:
    """The compiler is a substitute that refuses every text, because real compilers accept all emitted text."""
    refuse = pytester.path / "glslangValidator"
    refuse.write_text(
        '#!/bin/sh\n[ "$1" = --version ] && echo "Glslang Version: 1:1" && exit 0\ncat >/dev/null\n'
        'for n in $(seq 99); do echo "ERROR: 0:$n: no such thing"; done\nexit 2\n',
        encoding="utf-8",
    )
    refuse.chmod(0o755)
    test = """
def test_it(sssgen_compile, monkeypatch):
    monkeypatch.setenv("PATH", HERE, prepend=":")
    sssgen_compile("lamp.toml", targets=["glsl-330"])
"""
    result = run(test.replace("HERE", repr(str(pytester.path))))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*refused it*", "*glslang: *no such thing*", "*--> surface/base_color.sss:*"])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("sssgen_compile('lamp.toml', 'wgls')", "*did you mean 'wgsl'*"),
        ("sssgen_compile('none.toml')", "*none.toml*"),
        ("sssgen_run('beer_lamber', d=1.0)", "*did you mean 'beer_lambert'*"),
        ("sssgen_run('beer_lambert', x=1.0)", "*has no input 'x'*"),
        ("sssgen_run('beer_lambert', d=1.0, tolerance=-1.0)", "*-1.0 is not a tolerance*"),
        ("sssgen_render('none.toml')", "*none.toml*"),
        ("sssgen_render('scene.toml', size=(9000, 9000))", "*are too many*"),
        ("sssgen_golden('scene.toml', '../out')", "*leaves the output folder*"),
        ("sssgen_golden([[1.0]], 'one')", "*is not a picture*"),
        ("sssgen_golden('scene.toml', 'lamp', flip=2.0)", "*2.0 is not a threshold*"),
    ],
)
def test_wrong_input_is_reported_at_the_test_s_line(run: Run, call: str, message: str) -> None:
    fixture = call.partition("(")[0]
    result = run(f"def test_it({fixture}):\n    {call}\n")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([f">*{call.replace('[', '[[]')}", message])
    result.stdout.no_fnmatch_line("*sssgen*.py:*")


def test_run_returns_outputs_and_checks_them(run: Run, pytester: pytest.Pytester) -> None:
    pytester.path.joinpath("loss.sss").write_text(
        "/**\n * Loses all that is small: 1 + x - 1.\n * role: conversion\n */\n"
        "transmittance loss(thickness d)\n{\n    return transmittance((16777216.0 + d) - 16777216.0);\n}\n",
        encoding="utf-8",
    )
    test = """
def test_right(sssgen_run):
    found = sssgen_run("beer_lambert", d=[0.0, 1.0], attenuation_distance=1.0)
    assert found["result"].shape == (2,)
    assert abs(found["result"][1] - 0.36787944) < 1e-6

def test_wrong(sssgen_run):
    sssgen_run("beer_lambert", d=[0.3], tolerance=0.0)
"""
    result = run(test)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*gl deviates by *, more than 0*", "*float64 gives*"])


def test_golden_pictures(run: Run, pytester: pytest.Pytester) -> None:
    run(LOOKS).stdout.fnmatch_lines(["*no golden picture *golden/lamp.png: --sssgen-update writes it"])
    run(LOOKS, "--sssgen-update").assert_outcomes(passed=1)
    assert (pytester.path / "golden" / "lamp.png").is_file()
    assert [path.name for path in (pytester.path / "golden").iterdir()] == ["lamp.png"]
    run(LOOKS).assert_outcomes(passed=1)
    bright = SCENE + "color = [0.5, 0.5, 0.5]\n"
    pytester.path.joinpath("scene.toml").write_text(bright, encoding="utf-8")
    run(LOOKS).assert_outcomes(failed=1)
    assert (pytester.path / "sssgen-failures" / "lamp.difference.png").is_file()
    run(LOOKS.replace("'lamp'", "'lamp', flip=0.9")).assert_outcomes(passed=1)


def test_the_ini_file_sets_the_folder_of_golden_pictures(run: Run, pytester: pytest.Pytester) -> None:
    pytester.makeini("[pytest]\nsssgen_golden = kept/pictures\n")
    pytester.mkdir("tests")
    run(LOOKS, "--sssgen-update").assert_outcomes(passed=1)
    assert (pytester.path / "kept" / "pictures" / "lamp.png").is_file()


def test_a_users_picture(run: Run) -> None:
    test = """
import numpy as np

def test_it(sssgen_render, sssgen_golden):
    picture = sssgen_render("scene.toml", size=(12, 8), time=1.0)
    assert picture.linear.shape == picture.encoded.shape == (8, 12, 3)
    sssgen_golden(picture, "parts/small")
    sssgen_golden(picture.encoded, "parts/small")

def test_almost(sssgen_render, sssgen_golden):
    picture = sssgen_render("scene.toml", size=(12, 8)).encoded
    sssgen_golden(np.clip(picture + 1 / 255, 0.0, 1.0), "parts/small", flip=0.05)
"""
    run(test, "--sssgen-update", "-k", "it").assert_outcomes(passed=1)
    run(test).assert_outcomes(passed=2)


def test_a_users_picture_needs_no_back_end(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", os.devnull)
    test = "import numpy as np\n\ndef test_it(sssgen_golden):\n    sssgen_golden(np.zeros((8, 8, 3)), 'black')\n"
    run(test, "--sssgen-update").assert_outcomes(passed=1)
    run(LOOKS, "-rs").stdout.fnmatch_lines(["SKIPPED*the back end gl is missing: *libgl1-mesa-dri*"])


def test_each_back_end(run: Run, pytester: pytest.Pytester) -> None:
    test = LOOKS + "\ndef test_backend(sssgen_backend):\n    assert sssgen_backend in ('gl', 'numpy')\n"
    test += "\ndef test_none():\n    pass\n"
    options = ("--sssgen-backend", "numpy,gl", "--sssgen-backend", "gl", "-v")
    result = run(test, *options, "--sssgen-update")
    result.assert_outcomes(passed=5)
    result.stdout.fnmatch_lines_random(["*test_looks[[]gl]*", "*test_looks[[]numpy]*", "*test_none PASSED*"])
    (pytester.path / "golden" / "lamp.png").unlink()
    run(test, *options).assert_outcomes(passed=3, failed=2)
    stored = sorted(path.name for path in (pytester.path / "sssgen-failures").iterdir())
    assert stored == ["lamp.gl.actual.png", "lamp.numpy.actual.png"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--sssgen-backend", "gll"), "did you mean 'gl'"),
        (("--sssgen-flip", "2"), "from 0"),
        (("--sssgen-flip", "nan"), "from 0"),
    ],
)
def test_wrong_options(run: Run, options: tuple[str, ...], message: str) -> None:
    result = run("def test_none():\n    pass\n", *options)
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    assert message in "\n".join(result.errlines)


def test_the_fixtures_are_documented(run: Run) -> None:
    result = run("", "--fixtures")
    for name in ("compile", "run", "render", "golden"):
        result.stdout.fnmatch_lines_random([f"    `sssgen_{name}(*)` *"])


def python(folder: Path, *arguments: str, **variables: str) -> str:
    """The output of a Python process that has the entry points of this checkout's pyproject.toml."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    packages = folder / "packages"
    facts = packages / "sssgen-0.dist-info"
    facts.mkdir(parents=True, exist_ok=True)
    (facts / "METADATA").write_text("Metadata-Version: 2.1\nName: sssgen\nVersion: 0\n", encoding="utf-8")
    groups = project["entry-points"]
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in names.items()) for group, names in groups.items()]
    (facts / "entry_points.txt").write_text("".join(lines), encoding="utf-8")
    path = os.pathsep.join([str(packages), *sys.path])
    environment = {**os.environ, "PYTHONPATH": path, **variables}
    environment.pop("PYTEST_DISABLE_PLUGIN_AUTOLOAD", None)
    command = [sys.executable, *arguments]
    process = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


def test_pytest_loads_the_plugin_and_it_imports_little(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(
        "import sys\n\ndef test_it(request):\n"
        "    assert request.config.pluginmanager.has_plugin('sssgen')\n"
        "    ours = {name for name in sys.modules if name.partition('.')[0] == 'sssgen'}\n"
        "    plugin = 'sssgen.testing.pytest_plugin'\n"
        "    assert ours == {'sssgen', 'sssgen.version', 'sssgen.testing', plugin}\n"
        "    assert 'numpy' not in sys.modules\n",
        encoding="utf-8",
    )
    assert "1 passed" in python(tmp_path, "-m", "pytest", "-p", "no:hypothesispytest", "-p", "no:cacheprovider")


def test_without_numpy(tmp_path: Path) -> None:
    """Without NumPy, materials compile, and the other fixtures name the package to install."""
    packages = tmp_path / "packages"
    packages.mkdir()
    (packages / "numpy.py").write_text("raise ImportError('not installed', name='numpy')\n", encoding="utf-8")
    (tmp_path / "test_it.py").write_text(
        "def test_run(sssgen_run):\n    sssgen_run('beer_lambert', d=1.0)\n\n"
        "def test_compile(sssgen_compile):\n    sssgen_compile('ice', 'wgsl')\n",
        encoding="utf-8",
    )
    output = python(tmp_path, "-m", "pytest", "-rs", "-p", "no:cacheprovider", CI="")
    assert "1 passed, 1 skipped" in output
    assert re.search(r"the package 'numpy' is missing: \S+ install -e \"[^\"]+\[render\]\"", output)
