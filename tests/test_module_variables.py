"""Module variables and whole shaders: what every pass keeps of their order, and what every target makes of them."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir_interpreter import Interpreter
from sssgen.compiler import transpile
from sssgen.diagnostics import SssgenError
from sssgen.harness.compilers import Source, check, errors
from sssgen.ir.nodes import Module
from sssgen.ir.text import print_module, read_module
from sssgen.ir.verify import check_module, verify
from sssgen.lang.polyfills import polyfill
from sssgen.passes.fold import fold
from sssgen.passes.hoist import hoist
from sssgen.passes.inline import inline
from sssgen.passes.legalise import legalise
from sssgen.passes.prune import prune
from sssgen.passes.uniform_structs import uniform_structs
from sssgen.passes.variables_to_parameters import variables_to_parameters
from sssgen.programs import plain_module
from sssgen.targets import descriptor
from sssgen.targets import numpy_runtime as rt

FUNCTIONS = """variable private float g = 1.0
variable private vec2 h = vec2{2.0, 3.0}
variable private int k
function float next() {
    set $g = (($g * 0.5) + 1.0);
    return $g;
}
function float peek(in float x) {
    return (x + $g);
}
function float both(inout float x) {
    set x += $h.x;
    set $h.y = (x - $g);
    set $k += 1;
    return ($h.y * 0.5);
}
function float outer(in float x) {
    if (x > 2.0) then {
        return ($next() - $peek(x));
    }
    return ($peek(x) - $next());
}
function int turn() {
    set $k = ($k + 1);
    return ($k % 2);
}
"""


class Programs:
    """The text of a module with `f(float a, float b)`, whose expressions read and write variables in any order.

    All arithmetic is exact in float64, or nearly so and done in one order everywhere.
    """

    def __init__(self, random: Random) -> None:
        self.random = random
        self.made = 0

    def module(self) -> str:
        body = "    var float c = a;\n    var float[2] list = float[2]{a, b};\n" + self.block(4, 2)
        return f"{FUNCTIONS}function float f(in float a, in float b) {{\n{body}    return {self.number(2)};\n}}\n"

    def block(self, count: int, depth: int) -> str:
        return "".join([self.statement(depth) for _ in range(count)])

    def statement(self, depth: int) -> str:
        kind = self.random.randrange(9 if depth else 6)
        if kind == 0:
            return f"    set {self.place()} {self.random.choice(['', '+', '-'])}= {self.number(2)};\n"
        if kind == 1:
            return f"    set {self.place()} = {self.call()};\n"
        if kind == 2:
            return f"    call {self.call()};\n"
        if kind in (3, 4):
            self.made += 1
            return f"    var float t{self.made} = {self.number(2)};\n    set c -= (t{self.made} * 0.25);\n"
        if kind == 5:
            return f"    set list[$turn()] = {self.number(2)};\n"
        if kind in (6, 7):
            otherwise = f" else {{\n{self.block(1, depth - 1)}    }}" if self.random.randrange(2) else ""
            return f"    if {self.condition(2)} then {{\n{self.block(2, depth - 1)}    }}{otherwise}\n"
        self.made += 1
        name = f"i{self.made}"
        inner = self.block(2, depth - 1)
        leave = f"    if {self.condition(1)} then {{\n    break;\n    }}\n" if self.random.randrange(2) else ""
        return f"    for (var int {name} = 0; ({name} < 3); set {name} += 1;) {{\n{inner}{leave}    }}\n"

    def place(self) -> str:
        return self.random.choice(["c", "$g", "$h.x", "$h.y", "list[0]", "list[($k % 2)]"])

    def call(self) -> str:
        kind = self.random.randrange(5)
        if kind == 0:
            return "$next()"
        if kind in (1, 2):
            return f"$both({self.place()})"
        return f"${'peek' if kind == 3 else 'outer'}({self.number(1)})"

    def condition(self, depth: int) -> str:
        if depth and self.random.randrange(3) == 0:
            return f"({self.condition(depth - 1)} {self.random.choice(['&&', '||'])} {self.condition(depth - 1)})"
        return f"({self.number(depth)} {self.random.choice('<>')} {self.number(0)})"

    def number(self, depth: int) -> str:
        kind = self.random.randrange(9 if depth else 3)
        if kind == 0:
            return self.random.choice(["0.0", "1.0", "0.5", "-2.0", "3.0"])
        if kind in (1, 2):
            return self.random.choice(["a", "b", "c", "$g", "$h.x", "$h.y", "list[1]", "list[($k % 2)]"])
        if kind in (3, 4):
            return self.call()
        if kind == 5:
            return f"({self.condition(1)} ? {self.number(depth - 1)} : {self.number(depth - 1)})"
        if kind == 6:
            return f"min({self.number(depth - 1)}, {self.number(depth - 1)})"
        return f"({self.number(depth - 1)} {self.random.choice('+-')} {self.number(depth - 1)})"


KEY = "f(float,float)"
VARIABLES: dict[str, Any] = {"g": 1.0, "h": (2.0, 3.0), "k": 0}
"""What the variables begin with."""


def outcome(module: Module, a: float, b: float) -> tuple[Any, ...]:
    """What f gives, and what it leaves in the variables."""
    interpreter = Interpreter(module)
    return (*interpreter.call(KEY, a, b), *[interpreter.globals.get(*one) for one in VARIABLES.items()])


def legal(target: str) -> Callable[[Module], Module]:
    chosen = descriptor.load(target)
    return lambda module: legalise(module, chosen.dialect, chosen.can, polyfill)


PASSES: dict[str, Callable[[Module], Module]] = {
    "fold": fold,
    "prune": lambda module: prune(module, [KEY]),
    "fold and prune": lambda module: prune(fold(module), [KEY]),
    "hoist": lambda module: hoist(module, [KEY])[0],
    "inline": lambda module: inline(module, lambda _: True),
    "inline, with variables": lambda module: inline(module, lambda _: True, insist=True),
    "wgsl": legal("wgsl"),
    "hlsl": legal("hlsl"),
    "glsl": legal("glsl-es-300"),
}


@pytest.mark.parametrize("name", PASSES)
@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.sampled_from([-2.0, 0.0, 0.75, 4.0]), st.sampled_from([-1.0, 2.5]))
def test_a_pass_keeps_the_order_of_reads_and_writes(name: str, random: Random, a: float, b: float) -> None:
    module = read_module(Programs(random).module())
    check_module(module)
    made = PASSES[name](module)
    check_module(made)
    assert outcome(made, a, b) == outcome(module, a, b), print_module(made)


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.booleans())
def test_without_variables_numpy_gives_the_same(random: Random, keep: bool) -> None:
    module = read_module(Programs(random).module())
    text = transpile(module, "numpy", "x", keep=keep).files["x_functions.py"]
    functions: dict[str, Any] = {}
    exec(compile(text, "numpy", "exec"), functions)
    a, b = np.array([-2.0, 0.0, 0.75, 4.0]), np.array([-1.0, 2.5, 0.0, 2.5])
    added = variables_to_parameters(module if keep else plain_module(module)[0]).added.get(KEY, ())
    lanes = {"g": np.ones(4), "h": np.array([[2.0], [3.0]]) * np.ones(4), "k": np.zeros(4, np.int32)}
    with rt.precision(np.float64):
        result = functions["f"](a, b, *[lanes[param.name] for param in added])
    written = [param.name for param in added if param.direction == "inout"]
    values = result if written else (result,)
    for lane in range(4):
        wanted = dict(zip(("f", *VARIABLES), outcome(module, float(a[lane]), float(b[lane])), strict=True))
        for name, value in zip(("f", *written), values, strict=True):
            found = np.broadcast_to(value, (*np.shape(VARIABLES.get(name, 0.0)), 4))[..., lane]
            np.testing.assert_array_equal(found, wanted[name])


# Whole shaders


FRAGMENT = """uniform vec3 iResolution = (1.0, 1.0, 1.0)
uniform sampler2D map
variable private float seed = 1.0
variable private vec2 scaled = ($iResolution.xy * 2.0)
variable in vec2 uv
variable in int kind [interpolation("flat")]
variable in vec4 gl_FragCoord [builtin("gl_FragCoord")]
variable in bool gl_FrontFacing [builtin("gl_FrontFacing")]
variable out vec4 color
variable out vec4 glow [location(1.0)]
function float rand() {
    set $seed = fract((($seed * 1.1) + 0.3));
    return $seed;
}
function void main() {
    var float a = ($rand() + ($rand() * $seed));
    if ((a > 0.5) && ($rand() > 0.2)) then {
        set $color = texture($map, ($uv + $gl_FragCoord.xy));
    } else {
        set $color.xyz = vec3{dFdy($uv.y)};
        set $color.w = float{$kind};
    }
    if $gl_FrontFacing then {
        set $color.xy *= $scaled;
    }
    set $glow = vec4{a};
}
"""
VERTEX = """uniform mat4 mvp = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
variable in vec3 position [location(0.0)]
variable in mat3 frame
variable in int gl_VertexID [builtin("gl_VertexID")]
variable out vec2 uv
variable out int kind [interpolation("flat")]
variable out vec4 gl_Position [builtin("gl_Position")]
function void main() {
    set $uv = ($frame[0].xy * 0.5);
    set $kind = ($gl_VertexID % 3);
    set $gl_Position = ($mvp * vec4{$position, 1.0});
}
"""
OLD = """variable out vec4 gl_FragColor [builtin("gl_FragColor")]
function void main() {
    set $gl_FragColor = vec4{1.0};
}
"""
SEVERAL = """variable out vec4[8] gl_FragData [builtin("gl_FragData")]
variable out float gl_FragDepth [builtin("gl_FragDepth")]
function void main() {
    set $gl_FragData[0] = vec4{1.0};
    set $gl_FragData[1] = vec4{0.5};
    set $gl_FragDepth = 0.25;
}
"""
NOTHING = """function void main() {
    discard;
}
"""
STAGES = {"fragment": FRAGMENT, "vertex": VERTEX, "old": OLD, "several": SEVERAL, "nothing": NOTHING}
TARGETS = ("glsl-330", "glsl-es-300", "hlsl", "wgsl")


def whole(text: str, target: str, keep: bool = True) -> str:
    module = read_module(text)
    check_module(module)
    return next(iter(transpile(module, target, "x", keep=keep).files.values()))


@pytest.mark.parametrize("keep", [True, False])
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", STAGES)
def test_a_whole_shader_compiles(name: str, target: str, keep: bool) -> None:
    stage = "vertex" if name == "vertex" else "fragment"
    entry = "main" if target.startswith("glsl") else f"{stage}_main"
    text = whole(STAGES[name], target, keep)
    found = check(Source(text, target, stage, entry))  # type: ignore[arg-type]  # one of its two words
    assert [str(one) for messages in found.values() for one in errors(messages)] == [], text


def test_colours_that_nothing_gives_are_left_out() -> None:
    assert "out vec4 FragData[2];" in whole(SEVERAL, "glsl-es-300")
    assert "SV_Target1" in whole(SEVERAL, "hlsl")
    assert "SV_Target2" not in whole(SEVERAL, "hlsl")


def test_the_stages_meet() -> None:
    """What the vertex shader gives is what the fragment shader takes, and the GL driver links them."""
    for target in ("glsl-330", "glsl-es-300"):
        source = Source(whole(FRAGMENT, target), target, "fragment", companion=whole(VERTEX, target))
        assert [str(one) for messages in check(source).values() for one in errors(messages)] == []
    wgsl = whole(VERTEX, "wgsl"), whole(FRAGMENT, "wgsl")
    for place in ("@location(0) uv", "@location(1) @interpolate(flat) kind"):
        assert all(place in text for text in wgsl)


def test_what_the_framebuffer_turns() -> None:
    assert "FragCoord.y = iResolution.y - FragCoord.y;" in whole(FRAGMENT, "hlsl")
    assert "FragCoord.w = 1.0 / FragCoord.w;" in whole(FRAGMENT, "hlsl")
    assert "FragCoord.y = material.iResolution.y - FragCoord.y;" in whole(FRAGMENT, "wgsl")
    assert "-uv_dy" in whole(FRAGMENT, "wgsl").replace("-value_dy", "-uv_dy")
    assert "Position.z = (Position.z + Position.w) * 0.5;" in whole(VERTEX, "hlsl")
    assert "dFdy(uv.y)" in whole(FRAGMENT, "glsl-330")
    assert "-dFdy" not in whole(FRAGMENT, "glsl-330")
    without = FRAGMENT.replace("iResolution", "size")
    (warning,) = transpile(read_module(without), "wgsl", "x", keep=True).warnings
    assert "counts from the top" in warning.message
    assert transpile(read_module(without), "glsl-330", "x", keep=True).warnings == []


def test_glsl_is_kept() -> None:
    """The text is the author's, unused functions and all, in the order of its operands."""
    text = whole(FRAGMENT + "function float unused() {\n    return (1.0 + 1.0);\n}\n", "glsl-330")
    assert "float a = rand() + rand() * seed;" in text
    assert "return 1.0 + 1.0;" in text
    assert "kind = gl_VertexID % 3;" in whole(VERTEX, "glsl-330")
    module = read_module(FRAGMENT + "function float unused() {\n    return (1.0 + 1.0);\n}\n")
    pruned = transpile(module, "glsl-330", "x", called=["main()"], keep=True)
    assert "unused" not in next(iter(pruned.files.values()))


