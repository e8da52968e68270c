"""docs/architecture.md is up to date: its files exist, and its layers are those of the import contracts."""

import re
import tomllib
from collections import Counter
from pathlib import Path

from folders import ROOT

TEXT = (ROOT / "docs" / "architecture.md").read_text("utf-8")
PACKAGE = ROOT / "src" / "sssgen"
MAX_ROOT_MODULES = 6


def python_files() -> list[Path]:
    return [path for path in PACKAGE.rglob("*.py") if "__pycache__" not in path.parts]


def test_every_file_it_names_exists() -> None:
    folders = [ROOT, PACKAGE, *(path for path in PACKAGE.rglob("*") if path.is_dir())]
    names = set(re.findall(r"`([\w./-]+(?:\.(?:py|md|toml|lark|json|j2)|/))`", TEXT))
    placeholders = {"technique.sss", "material.toml"}
    missing = [name for name in names - placeholders if not any((folder / name).exists() for folder in folders)]
    assert not [name for name in missing if "NAME" not in name and "COMMAND" not in name]


def test_every_folder_of_the_package_is_in_its_table() -> None:
    table = TEXT.split("## Layers")[1].split("## The pipeline")[0]
    rows = set(re.findall(r"^\| `(\w+)/` \|", table, re.MULTILINE))
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir() and path.name not in ("__pycache__", "_data")}
    assert rows == folders - {"techniques", "shells"}, "these two have no Python; the text below the table names them"


def test_every_inner_folder_and_printer_is_named() -> None:
    """By its path, or in a table of its parent's folders by the part of the path behind that."""
    folders = [path for path in PACKAGE.rglob("*") if path.is_dir() and any(path.glob("*.py"))]
    parts = [path.relative_to(PACKAGE).as_posix() for path in folders if path.name != "__pycache__"]
    assert not [part for part in parts if f"`{part}/" not in TEXT and f"`{part.partition('/')[2]}/" not in TEXT]
    printers = [path.name for path in (PACKAGE / "targets" / "printers").glob("*.py") if path.name != "__init__.py"]
    assert not [name for name in printers if not re.search(rf"`(targets/printers/)?{name}`", TEXT)]


def test_the_layers_are_those_of_the_contracts() -> None:
    """Each row of the table is above the rows that it may import."""
    table = TEXT.split("## Layers")[1].split("## The pipeline")[0]
    rows = re.findall(r"^\| `(\w+)/` \|", table, re.MULTILINE)
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    order = [name.strip().removeprefix("sssgen.") for layer in layers for name in layer.split("|")]
    assert rows == order


def test_the_root_of_the_package_has_few_files() -> None:
    assert len(list(PACKAGE.glob("*.py"))) <= MAX_ROOT_MODULES


def test_module_names_are_unique() -> None:
    """A name identifies a module. Commands, and modules of `cli/facts`, have the names of what they are about."""
    named_apart = (PACKAGE / "cli", PACKAGE / "cli" / "facts")
    names = Counter(
        path.name for path in python_files() if path.name != "__init__.py" and path.parent not in named_apart
    )
    assert not [name for name, count in names.items() if count > 1]
