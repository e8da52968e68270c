"""Target descriptors: the properties of a language or engine, except its printer, read from a TOML file.

The records below are the sections of the file, their fields its keys; descriptor_reader.py makes them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import NamedTuple, TypeVar

from sssgen.ir.frame_passes import BEHIND, FRAME_PASSES, VOLUMES, shows_light
from sssgen.passes.capabilities import Capabilities
from sssgen.targets.frame import Variant

_Record = TypeVar("_Record", bound=NamedTuple)

STAGE_BUILTINS = (
    "gl_Position", "gl_FragCoord", "gl_FrontFacing", "gl_FragDepth", "gl_SampleID", "gl_SamplePosition",
    "gl_SampleMaskIn", "gl_SampleMask", "gl_VertexID", "gl_InstanceID",
    "gl_PointSize", "gl_PointCoord", "gl_GlobalInvocationID", "gl_LocalInvocationID", "gl_WorkGroupID",
    "gl_NumWorkGroups", "gl_LocalInvocationIndex",
)  # fmt: skip
"""GLSL's variables that a stage of another language may have as inputs and outputs."""
FACTS = (
    "two_sided", "lit", "unlit", "mesh", "screen", "picture", "opaque", "mask", "blend", "placed",
    "normal_mapped", "tangent_frame", "translucency", "subsurface", "per_light", "lighting",
)  # fmt: skip
"""The properties of a material for which a descriptor may have variants; the later ones win. `screen` is a material
that makes its own picture, without a mesh, and `picture` one of these that reads no ray of the eye; `opaque`,
`mask` and `blend` are alpha modes, `placed` has parameters with that hint. The last six are those of the chain in a
file: a technique writes the normal; one does, or reads T or B (`tangent_frame`); light comes through; it does so
alike from all lights (`subsurface`), or depends on the light (`per_light`); a technique lights."""


class OutputFile(NamedTuple):
    """One file that a target writes."""

    name: str = ""
    """With `{material}` for the material's name, and `{module}` for that of a module in another language than the
    shader's: the same, with `_` where `[names]` has it in `modules` or `host_words`."""
    template: str = ""
    graph: str = ""
    """The function, `module:name`, that makes `graph` of the template's other variables: the nodes of an engine's graph
    (`targets/graphs/`), which the template lays out."""
    stages: Mapping[str, str] = {}
    """Stage (vertex, fragment, library) → its entry point; '' for a library."""
    includes: str = ""
    """The name of the file of the same form that this one includes."""
    holds: Mapping[str, str] = {}
    """A constant of a module for the web → the target whose functions are its text, for `sssgen check`."""
    note: str = ""
    """A sentence at the head of the file: how it is used."""
    without: tuple[str, ...] = ()
    """Kinds of entries that this file does not call: functions that only these need are left out."""
    sources: tuple[str, ...] = ()
    """In place of a template: the files of which this one consists (`javascript_runtime`), the same for every
    material: their runtime."""
    needs: str = ""
    """A list of the template's variables, such as `passes`: where it is empty, there is no such file."""


class Names(NamedTuple):
    """The names that identifiers must avoid: lists in the descriptor, or texts of names between blanks."""

    reserved: frozenset[str] = frozenset()
    """The language's own."""
    also: tuple[str, ...] = ()
    """The targets whose reserved names this one avoids, too, as its text becomes theirs."""
    shell: frozenset[str] = frozenset()
    """Those of the templates."""
    private: frozenset[str] = frozenset()
    """Reserved for this target alone: an engine's macros, which replace local names, too, and Python's words."""
    case_insensitive: frozenset[str] = frozenset()
    """Reserved in any case, as some of HLSL's words are."""
    prefixes: tuple[str, ...] = ()
    """Every name that starts with one of these is reserved."""
    local: frozenset[str] = frozenset()
    """Names that only declarations at file scope must avoid: of variables in the templates' functions, of a library."""
    types: frozenset[str] = frozenset()
    """Types that the file beside the shader reads; one that it declares of such a name, in any case, gets `_`."""
    host_words: frozenset[str] = frozenset()
    """The words of that file's language."""
    modules: frozenset[str] = frozenset()
    """Names of modules that are not free there, in any case of their letters."""
    builtins: bool = False
    """Whether declarations at file scope, too, must avoid the names of builtins, which are GLSL's here."""

    @property
    def exact(self) -> frozenset[str]:
        """The reserved names, without those that are reserved in any case."""
        return self.reserved | self.shell

    @property
    def folded(self) -> frozenset[str]:
        """The names that are reserved in any case, in lower case."""
        return frozenset(name.lower() for name in self.case_insensitive)


