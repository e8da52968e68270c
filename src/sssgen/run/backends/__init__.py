"""The back ends that run emitted shaders, behind one interface: text and arrays in, arrays out.

    gpu = backends.get("gl")
    sums, = gpu.run(Text(text), [Call("add", (FLOAT, VEC3), VEC3, (x, y))])

Each is started once a process and keeps what it has compiled. `sssgen.run.backend_registry` lists them.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module

from sssgen.run.backend_registry import (
    BACKENDS,
    DEFAULT,
    DRIVERS,
    FUNCTIONS,
    HALF,
    SINGLE,
    backend_names,
    half_counterparts,
)
from sssgen.run.backends.backend_interface import (
    VERTEX_SIZE,
    Array,
    Backend,
    Block,
    Bound,
    Call,
    Drawing,
    Place,
    Stage,
    Text,
    file_text,
)
from sssgen.run.backends.draw_backend import DrawingBackend
from sssgen.run.compilers import CompilerMissing
from sssgen.support.diagnostics import failure

__all__ = [
    "BACKENDS", "DEFAULT", "DRIVERS", "FUNCTIONS", "HALF", "SINGLE", "VERTEX_SIZE", "Array", "Backend", "Block",
    "Bound", "Call", "CompilerMissing", "Drawing", "DrawingBackend", "Place", "Stage", "Text", "available",
    "backend_names", "file_text", "get", "half_counterparts", "missing", "require",
]  # fmt: skip


def get(name: str) -> Backend:
    """The back end of that name. Raises CompilerMissing, which states how to get it, where this machine lacks it."""
    backend = _find(name)
    if isinstance(backend, str):
        raise CompilerMissing(backend)
    return backend


def require(name: str) -> Backend:
    """The same for a caller that cannot continue without it: raises SssgenError where this machine lacks it."""
    try:
        return get(name)
    except CompilerMissing as reason:
        raise failure(f"the back end {name} is missing", str(reason)) from None


def available() -> list[Backend]:
    """Every back end for functions that this machine has, started."""
    return [backend for backend in map(_find, FUNCTIONS) if isinstance(backend, Backend)]


def missing() -> list[tuple[str, str]]:
    """(name, how to get it) of every such back end that this machine lacks."""
    return [(name, reason) for name in FUNCTIONS if isinstance(reason := _find(name), str)]


@cache
def _find(name: str) -> Backend | str:
    """The back end, or how to get it. Its module is imported here, as each needs other packages."""
    record = BACKENDS[name]
    module, _, program = record.program.partition(":")
    try:
        start = getattr(import_module(f"sssgen.run.backends.{module}"), program)
        backend: Backend = start(name, record.target, **record.options)
    except CompilerMissing as reason:
        return str(reason)
    except ModuleNotFoundError as error:
        if (error.name or "").startswith("sssgen"):
            raise
        return f"the Python package {error.name}: {record.install.replace('`', '')}"
    return backend
