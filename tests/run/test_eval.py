"""`sssgen eval`: a technique on arrays of inputs, on every back end, and the messages for wrong inputs."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slow_cases import some_slow
from sssgen.cli.main import main
from sssgen.run import backends, compilers
from sssgen.run.backends import Backend, Text
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.dispatch import Dispatch, by_webgpu
from sssgen.run.evaluate import input_files as inputs
from sssgen.run.evaluate.deviation import deviation, errors
from sssgen.run.evaluate.evaluation import evaluate
from sssgen.run.evaluate.probes import subject
from sssgen.scene.pictures.images import write_exr, write_png
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.runtime.numpy_textures import Texture

LOBE: dict[str, Any] = {"V": [0, 0, 1], "N": [0, 0, 1], "L": [[0, 0, -1], [0.6, 0, -0.8]], "through": 0.5}


@pytest.fixture
def write_inputs(tmp_path: Path) -> Callable[..., str]:
    """Writes inputs to a file."""

    def write(data: object, name: str = "inputs.json") -> str:
        path = tmp_path / name
        path.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
        return str(path)

    return write


def answer(capsys: pytest.CaptureFixture[str], *arguments: str, status: int = 0) -> Any:
    """The JSON that the command prints."""
    assert main(["eval", *arguments, "--json"]) == status
    return json.loads(capsys.readouterr().out)


def complaint(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The error message of the command for wrong input."""
    assert main(["eval", *arguments]) == 2
    return capsys.readouterr().err


# Results


def test_outputs_of_the_oracle(capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str]) -> None:
    """GDC 2011: pow(dot(V, −(L + N distortion)), power) scale, and ambient, times the transmitted part."""
    values = {**LOBE, "distortion": 0.2, "power": 2.0, "scale": 3.0, "ambient": 0.1, "attenuation": 1.0}
    report = answer(capsys, "lobe_gdc2011", "-i", write_inputs(values | {"subsurface_color": [1.0, 0.5, 0.25]}))
    lobe = [(light[2] + 0.2) ** 2 * 3.0 for light in LOBE["L"]]
    expected = [[(power + 0.1) * 0.5 * part for part in (1.0, 0.5, 0.25)] for power in lobe]
    np.testing.assert_allclose(report["outputs"]["result"], expected, rtol=1e-6)
    assert report["lanes"] == 2 and report["backend"] == "numpy"


@pytest.mark.parametrize("names", some_slow(["gl,webgpu,numpy-f32", "all"], "gl,webgpu,numpy-f32"))
def test_back_ends_agree(names: str, capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str]) -> None:
    report = answer(capsys, "lobe_gdc2011", "-i", write_inputs(LOBE), "--backend", names)
    rows = {row["name"]: row for row in report["backends"]}
    assert set(rows) == set(backends.FUNCTIONS if names == "all" else names.split(","))
    for name, row in rows.items():
        assert row.get("missing") or row["deviation"] <= (1e-3 if name.endswith("f16") else 1e-6), row


def test_precisions(capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str]) -> None:
    file = write_inputs(LOBE)
    wide, single, half = (
        np.array(answer(capsys, "lobe_gdc2011", "-i", file, "--precision", precision)["outputs"]["result"])
        for precision in ("f64", "f32", "f16")
    )
    assert 0.0 < np.abs(single - wide).max() < 1e-6 < np.abs(half - wide).max() < 1e-2


def test_out_parameters_are_outputs(capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str]) -> None:
    report = answer(capsys, "camera_orbit", "-i", write_inputs({"uv": [[0.5, 0.5], [0.25, 1.0]], "time": 0.0}))
    assert list(report["outputs"]) == ["ray_origin", "ray_direction"]
    assert report["outputs"]["ray_origin"][0] == pytest.approx([3.0, 2.5, 0.0])


def test_a_function_of_a_file_for_a_slot(
    capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str], tmp_path: Path
) -> None:
    """The thinness is 0 in full space, 1 in empty space."""
    own = tmp_path / "own.sss"
    own.write_text(
        "float full(world_position p) { return -10.0; }\nfloat empty(world_position p) { return p.y + 10.0; }\n",
        encoding="utf-8",
    )
    file = write_inputs({"P": [[0.0, 0.0, 0.0]], "N": [0.0, 1.0, 0.0]})
    output = complaint(capsys, "thinness_uniform", "-i", file, "--bind", "nowhere=sphere")
    assert "has no slot 'nowhere'" in output and "body_distance" in output
    for name, expected in (("full", 0.0), ("empty", 1.0)):
        report = answer(capsys, "thinness_uniform", "-i", file, "--bind", f"body_distance={own}:{name}", "-b", "numpy")
        assert report["outputs"]["result"] == [expected]
    assert evaluate(subject(f"{own}:empty"), {"p": [1.0, 2.0, 3.0]}, backends.get("numpy"))["result"] == [12.0]


