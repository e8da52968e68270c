"""Assembles a shader: prints the legal module, passes the text to the target's templates, and maps lines to source.

Printed lines carry an invisible mark through the template, so that the source span of each line of the finished file is
known wherever the template placed it.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from sssgen.ir.baked_textures import is_baked, is_volume
from sssgen.ir.constant_expressions import literal
from sssgen.ir.frame_passes import FRAME_PASSES, VOLUMES, pass_name
from sssgen.ir.nodes import NOWHERE, Function, Local, Module, Param, Span, Uniform
from sssgen.ir.surface_fields import FIELDS
from sssgen.ir.types import Sampler, Struct, spell
from sssgen.passes.ranges.guard_report import GuardReport
from sssgen.passes.stage.stage_interface import Stage
from sssgen.support.diagnostics import Diagnostic, failure
from sssgen.targets.descriptor import OutputFile, Target
from sssgen.targets.frame import LIBRARY, library
from sssgen.targets.javascript_runtime import inlined_text, is_module, runtime_text
from sssgen.targets.parameter_variables import (
    check_properties,
    pass_variables,
    property_name,
    texture_variables,
    uniform_variables,
)
from sssgen.targets.printed_places import Places, check_places
from sssgen.targets.printers.printed_lines import Line, comment_text, wrap
from sssgen.targets.printers.printer import Comments, Printer
from sssgen.targets.templates import NO_LINES, render
from sssgen.targets.uniform_layout import Member, padding, place
from sssgen.targets.used_frame import PER_LIGHT, UsedFrame, check_inputs, named, named_per_light, used_frame, with_names

if TYPE_CHECKING:
    from sssgen.targets.reflection_record import Argument, TextureBinding

_MARK = re.compile(r"\x02(\d{1,9})\x03", re.ASCII)


class About(NamedTuple):
    """A material's description of itself; templates see it as `material`."""

    name: str
    title: str
    doc: str = ""
    shading: str = "lit"
    alpha_mode: str = "opaque"
    two_sided: bool = False
    """Whether back faces are drawn, too, and lit with the reversed normal."""
    facts: frozenset[str] = frozenset()
    """Its properties for which a target may have variants (`FACTS` of the descriptor)."""
    raymarched: bool = False
    """Whether the chain makes its own geometry, so that the shell needs no mesh."""
    head: tuple[str, ...] = ()
    """The author's comment at the head of the file, such as a licence."""
    bodies: tuple[str, ...] = ()
    """The distance functions of the bodies that the material is made for."""
    needs: Mapping[tuple[str, str], tuple[str, str]] = {}
    """What to do for each texture that a picture needs, and its file or '', by its technique and its name there."""


class Program(NamedTuple):
    """A legal module with the facts that templates need."""

    module: Module
    entries: Mapping[str, tuple[Function, tuple[str, ...]]]
    """Entry kind → its function in `module`, and the inputs that it takes."""
    surface: Struct | None
    source_names: Mapping[str, str]
    """A uniform's name in `module` → its technique's own name for it."""
    about: About
    encoded: bool
    """Whether the resulting colour is already encoded for a display."""
    parts: Mapping[str, list[list[Line]]]
    """The printed text of the structs (`types`), constants, variables, functions and the entry. The functions in
    `module` have no bodies."""
    owners: Mapping[str, tuple[str, str]]
    """A uniform's source name → its technique and its name there."""
    renames: Mapping[str, str]
    costs: Mapping[str, dict[str, int]]
    warnings: list[Diagnostic]
    settings: Mapping[str, list[tuple[int, str]]]
    """A uniform's source name → the material's stages that may give it a value, and its name there."""
    guards: GuardReport
    stage: Stage | None = None
    """The interface, where the module is a whole shader."""
    embedded: Mapping[str, tuple[Target, Program]] = {}
    """The same material in the other languages of the target's files."""
    shell: tuple[Function, tuple[str, ...]] | None = None
    """The function around the chain of a target without an engine, and the values that the target supplies to it."""
    frame_functions: Mapping[str, str] = {}
    """A function of `shells/` that the target's frame names → its name in the text."""
    surface_reads: Mapping[str, frozenset[str]] = {}
    """Entry kind → the members of the surface that its function reads."""
    reached: Mapping[str, frozenset[str]] = {}
    """Entry kind, or function of the frame → the names of the functions that it calls, where a file of the target
    leaves an entry out."""
    later_glsl: bool = False
    """Whether a builtin needs GLSL 4.30."""
    folder: str = ""
    """The material's folder: the reflection names files relative to it. '' is the working folder."""


