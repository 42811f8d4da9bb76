"""The report of an identification: model, numbers, figures and a page that explains them."""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from hyst._files import replacing_files
from hyst.identification import Identified
from hyst.operators.verdict import UNFIT
from hyst.report.error_memory import autocorrelation
from hyst.report.fitted_record import FittedRecord, fit_records
from hyst.report.page import Page
from hyst.report.parameter_tables import parameters_table
from hyst.report.table import Table, number, with_unit
from hyst.report.tables import (
    candidates_table,
    metrics_table,
    motion_table,
    per_record_table,
)
from hyst.report.words import (
    command_method,
    error_sentence,
    in_short,
    memory_sentence,
    words_of,
)
from hyst.signals import Record

MODEL, METRICS, PAGE = "model.json", "metrics.json", "report.html"
LOOP, HISTORY, ERROR, PARTS = "loop.png", "history.png", "error.png", "model.png"
FILES = (MODEL, METRICS, LOOP, HISTORY, ERROR, PARTS, PAGE)
"""Everything a report consists of."""

_LOOP_CAPTION = (
    "Recorded and modelled loop. Beside it the straight line that fits best is taken away, so that "
    "the hysteresis fills the picture."
)


@dataclass(frozen=True, eq=False)
class Section:
    """A section of the page that a caller adds, with a picture.

    Parameters
    ----------
    heading, texts, table
        What it says.
    picture, png, caption
        Name of the picture's file, its content, and what there is to see.
    files
        Further files to write beside it, by name.
    leads
        Whether it says what the page is read for, so that it stands at its beginning.
    """

    heading: str
    texts: tuple[str, ...]
    table: Table
    picture: str
    png: bytes
    caption: str
    files: Mapping[str, bytes] = field(default_factory=dict)
    leads: bool = False


@dataclass(frozen=True, eq=False)
class _Findings:
    """What the page is written from."""

    identified: Identified
    training: tuple[FittedRecord, ...]
    validation: tuple[FittedRecord, ...]
    sources: tuple[str, ...]
    folder: Path
    banner: str
    sections: tuple[Section, ...]

    @property
    def records(self) -> tuple[Record, ...]:
        return tuple(fit.record for fit in self.training)


def write_report(
    identified: Identified,
    records: Record | Sequence[Record],
    validation: Record | Sequence[Record],
    folder: str | os.PathLike[str],
    *,
    sources: Sequence[str] = (),
    banner: str = "",
    sections: Sequence[Section] = (),
    figures: bool = True,
) -> tuple[Path, ...]:
    """Write model.json, metrics.json, the figures and report.html; all of them or none.

    Parameters
    ----------
    identified
        The result.
    records
        Records it was identified from, in the same order.
    validation
        Records kept apart; may be empty.
    folder
        Made if it does not exist; its own parent must. Other files in it stay.
    sources
        Where the records came from, training before validation, for the page.
    banner
        A line to put above everything, for instance that the data are simulated.
    sections
        Further sections of the page; their pictures and files are written too.
    figures
        Whether the figures of the result are drawn; without them matplotlib is not loaded.

    Returns
    -------
    tuple of pathlib.Path
        The files written.

    Raises
    ------
    InputError
        If the folder cannot be one.

    Examples
    --------
    ::

        found = hyst.identify(record)
        hyst.report.write_report(found, record, (), "out")
    """
    training, kept = fit_records(identified, _several(records), _several(validation))
    findings = _Findings(
        identified, training, kept, tuple(sources), Path(folder), banner, tuple(sections)
    )
    pictures = _figures(findings) if figures else {}
    with replacing_files(folder) as temporary:
        identified.model.save(temporary / MODEL, identified.description)
        numbers = json.dumps(identified.to_dict(), indent=2, allow_nan=False, ensure_ascii=False)
        (temporary / METRICS).write_text(numbers + "\n", encoding="utf-8")
        for name, content in pictures.items():
            (temporary / name).write_bytes(content)
        for section in sections:
            for name, content in _files_of(section).items():
                (temporary / name).write_bytes(content)
        (temporary / PAGE).write_text(_page(findings, pictures), encoding="utf-8")
    written = (each for each in FILES if each in pictures or not each.endswith(".png"))
    names = (*written, *(name for section in sections for name in _files_of(section)))
    return tuple(Path(folder) / name for name in names)


def _files_of(section: Section) -> dict[str, bytes]:
    return {section.picture: section.png, **section.files}


def _several(records: Record | Sequence[Record]) -> tuple[Record, ...]:
    return (records,) if isinstance(records, Record) else tuple(records)


def _figures(findings: _Findings) -> dict[str, bytes]:
    # Here, for matplotlib takes as long to import as all else, and pages without figures need none.
    from hyst.report.identification_figures import draw_identification

    training, about = findings.training, findings.identified.description
    named = (about.input_name, about.input_unit, about.output_name, about.output_unit)
    shown = (*training[:1], *findings.validation[:1])
    drawn = draw_identification(findings.identified, training, shown, named, findings.banner)
    return dict(zip((LOOP, HISTORY, ERROR, PARTS), drawn, strict=True))


