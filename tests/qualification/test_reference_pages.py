"""The builtin functions that reference pages list, on a page of our own."""

from __future__ import annotations

from pathlib import Path

from qualification.suites.outcomes import RIGHT
from qualification.suites.reference_pages import cases, prototypes
from qualification.suites.text_cases import TextCase, run_case

PAGE = """<!DOCTYPE refentry [ <!ENTITY % mathent SYSTEM "math.ent"> %mathent; ]>
<refentry xmlns="http://docbook.org/ns/docbook"><para>&minus;1</para><funcsynopsis>{}</funcsynopsis></refentry>
"""


def prototype(head: str, *parameters: str) -> str:
    result, name = head.split()
    inner = "".join(f"<paramdef>{text}</paramdef>" for text in parameters)
    return f"<funcprototype><funcdef>{result} <function>{name}</function></funcdef>{inner}</funcprototype>"


def read(folder: Path, version: str, *page: str) -> list[TextCase]:
    (folder / version).mkdir(exist_ok=True)
    (folder / version / "page.xml").write_text(PAGE.format("".join(page)), "utf-8")
    return list(cases(folder))


def test_generic_types_stand_for_several_functions() -> None:
    page = PAGE.format(prototype("genType mix", "genType <parameter>x</parameter>", "genType y", "genBType a"))
    (own,) = prototypes(page)
    types = [[parameter.type for parameter in overload.parameters] for overload in own.overloads()]
    assert types == [["float", "float", "bool"]] + [[f"vec{size}"] * 2 + [f"bvec{size}"] for size in (2, 3, 4)]


def test_optional_parameters_and_functions_of_the_api() -> None:
    page = PAGE.format(
        prototype("gvec4 texture", "gsampler2D sampler", "vec2 P", "[float bias]")
        + prototype("void glClear", "GLbitfield mask")
        + prototype("void barrier", "void")
    )
    texture, barrier = prototypes(page)
    heads = [(overload.result, len(overload.parameters)) for overload in texture.overloads()]
    assert heads == [("vec4", 3), ("vec4", 2), ("ivec4", 3), ("ivec4", 2), ("uvec4", 3), ("uvec4", 2)]
    assert barrier.parameters == ()


def test_a_later_version_adds_functions(tmp_path: Path) -> None:
    sine = prototype("genType sin", "genType angle")
    read(tmp_path, "es3.0", sine)
    names = [case.name for case in read(tmp_path, "es3.1", sine, prototype("genIType bitCount", "genIType value"))]
    assert [name.split("/")[1] for name in names] == ["es3.0"] * 4 + ["es3.1"] * 4


def test_programs_are_translated(tmp_path: Path) -> None:
    page = (
        prototype("genType modf", "genType x", "out genType i"),
        prototype("vec4 textureOffset", "sampler2D sampler", "vec2 P", "ivec2 offset"),
        prototype("int atomicAdd", "inout int mem", "int data"),
        prototype("mat2x3 outerProduct", "vec3 c", "vec2 r"),
    )
    for case in read(tmp_path, "es3.1", *page):
        result = run_case(case)
        assert {outcome.outcome for outcome in result.outcomes.values()} == {RIGHT}, (case.text, result)


def test_an_error_of_the_page_is_skipped(tmp_path: Path) -> None:
    (case,) = read(tmp_path, "es3.1", prototype("vec2 unpackUnorm4x8", "uint p"))
    assert run_case(case).kind == "skipped"