class Emitted(NamedTuple):
    """The finished files, each with the source span of its lines (1-based)."""

    files: dict[str, str]
    lines: dict[str, dict[int, Span]]
    members: list[Member]
    block_size: int
    bindings: list[TextureBinding]
    """Where each texture and its sampler are bound; empty where the text does not state it."""
    calls: Mapping[str, list[Argument]]
    """Entry kind → its parameters in order, with what the shell passes for each."""
    embedded_calls: Mapping[str, Mapping[str, list[Argument]]]
    """The same of the embedded languages."""


_PRINTERS = {
    "glsl": "sssgen.targets.printers.glsl:GlslPrinter",
    "gdshader": "sssgen.targets.printers.gdshader:GodotPrinter",
    "hlsl": "sssgen.targets.printers.hlsl:HlslPrinter",
    "wgsl": "sssgen.targets.printers.wgsl:WgslPrinter",
    "metal": "sssgen.targets.printers.metal:MetalPrinter",
    "python": "sssgen.targets.printers.numpy_printer:NumpyPrinter",
    "tsl": "sssgen.targets.printers.tsl:TslPrinter",
}


def printer_for(target: Target, module: Module) -> Printer:
    """The target's printer. Raises SssgenError where a plug-in names one that does not exist."""
    made = _imported(_PRINTERS.get(target.language, target.language))
    if made is None:
        raise failure(f"target '{target.name}' names a printer that does not exist: {target.language}")
    printer: Printer = made(target, module)
    return printer


def _imported(name: str) -> Any:
    """What a descriptor names as `module:name`; None where it does not exist."""
    import importlib

    place, _, name = name.partition(":")
    try:
        return getattr(importlib.import_module(place), name)
    except (ImportError, AttributeError, ValueError):
        return None


def print_parts(
    target: Target,
    module: Module,
    comments: Comments,
    stage: Stage | None = None,
    entry: str = "",
    kept: bool = False,
    behind: Callable[[str, int], str] | None = None,
    source: Callable[[Span], str] | None = None,
    shell: tuple[Function, tuple[str, ...]] | None = None,
) -> dict[str, list[list[Line]]]:
    """Prints a legal module without its uniforms; `entry` is the name of a whole shader's entry function.

    `kept`: numbers have the digits that they were written with. `shell` is the function around the chain and the values
    that it takes: its body is a part of its own where the target's template has the function around it.
    """
    printer = printer_for(target, module)
    printer.comments = comments
    printer.stage, printer.keeps_text = stage, kept
    if behind is not None:
        printer.comment_behind = behind
    if source is not None:
        printer.source = source
    inlined = shell[0] if shell is not None and target.fragment_result else None
    return {
        "types": [lines for struct in module.structs if (lines := printer.print_struct(struct))],
        "constants": [[line for constant in module.constants for line in printer.print_constant(constant)]],
        "variables": [
            printer.print_layout(),
            [line for variable in module.variables for line in printer.print_variable(variable)],
        ],
        "functions": [printer.print_function(function) for function in module.functions if function is not inlined],
        "shell": [printer.print_body(inlined, _texts(target, printer, inlined, shell[1]))] if inlined and shell else [],
        "entry": [printer.print_entry(entry)] if stage is not None else [],
        "imports": [printer.print_imports()],
    }


def emit(
    target: Target, program: Program, form: str, templates: str | None = None, standalone: bool = False
) -> Emitted:
    """Prints the uniforms and renders every file of a form. Raises SssgenError for a faulty template.

    `standalone`: the runtime of modules for the web is inside of the module, in place of a file beside it.
    """
    marks: list[Span] = []
    context, members, size, bindings = _printed(target, program, form, marks)
    embedded = {name: _printed(*inner, form, marks)[0] for name, inner in program.embedded.items()}
    context["embedded"] = embedded
    contexts = [("", context), *((f"embedded.{name}.", inner) for name, inner in embedded.items())]
    files: dict[str, str] = {}
    lines: dict[str, dict[int, Span]] = {}
    outputs = target.files.get(form, ())
    context["runtime"] = _runtime(target, outputs, standalone)
    for output in outputs:
        name = target.file_name(output, program.about.name)
        if output.needs and not context[output.needs]:
            continue
        if output.sources:
            if not (standalone and _is_inlined(output, outputs)):
                files[name] = runtime_text(output.sources, target.folder)
            continue
        own = context
        if output.without:
            own = _printed(target, program, form, marks, output.without)[0]
            contexts.append(("", own))
        if output.note:
            own = {**own, "header": [*own["header"], output.note]}
        if output.graph:
            own = {**own, "graph": _graph(target, output, own)}
        text = render(output.template, own, templates, target.folder)
        if text.strip():  # a template may have nothing to say about a material
            files[name], lines[name] = _finish(text, marks)
    if form == "shader" and templates is None:  # a template of the user may leave a place out
        check_places(target, [output.template for output in outputs if output.template], contexts)
    embedded_calls = {name: _calls(inner) for name, inner in embedded.items()}
    return Emitted(files, lines, members, size, bindings, _calls(context), embedded_calls)


