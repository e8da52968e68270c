"""Programs of two stages whose result is a picture: as their author wrote them, and translated.

Pictures have the rows of OpenGL: the first one is at the bottom, and `gl_FragCoord` is as the author means it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import NamedTuple

import numpy as np

from sssgen.ir.types import BY_NAME, Matrix, components, kind_of
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.two_stages import Source, TranslatedProgram, transpile_stages
from sssgen.run.backends import Array, Block, Bound, Drawing, Place, Stage, Text
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.render.shell_values import material_block
from sssgen.targets.program_reflection import ROWS
from sssgen.targets.reflection_record import AttributeRecord, ProgramReflection, ProgramTexture, ProgramUniform
from sssgen.targets.runtime.numpy_textures import Texture

DTYPES: dict[str, type] = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.uint32}
_BLOCK = re.compile(r"layout\s*\(([^()]*)\)(\s*uniform\s+\w+\s*\{)")
_LAYOUT = re.compile(r"layout\s*\(([^()]*\bset\b[^()]*)\)")
_INSTANCE = re.compile(r"\buniform\s+(\w+)\s*\{[^{}]*\}\s*(\w+)")
_VERSION = re.compile(r"^[ \t]*#[ \t]*version[ \t]+(.*?)[ \t]*$", re.MULTILINE)
_HIGH = "\n#define lowp highp\n#define mediump highp"
_HIGH_INT = "\nprecision highp int;"
_OLD = ("", "100", "100 es", "110", "120")
"""The versions that have attributes."""
_NAME = "case"
_POSITION = "picture_position"


class Mesh(NamedTuple):
    """What the vertex stage reads."""

    attributes: Mapping[str, Array]
    """By name: (vertices, components)."""
    triangles: Array
    """(count, 3)."""

    def values(self, attribute: AttributeRecord) -> Array:
        """The numbers of an attribute, or of one location of it; those of the mesh, or zeros."""
        count = len(next(iter(self.attributes.values())))
        zeros = np.zeros((count, components(BY_NAME[attribute["type"].partition("[")[0]])), np.float32)
        return self.attributes.get(attribute["name"], zeros[:, :4])


class PictureProgram(NamedTuple):
    """A program, what it reads, and the size of its picture."""

    vertex: str
    fragment: str
    size: tuple[int, int]
    mesh: Mesh
    uniforms: Mapping[str, Array] = {}
    """By the author's name: `lights[0].color`."""
    blocks: Mapping[str, bytes] = {}
    """The author's uniform blocks by name, in the layout std140."""
    textures: Mapping[str, Texture] = {}

    @property
    def few(self) -> PictureProgram | None:
        """The same program, drawn at `places` alone; None where it has a vertex shader of its author."""
        return self._replace(mesh=_at_places(self.size)) if _POSITION in self.mesh.attributes else None


def of_fragment(fragment: str, size: tuple[int, int]) -> PictureProgram:
    """The program of a fragment shader that covers the picture and reads no values of a vertex shader."""
    version = _VERSION.search(fragment)
    number = version[1] if version else ""
    head = f"#version {number or '100'}\n"
    word = "attribute" if number in _OLD else "in"
    vertex = f"{head}{word} vec4 {_POSITION};\nvoid main()\n{{\n    gl_Position = {_POSITION};\n}}\n"
    corners = np.array([[-1.0, -1.0, 0.0, 1.0], [3.0, -1.0, 0.0, 1.0], [-1.0, 3.0, 0.0, 1.0]], np.float32)
    mesh = Mesh({_POSITION: corners}, np.array([[0, 1, 2]], np.uint32))
    return PictureProgram(vertex, fragment if version else head + fragment, size, mesh)


