"""Unity's shaders, compiled outside Unity: preprocessed with Unity's headers, then given to glslang or DXC.

Unity's headers are not part of this project. SSSGEN_UNITY_INCLUDES names a folder with `CGIncludes/` and
`Packages/com.unity.render-pipelines.{core,universal}/` (an installed Unity has both), or several, separated as in PATH:
then every version of the packages compiles the text. Without it the stand-in headers of `unity_standin/` are used,
which declare only what is needed. `version()` states which.

Built-in pipeline: HLSL with DX9 samplers, so glslang reads it. URP and Shader Graph: DXC.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from sssgen.run import machine_parts
from sssgen.run.compilers import dxc, glslang, shaderlab
from sssgen.run.compilers import surface_shader as surface
from sssgen.run.compilers.calling_entry import Opaque, hlsl_entry
from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Source, Stage

_TEXT = "sssgen-text"
"""The name of the text in `#line`. A user's name could contain a quote, or be that of a header."""

STANDIN = Path(__file__).with_name("unity_standin")
"""The project's own headers, which stand in for Unity's."""

HEADERS = "CGIncludes/ and Packages/com.unity.render-pipelines.*/"

_URP = "Packages/com.unity.render-pipelines.universal/ShaderLibrary/"
_CORE = "Packages/com.unity.render-pipelines.core/ShaderLibrary/"
_GRAPH = "Packages/com.unity.shadergraph/ShaderGraphLibrary/"
_HDRP = "Packages/com.unity.render-pipelines.high-definition/Runtime/ShaderLibrary/"

# The headers that the editor includes implicitly: in CGPROGRAM, and around a surface function.
_CG_HEADERS = ("HLSLSupport.cginc", "UnityShaderVariables.cginc", "UnityShaderUtilities.cginc")
_SURFACE_HEADERS = ("UnityCG.cginc", "Lighting.cginc", "UnityPBSLighting.cginc", "AutoLight.cginc")
_LIBRARY_HEADERS = {
    "unity-builtin": (*_CG_HEADERS, *_SURFACE_HEADERS),
    "unity-urp": (_URP + "Core.hlsl", _URP + "Lighting.hlsl"),
    # in a graph's own pass in URP and in HDRP, and in the preview on a node
    "unity-shadergraph": (
        *(_CORE + name for name in ("Color.hlsl", "Texture.hlsl")),
        *(_URP + name for name in ("Core.hlsl", "Lighting.hlsl", "ShaderGraphFunctions.hlsl")),
    ),
    "high definition": (
        *(f"{_CORE}{name}.hlsl" for name in ("Common", "Packing", "Color", "Texture", "UnityInstancing")),
        _HDRP + "ShaderVariables.hlsl",
        _GRAPH + "Functions.hlsl",
    ),
    "preview": (
        *(f"{_CORE}{name}.hlsl" for name in ("Common", "Packing", "Color", "Texture", "UnityInstancing")),
        *(f"{_GRAPH}{name}.hlsl" for name in ("ShaderVariables", "ShaderVariablesFunctions", "Functions")),
    ),
}  # fmt: skip
# glslang reads the float1 of Unity's fog coordinate as a float, and refuses to assign to its .x.
_BUILTIN_MACROS = (
    "SHADER_API_D3D11=1", "SHADER_TARGET=30", "UNITY_VERSION=201940", "UNITY_PBS_USE_BRDF1=1", "float1=float2",
)  # fmt: skip
# The last one is what the editor adds for instances, which have their boxes in an array.
_URP_MACROS = (
    "SHADER_API_D3D11=1", "SHADER_TARGET=45", "UNITY_COMPILER_DXC=1", "UNITY_INSTANCED_RENDERER_BOUNDS=1",
)  # fmt: skip
_KEYWORDS_ARE_VALUES = 60000000
"""UNITY_VERSION from which headers read a declared keyword that is off as a value, `if (FOG_LINEAR)`."""
OLDEST = 202120
"""UNITY_VERSION of the first version with URP 12."""
# Unity's preprocessor expands a macro's arguments before it joins them with ##; C's does not, so that the
# instanced matrices get this name. The same is impossible for the built-in pipeline's headers: its shaders
# are compiled without instancing.
_INSTANCED = "UNITY_BUILTINS_WITH_WORLDTOOBJECTARRAYArray=unity_Builtins0Array"
# The keywords of lists of lights per part of the screen; those of other versions do nothing.
_CLUSTERS = ("_CLUSTERED_RENDERING", "_FORWARD_PLUS", "_CLUSTER_LIGHT_LOOP")
# The passes of a surface shader that is lit forward, without and with shadows.
_SURFACE_PASSES = (
    ("UNITY_PASS_FORWARDBASE=1", "DIRECTIONAL=1"),
    ("UNITY_PASS_FORWARDBASE=1", "DIRECTIONAL=1", "SHADOWS_SCREEN=1", "LIGHTPROBE_SH=1"),
    ("UNITY_PASS_FORWARDADD=1", "POINT=1"),
)
_GRAPH_TEXTURES: dict[str, Opaque] = {
    kind: (
        f"{macro}({{0}}); SAMPLER(sampler{{0}}); float4 {{0}}_TexelSize; float4 {{0}}_ST;",
        f"{build}({{0}})",
    )
    for kind, macro, build in (
        ("UnityTexture2D", "TEXTURE2D", "UnityBuildTexture2DStruct"),
        ("UnityTexture3D", "TEXTURE3D", "UnityBuildTexture3DStruct"),
        ("UnityTextureCube", "TEXTURECUBE", "UnityBuildTextureCubeStruct"),
    )
} | {"UnitySamplerState": ("SAMPLER(sampler{0});", "UnityBuildSamplerStateStruct(sampler{0})")}


