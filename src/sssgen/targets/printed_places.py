"""The places of a frame as templates see them, which know whether a template has printed them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from sssgen.support.diagnostics import did_you_mean
from sssgen.targets.descriptor import Target
from sssgen.targets.descriptor_table import error_in
from sssgen.targets.templates import words


class Places(Mapping[str, str]):
    """Place → its text; `printed` are those that a template has read."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self.texts = texts
        self.printed: set[str] = set()

    def __getitem__(self, place: str) -> str:
        self.printed.add(place)
        return self.texts[place]

    def __iter__(self) -> Iterator[str]:
        return iter(self.texts)

    def __len__(self) -> int:
        return len(self.texts)


def check_places(target: Target, templates: Iterable[str], contexts: Sequence[tuple[str, Mapping[str, Any]]]) -> None:
    """Raises SssgenError for a place of a descriptor that no template knows: its texts would be lost.

    Places of a base are not checked: a target with templates of its own need not print them all. `contexts` are the
    variables of the templates, each after the beginning of the names of its sections.
    """
    printed = {place for _, own in contexts for key in _KEYS for place in own[key].printed}
    for section, texts in [(f"{prefix}{key}", own[key].texts) for prefix, own in contexts for key in _KEYS]:
        left = {place for place, text in texts.items() if text and place not in printed}
        if left and (unknown := left.difference(*(words(template, target.folder) for template in templates))):
            place = min(unknown)
            message = f"the templates of {target.title} do not print the place '{place}' of [{section}]"
            hint = did_you_mean(place, printed) or f"they print {', '.join(sorted(printed))}"
            path = os.path.join(target.folder, f"{target.name}.toml")
            if os.path.isfile(path) and (error := error_in(path, [*section.split("."), place], message, hint)):
                raise error


_KEYS = ("frame", "surface")
