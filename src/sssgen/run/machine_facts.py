"""What a report of a problem needs to know about this machine: `sssgen doctor`.

Nothing is started for it, unless it is asked whether the back ends and compilers start: then each runs in a process of
its own, which may crash or hang without harm.
"""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from typing import Any

from sssgen.run.backend_registry import BACKENDS
from sssgen.run.compiler_registry import COMPILERS
from sssgen.run.machine_parts import all_lacks
from sssgen.support import cache
from sssgen.support.extra_packages import NEEDED, installed_version, packages
from sssgen.support.installation import install_hint, source
from sssgen.support.paths import PACKAGE
from sssgen.support.worker_process import LostError, Process
from sssgen.version import VERSION

SECONDS = 60.0
"""How long a back end may take to start."""
VARIABLES = {
    "SSSGEN_BROWSER_ADAPTER": "the adapter of the browsers: default for the machine's GPU",
    "SSSGEN_CACHE": "the cache folder; empty for none",
    "SSSGEN_CHROMIUM": "the program of Chromium or Chrome",
    "SSSGEN_DEBUG": "show the traceback of an internal error",
    "SSSGEN_FIREFOX": "the program of Firefox",
    "SSSGEN_GLSLANG": "the program of glslang",
    "SSSGEN_GODOT": "the program of Godot",
    "SSSGEN_NODE_MODULES": "the folder of npm packages",
    "SSSGEN_UNITY_INCLUDES": "the folders of Unity's headers",
}
"""The variables that are read, and what they set."""


@dataclass(frozen=True)
class Item:
    """A back end, a compiler or an extra."""

    name: str
    description: str
    found: bool
    how: str
    """How to get what is missing; '' where nothing is."""
    started: str = ""
    """Its version or device, once it was started."""
    failure: str = ""
    """Why it was found and did not start."""


@dataclass(frozen=True)
class Facts:
    """The report."""

    sssgen: str
    source: str
    python: str
    platform: str
    cache: str
    """The cache folder; '' where nothing is cached."""
    variables: dict[str, str]
    unknown_variables: list[str]
    packages: dict[str, str]
    """Installed package → version."""
    extras: list[Item]
    compilers: list[Item]
    backends: list[Item]

    def as_json(self) -> dict[str, Any]:
        """The report for programs."""
        return asdict(self)


def facts(start: bool = False) -> Facts:
    """What is found. `start`: compilers and back ends that are found are started, too."""
    compilers = [_item(name, COMPILERS[name].description, COMPILERS[name].parts) for name in COMPILERS]
    backends = [_item(name, BACKENDS[name].description, BACKENDS[name].parts) for name in BACKENDS]
    if start:
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            compilers = list(pool.map(_starter("sssgen.run.compilers.compiler_process"), compilers))
            backends = list(pool.map(_starter(__name__), backends))
    own = {name: value for name, value in sorted(os.environ.items()) if name.startswith("SSSGEN_")}
    extras = list(_extras())
    return Facts(
        VERSION,
        _source(),
        f"{platform.python_version()} ({platform.python_implementation()}), {sys.executable}",
        f"{platform.system()} {platform.release()}, {platform.machine()}",
        cache.folder(),
        own,
        [name for name in own if name not in VARIABLES],
        dict(_versions()),
        extras,
        compilers,
        backends,
    )


def _source() -> str:
    path, checkout = source()
    if checkout:
        return f"the checkout {path}"
    return f"installed from {path}" if path else f"installed in {os.path.dirname(PACKAGE)}"


def _item(name: str, description: str, parts: Iterable[str]) -> Item:
    how = all_lacks(parts)
    return Item(name, description, not how, how)


def _extras() -> Iterator[Item]:
    for extra, names in packages().items():
        if extra != NEEDED:
            missing = [name for name in names if not installed_version(name)]
            yield Item(extra, ", ".join(names), not missing, install_hint(extra) if missing else "")


def _versions() -> Iterator[tuple[str, str]]:
    for name in sorted({name for names in packages().values() for name in names}, key=str.lower):
        if found := installed_version(name):
            yield name, found


def _starter(module: str) -> Callable[[Item], Item]:
    """Starts what is found, in a process of its own."""

    def start(item: Item) -> Item:
        if not item.found:
            return item
        process = Process(module, item.name, seconds=SECONDS)
        try:
            return Item(**{**asdict(item), "started": str(process.start())})
        except LostError as reason:
            return Item(**{**asdict(item), "failure": str(reason)})
        except Exception as reason:  # what its package raises is its own
            return Item(**{**asdict(item), "failure": str(reason) or type(reason).__name__})
        finally:
            process.close()

    return start


def serve(name: str) -> tuple[str, Callable[[object], object]]:
    """The device of a back end, in the process that starts it. Raises CompilerMissing."""
    from sssgen.run import backends

    return backends.get(name).device(), lambda question: question
