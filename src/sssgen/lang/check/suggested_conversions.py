"""The conversions between quantities that error messages suggest.

A conversion technique of the library declares it with the attribute `suggested: SOURCE to TARGET`. It is read from the
text, since a file is checked without loading the rest of the library; loading a technique checks the declaration.
"""

from __future__ import annotations

import functools
import os
import re

from sssgen.support.paths import PACKAGE, stem

_FOLDER = os.path.join(PACKAGE, "techniques", "conversion")
_DECLARED = re.compile(r"^ \* suggested: (\w+) to (\w+)$", re.MULTILINE)


@functools.cache
def suggested_conversions() -> dict[tuple[str, str], str]:
    """(source, target) → the name of the technique."""
    names = {}
    for file in sorted(os.listdir(_FOLDER)):
        with open(os.path.join(_FOLDER, file), encoding="utf-8") as text:
            for match in _DECLARED.finditer(text.read()):
                names[match[1], match[2]] = stem(file)
    return names
