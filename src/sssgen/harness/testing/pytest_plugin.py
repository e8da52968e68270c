"""Fixtures for pytest that compile materials, run techniques, draw scenes, and compare golden pictures.

    def test_the_lamp(sssgen_compile, sssgen_golden):
        sssgen_compile("materials/lamp.toml")
        sssgen_golden("scenes/lamp.toml", "lamp")

Every test run of an environment with sssgen loads this module: it imports nothing until a fixture is used. A path is
looked for beside the test file, then in pytest's rootdir.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

if TYPE_CHECKING:
    from sssgen.harness.backends import Array, Backend
    from sssgen.harness.render.scene_render import Rendered
    from sssgen.harness.scenes.scene import Scene
    from sssgen.harness.testing.outcome import Outcome
    from sssgen.harness.testing.running_backends import Started

Found = TypeVar("Found")

DEFAULT = "gl"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options, and the folder of golden pictures in the ini file."""
    group = parser.getgroup("sssgen", "shaders of sssgen")
    group.addoption(
        "--sssgen-backend", metavar="NAME", action="append", default=[],
        help="the back end that runs and draws; several, with commas, run each test on each (default: gl)",
    )  # fmt: skip
    group.addoption("--sssgen-update", action="store_true", help="write golden pictures, instead of comparing")
    group.addoption(
        "--sssgen-flip", metavar="X", type=float, help="the largest mean of FLIP that passes (default: 0.005)"
    )
    parser.addini("sssgen_golden", "folder of golden pictures, from the ini file's; default: golden, beside the test")


def pytest_configure(config: pytest.Config) -> None:
    """Refuses options that mean nothing. Where none is given it imports nothing."""
    flip = config.getoption("sssgen_flip")
    if flip is not None and not 0.0 <= flip <= 1.0:
        raise pytest.UsageError(f"--sssgen-flip {flip}: it is from 0, which is the same, to 1")
    if given := config.getoption("sssgen_backend"):
        from sssgen.support.diagnostics import SssgenError

        try:
            from sssgen.harness.backends import chosen
        except ImportError:  # without NumPy: the fixtures say so
            return
        try:
            chosen(",".join(given))
        except SssgenError as error:
            raise pytest.UsageError(str(error)) from None


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test on each back end, where several are given."""
    names = _names(metafunc.config)
    if "sssgen_backend" in metafunc.fixturenames and len(names) > 1:
        metafunc.parametrize("sssgen_backend", names, indirect=True, scope="session")


@pytest.fixture(scope="session")
def sssgen_backend(request: pytest.FixtureRequest) -> str:
    """The name of the back end that runs and draws, of `--sssgen-backend`: gl, webgpu, browser, hlsl, numpy, …"""
    return str(getattr(request, "param", _names(request.config)[0]))


@pytest.fixture(scope="session")
def _sssgen_started() -> Iterator[Started]:
    """The back ends, each in a process of its own: a driver that crashes fails one test."""
    _need("numpy")
    from sssgen.harness.testing.running_backends import Started

    started = Started()
    yield started
    started.close()


@pytest.fixture
def sssgen_compile(request: pytest.FixtureRequest) -> Callable[..., None]:
    """`sssgen_compile(material, targets="all")` compiles a material with every compiler found.

    `material` is a .toml file or an example's name; `targets` is "all", or names as in "wgsl,unity-urp". Fails with
    what the compilers say, at the technique's own lines. Skips where no compiler is here; with CI set it fails.
    """

    def compile(material: str | os.PathLike[str], targets: str | Iterable[str] = "all") -> None:
        __tracebackhide__ = True
        from sssgen.harness.testing.compile_outcome import compiled

        _end(_guarded(lambda: compiled(_place(request, material), targets)))

    return compile


@pytest.fixture
def sssgen_run(
    request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_started: Started
) -> Callable[..., dict[str, Array]]:
    """`sssgen_run(technique, bind=None, tolerance=1e-5, **inputs)` gives a technique's outputs as arrays, by name.

    `technique` is a name of the library, a .sss file or FILE:FUNCTION; `bind` has a function for each slot; an input is
    a number, an array with lanes first, or a texture (height, width, channels). `result` is what the technique returns,
    (lanes,) or (lanes, 3). Fails where the back end is further than `tolerance`, relative above 1, from NumPy's
    float64, but for lanes where float32 itself must be.
    """

    def run(
        technique: str | os.PathLike[str],
        /,
        bind: Mapping[str, str] | None = None,
        tolerance: float = 1e-5,
        **inputs: Any,
    ) -> dict[str, Array]:
        __tracebackhide__ = True
        backend = _backend(_sssgen_started, sssgen_backend)
        slots = {slot: _place(request, function) for slot, function in (bind or {}).items()}
        found, outcome = _guarded(lambda: _run(_place(request, technique), slots, inputs, backend, tolerance))
        _end(outcome)
        return found

    return run


@pytest.fixture
def sssgen_render(
    request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_started: Started
) -> Callable[..., Rendered]:
    """`sssgen_render(scene, size=None, time=None)` draws a scene's .toml file.

    `size` is (width, height) in pixels, `time` is in seconds; without them the scene's own. The picture has `.linear`,
    (height, width, 3) in linear light, `.encoded`, the same in sRGB 0..1, and `.covered`, (height, width): how much of
    each pixel is not background. Row 0 is at the top.
    """

    def render(
        scene: str | os.PathLike[str] | Scene, size: tuple[int, int] | None = None, time: float | None = None
    ) -> Rendered:
        __tracebackhide__ = True
        backend = _backend(_sssgen_started, sssgen_backend)
        return _guarded(lambda: _render(request, scene, backend, size, time))

    return render


@pytest.fixture
def sssgen_golden(request: pytest.FixtureRequest, sssgen_backend: str, _sssgen_started: Started) -> Callable[..., None]:
    """`sssgen_golden(picture, name, flip=None)` compares with the golden picture golden/NAME.png beside the test file.

    `picture` is what `sssgen_render` gave, an array (height, width, 3) of sRGB 0..1, or a scene to draw. Fails where
    the mean of FLIP is above `flip` (`--sssgen-flip`, 0.005), and writes NAME.actual.png and NAME.difference.png into
    sssgen-failures/ beside golden/. `--sssgen-update` writes the golden picture; the ini file's `sssgen_golden` names
    another folder, from its own.
    """

    def golden(picture: Any, name: str, flip: float | None = None) -> None:
        __tracebackhide__ = True
        for module in ("PIL", "flip_evaluator"):
            _need(module)
        from sssgen.harness.scenes.scene import Scene

        if isinstance(picture, str | os.PathLike | Scene):
            scene, backend = picture, _backend(_sssgen_started, sssgen_backend)
            picture = _guarded(lambda: _render(request, scene, backend))
        _end(_guarded(lambda: _golden(request, picture, name, flip, sssgen_backend)))

    return golden


def _golden(request: pytest.FixtureRequest, picture: Any, name: str, flip: float | None, backend: str) -> Outcome:
    from sssgen.harness.render.scene_render import Rendered
    from sssgen.harness.testing import golden

    encoded = picture.encoded if isinstance(picture, Rendered) else picture
    config, names = request.config, _names(request.config)
    given = str(config.getini("sssgen_golden"))
    folder = str(config.rootpath / given if given else request.path.parent / golden.FOLDER)
    if config.getoption("sssgen_update") and backend == names[0]:
        return golden.updated(encoded, folder, name)
    limits = (flip, config.getoption("sssgen_flip"), golden.FLIP)
    limit = next(one for one in limits if one is not None)
    label = f".{backend}" if len(names) > 1 else ""
    return golden.compared(encoded, folder, name, limit, label, update="--sssgen-update")


def _render(
    request: pytest.FixtureRequest,
    scene: str | os.PathLike[str] | Scene,
    backend: Backend,
    size: tuple[int, int] | None = None,
    time: float | None = None,
) -> Rendered:
    from sssgen.harness.render.scene_render import render
    from sssgen.harness.scenes.scene import Scene
    from sssgen.harness.scenes.scene_loading import load

    read = scene if isinstance(scene, Scene) else load(_place(request, scene))
    return render(read, backend, size, time)


def _run(
    technique: str, bind: Mapping[str, str], inputs: Mapping[str, Any], backend: Backend, tolerance: float
) -> tuple[dict[str, Array], Outcome]:
    from sssgen.harness.evaluate.evaluation import fitted
    from sssgen.harness.evaluate.probes import subject
    from sssgen.harness.testing.agreement import against_oracle, check_tolerance

    check_tolerance(tolerance)
    chosen = subject(technique, bind)
    return against_oracle(chosen, fitted(chosen, inputs), backend, tolerance)


def _names(config: pytest.Config) -> list[str]:
    """The back ends of the options, each once; the first one's pictures are the golden ones."""
    given = ",".join(config.getoption("sssgen_backend") or [DEFAULT])
    return list(dict.fromkeys(name.strip() for name in given.split(",")))


