"""What the functions of translated templates call; the filters do what Jinja's do. See `template_code.py`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from ..ir.typed import Any

MISSING = object()
_METHODS = frozenset(dir(dict))

Template = Callable[[dict[str, Any]], tuple[str, dict[str, Any]]]


def namespace() -> tuple[dict[str, Template], dict[str, Any]]:
    """The functions that running a translation fills in, and the globals to run it with."""
    templates: dict[str, Template] = {}
    return templates, {**globals(), "TEMPLATES": templates}


def attribute(value: Any, name: str, default: Any = MISSING) -> Any:
    """`value.name`: an attribute, else an item."""
    if type(value) is dict and name in value and name not in _METHODS:
        return value[name]
    try:
        return getattr(value, name)
    except AttributeError:
        try:
            return value[name]
        except (LookupError, TypeError):
            if default is MISSING:
                raise
            return default


def bind(names: Sequence[str], given: Sequence[Any], named: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a macro by name."""
    if len(given) > len(names) or not named.keys() <= set(names[len(given) :]):
        raise TypeError("wrong arguments")
    return {**dict(zip(names, given, strict=False)), **named}


def take(scope: dict[str, Any], given: dict[str, Any], names: Sequence[tuple[str, str]]) -> None:
    """Imports variables; one that is not there stays undefined until it is used."""
    for name, own in names:
        scope.pop(own, None)
        if name in given:
            scope[own] = given[name]


def loop(index: int, items: Sequence[Any]) -> dict[str, Any]:
    """The variable `loop`."""
    return {
        "index": index + 1,
        "index0": index,
        "first": index == 0,
        "last": index == len(items) - 1,
        "length": len(items),
    }


def filter_indent(text: str, width: int | str = 4, first: bool = False, blank: bool = False) -> str:
    """Indents the lines after the first, and the first too if asked; blank lines only if asked."""
    pad = width if isinstance(width, str) else " " * width
    lines = f"{text}\n".splitlines()
    rest = [pad + line if line or blank else line for line in lines[1:]]
    return "\n".join([pad * first + lines[0], *rest])


def filter_join(items: Iterable[Any], separator: str = "") -> str:
    return separator.join(map(str, items))


def filter_length(items: Sequence[Any]) -> int:
    return len(items)


def filter_list(items: Iterable[Any]) -> list[Any]:
    return list(items)


def filter_lower(text: object) -> str:
    return str(text).lower()


def filter_upper(text: object) -> str:
    return str(text).upper()


def filter_map(items: Iterable[Any], *, attribute: str | int) -> list[Any]:
    """One attribute or item of each."""
    path = attribute.split(".") if isinstance(attribute, str) else [attribute]
    return [_item(item, path) for item in items]


def _item(item: Any, path: Iterable[str | int]) -> Any:
    for key in path:
        item = item[key]
    return item


def filter_replace(text: object, old: object, new: object) -> str:
    return str(text).replace(str(old), str(new))


def filter_title(text: object) -> str:
    """Every word with a capital; a word begins behind white space, a hyphen or an opening bracket."""
    letters, begins = [], True
    for letter in str(text):
        letters.append(letter.upper() if begins else letter.lower())
        begins = letter.isspace() or letter in "-({[<"
    return "".join(letters)


def filter_trim(text: object, characters: str | None = None) -> str:
    return str(text).strip(characters)
