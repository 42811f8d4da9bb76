"""Choose columns by looking at them."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from typing import Any

from nicegui import ui

from hyst.io import ColumnSummary
from hyst.studio.page.pieces import picture, section, text
from hyst.studio.session import StudioSession
from hyst.studio.work.choice import ROLES

_UNITS = ("", "s", "ms", "us", "ns", "min", "h", "days")
_NONE = "none"
_NAMES = {"output_time": "output's time"}


def draw_columns(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        Not used here.
    """
    with section("columns", "2. Its columns"):
        if session.look is None:
            text("Open a file first.", "small")
            if session.file and "file" in session.said:
                _draw_table(session)  # which may be all that is missing
            return
        text(
            "Say which column is what. The guess is by names, units and values: check it.", "small"
        )
        with ui.element("div").classes("signals"):
            for column, sketch in session.look.columns:
                _draw_column(session, column, sketch)
        for each in session.look.notes:
            text(f"No column: {each}.", "small")
        _draw_reading(session)


def _draw_column(session: StudioSession, column: ColumnSummary, sketch: str) -> None:
    role, guess = session.choice.role_of(column.index), column.guess
    unit = f" [{column.unit}]" if column.unit else ""
    name = f"{column.name or f'column {column.index}'}{unit}"

    async def choose(event: Any) -> None:
        await session.choose_role(column.index, "" if event.value == _NONE else event.value)

    with ui.element("fieldset").classes(f"signal {role}"):
        ui.html("", tag="legend", sanitize=False).set_content(_legend(name, guess))
        picture(sketch)
        text(
            f"{column.size} values, {column.low:.4g} to {column.high:.4g}"
            if column.low <= column.high
            else f"{column.size} entries, no numbers",
            "small",
        )
        if column.flaw:
            text(column.flaw, "small")
        options = {_NONE: "–", **{each: _NAMES.get(each, each) for each in ROLES}}
        ui.radio(options, value=role or _NONE, on_change=choose).props(
            f'inline dense id="column-{column.index}" aria-label="Role of this column"'
        )


def _legend(name: str, guess: str) -> str:
    mark = f' <span class="guess">guess: {guess}</span>' if guess else ""
    return f"{escape(name)}{mark}"


def _draw_reading(session: StudioSession) -> None:
    """Draw what a reader must be told besides."""
    choice = session.choice

    async def read_with(**values: Any) -> None:
        await session.read_as(replace(session.choice, **values))

    async def set_rate(event: Any) -> None:
        value = event.value
        await read_with(rate=float(value) if value and float(value) > 0.0 else None)

    with ui.element("div").classes("fields"):
        if choice.time is None:
            rate = ui.number("Samples per second", value=choice.rate, on_change=set_rate)
            rate.props('id="rate" debounce="600" outlined').classes("field")
        else:
            units = ui.select(
                {each: each or "as the file says" for each in _UNITS},
                value=choice.time_unit,
                label="Unit of the time stamps",
                on_change=lambda event: read_with(time_unit=event.value),
            )
            units.props('id="time-unit" outlined').classes("field")
        _draw_table(session)
        ui.checkbox(
            "Repair: leave out a few bad rows, and make uneven time even",
            value=choice.repair,
            on_change=lambda event: read_with(repair=event.value),
        ).props('id="repair"')
        ui.checkbox(
            "Bring to one raster: signals that were stamped apart",
            value=choice.resample,
            on_change=lambda event: read_with(resample=event.value),
        ).props('id="resample"')


def _draw_table(session: StudioSession) -> None:
    async def choose(event: Any) -> None:
        number = int(event.value) if event.value else None
        if number != session.choice.table:
            await session.choose_file(session.file, number)

    made = ui.number("Number of the table", value=session.choice.table, on_change=choose)
    made.props('id="table" debounce="600" min="1" step="1" outlined').classes("field")
