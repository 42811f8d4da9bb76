"""What can be said of a drive before it is run."""

from __future__ import annotations

from hyst.report.table import Table, number
from hyst.signals import Drive


def drive_table(drive: Drive, name: str) -> Table:
    """Give size, peaks, rates and crest factor of a drive.

    Parameters
    ----------
    drive
        The drive.
    name
        Of the input, with its unit.

    Returns
    -------
    Table
    """
    rows = (
        ("samples", str(len(drive))),
        ("duration [s]", number(len(drive) * drive.dt)),
        ("period [samples]", str(drive.period) if drive.period else "none"),
        ("starts at", number(float(drive.u[0]))),
        ("ends at", number(float(drive.u[-1]))),
        ("lowest", number(float(drive.u.min()))),
        ("highest", number(float(drive.u.max()))),
        ("rms about the mean", number(drive.rms)),
        ("crest factor", number(drive.crest_factor)),
        ("largest rate [per s]", number(drive.max_rate)),
        ("largest acceleration [per s^2]", number(drive.max_acceleration)),
    )
    return Table(f"{drive.kind} of {name}", ("", "value"), rows)
