"""Tables of a model's constants, with their units where these are known."""

from __future__ import annotations

import math
from collections.abc import Mapping

from hyst.identification import Identified
from hyst.operators import Operator
from hyst.report.parameter_units import units_of_parameters
from hyst.report.table import Table, number


def parameters_table(identified: Identified) -> Table:
    """Free parameters with their standard errors, and a gain that turns the output round.

    Parameters
    ----------
    identified
        The result.

    Returns
    -------
    Table
    """
    about = identified.description
    units = units_of_parameters(identified.model, about.input_unit, about.output_unit)
    unit_of = dict(zip(identified.model.parameters().names, units, strict=True))
    rows = [
        (name, number(value, 6), "-" if math.isnan(error) else number(error, 2))
        for name, value, error in zip(
            identified.parameter_names,
            identified.parameter_values.tolist(),
            identified.standard_errors.tolist(),
            strict=True,
        )
    ] + _fixed_gains(identified)
    header = ("parameter", "value", "standard error")
    return _with_units(Table("Parameters", header, tuple(rows)), unit_of)


def _fixed_gains(identified: Identified) -> list[tuple[str, str, str]]:
    """List gains that were not free and are not 1: without them the others read wrong."""
    constants = identified.model.parameters()
    return [
        (name, number(value, 6), "fixed")
        for name, value in zip(constants.names, constants.values.tolist(), strict=True)
        if name.rpartition(".")[2] == "gain"
        and value != 1.0
        and name not in identified.parameter_names
    ]


def _with_units(table: Table, unit_of: Mapping[str, str]) -> Table:
    """Add a column of units, unless none is known."""
    units = [unit_of.get(row[0], "") for row in table.rows]
    if not any(units):
        return table
    rows = tuple((*row, unit) for row, unit in zip(table.rows, units, strict=True))
    return Table(table.title, (*table.header, "unit"), rows)


def constants_table(model: Operator, input_unit: str = "", output_unit: str = "") -> Table:
    """All constants of an operator.

    Parameters
    ----------
    model
        Any operator.
    input_unit, output_unit
        Units of its signals; empty where not known.

    Returns
    -------
    Table
    """
    own = model.parameters()
    units = units_of_parameters(model, input_unit, output_unit)
    pairs = zip(own.names, own.values.tolist(), strict=True)
    rows = tuple((name, number(value, 10)) for name, value in pairs)
    return _with_units(
        Table("Constants", ("name", "value"), rows), dict(zip(own.names, units, strict=True))
    )
