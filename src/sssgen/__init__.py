"""Describe a translucent material once; get it, proven and measured, in every engine.

>>> import sssgen
>>> shader = sssgen.compile("resin_inlay", "wgsl")
>>> list(shader.files)
['resin_inlay.wgsl', 'resin_inlay.wgsl.reflection.json']
>>> [texture["name"] for texture in shader.reflection["textures"]]
['base_color_texture']

What is public: `compile`, `load_material`, `load_technique`, `all_targets`, `Compiled`, `Material`, `SssgenError`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from sssgen.version import VERSION as __version__

if TYPE_CHECKING:
    from sssgen.material.library import load as load_technique
    from sssgen.material.material_loading import load_material
    from sssgen.material.model import Material
    from sssgen.pipeline.compiler import Compiled, all_targets, compile
    from sssgen.support.diagnostics import SssgenError

__all__ = [
    "Compiled",
    "Material",
    "SssgenError",
    "__version__",
    "all_targets",
    "compile",
    "load_material",
    "load_technique",
]

_PLACES = {
    "Compiled": ("pipeline.compiler", "Compiled"),
    "compile": ("pipeline.compiler", "compile"),
    "all_targets": ("pipeline.compiler", "all_targets"),
    "SssgenError": ("support.diagnostics", "SssgenError"),
    "load_technique": ("material.library", "load"),
    "Material": ("material.model", "Material"),
    "load_material": ("material.material_loading", "load_material"),
}


def __getattr__(name: str) -> Any:
    """Loads a public name when it is first used, so that `import sssgen` costs next to nothing."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _PLACES[name]
    return getattr(import_module(f".{module}", __name__), attribute)