def test_what_a_stage_cannot_have_is_refused() -> None:
    point = 'variable in vec2 gl_PointCoord [builtin("gl_PointCoord")]\n' + OLD
    with pytest.raises(SssgenError, match="is given no gl_PointCoord"):
        transpile(read_module(point), "wgsl", "x", keep=True)
    loose = "uniform float u = (1.0)\nvariable private float g = $u\nfunction float f() {\n    return $g;\n}\n"
    with pytest.raises(SssgenError, match="the value of 'g' is not constant"):
        transpile(read_module(loose), "wgsl", "x", keep=True)


def test_a_constant_that_is_no_number_is_refused_where_it_must_be() -> None:
    text = "function float f() {\n    return (1.0 / 0.0);\n}\n"
    assert "1.0 / 0.0" in whole(text, "glsl-330")
    with pytest.raises(SssgenError, match="divided by 0"):
        transpile(read_module(text), "wgsl", "x", keep=True)


def test_a_vertex_shader_reads_textures_at_level_0() -> None:
    read = "    set $uv += texture($map, $uv).xy;\n}\n"
    text = "uniform sampler2D map\n" + VERTEX.removesuffix("}\n") + read
    assert "texture(map, uv)" in whole(text, "glsl-330")
    for target, level in (("wgsl", "textureSampleLevel(map, map_sampler, uv, 0.0)"), ("hlsl", "SampleLevel")):
        made = whole(text, target)
        assert level in made
        found = check(Source(made, target, "vertex", "vertex_main"))
        assert [str(one) for messages in found.values() for one in errors(messages)] == []


