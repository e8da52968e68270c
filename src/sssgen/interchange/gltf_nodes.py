"""The nodes of a glTF file's scene, with their transforms."""

from __future__ import annotations

import numpy as np

from sssgen.interchange.gltf_json import JsonElement
from sssgen.scene.arrays import Array


def node_transforms(root: JsonElement) -> list[tuple[JsonElement, Array]]:
    """The nodes of the file's scene with their transforms to world space, (4, 4) for column vectors.

    Raises SssgenError for nodes in a circle.
    """
    nodes = root.objects("nodes")
    scenes = root.objects("scenes")
    if scenes:
        scene = root.reference("scene", scenes, "scene") if root.has("scene") else scenes[0]
        tops = [_node(index, nodes) for index in scene.items("nodes")]
    else:
        children = {_node(index, nodes).path for node in nodes for index in node.items("children")}
        tops = [node for node in nodes if node.path not in children]
        if nodes and not tops:
            raise nodes[0].fault("the nodes form a circle", "export the file again")
    placed: list[tuple[JsonElement, Array]] = []
    seen: set[str] = set()
    waiting = [(node, np.eye(4)) for node in reversed(tops)]
    while waiting:
        node, above = waiting.pop()
        if node.path in seen:
            raise node.fault("the node has two parents, or is its own ancestor", "export the file again")
        seen.add(node.path)
        matrix = above @ _local(node)
        placed.append((node, matrix))
        waiting += [(_node(index, nodes), matrix) for index in reversed(node.items("children"))]
    return placed


def _node(index: JsonElement, nodes: list[JsonElement]) -> JsonElement:
    number = index.value
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(nodes):
        raise index.fault(f"there is no node {number!r:.20}", f"the file has {len(nodes)}")
    return nodes[number]


def _local(node: JsonElement) -> Array:
    if node.has("matrix"):
        return np.array(node.vector("matrix", [0.0] * 16)).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = node.vector("rotation", (0.0, 0.0, 0.0, 1.0), -1.001, 1.001)
    length = np.sqrt(x * x + y * y + z * z + w * w) or 1.0
    x, y, z, w = x / length, y / length, z / length, w / length
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    matrix[:3, :3] = rotation * np.array(node.vector("scale", (1.0, 1.0, 1.0)))
    matrix[:3, 3] = node.vector("translation", (0.0, 0.0, 0.0))
    return matrix
