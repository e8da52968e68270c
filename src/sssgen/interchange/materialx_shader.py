"""The inputs of one shader of a MaterialX document, and the report of what became of each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sssgen.interchange.graph_values import Constant, Normal, TexelGrid, Texture, Value, mean, quantity_of
from sssgen.interchange.imported_material import Element
from sssgen.interchange.mapping_report import Report
from sssgen.interchange.materialx_graph import Graph, Scope, apply_node
from sssgen.interchange.record_limits import BRIGHTEST
from sssgen.interchange.surface_model import Quantity

_MOST = {"emission": BRIGHTEST, "thickness": 1e6}
"""Field → its largest number, where that is not 1."""


class Shader:
    """Reads the inputs of a shader node. Each input that the document sets has one row in the report."""

    def __init__(self, graph: Graph, node: Any, scope: Scope | None, report: Report) -> None:
        self.graph, self.node, self.scope, self.report = graph, node, scope, report
        self.elements: dict[str, list[Element]] = {}
        """Field of the record → the inputs that it comes from"""
        self.aliases: Mapping[str, str] = {}
        """Name of an input for the methods below → its name in the shader, where that is another"""
        self._set = {part.getName() for part in node.getInputs()}
        self._reported: set[str] = set()
        self._estimated: set[str] = set()

    def path(self, name: str) -> str:
        """The path of an input in the document."""
        return f"/{self.node.getNamePath()}/{name}"

    def value(self, name: str, field: str) -> Value:
        """The value of an input that becomes a field of the record."""
        name = self.aliases.get(name, name)
        value = self.graph.input(self.node, name, self.scope)
        if name in self._set and name not in self._reported:
            self._reported.add(name)
            if value.cause:
                self._report_estimate(name, value)
            else:
                self.elements.setdefault(field, []).append(Element(self.path(name), _value_text(value)))
        return value

    def _report_estimate(self, name: str, value: Value) -> None:
        self._estimated.add(name)
        driver = f"graph with {value.cause}"
        if isinstance(value, Texture | TexelGrid):
            text = f"{value.cause} is estimated: {_value_text(value)}"
            self.report.add_approximation(self.path(name), driver, text)
        else:
            text = f"{value.cause} has no form in a material; the mean takes its place: {_value_text(value)}"
            self.report.add_omission(self.path(name), driver, text)

    def numbers(self, name: str, field: str) -> tuple[float, ...]:
        """An input that the record has without a picture: of a picture, the mean."""
        value = self.value(name, field)
        if isinstance(value, Texture | TexelGrid):
            self.report_approximation(name, f"the mean of the picture, {_numbers(value)}")
        return mean(value)

    def shares(self, name: str, field: str) -> tuple[float, ...]:
        """`numbers` from 0 to 1, and a row of the report where the document has others."""
        given = self.numbers(name, field)
        limited = tuple(min(max(part, 0.0), 1.0) for part in given)
        if limited != given:
            self.report_approximation(name, f"limited to 0 to 1: {_numbers(Constant(limited))}")
        return limited

    def number(self, name: str, field: str) -> float:
        """The first component of `numbers`."""
        return self.numbers(name, field)[0]

    def quantity(self, name: str, field: str, *, color: bool = False) -> Quantity:
        """An input as a quantity of the record."""
        return self.as_quantity(self.value(name, field), field, color=color)

    def product(self, weight: str, name: str, field: str) -> Quantity:
        """A colour times the input that is its weight."""
        return self.as_quantity(self.weighted_value(weight, name, field), field, color=True)

    def weighted_value(self, weight: str, name: str, field: str) -> Value:
        """The value of an input times that of its weight."""
        return self.compute("multiply", self.value(name, field), self.value(weight, field))

    def compute(self, category: str, *values: Value) -> Value:
        """The result of a node that computes with values."""
        return apply_node(category, values, self.node.getNamePath())

    def as_quantity(self, value: Value, field: str, *, color: bool = False) -> Quantity:
        """A value as a quantity; `field` names the picture that is written for it."""
        return quantity_of(value, f"{self.node.getName()}_{field}", color, _MOST.get(field, 1.0))

    def normal(self, name: str, field: str) -> Quantity:
        """A normal map and its strength."""
        name = self.aliases.get(name, name)
        value = self.graph.input(self.node, name, self.scope)
        is_map = isinstance(value, Normal) and not value.cause
        if name in self._set:
            self._reported.add(name)
            if is_map:
                self.elements.setdefault(field, []).append(Element(self.path(name), _value_text(value)))
            else:
                cause = value.cause or self.node.getNamePath()
                text = f"{cause} is not a normal map; bake one"
                self.report.add_omission(self.path(name), f"graph with {cause}", text)
        if not isinstance(value, Normal) or value.texels is None or not is_map:
            return Quantity((1.0,))
        quantity = quantity_of(value.texels, f"{self.node.getName()}_{field}", False)
        return Quantity((value.strength,), quantity.image)

    def report_approximation(self, name: str, became: str, error: str = "") -> None:
        """Reports an input that the record keeps only in part, where the document sets it."""
        name = self.aliases.get(name, name)
        if name not in self._set or name in self._estimated:
            return
        self._estimated.add(name)
        self._reported.add(name)
        path = self.path(name)
        self.elements = {field: [part for part in parts if part.path != path] for field, parts in self.elements.items()}
        self.report.add_approximation(path, self._text(name), became, error)

    def report_omissions(self, reasons: Mapping[str, tuple[str, str]]) -> None:
        """Reports the inputs that have not been read: input → the input that is its weight, and the reason."""
        for element in self.node.getInputs():
            name = element.getName()
            if name in self._reported:
                continue
            self._reported.add(name)
            weight, reason = reasons.get(name, (name, "no technique has this"))
            zero = next((part for part in (weight, name) if self._is_zero(part)), "")
            if zero:
                self.report.add_mapping(self.path(name), self._text(name), f"nothing: {zero} is 0")
            else:
                self.report.add_omission(self.path(name), self._text(name), reason)

    def _text(self, name: str) -> str:
        return _value_text(self.graph.input(self.node, name, self.scope))

    def _is_zero(self, name: str) -> bool:
        value = self.graph.input(self.node, name, self.scope)
        return isinstance(value, Constant) and not any(value.values) and not value.cause


def _numbers(value: Value) -> str:
    return ", ".join(f"{part:.4g}" for part in mean(value))


def _value_text(value: Value) -> str:
    """A value for the report."""
    if isinstance(value, Texture):
        factor = value.quantity.factor
        times = "" if set(factor) == {1.0} else f" × {_numbers(Constant(factor))}"
        return f"{value.image.picture.name} {value.image.channels}{times}"
    if isinstance(value, TexelGrid):
        height, width = value.texels.shape[:2]
        return f"{width} × {height} texels"
    if isinstance(value, Normal):
        return "the surface's normal" if value.texels is None else _value_text(value.texels)
    return _numbers(value)
