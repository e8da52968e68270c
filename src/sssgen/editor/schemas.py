"""JSON schemas of materials and scenes, of the tables and techniques that the readers use themselves.

A schema knows less than the language server: neither the order of a chain nor the functions that are bound to slots.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from sssgen.ir.nodes import Uniform
from sssgen.ir.types import Array, Matrix, Sampler, components, kind_of
from sssgen.material import library, roles, slots
from sssgen.material.level_reader import LEVELED
from sssgen.material.library import Technique
from sssgen.material.material_loading import examples
from sssgen.material.material_reader import CHOICES, FLAGS, MATERIAL_KEYS, STAGE_KEYS, parameter_names
from sssgen.material.medium_look import look_keys
from sssgen.material.model import MOST_LEVELS, NAME, UV_SETS
from sssgen.material.shell_stages import choices
from sssgen.material.technique_facts import uniform_facts, uniform_text
from sssgen.material.values import HEX_COLOUR, has_opacity, is_colour, limits
from sssgen.scene import scene_keys
from sssgen.scene.measured.media import media
from sssgen.scene.toml_table import ANY, Key

Schema = dict[str, Any]

DIALECT = "http://json-schema.org/draft-07/schema#"
_TECHNIQUE_FILE = {"type": "string", "pattern": r"\.(sss|glsl)$"}
_LINE: Schema = {"type": "string", "pattern": r"^[^\u0000-\u001f]*$"}


def material_schema() -> Schema:
    """The schema of a material's TOML file."""
    techniques = list(library.load_all())
    return {
        "$schema": DIALECT,
        "title": "a material of sssgen",
        "type": "object",
        "required": ["material"],
        "anyOf": [{"required": [section]} for section in roles.SECTIONS],
        "properties": {"material": _head()} | {section: _section(section, techniques) for section in roles.SECTIONS},
        "additionalProperties": False,
        "definitions": {technique.name: _parameters(technique) for technique in techniques},
    }


def _head() -> Schema:
    keys: dict[str, Schema] = {key: {"type": "string"} for key in MATERIAL_KEYS}
    keys["name"] = {"type": "string", "pattern": f"^(?:{NAME.pattern})$"}
    keys |= {flag: {"type": "boolean"} for flag in FLAGS}
    keys["levels"] = {"type": "integer", "minimum": 1, "maximum": MOST_LEVELS}
    for key, (words, meaning) in CHOICES.items():
        keys[key] = {"enum": list(words), "description": meaning}
    return _table(keys, required=["name"])


def _section(section: str, techniques: Iterable[Technique]) -> Schema:
    """A stage, or a list of stages."""
    allowed = roles.allowed_roles(section)
    names = [technique.name for technique in techniques if technique.role in allowed]
    named = {"anyOf": [{"enum": names}, _TECHNIQUE_FILE]}
    level: Schema = {"type": "integer", "minimum": 0, "maximum": MOST_LEVELS - 1}
    levels: Schema = {"anyOf": [level, {"type": "array", "items": level, "minItems": 1}]}
    leveled = {"level": levels} if section in LEVELED else {}
    stage = {
        "type": "object",
        "required": ["technique"],
        "properties": {"technique": named, "uv": {"enum": list(UV_SETS)}, "bind": _texts()} | leveled,
        "allOf": [
            {"if": {"properties": {"technique": {"const": name}}}, "then": {"$ref": f"#/definitions/{name}"}}
            for name in names
        ],
    }
    return {"if": {"type": "array"}, "then": {"type": "array", "items": stage}, "else": stage}


def _parameters(technique: Technique) -> Schema:
    """The keys of a technique's stage. What is bound to a slot brings keys of its own."""
    read, needed = slots.needs(technique.module, technique.function)
    keys: dict[str, Schema] = {key: {} for key in STAGE_KEYS}
    uniforms = [uniform for uniform in technique.uniforms if uniform.name in read]
    for uniform in (*uniforms, *look_keys(uniforms).values()):
        keys |= dict.fromkeys(parameter_names(uniform), _parameter(uniform))
    schema: Schema = {"description": technique.doc.get("summary", ""), "properties": keys}
    return schema | ({"required": ["bind"]} if needed else {"additionalProperties": False})


def _parameter(uniform: Uniform) -> Schema:
    """A value, or a value in a table."""
    about = ". ".join(filter(None, (uniform.doc.rstrip("."), uniform_text(uniform_facts(uniform)))))
    if isinstance(uniform.type, Sampler):
        return {"description": about, "type": "string", "minLength": 1}
    value = _value(uniform)
    table = _table({"value": value, "fixed": {"type": "boolean"}}) | {"minProperties": 1}
    return {"description": about, "if": {"type": "object"}, "then": table, "else": value}


def _value(uniform: Uniform) -> Schema:
    element = uniform.type.element if isinstance(uniform.type, Array) else uniform.type
    kind, count = kind_of(element), components(uniform.type)
    low, high = limits(uniform) if kind != "bool" else (0.0, 0.0)
    one: Schema = {"type": "boolean"}
    if kind != "bool":
        one = {"type": "number" if kind == "float" else "integer", "minimum": low, "maximum": high}
    if count == 1 and not isinstance(uniform.type, Array):
        return one
    # a matrix or a list may be nested: then only its innermost elements are numbers
    items = [one, one, one, {"type": "number", "minimum": 0.0, "maximum": 1.0}] if has_opacity(uniform) else one
    flat: Schema = {"type": "array", "items": items, "minItems": count, "maxItems": count}
    nested: Schema = {"type": "array", "items": {"type": "array"}, "minItems": 1, "maxItems": count}
    several = [flat, nested] if isinstance(uniform.type, Array | Matrix) else [flat]
    if is_colour(uniform):
        several.append({"type": "string", "pattern": f"^{HEX_COLOUR}$"})
    return several[0] if len(several) == 1 else {"anyOf": several}


