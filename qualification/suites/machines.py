"""The back ends that run the values and draw the pictures of suites, started once in each process."""

from __future__ import annotations

import functools
from contextlib import ExitStack

from sssgen.analyse.verify.machines import SECONDS as VALUES_SECONDS
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


def machines() -> Machines:
    """The back ends of this process, which end with it."""
    return _with_limit(VALUES_SECONDS)


def drawing_machines() -> dict[str, BackendProcess]:
    """The same for pictures, without those that this machine lacks."""
    return _with_limit(SECONDS).running


def _with_limit(seconds: float) -> Machines:
    started = _started()
    for machine in started.running.values():
        machine.limit_time(seconds)
    return started


def devices() -> dict[str, str]:
    """The driver, the version and the device of each back end, by its title."""
    return {BACKENDS[name]: machine.device() for name, machine in machines().running.items()}


@functools.cache
def _started() -> Machines:
    return _open.enter_context(start_machines(tuple(BACKENDS)))
