"""Half precision in WebGPU: the printer, the results of all builtins and techniques, `sssgen eval --precision f16`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from folders import EXAMPLES
from half_cases import half_cases, wrong_lanes
from qualification.parity import run as run_cases
from qualification.parity import supported
from sssgen.cli import main as cli
from sssgen.ir.types import FLOAT, INT, Type
from sssgen.lang.loader import load_text
from sssgen.material import library
from sssgen.pipeline.compiler import transpile
from sssgen.run import backends
from sssgen.run.backends import Array, Backend, Call, CompilerMissing, Text
from sssgen.run.backends.call_program import drawing
from sssgen.run.backends.webgpu import WebGPU
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.run.evaluate.evaluation import fit_inputs, run
from sssgen.run.evaluate.probes import Subject, subject
from sssgen.run.evaluate.random_inputs import samples
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry
from sssgen.targets.printers.wgsl_half import half_text

TARGET = "wgsl-f16"
ULP = 2.0**-10
"""The distance from 1 to the next half."""

SIMPLE = {
    "beer_lambert": 2, "box": 2, "constant_thickness": 1, "gltf_diffuse_transmission": 2, "gltf_volume": 2, "srgb": 2,
    "sphere": 4, "thickness_from_thinness": 1, "thickness_from_transmittance": 4, "thinness_from_thickness": 1,
    "transmittance_from_thinness": 1, "wrap_lighting": 2, "lobe_henyey_greenstein": 4, "lobe_gdc2011": 32,
    "lobe_exp2": 32, "lobe_normalized": 32,
}  # fmt: skip
"""Technique → the largest difference between NumPy and the shader, in ulp of half. The power of a lobe, up to 32,
multiplies the difference of its base."""

Get = Callable[[str], Backend]


def text_of(source: str) -> str:
    """The WGSL of functions in half precision."""
    files = transpile(load_text(source, "half"), TARGET, "half").files
    return next(text for name, text in files.items() if not name.endswith(".json"))


def call(gpu: Backend, source: str, result: Type, *args: Array) -> Array:
    """The results of the function `float f(…)` of a source for arrays of floats and ints."""
    params = tuple(FLOAT if arg.dtype.kind == "f" else INT for arg in args)
    return gpu.run(Text(text_of(source)), [Call("f", params, result, args)])[0]


# The printer


def test_half_precision_is_an_internal_target() -> None:
    target = registry.load(TARGET)
    assert target.half_of == "wgsl" and set(target.files) == {"functions"}
    assert TARGET not in registry.names()


def test_every_half_is_read_back_from_its_text() -> None:
    bits = np.arange(0x7C00, dtype=np.uint16)
    texts = [half_text(float(value)) for value in bits.view(np.float16)]
    assert (
        np.array([text.removesuffix("h") for text in texts], np.float64).astype(np.float16).view(np.uint16) == bits
    ).all()
    assert max(sum(char.isdigit() for char in text.partition("e")[0].strip("0.h")) for text in texts) <= 5
    assert [half_text(value) for value in (0.1, -0.0, 2.0, 65504.0, 2.0**-24)] == [
        "0.1h", "-0.0h", "2.0h", "65500.0h", "6.0e-8h",
    ]  # fmt: skip


def test_builtins_that_exist_only_in_float32_are_converted() -> None:
    text = text_of(
        "vec2 f(sampler2D map, vec2 uv, uint bits) {\n"
        "    return dFdx(uv) + texture(map, uv * 0.1).xy + unpackUnorm2x16(bits);\n}\n"
    )
    assert text.startswith("enable f16;\n")
    for part in (
        "uv: vec2h, bits: u32", "vec2h(dpdx(vec2f(uv)))", "vec2h(unpack2x16unorm(bits))",
        "vec4h(textureSample(map, map_sampler, vec2f(uv * 0.1h)))",
    ):  # fmt: skip
        assert part in text


def test_a_literal_beyond_the_halves_is_an_error_at_its_place() -> None:
    assert "65500.0h" in text_of("float f(float x) { return x + 65519.0; }")
    with pytest.raises(SssgenError) as caught:
        text_of("float f(float x) {\n    return x * 65520.0;\n}\n")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.message == "65520 is beyond the largest half, 65504" and diagnostic.span[1:3] == (2, 16)


def test_whole_shaders_are_refused(capsys: pytest.CaptureFixture[str], backend: Get, tmp_path: Path) -> None:
    backend("webgpu-f16")
    scene = EXAMPLES / "paper_lantern" / "scene.toml"
    assert cli.main(["render", str(scene), "-b", "webgpu-f16", "-o", str(tmp_path / "no.png")]) == 2
    assert "evaluates functions and draws no scenes" in capsys.readouterr().err


# Results on the back end


@pytest.mark.parametrize("name", ["numpy-f16", "webgpu-f16"])
def test_every_builtin(name: str, backend: Get) -> None:
    gpu = backend(name)
    table = [case for case in half_cases() if supported(case, gpu)]
    assert len(table) > 250
    failures = [
        message
        for case, actual in zip(table, run_cases(gpu, table), strict=True)
        if (message := wrong_lanes(case, actual))
    ]
    assert not failures, "\n".join(failures)


@pytest.mark.parametrize(("target", "dtype"), [(TARGET, np.float16), ("wgsl", np.float32)])
def test_arguments_are_rounded_before_they_are_sent(target: str, dtype: type) -> None:
    """In WGSL a conversion may round up or down, so the arguments must be halves already."""
    inputs = np.array([0.1, 2049.5, 1e6, -1.0 / 3.0])
    program, _ = drawing(registry.load(target), Text(""), [Call("f", (FLOAT,), FLOAT, (inputs,))], {})
    sent = program.textures["sssgen_data"].data
    assert isinstance(sent, np.ndarray)
    with np.errstate(over="ignore"):
        assert sent[..., 0].view(np.float32).ravel()[:4].tolist() == inputs.astype(dtype).tolist()


def test_every_operation_rounds_to_half(backend: Get) -> None:
    """A sum of products that no compiler can combine equals NumPy's, so it is not only rounded at its end."""
    rng = np.random.default_rng(0)
    args = [rng.uniform(-8.0, 8.0, 2000).astype(np.float16).astype(np.float64) for _ in range(3)]
    x, y, z = (arg.astype(np.float16) for arg in args)
    source = "float f(float x, float y, float z) {{ float s = x; {} return s; }}".format("s = s * (y * 0.1) + z; " * 20)
    rounded, once = x, args[0]
    for _ in range(20):
        rounded = rounded * (y * np.float16(0.1)) + z
        once = once * (args[1] * 0.1) + args[2]
    result = call(backend("webgpu-f16"), source, FLOAT, *args)
    assert (result == rounded).mean() > 0.9 > 0.8 > (result == once.astype(np.float16)).mean()


