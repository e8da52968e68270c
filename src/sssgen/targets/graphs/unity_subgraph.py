"""The sub-graph for Unity's Shader Graph: its documents of JSON, the graph first; the others are those that it names.

It has a Custom Function node, what supplies its ports, and the output. What the engine supplies comes from the nodes
that the descriptor lists for a port; a parameter is a property of the graph. An identifier is the digest of what it
names, so it stays the same when the material changes, and with it the wires of the graphs that use this one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from sssgen.targets.graphs.port_nodes import port_nodes
from sssgen.targets.templates import digest

Json = dict[str, Any]


class Slot(NamedTuple):
    """A slot of a node; its number is its place among those of the node, from the first number on."""

    type: str
    """In HLSL; `dynamic` for vectors of any size."""
    name: str
    is_output: bool
    label: str = ""
    """What is shown; '': the name."""


_FLOAT3, _FLOAT4, _BOOL = (("float3", "Out"),), (("float4", "Out"),), (("bool", "Out"),)
_TIMES = ("Time", "Sine Time", "Cosine Time", "Delta Time", "Smooth Delta")
_OF_CAMERA = ("Orthographic", "Near Plane", "Far Plane", "Z Buffer Sign", "Width", "Height")
NODES: Mapping[str, tuple[int, Sequence[tuple[str, str]]]] = {
    "UVNode": (0, _FLOAT4),
    "PositionNode": (1, _FLOAT3),
    "NormalVectorNode": (0, _FLOAT3),
    "TangentVectorNode": (0, _FLOAT3),
    "BitangentVectorNode": (0, _FLOAT3),
    "ViewDirectionNode": (1, _FLOAT3),
    "ScreenPositionNode": (0, _FLOAT4),
    "CameraNode": (0, [("float3", "Position"), ("float3", "Direction"), *(("float", name) for name in _OF_CAMERA)]),
    "NegateNode": (0, (("dynamic", "Out"),)),
    "TimeNode": (0, [("float", name) for name in _TIMES]),
    "VertexColorNode": (0, _FLOAT4),
    "IsFrontFaceNode": (0, _BOOL),
}
"""Class of a node that supplies a port → its version in Unity's files, and its outputs."""


def _zeros(names: str) -> Json:
    return dict.fromkeys(names, 0.0)


def _matrix(size: int = 0, values: Sequence[float] = ()) -> Json:
    """The 16 numbers of a matrix: those of a smaller one, column by column, inside of the identity."""
    return {
        f"e{row}{column}": float(values[column * size + row] if max(row, column) < size else row == column)
        for row in range(4)
        for column in range(4)
    }


def _valued(value: Any) -> Json:
    return {"m_Value": value, "m_DefaultValue": value}


_LABELS: Json = {"m_Labels": []}
_BARE = {"m_BareResource": False}
_NO_TEXTURE = {"m_SerializedTexture": "", "m_Guid": ""}
_SLOTS: Mapping[str, tuple[str, Json]] = {
    "bool": ("Boolean", _valued(False)),
    "float": ("Vector1", _valued(0.0) | _LABELS),
    **{f"float{size}": (f"Vector{size}", _valued(_zeros("xyzw"[:size])) | _LABELS) for size in (2, 3)},
    "float4": ("Vector4", _valued(_zeros("xyzw")) | _LABELS),
    "dynamic": ("DynamicVector", _valued(_zeros("xyzw"))),
    **{f"float{size}x{size}": (f"Matrix{size}", _valued(_matrix())) for size in (2, 3, 4)},
    "UnityTexture2D": ("Texture2D", _BARE),
    "UnityTexture3D": ("Texture3D", _BARE),
    "UnityTextureCube": ("Cubemap", _BARE),
    "UnitySamplerState": ("SamplerState", _BARE),
}
"""Type of a slot → its class, and the members beside those of every slot."""
_INPUT_SLOTS: Mapping[str, tuple[str, Json]] = {
    "UnityTexture2D": ("Texture2DInput", {**_BARE, "m_Texture": _NO_TEXTURE, "m_DefaultType": 0}),
    "UnityTexture3D": ("Texture3DInput", {**_BARE, "m_Texture": _NO_TEXTURE}),
    "UnityTextureCube": ("CubemapInput", {**_BARE, "m_Cubemap": {"m_SerializedCubemap": "", "m_Guid": ""}}),
}
"""The same for inputs, where they have a class of their own."""

