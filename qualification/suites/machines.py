"""The back ends that the runners share, each in a process of its own, and what they make of a case."""

from __future__ import annotations

import functools
from contextlib import ExitStack

from qualification.suites.outcomes import CRASH, Outcome
from sssgen.analyse.verify.machines import start_machines
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.support.diagnostics import SssgenError

TITLES = {
    "driver": "the driver, the author's text", "front end": "front end", "numpy": "NumPy", "gl": "GLSL 3.30",
    "gl-es": "GLSL ES 3.00", "webgpu": "WGSL, naga", "browser": "WGSL, Tint", "hlsl": "HLSL",
}  # fmt: skip
"""The names of what has an outcome, and their titles."""
AUTHOR = "driver"
"""The driver with the author's own text: what it does wrong, no translation is blamed for."""
FRONT = "front end"
SECONDS = 12.0
"""How long one picture may take."""


@functools.cache
def machines(*names: str) -> dict[str, BackendProcess]:
    """The back ends of this process, which end with it; without those that this machine lacks."""
    running = _open.enter_context(start_machines(names)).running
    for machine in running.values():
        machine.limit_time(SECONDS)
    return running


_open = ExitStack()


def message(error: SssgenError) -> str:
    """What a table says of an error."""
    return error.diagnostics[0].message


def crash(error: Exception) -> Outcome:
    """The outcome of an exception, which is a bug that the table shows."""
    return Outcome(CRASH, f"{type(error).__name__}: {error}")
