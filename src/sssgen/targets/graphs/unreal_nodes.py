"""The nodes that Unreal's material editor pastes: a Custom node with one wire for each value that its code passes on.

What the engine supplies comes from the nodes that the descriptor lists for a pin; a parameter has a node of its own.
Lengths are in centimetres.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.targets.graphs.port_nodes import port_nodes

_VECTOR_OUTPUTS = ("", "red", "green", "blue", "alpha")
"""The channels of a node's outputs, where it has several; the first has three numbers."""
_ALPHA = 4
_CENTIMETRES = {"m": 100.0, "1/m": 0.01}
"""The unit of a parameter → what multiplies its value."""
_PICTURES = {
    ("white", "Color"): "EngineResources/WhiteSquareTexture.WhiteSquareTexture",
    ("bump", "Normal"): "EngineMaterials/DefaultNormal.DefaultNormal",
}
"""A texture's default and sampler type → Unreal's picture. One whose sRGB differs from the type's is refused."""


class Pin(NamedTuple):
    """An end of a wire. A place is the number of the node, 1 for an input or 2 for an output, and the number there."""

    name: str
    place: tuple[int, int, int]
    type: str
    linked: str = ""
    """The node at the other end of the wire; '' where there is none."""
    reads: tuple[int, int, int] = (0, 0, 0)
    """The other end."""


class Wire(NamedTuple):
    """An input of a node."""

    name: str
    node: int
    output: int


@dataclasses.dataclass
class Node:
    """A node of the material; its class is MaterialExpression and the kind."""

    number: int
    kind: str
    properties: list[str]
    inputs: list[Wire]
    outputs: Sequence[str] = ("Output",)
    pins: list[Pin] = dataclasses.field(default_factory=list)

    @property
    def has_channels(self) -> bool:
        """Whether each channel of its value is an output, too."""
        return self.kind in ("VectorParameter", "VertexColor")

    @property
    def name(self) -> str:
        """Of its object in the editor."""
        return f"MaterialGraphNode_{self.number or 'Custom_0'}"


def nodes(context: Mapping[str, Any]) -> list[Node]:
    """All nodes of a material, the Custom node first. `context` has the variables of a template."""
    material = context["material"]
    graph = _Graph(material["title"])
    for name in context["frame"]["ports"].split():
        graph.add_port(name, context["target"].ports[name].nodes)
    for uniform in context["uniforms"]:
        graph.add_uniform(uniform)
    for texture in context["textures"]:
        graph.add_texture(texture)
    outs = [line.strip(",").split()[1:] for line in context["frame"]["outputs"].splitlines()]
    graph.complete(material["name"], outs)
    return graph.nodes


