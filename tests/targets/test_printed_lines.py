"""Where printed lines are broken, and which sentences of a documentation are printed."""

from __future__ import annotations

import re

import pytest

import sssgen
from carried import carrying
from example_cases import marks
from sssgen.material.material_loading import examples
from sssgen.targets.printers.printed_lines import WIDTH, first_sentence, summary

LONG = "one two three " * 12 + "end."
SUMMARIES = {
    "": [],
    "A ball.": ["A ball."],
    "A ball": ["A ball"],
    "A ball. It is round.\nAnd red.": ["A ball. It is round."],
    "A ball, which is\nround. And red.\nrole: distance": ["A ball, which is round."],
    "A ball, which is\nround\nrole: distance": ["A ball, which is round"],
    "A ball\n\nwhich is round.": ["A ball"],
    "A ball of 1.5\nunits (e.g. a small\none). It is red.": ["A ball of 1.5 units (e.g. a small one)."],
    "A ball (round.)\nIt is red.": ["A ball (round.)"],
    "Is it\na ball? Yes.": ["Is it a ball?"],
    "A path \\\nto a ball\\": ["A path \\ to a ball"],
    LONG: [LONG[:107].rpartition(" ")[0], LONG[len(LONG[:107].rpartition(" ")[0]) + 1 :]],
}


@pytest.mark.parametrize("doc", SUMMARIES)
def test_the_summary_has_whole_sentences(doc: str) -> None:
    assert summary(doc) == SUMMARIES[doc]


def test_the_first_sentence() -> None:
    assert first_sentence("A colour, e.g. red. Or blue.") == "A colour, e.g. red"
    assert first_sentence("A colour of\n1.0. `x` is it.") == "A colour of 1.0"
    assert first_sentence("") == ""


@pytest.mark.parametrize("name", [pytest.param(name, marks=marks(name)) for name in examples()])
def test_no_comment_of_an_example_stops_inside_a_sentence(name: str) -> None:
    count = 0
    for target in {"glsl-330", "numpy"} & set(carrying(name)):
        for file, text in sssgen.compile(name, target).files.items():
            if not file.endswith(".json"):
                comments = re.findall(r"((?:^//.*\n)+)(?=[a-z]\w* \w+\()", text, re.MULTILINE)
                comments += re.findall(r'^    """([^"]*)"""$', text, re.MULTILINE)
                count += len(comments)
                assert [comment for comment in comments if not re.search(r"[.!?)]\n?$", comment)] == []
                assert all(len(line) <= WIDTH for comment in comments for line in comment.splitlines())
    assert count
