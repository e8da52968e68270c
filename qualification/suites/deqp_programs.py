"""A case of VK-GL-CTS as a program: its text, and its runs on every back end."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from qualification.suites.deqp_cases import BOTH, Case, Value
from sssgen.analyse.verify.driven_function import DrivenFunction, Inputs
from sssgen.analyse.verify.plain_inputs import KINDS
from sssgen.analyse.verify.plain_probes import FunctionProbes, probe_functions
from sssgen.analyse.verify.stage_variables import MAIN, Plain, plain
from sssgen.analyse.verify.verification import load
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.nodes import Module
from sssgen.ir.types import Type, components, kind_of, spell
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.evaluate.evaluation import shape_of
from sssgen.support.diagnostics import failure

NEAR = 0.05
"""A float is right within this distance, plus this share of its value: the suite's own limit."""
_VERSION = re.compile(r"^#version.*", re.MULTILINE)
_EXTENSION = re.compile(r"extension (?P<name>\w+)(?: \| \w+)*(?: in (?P<stages>.*))?")
_MARK = re.compile(r"\$\{([A-Z_]+)(?::[a-z-]+)?\}")


class Answer(NamedTuple):
    """What a back end made of a case."""

    right: bool
    text: str = ""
    """The first value that is not as expected"""


def stage_text(case: Case, stage: str) -> str:
    """The text of a stage as a file: inputs and outputs are variables of the stage."""
    text = case.stages.get(BOTH) or case.stages[stage]
    is_old = case.version in ("", "100 es")
    fragment = stage == "fragment"
    inputs, outputs = ("varying", "") if is_old else ("in", "out")
    if is_old and not fragment:
        inputs = "attribute"
    lines: list[str] = []
    location = 0  # that of the color which the suite declares
    for value in case.values:
        if value.kind == "input":
            flat = "flat " if fragment and not is_old and value.type[0] in "iu" else ""
            lines.append(f"{flat}{inputs} {value.type} {value.name};")
        elif value.kind == "output":
            # a fragment shader has no matrices as outputs
            word = "" if fragment and value.type.startswith("mat") else outputs
            if word == "out" and fragment and case.version.endswith("es"):
                location += 1
                word = f"layout(location = {location}) out"
            lines.append(f"{word} {value.type} {value.name};".strip())
        elif _lacks(text, value):
            lines.append(f"uniform {value.type} {value.name};")
    declarations = "\n".join(lines)
    color = "gl_FragColor" if is_old else "dEQP_FragColor"
    shown = "" if is_old or not fragment else f"layout(location = 0) out mediump vec4 {color};\n"
    position = f"{'attribute' if is_old else 'in'} highp vec4 dEQP_Position;\n"
    marks = {
        "DECLARATIONS": (shown if fragment else position) + declarations,
        "FRAGMENT_DECLARATIONS": shown + declarations,
        "VERTEX_DECLARATIONS": position + declarations,
        "FRAG_COLOR": color,
        "POSITION_FRAG_COLOR": color if fragment else "gl_Position",
        "VERTEX_OUTPUT": "gl_Position = dEQP_Position;",
    }
    text = with_extensions(case, stage, _MARK.sub(lambda mark: marks.get(mark[1], ""), text))
    return text if case.version not in ("", "100 es") or "#version" in text else f"#version 100\n{text}"


def function_text(case: Case) -> Plain:
    """The text of a case of one stage as a function of its inputs. Raises SssgenError for members of uniforms."""
    if any("." in value.name or "[" in value.name for value in case.values):
        raise failure("the case sets members of uniforms")
    text = case.stages[BOTH]
    lines = [
        f"{'uniform ' if value.kind == 'uniform' else ''}{value.type} {value.name};"
        for value in case.values
        if value.kind != "uniform" or _lacks(text, value)
    ]
    marks = {"DECLARATIONS": "\n".join(lines), "POSITION_FRAG_COLOR": "gl_FragColor"}
    if case.version not in ("", "100 es") and "POSITION_FRAG_COLOR" in text:
        marks["POSITION_FRAG_COLOR"] = "dEQP_FragColor"
        marks["DECLARATIONS"] += "\nvec4 dEQP_FragColor;"
    return plain(with_extensions(case, "fragment", _MARK.sub(lambda mark: marks.get(mark[1], ""), text)))