_DEFAULT_TEXTURES = ("white", "black", "gray", "bump")
_NO_IMAGE = {"m_SerializedTexture": '{"texture":{"instanceID":0}}', "m_Guid": ""}
_TEXTURES: Mapping[str, tuple[str, Json]] = {
    "UnityTexture2D": (
        "Internal.Texture2D",
        {"m_Value": _NO_IMAGE, "isMainTexture": False, "useTilingAndOffset": False, "m_Modifiable": True},
    ),
    "UnityTexture3D": ("Internal.Texture3D", {"m_Value": _NO_IMAGE, "m_Modifiable": True}),
    "UnityTextureCube": (
        "Internal.Cubemap",
        {"m_Value": {"m_SerializedCubemap": '{"cubemap":{"instanceID":0}}', "m_Guid": ""}, "m_Modifiable": True},
    ),
}
"""Type of a texture → the class of its property, and its members."""


def documents(context: Mapping[str, Any]) -> list[Json]:
    """The documents of a material's sub-graph. `context` has the variables of a template."""
    target, material, frame = context["target"], context["material"], context["frame"]
    uniforms, textures = context["uniforms"], context["textures"]
    of_engine = [(target.ports[name].type, name) for name in frame["ports"].split()]
    ports = [*of_engine, *((uniform["type"], uniform["name"]) for uniform in uniforms)]
    for texture in textures:
        ports += [(texture["type"], texture["name"]), (texture["sampler_type"], texture["sampler"])]
    outputs = [(kind, name) for kind, name in (line.split() for line in frame["outputs"].splitlines())]
    graph = _Graph()
    graph.add_function(material["name"], ports, outputs)
    numbers = {name: number for number, (_, name) in enumerate(ports)}
    for _, name in of_engine:
        graph.add_port(name, numbers[name], target.ports[name].nodes)
    for parameter in [*uniforms, *textures]:
        graph.add_property(parameter, numbers[parameter["name"]])
    for texture in textures:
        graph.add_sampler(texture, numbers[texture["sampler"]])
    return graph.whole()