@pytest.mark.parametrize("name", ["numpy", "gl", "gl-es", "webgpu", "browser", "hlsl", "hlsl-glslang", "unity"])
def test_textures_of_all_kinds_of_files(name: str, backend: Callable[[str], Backend], tmp_path: Path) -> None:
    """The lowest row of a picture is at v = 0. sRGB colours are decoded; those of .exr and .npy files are linear."""
    rows = np.array([[[0.0, 1.0, 0.5], [1.0, 0.0, 0.5]], [[0.25, 0.25, 0.25], [0.75, 0.5, 0.125]]])
    write_png(tmp_path / "a.png", rows)
    write_exr(tmp_path / "a.exr", rows)
    np.save(tmp_path / "a.npy", rows[::-1])
    centres = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]
    technique = subject("base_color")
    assert technique.uniforms["base_color_texture"].hints
    for file in ("a.png", "a.exr", "a.npy"):
        texture = inputs.texture(str(tmp_path / file), filter="nearest")
        result = evaluate(technique, {"uv": centres, "base_color_texture": texture}, backend(name))["albedo"]
        np.testing.assert_allclose(result, rows[::-1].reshape(4, 3), atol=1 / 500)
    whole = json.dumps({"uv": centres, "base_color_texture": {"file": "a.png", "filter": "nearest", "wrap": "clamp"}})
    (tmp_path / "in.json").write_text(whole, encoding="utf-8")
    read = inputs.read(str(tmp_path / "in.json"), technique)
    decoded = evaluate(technique, read, backend(name))["albedo"]
    assert decoded[0] == pytest.approx([((64 / 255 + 0.055) / 1.055) ** 2.4] * 3, abs=1e-4)


def test_ten_thousand_lanes_are_one_draw(backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch) -> None:
    gpu = backend("gl")
    draws = []
    draw = gpu.draw  # type: ignore[attr-defined]
    monkeypatch.setattr(gpu, "draw", lambda drawing: draws.append(drawing) or draw(drawing))
    rng = np.random.default_rng(3)
    inputs = {name: rng.normal(size=(10_000, 3)) for name in "VNL"}
    inputs = {name: v / np.linalg.norm(v, axis=1, keepdims=True) for name, v in inputs.items()} | {"through": 0.5}
    technique = subject("lobe_gdc2011")
    result, expected = (evaluate(technique, inputs, back_end) for back_end in (gpu, backends.get("numpy")))
    assert len(draws) == 1
    assert deviation(result, expected).largest < 1e-5


# Deviations


def test_deviation_is_relative_above_one_and_absolute_below() -> None:
    expected = np.array([[100.0, 0.0], [0.5, 0.0], [np.nan, 0.0], [np.inf, 0.0]])
    actual = np.array([[100.1, 0.05], [0.5, 0.001], [np.nan, 0.0], [np.inf, 0.0]])
    assert errors(actual, expected) == pytest.approx([0.001, 0.001, 0.0, 0.0])
    assert np.isinf(errors(np.array([[0.0, 0.0]]), expected[2:3])) and np.isinf(errors(expected[2:3], expected[1:2]))
    worst = deviation({"a": actual[:2], "b": np.array([1.0, 9.0])}, {"a": expected[:2], "b": np.array([1.0, 3.0])})
    assert (worst.output, worst.lane, worst.largest) == ("b", 1, 2.0)


# Wrong inputs


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V": None}, "needs more inputs: V (vec3)"),
        ({"M": 1.0}, "has no input 'M'"),
        ({"distorsion": 0.1}, "did you mean 'distortion'?"),
        ({"N": [0, 0]}, "input 'N' has the shape 2, not that of vec3"),
        ({"N": [[0, 0, 1], [0, 1]]}, "input 'N': its rows have different lengths"),
        ({"N": [[[0, 0, 1]]]}, "input 'N' has the shape 1×1×3"),
        ({"N": []}, "input 'N'"),
        ({"through": [[0.5]]}, "input 'through' has the shape 1×1, not that of float"),
        ({"N": [[0, 0, 1]] * 3}, "the inputs have different numbers of values: N has 3, L has 2"),
        ({"N": [0, 0, float("nan")]}, "input 'N' is NaN or infinite at number 0"),
        ({"L": [[0, 0, 1], [0, float("inf"), 0]]}, "input 'L' is NaN or infinite at number 1"),
        ({"through": 1e300}, "input 'through' is too large for a 32-bit float"),
        ({"through": True}, "input 'through' is not of type float"),
        ({"through": "half.png"}, "cannot find the picture"),
        ({"through": {"a": 1}}, "texture 'through'"),
    ],
)
def test_wrong_inputs(
    capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str], change: dict[str, Any], message: str
) -> None:
    values = {name: value for name, value in {**LOBE, **change}.items() if value is not None}
    assert message in complaint(capsys, "lobe_gdc2011", "-i", write_inputs(values))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "this is not JSON"),
        ("[1, 2]", "the inputs are not a JSON object"),
        ("[" * 100_000, "nested too deeply"),
        ('{"V": [0, 0, 1],\n "N": [0, 0, 1,]}', ":2:"),
    ],
)
def test_wrong_json(
    capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str], text: str, message: str
) -> None:
    assert message in complaint(capsys, "lobe_gdc2011", "-i", write_inputs(text))