def _graph(target: Target, output: OutputFile, context: Mapping[str, Any]) -> Any:
    graph = _imported(output.graph)
    if graph is None:
        raise failure(f"target '{target.name}' names a graph that does not exist: {output.graph}")
    return graph(context)


def _runtime(target: Target, outputs: Sequence[OutputFile], standalone: bool) -> dict[str, str]:
    """The file that a module imports, and its text where the module contains it; empty where there is none."""
    for output in outputs:
        if output.sources:
            inlined = standalone and _is_inlined(output, outputs)
            return {"file": output.name, "text": inlined_text(output.sources, target.folder) if inlined else ""}
    return {}


def _is_inlined(runtime: OutputFile, outputs: Sequence[OutputFile]) -> bool:
    """Whether a runtime can be inside of another file: both are modules of JavaScript."""
    return is_module(runtime.sources) and any(
        output.template and output.name.endswith((".js", ".mjs")) for output in outputs
    )


def _calls(context: Mapping[str, Any]) -> dict[str, list[Argument]]:
    return {kind: entry["params"] for kind, entry in context["entries"].items()}


def _printed(
    target: Target, program: Program, form: str, marks: list[Span], without: Collection[str] = ()
) -> tuple[dict[str, Any], list[Member], int, list[TextureBinding]]:
    """A template's variables without some entries, and where its uniforms and textures are."""
    module = program.module
    inputs = {kind: names for kind, (_, names) in program.entries.items() if kind not in without}
    fields = {field.name for field in program.surface.fields} if program.surface is not None else set()
    used = used_frame(target, inputs, program.shell[1] if program.shell else None, fields)
    if form == "shader" and program.shell is None and not target.fragment_shell:
        check_inputs(used.target, inputs)
    printer = printer_for(target, module)
    owners = {uniform.name: program.source_names.get(uniform.name, uniform.name) for uniform in module.uniforms}
    printer.groups = {name: program.owners[source][0] for name, source in owners.items() if source in program.owners}
    members, size = place(module.uniforms, target.layout)
    textures = [uniform for uniform in module.uniforms if isinstance(uniform.type, Sampler)]
    declares = target.declares(form)
    uniform_lines: list[Line] = printer.print_uniforms(members) if declares else []
    texture_lines: list[Line] = printer.print_textures(textures) if declares else []
    code = {
        "types": _text(program.parts["types"], marks),
        "constants": _text(program.parts["constants"], marks),
        "uniforms": _text([uniform_lines], marks),
        "textures": _text([texture_lines], marks),
        "declarations": _text([uniform_lines, texture_lines], marks),
        "variables": _text(program.parts["variables"], marks),
        "functions": _text(_functions(program, {*inputs, *named(used)}), marks),
        "entry": _text(program.parts["entry"], marks),
        "shell": _text(program.parts["shell"], marks),
        "imports": _text(program.parts["imports"], marks),
    }
    used = used._replace(frame={**used.frame, LIBRARY: library(used.target.frame, code.values())})
    bindings = [printer.binding(index) for index in range(len(textures))] if declares else []
    context = _context(used, fields, inputs, program, printer, form, code) | {"padding": padding(members)}
    return context, members, size, [place for place in bindings if place]


def _functions(program: Program, called: Collection[str]) -> list[list[Line]]:
    """The printed functions without those that only other entries, or functions of the frame, call."""
    reached = program.reached
    left = frozenset[str]().union(*(names for root, names in reached.items() if root in called))
    out = frozenset[str]().union(*(names for root, names in reached.items() if root not in called)) - left
    if not out:
        return list(program.parts["functions"])
    functions = zip(program.module.functions, program.parts["functions"], strict=True)
    return [lines for function, lines in functions if function.name not in out]


