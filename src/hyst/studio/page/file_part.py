"""Choose a file: drop it, or pick it from the folder."""

from __future__ import annotations

from functools import partial
from typing import Any

from nicegui import ui

from hyst.studio.page.pieces import button, say, section, text
from hyst.studio.session import StudioSession
from hyst.studio.work.folder import MOST_BYTES


def draw_file(session: StudioSession, remembered: dict[str, Any]) -> None:
    """Draw the part.

    Parameters
    ----------
    session
        Of the page.
    remembered
        Not used here.
    """
    with section("file", "1. A file"):
        ui.html(
            f'<label class="drop" for="dropped" data-most="{MOST_BYTES}">'
            "<span>Drop a file of measured signals here, or choose one of this machine</span>"
            '<input type="file" id="dropped"></label>',
            sanitize=False,
        )
        text(f"It is copied into {session.folder.root}, where the studio was started.", "small")
        files = session.folder.files()
        if files:
            text("Or take one that lies there:", "small")
            with ui.element("div").classes("files").props('role="group" aria-label="Files"'):
                for k, name in enumerate(files):
                    made = button(name, partial(session.choose_file, name), f"file-{k}")
                    if name == session.file:
                        made.classes("chosen").props('aria-pressed="true"')
        else:
            text("No data file lies there yet.", "small")
        say(session, "file", f"Reading {session.file} ...")
        if session.look is not None and "file" not in session.busy:
            text(f"Open: {session.file}", "small", role="status")