def test_wrong_files(capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str], tmp_path: Path) -> None:
    assert "cannot read the inputs" in complaint(capsys, "lobe_gdc2011", "-i", str(tmp_path / "none.json"))
    assert "cannot read the inputs" in complaint(capsys, "lobe_gdc2011", "-i", str(tmp_path))
    (tmp_path / "binary.json").write_bytes(b"\xff\xfe\x00")
    assert "not UTF-8" in complaint(capsys, "lobe_gdc2011", "-i", str(tmp_path / "binary.json"))
    np.save(tmp_path / "volume.npy", np.ones((2, 2, 2, 1)))
    np.save(tmp_path / "bad.npy", np.full((2, 2, 3), np.nan))
    for file, message in (("volume.npy", "takes a sampler2D"), ("bad.npy", "NaN or infinity"), ("x.jpg", "'.jpg'")):
        values = {"uv": [0.5, 0.5], "base_color_texture": file}
        assert message in complaint(capsys, "base_color", "-i", write_inputs(values))


def test_wrong_arguments(capsys: pytest.CaptureFixture[str], write_inputs: Callable[..., str]) -> None:
    file = write_inputs(LOBE)
    assert "did you mean 'webgpu'?" in complaint(capsys, "lobe_gdc2011", "-i", file, "-b", "webgpuu")
    assert "unknown technique 'lobe_gdc2012'" in complaint(capsys, "lobe_gdc2012", "-i", file)
    assert "own precision" in complaint(capsys, "lobe_gdc2011", "-i", file, "-b", "gl", "--precision", "f64")
    assert "is not a binding" in complaint(capsys, "lobe_gdc2011", "-i", file, "--bind", "a")


def test_a_missing_back_end(write_inputs: Callable[..., str]) -> None:
    """A back end requested by name gives an error with instructions; with `all` it gives a line, and the others run."""
    environment = {**os.environ, "SSSGEN_CHROMIUM": "/nowhere/chromium", "CI": ""}
    command = [sys.executable, "-m", "sssgen", "eval", "lobe_gdc2011", "-i", write_inputs(LOBE), "-b"]
    alone = subprocess.run([*command, "browser"], env=environment, capture_output=True, text=True, check=False)
    assert alone.returncode == 2 and "help: chromium" in alone.stderr
    among = subprocess.run([*command, "numpy,browser,gl"], env=environment, capture_output=True, text=True, check=False)
    bare = {**environment, "PATH": "/nowhere"}
    none = subprocess.run([*command, "browser,hlsl"], env=bare, capture_output=True, text=True, check=False)
    assert none.returncode == 1 and none.stdout.count("missing: ") == 2
    strict = {**environment, "CI": "true"}
    assert subprocess.run([*command, "numpy,browser"], env=strict, capture_output=True, check=False).returncode == 1
    assert "missing: chromium" in among.stdout and "\ngl " in among.stdout and among.returncode == 0


# Drivers that refuse, crash and hang


def test_a_refusal_names_the_techniques_line(backend: Callable[[str], Backend]) -> None:
    """If the driver refuses a text, the message has the line of the technique."""
    from sssgen.ir.types import FLOAT
    from sssgen.run.backends import Call, Text

    wrong = {
        "gl": "float f(float x) {\n    return y;\n}\n",
        "hlsl": "float f(float x) {\n    return y;\n}\n",
        "hlsl-glslang": "float f(float x) {\n    return y;\n}\n",
        "unity": "float f(float x) {\n    return y;\n}\n",
        "unity-urp": "float f(float x) {\n    return y;\n}\n",
        "webgpu": "fn f(x: f32) -> f32 {\n    return y;\n}\n",
        "browser": "fn f(x: f32) -> f32 {\n    return y;\n}\n",
    }
    for name, text in wrong.items():
        with pytest.raises(SssgenError) as caught:
            backend(name).run(Text(text, {2: "lobe.sss:7:3"}), [Call("f", (FLOAT,), FLOAT, (np.ones(4),))])
        (first, *_) = caught.value.diagnostics
        assert (first.span.file, first.span.line, first.span.column) == ("lobe.sss", 7, 3), name
        assert first.message.startswith(f"{name}: ") and "return y;" in first.hint, name


