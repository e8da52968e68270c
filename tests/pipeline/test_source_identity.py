"""A source file is one file however its path is spelled: emitted bytes do not depend on the working folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

import sssgen
from carried import carrying
from example_cases import marks
from folders import EXAMPLES
from slow_cases import some_slow
from sssgen.material.library import TECHNIQUES
from sssgen.material.material_loading import examples
from sssgen.support.diagnostics import SssgenError

TARGETS = ("glsl-330", "wgsl")
NAMES = [pytest.param(name, marks=marks(name)) for name in examples()]

_FUNCTION = re.compile(
    r"^[ \t]*(?:fn |[A-Za-z_][\w<>, ]*? )(?P<name>\w+)\((?P<params>[^;{}]*?)\)[^;{}()]*\n?[ \t]*\{", re.MULTILINE
)
_TSL = re.compile(r"^export const (?P<name>\w+) = /\*@__PURE__\*/ Fn\(\(\[(?P<params>.*?)\]\) => \{", re.MULTILINE)
_PYTHON = re.compile(r"^def (\w+)\((.*?)\)(?: ->.*)?:\n((?:    .*\n|\n)+)", re.MULTILINE)
_TYPES = re.compile(r"\)\.setLayout\(\{ name: '\w+'(.*?)\);")
_OVERLOAD = re.compile(r"_(?:vec\d|float|mat\d)$")
_COMMENT = re.compile(r'"""(?:.|\n)*?"""|//.*|#.*')


def emit(output: Path, folder: Path, paths: list[str], targets: str) -> dict[str, bytes]:
    """The bytes of all files that `sssgen emit` writes in a working folder, without the cache."""
    command = [sys.executable, "-m", "sssgen", "emit", *paths, "--target", targets, "-o", str(output)]
    environment = os.environ | {"SSSGEN_CACHE": ""}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True, timeout=600)
    return {path.relative_to(output).as_posix(): path.read_bytes() for path in output.rglob("*") if path.is_file()}


def emitted_from_folders(tmp_path: Path, name: str, targets: str) -> list[dict[str, bytes]]:
    """The files of one example: from its folder, the folder above, one elsewhere, through a link, and by its name."""
    path = Path(examples()[name])
    (tmp_path / "link").symlink_to(path.parent, target_is_directory=True)
    ways = [
        (path.parent, path.name),
        (path.parents[1], f"{path.parent.name}/{path.name}"),
        (tmp_path, str(path)),
        (tmp_path, f"link/{path.name}"),
        (path.parents[2], name),
    ]
    return [emit(tmp_path / str(index), folder, [text], targets) for index, (folder, text) in enumerate(ways)]


@pytest.mark.parametrize("name", some_slow(["candle", "jelly"], "jelly"))
def test_the_folder_does_not_change_a_byte(tmp_path: Path, name: str) -> None:
    first, *others = emitted_from_folders(tmp_path, name, ",".join(TARGETS))
    assert len(first) > len(TARGETS)
    assert all(other == first for other in others)


@pytest.mark.slow
def test_the_folder_does_not_change_a_byte_of_any_example(tmp_path: Path) -> None:
    targets = ",".join(TARGETS)  # both can express every example
    paths = [Path(path) for path in examples().values()]
    top = emit(tmp_path / "top", EXAMPLES, [path.relative_to(EXAMPLES).as_posix() for path in paths], targets)
    inside = [Path(os.path.relpath(path, EXAMPLES / "jelly")).as_posix() for path in paths]
    assert emit(tmp_path / "inside", EXAMPLES / "jelly", inside, targets) == top
    assert emit(tmp_path / "absolute", tmp_path, [str(path) for path in paths], targets) == top
    assert len(paths) > 10 and not any(os.fsencode(EXAMPLES) in data for data in top.values())


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_folder_does_not_change_a_byte_for_any_target(tmp_path: Path, name: str) -> None:
    first, *others = emitted_from_folders(tmp_path, name, ",".join(carrying(name)))
    assert all(other == first for other in others)


def bodies(text: str) -> Iterator[tuple[str, str]]:
    """The name of each function of an emitted text, and what its parameters and body are, without comments."""
    for match in (*_FUNCTION.finditer(text), *_TSL.finditer(text)):
        end, depth = match.end(), 1
        while depth:
            depth += (text[end] == "{") - (text[end] == "}")
            end += 1
        types = _TYPES.match(text, end)  # of TSL they follow the body
        yield match["name"], f"{match['params']} {text[match.end() : end]} {types[1] if types else ''}"
    for name, params, body in _PYTHON.findall(text):
        overload = _OVERLOAD.search(name)  # the parameters have no types there
        yield name, f"{overload[0] if overload else ''} {params} {body}"


def copies(name: str, target: str, form: str) -> list[list[str]]:
    """The functions of equal bodies in the files of an example."""
    found, count = [], 0
    for file, text in sssgen.compile(name, target, form).files.items():
        if file.endswith(".json") or file.startswith("sssgen-"):  # a runtime, with braces in its strings
            continue
        for program in text.split("ENDHLSL"):  # each pass of Unity is a program of its own
            groups = defaultdict(list)
            for function, body in bodies(program):
                groups[" ".join(_COMMENT.sub("", body).split())].append(function)
                count += 1
            found += [group for group in groups.values() if len(group) > 1]
    assert count
    return found


@pytest.mark.parametrize("name", NAMES)
def test_no_function_is_a_copy_of_another(name: str) -> None:
    for target in TARGETS:
        assert copies(name, target, "shader") == [], target


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_no_function_is_a_copy_of_another_in_any_target(name: str) -> None:
    for target in carrying(name):
        for form in ("shader", "functions"):
            assert copies(name, target, form) == [], (target, form)


# Two files

STAGE = """
#include "{included}"
/**
 * A stage.
 * role: surface
 * formula: albedo' = f(albedo)
 * source: None.
 * units: None.
 * limits: None.
 */
