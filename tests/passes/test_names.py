"""Names are legal for a target, and as close as possible to those of the author."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from name_rules import rules_of
from pass_cases import assert_is, module_of, text
from sssgen.ir.verify import verify
from sssgen.passes.names import rename


def unity(name: str) -> str:
    return "_" + "".join(word.capitalize() for word in name.split("_"))


def becomes(
    before: str,
    after: str,
    renamed: dict[str, str],
    reserved: Iterable[str] = (),
    style: Callable[[str], str] = str,
    mangle: bool = False,
    folded: Iterable[str] = (),
) -> None:
    rules = rules_of(set(reserved), not mangle)._replace(reserved_folded=set(folded), uniform_name=style)
    module, names = rename(module_of(before), rules)
    assert_is(module, after)
    assert names == renamed


def test_a_pass_without_changes_keeps_every_node() -> None:
    module = module_of("uniform float a1 = 1.0; float f2(float x3) { float v_4 = x3 * a1; return v_4; }")
    result, names = rename(module, rules_of(overloads=False))
    assert names == {} and all(one is other for one, other in zip(result.functions, module.functions, strict=True))


def test_reserved_words_get_an_underscore_then_a_number() -> None:
    becomes(
        """
        uniform float stage = 1.0; const float region = 2.0; struct patch_ { float main; };
        float lerp(float x) { return x; }
        float f(float texel, float texel_) {
            patch_ p; p.main = lerp(texel) * region * stage;
            for (int pass_ = 0; pass_ < 3; pass_++) { p.main += texel_; }
            return p.main;
        }
        """,
        """
        uniform float stage_ = 1.0; const float region_ = 2.0; struct patch_2 { float main_; };
        float lerp_(float x) { return x; }
        float f(float texel_2, float texel_) {
            patch_2 p; p.main_ = lerp_(texel_2) * region_ * stage_;
            for (int pass_2 = 0; pass_2 < 3; pass_2++) { p.main_ += texel_; }
            return p.main_;
        }
        """,
        {
            "stage": "stage_", "region": "region_", "patch_": "patch_2", "patch_.main": "main_", "lerp": "lerp_",
            "f.texel": "texel_2", "f.pass_": "pass_2",
        },
        reserved=("stage", "region", "patch_", "main", "lerp", "texel", "pass_"),
    )  # fmt: skip


def test_words_reserved_in_any_case() -> None:
    becomes(
        "float f(float Technique) { float Pass = Technique; return Pass; }",
        "float f(float Technique_) { float Pass_ = Technique_; return Pass_; }",
        {"f.Technique": "Technique_", "f.Pass": "Pass_"},
        folded=("technique", "pass"),
    )


def test_uniform_style_and_collisions_in_it() -> None:
    becomes(
        "uniform float light_depth = 1.0; uniform float lightDepth = 1.0; uniform float light_Depth = 1.0; "
        "float f(float x) { return x * light_depth + lightDepth + light_Depth; }",
        "uniform float _LightDepth = 1.0; uniform float _Lightdepth = 1.0; uniform float _LightDepth_ = 1.0; "
        "float f(float x) { return x * _LightDepth + _Lightdepth + _LightDepth_; }",
        {"light_depth": "_LightDepth", "lightDepth": "_Lightdepth", "light_Depth": "_LightDepth_"},
        style=unity,
    )


def test_overload_suffixes_have_the_fewest_types() -> None:
    becomes(
        """
        float box(vec3 p, float r) { return p.x - r; } float box(vec2 p, float r) { return p.x - r; }
        float ball(float x, vec2 y) { return x; } float ball(float x, float y) { return y; }
        float ball(float x) { return x; }
        float only(float x) { return x; }
        float f(float x) {
            return box(vec3(x), x) + box(vec2(x), x) + ball(x, vec2(x)) + ball(x, x) + ball(x) + only(x);
        }
        """,
        """
        float box_vec3(vec3 p, float r) { return p.x - r; } float box_vec2(vec2 p, float r) { return p.x - r; }
        float ball_float_vec2(float x, vec2 y) { return x; } float ball_float_float(float x, float y) { return y; }
        float ball_float(float x) { return x; }
        float only(float x) { return x; }
        float f(float x) {
            return box_vec3(vec3(x), x) + box_vec2(vec2(x), x) + ball_float_vec2(x, vec2(x)) + ball_float_float(x, x)
                + ball_float(x) + only(x);
        }
        """,
        {
            "box(vec3,float)": "box_vec3", "box(vec2,float)": "box_vec2", "ball(float,vec2)": "ball_float_vec2",
            "ball(float,float)": "ball_float_float", "ball(float)": "ball_float",
        },
        mangle=True,
    )  # fmt: skip


def test_overloads_keep_one_name_where_allowed() -> None:
    becomes(
        "float lerp(vec3 p) { return p.x; } float lerp(vec2 p) { return p.x; } "
        "float f(vec3 p) { return lerp(p) + lerp(p.xy); }",
        "float lerp_(vec3 p) { return p.x; } float lerp_(vec2 p) { return p.x; } "
        "float f(vec3 p) { return lerp_(p) + lerp_(p.xy); }",
        {"lerp": "lerp_"},
        reserved=("lerp",),
    )


def test_a_variable_may_hide_an_unused_declaration() -> None:
    source = """
        uniform float depth = 1.0;
        float g(float depth) { return depth; }
        float f(float g) { return g * depth; }
        """
    becomes(source, source, {})


def test_a_variable_that_hides_a_used_declaration_is_renamed() -> None:
    module = module_of("uniform float a = 1.0; float h(float b) { return b * a; } float f(float c) { return h(c); }")
    # in the IR a variable may be called like a declaration that it does not hide
    locals_ = module_of("float f(float a, float h) { float c = a; return c * h; }")
    body = (*(locals_.functions[0].body or ())[:1], *(module.functions[1].body or ()))
    joined = module._replace(functions=(module.functions[0], locals_.functions[0]._replace(body=body)))
    assert verify(joined) == []
    result, names = rename(joined, rules_of())
    assert names == {"f.h": "h_"}
    assert "h_" in text(result) and verify(result) == []


def test_a_variable_called_like_a_builtin_that_its_function_calls() -> None:
    becomes(
        "float f(vec3 p) { float length = length(p); float dot = 1.0; return length * dot; }",
        "float f(vec3 p) { float length_ = length(p); float dot = 1.0; return length_ * dot; }",
        {"f.length": "length_"},
    )


def test_names_that_no_shading_language_allows() -> None:
    module = module_of("uniform float a = 1.0; float f(float x) { float y = x; return y * a; }")
    odd = rename(module, rules_of("afxy")._replace(uniform_name=lambda name: "gl_a__b"))[0]
    assert [uniform.name for uniform in odd.uniforms] == ["a_b"]
    (function,) = odd.functions
    assert (function.name, function.params[0].name) == ("f_", "x_")


def test_structs_in_arrays_and_structs() -> None:
    becomes(
        """
        struct Cell { float level; vec2 sample_; }; struct Grid { Cell cells[2]; Cell last; };
        float g(Grid grid, Cell cell) { return grid.cells[1].level + cell.sample_.x; }
        float f(float x) {
            Grid grid; Cell row[3]; row[0] = Cell(x, vec2(x)); grid.cells[0] = row[0]; grid.last = row[1];
            return g(grid, row[2]) + grid.last.sample_.y;
        }
        """,
        """
        struct Cell_ { float level_; vec2 sample_; }; struct Grid { Cell_ cells[2]; Cell_ last; };
        float g(Grid grid, Cell_ cell) { return grid.cells[1].level_ + cell.sample_.x; }
        float f(float x) {
            Grid grid; Cell_ row[3]; row[0] = Cell_(x, vec2(x)); grid.cells[0] = row[0]; grid.last = row[1];
            return g(grid, row[2]) + grid.last.sample_.y;
        }
        """,
        {"Cell": "Cell_", "Cell.level": "level_"},
        reserved=("Cell", "level"),
    )


def test_the_result_does_not_depend_on_the_order_of_sets() -> None:
    source = "float f(float aa, float bb, float cc) { float dd = aa; float ee = bb; return dd * ee * cc; }"
    words = ["aa", "bb", "cc", "dd", "ee"]
    texts = {text(rename(module_of(source), rules_of(order))[0]) for order in (words, words[::-1])}
    assert len(texts) == 1
