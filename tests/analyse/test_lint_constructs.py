"""Constructs that real files have: each is reported once, at its place, with its own operands."""

from __future__ import annotations

from pathlib import Path

import pytest

from sssgen.analyse.lint.lint_findings import Finding, lint

HEAD = (
    "#version 430\nin float t;\nin vec3 a;\nflat in int k;\nuniform vec3 u;\nuniform float grid[3][4];\nout vec4 o;\n"
)


def found(text: str, tmp_path: Path, head: str = HEAD) -> list[tuple[str, int, str]]:
    """Operation, line below the head and remedy of each finding; the text of each is whole."""
    path = tmp_path / "odd.frag"
    path.write_bytes((head + text).encode())
    findings = lint(str(path), False).unproven()
    for finding in findings:
        assert_readable(finding, path)
    start = head.count("\n")
    return [(each.site.operation, each.span.line - start, each.remedy.partition(" in place")[0]) for each in findings]


def assert_readable(finding: Finding, path: Path) -> None:
    """Its place is in the file, and no constant is its last reason."""
    lines = path.read_text().split("\n")
    assert 1 <= finding.span.column <= len(lines[finding.span.line - 1])
    assert finding.span.end_column - 1 <= len(lines[finding.span.end_line - 1])
    last = finding.render().split("\n")[-2]
    assert not last.endswith(("= 0 is in 0..0", "= 0.0 is in 0..0"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("void main() { float q[4]; q[k] = 1.0; o = vec4(q[0]); }", [("index", 1, "clamp(k, 0, 3)")]),
        ("void main() { o[k] = 1.0; o.xyz[1] = 2.0; }", [("index", 1, "clamp(k, 0, 3)")]),
        ("void main() { o = vec4(1.0 / grid[1][2]); }", [("/", 1, "max(abs(y), 1e-20) * (2.0 * step(0.0, y) - 1.0)")]),
        ("void main() { o = vec4(sqrt(grid[k & 1][2])); }", [("sqrt", 1, "max(x, 0.0)")]),
        ("void main() { o = vec4(7 / k); }", [("/", 1, "(k != 0 ? k : 1)")]),
        ("void main() { if (k > 0) o = vec4(7 % k, 7u / uint(k), 0, 0); }", []),
        ("void main() { o = vec4(7u % uint(k)); }", [("%", 1, "max(y, 1u)")]),
        (
            "void main() {\n float s;\n switch (k) {\n case 1: s = t;\n case 2: s = 1 / s; break;\n"
            " default: s = 2.0; }\n o = vec4(s);\n}",
            [("/", 5, "max(abs(s), 1e-20) * (2.0 * step(0.0, s) - 1.0)")],
        ),
        (
            "void main() {\n for (int i = 0; i < k; i++)\n  o += 1.0 / float(i);\n}",
            [("/", 3, "max(abs(y), 1.0) * (2.0 * step(0.0, y) - 1.0)")],
        ),
        (
            "#define DIV(n, d) \\\n  ((n) / \\\n   (d))\nvoid main() {\n o = vec4(DIV(1.0,\n  t));\n}",
            [("/", 5, "max(abs(t), 1e-20) * (2.0 * step(0.0, t) - 1.0)")],
        ),
        ("#define CUBE(x) ((x)*(x)*(x))\nvoid main() { o = vec4(sqrt(CUBE(t))); }", [("sqrt", 2, "max(x, 0.0)")]),
        (
            "#define F(n) float f_##n(float x) { return 1.0 / x; }\nF(one)\nvoid main() { o = vec4(f_one(t)); }",
            [("/", 2, "max(abs(x), 1e-20) * (2.0 * step(0.0, x) - 1.0)")],
        ),
        ("#line 900\nvoid main() {\n o = vec4(log(t));\n}", [("log", 3, "max(t, 1e-37)")]),
        ("// \u2603\nvoid main() { /* \U0001d4b3\u00df */ o = vec4(log(t)); }", [("log", 2, "max(t, 1e-37)")]),
        ("void main() {\r\n\to = vec4(\r\n\t\tlog(\r\n\t\t t));\r\n}\r\n", [("log", 3, "max(t, 1e-37)")]),
        ("void f(float x, out float r) { r = sqrt(x); }\nvoid main() { f(t, o.x); }", [("sqrt", 1, "max(x, 0.0)")]),
        (
            "void main() { float t = 1.0; { float t = a.x; o.x = log(t); } o.y = log(t); }",
            [("log", 1, "max(t, 1e-37)")],
        ),
    ],
)
def test_constructs(text: str, expected: list[tuple[str, int, str]], tmp_path: Path) -> None:
    assert found(text, tmp_path) == expected


@pytest.mark.parametrize("text", ["", "\n \t\n", "// nothing\n", "#define ONLY 1\n"])
def test_files_without_code(text: str, tmp_path: Path) -> None:
    assert found(text, tmp_path, "") == []


def test_a_variable_of_many_assignments(tmp_path: Path) -> None:
    """Its explanations look at the nearest ones, so that they do not take the square of the lines."""
    lines = "x = u.x / (x - t);\n" * 300
    findings = found(f"void main() {{\nfloat x = t;\n{lines}o = vec4(x);\n}}\n", tmp_path)
    assert [line for _, line, _ in findings] == list(range(3, 303))


def test_a_value_is_not_explained_by_itself(tmp_path: Path) -> None:
    path = tmp_path / "own.frag"
    path.write_text(f"{HEAD}void main() {{\n float s = t;\n s = 1.0 / s;\n o = vec4(s);\n}}\n")
    (finding,) = lint(str(path), False).unproven()
    assert [(step.what, step.name) for step in finding.why] == [("input", "t")]


@pytest.mark.parametrize(
    ("comment", "shown"),
    [
        ("/* sssgen: assume\n 0.5 <= t <= 1,\n nonzero a */", "0.5 <= t <= 1, nonzero a"),
        ("// sssgen: assume t > 0.5 // as the engine has it", "t > 0.5"),
        ("/* sssgen: assume t > 0.5 */ // and no more", "t > 0.5"),
    ],
)
def test_comments_with_assumptions(comment: str, shown: str, tmp_path: Path) -> None:
    """Over several lines, and with other words behind them."""
    path = tmp_path / "comments.frag"
    path.write_text(f"{HEAD}{comment}\nvoid main() {{ o = vec4(log(t)); }}\n")
    report = lint(str(path), False)
    assert report.unproven() == [] and [fact.text for fact in report.assumptions] == [shown]


def test_members_of_blocks_are_named_as_in_the_source(tmp_path: Path) -> None:
    block = "uniform B { float w; } b;\nvoid main() { o = vec4(log(b.w)); }"
    assert found(block, tmp_path) == [("log", 2, "max(b.w, 1e-37)")]
