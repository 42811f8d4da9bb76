"""The page: its parts in their order, each drawn again when what it shows has changed."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

from nicegui import ui

from hyst.studio.page.columns_part import draw_columns
from hyst.studio.page.file_part import draw_file
from hyst.studio.page.identify_part import draw_identify
from hyst.studio.page.models_part import draw_models
from hyst.studio.page.record_part import draw_record
from hyst.studio.page.reference_part import draw_reference
from hyst.studio.page.save_part import draw_save
from hyst.studio.session import StudioSession

_HERE = Path(__file__).parent
STYLE = (_HERE / "studio.css").read_text(encoding="utf-8")
SCRIPT = (_HERE / "studio.js").read_text(encoding="utf-8")
_PARTS: dict[str, Callable[[StudioSession, dict[str, Any]], None]] = {
    "file": draw_file,
    "columns": draw_columns,
    "record": draw_record,
    "identify": draw_identify,
    "models": draw_models,
    "reference": draw_reference,
    "save": draw_save,
}


def build_page(session: StudioSession) -> None:
    """Build the page for one tab.

    Parameters
    ----------
    session
        Which all tabs share.
    """
    ui.colors(primary="#0a58ca")
    ui.add_css(STYLE)
    ui.add_body_html(f"<script>{SCRIPT}</script>")
    _draw_head(session)
    remembered: dict[str, Any] = {}
    with ui.element("main").props('id="main"'):
        places = {name: ui.element("div") for name in _PARTS}

    def draw(part: str) -> None:
        place = places.get(part)
        if place is not None and not place.is_deleted:
            place.clear()
            with place:
                _PARTS[part](session, remembered)

    for name in _PARTS:
        draw(name)
    _listen(session, draw)


def _draw_head(session: StudioSession) -> None:
    folder = escape(str(session.folder.root))
    ui.html(
        '<a class="skip" href="#main">To the work</a><header><h1>hyst studio</h1>'
        f'<p class="small">From a measured loop to a command. Works in <code>{folder}</code>; '
        "nothing leaves this machine.</p></header>"
        '<div id="lost" class="said" role="alert" hidden></div>',
        sanitize=False,
    ).props(f'id="head" data-folder="{escape(folder, quote=True)}"')


def _listen(session: StudioSession, draw: Callable[[str], None]) -> None:
    async def dropped(event: Any) -> None:
        if "kept" in event.args:
            await session.choose_file(str(event.args["kept"]))
        else:
            session.said["file"] = str(event.args.get("refused", "The file was not taken."))
            session.changed("file")

    ui.on("dropped", dropped)
    session.listeners.append(draw)
    ui.context.client.on_delete(lambda: _forget(session, draw))


def _forget(session: StudioSession, update: Any) -> None:
    if update in session.listeners:
        session.listeners.remove(update)
