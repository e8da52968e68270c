"""Compares the texts that the targets emit for a source with the expected texts.

    validate_all("saturate(x)", {"glsl": "clamp(x, 0.0, 1.0)", "hlsl": "saturate(x)", "wgsl": "saturate(x)"})

An expression's free variables are typed by their names: x, y, z, t are floats, i, j, k ints, u, v, w uints, p, q bools, m, n
matrices, and a digit after the letter is the size: x3 is a vec3, p2 a bvec2, m4 a mat4. `map` is a sampler2D, `volume`
a sampler3D, `cube` a samplerCube, and SAMPLERS has more. The compared text is the expression after `return`, or, if a target needs several statements, the statements, after
the functions that they call.

If the source contains a brace, it is one or more functions, and whole functions are compared. If a target refuses the
source, the text is the message: `error: …`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from textwrap import dedent

from sssgen.ir import nodes as ir
from sssgen.ir.types import BY_NAME, Type, spell, vector_of
from sssgen.lang.loader import load_text
from sssgen.pipeline.compiler import transpile
from sssgen.support.diagnostics import SssgenError

TARGETS = {
    "glsl": "glsl-330",
    "glsl-es": "glsl-es-300",
    "hlsl": "hlsl",
    "dx9": "unity-builtin",
    "urp": "unity-urp",
    "wgsl": "wgsl",
    "godot": "godot",
    "numpy": "numpy",
}
"""Name of a target in the tests → target: `dx9` and `urp` are the HLSL dialects of Unity's two pipelines."""

_KINDS = {"x": "float", "y": "float", "z": "float", "t": "float", "i": "int", "j": "int", "k": "int", "u": "uint", "v": "uint", "w": "uint",
          "p": "bool", "q": "bool"}  # fmt: skip
SAMPLERS = {
    "map": "sampler2D", "volume": "sampler3D", "cube": "samplerCube", "layers": "sampler2DArray",
    "cubes": "samplerCubeArray", "shade": "sampler2DShadow", "shadecube": "samplerCubeShadow",
    "shades": "sampler2DArrayShadow", "ints": "isampler2D", "intvolume": "isampler3D", "intcube": "isamplerCube",
    "intlayers": "isampler2DArray", "uints": "usampler2D", "uintvolume": "usampler3D", "uintcube": "usamplerCube",
    "uintlayers": "usampler2DArray", "samples": "sampler2DMS", "intsamples": "isampler2DMS",
    "uintsamples": "usampler2DMS",
}  # fmt: skip
_VARIABLE = re.compile(rf"(?<![.\w])(?:[xyztijkuvwpq][234]?|[mn][234]|{'|'.join(SAMPLERS)})(?![\w(])")


def validate_all(source: str, expected: Mapping[str, str]) -> None:
    """Fails, with the texts of all targets, if a text is not as expected."""
    results = {target: printed(source, target) for target in expected}
    reference = {target: dedent(text).strip() for target, text in expected.items()}
    texts = "\n".join(f"{target}:\n{text}" for target, text in results.items())
    failures = [target for target in expected if results[target] != reference[target]]
    assert not failures, f"{', '.join(failures)} of {source}\n{texts}"


def printed(source: str, target: str) -> str:
    """The text of an expression or of functions in a target."""
    try:
        text = code(module_of(source), TARGETS.get(target, target))
    except SssgenError as error:
        return "\n".join(f"error: {result.message}" for result in error.diagnostics)
    if "{" in source:
        return text
    before, _, function = text.rpartition("\n\n")
    lines = function.splitlines()
    head = next(number for number, line in enumerate(lines) if line.endswith(("{", ":")))
    lines = lines[head + 1 :] if target == "numpy" else lines[head + 1 : -1]
    statements = dedent("\n".join(lines))
    if not before and statements.startswith("return ") and ";\n" not in statements:
        return " ".join(line.strip() for line in lines).removeprefix("return ").removesuffix(";")
    return f"{before}\n\n{statements}".strip()


def module_of(source: str, file: str = "case") -> ir.Module:
    """The module of functions, or of one function `f` that returns the expression."""
    if "{" in source:
        return load_text(dedent(source), file)
    variables = sorted(set(_VARIABLE.findall(source)))
    params = ", ".join(f"{spell(variable_type(name))} {name}" for name in variables)
    module = load_text(f"bool f({params}) {{ return ({source}) == ({source}); }}", file)
    (function,) = module.functions
    assert function.body is not None
    (stmt,) = function.body
    assert isinstance(stmt, ir.Return) and isinstance(stmt.value, ir.Binary)
    value = stmt.value.left
    function = function._replace(result=value.type, body=(ir.Return(value, stmt.span),))
    return module._replace(functions=(function,))


def variable_type(name: str) -> Type:
    """The type of a free variable by its name."""
    if name in SAMPLERS:
        return BY_NAME[SAMPLERS[name]]
    if name[0] in "mn":
        return BY_NAME[f"mat{name[1]}"]
    return vector_of(_KINDS[name[0]], int(name[1:] or 1))


def code(module: ir.Module, target: str) -> str:
    """The functions form of a module, without the head of the file and the include guard."""
    files = transpile(module, target, "case").files
    (text,) = [text for name, text in files.items() if not name.endswith(".json")]
    lines = text.splitlines()
    while lines and (not lines[0] or lines[0].startswith(("//", "#", '"""', "from", "import"))):
        lines.pop(0)
    while lines and (not lines[-1] or lines[-1].startswith("#endif")):
        lines.pop()
    return "\n".join(lines)
