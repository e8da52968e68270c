"""The passes of every way into the pipeline, in their order, as data.

>>> from sssgen.pipeline import pass_list
>>> print(pass_list.describe(pass_list.MATERIAL).splitlines()[5])
 6  prune         remove what is not used, so that nothing of it is moved or renamed
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from sssgen.ir.nodes import Module
from sssgen.lang.source_lines import source_line
from sssgen.passes.aliases import drop_aliases
from sssgen.passes.capabilities import Capabilities
from sssgen.passes.conversions import drop_conversions
from sssgen.passes.legal.nested_arrays import nested_arrays
from sssgen.passes.legal.plain_loops import plain_loops
from sssgen.passes.legal.result_structs import result_structs
from sssgen.passes.legal.single_exit import single_exits
from sssgen.passes.link import LinkError
from sssgen.passes.numpy.predicate import predicate
from sssgen.passes.stage.stage_interface import colors_in_use, entry_of, turned_derivatives
from sssgen.passes.stage.storage_layout import has_buffers
from sssgen.passes.stage.vertex_reads import with_levels
from sssgen.passes.uniforms_to_parameters import uniforms_to_parameters
from sssgen.passes.unsupported import Unsupported
from sssgen.pipeline import steps
from sssgen.pipeline.frame_functions import add_frame_functions
from sssgen.pipeline.state import State
from sssgen.pipeline.trace import Trace
from sssgen.support.diagnostics import Diagnostic, SssgenError


class Condition(NamedTuple):
    """When a pass runs."""

    text: str
    holds: Callable[[State], bool]


class Pass(NamedTuple):
    """One step from a module to the next. An analysis returns the same module and stores its result in the state."""

    name: str
    step: Callable[[State], Module]
    reason: str
    """What it does, and why at this position, in one line."""
    when: Condition | None = None
    """None: always."""


def _target(text: str, holds: Callable[[Capabilities], bool]) -> Condition:
    """A condition on what the target's language can express."""
    return Condition(f"the target {text}", lambda state: holds(state.target.capabilities))


_SHADER = Condition("it is a whole shader", lambda state: state.whole_shader)
_COMPUTE = Condition("it is a compute shader", lambda state: bool(state.module.workgroup))
_MEMORY = Condition(
    "it is a compute shader, or has storage buffers or images",
    lambda state: bool(state.module.workgroup) or has_buffers(state.module),
)
_NO_MAIN = Condition(
    "there are module variables and no main()",
    lambda state: bool(state.module.variables) and entry_of(state.module) is None,
)
_PARTNER = Condition(
    "it is a whole shader and the other stage is given",
    lambda state: state.whole_shader and state.partner is not None,
)
_Y_DOWN = Condition("it is a whole shader and y counts down", lambda state: state.whole_shader and state.y_down)
_NO_VERTEX_LEVELS = Condition(
    "it is a vertex or compute shader and the target has no implicit levels there",
    lambda state: state.form in ("vertex", "compute") and not state.target.capabilities.implicit_levels,
)
_MATERIAL = Condition("it is a whole material", lambda state: state.material is not None and state.form == "shader")
_SHELL = Condition("the target has no engine", lambda state: state.has_shell)
_CALLED = Condition("the called functions are given", lambda state: state.called is not None)
_NO_LEVELS = _target("has no derivatives in non-uniform flow", lambda can: not can.implicit_levels)
_NEVER_UNDEFINED = _target(
    "refuses undefined constants, also as variables",
    lambda can: not can.undefined_constants and can.folded_variables,
)
_LATE = _target(
    "refuses undefined constants, but no variables", lambda can: not (can.undefined_constants or can.folded_variables)
)
_NO_VARIABLES = _target("has no module variables", lambda can: not can.module_variables)
_CONSTANT_VALUES = Condition(
    "a module variable can only begin with a constant",
    lambda state: state.target.capabilities.module_variables and not state.target.capabilities.variable_values,
)
_FLAT_VARYINGS = Condition(
    "it is a whole shader and the target passes no structs in structs",
    lambda state: state.whole_shader and not state.target.capabilities.nested_varyings,
)
_PARAMETERS = Condition("the form passes uniforms as parameters", lambda state: state.form in state.target.parameters)
_MASKS = _target("has no control flow per lane", lambda can: not can.lane_control_flow)