@dataclass(frozen=True)
class _Job:
    """One text for the preprocessor and then a compiler."""

    what: str
    headers: tuple[str, ...]
    macros: tuple[str, ...]
    code: str
    stage: Stage
    entry: str
    builtin: bool


class Unity(Compiler):
    """Preprocesses with `root`'s headers and compiles every pass, stage and end of the keyword lists."""

    name = "unity"

    def __init__(
        self,
        root: Path,
        real: bool,
        preprocess: Callable[[str, list[str], list[Path]], str],
        others: Sequence[Unity] = (),
        unity_version: int | None = None,
    ) -> None:
        """`others` check a text too. `unity_version` is UNITY_VERSION, or None: that of the packages in `root`."""
        self.root = root
        self.real = real
        self.unity_version = unity_version or version_of(root)
        self._preprocess = preprocess
        self._others = others
        self._glslang = glslang.find()
        self._dxc = dxc.find()

    def version(self) -> str:
        headers = ", ".join(unity.headers() for unity in (self, *self._others))
        return f"{headers}, {self._glslang.version()}, {self._dxc.version()}"

    def headers(self) -> str:
        """The owner of the headers: Unity or this project."""
        return f"Unity's own headers in {self.root}" if self.real else "the project's stand-in headers"

    def preprocess(self, text: str, language: str) -> str:
        """Functions of `language` after the engine's headers, with their own line numbers.

        Raises ValueError with the preprocessor's log.
        """
        builtin = language == "unity-builtin"
        stage = "SHADER_STAGE_FRAGMENT=1"
        macros = (*_BUILTIN_MACROS, *_SURFACE_PASSES[0], stage) if builtin else self._urp_macros()
        head = "".join(f'#include "{header}"\n' for header in _LIBRARY_HEADERS[language])
        return self._preprocess(f"{head}#line 1\n{text}", list(macros), self._roots(builtin))

    def forward(self, text: str, language: str, stage: Stage, keywords: Sequence[str]) -> tuple[str, str]:
        """A stage of an emitted shader's first pass, which is the forward one, preprocessed; and its entry.

        `keywords` are macros, `NAME=1`; a surface shader's pass is one of them. Raises ValueError with the first error.
        """
        shader = shaderlab.parse(text, _TEXT, self.unity_version)
        if shader.messages:
            raise ValueError(shader.messages[0].text)
        program = shader.programs[0]
        if (surface_pragma := program.pragma("surface")) is not None:
            job = _surface_job(program, surface_pragma, stage, tuple(keywords))
        else:
            job = self._pass_job(program, stage, tuple(keywords), language == "unity-builtin")
        return self._text(job), job.entry

    def check(self, source: Source) -> list[Message]:
        messages = self._own_check(source)
        for other in self._others if source.language != "unity-builtin" else ():
            messages += [replace(m, text=f"{other.headers()}: {m.text}") for m in other._own_check(source)]
        return messages

    def _own_check(self, source: Source) -> list[Message]:
        if not re.search(r'^\s*Shader\s*"', source.text, re.MULTILINE):
            return self._run(self._library_jobs(source))
        shader = shaderlab.parse(source.text, _TEXT, self.unity_version)
        if shader.messages:
            return shader.messages
        try:
            jobs = [job for program in shader.programs for job in self._program_jobs(program, source.language)]
        except surface.SurfaceError as error:
            return [Message("error", 0, 0, str(error))]
        messages = self._run(iter(jobs))
        if source.language == "unity-urp" and not messages:
            messages += _check_batcher(shader)
        return messages

    def _library_jobs(self, source: Source) -> Iterator[_Job]:
        """Functions to paste, called once each.

        A Shader Graph include also as the node's preview and HDRP compile it; a graph sees no lights in HDRP, so that a
        text which reads them everywhere is one for URP.
        """
        language = source.language
        builtin = language == "unity-builtin"
        code = f'#line 1 "{_TEXT}"\n' + hlsl_entry(source.text, opaque=_GRAPH_TEXTURES)
        macros: tuple[str, ...] = (*_BUILTIN_MACROS, *_SURFACE_PASSES[0]) if builtin else self._urp_macros()
        entry, headers = glslang.LIBRARY_ENTRY, _LIBRARY_HEADERS[language]
        if language != "unity-shadergraph":
            yield _Job("functions", headers, macros, code, "fragment", entry, builtin)
            return
        graph = (*macros, "SHADERGRAPH_TARGET=1", "_MAIN_LIGHT_SHADOWS=1", "_LIGHT_COOKIES=1", "_LIGHT_LAYERS=1")
        for keyword in ("_ADDITIONAL_LIGHTS", *_CLUSTERS):
            yield _Job("functions", headers, (*graph, f"{keyword}=1"), code, "fragment", entry, builtin)
        if self._has(_GRAPH + "ShaderVariables.hlsl"):
            preview = (*macros, "SHADERGRAPH_PREVIEW=1")
            yield _Job("preview", _LIBRARY_HEADERS["preview"], preview, code, "fragment", entry, builtin)
        urp_only = "GetMainLight" in source.text and "UNIVERSAL_LIGHTING_INCLUDED" not in source.text
        if self._has(_HDRP + "ShaderVariables.hlsl") and not urp_only:
            hdrp = _LIBRARY_HEADERS["high definition"]
            yield _Job("HDRP", hdrp, (*macros, "SHADERGRAPH_TARGET=1"), code, "fragment", entry, builtin)

    def _program_jobs(self, program: shaderlab.Program, language: str) -> Iterator[_Job]:
        builtin = language == "unity-builtin"
        stages: tuple[Stage, ...] = ("vertex", "fragment")
        surface_pragma = program.pragma("surface")
        if surface_pragma is not None:
            for macros in _SURFACE_PASSES:
                for stage in stages:
                    yield _surface_job(program, surface_pragma, stage, macros)
            return
        for stage in stages:
            for keywords in program.keyword_sets(stage):
                defines = tuple(f"{word}=1" for word in keywords if not (builtin and word == "INSTANCING_ON"))
                yield self._pass_job(program, stage, defines, builtin)

    def _pass_job(self, program: shaderlab.Program, stage: Stage, keywords: tuple[str, ...], builtin: bool) -> _Job:
        """A stage of a pass with vertex and fragment programs of its own. Raises SurfaceError."""
        entry = program.pragma(stage)
        if entry is None:
            raise surface.SurfaceError(f"{program.name}: no #pragma {stage}")
        headers = _CG_HEADERS if program.dialect == "CG" else ()
        common = _BUILTIN_MACROS if builtin else (*self._urp_macros(), _INSTANCED)
        words, code = program.keywords(), program.code
        declared = (f"{word}_KEYWORD_DECLARED=1" for word in words)
        defines = (*common, f"SHADER_STAGE_{stage.upper()}=1", *declared, *keywords)
        if self.unity_version >= _KEYWORDS_ARE_VALUES:
            off = (word for word in words if f"{word}=1" not in keywords)
            code = "".join(f"static const bool {word} = false;\n" for word in off) + code
        return _Job(f"{program.name} {stage}", headers, defines, code, stage, entry, builtin)

    def _urp_macros(self) -> tuple[str, ...]:
        return (*_URP_MACROS, f"UNITY_VERSION={self.unity_version}")

    def _has(self, header: str) -> bool:
        return (self.root / header).is_file()

    def _run(self, jobs: Iterator[_Job]) -> list[Message]:
        unique: dict[tuple[int, int, str], Message] = {}
        compiled: set[tuple[str, str]] = set()
        for job in jobs:
            try:
                text = self._text(job)
            except ValueError as error:
                return [locate(_preprocessing_error(str(error)), job.what)]
            if (text, job.entry) in compiled:
                continue
            compiled.add((text, job.entry))
            if job.builtin:
                messages = self._glslang.check_hlsl(text, job.stage, job.entry, dx9_samplers=True)
            else:
                messages = self._dxc.check_hlsl(text, job.stage, job.entry)
            for m in messages:
                unique.setdefault((m.line, m.column, m.text), locate(m, job.what))
        return list(unique.values())

    def _text(self, job: _Job) -> str:
        """Raises ValueError with the preprocessor's log."""
        head = "".join(f'#include "{header}"\n' for header in job.headers)
        prelude = surface.PRELUDE if job.entry.startswith("sssgen_") and job.builtin else ""
        return self._preprocess(head + prelude + job.code, list(job.macros), self._roots(job.builtin))

    def _roots(self, builtin: bool) -> list[Path]:
        return [self.root / "CGIncludes", self.root] if builtin else [self.root]


