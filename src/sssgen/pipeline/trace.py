"""The IR of a program after each pass that changed it, as files for `--trace`."""

from __future__ import annotations

import os

from sssgen.ir.frame_passes import FRAME_PASSES, passes_of
from sssgen.ir.nodes import Module
from sssgen.ir.text import print_module
from sssgen.support.file_writer import write_files


class Trace:
    """Collects one file for each pass that changed the module, such as `03-fold.ir`."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.files: dict[str, str] = {}
        self._count = 0
        self._last = ""

    def start(self, module: Module) -> None:
        """Adds the module before the first pass."""
        self._last = print_module(module, spans=False)
        self.files[f"{self.folder}/00-input.ir"] = (
            f"// input: the module before the first pass\n{_drawn_before(module)}\n{self._last}"
        )

    def record(self, name: str, reason: str, module: Module) -> None:
        """Adds the module as the next pass of the list left it, unless its text is the same as before."""
        self._count += 1
        text = print_module(module, spans=False)
        if text != self._last:
            self.files[f"{self.folder}/{self._count:02}-{name}.ir"] = (
                f"// {name}: {reason}\n{_drawn_before(module)}\n{text}"
            )
        self._last = text

    def write(self, output: str | os.PathLike[str]) -> None:
        """Writes the files into a folder, and removes those of an earlier trace. Raises SssgenError."""
        from pathlib import Path

        write_files(output, self.files)
        for path in Path(output, self.folder).glob("[0-9][0-9]-*.ir"):
            if f"{self.folder}/{path.name}" not in self.files:
                path.unlink()


def _drawn_before(module: Module) -> str:
    """What a program draws before the module runs, a comment for each."""
    drawn = [(use, FRAME_PASSES[use.name]) for use in passes_of(module.uniforms)]
    return "".join(
        f"// drawn before: {use.name}, the {of} from {eye}, to {use.texture.name}\n" for use, (of, eye, *_) in drawn
    )
