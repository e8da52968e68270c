"""A user's templates that would get out of the sandbox, or never end: refused, with file and line, soon."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

import sssgen
from amounts import COUNTED
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry, sandbox
from watchdog import bounded, roomy

ESCAPES = {
    "an attribute": "{{ ''.__class__ }}",
    "all classes": "{{ ''.__class__.__mro__[1].__subclasses__() }}",
    "a filter for attributes": "{{ ''|attr('__class__') }}",
    "an item": "{{ material['__class__'] }}",
    "a format": "{{ '{0.__class__}'.format(1) }}",
    "a format by a filter": "{{ (''|attr('for' ~ 'mat'))|attr('__self__') }}",
    "a format of items": "{{ '{0[__class__]}'.format(material) }}",
    "a format of a table": "{{ '{a.__class__}'.format_map({'a': 1}) }}",
    "a mapped attribute": "{{ [material]|map(attribute='__class__')|join }}",
    "globals": "{{ cycler.__init__.__globals__ }}",
    "the template": "{{ self._TemplateReference__context }}",
    "a macro": "{% macro f() %}{% endmacro %}{{ f.__call__.__func__ }}",
    "a method's code": "{{ material.items.__self__ }}",
}
READS = {
    "a file above": "{% include '../../x' %}",
    "a file of the system": "{% include '/etc/passwd' %}",
    "a file by import": "{% import '../secret.j2' as x %}",
    "a file by extension": "{% extends '../secret.j2' %}",
    "a file that is not there": "{% include 'nothing.j2' %}",
}
ENDLESS = {
    "a long range": "{% for i in range(10 ** 9) %}{% endfor %}",
    "loops in loops": "{% for a in range(99999) %}{% for b in range(99999) %}{% endfor %}{% endfor %}",
    "a loop that leaves out": "{% for a in range(9999) %}{% for b in range(9999) if false %}{% endfor %}{% endfor %}",
    "a loop in itself": "{% for a in range(9999) recursive %}{{ loop(range(9999)) }}{% endfor %}",
    "a loop of a text": "{% set s = 'a' * 99999 %}{% for a in s %}{% for b in s %}{% endfor %}{% endfor %}",
    "a macro in itself": "{% macro f(n) %}{{ f(n - 1) }}{% endmacro %}{{ f(1) }}",
    "a macro twice in itself": "{% macro f(n) %}{{ f(n - 1) ~ f(n - 1) if n }}{% endmacro %}{{ f(60) }}",
    "a block in itself": "{% block a %}{{ self.a() }}{% endblock %}",
    "an include of itself": "{% include 'common/header.j2' %}",
    "an import of itself": "{% import 'common/header.j2' as h %}",
    "an extension of itself": "{% extends 'common/header.j2' %}",
    "comparisons": "{% set s = 'a' * 300000 %}{% for i in range(99999) %}{% if s ~ i == s %}{% endif %}{% endfor %}",
    "searches": "{% set s = 'a' * 300000 %}{% for i in range(99999) %}{{ 'b' in s }}{% endfor %}",
    "copies": "{% set s = 'a' * 300000 %}{% for i in range(99999) %}{% if s[1:] %}{% endif %}{% endfor %}",
    "a large text": "{% for i in range(99999) %}" + "y" * 9999 + "{% endfor %}",
}
DOUBLED = "{% set n = namespace(s=START) %}{% for i in range(99) %}{% set n.s = TWICE %}{% endfor %}"
LARGE = {
    "a product": "{{ 'x' * 10 ** 9 }}",
    "a product of products": "{{ ('x' * 10 ** 5) * 10 ** 5 }}",
    "a list": "{{ [0] * 10 ** 9 }}",
    "a power": "{{ (10 ** 300) ** 10 ** 8 }}",
    "squares": "{% set n = namespace(n=3) %}{% for i in range(99) %}{% set n.n = n.n * n.n %}{% endfor %}{{ n.n }}",
    "a text that doubles": DOUBLED.replace("START", "'x'").replace("TWICE", "n.s ~ n.s"),
    "a list that doubles": DOUBLED.replace("START", "[1]").replace("TWICE", "[n.s, n.s]"),
    "a padded text": "{{ 'x'.ljust(10 ** 9) }}",
    "a padded text by a filter": "{{ 'x'|center(10 ** 9) }}",
    "a width": "{{ '%999999999d' % 1 }}",
    "a width of a format": "{{ '{:999999999}'.format(1) }}",
    "a width that is given": "{{ '%*d'|format(10 ** 9, 1) }}",
    "a replacement": "{% set s = 'a' * 99999 %}{{ s.replace('a', s) }}",
    "a replacement by a filter": "{% set s = 'a' * 99999 %}{{ s|replace('a', s) }}",
    "joined": "{% set s = 'a' * 99999 %}{{ s.join(s) }}",
    "joined by a filter": "{% set s = 'a' * 99999 %}{{ s|join(s) }}",
    "tabs": "{{ '\\t'.expandtabs(10 ** 9) }}",
    "a batch": "{{ [1]|batch(10 ** 9, 'x')|list }}",
    "slices": "{{ [1]|slice(10 ** 9)|list }}",
    "indented": "{{ 'a\\nb'|indent(10 ** 9) }}",
    "JSON": "{{ [1]|tojson(indent=10 ** 9) }}",
    "wrapped": "{% set s = 'a ' * 99999 %}{{ s|wordwrap(1, wrapstring=s) }}",
    "any amount of words": "{{ lipsum(n=10 ** 6) }}",
}
WRONG = {
    "an unknown name": "{{ zork }}",
    "an unknown attribute": "{{ material.zork }}",
    "a division by 0": "{{ 1 / 0 }}",
    "a mixture": "{{ 1 + 'a' }}",
    "no function": "{{ 1() }}",
    "an index": "{{ [][1] }}",
    "an assignment to what is not its own": "{% set material.name = 'x' %}",
    "a statement that is not ended": "{% for a in [1] %}",
    "an expression that is not ended": "{{",
    "an unknown statement": "{% debug %}",
    "deep brackets": "{{ " + "(" * 10_000 + "1" + ")" * 10_000 + " }}",
    "deep blocks": "{% if 1 %}" * 5000 + "{% endif %}" * 5000,
    "digits": "{{ " + "9" * 5000 + " }}",
    "no UTF-8": "\udcff",
}
NO_LINE = ("deep brackets", "deep blocks", "digits", "no UTF-8", "an assignment to what is not its own")
"""Jinja tells no line of these: the place is that of the include, or the file's first line."""
HOSTILE = {**ESCAPES, **READS, **ENDLESS, **LARGE, **WRONG}