def locate(message: Message, job: str) -> Message:
    """A message with the name of its job; a place outside of the text becomes part of the message."""
    if message.file in ("", _TEXT):
        return replace(message, text=f"{job}: {message.text}", file="")
    place = f"{message.file}:{message.line}"
    return Message(message.severity, 0, 0, f"{job}: {place}: {message.text}", message.file)


def _surface_job(program: shaderlab.Program, surface_pragma: str, stage: Stage, macros: tuple[str, ...]) -> _Job:
    """A stage of one of the passes that the editor makes of a surface shader; `macros[0]` names the pass."""
    code = f'{program.code}#line 1 "surface entries"\n{surface.entries(program.code, surface_pragma)}'
    pass_name = macros[0].removeprefix("UNITY_PASS_").partition("=")[0]
    defines = (*_BUILTIN_MACROS, *macros, f"SHADER_STAGE_{stage.upper()}=1")
    return _Job(pass_name, (*_CG_HEADERS, *_SURFACE_HEADERS), defines, code, stage, f"sssgen_{stage}", True)


def _check_batcher(shader: shaderlab.Shader) -> list[Message]:
    """The SRP batcher requires the same UnityPerMaterial in every pass, with every property except textures."""
    buffers = {}
    for program in shader.programs:
        match = re.search(r"CBUFFER_START\s*\(UnityPerMaterial\)(.*?)CBUFFER_END", program.code, re.DOTALL)
        buffers[program.name] = " ".join(re.sub(r"//[^\n]*", "", match[1]).split()) if match else ""
    messages = []
    if len(set(buffers.values())) > 1:
        text = f"UnityPerMaterial differs between the passes {', '.join(buffers)}"
        messages.append(Message("error", 0, 0, text))
    first = next(iter(buffers.values()), "")
    for name in shader.scalar_properties():
        if not re.search(rf"\b{name}\b", first):
            text = f"property {name} is not in UnityPerMaterial: the SRP batcher skips it"
            messages.append(Message("error", 0, 0, text))
    return messages


