"""Tables of what a model file says beside the model: meaning, errors, origin."""

from __future__ import annotations

from hyst.operators import ModelDescription
from hyst.report.delay_words import lag_in_words
from hyst.report.table import Table, number, with_unit


def description_table(about: ModelDescription) -> Table:
    """List what the numbers of a model mean, as far as its file says.

    Parameters
    ----------
    about
        From the model file.

    Returns
    -------
    Table
    """

    def signal(name: str, unit: str, low: float | None, high: float | None) -> str:
        extent = "" if low is None or high is None else f", {number(low, 6)} to {number(high, 6)}"
        return f"{name}{extent}" + (f" {unit}" if unit else "")

    rows = [
        ("family", about.family or "not identified"),
        ("input", signal(about.input_name, about.input_unit, about.input_low, about.input_high)),
        (
            "output",
            signal(about.output_name, about.output_unit, about.output_low, about.output_high),
        ),
        ("sample time", "any" if about.dt is None else f"{number(about.dt, 6)} s"),
        ("delay of the output", _delay(about)),
    ]
    if about.driver is not None:
        rows.append(("driver", about.driver.told()))
    if about.smallest_swing is not None:
        swing = with_unit(number(about.smallest_swing), about.input_unit)
        rows.append(("smallest loop it was shown", swing))
    if about.verdict is not None:
        rows.insert(0, ("verdict", about.verdict.level))
    return Table("Description", ("what", "value"), tuple(rows))


def _delay(about: ModelDescription) -> str:
    if about.delay < 0:
        return f"{lag_in_words(about.delay, about.dt, about.delay_interval)}: not aligned"
    return lag_in_words(about.delay, about.dt, about.delay_interval)


def errors_table(about: ModelDescription) -> Table:
    """List how good a model was when it was identified.

    Parameters
    ----------
    about
        From the model file.

    Returns
    -------
    Table
        A row a record; none if the file does not say.
    """
    told = about.input_unit if about.is_inverse else about.output_unit
    unit = told and f"[{told}]"
    rms, largest = with_unit("rms", unit), with_unit("max", unit)
    names = {"rms": rms, "rms_percent": "rms, % of range", "max_abs": largest}
    rows = tuple(
        (record, *(number(errors[name]) if name in errors else "-" for name in names))
        for record, errors in about.errors.items()
    )
    of = "the model it inverts" if about.is_inverse else "it"
    return Table(f"Errors when {of} was identified", ("record", *names.values()), rows)


def provenance_table(about: ModelDescription) -> Table:
    """List where a model comes from.

    Parameters
    ----------
    about
        From the model file.

    Returns
    -------
    Table
        Empty if the file does not say.
    """
    origin = about.provenance
    rows: list[tuple[str, str]] = []
    if origin is not None:
        rows.append(("date", origin.date))
        if origin.command:
            rows.append(("command", origin.command))
        rows.append(("options", ", ".join(f"{k} {v}" for k, v in origin.options.items()) or "none"))
        rows.append(("versions", ", ".join(f"{k} {v}" for k, v in origin.versions.items())))
        rows.append(("sha256 of the data", origin.data_sha256))
    return Table("Origin", ("what", "value"), tuple(rows))