def test_an_interpolation_that_a_target_has_not_is_told() -> None:
    text = 'variable in vec2 uv [interpolation("noperspective")]\n' + OLD
    assert "noperspective in vec2 uv;" in whole(text, "glsl-330")
    assert "@interpolate(linear)" in whole(text, "wgsl")
    made = transpile(read_module(text), "glsl-es-300", "x", keep=True)
    assert "\nin vec2 uv;" in next(iter(made.files.values()))
    assert "with perspective" in made.warnings[0].message


def test_what_main_calls_alike_for_all_pixels_may_sample_in_a_loop() -> None:
    """A function of a whole shader is judged by its calls: here the loop's bound is a constant."""
    text = """uniform sampler2D map
variable in vec2 uv
variable out vec4 color
function vec4 blurred(in int count) {
    var vec4 sum = vec4{0.0};
    for (var int i = 0; (i < count); set i += 1;) {
        set sum += texture($map, ($uv * float{i}));
    }
    return sum;
}
function void main() {
    set $color = $blurred(4);
}
"""
    made = transpile(read_module(text), "wgsl", "x", keep=True)
    assert made.warnings == []
    shown = next(iter(made.files.values()))
    found = check(Source(shown, "wgsl", "fragment", "fragment_main"))
    assert [str(one) for messages in found.values() for one in errors(messages)] == [], shown


