"""`sssgen transpile --verify` of a compute shader: its buffers after a run, as written and as translated.

The author's text runs in OpenGL's driver; its translations to GLSL, WGSL and Metal in OpenGL, WebGPU and on the
processor, each with equal buffers, uniforms and textures. All numbers of all buffers are compared: integers must be
equal, floats deviate relative to the larger of their size and 1.

The run on the processor comes first, and repeats with the invocations and workgroups in other orders:

- A round in which something is undefined is not compared: an index out of range, a race, a barrier that not all reach.
- A number that depends on the order is not compared, and counted: it may differ between two runs of one program.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np

from sssgen.analyse.verify.compute_inputs import RoundValues, Word, group_counts, round_values, words
from sssgen.analyse.verify.compute_report import ComputeReport, Difference
from sssgen.analyse.verify.driven_function import NEWEST, VERSIONS
from sssgen.ir.nodes import Module, Variable
from sssgen.ir.types import Struct, spell, unnested
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.lang.source_lines import source_text
from sssgen.passes.stage.host_uniforms import COUNT_TEXT, length_text
from sssgen.passes.stage.storage_layout import extent
from sssgen.pipeline.compiler import transpile
from sssgen.run.backends import Array, Block, Bound, CompilerMissing, Place, Text
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.dispatch import Dispatch, by_opengl, by_webgpu
from sssgen.run.backends.metal_kernel import KernelRun, run_kernel
from sssgen.run.evaluate.deviation import GOAL
from sssgen.run.render import metal_values, shell_values
from sssgen.support.diagnostics import SssgenError, failure
from sssgen.targets.block_places import block_members
from sssgen.targets.reflection_record import BlockMember, BufferRecord, TextureBinding

TEXTS = {"glsl": ("gl", "glsl-330"), "wgsl": ("webgpu", "wgsl"), "metal": ("metal", "metal")}
"""The translations that are compared, with the back end and the target of each."""
ROUNDS, TRIES = 4, 16
"""How many rounds are compared, and how many are tried for them."""
ORDERS = (0, 1, 2, 3)
"""The orders of the invocations on the processor."""
SECONDS = 60.0
"""The time limit of one run."""
_VERSION = re.compile(r"^[ \t]*#[ \t]*version[ \t]+(\d+)[^\n]*", re.MULTILINE)
_VERIFIED = "verify a shader that reads textures and writes storage buffers"


def verify_compute(
    text: str, shown: str, seed: int = 0, machines: Mapping[str, BackendProcess] | None = None
) -> ComputeReport:
    """Compares the buffers of a text without `#include`. Raises SssgenError.

    `shown` is the text's name in messages; without `machines` the back ends gl, webgpu and metal are started here.
    """
    module = load_glsl_text(text, shown).module
    if image := next((variable for variable in module.variables if variable.storage == "image"), None):
        message = f"'{image.name}' is an image: compute shaders with images are not verified"
        raise failure(message, _VERIFIED, shown)
    if counter := _counter(module):
        message = f"'{counter}' is an atomic counter: compute shaders with atomic counters are not verified"
        raise failure(message, _VERIFIED, shown)
    started: dict[str, BackendProcess] = dict(machines or {})
    missing: dict[str, str] = {}
    try:
        for name in () if machines else ("gl", "metal", "webgpu"):
            try:
                started[name] = BackendProcess(name, SECONDS)
            except CompilerMissing as reason:
                missing[name] = str(reason)
        for name, purpose in (("gl", "it runs the text as written"), ("metal", "it finds what depends on the order")):
            if name not in started:
                raise failure(f"the back end {name} is missing: {purpose}", missing.get(name, ""))
        return _Verification(module, text, seed, started).report(missing)
    finally:
        for machine in started.values() if machines is None else ():
            machine.close()


class _Verification:
    def __init__(self, module: Module, text: str, seed: int, machines: Mapping[str, BackendProcess]) -> None:
        self.module, self.seed, self.machines = module, seed, machines
        self.text = text if _VERSION.search(text) else f"#version 430 core\n{text}"
        version = _VERSION.search(self.text)
        self.is_newer = version is not None and int(version[1]) > NEWEST
        self.groups = group_counts(module)
        self.length = int(np.prod(self.groups) * np.prod(module.workgroup))
        self.buffers = [variable for variable in module.variables if variable.storage == "buffer"]
        self.layouts: dict[str, list[Word]] = {
            buffer.name: list(words(buffer.type, buffer.layout, self.length)) for buffer in self.buffers
        }
        self.compiled = {name: self.translate(target) for name, (_, target) in TEXTS.items()}

    def translate(self, target: str) -> Any:
        """The translation for a target, or the SssgenError of its refusal."""
        try:
            return transpile(self.module, target, "verified", keep=True)
        except SssgenError as error:
            return error

    def report(self, missing: dict[str, str]) -> ComputeReport:
        written = [buffer.name for buffer in self.buffers if buffer.access != "readonly"]
        total = sum([len(self.layouts[name]) for name in written])
        devices = {name: machine.device() for name, machine in self.machines.items()}
        report = ComputeReport(self.groups, self.module.workgroup, missing=missing, devices=devices)
        if isinstance(self.compiled["metal"], SssgenError):
            raise self.compiled["metal"]
        if not written:
            return report._replace(reason="it writes no buffer")
        unset = [uniform.name for uniform in self.module.uniforms
                 if uniform.row_major or isinstance(unnested(uniform.type)[0], Struct)]  # fmt: skip
        if unset:
            return report._replace(reason=f"'{unset[0]}' gets no value: it is a struct, or is stored row by row")
        faults: list[str] = []
        order_places: list[str] = []
        for number in range(TRIES):
            if report.rounds == ROUNDS:
                break
            values = round_values(self.module, self.layouts, self.length, number, self.seed)
            try:
                runs = [self.on_processor(values, order) for order in ORDERS]
            except SssgenError as error:  # such as a loop without an end
                return report._replace(reason=f"the run on the processor failed: {error.diagnostics[0].message}")
            fault = next((run.fault for run in runs if run.fault), "")
            if fault:
                faults.append(fault)
                continue
            stable, places = self.stable([run.buffers for run in runs], written)
            order_places += places
            report = self.compare(report, values, runs[0], stable, written)
            if report.reason:
                return report
            report = report._replace(
                rounds=report.rounds + 1, numbers=report.numbers + total, ordered=report.ordered + len(places)
            )
        report = report._replace(undefined=len(faults), faults=tuple(dict.fromkeys(faults)),
                                 order_places=tuple(dict.fromkeys(order_places)))  # fmt: skip
        if not report.rounds:
            return report._replace(reason=f"it is undefined in every round: {faults[0]}")
        if report.ordered == report.numbers:
            return report._replace(reason="all that it writes depends on the order of the invocations")
        return report

    def stable(self, runs: Sequence[Mapping[str, Array]], written: Sequence[str]) -> tuple[dict[str, Array], list[str]]:
        """Which numbers are the same in all orders, by buffer, and the places of the others."""
        stable, places = {}, []
        for name in written:
            numbers = [_numbers(run[name], self.layouts[name]) for run in runs]
            same = np.all([_errors(self.layouts[name], other, numbers[0]) <= GOAL / 2 for other in numbers[1:]], axis=0)
            stable[name] = same
            places += [f"{name}.{self.layouts[name][index].place}" for index in np.flatnonzero(~same)]
        return stable, places

    def compare(
        self,
        report: ComputeReport,
        values: RoundValues,
        processor: KernelRun,
        stable: dict[str, Array],
        written: Sequence[str],
    ) -> ComputeReport:
        """The report with the differences of one round."""
        try:
            original = self.original(values)
        except SssgenError as error:
            return report._replace(reason=f"the driver refuses it as written: {error.diagnostics[0].message}")
        runs = {name: partial(self.run, name, values) for name in ("glsl", "wgsl") if TEXTS[name][0] in self.machines}
        with ThreadPoolExecutor(2) as pool:
            results: dict[str, Any] = dict(zip(runs, pool.map(lambda run: run(), runs.values()), strict=True))
        results["metal"] = processor.buffers
        differences = dict(report.differences)
        for name, result in results.items():
            if isinstance(result, str):
                differences[name] = Difference(error=result)
                continue
            for buffer in written:
                layout = self.layouts[buffer]
                expected, actual = _numbers(original[buffer], layout), _numbers(result[buffer], layout)
                errors = np.where(stable[buffer] & _is_number(layout, expected), _errors(layout, actual, expected), 0.0)
                differences[name] = differences.get(name, Difference(0.0))
                worst = int(np.argmax(errors))
                if errors[worst] > (differences[name].deviation or 0.0):
                    shown = [_text(layout[worst], numbers[worst]) for numbers in (actual, expected)]
                    at = f"{buffer}.{layout[worst].place}: {shown[0]}, the author's text gives {shown[1]}"
                    differences[name] = Difference(float(errors[worst]), f"{at} (round {report.rounds})")
        return report._replace(differences=differences)

    def original(self, values: RoundValues) -> dict[str, Array]:
        """The buffers after a run of the author's text."""
        names = {buffer.name: _block(buffer) for buffer in self.buffers}
        textures = {name: Bound(texture, Place(0, 0)) for name, texture in values.textures.items()}
        dispatch = Dispatch(
            Text(self.text), self.groups, self._size(), {names[name]: data for name, data in values.buffers.items()},
            {},
            values=values.uniforms, textures=textures, blocks=self.blocks(values),
        )  # fmt: skip
        try:
            after = self.machines["gl"].apply(by_opengl, dispatch)
        except SssgenError:
            if not self.is_newer:
                raise
            text = _VERSION.sub(f"#version {VERSIONS[0]}", self.text, count=1)
            after = self.machines["gl"].apply(by_opengl, dispatch._replace(text=Text(text)))
            self.text, self.is_newer = text, False  # for the next rounds
        return {name: after[block] for name, block in names.items()}

    def blocks(self, values: RoundValues) -> dict[str, Block]:
        """The uniform blocks of the author's text."""
        places = block_members(self.module)
        blocks = {}
        for block in dict.fromkeys([uniform.block for uniform in self.module.uniforms if uniform.block]):
            own = [uniform for uniform in self.module.uniforms if uniform.block == block]
            ends = [places[block, uniform.source].offset + extent(uniform.type, "std140").size for uniform in own]
            size = -(-max(ends) // 16) * 16
            members: list[BlockMember] = [
                {"name": uniform.name, "type": spell(uniform.type), "offset": places[block, uniform.source].offset}
                for uniform in own
            ]
            blocks[block] = Block(shell_values.material_block(size, members, values.uniforms), Place(0, 0))
        return blocks

    def on_processor(self, values: RoundValues, order: int) -> KernelRun:
        """The run of the translation to Metal."""
        run: KernelRun = self.machines["metal"].apply(run_kernel, self.dispatch("metal", values), order)
        return run._replace(buffers=self.source_names("metal", run.buffers))

    def run(self, name: str, values: RoundValues) -> dict[str, Array] | str:
        """The buffers after a run of a translation, or why it does not run."""
        compiled = self.compiled[name]
        if isinstance(compiled, SssgenError):
            return compiled.diagnostics[0].message
        function: Callable[..., dict[str, Array]] = by_webgpu if name == "wgsl" else by_opengl
        try:
            after = self.machines[TEXTS[name][0]].apply(function, self.dispatch(name, values))
        except SssgenError as error:
            return error.diagnostics[0].message
        return self.source_names(name, after)

    def source_names(self, name: str, buffers: Mapping[str, Array]) -> dict[str, Array]:
        """The buffers of a translation by the names of the module's variables."""
        listed = self.compiled[name].reflection["storage_buffers"]
        return {own.name: buffers[other["block"]] for own, other in zip(self._buffers_of(listed), listed, strict=True)}

    def _buffers_of(self, listed: Sequence[BufferRecord]) -> list[Variable]:
        """The module's buffers that a reflection lists; both have the order of their declarations."""
        assert len(listed) == len(self.buffers)
        return self.buffers

    def dispatch(self, name: str, values: RoundValues) -> Dispatch:
        """The run of a translation."""
        reflection = self.compiled[name].reflection
        (file,) = [text for file, text in self.compiled[name].files.items() if not file.endswith(".json")]
        listed = reflection["storage_buffers"]
        uniforms = dict(values.uniforms)
        uniforms |= {uniform["source_name"]: self._host_value(uniform["doc"]) for uniform in reflection["uniforms"]
                     if uniform["source_name"] not in uniforms}  # fmt: skip
        by_name = {uniform["name"]: uniforms[uniform["source_name"]] for uniform in reflection["uniforms"]}
        textures = {
            texture["name"]: Bound(values.textures[texture["source_name"]], _place(texture.get("binding", {})))
            for texture in reflection["textures"]
        }
        block, group = b"", 0
        if name == "metal":
            block = metal_values.material_block(reflection, uniforms)
        elif name == "wgsl":
            size = reflection["uniform_block_size"] or 0
            block = shell_values.material_block(size, reflection["uniforms"], by_name)
            group = 1
        entry = next(iter(reflection["files"][0]["stages"].values()))
        buffers = zip(self._buffers_of(listed), listed, strict=True)
        return Dispatch(
            Text(file), self.groups, self._size(),
            {other["block"]: values.buffers[own.name] for own, other in buffers},
            {other["block"]: other["binding"]["binding"] for other in listed}, entry, by_name, block, textures, group,
            frozenset(other["block"] for other in listed if other["access"] == "readonly"),
        )  # fmt: skip

    def _size(self) -> tuple[int, int, int]:
        x, y, z = self.module.workgroup
        return x, y, z

    def _host_value(self, doc: str) -> Array:
        """The value of a uniform that the translation added."""
        if doc.startswith(COUNT_TEXT):
            return np.array(self.groups, np.uint32)
        for buffer in self.buffers:
            assert isinstance(buffer.type, Struct)
            if any(doc.startswith(length_text(buffer.type, field.name)) for field in buffer.type.fields):
                return np.array([self.length], np.int32)
        raise failure(f"a uniform of the translation is unknown: {doc}")


def _counter(module: Module) -> str:
    """An atomic counter, or ''; OpenGL binds counters otherwise than the storage buffers that they become.

    Such a buffer has the place of the counter's name, all others that of the name of their block.
    """
    for variable in module.variables:
        if variable.storage == "buffer" and isinstance(variable.type, Struct):
            (name, *_) = [field.name for field in variable.type.fields]
            if name != variable.type.name and source_text(variable.span) == name:
                return name
    return ""


def _block(buffer: Variable) -> str:
    assert isinstance(buffer.type, Struct)
    return buffer.type.name


def _place(binding: TextureBinding) -> Place:
    return Place(int(binding.get("group", 0)), int(binding.get("texture", 0)), int(binding.get("sampler", -1)))


def _numbers(buffer: Array, layout: Sequence[Word]) -> Array:
    """The words of a layout, in its order, as uint32."""
    result: Array = buffer[[word.at for word in layout]]
    return result


def _floats(layout: Sequence[Word]) -> Array:
    return np.array([word.kind == "float" for word in layout])


def _is_number(layout: Sequence[Word], numbers: Array) -> Array:
    """Where a number is no infinity and no NaN."""
    defined: Array = ~_floats(layout) | np.isfinite(numbers.view(np.float32))
    return defined


def _errors(layout: Sequence[Word], actual: Array, expected: Array) -> Array:
    """The deviation of each number: of floats relative to their size, but at least to 1; infinite of other integers."""
    a, b = actual.view(np.float32).astype(np.float64), expected.view(np.float32).astype(np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        floats = np.abs(a - b) / np.maximum(np.abs(b), 1.0)
    floats = np.where(np.isnan(floats), np.inf, floats)
    errors: Array = np.where(actual == expected, 0.0, np.where(_floats(layout), floats, np.inf))
    return errors


def _text(word: Word, number: Any) -> str:
    kinds: dict[str, Any] = {"float": np.float32, "int": np.int32, "uint": np.uint32}
    return str(np.asarray(number, np.uint32).view(kinds[word.kind]))
