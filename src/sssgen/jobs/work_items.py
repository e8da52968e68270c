"""A work item: a function by its name, its arguments as plain data, and the key of its result.

Equal arguments must give equal results everywhere, so they include seeds and the contents of files.
"""

from __future__ import annotations

import functools
import glob
import importlib
import importlib.util
import os
import sys
import traceback
from importlib.metadata import PackageNotFoundError, version
from typing import Any, NamedTuple

from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import PACKAGE, place
from sssgen.support.value_bytes import decode, encode

EncodedResult = tuple[str, bytes]
"""The key of a finished item, and its encoded result."""


class Failure(NamedTuple):
    """Replaces the result of a failed item. It is not stored: the next run tries again."""

    name: str
    """The item's name."""
    message: str
    """The error and its position."""
    hint: str = ""
    """What to do, where it is known."""


class Item(NamedTuple):
    """A call of `function`, as "package.module:name", with picklable `arguments`, without sets or cycles."""

    function: str
    arguments: tuple[Any, ...] = ()
    name: str = ""
    """The name in messages, which is not part of the key."""

    @property
    def title(self) -> str:
        """The name, by default that of the function."""
        return self.name or self.function.partition(":")[2]


class Task(NamedTuple):
    """An item in the form for workers."""

    key: str
    name: str
    function: str
    arguments: bytes
    stamp: str
    """The digest of the code that must run it."""


def task_of(item: Item) -> Task:
    """The item with its key: a digest of the function, the arguments and the code."""
    arguments = encode(item.arguments)
    stamp = code_stamp(item.function.partition(":")[0])
    key = cache.digest(b"\0".join([item.function.encode(), stamp.encode(), arguments]))
    return Task(key, item.title, item.function, arguments, stamp)


def execute(task: Task) -> bytes:
    """Runs a task in this process; returns the encoded result, or a Failure if the function raised an exception."""
    try:
        module, _, name = task.function.partition(":")
        if code_stamp(module) != task.stamp:
            return encode(Failure(task.name, "this worker has another version of sssgen: restart it, or the run"))
        function = getattr(importlib.import_module(module), name)
        return encode(function(*decode(task.arguments)))
    except SssgenError as error:
        hints = dict.fromkeys(diagnostic.hint for diagnostic in error.diagnostics if diagnostic.hint)
        messages = "; ".join(diagnostic.message for diagnostic in error.diagnostics)
        return encode(Failure(task.name, messages, "; ".join(hints)))
    except (Exception, SystemExit) as error:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        position = f"{os.path.basename(frame.filename)}:{frame.lineno}"
        return encode(Failure(task.name, f"{type(error).__name__}: {error} ({position})"))


@functools.cache
def code_stamp(module: str) -> str:
    """A digest of the code, the same on every machine: of sssgen's files, of the module's file if it is not part of
    sssgen, with the files of its package, and of the versions of Python and NumPy.
    """
    parts = [b"Python %d.%d" % sys.version_info[:2], _numpy_version().encode(), _package_digest().encode()]
    if not module.startswith("sssgen."):
        spec = importlib.util.find_spec(module)
        if spec is not None and spec.origin is not None:
            folder = os.path.dirname(spec.origin)
            files = sorted(glob.glob(os.path.join(folder, "*.py"))) if spec.parent else [spec.origin]
            parts += map(_content, files)
    return cache.digest(b"\0".join(parts))


def _numpy_version() -> str:
    try:
        return version("numpy")
    except PackageNotFoundError:
        return ""


@functools.cache
def _package_digest() -> str:
    folders = [PACKAGE, *map(place, ("targets", "templates", "examples"))]
    digests = []
    for top in folders:
        for folder, subfolders, names in os.walk(top):
            subfolders[:] = sorted(name for name in subfolders if name not in ("__pycache__", "_data"))
            digests += [f"{name} {cache.digest(_content(os.path.join(folder, name)))}" for name in sorted(names)]
    return cache.digest("\n".join(digests))


def _content(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
