"""What a back end made of a case of a suite."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

RIGHT, WRONG, INVALID, REFUSED, CRASH, ACCEPTED, SKIPPED = (
    "right", "wrong", "invalid", "refused", "crash", "accepted", "skipped",
)  # fmt: skip
OUTCOMES = {
    RIGHT: "the values or the pictures are as expected, all compilers accept the text, or what is invalid is refused",
    WRONG: "another value, and no message",
    INVALID: "a back end refuses the emitted text",
    REFUSED: "sssgen refuses a valid program, with a message",
    CRASH: "an internal error of sssgen",
    ACCEPTED: "sssgen translates a program that a compiler has to refuse",
    SKIPPED: "the runner cannot run the case: it needs stages or settings that no target has, or a driver is too slow",
}
"""Outcome → its meaning."""


FRONT = "front end"
"""In place of a back end: the front end alone."""


class Outcome(NamedTuple):
    """The outcome of a case on a back end."""

    outcome: str
    """One of OUTCOMES"""
    why: str = ""
    """The message, or the value"""


class Result(NamedTuple):
    """The outcomes of a case."""

    case: str
    kind: str
    """`values`, `builds`, `must fail` or `skipped`"""
    outcomes: Mapping[str, Outcome]
    """By the name of the back end or of the target"""


class SuiteFormatError(Exception):
    """A file of a suite that is not as its reader expects."""