class _Graph:
    """What the sub-graph consists of, while it is built."""

    def __init__(self) -> None:
        self.documents: list[Json] = []
        self.nodes: list[Json] = []
        self.edges: list[Json] = []
        self.properties: list[Json] = []

    def add_node(
        self, name: str, kind: str, version: int, title: str, place: tuple[float, float], slots: Sequence[Slot],
        members: Json, first: int = 0,
    ) -> None:  # fmt: skip
        """A node with its slots, whose numbers begin with `first`."""
        slot_ids = []
        for number, slot in enumerate(slots, first):
            slot_ids.append({"m_Id": digest(f"{name} slot {number}")})
            self.documents.append(_slot(slot_ids[-1]["m_Id"], number, slot))
        position = {"serializedVersion": "2", "x": place[0], "y": place[1], "width": 0.0, "height": 0.0}
        self.nodes.append({"m_Id": digest(name)})
        self.documents.append({
            "m_SGVersion": version, "m_Type": f"UnityEditor.ShaderGraph.{kind}", "m_ObjectId": digest(name),
            "m_Group": {"m_Id": ""}, "m_Name": title, "m_DrawState": {"m_Expanded": True, "m_Position": position},
            "m_Slots": slot_ids, "synonyms": [], "m_Precision": 0, "m_PreviewExpanded": False, "m_PreviewMode": 0,
            "m_CustomColors": {"m_SerializableColors": []}, **members,
        })  # fmt: skip

    def connect(self, source: str, output: int, node: str, slot: int) -> None:
        self.edges.append(
            {
                "m_OutputSlot": {"m_Node": {"m_Id": digest(source)}, "m_SlotId": output},
                "m_InputSlot": {"m_Node": {"m_Id": digest(node)}, "m_SlotId": slot},
            }
        )

    def add_function(self, material: str, ports: Sequence[tuple[str, str]], outputs: Sequence[tuple[str, str]]) -> None:
        """The Custom Function node and the output of the sub-graph."""
        title = material.replace("_", " ").title().replace(" ", "")
        slots = [Slot(_graph_type(kind), name, False) for kind, name in ports]
        self.add_node(
            "function", "CustomFunctionNode", 1, f"{title} (Custom Function)", (0.0, 0.0),
            [*slots, *(Slot(kind, name, True) for kind, name in outputs)],
            {"m_SourceType": 0, "m_FunctionName": title, "m_FunctionBody": "",
             "m_FunctionSource": digest(f"sssgen {material} unity-shadergraph")},
        )  # fmt: skip
        inputs = [Slot(kind, name, False) for kind, name in outputs]
        members = {"IsFirstSlotValid": True}
        self.add_node("output", "SubGraphOutputNode", 0, "Output", (500.0, 0.0), inputs, members, first=1)
        for number in range(len(outputs)):
            self.connect("function", len(ports) + number, "output", number + 1)

    def add_port(self, name: str, number: int, texts: Sequence[str]) -> None:
        """The nodes of a value of the engine; a wire begins at a node's first output."""
        nodes = port_nodes(texts)
        names = [f"port {name} {index}" for index in range(len(nodes))]
        for index, node in enumerate(nodes):
            version, outputs = NODES[node.kind]
            slots = [Slot("dynamic", own, False) for own, _, _ in node.inputs]
            slots += [Slot(kind, own, True) for kind, own in outputs]
            place = (-300.0 * (1 + len(nodes) - index), 120.0 * number)
            members = {own: int(value) for own, value in node.properties}
            self.add_node(names[index], node.kind, version, node.kind.replace("Node", ""), place, slots, members)
            for slot, (_, source, _) in enumerate(node.inputs):
                self.connect(names[source], len(nodes[source].inputs), names[index], slot)
        self.connect(names[-1], len(nodes[-1].inputs), "function", number)

    def add_property(self, parameter: Mapping[str, Any], number: int) -> None:
        """A uniform or a texture."""
        kind, id = _graph_type(parameter["type"]), digest(f"property {parameter['source_name']}")
        self.properties.append({"m_Id": id})
        self.documents.append(_property(parameter, kind, id))
        shown = "float4" if parameter["hint"] == "source_color" and kind == "float3" else kind
        own, slots = f"parameter {parameter['source_name']}", [Slot(shown, "Out", True, parameter["label"])]
        place = (-300.0, 120.0 * number)
        self.add_node(own, "PropertyNode", 0, "Property", place, slots, {"m_Property": {"m_Id": id}})
        self.connect(own, 0, "function", number)

    def add_sampler(self, texture: Mapping[str, Any], number: int) -> None:
        own, slots = f"sampler {texture['source_name']}", [Slot("UnitySamplerState", "Out", True)]
        members = {"m_filter": 0, "m_wrap": 1 if texture["wrap"] == "clamp" else 0, "m_aniso": 0}
        self.add_node(own, "SamplerStateNode", 0, "Sampler State", (-300.0, 120.0 * number), slots, members)
        self.connect(own, 0, "function", number)

    def whole(self) -> list[Json]:
        category, stage = digest("category"), {"m_Position": {"x": 0.0, "y": 0.0}, "m_Blocks": []}
        self.documents.append(
            {
                "m_SGVersion": 0,
                "m_Type": "UnityEditor.ShaderGraph.CategoryData",
                "m_ObjectId": category,
                "m_Name": "",
                "m_ChildObjectList": self.properties,
            }
        )
        mesh = {"m_SerializedMesh": '{"mesh":{"instanceID":0}}', "m_Guid": ""}
        graph = {
            "m_SGVersion": 3, "m_Type": "UnityEditor.ShaderGraph.GraphData", "m_ObjectId": digest("graph"),
            "m_Properties": self.properties, "m_Keywords": [], "m_Dropdowns": [],
            "m_CategoryData": [{"m_Id": category}], "m_Nodes": self.nodes, "m_GroupDatas": [],
            "m_StickyNoteDatas": [], "m_Edges": self.edges, "m_VertexContext": stage, "m_FragmentContext": stage,
            "m_PreviewData": {"serializedMesh": mesh, "preventRotation": False}, "m_Path": "sssgen",
            "m_GraphPrecision": 1, "m_PreviewMode": 2, "m_OutputNode": {"m_Id": digest("output")},
            "m_ActiveTargets": [],
        }  # fmt: skip
        return [graph, *self.documents]


