"""Complete shaders in the text form of the IR, and their texts in the targets."""

from __future__ import annotations

from sssgen.ir.text import read_module
from sssgen.ir.verify import check_module
from sssgen.pipeline.compiler import transpile
from sssgen.run.compilers import Source, Stage, check, errors

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


def emitted_shader(text: str, target: str, keep: bool = True) -> str:
    module = read_module(text)
    check_module(module)
    return next(iter(transpile(module, target, "x", keep=keep).files.values()))


def compile_errors(text: str, target: str, stage: Stage = "fragment") -> list[str]:
    """The errors that external compilers report for a complete shader."""
    entry = "main" if target.startswith("glsl") else f"{stage}_main"
    result = check(Source(text, target, stage, entry))
    return [str(message) for messages in result.values() for message in errors(messages)]