def _text(parts: Sequence[Sequence[Line]], marks: list[Span]) -> str:
    """The lines as text with their marks; empty lines separate the parts."""
    blocks = []
    for part in parts:
        texts = []
        for line in part:
            if line.span.file:
                texts.append(f"{line.text}\x02{len(marks)}\x03")
                marks.append(line.span)
            else:
                texts.append(line.text)
        if texts:
            blocks.append("\n".join(texts))
    return "\n\n".join(blocks)


def _context(
    used: UsedFrame, fields: Collection[str], kinds: Collection[str], program: Program, printer: Printer, form: str,
    code: dict[str, str],
) -> dict[str, Any]:  # fmt: skip
    """The variables of a template, with the entries of these kinds; docs/templates.md documents them."""
    target, surface = used.target, program.surface
    entries = {kind: _entry(target, printer, kind, *program.entries[kind], program.frame_functions) for kind in kinds}
    inputs = {name for kind in kinds for name in program.entries[kind][1]}
    uniforms = [(uniform, program.source_names.get(uniform.name, uniform.name)) for uniform in program.module.uniforms]
    check_properties(target, [source for _, source in uniforms])
    textures = [(uniform, uniform.type, source) for uniform, source in uniforms if isinstance(uniform.type, Sampler)]
    members = [{"name": field.name, "type": printer.type(field.type)} for field in surface.fields] if surface else []
    per_light = [program.surface_reads[kind] for kind in PER_LIGHT if kind in kinds]
    read_per_light = frozenset(named_per_light(used)).union(*per_light)
    texts_of_names = {**target.spelling, **program.frame_functions} | _surface_values(target, printer, fields)
    passes = pass_variables(target, program.module.uniforms, program.source_names)
    return {
        "frame": Places({place: with_names(text, texts_of_names) for place, text in used.frame.items()}),
        "surface": Places({place: with_names(text, texts_of_names) for place, text in used.surface.items()}),
        "material": program.about._asdict(),
        "facts": {*program.about.facts, *used.facts},
        "target": target,
        "form": form,
        "header": _header(target, program, form),
        "code": code,
        "uniforms": [
            uniform_variables(printer, uniform, source)
            for uniform, source in uniforms
            if not isinstance(uniform.type, Sampler)
        ],
        "textures": [
            {**texture_variables(printer, *texture, index), **_needed_variables(program, texture[0])}
            for index, texture in enumerate(textures)
        ],
        "passes": passes,
        "pictures": [drawn for drawn in passes if drawn["name"] not in VOLUMES],
        "volumes": [drawn for drawn in passes if drawn["name"] in VOLUMES],
        "entries": entries,
        "inputs": inputs,
        "surface_fields": members,
        "light_fields": [member for member in members if member["name"] in read_per_light],
        "library": [function.name for function in program.module.functions],
        "encoded": program.encoded or "output" in entries,
        "workgroup": program.module.workgroup,
        "later_glsl": program.later_glsl or bool(printer.buffers or printer.images),
        "numbers_samples": any(variable.builtin.startswith("gl_Sample") for variable in program.module.variables),
        "varying_locations": program.stage is not None and program.stage.passes_locations,
    }


def _surface_values(target: Target, printer: Printer, fields: Collection[str]) -> dict[str, str]:
    """Each value of the surface as an expression: a member, or the default where no technique writes it."""
    surface = target.inputs.get("surface", "surface")
    return {
        field.name: f"{surface}.{field.name}"
        if field.name in fields
        else printer.expr(literal(field.type, field.default, NOWHERE))
        for field in FIELDS
    }


def _header(target: Target, program: Program, form: str) -> list[str]:
    """The comment at the head of a file: its contents, and where to change them."""
    about = program.about
    description = f"{about.title}: {about.doc}" if about.doc else about.title
    origin = "the material" if program.entries else "the source"
    notice = f"Made by sssgen for {target.title}. Change {origin} and emit it again rather than this file."
    head = ["", *map(comment_text, about.head)] if about.head else []
    sides = ["Two-sided: drawn without culling; back faces have the reversed normal."] if about.two_sided else []
    made_for = f"Made for the body of {' and '.join(about.bodies)}: on another mesh the light inside is wrong."
    supplied = [_supplied(target, program, uniform, form) for uniform in program.module.uniforms]
    needed = [*([made_for] if about.bodies and not about.raymarched else []), *supplied]
    lines = [line for text in needed for line in textwrap.wrap(text, 100)]
    return [comment_text(line) for line in (*textwrap.wrap(description, 100), notice, *sides, *lines)] + head


def needed(program: Program, texture: Uniform) -> str | None:
    """What to do for a texture that a picture needs; None where it is optional, or drawn for each frame.

    A volume of light is computed from a file, which is needed.
    """
    return _needed_variables(program, texture)["needed"]