_FLAT_ARRAYS = _target("has no arrays of arrays", lambda can: not can.nested_arrays)

_NO_REFERENCES = _target(
    "has neither out parameters nor pointers", lambda can: not (can.out_parameters or can.pointers)
)
_PLAIN_LOOPS = _target("evaluates a loop's head once", lambda can: not can.loop_heads)
_ONE_EXIT = _target("returns at a function's end", lambda can: not can.early_returns)

_FOLD = Pass("fold", steps.fold_constants, "compute constants; before prune, which removes the dead branches' uses")
_UNDEFINED = Pass(
    "undefined", steps.refuse_undefined_constants, "refuse constants without a value; fold has left exactly these"
)
_PRUNE = Pass("prune", steps.prune_unused, "remove what is not used, so that nothing of it is moved or renamed")
_ALIASES = Pass(
    "aliases", steps.on_module(drop_aliases), "give each value one name; conversions and prune leave others behind"
)
_HOIST = Pass("hoist", steps.hoist_derivatives, "move derivatives and texture reads out of non-uniform flow")
_GUARDS = Pass(
    "guards", steps.insert_guards, "guard operations that may fail; the program is final and uniforms have their hints"
)

MATERIAL: tuple[Pass, ...] = (
    Pass("link", steps.link_stages, "bind slots and merge the techniques into one module, which all others need"),
    Pass("chain", steps.assemble_chain, "assemble the functions that the shell calls, from the linked functions"),
    Pass("shell", steps.write_shell, "write the shell around these functions, which is simplified with them", _SHELL),
    _FOLD,
    _UNDEFINED,
    Pass("conversions", steps.on_module(drop_conversions), "remove conversions, which serve the type check alone"),
    _PRUNE,
    Pass("frame", steps.find_frame, "find the values that the target supplies to what is left of the shell", _SHELL),
    _ALIASES,
    _HOIST,
    _GUARDS,
    Pass("cost", steps.count_cost, "count the operations of the program that all targets get"),
)
"""A material. Of the target they depend on its lighting and shell, on whether the engine encodes colours, and on its
precision: their result is cached for all targets that agree in these."""

_SHADER_INPUT: tuple[Pass, ...] = (
    Pass("uniform_structs", steps.split_uniforms, "split uniforms of structs, where the target has none of these"),
    Pass("color_outputs", steps.on_module(colors_in_use), "shorten gl_FragData to the elements in use", _SHADER),
    Pass("vertical_derivatives", steps.on_module(turned_derivatives), "negate dFdy, which keeps its sign", _Y_DOWN),
    Pass(
        "vertex_levels", steps.on_module(with_levels), "read textures at level 0, as GLSL does there", _NO_VERTEX_LEVELS
    ),
    Pass("partner", steps.match_partner, "check that the other stage fits, and interpolate as it does", _PARTNER),
    Pass(
        "varying_parts",
        steps.split_varyings,
        "pass the parts of nested structs; of both stages, which are matched by them",
        _FLAT_VARYINGS,
    ),
    Pass("differences", steps.note_differences, "report what the target's stage cannot have", _SHADER),
)

SIMPLIFY: tuple[Pass, ...] = (
    Pass("roots", steps.find_roots, "take every function as called from outside"),
    _FOLD,
    _UNDEFINED,
    _PRUNE,
    _HOIST,
)
"""Plain functions without anything that depends on a target."""

PLAIN: tuple[Pass, ...] = (*_SHADER_INPUT, *SIMPLIFY, _ALIASES, _GUARDS)
"""A module of plain functions, or a whole shader."""

