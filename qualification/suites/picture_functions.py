"""A fragment shader as a function of its pixel: how back ends without pictures compute some of them."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping

import numpy as np

from qualification.suites.deqp_cases import Value
from qualification.suites.deqp_programs import numbers
from qualification.suites.pictures import Translations, places
from sssgen.analyse.verify.driven_function import DrivenFunction, Inputs
from sssgen.analyse.verify.lane_program import Program
from sssgen.analyse.verify.plain_probes import FunctionProbes, probe_functions
from sssgen.analyse.verify.rounding_noise import noise
from sssgen.analyse.verify.stage_variables import MAIN, STAGE, plain
from sssgen.analyse.verify.verification import load
from sssgen.ir.constant_expressions import constant_numbers
from sssgen.ir.types import Sampler, spell
from sssgen.run.backends import Array
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.support.diagnostics import failure

SECONDS = 15.0
"""How long the interpreter may take"""
DRAWS = 16
"""How many runs with errors of rounding"""
STABLE = 0.001
"""How far rounding may move a stable color"""
_COORDINATES = STAGE["gl_FragCoord"][1]
_OUTPUTS = {"gl_FragColor": STAGE["gl_FragColor"][1], "gl_FragData": f"{STAGE['gl_FragData'][1]}[0]"}


class PixelFunction:
    """A program of `of_fragment` as a function. Raises SssgenError where it cannot be one."""

    def __init__(self, translations: Translations, machines: Mapping[str, BackendProcess]) -> None:
        program = translations.program
        self.size = program.size
        written = plain(program.fragment)
        module = load(written.text, "case", written.version)
        functions = [function for function in module.functions if function.name == MAIN]
        (probes,) = probe_functions(module, functions, written.text)
        if probes.reason:
            raise failure(f"the runner cannot call it: {probes.reason}")
        output = translations.reflection("glsl-330")["outputs"][0]["name"]
        shown = tuple(probe for probe in probes.probes if probe.output == _OUTPUTS.get(output, output))
        text = written.text + "\n".join(probe.text for probe in shown)
        self.function = DrivenFunction(
            FunctionProbes(probes.function, shown), written, load(text, "case", written.version), machines
        )
        y, x = np.nonzero(places(program.size))
        pixels = tuple((column + 0.5, row + 0.5, 0.5, 1.0) for row, column in zip(y.tolist(), x.tolist(), strict=True))
        given = {_COORDINATES: pixels} | {path: (row,) for path, row in translations.elements().items()}
        for variable in module.variables:
            if variable.value is not None:
                values = constant_numbers(variable.value)
                if values is None:
                    raise failure(f"the initial value of {variable.name} is not one number or vector")
                given.setdefault(variable.name, (tuple(map(float, values)),))
        types = {leaf.name: (leaf.type, leaf.path) for probe in shown for leaf in probe.leaves}
        types |= {name: (param.type, name) for name, param in self.function.uniforms().items()}
        lanes = range(len(pixels))
        self.key = self.function.keys[shown[0].name]
        self.inputs = Inputs(
            {
                name: numbers(type_, Value("input", spell(type_), path, given[path]) if path in given else None, lanes)
                for name, (type_, path) in types.items()
                if not isinstance(type_, Sampler)
            },
            dict(program.textures),
        )

    def picture(self, backend: str) -> Array:
        """The picture, which is known at `places`. Raises SssgenError."""
        (result,) = self.function.run_translation(backend, self.inputs)
        picture = np.zeros((*self.size[::-1], 4), np.float32)
        picture[places(self.size)] = np.moveaxis(np.atleast_2d(result), -1, 0)
        return picture

    def stable(self) -> Array:
        """(height, width): the places whose color depends neither on rounding nor on what GLSL leaves undefined.

        None are where the interpreter takes too long.
        """
        end = time.monotonic() + SECONDS

        def check() -> None:
            if time.monotonic() > end:
                raise TimeoutError

        program = Program(self.function.module, check)
        known = places(self.size)
        values, textures = self.inputs.values, self.inputs.textures
        lanes = np.arange(int(known.sum()))
        moved = np.full(len(lanes), np.inf)
        with contextlib.suppress(TimeoutError, RecursionError):
            moves = [
                noise(program, [self.key], values, textures, lanes, DRAWS, True, at_edges=at_edges)[0]
                for at_edges in (False, True)
            ]
            moved = np.max(moves, axis=0)
        known[known] = moved < STABLE
        return known
