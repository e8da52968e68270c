"""Describe a translucent material once; get it, proven and measured, in every engine.

>>> import sssgen
>>> made = sssgen.compile("resin_inlay", "wgsl")
>>> list(made.files)
['resin_inlay.wgsl', 'resin_inlay.wgsl.reflection.json']
>>> [texture["name"] for texture in made.reflection["textures"]]
['base_color_texture']

What is public: `compile`, `load_material`, `load_technique`, `all_targets`, `Compiled`, `Material`, `SssgenError`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .version import VERSION as __version__

if TYPE_CHECKING:
    from .compiler import Compiled, all_targets, compile
    from .diagnostics import SssgenError
    from .library import load as load_technique
    from .material import Material, load_material

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
    "Compiled": ("compiler", "Compiled"),
    "compile": ("compiler", "compile"),
    "all_targets": ("compiler", "all_targets"),
    "SssgenError": ("diagnostics", "SssgenError"),
    "load_technique": ("library", "load"),
    "Material": ("material", "Material"),
    "load_material": ("material", "load_material"),
}


def __getattr__(name: str) -> Any:
    """Loads a public name when it is first used, so that `import sssgen` costs next to nothing."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    module, attribute = _PLACES[name]
    return getattr(import_module(f".{module}", __name__), attribute)
