"""The layout of files: stable, without a change of meaning, and that of every file of the library and the examples."""

from __future__ import annotations

import random
import re
import tomllib
from pathlib import Path

import pytest

from folders import ROOT
from sssgen.cli.main import main
from sssgen.editor.layout import lay_out, lay_out_file
from sssgen.editor.layout_code import code_layout
from sssgen.editor.layout_toml import toml_layout
from sssgen.ir.text import print_module
from sssgen.lang.loader import load_text
from sssgen.lang.syntax.lexer import pieces
from sssgen.material.library import TECHNIQUES
from sssgen.support.diagnostics import SssgenError

CODE = sorted([*(ROOT / "src/sssgen/techniques").rglob("*.sss"), *(ROOT / "examples").rglob("*.sss")])
TOML = sorted([*(ROOT / "targets").glob("*.toml"), *(ROOT / "examples").rglob("*.toml")])

UNTIDY = """#include   "common/lobe.sss"  \n
\n
uniform   float  x:hint_range( -1.0,1.0 ),unit( "1" )=-0.5;//  a
const float T[3]=float[3]( 1.0,-2.0,
3.0 );
/**
* A lobe.
 * role: translucency
   */
float  lobe( world_direction N ){
  float q=x;
  for(int i=0;i<4;++i){ q+=-1.0*( q- -2.0 ) ; q ++; }
      /* more
         lines */
  if(q>0.0&&!(q<1.0))
  q=q>2.0?1.0:-q;
  else if (q == 1.0)
  for (int j=0;j<2;j++)
  q = q +
  1.0;
  else { q=2.0; }
  float a [ 2 ]=float[2](1.0,2.0);
  return T[ 0 ]*N . x+ -q- -a[1]; }


"""
TIDY = """#include   "common/lobe.sss"

uniform float x : hint_range(-1.0, 1.0), unit("1") = -0.5; //  a
const float T[3] = float[3](1.0, -2.0,
    3.0);
/**
 * A lobe.
 * role: translucency
 */
float lobe(world_direction N) {
    float q = x;
    for (int i = 0; i < 4; ++i) { q += -1.0 * (q - -2.0); q++; }
    /* more
         lines */
    if (q > 0.0 && !(q < 1.0))
        q = q > 2.0 ? 1.0 : -q;
    else if (q == 1.0)
        for (int j = 0; j < 2; j++)
            q = q +
                1.0;
    else { q = 2.0; }
    float a[2] = float[2](1.0, 2.0);
    return T[0] * N.x + -q - -a[1]; }
"""
UNTIDY_TOML = """

a=1
b   =   [ 1,2,
3 , [4,5 ], # c
 {x=1,y = {} },
]
[ a1 . "b c" ]  # head
d= 1979-05-27 07:32:00
s = \"\"\"
  x  =1
\"\"\"


[[x]]
e.f   = 1.5   \n"""
TIDY_TOML = """a = 1
b = [1, 2,
    3, [4, 5], # c
    { x = 1, y = {} },
]

[a1."b c"]  # head
d = 1979-05-27 07:32:00
s = \"\"\"
  x  =1
\"\"\"

[[x]]
e.f = 1.5
"""


def ir_of(text: str) -> str:
    """The checked module of a technique, without places."""
    return print_module(load_text(text, "lobe.sss", (TECHNIQUES,)), spans=False)


def test_a_technique_in_its_layout() -> None:
    assert code_layout(UNTIDY, "lobe.sss") == TIDY
    assert code_layout(TIDY, "lobe.sss") == TIDY
    assert ir_of(TIDY) == ir_of(UNTIDY)


def test_a_toml_file_in_its_layout() -> None:
    assert toml_layout(UNTIDY_TOML, "x.toml") == TIDY_TOML
    assert toml_layout(TIDY_TOML, "x.toml") == TIDY_TOML


def test_every_file_of_the_library_and_the_examples_has_the_layout() -> None:
    assert len(CODE) > 100 and len(TOML) > 50
    assert [path.name for path in (*CODE, *TOML) if lay_out_file(str(path), write=False)] == []


def untidy(text: str, generator: random.Random) -> str:
    """A technique without indentation, and with other blanks between its tokens."""
    result, directive = "", False
    found = pieces(text)
    for index, piece in enumerate(found):
        directive = (directive or piece.strip() == "#") and "\n" not in piece
        if "\n" in piece and not piece.strip():
            result += "\n" * piece.count("\n")
        elif directive or piece.startswith(("//", "/*")) or found[index + 1].startswith(("//", "/*")):
            result += piece
        else:
            token = piece.rstrip()
            spaces = generator.randint(1, 3) if token != piece else generator.randint(0, 1) if token in "()[],;" else 0
            result += token + " " * spaces
    return result


def test_an_untidy_file_gets_its_layout_back() -> None:
    generator = random.Random(3)
    for path in CODE:
        text = path.read_text("utf-8")
        assert code_layout(untidy(text, generator), path.name) == text, path
    for path in TOML:
        text = path.read_text("utf-8")
        spread = re.sub(r"^(\w+) = ", r"  \1=", text, flags=re.MULTILINE)
        if tomllib.loads(spread) == tomllib.loads(text):  # not in a text of several lines
            assert toml_layout(spread.replace("\n\n[", "\n\n\n["), path.name) == text, path


def test_the_checked_module_stays() -> None:
    for path in CODE[::6]:
        text = path.read_text("utf-8")
        squeezed = re.sub(r"^ +(?!\*)", "", text, flags=re.MULTILINE)
        roots = (str(path.parent), TECHNIQUES)
        before = print_module(load_text(text, path.name, roots), spans=False)
        after = load_text(code_layout(squeezed, path.name), path.name, roots)
        assert print_module(after, spans=False) == before, path


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.sss", "float f(float x)\n{\n return x\n"),
        ("a.toml", "a =  1\nb = [1,\n"),
        ("a.sss", "float x = 1f;"),
        ("a.glsl", ""),
    ],
)
def test_a_faulty_file_is_not_changed(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SssgenError):
        lay_out_file(str(path))
    assert path.read_text("utf-8") == text
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_line_ends_links_and_modes_stay(tmp_path: Path) -> None:
    path, link = tmp_path / "a.toml", tmp_path / "b.toml"
    path.write_bytes(b"a=1\r\n")
    path.chmod(0o640)
    link.symlink_to(path)
    assert lay_out_file(str(link))
    assert path.read_bytes() == b"a = 1\r\n" and link.is_symlink() and path.stat().st_mode & 0o777 == 0o640
    assert not lay_out_file(str(link))


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "lobe.sss"
    path.write_text(UNTIDY, encoding="utf-8")
    assert main(["fmt", "--check", str(path)]) == 1
    assert path.read_text("utf-8") == UNTIDY and "would change" in capsys.readouterr().out
    broken = tmp_path / "broken.toml"
    broken.write_text("a = ", encoding="utf-8")
    assert main(["fmt", str(broken), str(path)]) == 2
    assert path.read_text("utf-8") == TIDY and broken.read_text("utf-8") == "a = "
    assert main(["fmt", "--check", str(path)]) == 0
    assert main(["fmt", "--json", str(path)]) == 0
    assert '"changed": false' in capsys.readouterr().out


def test_texts_that_are_laid_out_alike() -> None:
    assert lay_out("", "a.sss") == "" and lay_out("\n\n", "a.toml") == ""
    assert lay_out("float a = 1.0;", "a.SSS").endswith(";\n")
