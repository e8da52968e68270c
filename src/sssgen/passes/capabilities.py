"""What a target language can express: the passes rewrite whatever it cannot."""

from __future__ import annotations

from typing import NamedTuple


class Capabilities(NamedTuple):
    """The capabilities of one language: `[capabilities]` of its descriptor. What is not declared is False."""

    any_images: bool = False
    """An image may have any format, or none if it is only written; it may be read and written."""
    array_attributes: bool = False
    """An attribute of a vertex shader may be an array."""
    array_constructors: bool = False
    """An array constructor is an expression, and a function may return an array."""
    bool_conversions: bool = False
    """`bool(x)` of a number is 0 or 1 also where it is converted again; if not, it is compared with 0."""
    bool_uniforms: bool = False
    """A uniform block may hold a bool; if not, it holds an int in its place."""
    buffer_blocks: bool = False
    """A storage buffer may have several members; if not, it has elements of one type without padding."""
    buffer_lengths: bool = False
    """A storage buffer has a length; if not, the program passes it as a uniform."""
    constant_choices: bool = False
    """A choice between constant vectors that are made of vectors is computed; if not, its value is written."""
    discard_ends: bool = False
    """A discarded invocation ends; if not, it goes on as a helper, and returns where it is in a loop."""
    dynamic_outputs: bool = False
    """An index into an output of a fragment shader may be any expression; if not, it is constant."""
    dynamic_stores: bool = False
    """A component of a vector or a column of a matrix may be assigned through an index that is not constant."""
    early_returns: bool = False
    """`return` may be anywhere in a function; if not, a function returns once, at its end."""
    endless_loops: bool = False
    """A loop may have no exit."""
    float_array_uniforms: bool = False
    """Array elements in a uniform block may be smaller than 16 bytes; if not, each is a vector of four."""
    folded_variables: bool = False
    """A variable that nothing writes becomes a constant, which compilers compute."""
    hiding: bool = False
    """A function's parameters and variables may have the names of uniforms, constants and module variables that it
    does not use."""
    image_atomics: bool = False
    """Atomics work on images."""
    implicit_levels: bool = False
    """Derivatives, and texture reads that need them, are allowed in non-uniform control flow and in vertex shaders."""
    integer_division: bool = False
    """Integer `/`, `%`, `<<` and `>>` are defined for a divisor of 0, negative operands and shifts by 32 or more."""
    lane_control_flow: bool = False
    """Each lane branches for itself; if not, control flow becomes masks."""
    large_variables: bool = False
    """A variable of a function may have any size; if not, one of more than 8192 bytes that nothing uses is omitted."""
    layout_overloads: bool = False
    """Overloads may differ in a vec4 and a mat2 alone, or in structs that hold the same numbers."""
    loop_heads: bool = False
    """A loop's head may hold any expressions, which each round evaluates; if not, a loop counts to a plain value, or
    tests one."""
    loop_scope: bool = False
    """A variable of a loop's head can be declared again behind the loop."""
    mat2_uniforms: bool = False
    """A uniform block may hold a mat2; if not, it holds a vec4 for each column."""
    mat3_uniforms: bool = False
    """The same for a mat3."""
    matrix_conversions: bool = False
    """A matrix can be constructed from a scalar (its diagonal) or from a matrix of another size."""
    matrix_scalar_arithmetic: bool = False
    """`-M` and componentwise `/`, `+` and `-` of matrices and scalars exist; `M * s` exists in every language."""
    member_types: bool = False
    """A struct's member may have the name of a struct that later members have as their type."""
    mixed_bits: bool = False
    """Shifts and bitwise operators take operands of different sizes and signs."""
    mixed_columns: bool = False
    """A matrix can be constructed from any mixture of vectors and scalars; if not, from whole columns or scalars."""
    module_variables: bool = False
    """Modules have mutable variables; if not, these become parameters."""
    mutable_parameters: bool = False
    """A function may assign to its `in` parameters; if not, it copies them."""
    named_varyings: bool = False
    """What the vertex shader passes to the fragment shader is matched by names; if not, by locations."""
    nested_arrays: bool = False
    """Elements of arrays may be arrays; if not, they are structs with an array."""
    nested_varyings: bool = False
    """Stages pass structs and arrays in structs and in arrays; if not, each part is a variable of its own."""
    noperspective: bool = False
    """Stage inputs can be interpolated without perspective."""
    operand_order: bool = False
    """Operands and arguments are evaluated from left to right, and `&&`, `||`, `?:` evaluate only what they need."""
    out_parameters: bool = False
    """Functions have `out` and `inout` parameters; if not, pointers."""
    overloads: bool = False
    """Functions of one name may differ in their parameters' types."""
    plain_atomics: bool = False
    """Atomics work on any int or uint in memory; if not, their memory has a type of its own, which is not copied."""
    pointers: bool = False
    """Pointers stand for `out_parameters`; without both a function returns a struct of its results."""
    std140_buffers: bool = False
    """A storage buffer may have the layout std140 where that is not std430."""
    storage_buffers: bool = False
    """There are storage buffers."""
    storage_images: bool = False
    """There are images whose texels a shader loads and stores."""
    struct_choices: bool = False
    """`?:` chooses between structs and between arrays, too."""
    struct_constructors: bool = False
    """A struct constructor is an expression."""
    struct_uniforms: bool = False
    """A uniform of a whole shader may be a struct; if not, each of its members is a uniform."""
    subset_varyings: bool = False
    """A fragment shader may have fewer inputs than the vertex shader has outputs."""
    swizzle_store: bool = False
    """A swizzle of several components may be assigned: `a.xy = b`."""
    ternary: bool = False
    """`c ? a : b` exists and evaluates one arm only."""
    uint_minus: bool = False
    """`-u` exists for unsigned integers."""
    undefined_constants: bool = False
    """Constant expressions may give infinity or NaN."""
    uniform_values: bool = False
    """A uniform's declaration may give it a value."""
    unreachable_statements: bool = False
    """Statements may follow a `return`, `break` or `continue` in its block; if not, they are omitted."""
    vertex_buffer_writes: bool = False
    """A vertex shader may write storage buffers."""
    variable_values: bool = False
    """A module variable may be initialised with an expression that is not constant."""
    varying_locations: bool = False
    """What the vertex shader passes to the fragment shader may have a location."""
    whole_equality: bool = False
    """`==` and `!=` of vectors, matrices, structs and arrays give one bool."""
    wrapping_constants: bool = False
    """Constant expressions of ints wrap at 32 bits; if not, a part that would differ is replaced by its value."""
