"""Programs whose results are known by construction, and rewrites that keep results; by hand: `metamorphic.py`."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import pytest

import metamorphic
import metamorphic_batches
from glsl_batches import TARGETS
from ir_rewrites import rewritten
from known_answers import SWITCHES
from metamorphic_bases import Base, base_from, mutated_case, rewritten_case, same_case
from metamorphic_batches import Job, Worker
from metamorphic_cases import KnownCase, MetamorphicRunner, known_case
from slow_cases import some_slow
from sssgen.ir.text import print_module
from sssgen.run.backends import Backend

FEW, MANY = 16, 640
"""Known answers in a test run, and in a long one."""
TEXT = """
const float STEP = 0.25;
struct Ray { vec3 at; vec3 along; };

float height(vec2 p) { return sin(p.x) * 0.5 + cos(p.y * STEP); }

bool hits(inout Ray ray, int steps, out int rounds) {
    rounds = 0;
    for (int i = 0; i < steps; i++) {
        rounds = i;
        if (ray.at.y < height(ray.at.xz)) { return true; }
        ray.at += ray.along * STEP;
    }
    return false;
}

vec4 marched(vec3 at, vec3 along, int steps) {
    Ray ray = Ray(at + vec3(0.0, 1.0, 0.0), along);
    int rounds;
    bool hit = hits(ray, steps & 7, rounds);
    mat2 turn = mat2(0.6, 0.8, -0.8, 0.6);
    vec2 turned = turn * ray.at.xz;
    return hit ? vec4(ray.at, float(rounds)) : vec4(turned, 0.0, -1.0);
}
"""


@pytest.fixture(scope="module")
def runners() -> Iterator[dict[str, MetamorphicRunner]]:
    """One runner per target; its back ends end with the tests."""
    runners = {target: MetamorphicRunner((target,)) for target in TARGETS}
    yield runners
    for runner in runners.values():
        runner.close()


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Base:
    folder = tmp_path_factory.mktemp("bases")
    path = folder / "marched.glsl"
    path.write_text(TEXT, encoding="utf-8")
    bases = [base_from(path, folder, Random(seed)) for seed in range(8)]
    return next(base for base in bases if base is not None and " marched(" in base.origin)


def failures(runner: MetamorphicRunner, cases: list[KnownCase]) -> list[str]:
    return [
        f"{metamorphic_batches.title(case, failure)}\n{failure.message}\n{case.text}"
        for case, failure in runner.failures(cases)
        if failure.kind != "tool"
    ]


@pytest.mark.parametrize("target", some_slow(TARGETS, "numpy", "hlsl"))
def test_known_answers(backend: Callable[[str], Backend], runners: dict[str, MetamorphicRunner], target: str) -> None:
    backend(target)
    messages = failures(runners[target], [known_case(Random(f"few {number}"), number) for number in range(FEW)])
    assert not messages, "\n\n".join(messages[:3])


@pytest.mark.slow
@pytest.mark.parametrize("target", TARGETS)
def test_many_known_answers(
    backend: Callable[[str], Backend], runners: dict[str, MetamorphicRunner], target: str
) -> None:
    backend(target)
    for start in range(0, MANY, metamorphic.BATCH):
        cases = [known_case(Random(f"many {start + number}"), number) for number in range(metamorphic.BATCH)]
        messages = failures(runners[target], cases)
        assert not messages, "\n\n".join(messages[:3])


@pytest.mark.parametrize("target", TARGETS)
def test_rewrites_keep_the_results(
    backend: Callable[[str], Backend], runners: dict[str, MetamorphicRunner], base: Base, target: str
) -> None:
    backend(target)
    random = Random(5)
    cases = [same_case(base, 0), *(rewritten_case(base, random, number) for number in range(1, 9))]
    messages = failures(runners[target], cases)
    assert not messages, "\n\n".join(messages[:3])


def test_mutations_have_the_results_of_the_interpreter(runners: dict[str, MetamorphicRunner], base: Base) -> None:
    cases = [mutated_case(base, Random(number), number) for number in range(8)]
    useful = [case for case in cases if case is not None]
    assert len(useful) > 3 and any(case.expected.tolist() != base.expected.tolist() for case in useful)
    assert not failures(runners["numpy"], useful)


def test_a_rewrite_changes_the_text(base: Base) -> None:
    texts = {print_module(rewritten(base.module, Random(seed))) for seed in range(10)}
    assert len(texts) == 10 and all(SWITCHES in text for text in texts)


def test_a_wrong_answer_is_found(runners: dict[str, MetamorphicRunner]) -> None:
    case = known_case(Random("few 3"), 3)
    case.text = case.text.replace("return v;", "return v + ivec4(0, 0, 1, 0);")
    ((_, failure),) = runners["numpy"].failures([case])
    assert failure.kind == "wrong"


def test_a_rewrite_that_changes_a_result_is_found(runners: dict[str, MetamorphicRunner], base: Base) -> None:
    case = rewritten_case(base, Random(5), 1)
    assert case.text.count("0.25") == 1
    case.text = case.text.replace("0.25", "0.26")
    ((_, failure),) = runners["numpy"].failures([case])
    assert failure.kind == "wrong"


def test_a_run_is_resumed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--targets", "numpy", "-o", str(tmp_path), "--seed", "3"]
    assert metamorphic.main(["--programs", "32", *arguments]) == 0
    assert metamorphic.main(["--programs", "64", *arguments]) == 0
    assert "64 programs (64 × known answer) × 1 targets (numpy): 0 faults" in capsys.readouterr().out
    lines = (tmp_path / "done_3.jsonl").read_text("utf-8").splitlines()
    assert sorted(json.loads(line)["number"] for line in lines) == [0, 1]


def test_a_run_ends_with_the_programs_not_with_the_batches(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "marched.glsl").write_text(TEXT, encoding="utf-8")
    arguments = ["--glsl", str(tmp_path), "--targets", "numpy", "-o", str(tmp_path), "--seed", "4", "--programs", "96"]
    assert metamorphic.main(arguments) == 0
    assert "rewrite" in capsys.readouterr().out
    counts = [sum(result.programs.values()) for result in metamorphic.results_in(tmp_path / "done_4.jsonl").values()]
    assert sum(counts) >= 96 and sum(counts[:-1]) < 96


@pytest.mark.slow
def test_a_batch_that_takes_too_long_is_reported_and_the_next_one_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = Job(3, 0, ("numpy",), (), str(tmp_path), 600.0)
    worker = Worker()
    try:
        assert worker.run(job).failures == [] and worker.runner is not None
        monkeypatch.setattr(worker.runner, "results", lambda *_: time.sleep(600.0))
        assert worker.run(job._replace(limit=2.0)).failures == ["numpy tool batch timeout"]
        assert len(list(tmp_path.glob("numpy_tool_known_answer_timeout*.glsl"))) == metamorphic_batches.BATCH
        assert worker.run(job).failures == []
    finally:
        if worker.runner is not None:
            worker.runner.close()


def test_a_fault_that_opengl_has_too_is_one_of_the_driver(
    runners: dict[str, MetamorphicRunner], monkeypatch: pytest.MonkeyPatch
) -> None:
    case = known_case(Random("few 3"), 3)
    runner = runners["numpy"]
    monkeypatch.setattr(runner, "targets", ("webgpu",))
    monkeypatch.setattr(runner, "results", lambda *_: [case.expected + 1])
    for reread, expected in ((True, ("tool", "as in OpenGL")), (False, ("wrong", ""))):
        monkeypatch.setattr(runner, "is_right_reread", lambda *_, right=reread: right)
        ((_, failure),) = runner.failures([case])
        assert (failure.kind, failure.cause) == expected


def test_what_depends_on_an_unwritten_variable_is_not_compared(tmp_path: Path) -> None:
    path = tmp_path / "unwritten.glsl"
    path.write_text("float f(float x) { float y; return x > 0.0 ? x : y; }", encoding="utf-8")
    bases = [base for seed in range(8) if (base := base_from(path, tmp_path, Random(seed))) is not None]
    assert bases and all((base.arguments[base.params[0].name] > 0.0).all() for base in bases)