void {name}(inout vec3 albedo) {{ albedo = vec3(f(albedo.x)); }}
"""
MATERIAL = """
[material]
name = "two"
[[surface]]
technique = "base_color"
[[surface]]
technique = "a/one.sss"
[[surface]]
technique = "b/two.sss"
"""


def two_stages(folder: Path, first: str, second: str, *included: str) -> str:
    """The text of a material with two techniques in two folders with a file f.sss each ('' for none).

    Each technique includes its own, or the file that `included` names.
    """
    names = included or ("f.sss", "f.sss")
    for place, stage, text, name in (("a", "one", first, names[0]), ("b", "two", second, names[-1])):
        (folder / place).mkdir(exist_ok=True)
        (folder / place / f"{stage}.sss").write_text(STAGE.format(name=stage, included=name))
        if text:
            (folder / place / "f.sss").write_text(text)
    (folder / "two.toml").write_text(MATERIAL)
    return emitted(folder) if first or second else ""


def emitted(folder: Path) -> str:
    return sssgen.compile(folder / "two.toml", "glsl-330").files["two.glsl-330.frag"]


def test_two_files_of_one_name_are_two_files(tmp_path: Path) -> None:
    text = two_stages(tmp_path, "float f(float x) { return abs(x); }", "float f(float x) { return sin(x); }")
    assert "return abs(x);" in text and "return sin(x);" in text
    assert " vec3(f(albedo.x))" in text and "vec3(f_2(albedo.x))" in text


def test_a_file_of_the_library_is_not_one_of_the_same_place(tmp_path: Path) -> None:
    """One stage includes common/absorption.sss of its own folder, the other that of the library."""
    library = (Path(TECHNIQUES) / "common" / "absorption.sss").read_text()
    two_stages(tmp_path, "", "", "common/absorption.sss")
    for path in (tmp_path / "a" / "one.sss", tmp_path / "b" / "two.sss"):
        path.write_text(path.read_text().replace("f(albedo.x)", "optical_depth(thickness(albedo.x), 1.0)"))
    (tmp_path / "a" / "common").mkdir()
    (tmp_path / "a" / "common" / "absorption.sss").write_text(library.replace("max(mean", "min(mean"))
    text = emitted(tmp_path)
    assert "float path = min(mean_free_path" in text and "float path = max(mean_free_path" in text


@pytest.mark.parametrize("included", ["../a/f.sss", "../b/../a/f.sss", "../link/f.sss"])
def test_one_file_of_two_spellings_is_one_file(tmp_path: Path, included: str) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "a", target_is_directory=True)
    source = "/// A factor.\nuniform float k = 0.25;\nfloat f(float x) { return sin(x) * k; }"
    text = two_stages(tmp_path, source, "", "f.sss", included)
    assert text.count("float f(float x)") == 1 and "f_2" not in text and text.count("uniform float") == 1


def test_equal_functions_and_constants_of_two_files_appear_once(tmp_path: Path) -> None:
    text = "const float K[2] = float[2](0.25, 0.5);\nfloat g(float x) { return sin(x); }\n"
    text += "float f(float x) { return g(x) + K[1 - int(x > 0.0)]; }"
    result = two_stages(tmp_path, text, f"// elsewhere\n{text}")
    assert result.count("return g(x) + K[") == 1 and "_2" not in result and result.count("const float") == 1


def test_a_file_that_includes_itself_by_another_spelling(tmp_path: Path) -> None:
    with pytest.raises(SssgenError, match=r"includes itself: .*f\.sss → .*f\.sss"):
        two_stages(tmp_path, '#include "../a/f.sss"\nfloat f(float x) { return x; }', "float f(float x) { return x; }")


def test_an_included_file_is_looked_for_beside_the_file_with_the_line(tmp_path: Path) -> None:
    (tmp_path / "common").mkdir()
    (tmp_path / "common" / "f.sss").write_text('#include "g.sss"\nfloat f(float x) { return g(x); }')
    for folder, factor in (("a", "2.0"), ("b", "3.0"), ("common", "4.0")):
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / "g.sss").write_text(f"float g(float x) {{ return x * {factor}; }}")
    two_stages(tmp_path, "", "", "../common/f.sss")
    text = emitted(tmp_path)
    assert "return x * 4.0;" in text and "2.0;" not in text and "3.0;" not in text


def test_places_are_relative_to_the_material(tmp_path: Path) -> None:
    two_stages(tmp_path, "float f(float x) { return sin(x); }", "float f(float x) { return cos(x); }")
    places = sssgen.compile(tmp_path / "two.toml", "glsl-330").reflection["source_map"]["two.glsl-330.frag"]
    files = {place.rsplit(":", 2)[0] for place in places.values()}
    assert {"two.toml", "a/one.sss", "a/f.sss", "surface/base_color.sss"} <= files
    assert not any(Path(file).is_absolute() for file in files)
