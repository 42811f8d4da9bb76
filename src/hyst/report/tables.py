"""Tables of what was identified and compensated."""

from __future__ import annotations

import math

from hyst.compensation import Compensation, error_parts
from hyst.identification import Identified, RecordErrors
from hyst.identification.families.hammerstein.told.dynamics_words import HEADER, root_rows
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
)
from hyst.identification.families.registry import families
from hyst.identification.result.record_errors import run_at_several_rates
from hyst.operators import Operator
from hyst.operators.traits import Degree
from hyst.report.table import Table, number, with_unit

_TRAITS = {
    "memoryless": "output depends on the present input alone",
    "rate_independent": "speed does not matter",
    "return_point_memory": "minor loops close and are forgotten",
    "congruent_loops": "loops between the same inputs have one shape",
    "monotone": "output never falls while the input rises",
    "invertible": "has an exact inverse",
}


def metrics_table(identified: Identified) -> Table:
    """Errors by record.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    Table
    """
    unit = identified.description.output_unit
    return Table(
        "Error of the model (modelled minus recorded output)",
        (
            "record",
            with_unit("rms", unit and f"[{unit}]"),
            "rms [% of range]",
            with_unit("max", unit and f"[{unit}]"),
            "max [% of range]",
            "fit [%]",
        ),
        tuple(
            (
                name,
                number(each.rms),
                f"{each.rms_percent:.3f}",
                number(each.max_abs),
                f"{each.max_percent:.3f}",
                f"{each.nrmse_fit_percent:.2f}",
            )
            for name, each in identified.metrics.items()
        ),
    )


def motion_table(identified: Identified) -> Table:
    """Give what moves the output, part by part; no rows where nothing came up but hysteresis.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    Table
    """
    unit = identified.description.output_unit
    return Table(
        "What moves the output, and what of it the model has",
        ("part", with_unit("rms", unit and f"[{unit}]"), "rms [% of range]", "in the model"),
        tuple(
            (
                each.name,
                "not told by these records" if math.isnan(each.rms) else number(each.rms),
                "-" if math.isnan(each.percent) else f"{each.percent:.3f}",
                "yes" if each.in_model else "no",
            )
            for each in identified.motion
        ),
    )


def per_record_table(identified: Identified) -> Table:
    """Errors over each of the records it was identified from.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    Table
        No row for a single record, of which the table of metrics says the same.
    """
    unit = identified.description.output_unit
    several = identified.per_record if len(identified.per_record) > 1 else ()
    rates = run_at_several_rates(several)
    return Table(
        "Error by record (percent of its own output range)",
        (
            "record",
            with_unit("rms", unit and f"[{unit}]"),
            "rms [%]",
            with_unit("max", unit and f"[{unit}]"),
            "max [%]",
            "samples used",
            *(("frequency [Hz]", "hysteresis [%]", "of the model [%]") if rates else ()),
        ),
        tuple(_record_row(each) + (_loop_cells(each) if rates else ()) for each in several),
    )


def _loop_cells(each: RecordErrors) -> tuple[str, ...]:
    return (
        "-" if each.frequency is None else number(each.frequency),
        "-" if each.hysteresis is None else f"{each.hysteresis:.2f}",
        "-" if each.modelled_hysteresis is None else f"{each.modelled_hysteresis:.2f}",
    )


def _record_row(each: RecordErrors) -> tuple[str, ...]:
    name = f"{each.number}, {each.name}" if each.name else str(each.number)
    if each.metrics is None:
        return name, "-", "-", "-", "-", str(each.samples)
    return (
        name,
        number(each.metrics.rms),
        f"{each.metrics.rms_percent:.3f}",
        number(each.metrics.max_abs),
        f"{each.metrics.max_percent:.3f}",
        str(each.samples),
    )


def candidates_table(identified: Identified) -> Table:
    """Families and sizes that were compared; the chosen one is marked.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    Table
    """
    unit = identified.description.output_unit
    candidates = identified.candidates
    marked = [k for k, each in enumerate(candidates) if each.chosen]
    title, error = _compared_by(identified)
    return Table(
        title,
        (
            "family",
            "plays",
            "parameters",
            with_unit(error, unit and f"[{unit}]"),
            "+-",
            "chosen",
        ),
        tuple(
            (
                each.family,
                str(each.plays),
                str(each.parameters),
                number(each.score),
                number(each.standard_error, 2),
                "<- chosen" if each.chosen else "",
            )
            for each in candidates
        ),
        marked[0] if marked else None,
    )


def _compared_by(identified: Identified) -> tuple[str, str]:
    """Give the title of a comparison and of its errors: on left-out blocks, or in the sample."""
    compared = [families.get(each.family) for each in identified.candidates]
    if all(each is not None and each.judged_in_sample for each in compared):
        return (
            "Sizes compared by the error of the fit times what each further parameter costs "
            "(Bayesian criterion)",
            "error with that",
        )
    return (
        "Families and sizes compared by blocks left out of the fit, each block with its own offset",
        "error on left-out blocks",
    )


def traits_table(model: Operator) -> Table:
    """List what may be relied on of an operator.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    Table
    """
    held = model.traits().held()
    return Table(
        "Traits",
        ("trait", "holds", "meaning"),
        tuple(
            (name.replace("_", " "), _said(held[name]), meaning)
            for name, meaning in _TRAITS.items()
        ),
    )


def _said(held: bool | Degree) -> str:
    return "to rounding" if held is Degree.TO_ROUNDING else "yes" if held else "no"


def compensation_table(done: Compensation, unit: str) -> Table:
    """Give the tracking error the model predicts, and what the model itself missed.

    Parameters
    ----------
    done
        The command and its prediction.
    unit
        Of the output.

    Returns
    -------
    Table
    """

    def row(name: str, value: float) -> tuple[str, str, str]:
        percent = done.percent_of_range(value)
        return name, number(value), "-" if percent is None else number(percent)

    model = done.expected
    expected = (
        ()
        if model is None
        else (
            row(f"model itself, rms ({model.record})", model.rms),
            row(f"model itself, max ({model.record})", model.max_abs),
        )
    )
    predicted = tuple(
        row(", ".join(filter(None, (f"inversion, {name}", part.name))), value)
        for part in error_parts(done)
        for name, value in (("rms", part.rms), ("max", part.max_abs))
    )
    return Table(
        "Tracking error: of the model against the reference, and of the model against its record",
        ("", with_unit("error", unit and f"[{unit}]"), "% of the reference's range"),
        (*predicted, *expected),
    )


def dynamics_table(found: Identified) -> Table:
    """Give poles and zeros of the dynamics with standard errors; no rows where there are none.

    Parameters
    ----------
    found
        Any result.

    Returns
    -------
    Table
    """
    rows = root_rows(found.known) if isinstance(found, IdentifiedHammerstein) else ()
    return Table("Poles and zeros of G, with standard errors", HEADER, rows)
