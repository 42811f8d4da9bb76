"""What a drive will determine, as a table."""

from __future__ import annotations

from hyst.identification.forecast import DriveForecast, ExpectedError
from hyst.report.table import Table, number

_OPEN = 10.0  # times the number


def forecast_table(found: DriveForecast) -> Table:
    """Give every number of a stated model with the standard error to expect.

    Parameters
    ----------
    found
        Of a drive.

    Returns
    -------
    Table
    """
    header = ("number", "stated", "standard error", "determined")
    return Table(forecast_headline(found), header, tuple(_row(each) for each in found.errors))


def forecast_headline(found: DriveForecast) -> str:
    """Say in one sentence how much of a stated model a drive determines."""
    sure = len(found.errors) - len(found.undetermined)
    need = (
        f"{found.free_of_dynamics} of the dynamics and {found.free_of_front} of the hysteresis"
        if found.of_dynamics
        else f"{found.free_of_front}"
    )
    return (
        f"what it will determine of the stated model, which has {need} to find, with noise of "
        f"{number(found.noise_rms)} on an output of rms {number(found.output_rms)}: "
        f"{sure} of {len(found.errors)} numbers"
    )


def _row(each: ExpectedError) -> tuple[str, ...]:
    # An error of many times the number is none that means something.
    error = "-" if each.held else number(each.error) if each.share < _OPEN else "open"
    return each.name, number(each.value), error, each.verdict
