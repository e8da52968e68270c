"""Cost and proofs above functions and stages, compared with what the passes say of the whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sssgen.analyse.lint.lint_findings import PROVEN, lint
from sssgen.editor.lenses import lenses_of
from sssgen.ir.intrinsics import KINDS
from sssgen.material.material_loading import examples
from sssgen.passes.cost import Cost
from sssgen.pipeline.compiler import compile

SAFE = "float half_of(float x)\n{\n    return 0.5 * clamp(x, 0.0, 1.0);\n}\n"
UNSAFE = "float share(float x, float y)\n{\n    return half_of(x) / y;\n}\n"
LOBE = (
    "/**\n * A lobe.\n * role: translucency\n */\nfloat own(world_direction N, world_direction V)\n"
    "{\n    return share(dot(N, V), 0.0);\n}\n"
)


def shown(opened: Any) -> dict[int, str]:
    return {lens.range.line: lens.text for lens in lenses_of(opened.document, opened.analysis)}


def test_each_function_has_its_cost_and_its_proofs(opened: Callable[..., Any]) -> None:
    lenses = shown(opened("plain.glsl", SAFE + UNSAFE))
    assert list(lenses) == [0, SAFE.count("\n")]
    first, second = lenses.values()
    assert first.endswith("proven safe: all 1")
    assert second.endswith("not proven safe: 1 of 2 (division by 0: 1)")  # y may be 0; the other one is that of half_of
    count = [int(text.split()[0]) for text in (first, second)]
    assert count[0] < count[1]


def test_a_technique_is_analysed_as_it_is_called(opened: Callable[..., Any]) -> None:
    divisor = LOBE.replace("0.0)", "4.0)")
    lenses = shown(opened("own.sss", SAFE + UNSAFE + divisor))
    assert len(lenses) == 3 and all("not proven" not in text for text in lenses.values())
    assert [text.split(" · ")[1] for text in lenses.values()] == [
        "proven safe: all 1",
        "proven safe: all 2",
        "proven safe: all 2",
    ]


def test_a_function_that_the_technique_does_not_call_has_a_lens(opened: Callable[..., Any]) -> None:
    lenses = shown(opened("own.sss", SAFE + UNSAFE + LOBE.replace("share(dot(N, V), 0.0)", "half_of(N.x)")))
    assert len(lenses) == 3
    assert lenses[SAFE.count("\n")].endswith("not proven safe: 1 of 2 (division by 0: 1)")


def test_a_document_with_errors_has_none(opened: Callable[..., Any]) -> None:
    assert shown(opened("own.sss", LOBE, right=SAFE + UNSAFE + LOBE)) == {}


@pytest.mark.parametrize("name", ["ice", "paper_lantern"])
def test_a_material_has_the_cost_of_its_chain_and_of_each_stage(opened: Callable[..., Any], name: str) -> None:
    text = Path(examples()[name]).read_text("utf-8").replace("\r\n", "\n")
    document = opened(f"{name}.toml", text)
    lenses = shown(document)
    lines = text.split("\n")
    head = next(number for number in lenses if lines[number] == "[material]")
    for entry in compile(name, "glsl-330").reflection["entries"].values():
        assert Cost(**entry["cost"]).text in lenses[head]
    findings = lint(name, with_examples=False, kinds=tuple(KINDS)).findings
    sites = {id(finding.site): finding.verdict for finding in findings}
    unproven = sum(verdict != PROVEN for verdict in sites.values())
    assert f"not proven safe: {unproven} of {len(sites)} (" in lenses[head]
    assert [number for number in lenses if number != head] == [
        number for number, line in enumerate(lines) if line.startswith("[") and number != head
    ]
    conversion = lines.index('technique = "transmittance_from_thinness"') if name == "paper_lantern" else 0
    assert not conversion or lenses[conversion - 1] == "no operation is left of it"


def test_comments_with_assumptions_count(opened: Callable[..., Any]) -> None:
    assumed = "uniform float width; // sssgen: assume 0.1 <= width <= 1\n"
    safe = opened("assumed.glsl", assumed + "float share(float x)\n{\n    return x / width;\n}\n")
    assert [text.split(" · ")[1] for text in shown(safe).values()] == ["proven safe: all 1"]
    wrong = opened("wrong.glsl", assumed.replace("0.1 <= ", "0.1 < < "))
    assert [problem.severity for problem in wrong.analysis.diagnostics] == ["error"]
