"""Identify, with progress and a way to end it."""

from __future__ import annotations

from html import escape
from typing import Any

from nicegui import ui

from hyst.identification.families.registry import families
from hyst.studio.page.pieces import button, say, section, text
from hyst.studio.session import StudioSession
from hyst.studio.work.identifying import AUTO


def draw_identify(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        What was chosen here, to be kept when it is drawn again.
    """
    with section("identify", "4. A model"):
        if session.measured is None:
            text("Read a record first.", "small")
            return
        options = {AUTO: "auto: compare those that suit most actuators"}
        options |= {name: f"{name}: {each.words.full_name}" for name, each in families.items()}
        with ui.element("div").classes("fields"):
            chosen = ui.select(
                options,
                value=remembered.get("family", AUTO),
                label="Family of models",
                on_change=lambda event: remembered.update(family=event.value),
            )
            chosen.props('id="family" outlined').classes("field wide-field")
            if session.progress is None:

                async def identify() -> None:
                    await session.identify(remembered.get("family", AUTO))

                button("Identify", identify, "identify-button", "main")
            else:
                button("Cancel", session.cancel, "identify-button", "main")
        if session.progress is not None:
            _draw_progress(session)
        say(session, "identify")


def _draw_progress(session: StudioSession) -> None:
    progress = session.progress
    if progress is None:
        return
    bar = ui.html("", sanitize=False).props('id="progress"')

    def update() -> None:
        now = session.progress
        if now is not None:
            bar.set_content(_bar(now.step, now.share))

    update()
    ui.timer(0.1, update)


def _bar(step: str, share: float) -> str:
    percent = round(100.0 * share)
    return (
        f'<div class="bar" role="progressbar" aria-label="Identification" aria-valuemin="0" '
        f'aria-valuemax="100" aria-valuenow="{percent}" '
        f'aria-valuetext="{escape(step, quote=True)}">'
        f'<div style="width:{percent}%"></div></div><p class="small" role="status">'
        f"{percent} % of the stages: {escape(step)}</p>"
    )
