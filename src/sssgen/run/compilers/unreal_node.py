"""The Custom node in a text for Unreal's material editor, as a function around its code.

The engine makes a function of each Custom node: its inputs are parameters, each of the type that the connected node
has, a texture followed by its sampler; its further outputs are `inout` parameters. The files that the node names are
included before the function. The engine's names are those of `unreal_standin.hlsl`, the project's own stand-in.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

FUNCTION = "CustomExpression0"
INCLUDED = "sssgen-text"
"""The name of the included file in `#line`."""

_NODE = re.compile(
    r'^Begin Object Class=/Script/UnrealEd\.\w+ Name="(\w+)"\n(.*?)^End Object$', re.MULTILINE | re.DOTALL
)
_PIN = re.compile(r"^ +CustomProperties Pin \((.*)\)$", re.MULTILINE)
_INPUT = re.compile(r"^ +Inputs\(\d+\)=\(InputName=\"(\w+)\",Input=\((.*)\)\)$", re.MULTILINE)
_OUTPUT = re.compile(r'^ +AdditionalOutputs\(\d+\)=\(OutputName="(\w+)",OutputType=(\w+)\)$', re.MULTILINE)
_INCLUDE = re.compile(r'^ +IncludeFilePaths\(\d+\)="(/\w+(?:/[\w.]+)+)"$', re.MULTILINE)
_SOURCE = re.compile(r"Expression=\"/Script/Engine\.MaterialExpression(\w+)'(\w+)\.(\w+)'\"(?:,OutputIndex=(\d+))?")
_TYPES = {"CMOT_Float1": "MaterialFloat", **{f"CMOT_Float{size}": f"MaterialFloat{size}" for size in (2, 3, 4)}}

_VECTOR = ("MaterialFloat3", "MaterialFloat", "MaterialFloat", "MaterialFloat", "MaterialFloat")
_PLACE = ("MaterialFloat3",)
_SCALAR = ("MaterialFloat",)
NODES: dict[str, tuple[str, ...]] = {
    "VectorParameter": _VECTOR,
    "VertexColor": _VECTOR,
    "Constant3Vector": _PLACE,
    "ScalarParameter": _SCALAR,
    "Time": _SCALAR,
    "TwoSidedSign": _SCALAR,
    "Distance": _SCALAR,
    "TextureCoordinate": ("MaterialFloat2",),
    "ScreenPosition": ("MaterialFloat2",),
    **dict.fromkeys(
        (
            "CameraPositionWS", "CameraVectorWS", "SkyAtmosphereLightDirection", "SkyAtmosphereLightIlluminance",
            "Transform", "TransformPosition", "VertexNormalWS", "WorldPosition",
        ),
        _PLACE,
    ),
}  # fmt: skip
"""Class of a node → the types of its outputs. TruncateLWC has that of its input, AppendVector both inputs' numbers, a
texture that of the text."""


class NodeError(ValueError):
    """Raised for a text that the material editor would not read as it is meant."""


@dataclass(frozen=True)
class Input:
    """An input of the Custom node, with the node that is connected to it."""

    name: str
    type: str
    """'' for a texture."""
    node: str
    output: int


@dataclass(frozen=True)
class CustomNode:
    """The Custom node of a text."""

    code: str
    result: str
    inputs: tuple[Input, ...]
    outputs: tuple[tuple[str, str], ...]
    """(type, name) of the outputs beside the result."""
    includes: tuple[str, ...]

    def parameters(self, textures: Mapping[str, str]) -> list[tuple[str, str]]:
        """(type, name) of the function's parameters; `textures` has the type of each texture."""
        result: list[tuple[str, str]] = []
        for pin in self.inputs:
            if pin.type:
                result.append((pin.type, pin.name))
            else:
                result += [(textures[pin.name], pin.name), ("SamplerState", f"{pin.name}Sampler")]
        return result + [(f"inout {type_}", name) for type_, name in self.outputs]

    def function(self, textures: Mapping[str, str]) -> str:
        """The function that the engine makes of the node."""
        declared = ["FMaterialPixelParameters Parameters", *(" ".join(one) for one in self.parameters(textures))]
        return f"{self.result} {FUNCTION}({', '.join(declared)}) {{\n{self.code}\n}}\n"