KEPT: tuple[Pass, ...] = (
    *_SHADER_INPUT,
    Pass("called", steps.drop_uncalled, "leave out the functions that the called ones do not need", _CALLED),
    Pass("roots", steps.find_roots, "take every function as called from outside"),
    _UNDEFINED._replace(reason="refuse constants without a value", when=_NEVER_UNDEFINED),
    Pass("late_constants", steps.compute_constants_late, "have the device compute constants without a value", _LATE),
    _HOIST._replace(step=steps.hoist_derivatives_of_entry, when=_NO_LEVELS),
    _GUARDS,
)
"""The same, where the text stays as its author wrote it."""

TARGET: tuple[Pass, ...] = (
    Pass("frame_functions", add_frame_functions, "add the functions that the target's frame calls", _MATERIAL),
    Pass(
        "computed_variables",
        steps.compute_variables_in_functions,
        "declare variables in the functions that read them",
        _NO_MAIN,
    ),
    Pass(
        "memory",
        steps.check_shared_memory,
        "refuse storage buffers and images that the target lacks, and copies of atomics",
        _MEMORY,
    ),
    Pass("host_uniforms", steps.pass_host_uniforms, "make uniforms of what only the program knows there", _MEMORY),
    Pass(
        "variable_parameters", steps.pass_variables, "pass module variables to functions as parameters", _NO_VARIABLES
    ),
    Pass(
        "interface_arrays",
        steps.replace_interface_arrays,
        "copy arrays of the interface that a target cannot have",
        _SHADER,
    ),
    Pass("initial_values", steps.set_variables_at_start, "set module variables in main()", _CONSTANT_VALUES),
    Pass("uniform_parameters", steps.on_module(uniforms_to_parameters), "pass uniforms as parameters", _PARAMETERS),
    Pass("nested_arrays", steps.on_module(nested_arrays), "put the arrays in arrays into structs", _FLAT_ARRAYS),
    Pass("legalise", steps.legalise_nodes, "rewrite what the target cannot express; printing is then a table"),
    Pass("result_structs", steps.on_module(result_structs), "return what a function writes", _NO_REFERENCES),
    Pass("plain_loops", steps.on_module(plain_loops), "make loops that count or test a plain value", _PLAIN_LOOPS),
    Pass(
        "single_exits",
        steps.on_module(single_exits),
        "return once; after the passes that add returns and loops",
        _ONE_EXIT,
    ),
    Pass("masks", steps.on_module(predicate), "replace control flow by masks; no other pass expects these", _MASKS),
    Pass("names", steps.make_names_legal, "make names legal; every pass before may bring new ones"),
    Pass("interface", steps.find_interface, "place inputs and outputs, under their final names", _SHADER),
)
"""The passes for one target, after one of the other lists."""


def run(passes: Sequence[Pass], state: State, trace: Trace | None = None) -> State:
    """Runs the passes on the state. Raises SssgenError."""
    for pass_ in passes:
        try:
            if pass_.when is None or pass_.when.holds(state):
                state.module = pass_.step(state)
        except LinkError as error:
            raise SssgenError([_error(error.message, error)]) from None
        except Unsupported as error:
            errors = [_error(f"{each.message} ({state.target.name})", each) for each in (error, *error.more)]
            raise SssgenError(errors) from None
        if trace is not None:
            trace.record(pass_.name, pass_.reason, state.module)
    return state


def _error(message: str, error: LinkError | Unsupported) -> Diagnostic:
    return Diagnostic("error", message, error.span, error.hint, source_line(error.span))


def describe(passes: Sequence[Pass]) -> str:
    """The passes as a table: number, name, condition, reason."""
    rows = [(pass_.name, f"if {pass_.when.text}" if pass_.when else "", pass_.reason) for pass_ in passes]
    names, conditions = (max(len(row[column]) for row in rows) for column in (0, 1))
    lines = [
        f"{number:2}  {name:{names}}   {condition:{conditions}}   {reason}"
        for number, (name, condition, reason) in enumerate(rows, 1)
    ]
    return "\n".join(lines)
