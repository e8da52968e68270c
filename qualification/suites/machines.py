"""The back ends that run the values of suites, started once in each process."""

from __future__ import annotations

import functools
from contextlib import ExitStack

from sssgen.analyse.verify.machines import Machines, start_machines

BACKENDS = {"numpy": "NumPy", "gl": "GLSL 3.30", "webgpu": "WGSL", "hlsl": "HLSL"}
"""The back ends that run values, and their titles."""
AUTHOR = "driver"
"""The driver with the author's own text: what it does wrong, no translation is blamed for."""

_open = ExitStack()


@functools.cache
def machines() -> Machines:
    """The back ends of this process, which end with it."""
    return _open.enter_context(start_machines(tuple(BACKENDS)))
