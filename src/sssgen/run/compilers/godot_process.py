"""Runs Godot on a project of its own: the program on the path, or a Debian system that `make engines` has set up.

SSSGEN_GODOT names another program.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from sssgen.run.compilers.compiler_interface import CompilerMissing
from sssgen.run.machine_parts import godots, lacks

_SAID = "said.txt"
_PROJECT = 'config_version=5\n\n[application]\n\nconfig/name="sssgen"\n'


@dataclass(frozen=True)
class Godot:
    """The program. `root` is the folder of the system that it is in, or ''."""

    program: str
    root: str = ""

    def command(self, program: str, *arguments: str) -> list[str]:
        """A command of that system."""
        return ["chroot", self.root, program, *arguments] if self.root else [program, *arguments]

    def version(self) -> str:
        """The text of `--version`. Raises OSError and SubprocessError where the program does not run."""
        command = self.command(self.program, "--headless", "--version")
        lines = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout.splitlines()
        return next((line for line in lines if re.match(r"\d+\.\d+", line)), "")

    @contextlib.contextmanager
    def project(self, files: Mapping[str, str | bytes]) -> Iterator[Path]:
        """A new project with these files, for as long as the context."""
        above = f"{self.root}/tmp" if self.root else None
        with tempfile.TemporaryDirectory(prefix="sssgen_", dir=above) as place:
            project = Path(place)
            for name, content in {"project.godot": _PROJECT, **files}.items():
                data = content if isinstance(content, bytes) else content.encode()
                (project / name).write_bytes(data)
            yield project

    def run(self, project: Path, script: str, options: Sequence[str], seconds: float, display: str = "") -> str:
        """What a script of the project prints. Raises TimeoutExpired.

        With `display` the script draws in that X display; without one there is no renderer.
        """
        process = self.start(project, script, options, display)
        try:
            process.wait(timeout=seconds)
        finally:
            process.kill()
            process.wait()
        return said_in(project)

    def start(self, project: Path, script: str, options: Sequence[str], display: str = "") -> subprocess.Popen[bytes]:
        """The process that runs a script of the project, likewise."""
        inside = project.as_posix().removeprefix(self.root) if self.root else project.as_posix()
        arguments = ["--path", inside, "--audio-driver", "Dummy", "--script", script]
        command = self.command(self.program, *([] if display else ["--headless"]), *options, *arguments)
        environment = {**os.environ, "HOME": "/tmp", **({"DISPLAY": display} if display else {})}
        with (project / _SAID).open("wb") as said:
            return subprocess.Popen(command, env=environment, stdout=said, stderr=subprocess.STDOUT)

    @contextlib.contextmanager
    def display(self) -> Iterator[str]:
        """An X display of its own, for as long as the context. Raises CompilerMissing without Xvfb."""
        command = self.command("Xvfb", "-displayfd", "1", "-screen", "0", "640x480x24", "-nolisten", "tcp")
        if not self.root and shutil.which("Xvfb") is None:
            raise CompilerMissing("Xvfb (Debian: xvfb)")
        server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        assert server.stdout is not None
        try:
            number = server.stdout.readline().decode().strip()
            if not number:
                raise CompilerMissing("Xvfb does not start")
            yield f":{number}"
        finally:
            server.terminate()
            server.wait(timeout=30)
            server.stdout.close()


def said_in(project: Path) -> str:
    """What the last process of a project has printed until now."""
    return (project / _SAID).read_text("utf-8", errors="replace")


def find() -> Godot:
    """A Godot 4 of this machine. Raises CompilerMissing where there is none."""
    for program, root in godots():
        godot = Godot(program, root)
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            if godot.version().startswith("4."):
                return godot
    raise CompilerMissing(lacks("godot parser") or "Godot 4.6, which starts")
