"""What the emit path takes from `typing`, without importing it: that alone would cost a tenth of a cold emit.

Type checkers see the real things. At run time, `NamedTuple` makes the same classes ten times faster, as it neither
compiles annotations nor a constructor for each; the other names stand in annotations only.
"""

from __future__ import annotations

TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any as Any
    from typing import NamedTuple as NamedTuple
    from typing import NoReturn as NoReturn
    from typing import TypeAlias as TypeAlias
    from typing import cast as cast
else:
    from types import FunctionType

    try:
        from _collections import _tuplegetter as _getter
    except ImportError:
        from operator import itemgetter

        def _getter(index, doc):
            return property(itemgetter(index), doc=doc)

    Any = NoReturn = TypeAlias = object

    def cast(type_, value):
        """The value; only type checkers look at the type."""
        return value

    _constructors = {}

    def _constructor(name, fields, defaults):
        """`__new__` with these parameters, from the code of any constructor with as many."""
        code = _constructors.get(len(fields))
        if code is None:
            names = ", ".join([f"_{index}" for index in range(len(fields))])
            made = eval(f"lambda _class, {names}: _new(_class, ({names},))" if names else "lambda _class: _new(_class)")
            code = _constructors[len(fields)] = made.__code__
        code = code.replace(co_name="__new__", co_qualname=f"{name}.__new__", co_varnames=("_class", *fields))
        return FunctionType(code, {"_new": tuple.__new__}, "__new__", defaults)

    class _Record(tuple):
        """The methods of every named tuple."""

        __slots__ = ()

        @classmethod
        def _make(cls, values):
            return cls(*values)

        def _replace(self, /, **changes):
            values, places = list(self), self._places
            for name, value in changes.items():
                values[places[name]] = value
            return tuple.__new__(type(self), values)

        def _asdict(self):
            return dict(zip(self._fields, self, strict=True))

        def __repr__(self):
            shown = ", ".join([f"{name}={value!r}" for name, value in zip(self._fields, self, strict=True)])
            return f"{type(self).__name__}({shown})"

        def __getnewargs__(self):
            return tuple(self)

    class _Maker(type):
        """Turns a class of annotations into a tuple with named fields, as `typing.NamedTuple` does."""

        def __new__(maker, name, bases, space):
            if not bases:
                return super().__new__(maker, name, bases, space)
            fields = tuple(space.get("__annotations__", ()))
            defaults = {field: space[field] for field in fields if field in space}
            if tuple(defaults) != fields[len(fields) - len(defaults) :]:
                raise TypeError(f"{name}: a field without a default stands behind one with a default")
            for index, field in enumerate(fields):
                space[field] = _getter(index, "")
            space["__new__"] = _constructor(name, fields, tuple(defaults.values()))
            space |= {"__slots__": (), "_fields": fields, "_field_defaults": defaults, "__match_args__": fields}
            space["_places"] = {field: index for index, field in enumerate(fields)}
            return type(name, (_Record,), space)

    class NamedTuple(metaclass=_Maker):
        pass
