"""Evaluates the graphs of a MaterialX document: what an input of a shader has as its value."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

from sssgen.interchange.graph_operations import COMPARISONS, MEANS, OPERATIONS
from sssgen.interchange.graph_values import (
    Constant,
    Coordinates,
    Normal,
    TexelGrid,
    Texture,
    Value,
    Words,
    estimate,
    join_components,
    mean,
    pointwise,
    scale_texture,
    select_components,
    with_cause,
)
from sssgen.interchange.materialx_document import MaterialXDocument
from sssgen.interchange.surface_model import Image, Picture, Quantity, Wrap
from sssgen.interchange.texture_files import read_picture
from sssgen.support.diagnostics import SssgenError, did_you_mean

COMPONENTS = {
    "float": 1, "integer": 1, "boolean": 1, "color3": 3, "color4": 4, "vector2": 2, "vector3": 3, "vector4": 4,
    "matrix33": 9, "matrix44": 16,
}  # fmt: skip
_WORDS = ("string", "filename", "geomname")
_CHANNELS = {"float": "r", "vector2": "rg", "color3": "rgb", "vector3": "rgb", "color4": "rgba", "vector4": "rgba"}
_LINEAR = ("", "lin_rec709", "lin_srgb", "none", "raw", "linear")
_MAX_GRAPHS = 32
"""How deeply graphs may be nested in each other."""
_UV_NAMES = {"": 0, "UV0": 0, "UV1": 1, "st": 0, "uv": 0, "map1": 0, "UVMap": 0, "st0": 0, "st1": 1, "uv1": 1}
"""Set of texture coordinates by the usual names of the geometric property."""


Key: TypeAlias = tuple[str, str, tuple[str, ...]]
"""A node or graph, its output, and the key of the scope"""


class Scope(NamedTuple):
    """A graph that is being evaluated: `owner` has the inputs that its nodes name as `interfacename`."""

    owner: Any
    """The node that the graph implements, or the graph itself"""
    outer: Scope | None
    bound: Value | None = None
    """Takes the place of the owner's input `in`"""

    @property
    def key(self) -> tuple[str, ...]:
        """What tells this evaluation from others: the owners from the inside out."""
        bound = () if self.bound is None else (str(id(self.bound)),)
        return (self.owner.getNamePath(), *bound, *(self.outer.key if self.outer else ()))