def _graph_type(type_: str) -> str:
    """A type as a graph has it: integers are numbers."""
    return type_ if type_.startswith("Unity") else type_.replace("uint", "float").replace("int", "float")


def _slot(id: str, number: int, slot: Slot) -> Json:
    kind, members = (_SLOTS if slot.is_output else {**_SLOTS, **_INPUT_SLOTS})[slot.type]
    return {
        "m_SGVersion": 0, "m_Type": f"UnityEditor.ShaderGraph.{kind}MaterialSlot", "m_ObjectId": id, "m_Id": number,
        "m_DisplayName": slot.label or slot.name, "m_SlotType": int(slot.is_output), "m_Hidden": False,
        "m_ShaderOutputName": slot.name, "m_StageCapability": 2 if slot.type == "bool" and slot.is_output else 3,
        **members,
    }  # fmt: skip


def _property(parameter: Mapping[str, Any], type_: str, id: str) -> Json:
    kind, version, members = _kind_of_property(parameter, type_)
    guid = "-".join([id[:8], id[8:12], id[12:16], id[16:20], id[20:]])
    return {
        "m_SGVersion": version, "m_Type": f"UnityEditor.ShaderGraph.{kind}ShaderProperty", "m_ObjectId": id,
        "m_Guid": {"m_GuidSerialized": guid}, "m_Name": parameter["label"], "m_DefaultRefNameVersion": 1,
        "m_RefNameGeneratedByDisplayName": parameter["label"], "m_DefaultReferenceName": f"_{parameter['name']}",
        "m_OverrideReferenceName": "", "m_GeneratePropertyBlock": True, "m_UseCustomSlotLabel": False,
        "m_CustomSlotLabel": "", "m_Precision": 0, "overrideHLSLDeclaration": False, "hlslDeclarationOverride": 0,
        "m_Hidden": False, **members,
    }  # fmt: skip


def _kind_of_property(parameter: Mapping[str, Any], type_: str) -> tuple[str, int, Json]:
    """The class of a property, its version in Unity's files, and its own members."""
    default = parameter["default"]
    if type_ in _TEXTURES:
        kind, members = _TEXTURES[type_]
        chosen = {"m_DefaultType": _DEFAULT_TEXTURES.index(default)} if type_ == "UnityTexture2D" else {}
        return kind, 0, members | chosen
    if "x" in type_:
        size = int(type_[-1])
        return f"Matrix{size}", 1, {"m_Value": _matrix(size, default)}
    if type_ in ("float", "bool"):
        low, high, _ = parameter["range"] or (0.0, 1.0, None)
        form = 2 if parameter["base"] in ("int", "uint") else 1 if parameter["range"] else 0
        limits = {"x": float(low), "y": float(high)}
        return "Internal.Vector1", 1, {"m_Value": float(default[0]), "m_FloatType": form, "m_RangeValues": limits}
    values = [float(number) for number in [*default, 0.0, 0.0][:4]]
    if parameter["hint"] == "source_color":
        color = dict(zip("rgba", [*values[:3], values[3] if type_ == "float4" else 1.0], strict=True))
        return "Internal.Color", 3, {"m_Value": color, "isMainColor": False, "m_ColorMode": 1}
    return f"Internal.Vector{type_[-1]}", 1, {"m_Value": dict(zip("xyzw", values, strict=True))}