class Conventions(NamedTuple):
    """The conventions of a language or engine; the reflection lists those that are declared."""

    matrices: str = ""
    clip_y: str = ""
    clip_z: tuple[float, ...] = ()
    """The nearest and the farthest depth in clip space, divided by w."""
    framebuffer_y: str = ""
    """The sign of dFdy: `up`, `down`, or a text where it depends on the platform."""
    uv_origin: str = ""
    color_space: str = ""
    lengths: str = ""
    """The unit of the engine's lengths, where it is not the metre."""
    attributes: str = ""
    """The locations of a vertex's attributes (GLSL)."""
    semantics: str = ""
    """The same in HLSL."""
    locations: str = ""
    """The same in WGSL and Metal."""


class Limits(NamedTuple):
    """What every device of the target supports at least; 0: not known."""

    samplers: int = 0
    textures: int = 0
    attributes: int = 0
    """Locations of the vertex shader's inputs."""
    varyings: int = 0
    uniform_components: int = 0
    uniform_vectors: int = 0
    uniform_block: int = 0
    """In bytes."""


class TextureTexts(NamedTuple):
    """How a texture is written: `{name}`, `{type}`, `{sampler}`, `{sampler_type}`, `{dim}` and `{binding}` are its."""

    declaration: str = "{type} {name};"
    parameter: str = "{type} {name}"
    argument: str = "{name}"
    sampler: str = "{name}_sampler"
    """The name of its sampler."""
    bare: str = "{name}"
    """The texture itself, where an engine wraps it into a struct."""
    bare_sampler: str = "{name}"
    """The same for the sampler."""


class Bindings(NamedTuple):
    """Where the uniform block of the material goes. HLSL: without a block the members alone are declared."""

    material_block: str = ""
    material_register: str = ""
    group: str = ""
    """WGSL: the group, where it is a name of the engine's; else it is `material_group`."""
    first: int = 0
    """WGSL: the binding of the block; those of the textures and samplers follow."""
    padded: bool = False
    """WGSL: whether the block ends with members that make its size a multiple of 16 bytes."""


class Port(NamedTuple):
    """A port of an engine's node: Shader Graph's, or Unreal's Custom node."""

    type: str = ""
    wire: str = ""
    """What to connect to it, for people."""
    nodes: tuple[str, ...] = ()
    """The engine's nodes that supply it (`graphs/port_nodes.py`)."""


class Embedded(NamedTuple):
    """The text of another language in a target's files: a module for the web has GLSL and WGSL."""

    target: str = ""
    """The target whose functions are embedded; the engine's lighting and conventions are those of the outer target."""
    inputs: Mapping[str, str] = {}
    """Chain input → the expression for it where these functions are called, where it is not that of the target."""
    light_inputs: Mapping[str, str] = {}
    """The same inside the loop over the lights."""
    frame: Mapping[str, Mapping[str, str]] = {}
    surface: Mapping[str, Mapping[str, str]] = {}
    absent: Mapping[str, Mapping[str, str]] = {}
    reads: tuple[str, ...] = ()
    variants: Mapping[str, Variant] = {}
    spelling: Mapping[str, str] = {}
    arguments: Mapping[str, str] = {}
    """As in a target."""
    same_shell: bool = False
    """Whether the target's frame is that of these functions, too, with the spelling of their language; what this record
    has of a frame is then in addition."""


class Properties(NamedTuple):
    """How parameters are named as properties of an object of the engine."""

    style: str = "plain"
    """plain keeps `cell_count`; camel makes `cellCount`."""
    taken: frozenset[str] = frozenset()
    """The names that the object already has; a parameter of such a name begins with `sss`: `sssColor`."""


