"""Shades an emitted program on any back end: chooses the shell for the kind of back end."""

from __future__ import annotations

from sssgen.pipeline.compiler import Compiled
from sssgen.run.backends import Array, Backend, DrawingBackend
from sssgen.run.backends.backend_process import BackendProcess
from sssgen.run.backends.engine_backend import GodotBackend, PageBackend
from sssgen.run.backends.metal_backend import MetalOnCpu
from sssgen.run.backends.numpy_reference import Reference
from sssgen.run.backends.unity_backend import UnityHLSL
from sssgen.run.render import godot_values, metal_values, page_values, pixel_mesh, shade_numpy, unity_values
from sssgen.run.render.shell_values import Shell, drawing


def shade(backend: Backend, compiled: Compiled, shell: Shell, size: tuple[int, int], points: Array | None) -> Array:
    """The picture, (height, width, 4), row 0 at the bottom.

    `points` are the vertices of `pixel_mesh`; None means the screen.
    Raises SssgenError if the back end refuses or fails.
    """
    if isinstance(backend, BackendProcess):
        picture: Array = backend.apply(shade, compiled, shell, size, points)
        return picture
    if isinstance(backend, Reference):
        return shade_numpy.shade(compiled, shell, size, points, backend.dtype)
    if isinstance(backend, UnityHLSL):
        return unity_values.shade(compiled, shell, backend, size, points)
    if isinstance(backend, MetalOnCpu):
        return metal_values.shade(compiled, shell, backend, size, points)
    if isinstance(backend, PageBackend):
        return page_values.shade(compiled, shell, backend.page, size, points)
    if isinstance(backend, GodotBackend):
        text = compiled.files[f"{compiled.reflection['material']}.gdshader"]
        return godot_values.shade(text, compiled.reflection, shell, backend.godot, size, points)
    assert isinstance(backend, DrawingBackend)
    triangles = None if points is None else pixel_mesh.triangles(size, shell.front)
    picture = backend.draw(drawing(compiled, shell, size, points, triangles))
    return picture[::-1] if backend.top_first else picture
