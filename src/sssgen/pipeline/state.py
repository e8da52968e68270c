"""What the passes share: the module, the settings of the command, and the results of the passes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from sssgen.ir.formats import FLOAT16, FLOAT32, Format
from sssgen.ir.nodes import Function, Module
from sssgen.ir.types import Struct
from sssgen.material.chain_assembly import Entry
from sssgen.material.model import Material
from sssgen.passes.cost import Cost
from sssgen.passes.guards import GuardedModule
from sssgen.passes.ranges.sites import Site
from sssgen.passes.stage.stage_interface import Stage
from sssgen.passes.unsupported import Note
from sssgen.pipeline.material_stages import TargetTechnique
from sssgen.targets.descriptor import Target


@dataclass
class State:
    """A program between two passes."""

    module: Module
    form: str = "functions"
    """shader, functions, vertex, fragment or compute; the last three are whole shaders of plain GLSL."""
    guards: str = "none"
    """auto, all or none"""
    chosen: Target | None = None
    """None where only passes run that depend on no target."""
    keep: bool = False
    """Whether the text stays as its author wrote it, except what the target cannot express."""
    called: Sequence[str] | None = None
    """The keys of the functions that are called from outside, where only some are."""
    guard_action: Callable[[Site], str] | None = None
    """What becomes of a single guard; see `at` of `passes.guards.guard`."""
    chained: bool = False
    """Whether the functions are techniques, whose parameters have the ranges of their names."""
    partner: Module | None = None
    """The other stage of a whole shader, where it is given."""
    bottom_first: bool = False
    """Whether the first row of a picture is its bottom row, as in OpenGL, also where y counts from the top."""
    material: Material | None = None

    roots: list[str] = field(default_factory=list)
    """The keys of the functions from which all others are reached."""
    stages: list[TargetTechnique] = field(default_factory=list)
    linked: tuple[Function, ...] = ()
    """The function of each stage in `module`."""
    fixed: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    """The uniforms that the material fixes, with their values."""
    owners: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    """A uniform → its technique and its name there."""
    settings: Mapping[str, list[tuple[int, str]]] = field(default_factory=dict)
    """A uniform → the stages of the material that may give it a value, and its name there."""
    slots: frozenset[str] = frozenset()
    """The keys of the functions that are bound to slots."""
    entries: Mapping[str, Entry] = field(default_factory=dict)
    surface: Struct | None = None
    """The struct of the chain's surface."""
    shell: Entry | None = None
    """The shell with the values that the target supplies; None where the target's engine has it."""
    frame_functions: dict[str, Function] = field(default_factory=dict)
    """The functions that the target's frame calls, by their names there."""
    frame_names: Mapping[str, str] = field(default_factory=dict)
    """Their names there → their names in the text."""
    notes: list[Note] = field(default_factory=list)
    guarded: GuardedModule | None = None
    costs: Mapping[str, Cost] = field(default_factory=dict)
    source_names: Mapping[str, str] = field(default_factory=dict)
    """A uniform's final name → its name before."""
    renames: Mapping[str, str] = field(default_factory=dict)
    variable_names: Mapping[str, str] = field(default_factory=dict)
    """A module variable's final name → its name in the source."""
    stage: Stage | None = None
    """The interface of a whole shader."""

    @property
    def target(self) -> Target:
        assert self.chosen is not None
        return self.chosen

    @property
    def format(self) -> Format:
        """The number format in which the target's text computes."""
        return FLOAT16 if self.target.half_of else FLOAT32

    @property
    def has_shell(self) -> bool:
        """Whether the program has a shell: a whole material for a target without an engine."""
        return self.form == "shader" and bool(self.target.fragment_shell)

    @property
    def keeps_structs(self) -> bool:
        """Whether uniforms that are structs stay as the author wrote them: programs set their members by name."""
        return self.keep and self.whole_shader and self.target.capabilities.struct_uniforms

    @property
    def whole_shader(self) -> bool:
        return self.form in ("vertex", "fragment", "compute")

    @property
    def y_down(self) -> bool:
        """Whether y counts from the top of the picture."""
        return self.turned_framebuffer and not self.bottom_first

    @property
    def turned_framebuffer(self) -> bool:
        """Whether y counts from the top of the target's framebuffer."""
        return self.target.conventions.framebuffer_y == "down"

    @property
    def stage_builtins(self) -> set[str]:
        """The inputs and outputs of a stage that the target has; a descriptor that lists none has those of GLSL."""
        return set(self.target.stage_builtins) or {variable.builtin for variable in self.module.variables}

    @property
    def entry_name(self) -> str:
        """The target's name of the function with which a whole shader begins; '' in the other forms."""
        return self.target.files[self.form][0].stages[self.form] if self.whole_shader else ""