def test_variables_of_a_library() -> None:
    """Without an entry they are declared, for whoever calls its functions."""
    assert "var<private> g: f32 = 1.0;" in whole(FUNCTIONS, "wgsl")
    assert "static float g = 1.0;" in whole(FUNCTIONS, "hlsl")
    assert "\nfloat g = 1.0;" in whole(FUNCTIONS, "glsl-330")


def test_the_verifier_knows_variables() -> None:
    assert verify(read_module(FRAGMENT)) == []
    assert "cannot be assigned" in verify(read_module(FRAGMENT.replace("set $glow", "set $gl_FragCoord")))[0]
    assert "has a value" in verify(read_module("variable in float x = 1.0\n"))[0]
    assert "no storage" in verify(read_module("variable inout float x\n"))[0]
    for text in (FRAGMENT, VERTEX, OLD, SEVERAL):
        assert print_module(read_module(text)) == text


# Uniforms that hold structs


LIGHTS = """struct Fall {
    float near;
    float[2] steps;
}
struct Light {
    vec3 color;
    Fall fall;
}
uniform Light[3] lights = (NUMBERS)
uniform Light sun = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
variable private Light first = $lights[0]
function float pick(in Light l, in int k) {
    return (l.color.x + l.fall.steps[k]);
}
function float f(in int i, in int j) {
    var Light a = $lights[i];
    var Fall b = $sun.fall;
    var Light[3] all = $lights;
    var float[2] q = $lights[i].fall.steps;
    var float x = (($lights[(i + 1)].fall.steps[j] + $pick($lights[2], 1)) + (a.fall.near * b.steps[j]));
    return ((x + ($first.color.y * q[j])) - (all[i].color[1] + $lights[1].fall.steps[0]));
}
function void main() {
}
""".replace("NUMBERS", ", ".join(f"{number}.5" for number in range(18)))