def with_extensions(case: Case, stage: str, text: str) -> str:
    """A stage's text with a directive for each extension that the case requires in it; of several the first one."""
    needed = [_EXTENSION.fullmatch(line) for line in case.requires]
    names = [match["name"] for match in needed if match and stage in (match["stages"] or stage)]
    directives = "".join([f"\n#extension {name} : require" for name in names])
    return _VERSION.sub(lambda match: match[0] + directives, text, count=1)


def _lacks(text: str, uniform: Value) -> bool:
    """Whether a text does not declare a uniform itself."""
    return re.search(rf"\buniform\b[^;{{}}]*\b{uniform.name}\b", text) is None and "." not in uniform.name


class CaseProgram:
    """A case with values, on the back ends. Raises SssgenError where the front end refuses it."""

    def __init__(self, case: Case, machines: Mapping[str, BackendProcess]) -> None:
        written = function_text(case)
        module = load(written.text, case.name, written.version)
        functions = [part for part in module.functions if part.name == MAIN]
        (probes,) = probe_functions(module, functions, written.text)
        if probes.reason:
            raise failure(f"the runner cannot call it: {probes.reason}")
        self.skipped = "it counts lines" if "__LINE__" in written.text else ""
        """Why the runner cannot run it; '' where it can."""
        self.outputs = {value.name: value for value in case.values if value.kind == "output"}
        self.probes = tuple([probe for probe in probes.probes if probe.output in self.outputs])
        text = written.text + "\n".join(probe.text for probe in self.probes)
        self.function = DrivenFunction(
            FunctionProbes(probes.function, self.probes), written, load(text, case.name, written.version), machines
        )
        given = {value.name: value for value in case.values if value.kind != "output"}
        given |= self.initial_values(module, given)
        leaves = self.probes[0].leaves if self.probes else ()
        types = {leaf.name: (leaf.type, leaf.path) for leaf in leaves}
        uniforms = self.function.uniforms()
        types |= {name: (param.type, name) for name, param in uniforms.items()}
        count = max(len(value.rows) for value in case.values)
        # a uniform has one value in each run
        self.runs = [range(row, row + 1) for row in range(count)] if uniforms else [range(count)]
        self.inputs = [
            Inputs({name: numbers(type_, given.get(path), rows) for name, (type_, path) in types.items()}, {})
            for rows in self.runs
        ]

    def initial_values(self, module: Module, given: Mapping[str, Value]) -> dict[str, Value]:
        """The values that the text gives to its own variables: a probe sets all that a function reads."""
        values = {}
        for variable in module.variables:
            if variable.value is not None and variable.name not in given:
                numbers = constant_numbers(variable.value)
                if numbers is None:
                    self.skipped = f"the initial value of {variable.name} is no constant"
                else:
                    row = tuple(map(float, numbers))
                    values[variable.name] = Value("initial", spell(variable.type), variable.name, (row,))
        return values

    def original(self) -> Answer:
        """What the driver makes of the author's text."""
        return self.answer([self.function.original(inputs) for inputs in self.inputs])

    def translation(self, backend: str) -> Answer:
        """What a back end makes of its translation."""
        return self.answer([self.function.run_translation(backend, inputs) for inputs in self.inputs])

    def answer(self, results: list[list[Array]]) -> Answer:
        """Whether the outputs of all runs are as expected."""
        for rows, outputs in zip(self.runs, results, strict=True):
            for probe, result in zip(self.probes, outputs, strict=True):
                expected = numbers(probe.result, self.outputs[probe.output], rows)
                apart = np.abs(result.astype(np.float64) - expected.astype(np.float64))
                limit = NEAR + NEAR * np.abs(expected) if kind_of(probe.result) == "float" else 0.0
                if not (apart <= limit).all():
                    return Answer(False, f"{probe.output} is {result.tolist()}, {expected.tolist()} is expected")
        return Answer(True)


def numbers(type_: Type, value: Value | None, rows: range) -> Array:
    """The numbers of a value in some rows, lanes last; zeros for a variable that the case does not set."""
    given = value.rows if value else ((0.0,) * components(type_),)
    lanes = np.array([given[min(row, len(given) - 1)] for row in rows], np.float64)
    return lanes.T.reshape(*shape_of(type_), len(rows)).astype(KINDS[kind_of(type_)])
