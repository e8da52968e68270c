"""Charts of error against cost, drawn from a record: pictures, a page, CSV and JSON. Nothing is measured here."""

from __future__ import annotations

import os

from sssgen.lab.chart.record import check_record, to_csv, to_json
from sssgen.support.file_writer import write_files


def write(record: object, folder: str | os.PathLike[str], stem: str = "chart") -> list[str]:
    """Writes `stem`_ROLE.png and .svg for each role, `stem`.html, .csv and .json into the folder; returns their paths.

    Either all files are written or none. The same JSON file always gives the same files. Raises SssgenError for an
    invalid record (see record.py), a record without points, a missing library, and a folder that cannot be written.
    """
    return [written.path for written in write_files(folder, chart_files(record, stem))]


def chart_files(record: object, stem: str = "chart") -> dict[str, str | bytes]:
    """The files that `write` writes, by name."""
    from sssgen.lab.chart.drawing import figure, page
    from sssgen.lab.chart.drawing.panels import charts_of
    from sssgen.support.diagnostics import failure

    checked = check_record(record)
    if not checked["points"]:
        raise failure("there is nothing to draw: the record has no points")
    charts = charts_of(checked)
    pictures = {chart.role: figure.picture_of(chart) for chart in charts}
    files: dict[str, str | bytes] = {}
    for role, picture in pictures.items():
        files |= {f"{stem}_{role}.png": picture.png, f"{stem}_{role}.svg": picture.svg}
    files[f"{stem}.html"] = page.html_page(checked, charts, [picture.svg for picture in pictures.values()])
    files[f"{stem}.csv"] = to_csv(checked)
    files[f"{stem}.json"] = to_json(checked)
    return files
