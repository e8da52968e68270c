"""The Metal Shading Language, read by g++ with a small library of this project's in place of Metal's own.

No compiler of Apple's runs on Linux. `metal_standin/` declares what emitted shaders use of `metal_stdlib`, and is as
strict as it: no mixed vectors, no other functions. What C++ does not know is checked in the text: a reference and a
variable outside of functions need an address space.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

from sssgen.run.compilers.compiler_interface import Compiler, CompilerMissing, Message, Severity, Source

STANDIN = Path(__file__).with_name("metal_standin")
"""The stand-in for Metal's headers."""
OPTIONS = ("-std=c++17", "-x", "c++", "-fsingle-precision-constant", "-ffp-contract=off", "-fwrapv", "-I", str(STANDIN))
"""Metal's literals are floats."""

_SEVERITY: dict[str, Severity] = {"error": "error", "fatal error": "error", "warning": "warning", "note": "info"}
_NAME = "shader.metal"
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_REFERENCE = re.compile(r"(?:(\w+)\s+)?\b(\w+(?:<(?:[^<>()]|<(?:[^<>()]|<[^<>()]*>)*>)*>)?)&\s+(\w+)\b")
_LOOSE = re.compile(
    r"^(?:(?:static|const|constexpr)\s+)*(\w+)(?:<[^<>()]*>)?\s+(\w+)(?:\[\w*\])?\s*(?:=[^;]*)?;", re.MULTILINE
)
_ENTRIES = {"vertex": "vertex", "fragment": "fragment", "compute": "kernel"}
"""Stage → the word before its entry function."""


class Metal(Compiler):
    """Runs one g++ process a check; it reads standard input and writes nothing."""

    name = "metal"

    def __init__(self, program: str) -> None:
        self.program = program

    def version(self) -> str:
        text = subprocess.run([self.program, "-dumpfullversion"], capture_output=True, text=True, check=False).stdout
        return f"g++ {text.strip()} with a stand-in for metal_stdlib"

    def check(self, source: Source) -> list[Message]:
        reported = placeless(source.text)
        word = _ENTRIES.get(source.stage)
        if word and not re.search(rf"^{word}\s.*\b{source.entry}\(", source.text, re.MULTILINE):
            reported.append(Message("error", 0, 0, f"there is no {word} function {source.entry}"))
        command = [self.program, *OPTIONS, "-fsyntax-only", "-Wno-attributes", "-"]
        completed = subprocess.run(
            command, input=with_swizzles(source.text), capture_output=True, encoding="utf-8", check=False
        )
        reported += messages(completed.stderr)
        if completed.returncode and not any(message.severity == "error" for message in reported):
            reported.append(Message("error", 0, 0, completed.stderr.strip() or f"exit status {completed.returncode}"))
        return reported


def find() -> Metal:
    """g++ on the path. Raises CompilerMissing where there is none."""
    program = shutil.which("g++")
    if program is None:
        raise CompilerMissing("g++ (Debian: g++)")
    return Metal(program)


def with_swizzles(text: str, included: bool = False) -> str:
    """The text after the declarations of the swizzles that it uses; its own line numbers stay as they were.

    `included`: the library comes before the text, which may be a part of a file.
    """
    words = sorted(set(re.findall(r"\.([xyzw]{2,4}|[rgba]{2,4})\b", text)))
    head = [f"#define METAL_SWIZZLES_{size} {_swizzles(words, size)}" for size in (2, 3, 4)]
    head += ["#include <metal_stdlib>"] if included else []
    return "\n".join([*head, f'#line 1 "{_NAME}"', text])


def _swizzles(words: list[str], size: int) -> str:
    """The members of a vector of that size for the swizzles that it can have."""
    members = []
    for word in words:
        places = ["xyzw".find(letter) if letter in "xyzw" else "rgba".find(letter) for letter in word]
        if max(places) < size:
            members.append(f"swizzle<T, {size}, {', '.join(map(str, places))}> {word};")
    return " ".join(members)


def placeless(text: str) -> list[Message]:
    """The references and the variables outside of functions that have no address space."""
    bare = _COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    wrong = [
        Message("error", bare.count("\n", 0, match.start(3)) + 1, 0, f"the reference '{match[3]}' has no address space")
        for match in _REFERENCE.finditer(bare)
        if match[1] not in ("thread", "constant", "device", "threadgroup")
    ]
    wrong += [
        Message("error", bare.count("\n", 0, match.start(2)) + 1, 0, f"'{match[2]}' has no address space")
        for match in _LOOSE.finditer(bare)
        if match[1] not in ("constant", "using", "struct", "return")
    ]
    return wrong


def messages(log: str) -> list[Message]:
    """The messages in g++'s log; those about the stand-in's own lines are with the line that uses them."""
    result = []
    for line in log.splitlines():
        if match := re.match(r"(.+?):(\d+):(\d+): (fatal error|error|warning|note): (.*)", line):
            own = match[1] == _NAME
            place = (int(match[2]), int(match[3])) if own else (0, 0)
            result.append(Message(_SEVERITY[match[4]], *place, match[5], "" if own else Path(match[1]).name))
    return result
