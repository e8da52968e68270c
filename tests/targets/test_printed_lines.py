"""Where printed lines are broken, and which sentences of a documentation are printed."""

from __future__ import annotations

import re

import pytest

import sssgen
from carried import carrying
from slow_cases import some_slow
from sssgen.ir.spans import NOWHERE
from sssgen.material.material_loading import examples
from sssgen.targets.printers.printed_lines import WIDTH, first_sentence, summary, wrap

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


def code_of(line: str, file: str) -> str:
    """A line without the comment behind its code."""
    return line.partition("#" if file.endswith(".py") else "//")[0].rstrip()


def open_types(code: str) -> int:
    """How many angle brackets of types a line leaves open; an operator has a space before it."""
    return len(re.findall(r"\w<(?=\w)", code)) - len(re.findall(r"(?<![-=\s])>", code))


@pytest.mark.parametrize(
    ("code", "count"),
    [
        ("const K: array<array<f32, 3>, 2> = array<array<f32, 3>,", 1),
        ("    2>(a, b);", -1),
        ("fn f(x: ptr<function, vec3f>) -> array<f32, 2> {", 0),
        ("    if (a < b && c > d) {", 0),
        ("Fn(([x]) => {", 0),
    ],
)
def test_open_types_are_counted(code: str, count: int) -> None:
    assert open_types(code) == count


def test_a_type_is_not_broken() -> None:
    text = f"    let {'x' * 60} = array<array<vec4<f32>, 3>, 2>(first(a, b), second(c));"
    lines = [line.text for line in wrap(text, NOWHERE)]
    assert len(lines) == 2
    assert [open_types(line) for line in lines] == [0, 0]


def test_the_rest_of_a_head_is_indented_twice() -> None:
    condition = " && ".join(f"{'x' * 40}{number}" for number in range(3))
    lines = [line.text for line in wrap(f"    if ({condition}) {{", NOWHERE)]
    assert [re.match(" *", line)[0] for line in lines] == [" " * 4, " " * 12]  # type: ignore[index]  # it matches
    assert "".join([lines[0].strip(), " ", lines[1].strip()]) == f"if ({condition}) {{"


@pytest.mark.parametrize("name", some_slow(examples(), "ice", "jade_ring"))
def test_long_lines_of_an_example_are_broken_outside_of_types(name: str) -> None:
    """The functions alone: a template may indent them, or have long lines of its own, such as the rows of a table."""
    count = 0
    for target in carrying(name):
        for file, text in sssgen.compile(name, target, "functions").files.items():
            if not file.endswith((".json", ".ts", ".mts")):
                lines = [line for line in text.splitlines() if not line.lstrip().startswith("{ name: ")]
                codes = [code_of(line, file) for line in lines]
                count += sum(len(code) > WIDTH / 2 for code in codes)
                assert [code for code in codes if len(code) > WIDTH] == [], file
                assert [code for code in codes if open_types(code) > 0] == [], file
    assert count


@pytest.mark.parametrize("name", some_slow(examples(), "ice", "jade_ring"))
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