class Graph:
    """Evaluates inputs of nodes. Errors are SssgenErrors with the element's place and path."""

    def __init__(self, source: MaterialXDocument) -> None:
        self.source = source
        self._ready: dict[Key, Value] = {}
        self._active: list[Key] = []
        self._pictures: dict[str, Picture] = {}

    def input(self, node: Any, name: str, scope: Scope | None = None) -> Value:
        """The value of a node's input; where it is not set, the default of the node's definition.

        Lengths are metres and angles degrees where the document states a unit; colours are linear sRGB.
        """
        element = node.getInput(name)
        return self._default(node, name) if element is None else self._port(element, scope)

    def _port(self, element: Any, scope: Scope | None) -> Value:
        """The value of an input or an output."""
        if interface := element.getInterfaceName():
            return self._interface(element, interface, scope)
        if element.getNodeGraphString() or element.getNodeName():
            return self._connection(element, scope)
        if element.hasValueString():
            return self._literal(element)
        return self._default(element.getParent(), element.getName())

    def _interface(self, element: Any, name: str, scope: Scope | None) -> Value:
        if scope is None:
            raise self.source.error(element, f"the interface input '{name}' is used outside a graph")
        if scope.bound is not None and name == "in":
            return scope.bound
        owner = scope.owner
        declared = owner.getInput(name)
        if declared is not None:
            self._check_type(element, declared.getType(), f"the interface input '{name}'")
            return self._port(declared, scope.outer)
        definition = owner.getNodeDef()
        if definition is None or definition.getActiveInput(name) is None:
            names = [port.getName() for port in owner.getInputs()]
            raise self.source.error(element, f"the graph has no interface input '{name}'", did_you_mean(name, names))
        return self._default(owner, name)

    def node_of(self, element: Any, scope: Scope | None = None) -> tuple[Any, Scope | None]:
        """The node that an input or output is connected with, through graphs; None where it has no connection."""
        if scope is not None and len(scope.key) > _MAX_GRAPHS:
            raise self.source.error(element, "the graphs are nested too deeply: one contains itself")
        if (interface := element.getInterfaceName()) and scope is not None:
            declared = scope.owner.getInput(interface)
            return (None, None) if declared is None else self.node_of(declared, scope.outer)
        if not (element.getNodeGraphString() or element.getNodeName()):
            return None, None
        child = self._child(element)
        if child.isA(self.source.module.Node):
            self._check_type(element, child.getType(), f"the node '{child.getName()}'")
            return child, scope
        return self.node_of(self._graph_port(child, element.getOutputString(), element), Scope(child, scope))

    def _connection(self, element: Any, scope: Scope | None) -> Value:
        child, output = self._child(element), element.getOutputString()
        if child.isA(self.source.module.Node):
            return self._node(child, output, scope, element)
        return self._graph_output(child, output, Scope(child, scope), element)

    def _child(self, element: Any) -> Any:
        """The node or graph that an input or output is connected with."""
        module = self.source.module
        container = element.getParent()
        if element.isA(module.Input):
            container = container.getParent()
        name = element.getNodeGraphString() or element.getNodeName()
        child = container.getChild(name)
        if child is None or not (child.isA(module.Node) or child.isA(module.NodeGraph)):
            kind = "graph" if element.getNodeGraphString() else "node"
            names = [part.getName() for part in container.getChildren()]
            raise self.source.error(element, f"there is no {kind} '{name}'", did_you_mean(name, names))
        return child

    def _graph_port(self, graph: Any, output: str, element: Any) -> Any:
        """An output of a graph; without a name, its only one."""
        port = self._output(graph.getOutputs(), output, element, f"the graph '{graph.getName()}'")
        if element.getType() != "multioutput":
            self._check_type(element, port.getType(), f"the output '{port.getName()}'")
        return port

    def _output(self, ports: Sequence[Any], name: str, element: Any, owner: str) -> Any:
        """The output of a name; without a name, the first."""
        outputs = {port.getName(): port for port in ports}
        port = outputs.get(name) if name else next(iter(outputs.values()), None)
        if port is None:
            hint = did_you_mean(name, outputs) or f"outputs: {', '.join(outputs) or 'none'}"
            raise self.source.error(element, f"{owner} has no output '{name}'", hint)
        return port

    def _graph_output(self, graph: Any, output: str, scope: Scope, element: Any) -> Value:
        if len(scope.key) > _MAX_GRAPHS:
            raise self.source.error(element, "the graphs are nested too deeply: one contains itself")
        port = self._graph_port(graph, output, element)
        return self._compute_once(
            (graph.getNamePath(), port.getName(), scope.key), element, lambda: self._port(port, scope)
        )

    def _node(self, node: Any, output: str, scope: Scope | None, element: Any) -> Value:
        definition = node.getNodeDef()
        if definition is None:
            raise self.unknown(node)
        owner = f"the node '{node.getName()}'"
        port = self._output(definition.getActiveOutputs(), output, element, owner)
        self._check_type(element, port.getType(), owner)
        key = (node.getNamePath(), port.getName(), scope.key if scope else ())
        return self._compute_once(key, element, lambda: self._node_value(node, port, scope))

    def _compute_once(self, key: Key, element: Any, compute: Callable[[], Value]) -> Value:
        """A value that is computed once. Raises SssgenError where its computation needs itself."""
        if key not in self._ready:
            if key in self._active:
                circle = [path for path, _, _ in self._active[self._active.index(key) :]] + [key[0]]
                raise self.source.error(element, f"the graph runs in a circle: {' ← '.join(circle)}")
            self._active.append(key)
            try:
                self._ready[key] = compute()
            finally:
                self._active.pop()
        return self._ready[key]

    def unknown(self, node: Any) -> SssgenError:
        """The error for a node without a definition: its category is unknown, or its inputs have other types."""
        category = node.getCategory()
        definitions = self.source.document.getMatchingNodeDefs(category)
        same = [found for found in definitions if found.getType() == node.getType()]
        for port in node.getInputs():
            declared = [found.getActiveInput(port.getName()) for found in same]
            accepted = sorted({variant.getType() for variant in declared if variant is not None})
            if accepted and port.getType() not in accepted:
                message = f"the types do not match: '{port.getName()}' is {' or '.join(accepted)}, not {port.getType()}"
                return self.source.error(port, message)
        if definitions:
            types = ", ".join(f"{port.getName()} {port.getType()}" for port in node.getInputs())
            message = f"no '{category}' of type {node.getType()} has these inputs: {types or 'none'}"
            variants = sorted({definition.getType() for definition in definitions})
            return self.source.error(node, message, f"'{category}' exists with the types {', '.join(variants)}")
        names = {definition.getNodeString() for definition in self.source.document.getNodeDefs()}
        return self.source.error(node, f"unknown node '{category}'", did_you_mean(category, names))

    def _check_type(self, element: Any, given: str, what: str) -> None:
        if element.getType() != given:
            message = f"the types do not match: {element.getType()} is expected, {what} is {given}"
            raise self.source.error(element, message, "insert a convert or extract node")

    # Constants

    def _literal(self, element: Any) -> Value:
        kind, text = element.getType(), element.getValueString()
        if kind in _WORDS:
            return Words(element.getResolvedValueString() if kind == "filename" else text, element)
        if kind not in COMPONENTS:
            raise self.source.error(element, f"a value of the type '{kind}' is not read")
        try:
            values = _numbers(text)
        except ValueError:
            values = ()
        if len(values) != COMPONENTS[kind] or not all(map(math.isfinite, values)):
            expected = "a number" if COMPONENTS[kind] == 1 else f"{COMPONENTS[kind]} numbers with commas"
            raise self.source.error(element, f"'{text}' is not a value of the type {kind}", f"it is {expected}")
        value = self._with_unit(element, values)
        if kind in ("color3", "color4"):
            return self._linear(value, element.getActiveColorSpace(), kind, element)
        return value

    def _with_unit(self, element: Any, values: tuple[float, ...]) -> Constant:
        """Lengths in metres and angles in degrees, where the element states a unit."""
        unit, kind = element.getUnit(), element.getUnitType()
        base = {"distance": "meter", "angle": "degree"}.get(kind)
        if unit and base:
            module = self.source.module
            units = self.source.document.getUnitTypeDef(kind)
            converter = module.LinearUnitConverter.create(units)
            if unit not in converter.getUnitScale():
                raise self.source.error(element, f"unknown unit '{unit}'", did_you_mean(unit, converter.getUnitScale()))
            return Constant(tuple(converter.convert(value, unit, base) for value in values))
        return Constant(values)

    def _default(self, node: Any, name: str) -> Value:
        definition = node.getNodeDef()
        declared = definition.getActiveInput(name) if definition is not None else None
        if declared is None:
            raise self.source.error(node, f"the input '{name}' has neither a value nor a connection")
        if property_ := declared.getDefaultGeomPropString():
            return _geometry(property_, node.getNamePath())
        if declared.hasValueString():
            return self._literal(declared)
        if declared.getType() in _WORDS:
            return Words("", declared)
        return Constant((0.0,) * COMPONENTS.get(declared.getType(), 1))

    # Nodes

    def _node_value(self, node: Any, port: Any, scope: Scope | None) -> Value:
        category, path = node.getCategory(), node.getNamePath()
        if special := _SPECIAL.get(category):
            return special(self, node, port, scope)
        if category.startswith("separate"):
            index = [output.getName() for output in node.getNodeDef().getActiveOutputs()].index(port.getName())
            return select_components(self.input(node, "in", scope), [index], path)
        if category.startswith("combine"):
            names = [declared.getName() for declared in node.getNodeDef().getActiveInputs()]
            return join_components([self.input(node, name, scope) for name in names], path)
        if category in COMPARISONS:
            return self._comparison(node, scope)
        if operation := OPERATIONS.get(category):
            return apply_node(category, [self.input(node, name, scope) for name in operation.inputs], path)
        implementation = node.getNodeDef().getImplementation()
        if implementation is not None and implementation.isA(self.source.module.NodeGraph):
            return self._graph_output(implementation, port.getName(), Scope(node, scope), port)
        return self._procedural(node, port, scope)

    def _comparison(self, node: Any, scope: Scope | None) -> Value:
        first, second = (self.input(node, name, scope) for name in ("value1", "value2"))
        compare = COMPARISONS[node.getCategory()]
        path = node.getNamePath()
        if isinstance(first, Constant) and isinstance(second, Constant):
            chosen = pointwise(compare, [first, second], path)
            value = self.input(node, "in1" if all(mean(chosen)) else "in2", scope)
            return with_cause(value, chosen.cause) if chosen.cause else value
        share = pointwise(compare, [first, second], path)
        operands = [share, self.input(node, "in1", scope), self.input(node, "in2", scope)]
        return pointwise(lambda share, a, b: share * a + (1.0 - share) * b, operands, path)

    def _procedural(self, node: Any, port: Any, scope: Scope | None) -> Value:
        """The mean of a node that depends on the place on the surface, or that has no numbers."""
        path, kind = node.getNamePath(), port.getType()
        if node.getCategory() == "convert":  # of a boolean or an integer
            return self.input(node, "in", scope)
        if kind not in COMPONENTS:
            raise self.source.error(node, f"a node '{node.getCategory()}' of type {kind} is not read here")
        declared = {part.getName() for part in node.getNodeDef().getActiveInputs()}
        if "pivot" in declared and "amplitude" in declared:
            return estimate(self.input(node, "pivot", scope), path)
        return Constant((MEANS.get(node.getCategory(), 0.0),) * COMPONENTS[kind], path)

    def _ramp(self, node: Any, port: Any, scope: Scope | None) -> Value:
        """The middle of a ramp."""
        names = [part.getName() for part in node.getNodeDef().getActiveInputs() if part.getName().startswith("value")]
        ends = [self.input(node, name, scope) for name in names]
        path = node.getNamePath()
        return estimate(pointwise(lambda *parts: sum(parts) / len(parts), ends, path), path)

    def _extract(self, node: Any, port: Any, scope: Scope | None) -> Value:
        index = int(mean(self.input(node, "index", scope))[0])
        count = COMPONENTS.get(node.getInput("in").getType() if node.getInput("in") else "color3", 1)
        if not 0 <= index < count:
            raise self.source.error(node, f"the index {index} is not below {count}")
        return select_components(self.input(node, "in", scope), [index], node.getNamePath())

    def _texcoord(self, node: Any, port: Any, scope: Scope | None) -> Value:
        return Coordinates(int(mean(self.input(node, "index", scope))[0]))

    def _property(self, node: Any, port: Any, scope: Scope | None) -> Value:
        name = self.input(node, "geomprop", scope)
        if port.getType() == "vector2" and isinstance(name, Words) and name.text in _UV_NAMES:
            return Coordinates(_UV_NAMES[name.text])
        return estimate(self.input(node, "default", scope), node.getNamePath())

    def _normal_map(self, node: Any, port: Any, scope: Scope | None) -> Value:
        texels = self.input(node, "in", scope)
        strength = self.input(node, "scale", scope)
        path = node.getNamePath()
        cause = strength.cause if isinstance(strength, Constant) else path
        if isinstance(texels, Texture | TexelGrid):
            return Normal(texels, mean(strength)[0], texels.cause or cause)
        return Normal(cause=texels.cause or path)

    def _rotation(self, node: Any, port: Any, scope: Scope | None) -> Value:
        place, angle = self.input(node, "in", scope), self.input(node, "amount", scope)
        radians = math.radians(mean(angle)[0])
        cosine, sine = math.cos(radians), math.sin(radians)
        turned = ((cosine, sine), (-sine, cosine))
        if isinstance(place, Coordinates):
            return _transform_coordinates(place, turned, angle.cause)
        return estimate(place, node.getNamePath()) if not isinstance(place, Constant) else place

    # Pictures

    def _image(self, node: Any, port: Any, scope: Scope | None) -> Value:
        file, place = self.input(node, "file", scope), self.input(node, "texcoord", scope)
        path, kind = node.getNamePath(), port.getType()
        assert isinstance(file, Words)
        if not file.text:
            return self.input(node, "default", scope)
        if "<" in file.text:  # tokens for one file per tile or frame
            return estimate(self.input(node, "default", scope), path)
        if kind not in _CHANNELS:
            raise self.source.error(node, f"an image of the type {kind} is not read")
        channels = _CHANNELS[kind]
        color = kind in ("color3", "color4")
        space = file.element.getActiveColorSpace() if color else ""
        image = Image(self._picture(file), channels, space == "srgb_texture", wrap=self._wrap(node, scope))
        cause = "" if node.getCategory() == "image" else path
        if not isinstance(place, Coordinates) or place.transform is None:
            return estimate(Texture(Quantity((1.0,) * len(channels), image)), path)
        image = image._replace(uv_set=place.uv_set, transform=place.transform)
        texture = Texture(Quantity((1.0,) * len(channels), image), place.cause or cause)
        return texture if image.srgb else self._linear(texture, space, kind, file.element)

    def _hexagon_tiles(self, node: Any, port: Any, scope: Scope | None) -> Value:
        """The picture, tiled in a grid in place of turned hexagons."""
        value = self._image(node, port, scope)
        tiling = mean(self.input(node, "tiling", scope))
        if isinstance(value, Texture) and isinstance(place := self.input(node, "texcoord", scope), Coordinates):
            tiled = _transform_coordinates(place, ((tiling[0], 0.0), (0.0, tiling[1])), node.getNamePath())
            if tiled.transform is not None:
                image = value.image._replace(transform=tiled.transform)
                return Texture(value.quantity._replace(image=image), value.cause)
        return with_cause(value, node.getNamePath())

    def _wrap(self, node: Any, scope: Scope | None) -> Wrap:
        """How the picture goes on outside; one way for both axes."""
        if node.getNodeDef().getActiveInput("uaddressmode") is None:
            return "repeat"
        modes = [self.input(node, name, scope) for name in ("uaddressmode", "vaddressmode")]
        ends = [isinstance(mode, Words) and mode.text in ("clamp", "constant") for mode in modes]
        return "clamp" if all(ends) else "repeat"

    def _picture(self, file: Words) -> Picture:
        path = self.source.file_beside(file.element, file.text)
        if path not in self._pictures:
            self._pictures[path] = read_picture(path, self.source.place(file.element.getNamePath()))
        return self._pictures[path]

    def _linear(self, value: Constant | Texture, space: str, kind: str, element: Any) -> Value:
        """A colour of a colour space as linear sRGB, by MaterialX's own graph for that space."""
        if space in _LINEAR:
            return value
        definition = self.source.document.getNodeDef(f"ND_{space}_to_lin_rec709_{kind}")
        graph = definition.getImplementation() if definition is not None else None
        if graph is None:
            names = {
                found.getNodeString().removesuffix("_to_lin_rec709")
                for found in self.source.document.getNodeDefs()
                if found.getNodeGroup() == "colortransform"
            }
            raise self.source.error(element, f"unknown colour space '{space}'", did_you_mean(space, names))
        return self._port(graph.getOutputs()[0], Scope(graph, None, value))


