"""The places of a frame as templates see them, which know whether a template has printed them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from sssgen.support.diagnostics import did_you_mean, failure
from sssgen.targets.descriptor import Target
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
    """Raises SssgenError for a place with a text that no template knows: its name may be misspelt.

    `contexts` are the variables of the templates, each after the beginning of the names of its sections.
    """
    printed = {place for _, own in contexts for key in _KEYS for place in own[key].printed}
    for prefix, own in contexts:
        for key in _KEYS:
            left = [place for place, text in own[key].texts.items() if text and place not in printed]
            if left and (unknown := set(left).difference(*(words(template, target.folder) for template in templates))):
                place = min(unknown)
                message = f"the templates of {target.title} do not print the place '{place}' of [{prefix}{key}]"
                hint = did_you_mean(place, printed) or f"print it, or use another: {', '.join(sorted(printed))}"
                raise failure(message, hint, f"{target.name}.toml")


_KEYS = ("frame", "surface")
