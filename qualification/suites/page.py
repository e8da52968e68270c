"""docs/suites.md: what outside suites say of each back end."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from qualification.suites.lenience import LENIENCE, class_of
from qualification.suites.machines import AUTHOR, BACKENDS
from qualification.suites.outcomes import ACCEPTED, FRONT, OUTCOMES, REFUSED, RIGHT, SKIPPED, Result
from qualification.suites.sources import SUITES

_TITLES = {**BACKENDS, AUTHOR: "the driver, the author's text", FRONT: "front end"}


def table(results: Mapping[str, Sequence[Result]]) -> str:
    """The number of each outcome, by suite, kind of case and back end."""
    lines = ["| suite | cases | back end | " + " | ".join(OUTCOMES) + " |", "|---|---|---|" + "---:|" * len(OUTCOMES)]
    for suite, own in results.items():
        for kind in dict.fromkeys(result.kind for result in own):
            of_kind = [result for result in own if result.kind == kind]
            for name in dict.fromkeys(name for result in of_kind for name in result.outcomes):
                counts = Counter(result.outcomes[name].outcome for result in of_kind if name in result.outcomes)
                cells = " | ".join(str(counts[outcome] or "") for outcome in OUTCOMES)
                lines.append(f"| {suite} | {kind} | {_TITLES.get(name, name)} | {cells} |")
    return "\n".join(lines)


def totals(results: Mapping[str, Sequence[Result]]) -> str:
    """The number of each outcome of all suites, by back end."""
    lines = ["| back end | " + " | ".join(OUTCOMES) + " |", "|---|" + "---:|" * len(OUTCOMES)]
    every = [result.outcomes for own in results.values() for result in own]
    for name in dict.fromkeys(name for outcomes in every for name in outcomes):
        counts = Counter(outcomes[name].outcome for outcomes in every if name in outcomes)
        lines.append(f"| {_TITLES.get(name, name)} | {' | '.join(str(counts[each] or '') for each in OUTCOMES)} |")
    return "\n".join(lines)


def page(results: Mapping[str, Sequence[Result]], date: str, every: int, devices: Mapping[str, str]) -> str:
    """The page's text; `devices` are those of the back ends, by their titles."""
    every_text = "" if every == 1 else f" --every {every}"
    lines = [
        "# Outside suites", "",
        "Shader suites that nobody of this project wrote, run on every back end: "
        f"`make suites SUITES=FOLDER`, which is `python -m qualification.suites FOLDER{every_text} --write`, "
        f"of {date}. "
        "Nothing of a suite is in this repository.", "",
        "| suite | repository | folders | commit | license |", "|---|---|---|---|---|",
        *(
            f"| {name} | [{suite.repository}](https://github.com/{suite.repository}) | {', '.join(suite.folders)} | "
            f"`{suite.commit[:12]}` | {suite.license} |"
            for name, suite in SUITES.items()
            if name in results
        ),
        "", "FOLDER has each repository under its own name, at that commit. One is brought by", "",
        "```", *brought(results), "```", "",
        "Suites that FOLDER lacks are left out. The back ends:", "",
        *(f"- {title}: {device}" for title, device in devices.items()), "",
        "## All suites", "", totals(results), "",
        *(f"- **{outcome}**: {meaning}." for outcome, meaning in OUTCOMES.items()), "",
        "## By suite", "", table(results), "",
        "What a case is:", "", *descriptions(results), "",
        "## What is accepted and should not be", "",
        "| class | cases | why |", "|---|---:|---|",
        *lenience_rows(result for own in results.values() for result in own), "",
        "## What is refused, wrong or invalid", "",
        *problems(result for own in results.values() for result in own), "",
    ]  # fmt: skip
    return "\n".join(lines)


def brought(names: Iterable[str]) -> list[str]:
    """The commands for the repository of the first suite."""
    suite = SUITES[next(iter(names))]
    name = suite.repository.rpartition("/")[2]
    folders = dict.fromkeys(
        folder for other in SUITES.values() if other.repository == suite.repository for folder in other.folders
    )
    return [
        f"git clone --filter=blob:none --sparse https://github.com/{suite.repository} FOLDER/{name}",
        f"git -C FOLDER/{name} sparse-checkout set {' '.join(folders)}",
        f"git -C FOLDER/{name} checkout {suite.commit[:12]}",
    ]


def descriptions(names: Iterable[str]) -> list[str]:
    """What the cases of suites are: one point for suites that are alike."""
    alike: dict[str, list[str]] = {}
    for name in names:
        alike.setdefault(SUITES[name].about, []).append(name)
    return [f"- **{', '.join(own)}**: {about}" for about, own in alike.items() if about]


def lenience_rows(results: Iterable[Result]) -> list[str]:
    """A row for each class of programs that a driver refuses and sssgen accepts."""
    accepted = [result for result in results if any(each.outcome == ACCEPTED for each in result.outcomes.values())]
    counts = Counter(class_of(result.case) for result in accepted)
    return [f"| {name} | {counts[name]} | {LENIENCE[name].why} |" for name in LENIENCE if counts[name]]


def problems(results: Iterable[Result]) -> list[str]:
    """The messages of cases that are not right, with the number of cases of each and one of them; those that refuse one
    case are one row."""
    found: dict[tuple[str, str], list[str]] = {}
    for result in results:
        for name, outcome in result.outcomes.items():
            if outcome.outcome not in (RIGHT, ACCEPTED, SKIPPED) and name != AUTHOR:
                found.setdefault((outcome.outcome, outcome.why.splitlines()[0][:120]), []).append(result.case)
    single = [key for key, cases in found.items() if key[0] == REFUSED and len(set(cases)) == 1]
    rest = sorted({case for key in single for case in found.pop(key)})
    rows = sorted(found.items(), key=lambda item: (item[0][0], -len(set(item[1]))))
    if rest:
        rows.append(((REFUSED, f"{len(single)} other messages, of one case each"), rest))
    return ["| outcome | message | cases | such as |", "|---|---|---:|---|"] + [
        f"| {outcome} | {why.replace('|', chr(92) + '|')} | {len(set(cases))} | `{cases[0]}` |"
        for (outcome, why), cases in rows
    ]
