"""Charts of error against cost, drawn from a record: pictures, a page, CSV and JSON. Nothing is measured here."""

from __future__ import annotations

import os
from typing import Any

from sssgen.lab.chart.record import checked, roles, to_csv, to_json
from sssgen.support.file_writer import write_files


def write(record: Any, folder: str | os.PathLike[str], stem: str = "chart") -> list[str]:
    """Writes `stem`_ROLE.png and .svg for each role, `stem`.html, .csv and .json into the folder; their paths.

    All of them are written, or none. Drawing the JSON file again gives the same files. Raises SssgenError for what is
    no record (see record.py), for a record without points, where matplotlib is missing, and where the folder refuses.
    """
    files = drawn(record, stem)
    return [written.path for written in write_files(folder, files)]


def drawn(record: Any, stem: str = "chart") -> dict[str, str | bytes]:
    """The files that `write` writes, by name."""
    from sssgen.lab.chart.drawing import figure, page
    from sssgen.lab.chart.drawing.layout import chart
    from sssgen.support.diagnostics import failure

    record = checked(record)
    if not record["points"]:
        raise failure("there is nothing to draw: the record has no points")
    charts = [chart(record, role) for role in roles(record)]
    files: dict[str, str | bytes] = {}
    for one in charts:
        files |= {f"{stem}_{one.role}.{suffix}": data for suffix, data in figure.drawn(one).items()}
    files[f"{stem}.html"] = page.written(record, charts)
    files[f"{stem}.csv"] = to_csv(record)
    files[f"{stem}.json"] = to_json(record)
    return files
