"""The share of single changes that `--verify` finds, on a few functions; the whole run is a command."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from qualification.ir_mutations import mutated, mutations
from qualification.verify_mutants import Original, Result, main, originals, results

SOURCE = """
int f(int a, float x) {
    int s = a >> 2;
    if (x > 100.0) s += 3;
    for (int i = 0; i < 3; i++) s ^= clamp(a, -10, 10) << i;
    return s;
}
"""


@pytest.fixture(name="original", scope="module")
def _original(tmp_path_factory: pytest.TempPathFactory) -> Original:
    path: Path = tmp_path_factory.mktemp("mutants") / "f.glsl"
    path.write_text(SOURCE)
    (original,) = originals(path, 0)
    return original


@pytest.fixture(name="all_results", scope="module")
def _all_results(original: Original) -> list[Result]:
    return list(results(original, 1000, Random(0)))


def test_each_change_is_a_single_one(original: Original) -> None:
    every = mutations(original.function)
    assert len(every) > 40 and len({one.change for one in every}) > 20
    for one in every:
        assert mutated(original.function, one) is not original.function


def test_changes_of_the_result_are_found(all_results: list[Result]) -> None:
    differing = [one for one in all_results if one.differs]
    assert len(differing) > 40
    missed = [str(one) for one in differing if not one.detected]
    assert len(missed) <= 0.02 * len(differing), missed


def test_equivalent_changes_are_no_findings(all_results: list[Result]) -> None:
    equivalent = {one.mutation.change for one in all_results if not one.differs}
    assert "swapped operands of <" not in equivalent
    assert not equivalent or all(not one.detected for one in all_results if not one.differs)


def test_inputs_that_see_nothing_find_nothing(original: Original) -> None:
    blind = [
        ({name: value[..., :1] for name, value in values.items()}, textures) for values, textures in original.rounds
    ]
    seeing, original.rounds = original.rounds, blind
    expected, original.expected = original.expected, [original.results(original.program, *one) for one in blind]
    original.__dict__.pop("limits", None)
    try:
        shares = [one.detected for one in results(original, 1000, Random(0)) if one.differs]
        assert 0.0 < sum(shares) < 0.95 * len(shares)
    finally:
        original.rounds, original.expected = seeing, expected
        original.__dict__.pop("limits", None)


def test_operators_of_oblong_matrices_keep_their_types(tmp_path: Path) -> None:
    path = tmp_path / "oblong.glsl"
    path.write_text("vec2 f(mat3x2 a, mat2x3 b, vec2 v) { return (a * b) * v + (a * b + mat2(1.0)) * v; }\n")
    (original,) = originals(path, 0)
    changes = [one.change for one in mutations(original.function)]
    assert "+ → -" in changes and "* → +" not in changes
    assert len(list(results(original, 1000, Random(0)))) == len(changes)


def test_files_that_are_not_there_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([str(tmp_path / "none.glsl")])
    assert "usage:" in (printed := capsys.readouterr().err) and "none.glsl" in printed
