"""User templates that leave the sandbox, or never end: refused with file and line, after bounded work."""

from __future__ import annotations

from pathlib import Path

import pytest

import sssgen
from amounts import COUNTED
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry
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
RECURSIVE = {
    "a macro in itself": "{% macro f(n) %}{{ f(n - 1) }}{% endmacro %}{{ f(1) }}",
    "a block in itself": "{% block a %}{{ self.a() }}{% endblock %}",
    "an include of itself": "{% include 'common/header.j2' %}",
    "an import of itself": "{% import 'common/header.j2' as h %}",
    "an extension of itself": "{% extends 'common/header.j2' %}",
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
HOSTILE = {**ESCAPES, **READS, **RECURSIVE, **WRONG}


@pytest.fixture(autouse=True, scope="module")
def _warm() -> None:
    sssgen.compile("jelly_cubes", "glsl-330")  # the time limit is for the template alone


def rendered(folder: Path, text: str) -> str:
    """A file with a header of this text."""
    (folder / "common").mkdir(exist_ok=True)
    (folder / "common" / "header.j2").write_bytes(text.encode("utf-8", "surrogateescape"))
    COUNTED["templates"] += 1
    with bounded(what="the template"), roomy(1024):
        return sssgen.compile("jelly_cubes", "glsl-330", templates=folder).files["jelly_cubes.glsl-330.frag"]


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_templates(name: str, tmp_path: Path) -> None:
    (tmp_path / "secret.j2").write_text("secret", encoding="utf-8")
    (tmp_path / "templates").mkdir()
    with pytest.raises(SssgenError) as raised:
        rendered(tmp_path / "templates", f"\n{HOSTILE[name]}")
    (result,) = raised.value.diagnostics
    assert result.span.line > 0
    in_header = result.span.file.endswith("common/header.j2") and result.span.line >= 2
    assert in_header or name in NO_LINE


def test_the_sandbox_renders_usual_templates(tmp_path: Path) -> None:
    """Loops, macros, filters, formats and lists work as they do outside of it."""
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


@pytest.mark.slow
def test_the_sandbox_changes_no_text(tmp_path: Path) -> None:
    for target in sssgen.all_targets():
        for material in ("ice", "resin_inlay"):
            for form in ("shader", "functions"):
                sandboxed = sssgen.compile(material, target, form, templates=tmp_path).files
                assert sandboxed == sssgen.compile(material, target, form).files


def test_a_template_cannot_change_the_target(tmp_path: Path) -> None:
    before = repr(registry.load("glsl-330"))
    rendered(tmp_path, "{% set _ = target.types.clear() %}{% set _ = target.inputs.update({'uv': 'x'}) %}")
    assert repr(registry.load("glsl-330")) == before


@pytest.mark.parametrize("mark", ["\x02999999\x03", "\x02abc\x03", "\x02", "\x03\x02", "\x020\x03", "\x02٣\x03"])
def test_templates_may_contain_line_marks(mark: str, tmp_path: Path) -> None:
    """A template may contain the characters that mark lines."""
    assert rendered(tmp_path, f"// x{mark}y\n").startswith("#version")