def _place(request: pytest.FixtureRequest, path: str | os.PathLike[str]) -> str:
    from sssgen.harness.testing.outcome import beside

    return beside(os.fspath(path), [str(request.path.parent), str(request.config.rootpath)])


def _backend(started: Started, name: str) -> Backend:
    """The back end; a skip where this machine lacks it, with CI set a failure."""
    __tracebackhide__ = True
    from sssgen.harness.compilers import CompilerMissing
    from sssgen.harness.testing.outcome import lacking

    try:
        return _guarded(lambda: started.get(name))
    except CompilerMissing as reason:
        outcome = lacking(f"the back end {name}", str(reason))
    _end(outcome)
    raise AssertionError(outcome)


def _need(module: str) -> None:
    """A skip where a package is missing; with CI set a failure."""
    __tracebackhide__ = True
    from importlib import import_module

    from sssgen.harness.testing.outcome import lacking
    from sssgen.support.extras import install_hint

    try:
        import_module(module)
    except ImportError as error:
        outcome = lacking(f"the package '{error.name}'", install_hint("render"))
    else:
        return
    _end(outcome)


def _guarded(call: Callable[[], Found]) -> Found:
    """What the call gives. An error of its input is shown at the test's own line, not at ours."""
    __tracebackhide__ = True
    from sssgen.support.diagnostics import SssgenError

    try:
        return call()
    except SssgenError as error:
        raise error.with_traceback(None) from None


def _end(outcome: Outcome) -> None:
    """A failure or a skip, at the test's own line."""
    __tracebackhide__ = True
    if outcome.state == "failed":
        pytest.fail(outcome.text)
    if outcome.state == "skipped":
        pytest.skip(outcome.text)