def find() -> Unity:
    """The headers, a C preprocessor, glslang and DXC. Raises CompilerMissing where one of them is missing."""
    configured = os.environ.get("SSSGEN_UNITY_INCLUDES") or ""
    folders = filter(None, configured.split(os.pathsep))
    roots = [Path(folder).expanduser().resolve() for folder in folders] or [STANDIN.resolve()]
    if not all(map(holds_headers, roots)):
        raise CompilerMissing(f"SSSGEN_UNITY_INCLUDES must name a folder with {HEADERS}")
    preprocess = preprocessor()
    others = [Unity(root, True, preprocess) for root in roots[1:]]
    return Unity(roots[0], roots[0] != STANDIN.resolve(), preprocess, others)


def version_of(root: Path) -> int:
    """UNITY_VERSION of a folder's packages, from their `package.json`; OLDEST where there is none."""
    try:
        package = (root / _URP).parent / "package.json"
        named = re.fullmatch(r"(\d+)\.(\d+)", json.loads(package.read_text(encoding="utf-8"))["unity"])
    except (OSError, ValueError, KeyError, TypeError):
        return OLDEST
    if named is None:
        return OLDEST
    year, release = int(named[1]), int(named[2])
    return year * 10000 + release * 100 if year >= 6000 else year * 100 + release * 10