def test_a_crashed_back_end_is_restarted(backend: Callable[[str], Backend]) -> None:
    backend("gl")
    gpu = BackendProcess("gl")
    technique, expected = subject("lobe_gdc2011"), None
    try:
        expected = evaluate(technique, LOBE, gpu)["result"]
        assert gpu.process.process is not None
        os.kill(gpu.process.process.pid, signal.SIGSEGV)
        with pytest.raises(SssgenError, match=r"gl: the back end crashed \(SIGSEGV\)"):
            evaluate(technique, LOBE, gpu)
        assert np.array_equal(evaluate(technique, LOBE, gpu)["result"], expected)
    finally:
        gpu.close()


def test_a_lost_device_is_replaced(backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch) -> None:
    """Imitates the reset of a driver. Lost browsers are in test_browser.py, lost processes below."""
    gpu: Any = backend("webgpu")
    technique, write_inputs = subject("beer_lambert"), {"d": [0.1, 0.2], "attenuation_distance": 0.1}
    gpu.gpu.destroy()
    assert evaluate(technique, write_inputs, gpu)["result"] == pytest.approx(np.exp([-1.0, -2.0]))
    assert compilers.get("naga").check(compilers.Source("fn f() -> f32 { return 1.0; }", "wgsl", "library")) == []
    start = gpu.start

    def start_and_lose(naga: Any) -> None:
        start(naga)
        gpu.gpu.destroy()

    with monkeypatch.context() as patch:
        patch.setattr(gpu, "start", start_and_lose)
        gpu.gpu.destroy()
        with pytest.raises(SssgenError, match="webgpu: the device was lost twice"):
            evaluate(technique, write_inputs, gpu)
    assert evaluate(technique, write_inputs, gpu)["result"] == pytest.approx(np.exp([-1.0, -2.0]))


def test_a_device_that_does_nothing_is_noticed(
    backend: Callable[[str], Backend], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Imitates a device that another program blocks: what is submitted is not executed, and nothing is reported."""
    gpu: Any = backend("webgpu")
    technique, write_inputs = subject("beer_lambert"), {"d": [0.1, 0.2], "attenuation_distance": 0.1}
    assert evaluate(technique, write_inputs, gpu)["result"] == pytest.approx(np.exp([-1.0, -2.0]))
    kernel = "@group(0) @binding(0) var<storage, read_write> b: array<u32>; @compute @workgroup_size(1) fn main() {}"
    dispatch = Dispatch(Text(kernel), (1, 1, 1), (1, 1, 1), {"b": np.zeros(4, np.uint32)}, {"b": 0})
    with monkeypatch.context() as patch:
        patch.setattr(type(gpu.gpu.queue), "submit", lambda *_: None)
        with pytest.raises(SssgenError, match="webgpu: the device was lost twice"):
            evaluate(technique, write_inputs, gpu)
        with pytest.raises(SssgenError, match="webgpu: the device did not execute the shader"):
            by_webgpu(gpu, dispatch)
    assert evaluate(technique, write_inputs, gpu)["result"] == pytest.approx(np.exp([-1.0, -2.0]))
    assert by_webgpu(gpu, dispatch)["b"].tolist() == [0, 0, 0, 0]


def test_a_back_end_that_hangs_is_ended(backend: Callable[[str], Backend]) -> None:
    backend("gl")
    gpu = BackendProcess("gl")
    try:
        assert gpu.process.process is not None
        os.kill(gpu.process.process.pid, signal.SIGSTOP)
        gpu.process.seconds = 0.3
        with pytest.raises(SssgenError, match=r"did not finish within 0\.3 seconds"):
            evaluate(subject("lobe_gdc2011"), LOBE, gpu)
    finally:
        gpu.close()


def test_no_driver_on_this_machine(tmp_path: Path) -> None:
    """Without the libraries of EGL, the message names the packages."""
    fails = "lambda **_: (_ for _ in ()).throw(Exception('libEGL.so not loaded'))"
    before = f"import moderngl\nmoderngl.create_context = {fails}"
    text = f"{before}\nfrom sssgen.run import backends\ntry:\n    backends.get('gl')\n"
    text += "except backends.CompilerMissing as error:\n    print(error)"
    process = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert "libegl1" in process.stdout and "libEGL.so not loaded" in process.stdout


def test_half_float_textures_are_converted_once() -> None:
    from sssgen.run.evaluate.evaluation import half

    texture = Texture(np.full((2, 2, 3), 0.1))
    assert half(texture).levels[0].dtype == np.float16 and half(texture) is half(texture)
