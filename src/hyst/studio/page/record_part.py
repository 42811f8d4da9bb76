"""What the record shows before any model."""

from __future__ import annotations

from html import escape
from typing import Any

from nicegui import ui

from hyst.studio.page.pieces import picture, say, section, text
from hyst.studio.session import StudioSession


def draw_record(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        Not used here.
    """
    with section("record", "3. What the record shows"):
        say(session, "record", "Reading the record ...")
        measured = session.measured
        if measured is None:
            if session.look is None:
                text("Open a file first.", "small")
            return
        text(
            f"{measured.samples} samples at {1.0 / measured.dt:.6g} per second, "
            f"{measured.samples * measured.dt:.4g} s: {measured.input_label} and "
            f"{measured.output_label}.",
            role="status",
        )
        for each in measured.notes:
            text(f"Reading: {each}.", "small")
        with ui.element("div").classes("plots"):
            picture(measured.loop, "The loop")
            picture(measured.signals, "Input (above) and output (below)")
            picture(measured.spectrum, "Spectrum")
        with ui.element("ul").classes("findings"):
            for severity, name, sentence, advice in measured.findings:
                kind = severity.replace(" ", "-")
                more = f'<span class="advice">{escape(advice)}</span>' if advice else ""
                ui.html(
                    f'<span class="badge {kind}">{escape(severity)}</span> '
                    f"<strong>{escape(name)}</strong>: {escape(sentence)} {more}",
                    tag="li",
                    sanitize=False,
                )
