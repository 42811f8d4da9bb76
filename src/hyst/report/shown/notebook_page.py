"""A piece of a notebook's page: no script, no sheet of styles, and colours of the notebook's theme.

Notebooks are light or dark, and take style sheets away from what they do not trust. So text has
the colour around it, lines and backgrounds are half transparent, and each element has its style.
Everything that comes from a file of the user is escaped where it enters.
"""

from __future__ import annotations

import html
from collections.abc import Sequence

from hyst.operators import Verdict
from hyst.report.table import Table

_VERDICTS = {"good": "22, 163, 74", "fair": "217, 119, 6", "unfit": "220, 38, 38"}
_LINE = "1px solid rgba(128, 128, 128, 0.35)"
_CELL = "padding: 0.15em 0.9em 0.15em 0; white-space: nowrap; background: transparent;"
_MOST_ROWS = 40


class NotebookPage:
    """A piece built from the top to the bottom.

    Parameters
    ----------
    title
        What is shown.

    Examples
    --------
    >>> page = NotebookPage("a < b")
    >>> page.text("x & y")
    >>> "<strong>a &lt; b</strong>" in page.to_html(), "x &amp; y</p>" in page.to_html()
    (True, True)
    """

    def __init__(self, title: str) -> None:
        self._parts = [f'<p style="margin: 0.3em 0;"><strong>{html.escape(title)}</strong></p>']

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self._parts.append(f'<p style="margin: 0.3em 0;">{html.escape(text)}</p>')

    def verdict(self, verdict: Verdict) -> None:
        """Add how far something can be trusted, in words and colour."""
        colour = _VERDICTS[verdict.level]
        first, *others = (html.escape(each) for each in verdict.sentences)
        more = "".join(f"<br>{each}" for each in others)
        self._parts.append(
            f'<p style="margin: 0.3em 0; padding: 0.4em 0.7em; border-left: 5px solid '
            f'rgb({colour}); background: rgba({colour}, 0.12);"><strong>Verdict: {verdict.level}'
            f"</strong> - {first}{more}</p>"
        )

    def items(self, texts: Sequence[str]) -> None:
        """Add a list; nothing if there is no item."""
        if texts:
            lines = "".join(f"<li>{html.escape(each)}</li>" for each in texts)
            self._parts.append(f'<ul style="margin: 0.3em 0;">{lines}</ul>')

    def table(self, table: Table, most: int = _MOST_ROWS) -> None:
        """Add a table, of which ``most`` rows are shown; nothing if it has none."""
        if not table.rows:
            return
        head = "".join(
            f'<th style="{_cell(column)} border-bottom: {_LINE};">{html.escape(each)}</th>'
            for column, each in enumerate(table.header)
        )
        rows = [
            "<tr{}>{}</tr>".format(
                ' style="background: rgba(217, 119, 6, 0.18);"' * (number == table.marked),
                "".join(
                    f'<td style="{_cell(column)}">{html.escape(each)}</td>'
                    for column, each in enumerate(row)
                ),
            )
            for number, row in enumerate(table.rows[:most])
        ]
        self._parts.append(
            f'<div style="overflow-x: auto;"><table style="border-collapse: collapse; margin: '
            f'0.4em 0; font-variant-numeric: tabular-nums;"><caption style="text-align: left; '
            f'opacity: 0.75; caption-side: top;">{html.escape(table.title)}</caption><thead><tr>'
            f"{head}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
        )
        more = len(table.rows) - most
        if more > 0:
            self.text(f"... and {more} more.")

    def to_html(self) -> str:
        """Give the piece.

        Returns
        -------
        str
            One element.
        """
        return f"<div>{''.join(self._parts)}</div>"


def _cell(column: int) -> str:
    return f"{_CELL} text-align: {'right' if column else 'left'};"
