"""The parameters that a scene can set: those of its material, of the shell's stages, and of the shell's lights."""

from __future__ import annotations

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Sampler
from sssgen.material import library
from sssgen.material.chain_assembly import DETAIL_LEVEL
from sssgen.material.level_assembly import level_uniform
from sssgen.material.material_loading import load_material
from sssgen.material.model import Material
from sssgen.material.requirements import read_uniforms
from sssgen.material.shell_stages import NONE
from sssgen.material.values import WrongValue, read_value
from sssgen.scene.scene import Scene
from sssgen.support.diagnostics import Diagnostic, SssgenError, did_you_mean
from sssgen.support.paths import display_name
from sssgen.targets import registry


def material_of(scene: Scene) -> Material | None:
    """The material of a scene; None for a scene without one, which measures.

    Raises SssgenError at the scene's line.
    """
    if not scene.material:
        return None
    try:
        return load_material(scene.material)
    except SssgenError as error:
        span = scene.document.place("material").value
        first = error.diagnostics[0]
        place = f"{display_name(first.span.file)}:{first.span.line}: " if first.span.line else ""
        raise SssgenError([Diagnostic("error", f"{place}{first.message}", span, first.hint)]) from None


def uniforms_of(scene: Scene, material: Material) -> dict[str, Uniform]:
    """The parameters and textures by name."""
    uniforms = {
        uniform.name: uniform._replace(default=use.values.get(uniform.name, uniform.default))
        for use in material.stages
        for uniform in read_uniforms(use)
    }
    if material.levels > 1:
        uniforms[DETAIL_LEVEL] = level_uniform(material.levels)
    shells = {registry.load(target).lighting for target in registry.names()} if material.shading == "lit" else set()
    for name in filter(None, (*shells, *scene.shell.values())):
        if name != NONE:
            uniforms = {uniform.name: uniform for uniform in library.load(name).uniforms} | uniforms
    return uniforms


def check(scene: Scene, material: Material) -> None:
    """Raises SssgenError for names and values that the material does not take."""
    uniforms = uniforms_of(scene, material)
    values = {name: uniform for name, uniform in uniforms.items() if not isinstance(uniform.type, Sampler)}
    document = scene.document
    for name, raw in scene.parameters.items():
        place = document.place("parameters", name)
        if name not in values:
            hint = did_you_mean(name, values) or f"it has: {', '.join(values) or 'none'}"
            document.error(place.key, f"{material.name} has no parameter '{name}'", hint)
            continue
        try:
            read_value(values[name], raw)
        except WrongValue as wrong:
            document.error(place.value, wrong.message, wrong.hint)
    textures = [name for name, uniform in uniforms.items() if isinstance(uniform.type, Sampler)]
    for name in scene.textures:
        if name not in textures:
            hint = did_you_mean(name, textures) or f"it has: {', '.join(textures) or 'none'}"
            document.error(document.place("textures", name).key, f"{material.name} has no texture '{name}'", hint)
    document.reporter.check()
