"""A whole emitted program, shaded on any back end: each kind has its own shell around it."""

from __future__ import annotations

from ..compiler import Compiled
from . import dice, shade_numpy, unity_shell
from .backends import Array, Backend, DrawingBackend
from .backends.reference import Reference
from .backends.unity import UnityHLSL
from .isolated import Isolated
from .shell import Shell, drawing


def shade(compiled: Compiled, shell: Shell, backend: Backend, size: tuple[int, int], points: Array | None) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom. `points` are the vertices of `dice`; None: the screen.

    Raises SssgenError where the back end refuses or gives up.
    """
    if isinstance(backend, Isolated):
        return backend.shade(compiled, shell, size, points)
    if isinstance(backend, Reference):
        return shade_numpy.shade(compiled, shell, size, points, backend.dtype)
    if isinstance(backend, UnityHLSL):
        return unity_shell.shade(compiled, shell, backend, size, points)
    assert isinstance(backend, DrawingBackend)
    triangles = None if points is None else dice.triangles(size)
    picture = backend.draw(drawing(compiled, shell, size, points, triangles))
    return picture[::-1] if backend.top_first else picture