def scene_schema() -> Schema:
    """The schema of a scene's TOML file."""
    tables: dict[str, Schema] = {
        "material": {"anyOf": [{"enum": list(examples())}, {"type": "string", "pattern": r"\.toml$"}]},
        "background": _background(),
        "geometry": {"$ref": "#/definitions/geometry"},
        "bodies": {
            "description": "the scenes whose bodies are drawn together",
            "type": "array",
            "maxItems": scene_keys.MAX_BODIES,
            "items": {"type": "string"},
        },
        "camera": _table(_keys(scene_keys.CAMERA)),
        "light": {"type": "array", "maxItems": scene_keys.MAX_LIGHTS, "items": _light()},
        "shell": _table({role: {"enum": list(choices(role))} for role in scene_keys.SHELL}),
        "parameters": {"type": "object"},
        "textures": {"type": "object", "additionalProperties": _texture()},
        "medium": _medium(),
        "inlay": _table(_keys(scene_keys.INLAY)),
        "environment": _table(_keys(scene_keys.ENVIRONMENT)),
    }
    return {
        "$schema": DIALECT,
        "title": "a scene of sssgen",
        "type": "object",
        "anyOf": [{"required": [key]} for key in ("material", "bodies", "medium", "inlay")],
        "properties": _keys(scene_keys.KEYS) | tables,
        "additionalProperties": False,
        "definitions": {"geometry": _geometry()},
    }


def _background() -> Schema:
    color = _key(scene_keys.KEYS["background"])
    ends = {"type": "array", "items": color, "minItems": 2, "maxItems": 2}
    shown = {"enum": ["environment"]}
    return {"description": "a colour, [bottom, top], or the environment", "anyOf": [color, ends, shown]}


def _light() -> Schema:
    one_of = [{"required": [key]} for key in ("position", "direction")]
    return _table(_keys(scene_keys.LIGHT)) | {"oneOf": one_of}


def _geometry() -> Schema:
    inner: dict[str, Schema] = {
        "part": {
            "type": "array", "minItems": 1, "maxItems": scene_keys.MAX_PARTS,
            "items": {"$ref": "#/definitions/geometry"},
        },
        "parameters": {"type": "object"},
    }  # fmt: skip
    required: dict[str, list[str]] = {"union": ["part"], "mesh": ["file"], "distance": ["technique"]}
    shapes: list[Schema] = []
    for kind, keys in scene_keys.SHAPES.items():
        properties = _keys({**scene_keys.PLACE, **keys}) | {key: inner[key] for key in keys if key in inner}
        then = _table({"kind": {"const": kind}, **properties}, required=required.get(kind, ()))
        shapes.append({"if": {"properties": {"kind": {"const": kind}}}, "then": then})
    kinds = {"kind": {"enum": list(scene_keys.SHAPES)}}
    return {"type": "object", "required": ["kind"], "properties": kinds, "allOf": shapes}


def _texture() -> Schema:
    picture = _table(_keys(scene_keys.PICTURE), required=["file"])
    distance = _table(_keys(scene_keys.DISTANCE_TEXTURE))
    of_body = {"required": ["distance_of_geometry"]}
    table = {"if": of_body, "then": distance, "else": picture}
    return {"if": {"type": "object"}, "then": table, "else": _LINE | {"minLength": 1}}


def _medium() -> Schema:
    coefficients, look = ["absorption", "scattering"], ["color", "depth"]
    own = [*coefficients, "anisotropy", *look]
    keys = _keys(scene_keys.MEDIUM) | {"preset": {"enum": list(media())}}
    preset: Schema = {"properties": dict.fromkeys(own, False)}
    by_look: Schema = {"required": look, "properties": dict.fromkeys(coefficients, False)}
    by_coefficients: Schema = {"properties": dict.fromkeys(look, False)}
    custom: Schema = {"properties": {"unit_mm": False}, "anyOf": [by_look, by_coefficients]}
    return {**_table(keys), "if": {"required": ["preset"]}, "then": preset, "else": custom}


# The parts


def _table(keys: Mapping[str, Schema], required: Iterable[str] = ()) -> Schema:
    needed = list(required)
    schema: Schema = {"type": "object", "properties": dict(keys), "additionalProperties": False}
    return schema | ({"required": needed} if needed else {})


def _texts() -> Schema:
    return {"type": "object", "additionalProperties": {"type": "string"}}


def _keys(keys: Mapping[str, Key]) -> dict[str, Schema]:
    return {name: _key(key) for name, key in keys.items()}


def _key(key: Key) -> Schema:
    if key.kind == "other":
        return {}
    if key.kind == "text":
        return {"enum": list(key.choices)} if key.choices else _LINE
    one: Schema = {"type": "integer" if key.kind in ("whole", "wholes") else "number"}
    one |= {"minimum": key.within[0], "maximum": key.within[1]} if key.within != ANY else {}
    if key.kind in ("whole", "number"):
        return one
    return {"type": "array", "items": one, "minItems": key.size, "maxItems": key.size}
