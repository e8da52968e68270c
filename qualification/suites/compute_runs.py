"""Runs compute shaders of suites: the buffers that the author's text and its translations leave behind."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

import numpy as np

from qualification.suites.compiled_texts import crash
from qualification.suites.machines import AUTHOR, drawing_machines
from qualification.suites.outcomes import INVALID, REFUSED, RIGHT, WRONG, Outcome
from qualification.suites.pictures import DTYPES, for_driver
from sssgen.ir.nodes import Module
from sssgen.ir.types import components, kind_of
from sssgen.lang.plain_glsl import load_glsl_text
from sssgen.pipeline.compiler import Compiled, transpile
from sssgen.run.backends import Array, Block, Place, Text
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.dispatch import Dispatch, by_opengl, by_webgpu
from sssgen.run.backends.metal_kernel import run_kernel
from sssgen.run.render import metal_values, shell_values
from sssgen.support.diagnostics import SssgenError
from sssgen.targets.block_places import block_members

TARGETS = {"gl": "glsl-330", "webgpu": "wgsl", "metal": "metal"}
"""The back ends that run compute shaders, and the target of each."""
_BUFFER = re.compile(r"layout\s*\(([^()]*)\)\s*(?:(?:readonly|writeonly|coherent)\s+)*buffer\s+(\w+)")
_BINDING = re.compile(r"\bbinding\s*=\s*(\d+)")


class ComputeProgram(NamedTuple):
    """A compute shader and what it reads."""

    text: str
    groups: tuple[int, int, int]
    buffers: Mapping[int, bytes]
    """By binding."""
    uniforms: Mapping[str, tuple[float, ...]] = {}
    blocks: Mapping[str, bytes] = {}
    """The author's uniform blocks by name, in the layout std140."""


Buffers: TypeAlias = Mapping[int, Array]
"""Words by binding."""
Judge: TypeAlias = Callable[[Buffers, Buffers | None], str]
"""What is wrong with the buffers after a run, beside those of the driver; '' where nothing is."""


def outcomes(program: ComputeProgram, judge: Judge) -> dict[str, Outcome]:
    """The outcomes of a program, on the driver as written and on each back end as translated."""
    running = drawing_machines()
    try:
        module = load_glsl_text(program.text, "case.comp").module
    except SssgenError as error:
        return dict.fromkeys(TARGETS, _failed(error, REFUSED))
    expected, results = None, {}
    try:
        expected = run_written(program, module, running["gl"])
        results[AUTHOR] = _judged(judge(expected, None))
    except SssgenError as error:
        results[AUTHOR] = _failed(error, REFUSED)
    for name, target in TARGETS.items():
        if name in running:
            results[name] = _outcome(program, module, target, running[name], lambda after: judge(after, expected))
    return results


def _outcome(
    program: ComputeProgram, module: Module, target: str, machine: BackendProcess, judge: Callable[[Buffers], str]
) -> Outcome:
    """The outcome of the translation for a target."""
    try:
        compiled = transpile(module, target, "case", keep=True)
    except SssgenError as error:
        return _failed(error, REFUSED)
    except Exception as error:  # a bug, which the table shows
        return crash(error)
    try:
        return _judged(judge(run_translated(program, module, compiled, target, machine)))
    except SssgenError as error:
        return _failed(error, INVALID)


def run_written(program: ComputeProgram, module: Module, machine: BackendProcess) -> Buffers:
    """The buffers after a run of the author's text. Raises SssgenError."""
    names = declared(program.text)
    blocks = {name: Block(data.ljust(-(-len(data) // 16) * 16, b"\0"), Place(0, 0))
              for name, data in program.blocks.items()}  # fmt: skip
    dispatch = Dispatch(
        Text(for_driver(program.text)), program.groups, _workgroup(module),
        {name: words(program, binding) for name, binding in names.items()}, names,
        values={name: np.array(value) for name, value in program.uniforms.items()}, blocks=blocks,
    )  # fmt: skip
    after = machine.apply(by_opengl, dispatch)
    return {binding: after[name] for name, binding in names.items()}


def run_translated(
    program: ComputeProgram, module: Module, compiled: Compiled, target: str, machine: BackendProcess
) -> Buffers:
    """The buffers after a run of a translation. Raises SssgenError."""
    reflection = compiled.reflection
    listed = reflection["storage_buffers"]
    bindings = dict(zip([each["block"] for each in listed], declared(program.text).values(), strict=True))
    source = numbers(program, module)
    by_name = {each["name"]: source[each["source_name"]] for each in reflection["uniforms"]}
    block = b""
    if target == "metal":
        block = metal_values.material_block(reflection, source)
    elif target == "wgsl":
        block = shell_values.material_block(reflection["uniform_block_size"] or 0, reflection["uniforms"], by_name)
    dispatch = Dispatch(
        Text(next(iter(compiled.files.values()))), program.groups, _workgroup(module),
        {name: words(program, binding) for name, binding in bindings.items()},
        {each["block"]: each["binding"]["binding"] for each in listed},
        next(iter(reflection["files"][0]["stages"].values())), by_name, block, group=int(target == "wgsl"),
        readonly=frozenset(each["block"] for each in listed if each["access"] == "readonly"),
    )  # fmt: skip
    if target == "metal":
        after: Mapping[str, Array] = machine.apply(run_kernel, dispatch, 0).buffers
    else:
        after = machine.apply(by_webgpu if target == "wgsl" else by_opengl, dispatch)
    return {binding: after[name] for name, binding in bindings.items()}


def numbers(program: ComputeProgram, module: Module) -> dict[str, Array]:
    """The numbers of the uniforms, by their names in the IR."""
    places = block_members(module)
    result = {}
    for uniform in module.uniforms:
        dtype, count = DTYPES[kind_of(uniform.type)], components(uniform.type)
        values: Array = np.zeros(count, dtype)
        if uniform.block:
            start = places[uniform.block, uniform.source].offset
            data = program.blocks.get(uniform.block, b"")[start : start + 4 * count]
            values = np.frombuffer(data.ljust(4 * count, b"\0"), dtype)
        elif uniform.name in program.uniforms:
            values = np.array(program.uniforms[uniform.name], dtype)
        result[uniform.name] = values
    return result


def declared(text: str) -> dict[str, int]:
    """The storage blocks of a text and their bindings, in their order."""
    bindings = {}
    for layout, name in _BUFFER.findall(text):
        binding = _BINDING.search(layout)
        bindings[name] = int(binding[1]) if binding else 0
    return bindings


def words(program: ComputeProgram, binding: int) -> Array:
    """A buffer before the run."""
    return np.frombuffer(program.buffers[binding], np.uint32).copy()


def _workgroup(module: Module) -> tuple[int, int, int]:
    x, y, z = module.workgroup
    return x, y, z


def _judged(wrong: str) -> Outcome:
    return Outcome(WRONG if wrong else RIGHT, wrong)


def _failed(error: SssgenError, outcome: str) -> Outcome:
    return Outcome(outcome, error.diagnostics[0].message)
