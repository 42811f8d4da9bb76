"""Save the session, export code, and see the commands that would repeat it."""

from __future__ import annotations

from html import escape
from typing import Any

from nicegui import ui

from hyst.studio.page.pieces import button, say, section, text
from hyst.studio.session import StudioSession
from hyst.studio.work.commands import TARGETS


def draw_save(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        What was chosen here, to be kept when it is drawn again.
    """
    with section("save", "7. Save and export"):
        if session.measured is None:
            text("Read a record first.", "small")
            return
        _draw_form(session, remembered)
        say(session, "save", "Writing ...")
        if session.saved:
            text(f"Wrote {len(session.saved)} files in {session.saved_in}.", "done", role="status")
            with ui.element("details"):
                ui.html("Which ones", tag="summary", sanitize=False)
                ui.html(escape("\n".join(session.saved)), tag="pre", sanitize=False)
        text("The same on the command line, in the session's folder:", "small")
        lines = "\n".join(session.session(_targets(session, remembered)).commands())
        ui.html(escape(lines), tag="pre", sanitize=False).props(
            'id="commands" tabindex="0" role="region" aria-label="Commands"'
        )


def _targets(session: StudioSession, remembered: dict[str, Any]) -> tuple[str, ...]:
    return tuple(each for each in TARGETS if remembered.get(each)) if session.chosen else ()


def _draw_form(session: StudioSession, remembered: dict[str, Any]) -> None:
    with ui.element("div").classes("fields"):
        name = ui.input(
            "Name of the folder",
            value=remembered.get("name") or session.free_folder(),
            on_change=lambda event: remembered.update(name=event.value),
        )
        name.props('id="session-name" outlined').classes("field")
        if session.chosen:
            for target, label in TARGETS.items():
                ui.checkbox(
                    f"{label} of the inverse of {session.chosen}",
                    value=bool(remembered.get(target)),
                    on_change=lambda event, target=target: _remember(
                        session, remembered, target, event.value
                    ),
                ).props(f'id="export-{target}"')
        else:
            text("Code can be exported of a model that is not unfit.", "small")

        async def save() -> None:
            await session.save(str(name.value), _targets(session, remembered))
            remembered.pop("name", None)

        button("Save the session", save, "save-button", "main")


def _remember(session: StudioSession, remembered: dict[str, Any], target: str, on: bool) -> None:
    remembered[target] = target if on else ""
    session.changed("save")