_SPECIAL: dict[str, Callable[[Graph, Any, Any, Scope | None], Value]] = {
    "constant": lambda graph, node, port, scope: graph.input(node, "value", scope),
    "dot": lambda graph, node, port, scope: graph.input(node, "in", scope),
    "extract": Graph._extract,
    "texcoord": Graph._texcoord,
    "geompropvalue": Graph._property,
    "geompropvalueuniform": Graph._property,
    "normal": lambda graph, node, port, scope: Normal(),
    "normalmap": Graph._normal_map,
    "rotate2d": Graph._rotation,
    "image": Graph._image,
    "hextiledimage": Graph._hexagon_tiles,
    "ramplr": Graph._ramp,
    "ramptb": Graph._ramp,
    "splitlr": Graph._ramp,
    "splittb": Graph._ramp,
}


def apply_node(category: str, operands: Sequence[Value], path: str) -> Value:
    """The result of a node of `OPERATIONS`; `path` is named where it is a mean."""
    if (simple := _direct_result(category, operands)) is not None:
        return simple
    return pointwise(OPERATIONS[category].function, operands, path)


def _direct_result(category: str, operands: Sequence[Value]) -> Value | None:
    """The result of a node that keeps the form of its operand: a picture times constants, moved coordinates."""
    first = operands[0]
    if category == "multiply" and isinstance(operands[-1], Texture | Coordinates):
        operands = operands[::-1]
        first = operands[0]
    second = operands[-1]
    if len(operands) != 2 or not isinstance(second, Constant):
        return None
    numbers = second.values
    if isinstance(first, Texture) and category in ("multiply", "divide") and len(numbers) <= len(first.image.channels):
        if category == "divide":
            if 0.0 in numbers:
                return None
            numbers = tuple(1.0 / number for number in numbers)
        return scale_texture(first, numbers, second.cause)
    if not isinstance(first, Coordinates) or len(numbers) > 2:
        return None
    x, y = numbers if len(numbers) == 2 else numbers * 2
    if category in ("multiply", "divide"):
        if category == "divide":
            if 0.0 in (x, y):
                return None
            x, y = 1.0 / x, 1.0 / y
        return _transform_coordinates(first, ((x, 0.0), (0.0, y)), second.cause)
    if category in ("add", "subtract"):
        sign = 1.0 if category == "add" else -1.0
        offset = (first.offset[0] + sign * x, first.offset[1] + sign * y)
        return Coordinates(first.uv_set, first.matrix, offset, first.cause or second.cause)
    return None


def _transform_coordinates(
    place: Coordinates, by: tuple[tuple[float, float], tuple[float, float]], cause: str
) -> Coordinates:
    """Texture coordinates times a matrix from the left."""
    (a, b), (c, d) = by
    (e, f), (g, h) = place.matrix
    x, y = place.offset
    matrix = ((a * e + b * g, a * f + b * h), (c * e + d * g, c * f + d * h))
    return Coordinates(place.uv_set, matrix, (a * x + b * y, c * x + d * y), place.cause or cause)


def _geometry(name: str, path: str) -> Value:
    """A property of the surface that an input has by default."""
    if name in _UV_NAMES:
        return Coordinates(_UV_NAMES[name])
    if name == "Nworld":
        return Normal()
    return Constant((0.0, 0.0, 0.0), path)


def _numbers(text: str) -> tuple[float, ...]:
    """The numbers of a value; true and false are 1 and 0. Raises ValueError."""
    if text.strip() in ("true", "false"):
        return (float(text.strip() == "true"),)
    return tuple(float(part) for part in text.split(","))
