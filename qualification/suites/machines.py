"""The back ends that run the values and draw the pictures of suites, started once in each process."""

from __future__ import annotations

import functools
from contextlib import ExitStack

from sssgen.analyse.verify.machines import Machines, start_machines
from sssgen.run.backends.backend_process import BackendProcess

BACKENDS = {
    "numpy": "NumPy", "gl": "GLSL 3.30", "gl-es": "GLSL ES 3.00", "webgpu": "WGSL, naga", "browser": "WGSL, Tint",
    "hlsl": "HLSL, DXC", "metal": "Metal, stand-in",
}  # fmt: skip
"""The back ends that run values, and their titles."""
AUTHOR = "driver"
"""The driver with the author's own text: what it does wrong, no translation is blamed for."""
SECONDS = 12.0
"""How long one picture may take."""

_open = ExitStack()


@functools.cache
def machines() -> Machines:
    """The back ends of this process, which end with it."""
    return _open.enter_context(start_machines(tuple(BACKENDS)))


def devices() -> dict[str, str]:
    """The driver, the version and the device of each back end, by its title."""
    return {BACKENDS[name]: machine.device() for name, machine in machines().running.items()}


@functools.cache
def drawing_machines(*names: str) -> dict[str, BackendProcess]:
    """The back ends of this process for pictures, without those that this machine lacks."""
    running = _open.enter_context(start_machines(names)).running
    for machine in running.values():
        machine.limit_time(SECONDS)
    return running
