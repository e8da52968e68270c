"""Where this sssgen comes from, and the command that installs one of its extras there.

It is not part of `extras.py`, which every command imports: only a hint needs it.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from urllib.parse import unquote, urlsplit

from sssgen.support.paths import PACKAGE
from sssgen.version import VERSION

DISTRIBUTION = "sssgen-shaders"
"""The name in the package index, where `sssgen` is a package of others."""


def install_hint(extra: str) -> str:
    """The command that installs an extra, or several as `a,b`, as it works in the current folder.

    It installs into the environment that runs this, from where sssgen was installed. Double quotes work in every shell.
    """
    path, editable = source()
    return f'{_pip()} install {"-e " if editable else ""}"{_short_path(path) if path else DISTRIBUTION}[{extra}]"'


def npm_hint(package: str) -> str:
    """The command that installs an npm package where the back ends look for it."""
    path, checkout = source()
    if not checkout:
        return f"npm install {package}, and SSSGEN_NODE_MODULES=/path/to/node_modules"
    folder = os.path.join(path, "build", "node")
    return make_hint("setup", f"npm install --prefix {_quote(folder)} {package}")


def make_hint(target: str, otherwise: str, note: str = "") -> str:
    """`make TARGET`, which only a checkout has, or else another way; `note` is about make."""
    path, checkout = source()
    if not checkout:
        return otherwise
    shown = _quote(path)
    command = f"make {target}" if shown == os.curdir else f"make -C {shown} {target}"
    return f"{command}{f' ({note})' if note else ''}, or {otherwise}"


def source() -> tuple[str, bool]:
    """The checkout or the wheel that sssgen was installed from, '' for a package index; whether a checkout is run."""
    top = os.path.dirname(os.path.dirname(PACKAGE))
    if not os.path.isdir(os.path.join(PACKAGE, "_data")) and os.path.isfile(os.path.join(top, "pyproject.toml")):
        return top, True
    metadata = os.path.join(os.path.dirname(PACKAGE), f"{DISTRIBUTION.replace('-', '_')}-{VERSION}.dist-info")
    try:  # pip writes this file for what does not come from an index
        with open(os.path.join(metadata, "direct_url.json"), encoding="utf-8") as file:
            url = urlsplit(json.load(file)["url"])
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return "", False
    path = unquote(url.path)
    if os.name == "nt":
        path = os.path.normpath(path.lstrip("/"))
    return (path, False) if url.scheme == "file" and os.path.exists(path) else ("", False)


def _pip() -> str:
    """The pip of the environment that runs this, which need not be the shell's."""
    programs = os.path.dirname(sys.executable)
    if (found := shutil.which("pip")) and os.path.dirname(found) == programs:
        return "pip"
    program = shutil.which("pip", path=programs)
    return _quote(program) if program else f"{_quote(sys.executable)} -m pip"


def _quote(path: str) -> str:
    shown = _short_path(path)
    return f'"{shown}"' if " " in shown else shown


def _short_path(path: str) -> str:
    """A path, from the current folder where it is below it."""
    try:
        relative = os.path.relpath(path)
    except (OSError, ValueError):  # the current folder is gone, or on another drive
        return path
    if relative.startswith(os.pardir):
        return path
    # pip takes a word without a separator for the name of a distribution
    return relative if os.sep in relative or relative == os.curdir else os.path.join(os.curdir, relative)
