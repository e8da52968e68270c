"""The packages that each extra of the distribution installs, as its own metadata declares them."""

from __future__ import annotations

import os
import re
import sys
import tomllib
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, requires, version

from sssgen.support.installation import DISTRIBUTION, source

NEEDED = ""
"""In place of an extra: what every command needs."""
_DEVELOPMENT = "dev"


def packages() -> dict[str, list[str]]:
    """Extra → the names of its packages. The first is NEEDED; the extra for development is left out."""
    declared = {extra: [*names] for extra, names in _declared_requirements().items() if extra != _DEVELOPMENT}
    return {extra: sorted(_expand(names, declared), key=str.lower) for extra, names in declared.items()}


def installed_version(package: str) -> str:
    """The version of a package in this environment; '' where it is missing."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def is_installed(extra: str) -> bool:
    """Whether all packages of an extra are in this environment."""
    return all(installed_version(package) for package in packages().get(extra, ()))


def _declared_requirements() -> dict[str, list[str]]:
    """The requirements of this checkout or, where it is none, of the installed distribution."""
    top, checkout = source()
    if checkout:
        with open(os.path.join(top, "pyproject.toml"), "rb") as file:
            project = tomllib.load(file)["project"]
        return {NEEDED: project["dependencies"], **project["optional-dependencies"]}
    result: dict[str, list[str]] = {NEEDED: []}
    try:
        requirements = requires(DISTRIBUTION) or []
    except PackageNotFoundError:  # the folder of the package is in the path, without its metadata
        requirements = []
    for requirement in requirements:
        extra = re.search(r"extra == ['\"]([\w-]+)['\"]", requirement)
        result.setdefault(extra[1] if extra else NEEDED, []).append(requirement)
    return result


def _expand(requirements: Iterable[str], declared: dict[str, list[str]]) -> set[str]:
    """The names of packages, with those of the extras that a requirement of the distribution itself names."""
    names: set[str] = set()
    for requirement in requirements:
        before = re.search(r"python_version < ['\"](\d+)\.(\d+)", requirement)
        if before and sys.version_info >= (int(before[1]), int(before[2])):
            continue
        match = re.match(r"([\w.-]+)(?:\[([\w,-]+)\])?", requirement)
        assert match is not None, requirement
        if match[1] != DISTRIBUTION:
            names.add(match[1])
            continue
        for extra in (match[2] or "").split(","):
            names |= _expand(declared.get(extra, ()), declared)
    return names
