"""hyst info: what is in a file that hyst saved."""

from __future__ import annotations

from typing import Any

import hyst
from hyst.cli.arguments import ModelFile
from hyst.cli.console import show_table
from hyst.cli.scheduled import tell


def info(model_file: ModelFile) -> None:
    """Show what a model file holds: meaning, errors, origin, constants, traits, invertibility."""
    found = hyst.load(model_file)
    about = found.description
    if about.verdict is not None:
        print(hyst.report.verdict_lines(about.verdict))
    show_table(hyst.report.description_table(about))
    for table in (hyst.report.errors_table(about), hyst.report.provenance_table(about)):
        if table.rows:
            show_table(table)
    if isinstance(found, hyst.Scheduled):
        tell(found)
        return
    operator = _operator(found)
    if operator is not None:
        show_table(hyst.report.constants_table(operator, about.input_unit, about.output_unit))
        show_table(hyst.report.traits_table(operator))
        print(f"\n{hyst.report.invertible_sentence(operator)}")


def _drive(found: hyst.control.TrackingController | hyst.control.RepetitiveController) -> str:
    """Say what the drive of a controller may be."""
    said = ""
    if found.limits is not None:
        said = f"drive from {found.limits[0]:.6g} to {found.limits[1]:.6g}, "
    if found.rate is not None:
        said += f"at most {found.rate:.6g} per second, "
    return said


def _operator(found: Any) -> hyst.operators.Operator | None:
    """Give the operator to tell of, and say whose it is if the file holds something else."""
    if isinstance(found, hyst.operators.Operator):
        return found
    if isinstance(found, hyst.control.TrackingController):
        what = "no inverse" if found.inverse is None else "an inverse, as follows"
        print(
            f"tracking controller: {found.order} states, dt {found.dt:.6g} s, {_drive(found)}{what}"
        )
        return found.inverse
    if isinstance(found, hyst.control.RepetitiveController):
        what = "no inverse" if found.inverse is None else "an inverse, as follows"
        print(
            f"repetitive controller: period of {found.period} samples, dt {found.dt:.6g} s, "
            f"{_drive(found)}{what}"
        )
        return found.inverse
    print(f"{type(found).__name__}: the model it has found so far is")
    model: hyst.operators.Operator = found.model
    return model
