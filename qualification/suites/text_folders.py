"""The cases in folders of GLSL files, as their owners publish them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from qualification.suites.features import unsayable
from qualification.suites.text_cases import TextCase
from sssgen.analyse.verify.inline_includes import expand
from sssgen.support.diagnostics import SssgenError

STAGES = (".vert", ".frag", ".comp")


def spirv_cross(root: Path) -> Iterator[TextCase]:
    """SPIRV-Cross' sources in GLSL; `asm` has assembler."""
    for path in sorted(root.glob("shaders*/**/*")):
        if path.suffix in STAGES and ".asm." not in path.name and "asm" not in path.parts:
            yield _case("spirv-cross", path, root)


_OWN_ERROR = re.compile(r"ERROR: [^:]*:\d+: (?!Linking)")
"""A line of a result about the file itself."""
_PREPROCESSED = ("hlsl.", "preprocess", "include.", "glsl.-")
"""Names of glslang's tests that are no GLSL, or that it reads with options alone."""


def glslang(root: Path) -> Iterator[TextCase]:
    """glslang's tests: `baseResults` has what it says of a file."""
    for path in sorted((root / "Test").iterdir()):
        result = root / "Test" / "baseResults" / f"{path.name}.out"
        if path.suffix in STAGES and not path.name.startswith(_PREPROCESSED) and result.is_file():
            errors = [line for line in _text(result).splitlines() if line.startswith("ERROR:")]
            case = _case("glslang", path, root / "Test")._replace(valid=not errors)
            if errors and not any(map(_OWN_ERROR.match, errors)):
                case = case._replace(skipped="its errors are those of several files together, or of options")
            yield case


def naga(root: Path) -> Iterator[TextCase]:
    """The texts of the tests of naga's front end for GLSL."""
    folder = root / "naga" / "tests" / "in" / "glsl"
    for path in sorted(folder.iterdir()):
        if path.suffix in STAGES:
            yield _case("naga-glsl", path, folder)


def lygia(root: Path) -> Iterator[TextCase]:
    """LYGIA's files, each included in a fragment shader; some need what their user defines."""
    for path in sorted(root.rglob("*.glsl")):
        name = path.relative_to(root).as_posix()
        try:
            included = expand(_text(path), path, (root,))
        except SssgenError as error:
            included = f"#error {error.diagnostics[0].message}"
        text = f"#version 450\nlayout(location = 0) out vec4 color;\n{included}\nvoid main() {{ color = vec4(1.0); }}\n"
        yield TextCase(f"lygia/{name}", "includes.frag", text, judged=True)


def _case(suite: str, path: Path, root: Path) -> TextCase:
    text = _text(path)
    name = path.relative_to(root).as_posix()
    return TextCase(f"{suite}/{name}", path.name, text, folders=(str(path.parent),), skipped=unsayable(text))


def _text(path: Path) -> str:
    return path.read_text("utf-8-sig", errors="replace")