def _needed_variables(program: Program, texture: Uniform) -> dict[str, str | None]:
    """What to do for a needed texture, and its file."""
    source = program.source_names.get(texture.name, texture.name)
    drawn = pass_name(texture) and not is_volume(texture)
    how, file = (
        (None, None) if drawn else program.about.needs.get(program.owners.get(source, ("", source)), (None, None))
    )
    return {"needed": how, "file": file}


def _supplied(target: Target, program: Program, uniform: Uniform, form: str) -> str:
    """How a texture that is drawn or baked is supplied, or ''."""
    drawn = pass_name(uniform)
    baked = bool(program.entries) and is_baked(uniform)  # a texture of plain GLSL may hold anything
    if not isinstance(uniform.type, Sampler) or not (drawn or baked):
        return ""
    name = uniform.name
    if target.properties.style != "plain":  # its user sees the property only
        name = property_name(target, program.source_names.get(name, name))
    if not drawn:
        return f"{name}: bake it from the body (sssgen bake)."
    drawer = with_names(target.drawer(drawn), {"material": program.about.name}) if form == "shader" else ""
    return f"{name}: {f'drawn by {drawer}' if drawer else FRAME_PASSES[drawn].how}."


def _entry(
    target: Target,
    printer: Printer,
    kind: str,
    function: Function,
    inputs: tuple[str, ...],
    functions: Mapping[str, str],
) -> dict[str, Any]:  # fmt: skip
    """An entry with the text of its call: the shell's expressions for its inputs, then the uniforms."""
    expressions = {**target.inputs, **(target.light_inputs if kind in PER_LIGHT else {})}
    texts_of_names = {**target.spelling, **functions}
    leading = ["surface"] if len(function.params) > 0 and isinstance(function.params[0].type, Struct) else []
    names = [*leading, *inputs]
    params: list[Argument] = []
    for index, param in enumerate(function.params):
        name = names[index] if index < len(names) else ""
        uniform = "" if name else param.passes
        text = with_names(expressions.get(name, name), texts_of_names) if name else _passed(printer, param, uniform)
        params.append(
            {
                "name": param.name, "type": printer.type(param.type), "base": spell(param.type),
                "input": name, "uniform": uniform, "expression": text,
            }
        )  # fmt: skip
    call = _call(function.name, [param["expression"] for param in params])
    return {"name": function.name, "params": params, "result": printer.type(function.result), "call": call}


def _call(name: str, arguments: Sequence[str]) -> str:
    """The text of a call, on several lines where it is long. The indent leaves room for what stands before the call."""
    lines = wrap(f"{' ' * 24}{name}({', '.join(arguments)})", NOWHERE)
    return "\n            ".join([line.text.strip() for line in lines])


def _texts(target: Target, printer: Printer, shell: Function, inputs: Sequence[str]) -> dict[str, str]:
    """What the body of a shell reads in place of its parameters."""
    texts = [target.inputs.get(name, name) for name in inputs]
    texts += [_passed(printer, param, param.passes) for param in shell.params[len(inputs) :]]
    return {param.name: text for param, text in zip(shell.params, texts, strict=True)}


def _passed(printer: Printer, param: Param, uniform: str) -> str:
    """A uniform as an argument; the shell has it under the uniform's name, not under the parameter's."""
    for types, text in printer.target.arguments.items():
        if spell(param.type) in types.split():
            return with_names(text, {"name": uniform, "type": printer.type(param.type)})
    return printer.shell_argument(Local(param.type, uniform, param.span), param)


def _finish(text: str, marks: list[Span]) -> tuple[str, dict[int, Span]]:
    """Removes the marks and superfluous blank lines; returns the text and the source span of each line."""
    lines: list[str] = []
    spans: dict[int, Span] = {}
    for line in text.split("\n"):
        mark = _MARK.search(line)
        if mark is not None:
            line = line[: mark.start()] + _MARK.sub("", line[mark.end() :])
        line = line.rstrip()
        if line.lstrip() == NO_LINES or (not line and (not lines or not lines[-1] or lines[-1].endswith("{"))):
            continue
        if lines and not lines[-1] and line.lstrip().startswith("}"):
            lines.pop()
        lines.append(line)
        if mark is not None and int(mark[1]) < len(marks):  # a template may contain the characters of a mark
            spans[len(lines)] = marks[int(mark[1])]
    while lines and not lines[-1]:
        lines.pop()
    return "\n".join(lines) + "\n", spans
