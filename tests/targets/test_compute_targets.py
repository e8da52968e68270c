"""What each target makes of a compute shader, and which errors it reports."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import Compiled, transpile
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.support.diagnostics import SssgenError

HEAD = "#version 430\nlayout(local_size_x = 16) in;\n"


def compiled(text: str, target: str) -> Compiled:
    return transpile(load_glsl_text(HEAD + text, "x.comp").module, target, "x", keep=True)


def emitted(text: str, target: str) -> str:
    return next(iter(compiled(text, target).files.values()))


ITEM = "struct Item { uint count; float x; };\nbuffer Items { Item items[]; };\n"
COUNTED = "void main() {\n    atomicAdd(items[0].count, 1u);\n"


@pytest.mark.parametrize("target", ["wgsl", "metal"])
@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        (ITEM + COUNTED + "    Item item = items[1];\n}", "'Item.count' is an atomic", 7),
        (ITEM + COUNTED + "    items[2] = items[1];\n}", "'Item.count' is an atomic", 7),
        (ITEM + "float f(Item i) { return i.x; }\n" + COUNTED + "}", "'Item.count' is an atomic", 5),
        ("buffer A { uvec2 a[]; };\nvoid main() { atomicAdd(a[0].y, 1u); }", "atomicAdd works on a component", 4),
        ("shared uint n[4];\nvoid main() { atomicAdd(n[0], 1u); uint m[4] = n; }", "'n' has atomics, and is copied", 4),
    ],
)  # fmt: skip
def test_what_atomics_cannot_do_has_a_place(text: str, message: str, line: int, target: str) -> None:
    with pytest.raises(SssgenError) as caught:
        emitted(text, target)
    error = caught.value.diagnostics[0]
    assert message in error.message
    assert error.hint
    assert error.span.line == line
    assert "^" in str(caught.value)
    assert emitted(text, "glsl-330")


def test_atomics_on_members_of_structs() -> None:
    text = ITEM + "void main() { atomicAdd(items[0].count, 1u); items[1].x = float(items[2].count); }"
    assert "count: atomic<u32>," in emitted(text, "wgsl")
    assert "f32(atomicLoad(&items_buffer.items[2].count))" in emitted(text, "wgsl").replace(
        "itemsBuffer", "items_buffer"
    )
    assert "atomic_uint count;" in emitted(text, "metal")


def test_metal_has_the_layout_of_the_source() -> None:
    structs = "struct P { vec3 p; float m; vec3 v; vec2 u; };\nbuffer Ps { vec3 first; P ps[]; };\n"
    text = structs + "void main() { ps[0].p = first; }"
    metal = emitted(text, "metal")
    assert "alignas(16) packed_float3 p;" in metal
    assert "    float3 v;" in metal
    assert "    float3 first;" in metal
    assert "P ps[1];" in metal


def test_functions_of_metal_get_references_to_buffers() -> None:
    """The caller has them in memory of the device, in the layout of the source, as in a kernel."""
    buffer = "#version 430\nbuffer B { vec3 c; float w; uint n; } b;\n"
    text = buffer + "float f(float x) { b.w = x; return float(atomicAdd(b.n, 2u)); }"
    metal = next(iter(transpile(load_glsl_text(text, "x.glsl").module, "metal", "x").files.values()))
    assert "float f(float x, device B& b)" in metal
    assert "alignas(16) packed_float3 c;" in metal


@pytest.mark.parametrize(
    ("target", "text", "name"),
    [
        ("metal", "buffer A { float a[]; };\nvoid main() { a[0] = float(a.length()); }", "a_length"),
        ("hlsl", "buffer A { uint a[]; };\nvoid main() { a[0] = gl_NumWorkGroups.x; }", "NumWorkGroups"),
    ],
)
def test_what_only_the_program_can_tell_is_a_uniform(target: str, text: str, name: str) -> None:
    result = compiled(text, target)
    (uniform,) = result.reflection["uniforms"]
    assert uniform["name"] == name
    assert uniform["doc"]
    assert f"'{name}'" in result.warnings[0].message


def test_an_exchange_compares_with_what_it_was_given() -> None:
    """`swapped` of the source is no name of the loop, and the result is written after the comparison."""
    main = "void main() { uint swapped = a[1]; swapped = atomicCompSwap(a[0], swapped, swapped + 1u); }"
    text = "buffer A { uint a[2]; };\n" + main
    wgsl = emitted(text, "wgsl")
    assert "atomicCompareExchangeWeak(&a_buffer.a[0], swapped, swapped + 1u)" in wgsl
    assert "let swapped_2 = " in wgsl


def test_a_function_has_the_name_of_the_entry() -> None:
    text = "buffer A { uint a[2]; };\nuint compute_main() { return 1u; }\nvoid main() { a[0] = compute_main(); }"
    for target in ("wgsl", "hlsl", "metal"):
        assert emitted(text, target).count("compute_main(") == 1


def test_two_lengths_in_a_variable() -> None:
    main = "void main() { int n = a.length(); n += 1; n = b.length(); b[0] = n; }"
    text = "buffer A { uint a[]; };\nbuffer B { int b[]; };\n" + main
    hlsl = emitted(text, "hlsl")
    assert hlsl.count("uint n_size, ") == 1
    assert "uint n_size_2, " in hlsl


def test_the_length_of_a_buffer_with_atomics() -> None:
    text = (
        "#version 310 es\nlayout(local_size_x = 4) in;\nlayout(std430) buffer Bins { int bins[]; };\n"
        "void main() { atomicAdd(bins[0], 1); bins[1] = bins.length(); }\n"
    )
    module = load_glsl_text(text, "bins.comp").module
    emitted = next(iter(transpile(module, "wgsl", "bins", keep=True).files.values()))
    assert "arrayLength(&bins" in emitted


def test_a_buffer_of_arrays_of_arrays_is_bytes_in_hlsl() -> None:
    """glslang refuses structured buffers whose elements are arrays."""
    text = "buffer A { uint a[2][3]; };\nvoid main() { a[1][2] = 3u; }"
    assert "a_buffer.Store(20, 3u)" in emitted(text, "hlsl")


@pytest.mark.parametrize("target", ["hlsl", "glsl-330", "wgsl"])
def test_no_two_buffers_have_one_binding(target: str) -> None:
    """Those of the source stay; those without one, and counters, get the next that is free."""
    text = "uniform atomic_uint n;\nbuffer A { uint a; };\nlayout(binding = 0) buffer B { uint b; };\n"
    result = compiled(text + "void main() { a = atomicCounterIncrement(n); b = 2u; }", target)
    bindings = {each["name"]: each["binding"]["binding"] for each in result.reflection["storage_buffers"]}
    assert len(set(bindings.values())) == 3, bindings


@pytest.mark.parametrize("target", ["glsl-330", "wgsl", "metal"])
def test_counters_whose_names_differ_in_case(target: str) -> None:
    text = "uniform atomic_uint hits, Hits;\nuniform atomic_uint HITS;\n"
    text = emitted(text + "void main() { atomicCounterIncrement(hits); atomicCounterIncrement(Hits); }", target)
    assert "HitsCounter " in text and "HitsCounter_2 " in text


def test_lengths_of_buffers_in_functions_of_metal() -> None:
    text = "#version 430\nbuffer B { uint many[]; } b;\nfloat f() { return float(b.many.length()); }"
    assert "float f(int many_length)" in next(
        iter(transpile(load_glsl_text(text, "x.glsl").module, "metal", "x").files.values())
    )


def test_functions_with_storage_buffers_are_checked_as_later_glsl(compiler: Callable[[str], Compiler]) -> None:
    text = "#version 430\nbuffer B { float many[]; } b;\nfloat f(int i) { return b.many[i]; }"
    (glsl, *_) = transpile(load_glsl_text(text, "x.glsl").module, "glsl-330", "x").files.values()
    for name in ("gl", "glslang"):
        assert errors(compiler(name).check(Source(glsl, "glsl-330", "library"))) == []
