"""The sub-graph for Unity's Shader Graph: its documents, their references, the node that calls the emitted function.

Shader Graph runs in the Unity editor only. `CLASSES` is what its C# sources declare (com.unity.shadergraph 13.0); where
SSSGEN_UNITY_INCLUDES names a folder with that package's Editor folder, a test compares it with them.
"""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import sssgen
from folders import ROOT
from sssgen.run.compilers import Compiler, Source, errors
from sssgen.run.compilers.calling_entry import functions

LEAF = ROOT / "examples" / "engines" / "unity" / "leaf.toml"
EVERY_KIND = """
uniform int steps : hint_range(1, 8) = 3;
uniform uint seed = 7u;
uniform bool mirrored = true;
uniform vec2 offset = vec2(0.1, 0.2);
uniform vec3 axis = vec3(0.0, 1.0, 0.0);
uniform vec4 plane = vec4(1.0, 2.0, 3.0, 4.0);
uniform vec3 glow : source_color = vec3(0.1, 0.2, 0.3);
uniform mat2 turn = mat2(1.0, 2.0, 3.0, 4.0);
uniform mat3 basis = mat3(1.0);
uniform mat4 place = mat4(2.0);
uniform sampler3D volume : repeat_disable, default_white;
uniform samplerCube sky;
uniform sampler2D bumps : normal_map, default_bump;

/** Reads every kind of parameter and texture, and every input.
role: surface
*/
void every_kind(uv_position uv, world_position P, world_direction V, world_direction N, world_direction T,
    world_direction B, object_position P_object, object_direction V_object, object_direction N_object, float time,
    vec2 screen_uv, float eye_distance, vec2 uv2, vec4 vertex_color, out vec3 emission) {
    emission = vec3(float(steps) + float(seed) + (mirrored ? 1.0 : 0.0) + time + eye_distance) * glow + axis;
    emission += plane.xyz * plane.w + (place * vertex_color).xyz;
    emission += vec3(turn * (offset + uv + screen_uv + uv2), 0.0) + basis * (N + T + B + V + P);
    emission += texture(volume, P_object).rgb + texture(sky, V_object + N_object).rgb + texture(bumps, uv).rgb;
}
"""
COAT = """
[material]
name = "coat"
shading = "lit"
[[surface]]
technique = "specular_level"
[[surface]]
technique = "clearcoat_constants"
[[thickness]]
technique = "thickness_map"
[translucency]
technique = "absorption_tint"
"""
SLOT = {"m_Id", "m_DisplayName", "m_SlotType", "m_Hidden", "m_ShaderOutputName", "m_StageCapability"}
VALUE = {"m_Value", "m_DefaultValue"}
NODE = {
    "m_Group", "m_Name", "m_DrawState", "m_Slots", "synonyms", "m_Precision", "m_PreviewExpanded", "m_PreviewMode",
    "m_CustomColors",
}  # fmt: skip
PROPERTY = {
    "m_Guid", "m_Name", "m_DefaultRefNameVersion", "m_RefNameGeneratedByDisplayName", "m_DefaultReferenceName",
    "m_OverrideReferenceName", "m_GeneratePropertyBlock", "m_UseCustomSlotLabel", "m_CustomSlotLabel", "m_Precision",
    "overrideHLSLDeclaration", "hlslDeclarationOverride", "m_Hidden", "m_Value",
}  # fmt: skip
CLASSES: dict[str, tuple[int, set[str]]] = {
    "GraphData": (3, {
        "m_Properties", "m_Keywords", "m_Dropdowns", "m_CategoryData", "m_Nodes", "m_GroupDatas", "m_StickyNoteDatas",
        "m_Edges", "m_VertexContext", "m_FragmentContext", "m_PreviewData", "m_Path", "m_GraphPrecision",
        "m_PreviewMode", "m_OutputNode", "m_ActiveTargets",
    }),
    "CategoryData": (0, {"m_Name", "m_ChildObjectList"}),
    "CustomFunctionNode": (1, NODE | {"m_SourceType", "m_FunctionName", "m_FunctionSource", "m_FunctionBody"}),
    "SubGraphOutputNode": (0, NODE | {"IsFirstSlotValid"}),
    "PropertyNode": (0, NODE | {"m_Property"}),
    "SamplerStateNode": (0, NODE | {"m_filter", "m_wrap", "m_aniso"}),
    "UVNode": (0, NODE | {"m_OutputChannel"}),
    "PositionNode": (1, NODE | {"m_Space", "m_PositionSource"}),
    **{f"{name}VectorNode": (0, NODE | {"m_Space"}) for name in ("Normal", "Tangent", "Bitangent")},
    "ViewDirectionNode": (1, NODE | {"m_Space"}),
    "ScreenPositionNode": (0, NODE | {"m_ScreenSpaceType"}),
    **{f"{name}Node": (0, NODE) for name in ("Camera", "Time", "VertexColor", "IsFrontFace", "Negate")},
    **{f"Vector{size}MaterialSlot": (0, SLOT | VALUE | {"m_Labels"}) for size in (1, 2, 3, 4)},
    **{f"{name}MaterialSlot": (0, SLOT | VALUE) for name in ("DynamicVector", "Boolean", "Matrix2", "Matrix3")},
    "Matrix4MaterialSlot": (0, SLOT | VALUE),
    **{f"{name}MaterialSlot": (0, SLOT | {"m_BareResource"}) for name in ("Texture2D", "Texture3D", "Cubemap")},
    "SamplerStateMaterialSlot": (0, SLOT | {"m_BareResource"}),
    "Texture2DInputMaterialSlot": (0, SLOT | {"m_BareResource", "m_Texture", "m_DefaultType"}),
    "Texture3DInputMaterialSlot": (0, SLOT | {"m_BareResource", "m_Texture"}),
    "CubemapInputMaterialSlot": (0, SLOT | {"m_BareResource", "m_Cubemap"}),
    "Internal.Vector1ShaderProperty": (1, PROPERTY | {"m_FloatType", "m_RangeValues"}),
    **{f"Internal.Vector{size}ShaderProperty": (1, PROPERTY) for size in (2, 3, 4)},
    **{f"Matrix{size}ShaderProperty": (1, PROPERTY) for size in (2, 3, 4)},
    "Internal.ColorShaderProperty": (3, PROPERTY | {"isMainColor", "m_ColorMode"}),
    "Internal.Texture2DShaderProperty": (
        0, PROPERTY | {"isMainTexture", "useTilingAndOffset", "m_Modifiable", "m_DefaultType"},
    ),
    **{f"Internal.{name}ShaderProperty": (0, PROPERTY | {"m_Modifiable"}) for name in ("Texture3D", "Cubemap")},
}  # fmt: skip
"""Class → m_SGVersion (`latestVersion`), and its serialized members beside m_SGVersion, m_Type and m_ObjectId."""
SLOTS = {
    "bool": "Boolean", "float": "Vector1", "int": "Vector1", "uint": "Vector1", "float2": "Vector2",
    "float3": "Vector3", "float4": "Vector4", "float2x2": "Matrix2", "float3x3": "Matrix3", "float4x4": "Matrix4",
    "UnityTexture2D": "Texture2DInput", "UnityTexture3D": "Texture3DInput", "UnityTextureCube": "CubemapInput",
    "UnitySamplerState": "SamplerState",
}  # fmt: skip
"""Type of a parameter in HLSL → class of an input slot (`MaterialSlot.CreateMaterialSlot`)."""
Document = dict[str, Any]


