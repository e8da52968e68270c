"""The documents as a site: the menu has every page, and the generated pages are whole."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest

import commands_page
import formula_math
import generated
import llms
import menu
import preset_pages
import python_page
import records
import sssgen
import technique_pages
import technique_pictures
from folders import ROOT
from sssgen.cli.commands import COMMANDS, command_parser
from sssgen.material import library, slots
from sssgen.material.library import Technique
from sssgen.presets.preset import presets
from sssgen.run.backends import Backend


def test_every_page_is_in_the_menu_once() -> None:
    found = menu.problems([*menu.documents(), *generated.names()])
    assert not found, "\n".join(found)


def test_a_page_that_the_menu_lacks_is_reported_with_what_to_do() -> None:
    pages = [*menu.documents(), *generated.names()]
    added, removed = menu.problems([*pages, "docs/new.md"]), menu.problems(pages[1:])
    assert added == ["docs/new.md is not in the menu: add its path to a section of docs/site/menu.toml"]
    assert removed == [f"{pages[0]} is in the menu, but there is no such page: remove it there"]


def test_the_generated_pages_are_those_of_the_menu() -> None:
    assert list(generated.pages()) == generated.names()


def test_every_command_and_option_is_in_the_reference() -> None:
    text = commands_page.page()
    for name in COMMANDS:
        assert f"\n### sssgen {name}\n" in text
        for option in command_parser(name)._option_string_actions:
            assert option in text or option == "--help", f"{name} {option}"


@pytest.mark.slow
def test_every_preset_has_a_page_and_the_search_knows_its_name() -> None:
    pages = preset_pages.pages()
    assert list(pages) == [f"docs/reference/presets/{name}.md" for name in presets()]
    assert "{index} ! wax\n" in pages["docs/reference/presets/wax.md"]
    assert "(../techniques/interior_octaves_refracted.md)" in pages["docs/reference/presets/wax.md"]
    assert all(f"(reference/presets/{name}.md)" in preset_pages.listed() for name in presets())


def test_llms_txt_lists_every_command_with_its_json_and_every_page(tmp_path: Path) -> None:
    texts = {page: (ROOT / page).read_text(encoding="utf-8") for page in menu.documents()} | generated.pages()
    llms.write_llms(tmp_path, texts)
    text = (tmp_path / "llms.txt").read_text(encoding="utf-8")
    assert text.startswith("# sssgen\n\n> Describe a translucent material once")
    for name, command in COMMANDS.items():
        assert f"- [`sssgen {name}`](docs/reference/commands.html): {command.help}. JSON: " in text
    for page in (page for section in menu.sections() for page in section.pages):
        assert f"]({menu.page_of(page)})" in text
    whole = (tmp_path / "llms-full.txt").read_text(encoding="utf-8")
    assert texts["docs/lint.md"].strip() in whole and "# Changelog" not in whole


def test_every_public_name_is_in_the_reference() -> None:
    text = python_page.page()
    for name in sssgen.__all__:
        assert name == "__version__" or f"\n## {name}\n" in text


@pytest.mark.parametrize("name", sorted(library.index()))
def test_the_page_of_a_technique(name: str) -> None:
    """It has the parameters, the formula, the source, the units, and the function as GLSL."""
    technique = library.load(name)
    text = technique_pages.page(technique)
    assert _letters(text.partition("\n## Formula\n")[2].partition("</div>\n</div>")[0]) >= _names(technique)
    assert "\n## Source\n" in text and "\n## Units\n" in text
    read, _ = slots.needs(technique.module, technique.function)
    assert all(f"\n| `{uniform.name}` | " in text for uniform in technique.uniforms if uniform.name in read)
    assert f" {name}(" in text.partition("\n## In GLSL\n")[2]


def _letters(page: str) -> set[str]:
    """The names, numbers and words of a typeset formula, which is well-formed."""
    formula = ElementTree.fromstring(page + "</div>\n</div>")
    assert formula.find(".//*") is not None
    return set(re.findall(r"\w+", " ".join(formula.itertext())))


def _names(technique: Technique) -> set[str]:
    """The words of the formula as it is written, but those that typesetting replaces by signs or lowers."""
    words = re.findall(r"[^\W\d_]\w*", re.sub(r"\b\w+(?=\()", "", technique.doc["formula"]))
    return {word for word in words if "_" not in word and word not in formula_math.GREEK and not word[-1].isdigit()}


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("2 reach", "<mn>2</mn>_<mi>reach</mi>"),
        ("w_i", "<msub><mi>w</mi><mi>i</mi></msub>"),
        ("t_i+1", '<msub><mi>t</mi><mrow><mi>i</mi><mo form="infix">+</mo><mn>1</mn></mrow></msub>'),
        ("sigma_t", "<msub><mi>σ</mi><mi>t</mi></msub>"),
        ("attenuation_distance", "<mi>attenuation_distance</mi>"),
        ("a b / 2", "<mfrac><mrow><mi>a</mi>_<mi>b</mi></mrow><mrow><mn>2</mn></mrow></mfrac>"),
        ("a / b / c", "<mfrac><mrow><mi>a</mi></mrow><mrow><mi>b</mi>_<mi>c</mi></mrow></mfrac>"),
        ("x^-1", "<msup><mrow><mi>x</mi></mrow><mrow><mo>−</mo><mn>1</mn></mrow></msup>"),
        ("a dot(n, l)", '<mi>a</mi>_<mrow>(<mrow><mi>n</mi><mo form="infix">·</mo><mi>l</mi></mrow>)</mrow>'),
        ("|(|x|, y)|", "<mrow>|<mrow>(<mrow>|<mi>x</mi>|</mrow><mo>,</mo><mi>y</mi>)</mrow>|</mrow>"),
        ("sqrt(.5)", "<msqrt><mn>0.5</mn></msqrt>"),
        ("uv'", "<msup><mrow><mi>uv</mi></mrow><mo>′</mo></msup>"),
        ("sum_k", "<munder><mo>∑</mo><mi>k</mi></munder>"),
    ],
)
def test_the_notation_of_formulas(formula: str, expected: str) -> None:
    text = formula_math.typeset(formula)
    text = re.sub(r'<mo fence="true"[^>]*>(.)</mo>', r"\1", text)
    text = re.sub(r"<mspace[^>]*></mspace>", "_", re.sub(r"</?math[^>]*>|<wbr/>", "", text))
    assert text == f'<div class="formula">\n<div>{expected}</div>\n</div>'


@pytest.mark.parametrize("formula", ["x over 2", "a = (b", "the light of x", "x ="])
def test_what_is_no_formula_is_refused_with_its_place(formula: str) -> None:
    with pytest.raises(formula_math.FormulaError, match="⟨here⟩"):
        formula_math.typeset(formula)


def test_each_clause_of_a_formula_is_a_line() -> None:
    text = formula_math.typeset('a = b, k = 1, 2, "until" a < b; c')
    lines = [re.sub("<[^>]*>", "", line) for line in text.splitlines()[1:-1]]
    assert lines == ["a=b", "k=1, 2", "until a&lt;b", "c"]


def test_the_errors_of_a_technique_are_those_of_the_chart() -> None:
    points = [point for point in records.points_of("march_view") if point["label"] == "march_view, 8 steps"]
    errors = [point["error"]["value"] for point in points]
    row = rf"\n\| view thickness \| march\\_view, 8 steps \| \S+ \| {max(errors):.3f} \| \d+ \| {len(points)} \|\n"
    assert points and re.search(row, technique_pages.page(library.load("march_view")))


PICTURED = ("beer_lambert", "voronoi_normal", "torus")
"""One on the cube of the chart, one on a ball, one as the body."""


@pytest.mark.slow
@pytest.mark.parametrize("name", PICTURED)
def test_the_picture_of_a_technique(name: str, backend: Callable[[str], Backend]) -> None:
    picture = technique_pictures.draw(library.load(name), backend("gl"))
    assert picture is not None and picture.caption
    rows, columns = picture.colors.shape[:2]
    corner, middle = picture.colors[:4, :4], picture.colors[rows // 4 : -rows // 4, columns // 4 : -columns // 4]
    assert corner.std(axis=(0, 1)).max() < 0.01  # the background
    assert middle.std() > 0.05 and middle.max() > 0.5  # the body


def test_a_technique_that_only_bakes_serve_has_no_picture(backend: Callable[[str], Backend]) -> None:
    assert technique_pictures.draw(library.load("distance_texture"), backend("gl")) is None
