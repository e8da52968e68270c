"""TOML with wrong values at every place of the examples, and the unusual forms that TOML allows."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amounts import examples
from front_ends import FRONT_ENDS, survives
from slow_cases import some_slow

VALUES = [
    "true", "-1", "0", "1e308", "-1e308", "1e-300", "nan", "inf", "-inf", "9223372036854775808", '""', '"\\u0000"',
    '"\\u202e\\u0007"', '"../../../etc/passwd"', '"/dev/stdin"', '"x.png"', f'"{"a" * 5000}"', "[]", "[[]]", "[1]",
    "[nan, inf, 1.0]", '["a", 1, true]', "[{}]", "{}", "{ value = 1, fixed = 2 }", "{ file = 1 }", "1979-05-27",
    "1979-05-27T07:32:00Z", "07:32:00", "0xffffffffffffffffffff", "[[[[1]]]]", "[" + "1, " * 5000 + "]",
]  # fmt: skip
TEXTS = {
    "a key twice": "[material]\nname = 'a'\nname = 'b'",
    "a section twice": "[material]\nname = 'a'\n[material]\n",
    "a section and a list of it": "[surface]\n[[surface]]\n",
    "a value and a section": "material = 1\n[material]\n",
    "a key below a value": "material = 1\nmaterial.name = 1",
    "no value": "[material]\nname =\n",
    "no key": "= 1",
    "no end": '[material]\nname = "a',
    "no end of many lines": "[material]\ndoc = '''a\n\n",
    "a control character": "[material]\nname = 'a\x07'",
    "a surrogate": "[material]\nname = '\\ud800'\ntitle = \"\\ud800\"",
    "a date": "size = 1979-02-30",
    "another tool's": "[tool.ruff]\nline-length = 120",
    "keys of any kind": "'' = 1\n'\\u0000' = 2\n\"\\u0000\" = 3\nʎǝʞ = 4",
}


def places(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """The ways to everything in a table."""
    if path:
        yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in inner:
        yield from places(part, (*path, key))


def written(value: Any) -> str:
    """A value as TOML, on one line; a `Raw` as it is."""
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {written(part)}" for key, part in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    return str(value).lower() if isinstance(value, bool) else repr(value)


class Raw(str):
    """Text of TOML."""


def replaced(value: Any, path: tuple[str | int, ...], new: Raw) -> Any:
    """The table with another value at one place."""
    if not path:
        return new
    if isinstance(value, dict):
        return {key: replaced(part, path[1:], new) if key == path[0] else part for key, part in value.items()}
    return [replaced(part, path[1:], new) if index == path[0] else part for index, part in enumerate(value)]


def texts(seed: bytes, offset: int) -> Iterator[str]:
    """The document with another value at each place, at each another one."""
    document = tomllib.loads(seed.decode())
    for at, path in enumerate(places(document), offset):
        changed = replaced(document, path, Raw(VALUES[at % len(VALUES)]))
        yield "\n".join(f"{key} = {written(value)}" for key, value in changed.items())


@pytest.mark.parametrize("name", some_slow(["material", "scene", "ci folder"], "material"))
@examples(1, 0.01)
@given(offset=st.integers(0, len(VALUES) - 1))
def test_any_value_at_every_place(name: str, tmp_path: Path, offset: int) -> None:
    front_end = FRONT_ENDS[name]
    for number, seed in enumerate(front_end.seeds()):
        for text in texts(seed, offset + number):
            survives(front_end, text.encode(), tmp_path)


@pytest.mark.parametrize("name", some_slow(["material", "scene", "ci folder"], "material"))
def test_values_for_the_sections(name: str, tmp_path: Path) -> None:
    """Every section of a material and a scene with every value."""
    sections = (
        "material size samples time background ambient exposure geometry camera light parameters textures surface"
    )
    for section in [*sections.split(), "thickness", "translucency", "coordinates"]:
        for value in VALUES:
            survives(FRONT_ENDS[name], f"{section} = {value}\n".encode(), tmp_path)


@pytest.mark.parametrize("title", TEXTS)
def test_wrong_toml(title: str, tmp_path: Path) -> None:
    for name in ("material", "scene"):
        assert not survives(FRONT_ENDS[name], TEXTS[title].encode("utf-8", "surrogatepass"), tmp_path)


def test_written_documents_are_read_back() -> None:
    for seed in (*FRONT_ENDS["material"].seeds(), *FRONT_ENDS["scene"].seeds()):
        document = tomllib.loads(seed.decode())
        text = "\n".join(f"{key} = {written(value)}" for key, value in document.items())
        assert tomllib.loads(text) == document