class Target(NamedTuple):
    """One target. All fields but the last are keys and sections of the descriptor; templates see them all. A descriptor
    has two more keys, `extends` and `words` (descriptor_table.py)."""

    name: str = ""
    title: str = ""
    also: tuple[str, ...] = ()
    """Names under which users look for it; the error for such a name gives the right one."""
    language: str = ""
    """Which printer prints it: glsl, gdshader, hlsl, metal, wgsl, tsl or python, or `module:Class` of a plug-in."""
    dialect: str = ""
    """The intrinsic table's language: glsl, glsl-330, glsl-godot, hlsl, hlsl-dx9, hlsl-macros, hlsl-unreal, wgsl,
    wgsl-metal, wgsl-wesl, tsl, python."""
    types: Mapping[str, str] = {}
    """Type as sssgen spells it → as the target does. In a descriptor '' takes away a type of the base; so it does in
    `inputs` and `light_inputs`."""
    files: Mapping[str, tuple[OutputFile, ...]] = {}
    """Form (shader, functions, vertex, fragment) → the files it writes."""
    inputs: Mapping[str, str] = {}
    """Chain input → the shell's expression for it."""
    light_inputs: Mapping[str, str] = {}
    """The same, where it differs inside the loop over the lights."""
    frame: Mapping[str, Mapping[str, str]] = {}
    """Place in the templates → name → text: what the shell declares and computes where a text mentions the name."""
    surface: Mapping[str, Mapping[str, str]] = {}
    """Place in the templates → value of the surface → the text that gives it to the engine. In all these texts
    `{NAME}` is the function of `shells/` of that name, or a value of the surface, which may be a constant."""
    absent: Mapping[str, Mapping[str, str]] = {}
    """The same for the values that no technique writes, where the engine needs a text all the same."""
    reads: tuple[str, ...] = ()
    """Names of parts of the frame that the templates themselves mention."""
    variants: Mapping[str, Variant] = {}
    """Property of a material (see `FACTS`) → what differs for materials that have it."""
    spelling: Mapping[str, str] = {}
    """Name → what `{NAME}` in all these texts is in the target's language, where its files have a second one."""
    arguments: Mapping[str, str] = {}
    """Type, or several → how the shell passes a parameter of that type, where it is not by its name alone: with
    `{name}`, and `{type}`, the type in the target's language."""
    names: Names = Names()
    capabilities: Capabilities = Capabilities()
    """What the language can express; the passes rewrite the rest."""
    conventions: Conventions = Conventions()
    limits: Limits = Limits()
    textures: TextureTexts = TextureTexts()
    stage_builtins: Mapping[str, str] = {}
    """GLSL's variable → its semantic or attribute here; empty: the language has GLSL's own."""
    bindings: Bindings = Bindings()
    material_group: int = 0
    """WGSL: the group of the material's uniform block, textures and samplers."""
    ports: Mapping[str, Port] = {}
    """Shader Graph, Unreal: chain input, or the side of the face → its port, in the order of the node. The names of
    those that the program reads are the place `ports` of the frame."""
    embedded: Mapping[str, Embedded] = {}
    """Name in the templates → the functions of another target that the files contain, too."""
    properties: Properties = Properties()
    prefix: str = ""
    """The beginning of every global name; `--prefix` sets another. `{material}` in it is the material's name, and then
    the functions, which are called by name, have no prefix."""
    lacks: Mapping[str, str] = {}
    """Value of the surface that the engine does not have → what a user can do instead."""
    lighting: str = ""
    """The technique that lights a lit material; '' where the engine does."""
    fragment_shell: str = ""
    """The function of `shells/` that draws a fragment, where the target has no engine."""
    fragment_result: str = ""
    """What the shell's body does with its result, `{}`; '' where the shell is printed as a function."""
    own_body: bool = False
    """Whether the templates show a body of their own: without back faces, and with a background behind holes."""
    shell: tuple[str, ...] = ()
    """Which of the roles that add to a plain shell (shadow, environment, tone_mapping) its own can carry; an engine has
    its own instead."""
    engine_encodes: bool = False
    """Whether the engine encodes the final colour for a display, so that `output` techniques are left out."""
    draws_passes: str = ""
    """What draws the passes of a material in the form `shader`; '' where the user's program does."""
    draws_light: bool = False
    """Whether it draws the light on the body, too."""
    draws_scene: bool = False
    """Whether it draws the scene without the body, too."""
    draws_inside: str = ""
    """What computes the light inside a body there; '' where the user's program does."""
    clustered_lights: bool = False
    """Whether the number of lights differs from pixel to pixel: functions per light then read textures at level 0."""
    uniform_style: str = "plain"
    """plain keeps `distortion`; unity makes `_Distortion`."""
    layout: str = ""
    """The rule for offsets in a uniform block: std140, hlsl, simd, or '' where there is none."""
    parameters: tuple[str, ...] = ("functions",)
    """The forms in which uniforms are passed to every function instead of being read as globals."""
    declared: tuple[str, ...] = ()
    """Those of these forms whose shell declares the uniforms all the same, and passes them."""
    version: str = ""
    """GLSL: the `#version` line."""
    later_builtins: tuple[str, ...] = ()
    """GLSL: the variables that a version needs which whole shaders have for memory, too."""
    precision: str = ""
    """GLSL: the precision statements."""
    constants: bool = False
    """GLSL: uniforms are printed as constants with the material's values, as the engine sets no uniform."""
    parameter_types: tuple[str, ...] = ()
    """The types that the parameters of a whole shader may have; () for all."""
    texture_types: tuple[str, ...] = ()
    """The same of its textures, where the engine sets fewer kinds than the functions can read."""
    channels: tuple[str, ...] = ()
    """The engine's own names for textures; a material's textures get them in order, and there are no more of them."""
    integer_property: str = ""
    """Unity: the type of an integer property."""
    half_of: str = ""
    """The target of which this one is the variant in half precision; '' for every other."""
    folder: str = ""
    """Where the descriptor is; a plug-in keeps its `templates` there."""

    def for_material(self, facts: Collection[str]) -> Target:
        """The target with its variants for a material of these properties."""
        embedded = {name: _for_material(inner, facts) for name, inner in self.embedded.items()}
        return _for_material(self, facts)._replace(embedded=embedded)

    @property
    def given_inputs(self) -> tuple[str, ...]:
        """The values with an expression of the target's own: a shell does not compute them."""
        return tuple([name for name, text in self.inputs.items() if text != name])

    def drawer(self, name: str) -> str:
        """What draws the pass with this name; '' where the user's program does."""
        if name in VOLUMES:
            return self.draws_inside
        if FRAME_PASSES[name].of == "surroundings":
            return self.draws_passes if self.draws_scene and name == BEHIND else ""
        return self.draws_passes if self.draws_light or not shows_light(name) else ""

    @property
    def has_surroundings(self) -> bool:
        """Whether its shell knows the light of the surroundings: one of the language does, an engine's has a text."""
        return bool(self.fragment_shell) or "irradiance_behind" in self.given_inputs

    @property
    def has_rest_pose(self) -> bool:
        """Whether its shell knows where a point of a skinned body is without its bones."""
        return "P_rest" in self.given_inputs

    def declares(self, form: str) -> bool:
        """Whether the text of a form declares the uniforms and textures."""
        return form not in self.parameters or form in self.declared

    def file_name(self, output: OutputFile, material: str) -> str:
        """The name of a material's file."""
        taken = material.lower() in self.names.host_words | self.names.modules
        return output.name.format(material=material, module=f"{material}_" if taken else material)


_Framed = TypeVar("_Framed", Target, Embedded)


def _for_material(record: _Framed, facts: Collection[str]) -> _Framed:
    """A target, or an embedded text, with its variants for a material of these properties."""
    own = Variant(record.inputs, record.light_inputs, record.frame, record.surface, record.absent, record.reads)
    for fact in FACTS:
        if fact in facts and fact in record.variants:
            own = own.with_variant(record.variants[fact])
    return record._replace(**own._asdict())
