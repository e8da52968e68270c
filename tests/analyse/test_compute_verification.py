"""`sssgen transpile --verify` of compute shaders: agreement, differences, and what has no result to compare."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from folders import TESTS
from sssgen.analyse.verify import compute_verification
from sssgen.analyse.verify.compute_report import ComputeReport
from sssgen.analyse.verify.compute_verification import verify_compute
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Backend
from sssgen.support.diagnostics import SssgenError, failure

HEAD = "#version 430 core\nlayout(local_size_x = 32) in;\n"
BUFFERS = "layout(std430) readonly buffer In { uint a[]; };\nlayout(std430) buffer Out { uint b[]; };\n"
SHARED = "shared uint x[32];\n"
START = "    uint i = gl_GlobalInvocationID.x, lane = gl_LocalInvocationID.x;\n"


class InThisProcess:
    """A back end with the methods of one in a process of its own."""

    def __init__(self, backend: Backend) -> None:
        self.backend = backend

    def device(self) -> str:
        return self.backend.device()

    def apply(self, function: Callable[..., Any], *arguments: Any) -> Any:
        return function(self.backend, *arguments)


@pytest.fixture
def verify(backend: Callable[[str], Backend]) -> Callable[[str], ComputeReport]:
    machines: Any = {name: InThisProcess(backend(name)) for name in ("gl", "metal", "webgpu")}
    return lambda text: verify_compute(text, "x.comp", machines=machines)


def body(text: str, declared: str = "") -> str:
    return f"{HEAD}{BUFFERS}{declared}void main() {{\n{START}{text}}}\n"


@pytest.mark.parametrize("name", ["prefix_sum", "histogram", "blur"])
def test_translations_agree(name: str, verify: Callable[[str], ComputeReport]) -> None:
    report = verify((TESTS / "transpile" / f"{name}.comp").read_text("utf-8"))
    assert report.ok
    assert report.rounds == compute_verification.ROUNDS
    assert report.ordered == 0
    assert report.as_json()["devices"]["gl"].startswith("OpenGL ")
    assert {each.deviation for each in report.differences.values()} == {0.0}
    assert set(report.differences) == {"glsl", "wgsl", "metal"}


@pytest.mark.parametrize(
    ("text", "declared", "reason"),
    [
        ("b[i] = a[i + 40u];", "", "out of range"),
        ("b[i] = a[i] / (a[0] - a[0]);", "", "an operation is undefined"),
        ("x[lane] = a[i]; b[i] = x[31u - lane];", SHARED, "without a barrier after that"),
        ("b[i] = b[(i + 32u) % 96u] + 1u;", "", "without a barrier"),
        ("x[lane] = a[i]; if (lane < 9u) { return; } barrier(); b[i] = x[0];", SHARED, "at a barrier"),
        ("b[i] = x[lane];", SHARED, "before it is written"),
        ("b[i] = atomicAdd(total, 1u);", "shared uint total;\n", "before it is written"),
        ("uint v[4]; for (int k = 0; k < 4; k++) { v[k] = a[i]; } b[i] = v[i];", "", "out of range"),
        ("", "", "it writes no buffer"),
    ],
)
def test_undefined_programs_are_not_compared(
    text: str, declared: str, reason: str, verify: Callable[[str], ComputeReport]
) -> None:
    source = body(text, declared)
    report = verify(source if text else source.replace("buffer Out", "readonly buffer Out"))
    assert reason in report.reason
    assert not report.ok


def test_numbers_that_depend_on_the_order_are_not_compared(verify: Callable[[str], ComputeReport]) -> None:
    report = verify(body("b[i] = a[i];\n    if (i > 0u) {\n        b[atomicAdd(b[0], 0u) % 2u + 40u] = i;\n    }\n"))
    assert report.ordered > 0
    assert report.order_places
    assert all(place.startswith("out") for place in report.order_places), report.order_places
    everything = verify(body("b[lane * 0u] = i;").replace("b[];", "b[1];"))
    assert everything.reason == "all that it writes depends on the order of the invocations"


def test_a_version_that_the_driver_lacks_runs_as_450(verify: Callable[[str], ComputeReport]) -> None:
    report = verify(body("b[i] = a[i] * 3u;").replace("#version 430 core", "#version 460"))
    assert report.ok, list(report.lines())
    assert report.rounds == compute_verification.ROUNDS


def test_a_text_that_the_driver_refuses_has_no_rounds(verify: Callable[[str], ComputeReport]) -> None:
    text = body("b[atomicAdd(b[0], 0u) % 2u + 40u] = i;\n")
    report = verify(text.replace("#version 430 core", "#version 430 core\n#extension GL_NONE_such : require"))
    assert report.reason.startswith("the driver refuses it as written: ")
    assert (report.rounds, report.ordered) == (0, 0)
    assert not any("depend on the order" in line for line in report.lines())


def test_atomic_counters_are_not_verified(verify: Callable[[str], ComputeReport]) -> None:
    counter = "layout(binding = 0) uniform atomic_uint hits;\n"
    with pytest.raises(SssgenError, match="'hits' is an atomic counter: compute shaders with atomic counters are not"):
        verify(body("b[i] = atomicCounterIncrement(hits);", counter))
    assert verify(body("b[i] = a[i]; // no atomic_uint hits\n")).ok


def test_a_wrong_translation_is_found(verify: Callable[[str], ComputeReport], monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(module: Any, target: str, name: str, keep: bool) -> Any:
        result = transpile(module, target, name, keep=keep)
        if target != "wgsl":
            return result
        return result._replace(files={name: text.replace("* 3u", "* 4u") for name, text in result.files.items()})

    text = body("b[i] = a[i] * 3u;")
    assert verify(text).ok
    monkeypatch.setattr(compute_verification, "transpile", wrong)
    report = verify(text)
    assert not report.ok
    assert not report.differences["wgsl"].ok
    assert report.differences["glsl"].ok
    assert report.differences["metal"].ok
    assert "the author's text gives" in report.differences["wgsl"].at
    assert any("wgsl" in line and "author" in line for line in report.lines())
    assert report.as_json()["texts"]["wgsl"]["ok"] is False


@pytest.mark.parametrize("target", ["wgsl", "hlsl", "metal"])
def test_stores_of_components_leave_the_others_alone(target: str) -> None:
    """Other invocations may write the other components, and the whole vector is not read and written again."""
    buffers = "layout(std430) buffer V { vec4 v[]; };\n"
    text = HEAD + buffers + f"void main() {{\n{START}    v[i].zx = vec2(1.0, 2.0);\n    v[i][lane % 4u] = 3.0;\n}}\n"
    (emitted, *_) = transpile(load_glsl_text(text, "x.comp").module, target, "x", keep=True).files.values()
    assert not re.search(r"(?<!RWStructuredBuffer<)\b(?:float4|vec4f)\(", emitted), emitted


def test_stores_of_components_by_several_invocations(verify: Callable[[str], ComputeReport]) -> None:
    buffers = "layout(std430) buffer V { vec4 v[]; };\nshared mat2x3 m[16];\n"
    stores = "v[i / 4u][i % 4u] = float(i); m[lane / 2u][lane % 2u].zx = vec2(i, lane); barrier();"
    read = "v[i / 4u][i % 4u] = m[15u - lane / 2u][lane % 2u].z;"
    report = verify(f"{HEAD}{buffers}void main() {{\n{START}    {stores} {read}\n}}\n")
    assert report.ok, list(report.lines())


def test_uniform_blocks_have_values(verify: Callable[[str], ComputeReport]) -> None:
    block = "layout(std140) uniform Params { uint count; float gains[3]; vec3 add; } params;\n"
    report = verify(
        body("b[i] = i < params.count ? uint(abs(params.gains[i % 3u] + params.add.y) * 64.0) : 7u;", block)
    )
    assert report.ok, list(report.lines())


def test_a_program_without_an_end_has_a_reason(
    verify: Callable[[str], ComputeReport], monkeypatch: pytest.MonkeyPatch
) -> None:
    def hangs(*arguments: Any) -> Any:
        raise failure("the back end did not finish")

    monkeypatch.setattr(compute_verification, "run_kernel", hangs)
    report = verify(body("b[i] = a[i];"))
    assert not report.ok
    assert "did not finish" in report.reason