def values(numbers: tuple[float, ...], shape: Any) -> Any:
    """Numbers as a value of the interpreter's: `shape` counts scalars, or lists the shapes of the parts."""
    given = iter(numbers)

    def built(part: Any) -> Any:
        return tuple(map(built, part)) if isinstance(part, tuple) else next(given)

    return built(shape)


@pytest.mark.parametrize("i", [0, 1])
@pytest.mark.parametrize("j", [0, 1])
def test_a_struct_of_uniforms_reads_the_same_apart(i: int, j: int) -> None:
    module = read_module(LIGHTS)
    check_module(module)
    split = uniform_structs(module)
    check_module(split, linked=True)
    light = ((0, 0, 0), (0, (0, 0)))
    lights, sun = module.uniforms
    known = {"lights": values(lights.default, (light,) * 3), "sun": values(sun.default, light)}
    apart: dict[str, Any] = {}
    for uniform in split.uniforms:
        shape: Any = {"color": (0, 0, 0), "near": 0, "steps": (0, 0)}[uniform.name.rsplit("_", 1)[1]]
        if uniform.name.startswith("lights"):
            shape = (0,) * 6 if shape == (0, 0) else (shape,) * 3
        apart[uniform.name] = values(uniform.default, shape)
    wanted = Interpreter(module, known).call("f(int,int)", i, j)
    assert Interpreter(split, apart).call("f(int,int)", i, j) == wanted


@pytest.mark.parametrize("target", TARGETS)
def test_a_struct_of_uniforms_compiles(target: str) -> None:
    entry = "main" if target.startswith("glsl") else "fragment_main"
    found = check(Source(whole(LIGHTS, target), target, "fragment", entry))
    assert [str(one) for messages in found.values() for one in errors(messages)] == []