def _page(findings: _Findings, pictures: dict[str, bytes]) -> str:
    about = findings.identified.description
    page = Page(f"Hysteresis of {about.output_name} over {about.input_name}")
    if findings.banner:
        page.banner(findings.banner)
    page.verdict(findings.identified.verdict)
    page.items(in_short(findings.identified, findings.records))
    leading = [each for each in findings.sections if each.leads]
    if not leading:
        _show(page, pictures, LOOP, _LOOP_CAPTION)
    for section in leading:
        _further(page, section)
    _how_good(page, findings, pictures)
    _the_model(page, findings, pictures)
    _what_was_compared(page, findings)
    _the_data(page, findings)
    for section in findings.sections:
        if not section.leads:
            _further(page, section)
    _what_next(page, findings)
    return page.to_html()


def _show(page: Page, pictures: dict[str, bytes], name: str, caption: str) -> None:
    if name in pictures:
        page.picture(pictures[name], caption)


def _how_good(page: Page, findings: _Findings, pictures: dict[str, bytes]) -> None:
    page.heading("How good it is")
    page.table(metrics_table(findings.identified))
    if findings.identified.motion:
        page.table(motion_table(findings.identified))
    by_record = per_record_table(findings.identified)
    if by_record.rows:
        page.table(by_record)
    page.text(
        "Fit is 100 % for a perfect model and 0 % for one no better than the mean. With a free "
        "offset the mean of the error is taken out first: sensors drift, and a constant between "
        "model and sensor often means nothing."
    )
    if any(each.leads for each in findings.sections):
        # With dynamics, output over input is a cloud: what it shows best is how far they agree.
        _show(page, pictures, LOOP, _LOOP_CAPTION)
    _show(
        page,
        pictures,
        HISTORY,
        "Output over time, in the band that is to hold 95 % of the samples. A shaded beginning was "
        "not used.",
    )
    _show(page, pictures, ERROR, "What the model leaves unexplained on the training record.")
    error = findings.training[0].error
    lag_one = float(autocorrelation(error, 1)[1]) if error.size > 1 else 0.0
    page.text(error_sentence(lag_one, error.size))


def _the_model(page: Page, findings: _Findings, pictures: dict[str, bytes]) -> None:
    identified = findings.identified
    words = words_of(identified)
    page.heading(f"The model: {words.full_name}")
    for each in words.equations:
        page.equation(each)
    for each in words.explanations:
        page.text(each)
    _show(page, pictures, PARTS, "What the model is made of.")
    page.table(parameters_table(identified))
    page.faint(
        "Standard errors say how far a value may be off because of noise; they allow for errors "
        "that last longer than one sample. A dash: on a bound, or not determined by the records."
    )
    if identified.undetermined:
        page.text("What the records leave open, or what makes them doubtful:")
        page.items(identified.undetermined)


def _what_was_compared(page: Page, findings: _Findings) -> None:
    identified = findings.identified
    if not identified.candidates:
        return
    page.heading("What else was tried")
    page.text(
        "Every candidate was identified without some blocks of the record and judged on those, "
        "each stretch of them with its own offset, so that slow drift does not decide: errors here "
        "can be smaller than those of the fit above. The simplest one that the blocks do not show "
        "to be worse than the best was taken: within one standard error of the difference, block "
        "by block, which is known better than either error (+-)."
    )
    page.table(candidates_table(identified))


def _the_data(page: Page, findings: _Findings) -> None:
    page.heading("The data")
    identified = findings.identified
    fits = (*findings.training, *findings.validation)
    sources = findings.sources or ("",) * len(fits)
    rows = []
    for fit, source in zip(fits, sources, strict=True):
        record = fit.record
        rows.append(
            (
                fit.label,
                source,
                str(len(record)),
                f"{number(record.dt)} s",
                _range(record.u, record.input_unit),
                _range(record.y, record.output_unit),
            )
        )
    page.table(
        Table(
            "Records", ("record", "file", "samples", "sample time", "input", "output"), tuple(rows)
        )
    )
    page.items(
        [
            f"{fit.label}: output samples {used.start} to {used.stop - 1} of {used.total} were used"
            + (
                "; before, the memory of the actuator is not known."
                if used.start > max(identified.delay, 0.0)
                else "."
            )
            for fit, used in zip(findings.training, identified.used_of_shown, strict=True)
        ]
        + [f"{fit.label}: {note}" for fit in fits for note in fit.record.notes]
    )
    count = identified.iterations
    page.faint(f"The fit ended: {identified.status} after {count} iteration{'s' * (count != 1)}.")


def _further(page: Page, section: Section) -> None:
    page.heading(section.heading)
    for text in section.texts:
        page.text(text)
    page.table(section.table)
    page.picture(section.png, section.caption)


def _range(signal: np.ndarray[tuple[int], np.dtype[np.float64]], unit: str) -> str:
    return with_unit(f"{number(float(signal.min()))} to {number(float(signal.max()))}", unit)


def _what_next(page: Page, findings: _Findings) -> None:
    if findings.identified.verdict.level == UNFIT:
        return
    page.heading("What next")
    model = shlex.quote(str(findings.folder / MODEL))
    method = command_method(findings.identified)
    if not method:
        page.text("The output for another input:")
        page.code(f"hyst simulate {model} drive.csv --input 0 -o output.csv")
        return
    page.text("The command that makes the output follow a trajectory of yours:")
    option, argument = ("", "") if method == "exact" else (f" --method {method}", f', "{method}"')
    page.code(f"hyst compensate {model} trajectory.csv --column 0{option} -o command.csv")
    page.text("The same in Python:")
    page.code(
        "import hyst\n\n"
        f"model = hyst.load({str(findings.folder / MODEL)!r})\n"
        f"command = hyst.compensation.invert_trajectory(model, y_ref{argument}).u"
    )
    page.text(memory_sentence(findings.records[0]))