@pytest.fixture(autouse=True, scope="module")
def _warm() -> None:
    sssgen.compile("jelly_cubes", "glsl-330")  # what is measured is the template alone


def rendered(folder: Path, text: str) -> str:
    """A file with a header of this text."""
    (folder / "common").mkdir(exist_ok=True)
    (folder / "common" / "header.j2").write_bytes(text.encode("utf-8", "surrogateescape"))
    COUNTED["templates"] += 1
    with bounded(20, "the template"), roomy(1024):
        return sssgen.compile("jelly_cubes", "glsl-330", templates=folder).files["jelly_cubes.glsl-330.frag"]


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_templates(name: str, tmp_path: Path) -> None:
    (tmp_path / "secret.j2").write_text("secret", encoding="utf-8")
    (tmp_path / "templates").mkdir()
    start = time.process_time()
    with pytest.raises(SssgenError) as raised:
        rendered(tmp_path / "templates", f"\n{HOSTILE[name]}")
    assert time.process_time() - start < 10.0
    (found,) = raised.value.diagnostics
    assert found.span.line > 0
    in_header = found.span.file.endswith("common/header.j2") and found.span.line >= 2
    assert in_header or name in NO_LINE


def test_the_same_template_is_refused_wherever_it_is(tmp_path: Path) -> None:
    """The bound is of work, not of time: just below it a template is rendered, each time."""
    rounds = sandbox.MAX_WORK // sandbox.STEP
    text = "{% for i in range(1000) %}{% for j in range(N) %}{% endfor %}{% endfor %}"
    for _ in range(2):
        rendered(tmp_path, text.replace("N", str(rounds // 1500)))
        with pytest.raises(SssgenError, match="does too much"):
            rendered(tmp_path, text.replace("N", str(rounds // 900)))


def test_what_templates_do_goes_on(tmp_path: Path) -> None:
    """Loops, macros, filters, formats and lists of a usual size are what they are without the bound."""
    text = """\
{% macro twice(x) %}{{ x }}{{ x }}{% endmacro %}
{% set found = [] %}{% for u in uniforms %}{% set _ = found.append(u.name) %}{% endfor %}
// {{ found|join(', ') == uniforms|map(attribute='name')|join(', ') }} {{ twice('ab') }} {{ '%03d' % 7 }} {{ 2 ** 10 }}
// {{ 'x'.ljust(3) }}| {{ '{:>4}'.format(5) }}{% for i in [3, 4] %} {{ loop.index }}/{{ loop.length }}{% endfor %} .
// {{ code.functions.replace('float', 'half')|length > 100 }} {{ 'abc'[1:] }} {{ 'b' in 'abc' }} {{ 3 is odd }}
"""
    lines = [line.strip() for line in rendered(tmp_path, text).split("\n") if line.startswith("//")]
    assert lines[0] == "// True abab 007 1024"
    assert lines[1] == "// x  |    5 1/2 2/2 ."
    assert lines[2] == "// True bc True True"


def test_our_templates_cost_little(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All examples, for all targets, with a twentieth of the bound."""
    monkeypatch.setattr(sandbox, "MAX_WORK", sandbox.MAX_WORK // 20)
    for target in sssgen.all_targets():
        for material in ("ice", "resin_inlay"):
            for form in ("shader", "functions"):
                bounded_files = sssgen.compile(material, target, form, templates=tmp_path).files
                assert bounded_files == sssgen.compile(material, target, form).files


def test_what_a_template_does_to_the_target_is_its_own(tmp_path: Path) -> None:
    before = repr(registry.load("glsl-330"))
    rendered(tmp_path, "{% set _ = target.types.clear() %}{% set _ = target.update({'version': 'x'}) %}")
    assert repr(registry.load("glsl-330")) == before


@pytest.mark.parametrize("mark", ["\x02999999\x03", "\x02abc\x03", "\x02", "\x03\x02", "\x020\x03", "\x02٣\x03"])
def test_marks_that_are_not_ours(mark: str, tmp_path: Path) -> None:
    """A template may hold the characters by which lines are known."""
    assert rendered(tmp_path, f"// x{mark}y\n").startswith("#version")