def read(text: str) -> CustomNode:
    """The Custom node of a text whose wires are consistent. Raises NodeError."""
    nodes = dict(_NODE.findall(text))
    if "".join(text.split()) != "".join(_without_space(text)):
        raise NodeError("there is text outside of the nodes")
    _check_wires(nodes)
    (custom,) = [body for name, body in nodes.items() if name.startswith("MaterialGraphNode_Custom")]
    inputs = []
    for name, source in _INPUT.findall(custom):
        node, output = _connection(nodes, source)
        inputs.append(Input(name, _type_of(nodes, node, output), node, output))
    return CustomNode(
        _unquote(_property(custom, "Code")),
        _TYPES[_property(custom, "OutputType")],
        tuple(inputs),
        tuple((_TYPES[type_], name) for name, type_ in _OUTPUT.findall(custom)),
        tuple(_INCLUDE.findall(custom)),
    )


def program(text: str, included: str) -> tuple[str, CustomNode]:
    """HLSL of the stand-in, the included file and the node's function; line 1 is that of the included file.

    Raises NodeError.
    """
    node = read(text)
    if len(node.includes) != 1:
        raise NodeError("the Custom node includes no file, or several")
    return f'{before(included)}\n#line 1 "sssgen-node"\n{node.function(textures_of(included))}', node


def before(included: str) -> str:
    """The stand-in, and the included file with its own line numbers."""
    return f'{standin()}\n#line 1 "{INCLUDED}"\n{included}'


def textures_of(included: str) -> dict[str, str]:
    """The type of each texture that the functions of an included file read."""
    return {name: type_ for type_, name in re.findall(r"\b(Texture(?:2D|3D|Cube)) (\w+)[,)]", included)}


@cache
def standin() -> str:
    return Path(__file__).with_name("unreal_standin.hlsl").read_text(encoding="utf-8")


def _without_space(text: str) -> list[str]:
    return [piece for match in _NODE.finditer(text) for piece in match[0].split()]


def _check_wires(nodes: Mapping[str, str]) -> None:
    """Every link of a pin has its counterpart. Raises NodeError."""
    links = set()
    owners: dict[str, str] = {}
    for name, body in nodes.items():
        for pin in _PIN.findall(body):
            match = re.match(r"PinId=([0-9A-F]{32}),PinName=\"(\w+)\",", pin)
            if match is None or match[1] in owners:
                raise NodeError(f"{name}: a pin has no identifier of its own")
            owners[match[1]] = name
            linked = re.search(r"LinkedTo=\(([^)]*)\)", pin)
            for other in linked[1].split(",") if linked else ():
                if other:
                    links.add((name, match[1], *other.split(" ")))
    for name, pin, other, other_pin in links:
        if (other, other_pin, name, pin) not in links or owners.get(other_pin) != other:
            raise NodeError(f"{name}: a pin is connected to {other}, which is not connected to it")


def _connection(nodes: Mapping[str, str], source: str) -> tuple[str, int]:
    match = _SOURCE.match(source)
    if match is None or match[2] not in nodes or f'Name="{match[3]}"' not in nodes[match[2]]:
        raise NodeError(f"an input is connected to no node: {source}")
    return match[2], int(match[4] or 0)


def _type_of(nodes: Mapping[str, str], node: str, output: int) -> str:
    """The type of a node's output; '' for a texture. Raises NodeError."""
    match = re.search(r"Class=/Script/Engine\.MaterialExpression(\w+)", nodes[node])
    kind = match[1] if match else ""
    if kind == "TextureObjectParameter":
        return ""
    if kind == "TruncateLWC":
        return _type_of(nodes, *_connection(nodes, _property(nodes[node], "Input").strip("()")))
    if kind == "AppendVector":
        parts = [_type_of(nodes, *_connection(nodes, _property(nodes[node], name).strip("()"))) for name in "AB"]
        return f"MaterialFloat{sum(int(part[-1]) if part[-1].isdigit() else 1 for part in parts)}"
    if kind not in NODES or output >= len(NODES[kind]):
        raise NodeError(f"{node}: there is no output {output} of {kind or 'a node without a class'}")
    return NODES[kind][output]


def _property(body: str, name: str) -> str:
    match = re.search(rf"^ +{name}=(.*)$", body, re.MULTILINE)
    if match is None:
        raise NodeError(f"a node has no {name}")
    return match[1]


def _unquote(text: str) -> str:
    escapes = {"r": "", "n": "\n", "t": "\t"}
    return re.sub(r"\\(.)", lambda match: escapes.get(match[1], match[1]), text[1:-1])
