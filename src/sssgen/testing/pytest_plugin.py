"""Fixtures for pytest that compile materials, run techniques, draw scenes, and compare golden pictures.

    def test_the_lamp(sssgen_compile, sssgen_golden):
        sssgen_compile("materials/lamp.toml")
        sssgen_golden("scenes/lamp.toml", "lamp")

pytest imports this module in every test run of an environment with sssgen: it imports nothing until a fixture is used.
A path is searched for next to the test file, then in pytest's rootdir.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

if TYPE_CHECKING:
    from sssgen.run.backends import Array, Backend
    from sssgen.run.render.scene_render import RenderedPicture
    from sssgen.scene.scene import Scene
    from sssgen.testing.backend_pool import BackendPool
    from sssgen.testing.outcome import Outcome

Result = TypeVar("Result")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the options, and the ini setting for the folder of golden pictures."""
    group = parser.getgroup("sssgen", "shaders of sssgen")
    group.addoption(
        "--sssgen-backend", metavar="NAME", action="append", default=[],
        help="the back end that runs and draws; several, with commas, run each test on each (default: OpenGL)",
    )  # fmt: skip
    group.addoption("--sssgen-update", action="store_true", help="write golden pictures instead of comparing")
    group.addoption(
        "--sssgen-flip", metavar="X", type=float, help="the largest mean of FLIP that passes (default: 0.005)"
    )
    parser.addini(
        "sssgen_golden", "folder of golden pictures, relative to the ini file (default: golden, next to the test)"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Rejects invalid options. Without options it imports nothing."""
    flip = config.getoption("sssgen_flip")
    if flip is not None and not 0.0 <= flip <= 1.0:
        raise pytest.UsageError(f"--sssgen-flip {flip}: it must be from 0 (identical) to 1")
    if names := config.getoption("sssgen_backend"):
        from sssgen.support.diagnostics import SssgenError

        try:
            from sssgen.run.backends import backend_names
        except ImportError:  # without NumPy: the fixtures report it
            return
        try:
            backend_names(",".join(names))
        except SssgenError as error:
            raise pytest.UsageError(str(error)) from None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Runs a test once for each back end."""
    if "sssgen_backend" in metafunc.fixturenames:
        names = _names(metafunc.config)
        if len(names) > 1:
            metafunc.parametrize("sssgen_backend", names, indirect=True, scope="session")


@pytest.fixture(scope="session")
def sssgen_backend(request: pytest.FixtureRequest) -> str:
    """The name of the back end from `--sssgen-backend`: gl, webgpu, browser, hlsl, numpy, …"""
    return str(getattr(request, "param", _names(request.config)[0]))


@pytest.fixture(scope="session")
def _sssgen_backends() -> Iterator[BackendPool]:
    """The back ends, each in its own process: a driver that crashes fails one test."""
    _need("numpy")
    from sssgen.testing.backend_pool import BackendPool

    started = BackendPool()
    yield started
    started.close()


@pytest.fixture
def sssgen_compile(request: pytest.FixtureRequest) -> Callable[..., None]:
    """`sssgen_compile(material, targets="all")` compiles a material with every available compiler.

    `material` is a .toml file or an example's name; `targets` is "all", or names as in "wgsl,unity-urp". Fails with
    the compilers' messages at the technique's own lines. Skips without a compiler; with CI set it fails.
    """

    def compile(material: str | os.PathLike[str], targets: str | Iterable[str] = "all") -> None:
        __tracebackhide__ = True
        from sssgen.testing.compile_outcome import compile_material

        _end(_guard(lambda: compile_material(_place(request, material), targets)))

    return compile


@pytest.fixture
def sssgen_run(
    request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_backends: BackendPool
) -> Callable[..., dict[str, Array]]:
    """`sssgen_run(technique, bind=None, tolerance=1e-5, **inputs)` returns a technique's outputs as arrays, by name.

    `technique` is a name of the library, a .sss file or FILE:FUNCTION; `bind` has a function for each slot; an input is
    a number, an array with lanes first, or a texture (height, width, channels). `result` is the technique's result,
    (lanes,) or (lanes, 3). Fails where the back end deviates from NumPy's float64 by more than `tolerance`, relative
    above 1; lanes that are ill-conditioned in float32 are excluded.
    """

    def run(
        technique: str | os.PathLike[str],
        /,
        bind: Mapping[str, str] | None = None,
        tolerance: float = 1e-5,
        **inputs: Any,
    ) -> dict[str, Array]:
        __tracebackhide__ = True
        backend = _backend(_sssgen_backends, sssgen_backend)
        slots = {slot: _place(request, function) for slot, function in (bind or {}).items()}
        outputs, outcome = _guard(lambda: _run(_place(request, technique), slots, inputs, backend, tolerance))
        _end(outcome)
        return outputs

    return run


@pytest.fixture
def sssgen_render(
    request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_backends: BackendPool
) -> Callable[..., RenderedPicture]:
    """`sssgen_render(scene, size=None, time=None)` draws a scene's .toml file.

    `size` is (width, height) in pixels, `time` is in seconds; the defaults are the scene's. The picture has `.linear`,
    (height, width, 3) in linear light, `.encoded`, the same in sRGB 0..1, and `.covered`, (height, width): the share of
    each pixel that is not background. Row 0 is at the top.
    """

    def render(
        scene: str | os.PathLike[str] | Scene, size: tuple[int, int] | None = None, time: float | None = None
    ) -> RenderedPicture:
        __tracebackhide__ = True
        backend = _backend(_sssgen_backends, sssgen_backend)
        return _guard(lambda: _render(request, scene, backend, size, time))

    return render


@pytest.fixture
def sssgen_golden(
    request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_backends: BackendPool
) -> Callable[..., None]:
    """`sssgen_golden(picture, name, flip=None)` compares with golden/NAME.png next to the test file.

    `picture` is the result of `sssgen_render`, an array (height, width, 3) of sRGB 0..1, or a scene to draw. Fails if
    the mean of FLIP is above `flip` (default: `--sssgen-flip`, 0.005), and writes NAME.actual.png and
    NAME.difference.png to sssgen-failures/ next to golden/. `--sssgen-update` writes the golden picture. The setting
    `sssgen_golden` of the ini file names another folder, relative to it.
    """

    def golden(picture: Any, name: str, flip: float | None = None) -> None:
        __tracebackhide__ = True
        for module in ("PIL", "flip_evaluator"):
            _need(module)
        from sssgen.scene.scene import Scene

        if isinstance(picture, str | os.PathLike | Scene):
            scene, backend = picture, _backend(_sssgen_backends, sssgen_backend)
            picture = _guard(lambda: _render(request, scene, backend))
        _end(_guard(lambda: _golden(request, picture, name, flip, sssgen_backend)))

    return golden


def _golden(request: pytest.FixtureRequest, picture: Any, name: str, flip: float | None, backend: str) -> Outcome:
    from sssgen.run.render.scene_render import RenderedPicture
    from sssgen.testing import golden

    encoded = picture.encoded if isinstance(picture, RenderedPicture) else picture
    config, names = request.config, _names(request.config)
    setting = str(config.getini("sssgen_golden"))
    folder = str(config.rootpath / setting if setting else request.path.parent / golden.FOLDER)
    if config.getoption("sssgen_update") and backend == names[0]:
        return golden.update_golden(encoded, folder, name)
    limits = (flip, config.getoption("sssgen_flip"), golden.FLIP)
    limit = next(value for value in limits if value is not None)
    label = f".{backend}" if len(names) > 1 else ""
    return golden.compare_golden(encoded, folder, name, limit, label, update="--sssgen-update")


def _render(
    request: pytest.FixtureRequest,
    scene: str | os.PathLike[str] | Scene,
    backend: Backend,
    size: tuple[int, int] | None = None,
    time: float | None = None,
) -> RenderedPicture:
    from sssgen.run.render.scene_render import render
    from sssgen.scene.scene import Scene
    from sssgen.scene.scene_loading import load

    read = scene if isinstance(scene, Scene) else load(_place(request, scene))
    return render(read, backend, size, time)


def _run(
    technique: str, bind: Mapping[str, str], inputs: Mapping[str, Any], backend: Backend, tolerance: float
) -> tuple[dict[str, Array], Outcome]:
    from sssgen.run.evaluate.evaluation import fit_inputs
    from sssgen.run.evaluate.probes import subject
    from sssgen.testing.agreement import against_oracle, check_tolerance

    check_tolerance(tolerance)
    chosen = subject(technique, bind)
    return against_oracle(chosen, fit_inputs(chosen, inputs), backend, tolerance)


def _names(config: pytest.Config) -> list[str]:
    """The back ends of the options without duplicates; the pictures of the first are the golden ones."""
    from sssgen.run.backend_registry import PREFERRED

    listed = ",".join(config.getoption("sssgen_backend") or [PREFERRED])
    return list(dict.fromkeys(name.strip() for name in listed.split(",")))


def _place(request: pytest.FixtureRequest, path: str | os.PathLike[str]) -> str:
    from sssgen.testing.outcome import beside

    return beside(os.fspath(path), [str(request.path.parent), str(request.config.rootpath)])


def _backend(started: BackendPool, name: str) -> Backend:
    """The back end. Skips the test without it; with CI set the test fails."""
    __tracebackhide__ = True
    from sssgen.run.compilers import CompilerMissing
    from sssgen.testing.outcome import missing_part

    try:
        return _guard(lambda: started.get(name))
    except CompilerMissing as reason:
        outcome = missing_part(f"the back end {name}", str(reason))
    _end(outcome)
    raise AssertionError(outcome)


def _need(module: str) -> None:
    """Skips the test where a package is missing; with CI set the test fails."""
    __tracebackhide__ = True
    from importlib import import_module

    from sssgen.support.installation import install_hint
    from sssgen.testing.outcome import missing_part

    try:
        import_module(module)
    except ImportError as error:
        outcome = missing_part(f"the package '{error.name}'", install_hint("render"))
    else:
        return
    _end(outcome)


def _guard(call: Callable[[], Result]) -> Result:
    """The result of the call. An error of its input is shown at the test's own line, not at ours."""
    __tracebackhide__ = True
    from sssgen.support.diagnostics import SssgenError

    try:
        return call()
    except SssgenError as error:
        raise error.with_traceback(None) from None


def _end(outcome: Outcome) -> None:
    """Fails or skips the test, at its own line."""
    __tracebackhide__ = True
    if outcome.state == "failed":
        pytest.fail(outcome.text)
    if outcome.state == "skipped":
        pytest.skip(outcome.text)
