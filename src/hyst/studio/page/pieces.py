"""Small pieces that all parts of the page are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from typing import Any

from nicegui import ui

from hyst.report.table import Table
from hyst.studio.session import StudioSession


@contextmanager
def section(name: str, title: str) -> Iterator[None]:
    """Make a part of the page with its heading.

    Parameters
    ----------
    name, title
        Of the part.
    """
    with ui.element("section").props(f'id="{name}" aria-labelledby="{name}-title"'):
        ui.html(escape(title), tag="h2", sanitize=False).props(f'id="{name}-title"')
        yield


def text(words: str, kind: str = "", tag: str = "p", role: str = "") -> None:
    """Write a sentence.

    Parameters
    ----------
    words, kind, tag, role
        What, its class in the style sheet, its element, and its role for screen readers.
    """
    made = ui.html(escape(words), tag=tag, sanitize=False)
    if kind:
        made.classes(kind)
    if role:
        made.props(f'role="{role}"')


def picture(svg: str, caption: str = "") -> None:
    """Show a plot.

    Parameters
    ----------
    svg, caption
        The plot and what stands below it.
    """
    below = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
    ui.html(svg + below, tag="figure", sanitize=False)


def say(session: StudioSession, part: str, busy: str = "") -> None:
    """Say what was refused in a part, or that it is at work.

    Parameters
    ----------
    session, part
        Of which.
    busy
        What it is doing then.
    """
    if part in session.said:
        text(session.said[part], "said", role="alert")
    elif part in session.busy and busy:
        text(busy, "busy", role="status")


def button(label: str, act: Callable[..., Any], name: str, kind: str = "plain") -> ui.button:
    """Make a button.

    Parameters
    ----------
    label, act
        Its words and what it does.
    name
        By which the page finds it again to give it the focus back.
    kind
        ``main`` or ``plain``.
    """
    made = (
        ui.button(label, on_click=act, color=None)
        .props(f'no-caps id="{name}"')
        .classes(f"button {kind}")
    )
    return made.props("unelevated" if kind == "main" else "outline")


def show(table: Table) -> None:
    """Show a table.

    Parameters
    ----------
    table
        Of text.
    """
    head = "".join(f'<th scope="col">{escape(each)}</th>' for each in table.header)
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in table.rows
    )
    title = f"<caption>{escape(table.title)}</caption>"
    label = escape(table.title, quote=True)
    ui.html(
        f'<div class="wide" tabindex="0" role="region" aria-label="{label}">'
        f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>",
        sanitize=False,
    )
