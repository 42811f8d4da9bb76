"""The page of a fleet."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hyst._files import replacing_files
from hyst.report.page import Page
from hyst.report.table import Table, number

if TYPE_CHECKING:
    from hyst.fleet import Fleet

PAGE, DISTRIBUTIONS, LOOPS = "fleet.html", "distributions.png", "loops.png"

MOST_ROWS = 200
"""Of a list on the page; the table has all."""

_NUMBERS = {
    "gain": "gain",
    "hysteresis_percent": "opening of the loop",
    "bend_percent": "bend of the loop",
    "rms_error": "error, rms",
    "rms_percent": "error, of the range",
    "noise": "noise",
    "output_range": "stroke",
    "delay": "delay",
}


def fleet_numbers_table(fleet: Fleet) -> Table:
    """Give the median, and the range of the middle 90 %, of the main numbers of a fleet.

    Parameters
    ----------
    fleet
        The fleet.

    Returns
    -------
    Table
    """
    rows = []
    for name, words in _NUMBERS.items():
        values = fleet.table[name]
        known = values[~np.isnan(values)]
        if known.size:
            told = (number(float(each)) for each in np.quantile(known, [0.0, 0.05, 0.5, 0.95, 1.0]))
            rows.append((words, fleet.table.units.get(name, ""), *told))
    header = ("number", "unit", "lowest", "5 %", "median", "95 %", "highest")
    return Table("Numbers of the devices with a model", header, tuple(rows))


def odd_devices_table(fleet: Fleet) -> Table:
    """List the odd devices, the oddest first, and in what each is odd.

    Parameters
    ----------
    fleet
        The fleet.

    Returns
    -------
    Table
    """
    rows = tuple(
        (each.identifier, number(each.distance, 3), "; ".join(each.reasons))
        for each in fleet.outliers[:MOST_ROWS]
    )
    return Table("Odd devices", ("device", "robust deviations", "why"), rows)


def failed_devices_table(fleet: Fleet) -> Table:
    """List the devices without a model, and why.

    Parameters
    ----------
    fleet
        The fleet.

    Returns
    -------
    Table
    """
    rows = tuple(fleet.failures.items())[:MOST_ROWS]
    return Table("Devices without a model", ("device", "why"), rows)


def broken_limits_table(fleet: Fleet) -> Table:
    """List the devices that do not keep their limits, and which.

    Parameters
    ----------
    fleet
        The fleet.

    Returns
    -------
    Table
    """
    broken = zip(fleet.table["identifier"], fleet.table["limits_broken"], strict=True)
    rows = tuple((name, told) for name, told in broken if told)[:MOST_ROWS]
    return Table("Devices that fail the limits", ("device", "limit"), rows)


def write_fleet_page(
    fleet: Fleet, folder: str | os.PathLike[str], figures: bool = True
) -> tuple[Path, ...]:
    """Write the page of a fleet, and its figures as files.

    Parameters
    ----------
    fleet
        The fleet.
    folder
        Made if it is not there.
    figures
        Whether there are any.

    Returns
    -------
    tuple of pathlib.Path
        Everything written.

    Raises
    ------
    InputError
        If the folder is a file.
    """
    pictures = _pictures(fleet) if figures and len(fleet.models) else {}
    with replacing_files(folder) as temporary:
        for name, (png, _) in pictures.items():
            (temporary / name).write_bytes(png)
        (temporary / PAGE).write_text(_page(fleet, pictures), encoding="utf-8")
    return tuple(Path(folder) / name for name in (*pictures, PAGE))


def _pictures(fleet: Fleet) -> dict[str, tuple[bytes, str]]:
    from hyst.report.fleet.figures import draw_fleet_distributions, draw_fleet_loops

    return {
        DISTRIBUTIONS: (
            draw_fleet_distributions(fleet),
            "How many devices have which value; marks at the bottom are odd devices, broken lines "
            "limits. An odd device beyond the axis is a mark at its end, with its value.",
        ),
        LOOPS: (
            draw_fleet_loops(fleet),
            "Loops of the models over the whole drive of their records, odd devices in colour.",
        ),
    }


def _page(fleet: Fleet, pictures: dict[str, tuple[bytes, str]]) -> str:
    page = Page(f"A fleet of {len(fleet.devices)} devices")
    if fleet.passed is False:
        page.banner(f"{fleet.counts()['fail']} devices fail their limits.")
    for each in fleet.sentences():
        page.text(each)
    tables = (
        ("Limits", broken_limits_table(fleet)),
        ("Odd against the fleet", odd_devices_table(fleet)),
        ("Failures", failed_devices_table(fleet)),
    )
    for heading, table in tables:
        if table.rows:
            page.heading(heading)
            page.table(table)
            if len(table.rows) == MOST_ROWS:
                page.faint("The first are shown; all are in fleet.csv.")
    page.heading("Distributions")
    page.table(fleet_numbers_table(fleet))
    if pictures:
        page.picture(*pictures[DISTRIBUTIONS])
        page.heading("Loops")
        page.picture(*pictures[LOOPS])
    page.faint("fleet.csv has a row for each device, models has a file for each that has a model.")
    return page.to_html()