class Graph:
    """A sub-graph, read as Shader Graph reads it: documents between empty lines."""

    def __init__(self, path: str) -> None:
        compiled = sssgen.compile(path, "unity-shadergraph")
        self.reflection = compiled.reflection
        self.material = compiled.reflection["material"]
        self.text = compiled.files[f"{self.material}.unity-shadergraph.shadersubgraph"]
        self.hlsl = compiled.files[f"{self.material}.unity-shadergraph.hlsl"]
        self.meta = compiled.files[f"{self.material}.unity-shadergraph.hlsl.meta"]
        self.documents: list[Document] = [json.loads(text) for text in self.text.rstrip("\n").split("\n\n")]
        self.by_id: dict[str, Document] = {document["m_ObjectId"]: document for document in self.documents}
        self.graph = self.documents[0]

    def of_class(self, name: str) -> list[Document]:
        return [document for document in self.documents if class_of(document).removeprefix("Internal.") == name]

    def slots(self, node: Document, output: bool) -> list[Document]:
        slots = [self.by_id[slot["m_Id"]] for slot in node["m_Slots"]]
        return [slot for slot in slots if slot["m_SlotType"] == int(output)]

    def end(self, edge: Document, key: str) -> tuple[Document, Document]:
        """A node and its slot at an end of an edge."""
        node = self.by_id[edge[key]["m_Node"]["m_Id"]]
        (slot,) = [slot for slot in self.slots(node, key == "m_OutputSlot") if slot["m_Id"] == edge[key]["m_SlotId"]]
        return node, slot


