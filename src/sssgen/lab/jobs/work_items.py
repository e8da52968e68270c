"""A work item: a function by its name, its arguments as plain data, and the key that its result is kept under.

The same arguments must give the same result everywhere: seeds, and the contents of what is read from files, belong to
the arguments.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
import os
import sys
import traceback
from typing import Any, NamedTuple

from sssgen.lab.jobs.result_store import decoded, encoded
from sssgen.support import cache
from sssgen.support.diagnostics import SssgenError
from sssgen.support.paths import PACKAGE, place

Ended = tuple[str, bytes]
"""The key of an item that has ended, and its encoded result."""


class Failure(NamedTuple):
    """Stands for an item's result where there is none. It is not kept: the next run tries again."""

    name: str
    """The item's."""
    message: str
    """What went wrong, and where."""


class Item(NamedTuple):
    """A call of `function`, as "package.module:name", with `arguments`: what pickle takes, without sets or cycles."""

    function: str
    arguments: tuple[Any, ...] = ()
    name: str = ""
    """What people know it as; it is no part of the key."""

    @property
    def title(self) -> str:
        """The name, or else the function's."""
        return self.name or self.function.partition(":")[2]


class Task(NamedTuple):
    """An item as it goes to a worker."""

    key: str
    name: str
    function: str
    arguments: bytes
    stamp: str
    """The state of the code that is to run it."""


def task(item: Item) -> Task:
    """The item with its key: a digest of the function, the arguments and the code."""
    arguments = encoded(item.arguments)
    stamp = code_stamp(item.function.partition(":")[0])
    key = cache.digest(b"\0".join([item.function.encode(), stamp.encode(), arguments]))
    return Task(key, item.title, item.function, arguments, stamp)


def execute(one: Task) -> bytes:
    """Runs a task in this process; its encoded result, which is a Failure where the function raised."""
    try:
        module, _, name = one.function.partition(":")
        if code_stamp(module) != one.stamp:
            return encoded(Failure(one.name, "this worker has another state of sssgen: start it, or the run, anew"))
        function = getattr(importlib.import_module(module), name)
        return encoded(function(*decoded(one.arguments)))
    except SssgenError as error:
        return encoded(Failure(one.name, "; ".join(found.message for found in error.diagnostics)))
    except (Exception, SystemExit) as error:
        at = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{os.path.basename(at.filename)}:{at.lineno}"
        return encoded(Failure(one.name, f"{type(error).__name__}: {error} ({place})"))


@functools.cache
def code_stamp(module: str) -> str:
    """Tells one state of the code from another, on every machine alike: a digest of sssgen's files and of what lies
    beside them, of the module's own where it is another's, and of the versions of Python and NumPy.
    """
    parts = [b"Python %d.%d" % sys.version_info[:2], _numpy().encode(), _own().encode()]
    if not module.startswith("sssgen."):
        spec = importlib.util.find_spec(module)
        if spec is not None and spec.origin is not None:
            parts.append(_content(spec.origin))
    return cache.digest(b"\0".join(parts))


def _numpy() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("numpy")
    except PackageNotFoundError:
        return ""


@functools.cache
def _own() -> str:
    folders = [PACKAGE, *map(place, ("targets", "templates", "examples"))]
    found = []
    for top in folders:
        for folder, below, names in os.walk(top):
            below[:] = sorted(name for name in below if name not in ("__pycache__", "_data"))
            found += [f"{name} {cache.digest(_content(os.path.join(folder, name)))}" for name in sorted(names)]
    return cache.digest("\n".join(found))


def _content(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