class _Graph:
    """The nodes, and what the Custom node passes to its function."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.custom = Node(0, "Custom", [], [])
        self.nodes = [self.custom]
        self.arguments: list[str] = []

    def add(self, kind: str, properties: Sequence[str], inputs: Sequence[Wire] = ()) -> Node:
        node = Node(len(self.nodes), kind, list(properties), list(inputs))
        if node.has_channels:
            node.outputs = ["Output", *(f"Output{number + 1}" for number in range(1, len(_VECTOR_OUTPUTS)))]
        self.nodes.append(node)
        return node

    def connect(self, name: str, node: Node, output: int = 0) -> None:
        """An input of the Custom node."""
        self.custom.inputs.append(Wire(name, node.number, output))

    def add_port(self, name: str, texts: Sequence[str]) -> None:
        first = len(self.nodes)
        for kind, properties, inputs in port_nodes(texts):
            wires = [Wire(own, first + number, output) for own, number, output in inputs]
            self.add(kind, [f"{own}={value}" for own, value in properties], wires)
        self.connect(name, self.nodes[-1])
        self.arguments.append(name)

    def add_uniform(self, uniform: Mapping[str, Any]) -> None:
        name, type_, base = uniform["name"], uniform["type"], uniform["base"]
        factor = _CENTIMETRES.get(uniform["unit"], 1.0)
        size = int(base[-1]) if base[-1].isdigit() else 1
        values = [value * factor for value in uniform["default"]]
        if base.startswith("mat"):
            columns = [values[first : first + size] for first in range(0, size * size, size)]
            parts = [self.vector(f"{name}_{index}", column, uniform) for index, column in enumerate(columns)]
            self.arguments.append(f"{type_}({', '.join(parts)})")
            return
        if size > 1:
            text = self.vector(name, values, uniform)
        else:
            limits = zip(("SliderMin", "SliderMax"), uniform["range"] or (), strict=False)
            properties = [f"DefaultValue={_number(values[0])}", *(f"{key}={_number(x * factor)}" for key, x in limits)]
            self.connect(name, self.parameter("ScalarParameter", name, properties, uniform))
            text = name
        if base[0] in "iu":
            text = f"{type_}(round({text}))"
        self.arguments.append(f"{text} > 0.5" if base[0] == "b" else text)

    def vector(self, name: str, values: Sequence[float], described: Mapping[str, Any]) -> str:
        """Adds a parameter of several numbers; returns the text of its value in the code."""
        size = len(values)
        color = ",".join([f"{key}={_number(value)}" for key, value in zip("RGBA", [*values, 0.0, 0.0], strict=False)])
        node = self.parameter("VectorParameter", name, [f"DefaultValue=({color})"], described)
        self.connect(name, node)
        if size == 4:
            self.connect(f"{name}_alpha", node, _ALPHA)
        return {2: f"{name}.xy", 3: name, 4: f"float4({name}, {name}_alpha)"}[size]

    def add_texture(self, texture: Mapping[str, Any]) -> None:
        sampled = {"normal_map": "Normal", "source_color": "Color"}.get(texture["hint"], "LinearColor")
        picture = _PICTURES.get((texture["default"], sampled)) if texture["dim"] == "2D" else None
        properties = ["Texture=" + _quoted(f"/Script/Engine.Texture2D'/Engine/{picture}'")] if picture else []
        properties.append(f"SamplerType=SAMPLERTYPE_{sampled}")
        self.connect(texture["name"], self.parameter("TextureObjectParameter", texture["name"], properties, texture))
        self.arguments += [texture["name"], texture["sampler"]]

    def parameter(self, kind: str, name: str, properties: Sequence[str], described: Mapping[str, Any]) -> Node:
        """Adds the node of a parameter of the material."""
        group = [f"Group={_quoted(self.title)}", f"Desc={_quoted(described['doc'])}"]
        return self.add(kind, [f"ParameterName={_quoted(name)}", *properties, *group])

    def complete(self, name: str, outs: Sequence[Sequence[str]]) -> None:
        """Adds the properties of the Custom node and the pins; `outs` are its other outputs: type and name."""
        call = f"sssgen_{name}::evaluate_material({', '.join([*self.arguments, *(out for _, out in outs)])})"
        self.custom.outputs = ["return", *(out for _, out in outs)] if outs else ["Output"]
        self.custom.properties = [
            f"Code={_quoted(f'return {call};')}",
            "OutputType=CMOT_Float3",
            f"Description={_quoted(self.title)}",
            *(
                f"Inputs({number})=(InputName={_quoted(wire.name)},Input=({self.source(wire)}))"
                for number, wire in enumerate(self.custom.inputs)
            ),
            *(
                f"AdditionalOutputs({number})=(OutputName={_quoted(out)},OutputType=CMOT_Float{type_[5:] or 1})"
                for number, (type_, out) in enumerate(outs)
            ),
            f'IncludeFilePaths(0)="/Project/{name}.ush"',
        ]
        readers = {
            (wire.node, wire.output): (node, index) for node in self.nodes for index, wire in enumerate(node.inputs)
        }
        for node in self.nodes:
            if node is not self.custom:
                node.properties += [f"{wire.name}=({self.source(wire)})" for wire in node.inputs]
            for index, wire in enumerate(node.inputs):
                place, reads = (node.number, 1, index), (wire.node, 2, wire.output)
                kind = 'PinType.PinCategory="required"'
                node.pins.append(Pin(wire.name, place, kind, self.nodes[wire.node].name, reads))
            for index, output in enumerate(node.outputs):
                channel = _VECTOR_OUTPUTS[index] if node.has_channels else ""
                category = "mask" if node.has_channels else ""
                kind = f'Direction="EGPD_Output",PinType.PinCategory="{category}",PinType.PinSubCategory="{channel}"'
                pin = Pin(output, (node.number, 2, index), kind)
                reader = readers.get((node.number, index))  # one at most
                if reader is not None:
                    pin = pin._replace(linked=reader[0].name, reads=(reader[0].number, 1, reader[1]))
                node.pins.append(pin)

    def source(self, wire: Wire) -> str:
        """The output that an input reads, as the engine writes it."""
        node = self.nodes[wire.node]
        kind = f"MaterialExpression{node.kind}"
        masks = ",OutputIndex=4,Mask=1,MaskA=1" if wire.output == _ALPHA else ",Mask=1,MaskR=1,MaskG=1,MaskB=1"
        mask = masks if node.has_channels else ""
        return f"Expression=\"/Script/Engine.{kind}'{node.name}.{kind}_{node.number}'\"{mask}"


def _number(value: float) -> str:
    return f"{value:.9g}"


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
