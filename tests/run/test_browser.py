"""The back end `browser`: it draws in Chromium, and reports why it cannot draw."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

from processes import wait_until
from sssgen.ir.types import BY_NAME, FLOAT, INT, VEC2, VEC3, VEC4
from sssgen.lang.loader import load_text
from sssgen.run.backends import (
    VERTEX_SIZE,
    Backend,
    Block,
    Bound,
    Call,
    CompilerMissing,
    Drawing,
    Place,
    Stage,
    Text,
)
from sssgen.run.backends.browser import Browser
from sssgen.support.diagnostics import SssgenError
from sssgen.support.installation import install_hint
from sssgen.targets.runtime.numpy_textures import Texture
from validate import code

PICTURE = """
@vertex fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index % 2u), f32(index / 2u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn pixel(@builtin(position) place: vec4f) -> @location(0) vec4f {
    var x = place.x;
    return vec4f(x, place.y, 0.0, 1.0);
}
"""
ENDLESS = PICTURE.replace("return vec4f(x,", "loop { x = sin(x); if (x > 2.0) { break; } } return vec4f(x,")
MESH = """
struct Across { @builtin(position) place: vec4f, @location(0) uv: vec2f, @location(1) @interpolate(flat) sign: f32 }
@group(1) @binding(2) var<uniform> gain: vec4f;
@vertex fn corner(@location(0) p: vec3f, @location(2) tangent: vec4f, @location(3) uv: vec2f) -> Across {
    return Across(vec4f(p, 1.0), uv, tangent.w);
}
@fragment fn pixel(in: Across) -> @location(0) vec4f { return vec4f(in.uv, in.sign, 1.0) * gain; }
"""


@pytest.fixture
def browser(backend: Callable[[str], Backend]) -> Browser:
    result = backend("browser")
    assert isinstance(result, Browser)
    return result


def drawing(text: str, size: tuple[int, int] = (65, 3), **more: Any) -> Drawing:
    """A drawing of float32 pixels. The bytes of a row of 65 pixels need padding."""
    return Drawing(size, Stage(Text(text), "pixel"), Stage(Text(text), "corner"), floats=True, **more)


def assert_draws(browser: Browser) -> None:
    picture = browser.draw(drawing(PICTURE))
    y, x = np.mgrid[0:3, 0:65] + 0.5
    assert np.array_equal(picture, np.stack([x, y, 0.0 * x, 0.0 * x + 1.0], axis=-1))


def refusal(browser: Browser, job: Drawing) -> str:
    with pytest.raises(SssgenError) as error:
        browser.draw(job)
    return str(error.value)


def test_functions(browser: Browser) -> None:
    functions = "vec3 add(float a, vec3 b) { return a + b; } int twice(int a) { return 2 * a; }"
    text = code(load_text(functions, "t"), "wgsl")
    x, y, n = np.arange(5.0), np.arange(15.0).reshape(3, 5), np.arange(-2, 3)
    calls = [Call("add", (FLOAT, VEC3), VEC3, (x, y)), Call("twice", (INT,), INT, (n,))]
    sums, doubles = browser.run(Text(text), calls)
    assert np.array_equal(sums, x + y)
    assert np.array_equal(doubles, 2 * n)


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
def test_textures_wrap_and_have_levels(browser: Browser, wrap: str) -> None:
    texture = Texture(np.arange(4 * 8 * 3).reshape(4, 8, 3) / 64.0, wrap=wrap, mipmaps=True)
    text = code(load_text("vec4 look(sampler2D t, vec2 uv, float l) { return textureLod(t, uv, l); }", "t"), "wgsl")
    uv = np.array([[-0.9375, 0.1875, 0.25, 1.0625, 2.3125], [0.125, -0.375, 1.125, 2.625, 0.5]])
    level = np.array([0.0, 0.0, 1.0, 0.0, 2.0])
    call = Call("look", (BY_NAME["sampler2D"], VEC2, FLOAT), VEC4, ("image", uv, level))
    (result,) = browser.run(Text(text), [call], {"image": texture})
    assert result == pytest.approx(texture.sample(uv, level), abs=1e-3)


def test_implicit_levels_in_a_function(browser: Browser) -> None:
    """Several calls, each in its own branch, which Tint would report as non-uniform."""
    texture = Texture(np.arange(4 * 4 * 3).reshape(4, 4, 3) / 64.0, mipmaps=True)
    text = code(load_text("vec4 look(sampler2D t, vec2 uv) { return texture(t, uv); }", "t"), "wgsl")
    uv = np.full((2, 6), 0.375)
    call = Call("look", (BY_NAME["sampler2D"], VEC2), VEC4, ("image", uv))
    for result in browser.run(Text(text), [call, call], {"image": texture}):
        assert result == pytest.approx(texture.sample(uv, 0.0), abs=1e-3)


def test_vertices_and_blocks(browser: Browser) -> None:
    vertices = np.zeros((3, VERTEX_SIZE), np.float32)
    vertices[:, :2] = [[-1, 1], [3, 1], [-1, -3]]  # covers the whole picture; the first row is at the top
    vertices[:, 9] = -1.0
    vertices[:, 10:12] = [[0, 0], [2, 0], [0, 2]]
    gain = {"gain": Block(np.array([1, 2, 3, 4], np.float32).tobytes(), Place(1, 2))}
    triangles = np.array([[0, 1, 2]], np.uint32)
    picture = browser.draw(drawing(MESH, vertices=vertices, triangles=triangles, blocks=gain))
    y, x = (np.mgrid[0:3, 0:65] + 0.5) / [[[3]], [[65]]]
    assert picture == pytest.approx(np.stack([x, 2 * y, 0 * x - 3, 0 * x + 4], axis=-1), abs=1e-5)


def test_integer_textures_keep_their_bits(browser: Browser) -> None:
    text = PICTURE.replace("-> @location(0) vec4f", "-> @location(0) vec4u").replace(
        "return vec4f(x, place.y, 0.0, 1.0)", "return textureLoad(words, vec2i(place.xy), 0)"
    )
    words = np.random.default_rng(1).integers(0, 2**32, (5, 7, 4), np.uint32)
    job = drawing(f"@group(0) @binding(3) var words: texture_2d<u32>;{text}", (7, 5))
    bound = {"words": Bound(words, Place(0, 3))}
    assert np.array_equal(browser.draw(job._replace(floats=False, textures=bound)), words)


def test_large_picture(browser: Browser) -> None:
    picture = browser.draw(drawing(PICTURE, (1920, 1440)))
    assert picture.shape == (1440, 1920, 4)
    assert picture[-1, -1].tolist() == [1919.5, 1439.5, 0.0, 1.0]


def test_errors_name_the_line_and_its_origin(browser: Browser) -> None:
    broken = PICTURE.replace("place.y, 0.0,", "place.y, missing,")
    line = 1 + next(i for i, text in enumerate(broken.splitlines()) if "missing" in text)
    job = drawing(broken)
    placed = Stage(Text(broken, {line: "my/bark.sss:12:5"}), "pixel")
    message = refusal(browser, job._replace(fragment=placed))
    assert "unresolved value 'missing'" in message
    assert "my/bark.sss:12:5" in message
    assert f"line {line} of what was emitted: return vec4f(x, place.y, missing, 1.0);" in message
    assert_draws(browser)


def test_unsupported_drawings_are_errors(browser: Browser) -> None:
    assert "exceeded maximum texture size" in refusal(browser, drawing(PICTURE, (100_000, 1)))
    assert "doesn't exist" in refusal(browser, drawing(PICTURE.replace("fn pixel", "fn other")))
    assert_draws(browser)


@pytest.mark.skipif(os.name != "posix", reason="ends processes by their group")
def test_a_browser_that_is_lost_is_started_again(browser: Browser, monkeypatch: pytest.MonkeyPatch) -> None:
    assert_draws(browser)
    first = browser.page.process
    threading.Timer(0.3, os.killpg, (first.pid, signal.SIGKILL)).start()
    assert "crashed, or was ended by another program" in refusal(browser, drawing(ENDLESS))
    assert_draws(browser)
    os.killpg(browser.page.process.pid, signal.SIGKILL)  # after the first draw
    browser.page.process.wait()
    assert_draws(browser)
    with monkeypatch.context() as patch:
        patch.setattr(browser, "seconds", 0.5)
        message = refusal(browser, drawing(ENDLESS))
    assert "the browser did not answer within 0.5" in message
    assert_draws(browser)


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="finds the GPU process in /proc")
def test_a_lost_device(browser: Browser) -> None:

    def session(folder: Path) -> int:
        return int((folder / "stat").read_text().rsplit(")", 1)[1].split()[3])

    assert_draws(browser)
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            ours = session(folder) == browser.page.process.pid and b"=gpu-process" in (folder / "cmdline").read_bytes()
        except OSError:  # the process has ended
            continue
        if ours:
            os.kill(int(folder.name), signal.SIGKILL)
    assert "lost its device" in refusal(browser, drawing(ENDLESS))
    assert_draws(browser)


@pytest.fixture
def short_folder() -> Iterator[Path]:
    """A folder with a short path: the paths of Chromium's sockets have at most 107 bytes, and tmp_path may be long."""
    with TemporaryDirectory() as folder:
        yield Path(folder)


def test_a_killed_python_leaves_no_browser(browser: Browser, short_folder: Path) -> None:
    """The folder is removed when the browser has ended."""
    script = "from sssgen.run import backends; print(backends.get('browser').device(), flush=True); input()"
    python = subprocess.Popen(
        [sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env=os.environ | {"TMPDIR": str(short_folder)},
    )  # fmt: skip
    with python:
        assert python.stdout is not None
        assert python.stdout.readline().startswith("Tint in Chromium")
        assert list(short_folder.glob("sssgen-browser-*"))
        python.kill()
    wait_until(lambda: not list(short_folder.glob("sssgen-browser-*")), "the browser's folder to be removed")


def test_a_missing_browser() -> None:
    script = "from sssgen.run import backends; backends.get('browser')"
    environment = os.environ | {"SSSGEN_CHROMIUM": "/nowhere/chromium", "PYTHONIOENCODING": "utf-8"}
    process = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, encoding="utf-8")
    assert "CompilerMissing: chromium (Debian: chromium · elsewhere: Chrome; or set SSSGEN_CHROMIUM)" in process.stderr


def test_a_missing_package() -> None:
    script = "import sys; sys.modules['websockets'] = None; from sssgen.run import backends; backends.get('browser')"
    process = subprocess.run([sys.executable, "-c", script], capture_output=True, encoding="utf-8")
    assert "CompilerMissing: the Python package websockets" in process.stderr
    assert f"{install_hint('browser')} and Chromium or Chrome" in process.stderr


def test_a_program_that_is_not_a_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SSSGEN_CHROMIUM", sys.executable)
    with pytest.raises(CompilerMissing, match=r"ended as it started \(exit status 2\)"):
        Browser("browser", "wgsl")
