"""What a notebook shows of a record, a model, a result and a comparison beside their pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.identification import Comparison, Identified
from hyst.operators import ModelDescription, Operator
from hyst.report.comparison_report import (
    compared_errors_table,
    compared_models_table,
    not_invertible_sentences,
)
from hyst.report.description_tables import description_table, errors_table
from hyst.report.parameter_tables import constants_table, parameters_table
from hyst.report.shown.notebook_page import NotebookPage
from hyst.report.table import Table, number, with_unit
from hyst.report.tables import (
    candidates_table,
    metrics_table,
    motion_table,
    per_record_table,
)
from hyst.signals import Record


def page_of_record(record: Record) -> str:
    """Say what a ``record`` holds: signals, ranges, units, time and what was done to it."""
    page = NotebookPage(
        f"Record: {record.samples} samples, {number(record.duration)} s at {number(record.rate)} Hz"
    )
    page.table(
        Table(
            "Signals",
            ("signal", "name", "unit", "lowest", "highest"),
            (
                _signal("input u", record.input_name, record.input_unit, record.u),
                _signal("output y", record.output_name, record.output_unit, record.y),
            ),
        )
    )
    page.items(record.notes)
    return page.to_html()


def page_of_operator(model: Operator) -> str:
    """Say what a ``model`` is: its meaning, its constants, its verdict."""
    about = model.description
    page = NotebookPage(f"Model: {model.kind}")
    if about.verdict is not None:
        page.verdict(about.verdict)
    if about != ModelDescription():
        page.table(description_table(about))
        page.table(errors_table(about))
    page.table(constants_table(model))
    return page.to_html()


def page_of_identified(found: Identified) -> str:
    """Say what was ``found``: how far to trust it, how good it is, and its constants."""
    about, what = found.description, found.family or found.model.kind
    page = NotebookPage(f"{what}: {about.output_name} over {about.input_name}")
    page.verdict(found.verdict)
    page.text(f"{found.delay_in_words()}, {found.status}")
    for table in (metrics_table, per_record_table, motion_table, parameters_table):
        page.table(table(found))
    if found.candidates:
        page.table(candidates_table(found))
    page.items(found.undetermined)
    return page.to_html()


def page_of_comparison(found: Comparison) -> str:
    """Say which of the models that were ``found`` is for what, with their errors."""
    first = found.records[0]
    page = NotebookPage(
        f"{len(found)} model{'s' * (len(found) != 1)} of {first.output_name} over "
        f"{first.input_name}, side by side"
    )
    page.items(found.sentences())
    page.table(compared_errors_table(found))
    page.table(compared_models_table(found))
    page.items(not_invertible_sentences(found))
    return page.to_html()


def page_of_diagnosis(found: Diagnosis) -> str:
    """Say what records can tell, as ``found`` before any model."""
    page = NotebookPage("What these records can tell")
    page.items(
        [f"{each.severity}: {each.sentence} {each.advice}".rstrip() for each in found.findings]
    )
    if not found.findings:
        page.text("Nothing was found that a user should know.")
    return page.to_html()


def _signal(role: str, name: str, unit: str, signal: NDArray[np.float64]) -> tuple[str, ...]:
    low, high = (with_unit(number(float(end)), unit) for end in (signal.min(), signal.max()))
    return role, name, unit or "not known", low, high