def test_literals_are_exact(backend: Get) -> None:
    gpu = backend("webgpu-f16")
    values = np.random.default_rng(1).integers(0x400, 0x7C00, 200).astype(np.uint16).view(np.float16)
    listed = ", ".join(repr(float(value)) for value in values)
    source = f"float f(int i) {{ float all[200] = float[200]({listed}); return all[i]; }}"
    assert (call(gpu, source, FLOAT, np.arange(200)) == values).all()


def test_infinity_and_nan_are_returned(backend: Get) -> None:
    gpu = backend("webgpu-f16")
    inputs = np.array([np.inf, -np.inf, np.nan, 65504.0, 1e6])
    np.testing.assert_array_equal(
        call(gpu, "float f(float x) { return x; }", FLOAT, inputs), [np.inf, -np.inf, np.nan, 65504.0, np.inf]
    )
    product = call(
        gpu, "float f(float x, float y) { return x * y; }", FLOAT, np.full(2, 300.0), np.array([300.0, -300])
    )
    assert product.tolist() == [np.inf, -np.inf]


def technique(name: str, lanes: int) -> tuple[Subject, dict[str, object]]:
    chosen = subject(name)
    return chosen, samples(chosen, lanes, 3)


@pytest.mark.parametrize("step", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_every_technique_compiles_and_runs(step: int, backend: Get, compiler: Callable[[str], Compiler]) -> None:
    gpu, readers = backend("webgpu-f16"), [compiler("naga"), compiler("tint")]
    failures = []
    for name in sorted(library.index())[::step]:
        chosen, inputs = technique(name, 20)
        try:
            compiled = transpile(chosen.module, TARGET, name).files
            text = next(text for file, text in compiled.items() if not file.endswith(".json"))
            messages = [(reader.name, errors(reader.check(Source(text, "wgsl", "library")))) for reader in readers]
            failures += [f"{name}: {reader}: {result}" for reader, result in messages if result]
            outputs = run(chosen, fit_inputs(chosen, inputs), gpu)
            failures += [f"{name}: {key}" for key, value in outputs.items() if len(value) != 20]
        except SssgenError as error:
            failures.append(f"{name}: {error}")
    assert not failures, "\n".join(failures)


@pytest.mark.parametrize("name", SIMPLE)
def test_a_simple_technique_equals_numpy(name: str, backend: Get) -> None:
    gpu = backend("webgpu-f16")
    chosen, sampled = technique(name, 1000)
    fit = fit_inputs(chosen, sampled)
    expected = run(chosen, fit, backends.get("numpy-f16"))
    for key, actual in run(chosen, fit, gpu).items():
        right = expected[key].astype(np.float64)
        assert np.isfinite(right).all() and np.isfinite(actual).all()
        assert (np.abs(actual - right) / np.maximum(np.abs(right), 1.0)).max() <= SIMPLE[name] * ULP, key


# sssgen eval --precision f16


@pytest.mark.slow
def test_eval_in_half(capsys: pytest.CaptureFixture[str], backend: Get) -> None:
    backend("webgpu-f16")
    arguments = ["eval", "wrap_lighting", "--samples", "50", "--precision", "f16", "--json", "--backend"]
    assert cli.main([*arguments, "webgpu"]) == 0
    assert json.loads(capsys.readouterr().out)["backend"] == "webgpu-f16"
    for named in ("numpy,webgpu", "all", "webgpu-f16,numpy,webgpu"):
        assert cli.main([*arguments, named]) == 0
        rows = json.loads(capsys.readouterr().out)["backends"]
        assert {row["name"] for row in rows} == {"numpy-f16", "webgpu-f16"} and len(rows) == 2
        assert all(1e-5 < row["deviation"] < 1e-2 for row in rows)


@pytest.mark.parametrize(("named", "precision"), [("gl", "f16"), ("numpy,browser", "f16"), ("webgpu-f16", "f32")])
def test_eval_refuses(named: str, precision: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["eval", "box", "--samples", "5", "--backend", named, "--precision", precision]) == 2
    output = capsys.readouterr().err
    if precision == "f16":
        assert f"{named.split(',')[-1]} does not compute in half precision" in output
        assert "--backend numpy or webgpu" in output
    else:
        assert "webgpu-f16 computes in its own precision, not in f32" in output


def test_an_adapter_without_halves_is_reported(backend: Get, monkeypatch: pytest.MonkeyPatch) -> None:
    backend("webgpu")

    class AdapterWithoutHalves:
        def __init__(self, gpu: object) -> None:
            self.features: set[str] = set()
            self.limits = gpu.limits  # type: ignore[attr-defined]  # an adapter; wgpu is not imported here

    gpu = backends.get("webgpu")
    assert isinstance(gpu, WebGPU)
    monkeypatch.setattr(gpu.naga, "gpu", AdapterWithoutHalves(gpu.gpu))
    with pytest.raises(CompilerMissing, match=r"shader-f16, which naga in wgpu .* lacks"):
        WebGPU("webgpu-f16", TARGET)