def holds_headers(root: Path) -> bool:
    """Whether a folder has Unity's headers, of the built-in pipeline and of URP."""
    return (root / "CGIncludes" / "UnityCG.cginc").is_file() and (root / _URP / "Core.hlsl").is_file()


def preprocessor() -> Callable[[str, list[str], list[Path]], str]:
    """A C preprocessor: gcc's or clang's."""
    program = machine_parts.c_preprocessor()
    if not program:
        raise CompilerMissing("a C preprocessor (Debian: gcc · elsewhere: clang)")
    command = [program, "-E", "-x", "c", "-undef", "-nostdinc", "-w"]

    def preprocess(text: str, macros: list[str], folders: list[Path]) -> str:
        options = [f"-D{macro}" for macro in macros]
        for folder in folders:
            options += ["-I", str(folder)]
        call = [*command, *options, "-"]
        completed = subprocess.run(call, input=text, capture_output=True, encoding="utf-8", check=False)
        if completed.returncode:
            raise ValueError(completed.stderr.strip())
        output = re.sub(r"^[ \t]*#pragma.*$", "", completed.stdout, flags=re.MULTILINE)
        return re.sub(r'^# (\d+) "((?:[^"\\]|\\.)*)".*$', r'#line \1 "\2"', output, flags=re.MULTILINE)

    return preprocess


def _preprocessing_error(log: str) -> Message:
    """The first error of the C preprocessor, in the form `file:line:column: fatal error: …`."""
    match = re.search(r"^(.*?):(\d+):(\d+): (?:fatal )?error: (.*)", log, re.MULTILINE)
    if match is None:
        return Message("error", 0, 0, log)
    return Message("error", int(match[2]), int(match[3]), match[4], match[1])
