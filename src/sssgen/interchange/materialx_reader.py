"""Reads MaterialX documents: each material with a shader that is known becomes a record."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sssgen.interchange.imported_material import ImportedMaterial, check_name
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.materialx_document import MaterialXDocument
from sssgen.interchange.materialx_graph import Graph, Scope
from sssgen.interchange.materialx_shader import Shader
from sssgen.interchange.materialx_surfaces import SURFACES
from sssgen.support.diagnostics import failure
from sssgen.support.paths import posix


def read(path: str, report: Report, name: str = "", top: str = "") -> list[ImportedMaterial]:
    """The materials of a document; with `name`, that one alone.

    Includes and pictures lie in the folder `top`, by default that of the document. Adds to the report what is left out.
    Raises SssgenError where a graph is wrong, a file is missing, or no material has a shader that is read.
    """
    source = MaterialXDocument(path, top)
    graph = Graph(source)
    shaders = list(_shaders(source, graph))
    check_name(name, [title for title, _, _ in shaders], posix(path))
    result: list[ImportedMaterial] = []
    for index, (title, node, scope) in enumerate(shaders):
        if name not in ("", title, str(index)):
            continue
        if node.getCategory() not in SURFACES:
            reason = f"the shader '{node.getCategory()}' is not read: {', '.join(SURFACES)} are"
            report.add_omission(f"/{node.getNamePath()}", node.getCategory(), reason)
            continue
        if node.getNodeDef() is None:
            raise graph.unknown(node)
        shader = Shader(graph, node, scope, report)
        model = SURFACES[node.getCategory()](shader, title)
        result.append(ImportedMaterial(model, {field: parts for field, parts in shader.elements.items() if parts}))
    if not result:
        refused = sorted({row.value for row in report.rows})
        hint = f"{'its shaders are ' + ', '.join(refused) + '; ' if refused else ''}read are {', '.join(SURFACES)}"
        raise failure("the document has no material that can be read", hint, posix(path))
    return result


def _shaders(source: MaterialXDocument, graph: Graph) -> Iterator[tuple[str, Any, Scope | None]]:
    """The name, the shader node and its scope of each material; of a document without materials, of each shader."""
    module, document = source.module, source.document
    materials = document.getMaterialNodes()
    for material in materials:
        element = material.getInput("surfaceshader")
        if element is not None:
            yield material.getName(), *_shader(source, graph, material, element)
    if not materials:
        for node in document.getNodes():
            if node.getType() == module.SURFACE_SHADER_TYPE_STRING:
                yield node.getName(), node, None


def _shader(source: MaterialXDocument, graph: Graph, material: Any, element: Any) -> tuple[Any, Scope | None]:
    """The shader of a material; where a graph of the document defines its node, the shader in that graph."""
    node, scope = graph.node_of(element)
    if node is None:
        raise source.error(element, f"the material '{material.getName()}' has no shader", "connect a shader node")
    inner, inner_scope = node, scope
    while inner is not None and inner.getCategory() not in SURFACES:
        definition = inner.getNodeDef()
        implementation = definition.getImplementation() if definition is not None else None
        if implementation is None or not implementation.isA(source.module.NodeGraph):
            return node, scope
        inner, inner_scope = graph.node_of(implementation.getOutputs()[0], Scope(inner, inner_scope))
    return (node, scope) if inner is None else (inner, inner_scope)