def places(size: tuple[int, int]) -> Array:
    """(height, width): whether a pixel is among those to draw where all take too long, blocks of 4 by 4."""
    known = np.zeros(size[::-1], bool)
    rows, columns = ({0, side // 8 * 4, max(side - 4, 0)} for side in size[::-1])
    for row, column in product(rows, columns):
        known[row : row + 4, column : column + 4] = True
    return known


def _at_places(size: tuple[int, int]) -> Mesh:
    """A square for each of the places."""
    y, x = np.nonzero(places(size))
    corners = np.stack([np.stack([x + i, y + j], axis=-1) for i, j in ((0, 0), (1, 0), (0, 1), (1, 1))], axis=1)
    positions = np.zeros((*corners.shape[:2], 4), np.float32)
    positions[..., :2] = 2.0 * corners / np.array(size) - 1.0
    positions[..., 3] = 1.0
    first = 4 * np.arange(len(x))[:, None]
    triangles = np.concatenate([first + np.array(corner) for corner in ([0, 1, 2], [1, 3, 2])])
    return Mesh({_POSITION: positions.reshape(-1, 4)}, triangles)


class Translations:
    """The translations of a program. Raises SssgenError where the front end refuses it."""

    def __init__(self, program: PictureProgram) -> None:
        self.program = program
        self.vertex, self.fragment = (
            Source(load_glsl_text(text, f"{_NAME}.{ending}").module)
            for text, ending in ((program.vertex, "vert"), (program.fragment, "frag"))
        )
        self.translated: dict[tuple[str, str], TranslatedProgram] = {}

    def translation(self, target: str, rows: str = ROWS[0]) -> TranslatedProgram:
        """The program for a target. Raises SssgenError where it cannot be translated."""
        if (target, rows) not in self.translated:
            self.translated[target, rows] = transpile_stages(self.vertex, self.fragment, target, _NAME, rows=rows)
        return self.translated[target, rows]

    def reflection(self, target: str) -> ProgramReflection:
        """What a translation reads."""
        reflection: ProgramReflection = json.loads(self.translation(target).files[f"{_NAME}.program.json"])
        return reflection

    def draw(self, target: str, machine: DrawingBackend, mesh: Mesh) -> Array:
        """The picture of a translation. Raises SssgenError where a compiler refuses the text."""
        files, reflection = self.translation(target).files, self.reflection(target)
        # HLSL is drawn in OpenGL, where the vertex stage need not turn the picture
        vertex_files = self.translation(target, ROWS[1]).files if target == "hlsl" else files
        fragment, vertex = (
            Stage(Text(texts[reflection["stages"][kind]["file"]]), reflection["stages"][kind]["entry"] or "main")
            for kind, texts in (("fragment", files), ("vertex", vertex_files))
        )
        names = self.names(reflection)
        numbers = {uniform["name"]: self.numbers(uniform) for uniform in reflection["uniforms"]}
        blocks, values = {}, dict[str, Array]()
        if block := reflection["uniform_block"]:
            data = material_block(-(-block["size"] // 16) * 16, reflection["uniforms"], numbers)
            blocks["Material"] = Block(data, Place(block["group"], block["binding"]))
        else:
            for uniform in reflection["uniforms"]:
                own = numbers[uniform["name"]]  # GLSL keeps structs, but not those in blocks
                values |= {names(uniform["name"]): own, **_elements(uniform, own)}
        attributes = {
            f"ATTR{each['location'] + part}" if target == "hlsl" else names(each["name"]) + "'" * part: mesh.values(
                each
            )
            for each in reflection["attributes"]
            for part in range(each["locations"])
        }
        textures = {
            names(texture["name"]): Bound(self.texture(texture), _place(texture, target))
            for texture in reflection["textures"]
        }
        size = self.program.size
        drawing = Drawing(size, fragment, vertex, textures=textures, blocks=blocks, values=values)
        return _draw(drawing, attributes, mesh, machine)

    def names(self, reflection: ProgramReflection) -> Callable[[str], str]:
        """The function from a name in the source to that in texts of GLSL."""
        renames = {old: new for stage in reflection["renames"].values() for old, new in stage.items()}
        instances = dict(_INSTANCE.findall(self.program.vertex + self.program.fragment))

        def stage_text(source: str) -> str:
            block, dot, member = source.partition(".")
            if block in instances:
                source = f"{instances[block]}_{member}" if dot else source
            name = source.replace("[]", "").replace("[", "_").replace("]", "").replace(".", "_")
            return renames.get(name, name).removeprefix("gl_")

        return stage_text

    def texture(self, texture: ProgramTexture) -> Texture:
        """A texture of the program; without one a texel."""
        given = self.program.textures.get(texture["name"])
        if given is not None:
            return given
        kind = {"depth": "float", "sint": "int", "uint": "uint"}.get(texture["sample_type"], "float")
        dim, _, array = texture["dimension"].partition("-")
        shape = (1,) * bool(array) + {"2d": (1, 1, 4), "3d": (1, 1, 1, 4), "cube": (6, 1, 1, 4)}[dim]
        return Texture(
            np.zeros(shape),
            "nearest",
            dim={"cube": "Cube"}.get(dim, dim.upper()),
            layers=bool(array),
            kind=kind,
            compare=texture["sample_type"] == "depth",
        )

    def elements(self) -> dict[str, tuple[float, ...]]:
        """The numbers of each scalar, vector and matrix among the uniforms, by its name in the source."""
        instances = dict(_INSTANCE.findall(self.program.vertex + self.program.fragment))
        elements = {}
        for uniform in self.reflection("glsl-330")["uniforms"]:
            block, dot, member = uniform["name"].partition(".")
            name = f"{instances.get(block, block)}{dot}{member}"
            name += "[]" * (len(uniform["lengths"]) - name.count("[]"))
            for indices, row in zip(product(*map(range, uniform["lengths"])), self.numbers(uniform), strict=True):
                elements[name.replace("[]", "[{}]").format(*indices)] = tuple(map(float, row))
        return elements

    def numbers(self, uniform: ProgramUniform) -> Array:
        """The numbers of a uniform, (elements, components)."""
        type_ = BY_NAME[uniform["type"]]
        if "block" in uniform:
            return np.array([*_in_block(uniform, self.program.blocks.get(uniform["block"]["name"], b""))])
        count = int(np.prod(uniform["lengths"]))
        zeros = np.zeros((count // len(_written_names(uniform)), components(type_)))
        elements = [
            np.asarray(self.program.uniforms.get(name, zeros)).reshape(zeros.shape) for name in _written_names(uniform)
        ]
        return np.concatenate(elements).astype(DTYPES[kind_of(type_)])


def _written_names(uniform: ProgramUniform) -> list[str]:
    """The author's names of a uniform's elements: of each element of arrays of structs."""
    lengths = uniform["lengths"][: uniform["name"].count("[]")]
    return [uniform["name"].replace("[]", "[{}]").format(*indices) for indices in product(*map(range, lengths))]


def _elements(uniform: ProgramUniform, numbers: Array) -> dict[str, Array]:
    """The numbers of members of structs, which GLSL keeps, by their names."""
    names = _written_names(uniform)
    return dict(zip(names, np.split(numbers, len(names)), strict=True))


def draw_written(program: PictureProgram, machine: DrawingBackend) -> Array:
    """The picture of the author's text in OpenGL's driver. Raises SssgenError where it refuses the text."""
    fragment, vertex = (Stage(Text(for_driver(text))) for text in (program.fragment, program.vertex))
    textures = {name: Bound(texture, Place(0, 0)) for name, texture in program.textures.items()}
    blocks = {name: Block(data.ljust(-(-len(data) // 16) * 16 + 256, b"\0"), Place(0, 0))
              for name, data in program.blocks.items()}  # fmt: skip
    drawing = Drawing(program.size, fragment, vertex, textures=textures, blocks=blocks, values=program.uniforms)
    return _draw(drawing, program.mesh.attributes, program.mesh, machine)


def for_driver(text: str) -> str:
    """The author's text as OpenGL's driver accepts it: without what belongs to Vulkan, whose blocks are std140.

    All precisions are `highp`: drivers compute the others in 16 bits, which no other language has to.
    """
    text = _BLOCK.sub(lambda match: f"layout(std140{_opengl(match[1])}){match[2]}", text)
    text = _LAYOUT.sub(lambda match: f"layout({_opengl(match[1])[2:]})", text)
    text = text if _VERSION.search(text) else f"#version 100\n{text}"
    high = _HIGH if "#extension" in text else _HIGH + _HIGH_INT  # which no extension may follow
    return _VERSION.sub(lambda match: match[0] + high * (match[1].endswith("es") or match[1] == "100"), text, count=1)


def _opengl(layout: str) -> str:
    """A layout's words for OpenGL, each after a comma."""
    words = [word.strip() for word in layout.split(",")]
    return "".join(f", {word}" for word in words if not re.match(r"set\b|push_constant|std140", word))


def _draw(drawing: Drawing, attributes: Mapping[str, Array], mesh: Mesh, machine: DrawingBackend) -> Array:
    """Draws the mesh with those attributes, into floats."""
    columns, end = {}, 0
    for name, array in attributes.items():
        columns[name] = (end, array.shape[1])
        end += array.shape[1]
    vertices = np.concatenate([*attributes.values()], axis=1)
    return machine.draw(drawing._replace(floats=True, vertices=vertices, triangles=mesh.triangles, attributes=columns))


def _place(texture: ProgramTexture, target: str) -> Place:
    """Where a texture is bound."""
    binding = texture["binding"]
    if target != "wgsl" or binding is None:
        return Place(0, 0)
    sampler = int(binding["sampler"]) if texture["sampler"] else -1
    return Place(int(binding["group"]), int(binding["texture"]), sampler)


def _in_block(uniform: ProgramUniform, data: bytes) -> Iterator[Array]:
    """The elements of a uniform in a block of the source."""
    type_, place = BY_NAME[uniform["type"]], uniform["block"]
    columns = type_.columns if isinstance(type_, Matrix) else 1
    shape = (columns, components(type_) // columns)
    shape = shape[::-1] if place["row_major"] else shape
    dtype = DTYPES[kind_of(type_)]
    for indices in product(*map(range, uniform["lengths"])):
        start = place["offset"] + sum(i * stride for i, stride in zip(indices, place["strides"], strict=True))
        lines: list[Array] = [
            np.frombuffer(data[at : at + 4 * shape[1]].ljust(4 * shape[1], b"\0"), dtype)
            for at in (start + line * place["matrix_stride"] for line in range(shape[0]))
        ]
        element = np.array(lines)
        yield (element.T if place["row_major"] else element).reshape(-1)
