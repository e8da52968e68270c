"""One function in the drivers: the author's text with its probes, and the translations of both.

A probe is a function that returns one output (`plain_probes`). The author's text runs in the first version of GLSL that
the driver accepts; a translation may need a text for each probe, where variables at file scope become parameters.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sssgen.analyse.verify.plain_probes import FunctionProbes, Probe
from sssgen.analyse.verify.stage_variables import Plain, without_functions
from sssgen.ir.nodes import Module, Param, Span
from sssgen.ir.types import Sampler
from sssgen.passes.reachable import keep_reachable
from sssgen.passes.stage.variables_to_parameters import variables_to_parameters
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Bound, Call, Place, Stage, Text
from sssgen.run.backends import call_program as calls
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.glsl_reread import draw_reread
from sssgen.support.diagnostics import SssgenError
from sssgen.targets import registry
from sssgen.targets.runtime.numpy_textures import Texture

_SCREEN = "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }"
VERSIONS = ("450 core", "330 core", "300 es")
"""The versions to try, where the text has no `#version` or one before 3.30."""
NEWEST = 450
"""Drivers without a GPU, and those of macOS, have no later version: its texts are tried as the latest of `VERSIONS`."""


class Inputs(NamedTuple):
    """One round."""

    values: dict[str, Array]
    """By the probe's parameter or the uniform's name, lanes last."""
    textures: dict[str, Texture]

    @property
    def lanes(self) -> int:
        """Their number."""
        return int(next(iter(self.values.values())).shape[-1])

    def repeated(self, lane: int) -> Inputs:
        """All lanes with the inputs of this one."""
        values = {name: np.repeat(value[..., lane : lane + 1], self.lanes, -1) for name, value in self.values.items()}
        return Inputs(values, self.textures)


class _Translation(NamedTuple):
    """A translated text, and the probes in it."""

    probes: tuple[Probe, ...]
    text: Text
    names: Mapping[str, str]
    """Old name → name in the text."""


class DrivenFunction:
    """The texts of one function, and their results on the back ends."""

    def __init__(
        self, case: FunctionProbes, written: Plain, module: Module, machines: Mapping[str, BackendProcess]
    ) -> None:
        self.case, self.written, self.machines = case, written, machines
        self.texts: dict[str, list[_Translation]] = {}
        self.fragment = ""
        """The author's text as the driver has it, with a main that calls the probes; '' before the first run."""
        names = {probe.name for probe in case.probes}
        self.keys = {function.name: function.key for function in module.functions if function.name in names}
        self.written_names = {function.name for function in module.functions if function.name not in names}
        module = keep_reachable(module, list(self.keys.values()))
        # probes set the variables that are read; their initial values might need a main() that is not there
        variables = tuple([variable._replace(value=None) for variable in module.variables])
        self.module = module._replace(variables=variables)
        closed = {function.name: function.params for function in uniforms_to_parameters(self.module).functions}
        self.params: dict[str, tuple[Param, ...]] = {name: closed[name] for name in names if name in closed}

    def uniforms(self) -> dict[str, Param]:
        """The uniforms of the text that the function reads."""
        own = {leaf.name for probe in self.case.probes for leaf in probe.leaves}
        return {param.name: param for params in self.params.values() for param in params if param.name not in own}

    def join_rounds(self, rounds: Sequence[Sequence[Array]]) -> dict[str, Array]:
        """Each output of all rounds, lanes first."""
        return {
            probe.output: np.concatenate([np.moveaxis(outputs[index], -1, 0) for outputs in rounds])
            for index, probe in enumerate(self.case.probes)
        }

    def original(self, inputs: Inputs, reread: bool = False) -> list[Array]:
        """The outputs of the author's text, in the first version that the driver accepts.

        With `reread`, glslang reads the text. Where the driver accepts no version, functions that this one does not
        call are removed: the driver may refuse only those.
        """
        try:
            return self.original_of(self.written, inputs, reread)
        except SssgenError:
            called = {function.name for function in self.module.functions}
            others = {name for name in self.written_names if name not in called}
            if not others:
                raise
            alone = self.written._replace(text=without_functions(self.written.text, others))
            outputs = self.original_of(alone, inputs, reread)
            self.written = alone  # for the next rounds
            return outputs

    def original_of(self, written: Plain, inputs: Inputs, reread: bool) -> list[Array]:
        """The outputs of a text of the author, in the first version that the driver accepts."""
        number = written.version.split(" ")[0]
        versions = [written.version] if number and (int(number) >= 330 or written.is_es) else list(VERSIONS)
        if number and int(number) > NEWEST and not written.is_es:
            versions.append(VERSIONS[0])
        refusals: list[SssgenError] = []
        for version in versions:
            try:
                return self.draw_original(written, version, inputs, reread)
            except SssgenError as error:
                refusals.append(error)
        raise refusals[0]

    def draw_original(self, written: Plain, version: str, inputs: Inputs, reread: bool) -> list[Array]:
        """The outputs of the author's text, followed by the probes. Its uniforms are bound by their names."""
        probes = "\n".join(probe.text for probe in self.case.probes)
        text = Text(f"{written.for_driver(version)}\n{probes}")
        probe_calls = [
            self.call(probe, probe.name, [leaf.name for leaf in probe.leaves], inputs) for probe in self.case.probes
        ]
        target = registry.load("glsl-es-300" if version.endswith("es") else "glsl-330")
        drawing, layout = calls.drawing(target, text, probe_calls, inputs.textures)
        uniforms = self.uniforms()
        bound = {name: Bound(inputs.textures[name], Place(0, 0)) for name in uniforms if name in inputs.textures}
        bound |= {shown: bound[name] for name, shown in _elements(self.module).items() if name in bound}
        values = {name: inputs.values[name][..., 0] for name in uniforms if name in inputs.values}
        vertex = Stage(Text(f"#version {version}\n{_SCREEN}"))
        drawing = drawing._replace(vertex=vertex, textures={**drawing.textures, **bound}, values=values)
        gl = self.machines["gl"]
        self.fragment = drawing.fragment.text.text
        return calls.results(probe_calls, layout, gl.apply(draw_reread, drawing) if reread else gl.draw(drawing))

    def run_translation(self, backend: str, inputs: Inputs) -> list[Array]:
        """The outputs of the translation for a back end."""
        machine = self.machines[backend]
        outputs: list[Array] = []
        for probes, text, names in self.translations(machine.target.name):
            probe_calls = [
                self.call(probe, names.get(probe.name, probe.name), [p.name for p in self.params[probe.name]], inputs)
                for probe in probes
            ]
            outputs += machine.run(text, probe_calls, inputs.textures)
        return outputs

    def translations(self, target: str) -> list[_Translation]:
        """The texts for a target, cached."""
        if target not in self.texts:
            probes = self.case.probes
            separate = self.passes_variables(target)
            groups = [[probe] for probe in probes] if separate else [probes]
            self.texts[target] = [self.translation(target, group) for group in groups]
        return self.texts[target]

    def passes_variables(self, target: str) -> bool:
        """Whether module variables become parameters of the target's functions."""
        return bool(self.module.variables) and not registry.load(target).capabilities.module_variables

    def translation(self, target: str, probes: Sequence[Probe]) -> _Translation:
        """One text with these probes; only one, where module variables become its parameters."""
        keys = [self.keys[probe.name] for probe in probes]
        module = keep_reachable(self.module, keys)
        if self.passes_variables(target):
            module = variables_to_parameters(module, keys[0])
        compiled = transpile(module, target, "verified", "none", keys, keep=True)
        text = "\n".join([text for name, text in compiled.files.items() if not name.endswith(".json")])
        return _Translation(tuple(probes), Text(text), compiled.reflection["renames"])

    def call(self, probe: Probe, name: str, params: Sequence[str], inputs: Inputs) -> Call:
        """The call of a probe, called `name` in the text."""
        types = {param.name: param.type for param in self.params[probe.name]}
        args = tuple([inputs.values.get(param, param) for param in params])
        return Call(name, tuple([types[param] for param in params]), probe.result, args)


def _elements(module: Module) -> dict[str, str]:
    """The author's name of each texture that is an element of an array, as `maps[1]`, by its name in the IR.

    The elements of an array have the place of its declaration, and the names `maps_0`, `maps_1`, …
    """
    arrays: dict[Span, list[str]] = {}
    for uniform in module.uniforms:
        if isinstance(uniform.type, Sampler):
            arrays.setdefault(uniform.span, []).append(uniform.name)
    return {
        name: f"{names[0].partition('_0')[0]}[{index}]"
        for names in arrays.values()
        for index, name in enumerate(names)
        if "_0" in names[0]
    }
