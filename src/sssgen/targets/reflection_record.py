"""The records of the reflection JSON, of a shader and of a program of two stages (docs/reflection.md).

They are types only: what is read from a file is not checked against them. They take 5 ms to load, so modules on the way
to a shader import them for the type checker alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NotRequired, TypedDict


class BlockPlace(TypedDict, total=False):
    """The place of a parameter in the uniform block, in bytes; absent without a block."""

    offset: int
    size: int


class BlockMember(BlockPlace):
    """What is needed to write a parameter into the block."""

    name: str
    type: str


class NameRecord(TypedDict):
    """The names of a parameter or texture."""

    name: str
    type: str
    """The language's type: `float`, `vec3`, `vec4[8]`, `sampler2D`."""
    source_name: str
    """The name before the target's style and renames."""
    technique: str
    """The technique that declares it; '' for none."""
    technique_name: str
    property: NotRequired[str]
    """Its name as a property of the engine's object, where the target has such."""


class DeclarationRecord(NameRecord):
    """What a parameter and a texture have in common."""

    range: list[float] | None
    """[low, high] or [low, high, step], in `unit`."""
    unit: str | None
    color: bool
    """Whether it is a colour."""
    aliases: list[str]
    drawn: str | None
    """The view that the program draws for each frame (`ir.frame_passes`)."""
    doc: str


class UniformRecord(DeclarationRecord, BlockPlace):
    """A parameter."""

    default: list[float]
    """One number for a scalar, column after column for a matrix."""
    quantity: str | None
    """thickness, thinness or transmittance."""
    placed: bool
    """Whether it depends on where the object is and how large it is drawn."""


class ImportSettings(TypedDict):
    """The import settings of an image in an engine."""

    dimension: str
    """2D, 3D or Cube."""
    srgb: bool
    filter: str
    wrap: str
    """repeat or clamp."""
    mipmaps: bool
    normal_map: bool


class TextureBinding(TypedDict, total=False):
    """Where a texture and its sampler are bound: numbers, HLSL's registers (`t0`, `s0`), or a name for WGSL's group."""

    group: int | str
    texture: int | str
    sampler: int | str


class BindingRecord(TypedDict, total=False):
    """The binding of a texture; absent where the language binds by name."""

    binding: TextureBinding


# a class cannot have a key that is a word of Python
_ImportRecord = TypedDict("_ImportRecord", {"import": ImportSettings})


class TextureRecord(DeclarationRecord, _ImportRecord, BindingRecord):
    """A texture."""

    holds: str | None
    """The quantity that a channel stores."""
    default: str
    """The texture to bind if there is no picture: white, black, gray or bump."""
    needed: str | None
    """What to do for it, where a picture with the default is wrong; null: it is optional, or drawn for each frame."""
    color_space: str
    """sRGB or linear."""


class PassRecord(TypedDict):
    """A pass that a program runs before it draws the material (`ir.frame_passes`)."""

    name: str
    of: str
    """body, casters, both or surroundings."""
    seen_from: str
    """eye, light, distant light, first light, each light, each shadow, or everywhere."""
    layers: list[str]
    """For each channel of the picture `entry N`, `exit N` or `other N`."""
    empty: str
    """What a texel without a surface has: 0, or far."""
    texture: str
    """The texture that shows the picture, by its `source_name`."""
    views: list[str]
    """The matrices of its views, one for each light, likewise."""
    lights: str | None
    """The array that says what these lights are, likewise."""
    size: str | None
    """The parameter with the picture's width, or with the last level of a cube map, likewise."""


class FileRecord(TypedDict):
    """A file of the shader."""

    name: str
    stages: Mapping[str, str]
    """Stage (vertex, fragment, library, …) → its entry point; '' for a library."""


class SlotRecord(TypedDict):
    """A location, or a builtin, among the inputs or outputs of a whole shader."""

    name: str
    builtin: str | None
    path: list[int | str]
    """The indices and names of members in the variable."""
    type: str
    location: int | None
    link: str | None
    """The name by which the two stages match it."""


class BufferMember(TypedDict):
    """A member of a storage buffer; all in bytes."""

    name: str
    type: str
    offset: int
    size: int
    stride: int
    """Between the elements of an array."""


class BufferRecord(TypedDict):
    """A storage buffer."""

    name: str
    block: str
    """Its block in the source."""
    access: str
    """readonly, writeonly or read_write."""
    layout: str
    """std140 or std430."""
    binding: dict[str, int]
    least_size: int
    """Bytes, with one element of an array without a length."""
    members: list[BufferMember]


class ImageRecord(TypedDict):
    """An image whose texels the shader loads or stores."""

    name: str
    type: str
    """As in GLSL."""
    format: str
    """The format of GLSL, such as rgba8, or ''."""
    access: str
    """readonly, writeonly or read_write."""
    binding: dict[str, int]


class Argument(TypedDict):
    """A parameter of an assembled function, as templates see it: what the shell passes for it."""

    name: str
    type: str
    """In the target's spelling."""
    base: str
    """In the language's."""
    input: str
    """The value of the chain; '' for a uniform."""
    uniform: str
    """The uniform or texture; '' for a value of the chain."""
    expression: str


class ParameterSource(TypedDict, total=False):
    """What a parameter gets: `input`, `meaning` and `space` of a value of the chain, or else `uniform`."""

    input: str
    meaning: str
    space: str | None
    """world, object, texture or screen."""
    uniform: str


class EmbeddedExpressions(TypedDict, total=False):
    """The expressions in the other languages of a file; absent where it has one."""

    embedded_expressions: dict[str, str]