@pytest.fixture(scope="module", params=["leaf", "ice", "jelly_cubes", "paper_lantern", "every_kind", "coat"])
def graph(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Graph:
    if request.param == "every_kind":
        return Graph(every_kind(tmp_path_factory.mktemp("graph")))
    if request.param == "coat":
        path = tmp_path_factory.mktemp("graph") / "coat.toml"
        path.write_text(COAT, encoding="utf-8")
        return Graph(str(path))
    return Graph(str(LEAF) if request.param == "leaf" else request.param)


def every_kind(folder: Path, more: str = "") -> str:
    (folder / "every_kind.sss").write_text(EVERY_KIND, encoding="utf-8")
    head = '[material]\nname = "every_kind"\nshading = "lit"\ntwo_sided = true\n'
    material = f'{head}[[surface]]\ntechnique = "every_kind.sss"\n{more}'
    (folder / "every_kind.toml").write_text(material, encoding="utf-8")
    return str(folder / "every_kind.toml")


def class_of(document: Document) -> str:
    name: str = document["m_Type"]
    return name.removeprefix("UnityEditor.ShaderGraph.")


def references(value: Any) -> list[str]:
    """Every m_Id that is an identifier; a slot's m_Id is a number."""
    if isinstance(value, dict):
        own = [value["m_Id"]] if isinstance(value.get("m_Id"), str) and value["m_Id"] else []
        return own + [name for member in value.values() for name in references(member)]
    return [name for member in value for name in references(member)] if isinstance(value, list) else []


def test_every_document_is_of_a_class_with_its_version_and_members(graph: Graph) -> None:
    assert class_of(graph.graph) == "GraphData"
    for document in graph.documents:
        version, members = CLASSES[class_of(document)]
        assert document["m_SGVersion"] == version, class_of(document)
        assert document.keys() - {"m_SGVersion", "m_Type", "m_ObjectId"} == members, class_of(document)


def test_every_reference_resolves_and_every_document_is_referred_to(graph: Graph) -> None:
    assert len(graph.by_id) == len(graph.documents)
    assert all(re.fullmatch(r"[0-9a-f]{32}", name) for name in graph.by_id)
    used = set(references(graph.documents))
    assert used == graph.by_id.keys() - {graph.graph["m_ObjectId"]}


def test_the_function_node_has_the_parameters_of_the_function(graph: Graph) -> None:
    (node,) = graph.of_class("CustomFunctionNode")
    for precision in ("float", "half"):
        (function,) = [f for f in functions(graph.hlsl) if f.name == f"{node['m_FunctionName']}_{precision}"]
        parameters = re.search(rf"void {function.name}\(([^)]*)\)", graph.hlsl)
        assert parameters is not None
        named = [part.split() for part in parameters[1].replace("half", "float").split(",")]
        inputs = [(part[0], part[1]) for part in named if part[0] != "out"]
        outputs = [(part[1], part[2]) for part in named if part[0] == "out"]
        for expected, slots in ((inputs, graph.slots(node, False)), (outputs, graph.slots(node, True))):
            got = [(class_of(slot).removesuffix("MaterialSlot"), slot["m_ShaderOutputName"]) for slot in slots]
            assert got == [(SLOTS[kind], name) for kind, name in expected]
    # Shader Graph refuses other characters in the name of a slot
    assert all(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", slot["m_DisplayName"]) for slot in graph.slots(node, False))
    assert len({slot["m_Id"] for slot in [*graph.slots(node, False), *graph.slots(node, True)]}) == len(node["m_Slots"])


def test_every_port_is_connected_once(graph: Graph) -> None:
    ends = Counter(str(edge["m_InputSlot"]) for edge in graph.graph["m_Edges"])
    assert set(ends.values()) == {1}
    connected = [graph.end(edge, "m_InputSlot") for edge in graph.graph["m_Edges"]]
    for name in ("CustomFunctionNode", "SubGraphOutputNode", "NegateNode"):
        for node in graph.of_class(name):
            own = [slot["m_ObjectId"] for end, slot in connected if end is node]
            assert own == [] or sorted(own) == sorted(slot["m_ObjectId"] for slot in graph.slots(node, False))
            assert own or name == "NegateNode"


def test_what_is_connected_fits(graph: Graph) -> None:
    """Ends of a wire have one class, or both are numbers: Shader Graph converts these. Names of outputs agree."""
    numbers = re.compile(r"(?:Vector\d|DynamicVector|Boolean)MaterialSlot")
    for edge in graph.graph["m_Edges"]:
        (source, output), (target, slot) = graph.end(edge, "m_OutputSlot"), graph.end(edge, "m_InputSlot")
        kinds = class_of(output), class_of(slot).replace("InputMaterialSlot", "MaterialSlot")
        assert kinds[0] == kinds[1] or all(map(numbers.fullmatch, kinds)), kinds
        if class_of(target) == "SubGraphOutputNode":
            assert output["m_ShaderOutputName"] == slot["m_ShaderOutputName"]
            assert class_of(source) == "CustomFunctionNode"


def test_every_property_is_used_once(graph: Graph) -> None:
    properties = [reference["m_Id"] for reference in graph.graph["m_Properties"]]
    assert [node["m_Property"]["m_Id"] for node in graph.of_class("PropertyNode")] == properties
    (category,) = graph.of_class("CategoryData")
    assert [child["m_Id"] for child in category["m_ChildObjectList"]] == properties
    sources = Counter(edge["m_OutputSlot"]["m_Node"]["m_Id"] for edge in graph.graph["m_Edges"])
    assert all(sources[node["m_ObjectId"]] == 1 for node in graph.of_class("PropertyNode"))
    declared = [*graph.reflection["uniforms"], *graph.reflection["textures"]]
    assert len(properties) == len(declared) > 0


def test_a_property_goes_to_the_parameter_of_its_name(graph: Graph) -> None:
    labels = {}
    for edge in graph.graph["m_Edges"]:
        (source, _), (_, slot) = graph.end(edge, "m_OutputSlot"), graph.end(edge, "m_InputSlot")
        if class_of(source) == "PropertyNode":
            labels[slot["m_ShaderOutputName"]] = graph.by_id[source["m_Property"]["m_Id"]]["m_DefaultReferenceName"]
    assert labels == {name: f"_{name}" for name in labels}
    assert labels.keys() == {p["name"] for p in [*graph.reflection["uniforms"], *graph.reflection["textures"]]}


def test_defaults_and_ranges_are_those_of_the_parameters(graph: Graph) -> None:
    by_name = {
        graph.by_id[p["m_Id"]]["m_DefaultReferenceName"]: graph.by_id[p["m_Id"]] for p in graph.graph["m_Properties"]
    }
    for uniform in graph.reflection["uniforms"]:
        document = by_name[f"_{uniform['name']}"]
        value, default = document["m_Value"], uniform["default"]
        if "Matrix" in class_of(document):
            size = int(uniform["type"][-1])
            got = [value[f"e{row}{column}"] for column in range(size) for row in range(size)]
        else:
            channels = "rgba" if "Color" in class_of(document) else "xyzw"
            got = [value[channel] for channel in channels[: len(default)]] if isinstance(value, dict) else [value]
        assert got == pytest.approx([float(number) for number in default]), uniform["name"]
        if uniform["range"] and uniform["type"] == "float":
            assert document["m_FloatType"] == 1
            assert document["m_RangeValues"] == dict(zip("xy", uniform["range"][:2], strict=True))


def test_the_node_finds_the_file_by_the_identifier_of_its_meta_file(graph: Graph) -> None:
    (node,) = graph.of_class("CustomFunctionNode")
    assert f"guid: {node['m_FunctionSource']}\n" in graph.meta
    assert re.fullmatch(r"[0-9a-f]{32}", node["m_FunctionSource"])
    assert node["m_SourceType"] == 0  # a file


def test_identifiers_stay_where_the_material_grows(tmp_path: Path) -> None:
    """Graphs that use the sub-graph find its ports by these."""
    before, again = Graph(every_kind(tmp_path)), Graph(every_kind(tmp_path))
    assert before.text == again.text
    after = Graph(every_kind(tmp_path, '[[surface]]\ntechnique = "base_color"\n'))

    def guids(graph: Graph) -> dict[str, str]:
        documents = [graph.by_id[p["m_Id"]] for p in graph.graph["m_Properties"]]
        return {document["m_DefaultReferenceName"]: document["m_Guid"]["m_GuidSerialized"] for document in documents}

    assert guids(before).items() < guids(after).items()
    assert len(set(guids(after).values())) == len(guids(after))
    assert before.meta == after.meta


def test_the_values_of_the_engine(tmp_path: Path) -> None:
    """Each port of the engine's values has its node; the position is absolute, which it is not by itself in HDRP."""
    graph = Graph(every_kind(tmp_path))
    sources = {}
    for edge in graph.graph["m_Edges"]:
        (source, output), (target, slot) = graph.end(edge, "m_OutputSlot"), graph.end(edge, "m_InputSlot")
        if class_of(target) == "CustomFunctionNode":
            space = source.get("m_Space", source.get("m_OutputChannel", ""))
            sources[slot["m_ShaderOutputName"]] = (
                class_of(source).removesuffix("Node"),
                space,
                output["m_DisplayName"],
            )
    expected = {
        "uv": ("UV", 0, "Out"), "uv2": ("UV", 1, "Out"), "P": ("Position", 4, "Out"), "N": ("NormalVector", 2, "Out"),
        "T": ("TangentVector", 2, "Out"), "B": ("BitangentVector", 2, "Out"), "V": ("ViewDirection", 2, "Out"),
        "P_object": ("Position", 0, "Out"), "N_object": ("NormalVector", 0, "Out"),
        "V_object": ("ViewDirection", 0, "Out"), "screen_uv": ("ScreenPosition", "", "Out"),
        "time": ("Time", "", "Time"), "vertex_color": ("VertexColor", "", "Out"), "Front": ("IsFrontFace", "", "Out"),
    }  # fmt: skip
    assert expected.items() <= sources.items()


def test_one_graph_includes_the_files_of_several_materials(compiler: Callable[[str], Compiler]) -> None:
    """All of them read light and declare functions, constants and types of the same names in the techniques."""
    graphs = [Graph(path) for path in (str(LEAF), "wax_mouse", "jade_ring")]
    text = "".join(graph.hlsl for graph in graphs)
    assert (
        text.count("float in_layers(uint light_layers)") == len(graphs) == len(re.findall(r"struct \w+_Surface", text))
    )
    assert errors(compiler("unity").check(Source(text, "unity-shadergraph", "library"))) == []
    for part in (r"\b(?:leaf|wax_mouse|jade_ring)_", "#ifndef SSSGEN_IN_LAYERS"):
        wrong = re.sub(part, "#if 1" if part[0] == "#" else "", text)
        assert errors(compiler("unity").check(Source(wrong, "unity-shadergraph", "library")))


PACKAGES = [
    Path(folder) / "Packages" / "com.unity.shadergraph" / "Editor"
    for folder in os.environ.get("SSSGEN_UNITY_INCLUDES", "").split(os.pathsep)
    if folder and (Path(folder) / "Packages" / "com.unity.shadergraph" / "Editor").is_dir()
]


@pytest.mark.skipif(not PACKAGES, reason="SSSGEN_UNITY_INCLUDES names no com.unity.shadergraph with its Editor folder")
def test_the_table_of_classes_is_that_of_the_package() -> None:
    sources = {path.stem: path.read_text(encoding="utf-8") for path in PACKAGES[0].rglob("*.cs")}
    for name, (version, _) in CLASSES.items():
        text = sources[name.rpartition(".")[2]]
        assert re.search(rf"class {name.rpartition('.')[2]}\b", text), name
        namespace = "UnityEditor.ShaderGraph" + (".Internal" if "." in name else "")
        assert re.search(rf"namespace {re.escape(namespace)}\s*{{", text), name
        declared = re.findall(r"int latestVersion => (\d+)", text)
        assert (int(declared[0]) if declared else 0) == version, name
