"""Run by `precompile.mjs` in Pyodide: compiles the staged modules and the standard library, and fills the caches."""

import ast
import importlib
import importlib.util
import json
import marshal
import os
import shutil
import sys
import zipfile

CACHE = "/cache"
STAMP = (1980, 1, 1, 0, 0, 0)
UNCHECKED = (1).to_bytes(4, "little")
"""The flags of a compiled module that is never compared with its source, which is not there."""
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
NEVER = ("importlib.metadata", "subprocess", "urllib")
"""What sssgen imports only for plug-ins and for other processes."""
BESIDES = (
    *("codecs", "linecache", "locale", "textwrap", "tokenize", "traceback"),
    *(
        f"encodings.{name}"
        for name in ("ascii", "cp437", "idna", "latin_1", "raw_unicode_escape", "utf_16_le", "utf_32_le")
    ),
)
"""What Python itself imports when it needs it."""


def compiled(data: bytes, name: str) -> bytes:
    """The bytes of a module without its source and with short docstrings; tracebacks show `name`.

    Without any, dataclasses would write some.
    """
    tree = ast.parse(data)
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node):
            short = ast.copy_location(ast.Expr(ast.Constant("-")), node.body[0])
            node.body[0] = ast.fix_missing_locations(short)
    code = compile(tree, name, "exec", dont_inherit=True)
    return importlib.util.MAGIC_NUMBER + UNCHECKED + bytes(8) + marshal.dumps(code)


def imports(data: bytes) -> set[str]:
    """The modules that a source imports anywhere, by absolute names."""
    found = set()
    for node in ast.walk(ast.parse(data)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            found.add(node.module)
    return found


def install() -> set[str]:
    """Copies the stage to its places, with compiled modules in place of the sources; returns what sssgen imports."""
    shutil.copytree("/stage/examples", "/examples")
    imported = set()
    for folder, _, names in os.walk("/stage/app"):
        target = folder.removeprefix("/stage")
        os.makedirs(target, exist_ok=True)
        for name in names:
            with open(f"{folder}/{name}", "rb") as file:
                data = file.read()
            if name.endswith(".py"):
                imported |= imports(data) if target.startswith("/app/sssgen") else set()
                data, name = compiled(data, f"<{target.removeprefix('/app/')}/{name}>"), f"{name}c"
            with open(f"{target}/{name}", "wb") as file:
                file.write(data)
    return imported


def fill_caches() -> None:
    """Compiles the first start for its picture, so that a browser reads it from the cache.

    The caches of all would be a third of the bundle.
    """
    import playground_session as session

    session.age("/app", "/examples")
    with open("/stage/first.json") as file:
        asked = json.load(file)
    result = json.loads(
        session.answer(json.dumps({**asked, "part": "picture", "files": {}, "values": {}, "in_scene": []}))
    )
    if result["errors"]:
        raise SystemExit(result["errors"])
    session.warm()


def write_stdlib() -> None:
    """The modules of the standard library that are loaded now, as a zip without compression.

    As a whole it is compressed better, and Python reads it faster.
    """
    specs = [getattr(module, "__spec__", None) for module in list(sys.modules.values())]
    loaded = {spec.name for spec in specs if spec is not None}
    with zipfile.ZipFile("/stdlib.zip") as old, zipfile.ZipFile("/out/stdlib.zip", "w") as new:
        for entry in old.namelist():
            module = entry.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
            if entry.endswith(".py") and module in loaded:
                data = compiled(old.read(entry), f"<{entry}>")
                new.writestr(zipfile.ZipInfo(f"{entry}c", STAMP), data)


def write_app() -> None:
    """sssgen with its data, and the caches that a first picture of each start reads."""
    with zipfile.ZipFile("/out/app.zip", "w") as new:
        for top in ("/app", "/examples", CACHE):
            for folder, _, names in sorted(os.walk(top)):
                for name in sorted(names):
                    with open(f"{folder}/{name}", "rb") as file:
                        new.writestr(zipfile.ZipInfo(f"{folder}/{name}"[1:], STAMP), file.read())


os.environ["SSSGEN_CACHE"] = CACHE
needed = install()
sys.path[:] = ["/app", *(path for path in sys.path if not path.endswith("-packages"))]
fill_caches()
for name in sorted(needed | set(BESIDES)):
    if name.partition(".")[0] in sys.stdlib_module_names and name not in NEVER:
        importlib.import_module(name)
write_stdlib()
write_app()
