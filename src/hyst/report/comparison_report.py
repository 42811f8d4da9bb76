"""The report of a comparison: tables, figures, numbers and a page."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from hyst._files import replacing_files
from hyst.compensation import methods_for
from hyst.identification import ComparedModel, Comparison
from hyst.report.comparison_figures import (
    MOST_DRAWN,
    draw_compared_errors,
    draw_compared_loops,
)
from hyst.report.page import Page
from hyst.report.table import Table, number, with_unit

NUMBERS, PAGE = "comparison.json", "comparison.html"
LOOPS, ERRORS = "loops.png", "errors.png"
TAKEN = "model.json"
COMPARISON_FILES = (NUMBERS, LOOPS, ERRORS, PAGE, TAKEN)
"""Everything the report of a comparison consists of; no model.json where none is to be taken."""


def compared_errors_table(found: Comparison) -> Table:
    """Errors of every model, and where it is furthest off; the chosen one is marked.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    Table
    """
    first, several = found.records[0], len(found.records) > 1
    unit = f"[{first.output_unit}]" if first.output_unit else ""
    return Table(
        "Errors on these records (modelled minus recorded output)",
        (
            "model",
            with_unit("rms", unit),
            "rms [% of range]",
            with_unit("max", unit),
            with_unit("rms, free offset", unit),
            with_unit("outer strokes", unit),
            with_unit("minor loops", unit),
            "worst at",
            "time [s]",
            with_unit("input", f"[{first.input_unit}]" if first.input_unit else ""),
        ),
        tuple(_errors_row(each, several) for each in found.models),
        _marked(found),
    )


def _errors_row(each: ComparedModel, several: bool) -> tuple[str, ...]:
    worst = each.worst
    record = f"record {worst.record}, " if several else ""
    return (
        each.name,
        number(each.metrics.rms),
        f"{each.metrics.rms_percent:.3f}",
        number(each.metrics.max_abs),
        number(each.free_offset.rms),
        "-" if each.outer_strokes is None else number(each.outer_strokes),
        "-" if each.minor_loops is None else number(each.minor_loops),
        f"{record}sample {worst.sample}",
        number(worst.time, 5),
        number(worst.input),
    )


def compared_models_table(found: Comparison) -> Table:
    """List family, size, delay, cost, inverse and verdict of each model; the chosen is marked.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    Table
    """
    return Table(
        "The models",
        (
            "model",
            "family",
            "constants",
            "delay [samples]",
            "ns a sample",
            "way to a command",
            "verdict when saved",
        ),
        tuple(
            (
                each.name,
                each.family,
                str(each.constants),
                _delay(each),
                number(each.nanoseconds, 3),
                _way(each),
                "not judged" if each.verdict is None else each.verdict.level,
            )
            for each in found.models
        ),
        _marked(found),
    )


def not_invertible_sentences(found: Comparison) -> tuple[str, ...]:
    """Say of each model without an exact inverse why, and what it has in its place.

    Parameters
    ----------
    found
        The comparison.

    Returns
    -------
    tuple of str
    """
    sentences = []
    for each in found.models:
        if each.is_invertible:
            continue
        others = [method for method in methods_for(each.model) if method != "exact"]
        more = f"; hyst compensate has --method {', '.join(others)}" if others else ""
        sentences.append(f"{each.name} has no exact inverse: {each.not_invertible}{more}.")
    return tuple(sentences)


def write_comparison(
    found: Comparison,
    folder: str | os.PathLike[str],
    *,
    sources: Mapping[str, str] | None = None,
    data: str = "",
    save: Sequence[str] = (),
) -> tuple[Path, ...]:
    """Write comparison.json, the figures, comparison.html and the model to take as model.json.

    All of them or none.

    Parameters
    ----------
    found
        The comparison.
    folder
        Made if it does not exist. Other files in it stay.
    sources
        The file of each model, by its name, for the page.
    data
        Where the records came from.
    save
        Names of models to write beside them, each as NAME.json.

    Returns
    -------
    tuple of pathlib.Path
        The files written; model.json is none of them where every model is unfit.

    Raises
    ------
    InputError
        If the folder cannot be one, or a model of such a name there is none.

    Examples
    --------
    ::

        found = hyst.compare({"plays": plays, "friction": friction}, record)
        hyst.report.write_comparison(found, "side-by-side")
    """
    figures = {LOOPS: draw_compared_loops(found), ERRORS: draw_compared_errors(found)}
    files = dict(sources or {})
    models = {f"{name}.json": found[name].model for name in save}
    if found.chosen is not None:
        models[TAKEN] = found.chosen.model
    with replacing_files(folder) as temporary:
        numbers = found.to_dict() | {"files": files, "data": data}
        text = json.dumps(numbers, indent=2, allow_nan=False, ensure_ascii=False)
        (temporary / NUMBERS).write_text(text + "\n", encoding="utf-8")
        for name, content in figures.items():
            (temporary / name).write_bytes(content)
        (temporary / PAGE).write_text(_page(found, figures, files, data), encoding="utf-8")
        for name, model in models.items():
            model.save(temporary / name)
    written = (NUMBERS, LOOPS, ERRORS, PAGE, *models)
    return tuple(Path(folder) / name for name in written)


def _page(found: Comparison, figures: dict[str, bytes], files: dict[str, str], data: str) -> str:
    first = found.records[0]
    page = Page(f"Models of {first.output_name} over {first.input_name}, side by side")
    page.items(found.sentences())
    shown = "" if len(found) <= MOST_DRAWN else f" The {MOST_DRAWN} best are shown."
    page.picture(
        figures[LOOPS],
        "The recorded loop and those of the models. Beside it the straight line that fits the "
        f"record best is taken away, so that the hysteresis fills the picture.{shown}",
    )
    page.heading("The errors")
    page.table(compared_errors_table(found))
    page.faint(
        "All models are judged on the same samples. Percentages are of the range of the whole "
        "records. Outer strokes are those from nine tenths of the longest on, minor loops all "
        "others; a dash: the records hold hardly any. With a free offset the mean error is taken "
        "out. The marked row is the one to take."
    )
    page.picture(figures[ERRORS], f"Errors over time, all in one scale.{shown}")
    page.heading("The models")
    page.table(compared_models_table(found))
    page.items(not_invertible_sentences(found))
    page.heading("The verdicts they were saved with")
    page.items(
        [
            f"{each.name}: not judged"
            if each.verdict is None
            else f"{each.name}: {each.verdict.level} - {' '.join(each.verdict.sentences)}"
            for each in found.models
        ]
    )
    page.heading("The data")
    page.items(
        [
            f"record {k}{f' of {data}' if data else ''}: output samples {used.start} to "
            f"{used.stop - 1} of {used.total}"
            for k, used in enumerate(found.used, 1)
        ]
        + [f"{name}: {file}" for name, file in files.items()]
    )
    return page.to_html()


def _marked(found: Comparison) -> int | None:
    chosen = found.chosen
    return None if chosen is None else found.models.index(chosen)


def _way(each: ComparedModel) -> str:
    if each.is_invertible:
        return "exact inverse"
    others = methods_for(each.model)
    return others[0] if others else "none"


def _delay(each: ComparedModel) -> str:
    about = each.description
    interval = about.delay_interval
    if interval is None or interval[0] == interval[1]:
        return number(float(about.delay))
    return f"{number(float(about.delay))} ({number(interval[0], 3)} to {number(interval[1], 3)})"