class ParameterRecord(ParameterSource, EmbeddedExpressions):
    """A parameter of an assembled function."""

    name: str
    type: str
    expression: str


class EntryRecord(TypedDict):
    """An assembled function."""

    function: str
    inputs: list[str]
    """The values of the chain that the shell passes, in order."""
    params: list[ParameterRecord]
    result: str
    cost: dict[str, int]
    """The fields of `passes.cost.Cost` for one call."""


class ShellRecord(TypedDict):
    """The function around the chain, and the values that it takes."""

    function: str
    inputs: list[str]


class StageInterface(TypedDict, total=False):
    """What only a whole shader has."""

    stage_inputs: list[SlotRecord]
    stage_outputs: list[SlotRecord]


class Kernel(TypedDict, total=False):
    """What only compute shaders and shaders with storage buffers have."""

    workgroup_size: list[int]
    """Three numbers of invocations, of a compute shader."""
    storage_buffers: list[BufferRecord]
    storage_images: NotRequired[list[ImageRecord]]
    """Where the shader has any."""


class ShellPart(TypedDict, total=False):
    """What only a text has that contains the shell as a function."""

    shell: ShellRecord


class Reflection(StageInterface, Kernel, ShellPart):
    """What an engine or a tool needs to bind a shader, and the source of each line."""

    format: int
    material: str
    shading: str
    """lit or unlit."""
    alpha_mode: str
    """opaque, mask or blend."""
    two_sided: bool
    raymarched: bool
    color: str
    """linear or encoded."""
    target: str
    form: str
    files: list[FileRecord]
    uniforms: list[UniformRecord]
    """In the order of the block."""
    uniform_block_size: int | None
    """Bytes."""
    textures: list[TextureRecord]
    passes: list[PassRecord]
    """What the program draws first, in order."""
    entries: dict[str, EntryRecord]
    """Kind of entry (surface, translucency, …) → its function."""
    proven_safe: int
    """The number of operations."""
    guards: list[dict[str, str]]
    """`at`, `operation`, `reason` and `found` of each."""
    renames: dict[str, str]
    """A name in the source → its name in the shader."""
    conventions: dict[str, str | list[float]]
    source_map: dict[str, dict[str, str]]
    """File → line, 1-based, as a text → `file:line:column` in the source."""
    warnings: list[str]


class StageFile(TypedDict):
    """The file of a stage of a program, and its entry point."""

    file: str
    entry: str


class AttributeRecord(TypedDict):
    """An input of the vertex shader."""

    name: str
    type: str
    location: int
    """The first."""
    locations: int
    """Their number: a matrix has one for each column, an array one for each element."""
    format: str
    """WebGPU's vertex format of one location."""


class VaryingRecord(TypedDict):
    """A value that the vertex shader passes on."""

    name: str
    path: list[int | str]
    """The element, column or member."""
    type: str
    location: int
    interpolation: str
    """smooth, flat, noperspective or centroid."""


class OutputRecord(TypedDict):
    """An output of the fragment shader: it has `location` or `builtin`."""

    name: str
    path: list[int | str]
    type: str
    builtin: NotRequired[str | None]
    location: NotRequired[int]


class UniformBlock(TypedDict):
    """The block of all uniforms."""

    size: int
    """Bytes."""
    group: int
    binding: int


class SourceBlock(TypedDict):
    """The place of a uniform in a block of the source, in bytes, in the layout std140."""

    name: str
    offset: int
    strides: list[int]
    """Of its arrays, the outermost first."""
    matrix_stride: int
    row_major: bool


class SourcePlace(TypedDict, total=False):
    """Absent for a uniform that is in no block of the source."""

    block: SourceBlock


class ProgramPlace(BlockPlace, total=False):
    """The place of a uniform of a program in the target's block, in bytes; absent without a block."""

    array_stride: int
    matrix_stride: int


class ProgramUniform(SourcePlace, ProgramPlace):
    """A uniform of a program."""

    name: str
    stages: list[str]
    """Those that read it."""
    type: str
    """Of one element."""
    lengths: list[int]
    """Of the arrays around it, the outermost first."""


class ProgramTexture(TypedDict):
    """A texture of a program."""

    name: str
    stages: list[str]
    dimension: str
    """2d, 3d, cube, 2d-array or cube-array."""
    sample_type: str
    """float, depth, sint or uint."""
    filterable: bool
    sampler: str
    """filtering, comparison, non-filtering, or '' where it needs none."""
    multisampled: bool
    """Whether a texel has several samples."""
    binding: TextureBinding | None


class MemoryUse(TypedDict):
    """Who uses a storage buffer or an image of a program."""

    name: str
    """In the source."""
    stages: list[str]


class ProgramBuffer(BufferRecord):
    """A storage buffer of a program."""

    stages: list[str]


class ProgramImage(ImageRecord):
    """An image of a program."""

    stages: list[str]


class ProgramMemory(TypedDict, total=False):
    """The storage buffers and images of a program; absent where it has none."""

    storage_buffers: list[ProgramBuffer]
    storage_images: list[ProgramImage]


class ProgramReflection(ProgramMemory):
    """What a renderer needs to draw with a program of two stages."""

    format: int
    program: str
    target: str
    rows: str
    """bottom-first or top-first."""
    stages: dict[str, StageFile]
    attributes: list[AttributeRecord]
    varyings: list[VaryingRecord]
    outputs: list[OutputRecord]
    uniform_block: UniformBlock | None
    uniforms: list[ProgramUniform]
    textures: list[ProgramTexture]
    renames: dict[str, dict[str, str]]
    """Stage → a name in the source → its name in the shader."""
    warnings: list[str]
