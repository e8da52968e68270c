"""Names that a transpiler may get wrong: those that it invents itself, and those that another language reserves."""

from __future__ import annotations

INVENTED = """
selected selected_2 chosen chosen_2 both either once goes_on dropped place before returned result result_2 active
running running_2 mask mask_2 mask_3 value value_2 values values_2 compared x_before i_before n_before a_before
k_before x_in a_in n_in i_in x_2 i_2 k_2 a_2 n_2 x_1 i_1 n_1 x_ i_ a_ half_ sum_ column column_2 whole whole_2 bits
index index_2 modf_ frexp_ mod_ bitCount_ findMSB_ findLSB_ uaddCarry_value bump_value work_value bump_value_2
safe_div carry borrow discarded lanes lane rows element part copy copied saved kept old temporary argument arguments
target words slot lsb msb input_2 out_x stage_in stage_out main_ entry_2
"""
FOREIGN = """
half fn let var ptr loop select texture sample override bitcast array vec2f vec3i mat2x2f f32 i32 u32 f16 atomic
storage workgroup enable requires diagnostic continuing fallthrough alias private function read write read_write
countOneBits extractBits insertBits reverseBits firstLeadingBit firstTrailingBit quantizeToF16 lerp frac fmod atan2
rsqrt mul clip ddx ddy saturate sincos asfloat asint asuint countbits firstbithigh firstbitlow reversebits float2
float3 float4x4 int2 uint4 matrix vector cbuffer tbuffer register packoffset technique pass string point line
triangle groupshared linear sampler_ Texture2D SamplerState SV_Position row_major column_major unroll branch flatten
forcecase nointerpolation snorm unorm dword min16float self None True False lambda def del is not_ and_ or_ print
len range np any_ vec Record to_int to_uint from yield pass_ raise with assert global nonlocal class_ import_ async
await elif except finally lane_ select_ equals type match unless trait impl mod_2 pub crate move static_ extern_
size_t ptrdiff this_ operator_ wchar_t nullptr typeid dFdx fwidth textureLod textureGrad texelFetch shadow2D
texture2D ftransform gl iResolution iTime mainImage fragColor position normal color uv data buffer shared_ view proj
Material Light Camera Object material camera object
"""
PLAIN = "a b c d e f g h i j k l m n o p q r s t u v w x y z A B S T count total step_size acc state flags seed"

LOCALS = tuple(dict.fromkeys((INVENTED + FOREIGN + PLAIN).split()))
"""Names of variables, parameters and fields."""
PLAIN_NAMES = tuple(PLAIN.split())
FUNCTIONS = tuple(dict.fromkeys((INVENTED + FOREIGN + "bump work f g h step_once turn twice pick trade").split()))
TYPES = ("S", "Pair", "Inner", "Surface", "Light", "Material", "Ray", "Hit", "State", "Object", "Record",
         "Texture2D", "float2x", "T", "selected", "value", "result", "i32", "VertexInput", "array", "struct_", "Camera",
         "Varyings")  # fmt: skip
MACROS = ("SQUARE", "EDGE", "ADD", "LIMIT", "PICK", "MASK", "TWICE", "BIT", "HALF_OF", "LOW", "SHIFT", "SWAPPED")
