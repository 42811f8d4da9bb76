"""A page of HTML that needs nothing but itself: no network, no script, pictures inside.

What comes before the first heading is what matters most; then the page lists its headings.

Everything that comes from a file of the user is escaped where it enters the page.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence

from hyst.operators import Verdict
from hyst.report.page_style import STYLE
from hyst.report.table import Table

_LONG = 40
"""Letters from which on the cells of a column are broken into lines."""


class Page:
    """A page built from the top to the bottom.

    Parameters
    ----------
    title
        Of the page.

    Examples
    --------
    >>> page = Page("a < b")
    >>> page.text("x & y")
    >>> "<h1>a &lt; b</h1>" in page.to_html(), "<p>x &amp; y</p>" in page.to_html()
    (True, True)
    """

    def __init__(self, title: str) -> None:
        self._title = html.escape(title)
        self._parts = [f"<h1>{self._title}</h1>"]
        self._headings: dict[str, str] = {}  # by anchor
        self._first_heading = 0
        self._sizes: set[tuple[int, int]] = set()

    def heading(self, text: str) -> None:
        """Begin a section."""
        anchor = re.sub("[^a-z0-9]+", "-", text.lower()).strip("-") or "section"
        if anchor in self._headings:
            anchor = f"{anchor}-{len(self._headings) + 1}"
        if not self._headings:
            self._first_heading = len(self._parts)
        self._headings[anchor] = html.escape(text)
        self._parts.append(f'<h2 id="{anchor}">{html.escape(text)}</h2>')

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self._parts.append(f"<p>{html.escape(text)}</p>")

    def faint(self, text: str) -> None:
        """Add a paragraph in small grey type."""
        self._parts.append(f'<p class="faint">{html.escape(text)}</p>')

    def banner(self, text: str) -> None:
        """Add a line nobody overlooks."""
        self._parts.append(f'<p class="banner">{html.escape(text)}</p>')

    def verdict(self, verdict: Verdict) -> None:
        """Add a box that says how far something can be trusted, in words and colour."""
        first, *others = (html.escape(each) for each in verdict.sentences)
        more = "".join(f"<p>{each}</p>" for each in others)
        self._parts.append(
            f'<div class="verdict {verdict.level}"><p><strong>Verdict: {verdict.level}</strong> - '
            f"{first}</p>{more}</div>"
        )

    def items(self, texts: Sequence[str]) -> None:
        """Add a list; nothing if there is no item."""
        if texts:
            lines = "".join(f"<li>{html.escape(each)}</li>" for each in texts)
            self._parts.append(f"<ul>{lines}</ul>")

    def equation(self, text: str) -> None:
        """Add a line of mathematics, written in plain characters."""
        self._parts.append(f'<div class="equation">{html.escape(text)}</div>')

    def code(self, text: str) -> None:
        """Add lines to copy."""
        self._parts.append(f"<pre>{html.escape(text)}</pre>")

    def table(self, table: Table) -> None:
        """Add a table."""
        columns = [(each, *(row[k] for row in table.rows)) for k, each in enumerate(table.header)]
        marks = [' class="said"' * any(len(text) > _LONG for text in each) for each in columns]
        head = "".join(
            f'<th scope="col"{mark}>{html.escape(each)}</th>'
            for mark, each in zip(marks, table.header, strict=True)
        )
        rows = []
        for index, row in enumerate(table.rows):
            cells = "".join(
                f"<td{mark}>{html.escape(each)}</td>" for mark, each in zip(marks, row, strict=True)
            )
            rows.append(
                f'<tr class="marked">{cells}</tr>' if index == table.marked else f"<tr>{cells}</tr>"
            )
        self._parts.append(
            f'<div class="wide"><table><caption>{html.escape(table.title)}</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
        )

    def picture(self, png: bytes, caption: str) -> None:
        """Add a picture, the bytes ``png``, inside the page; ``caption`` says what it shows.

        Its panels stand beside each other where there is room, else one under another.
        """
        # Here, for a page without pictures needs nothing that reads them.
        from hyst.report.picture_pieces import pieces_of

        heading, columns, pieces = pieces_of(png)
        shown = [f"<p>{html.escape(heading)}</p>"] if heading else []
        for each in pieces:
            self._sizes.add((0, each.least_width))
            data = base64.b64encode(each.png).decode("ascii")
            shown.append(
                f'<div class="panel{" legend" * each.is_legend}"><img class="w{each.least_width}" '
                f'width="{each.width}" height="{each.height}" '
                f'alt="{html.escape(each.words or caption)}" '
                f'src="data:image/png;base64,{data}"></div>'
            )
        least = max(each.least_width for each in pieces if not each.is_legend)
        self._sizes.add((columns, least))
        self._parts.append(
            f'<figure><div class="panels c{columns}-{least}">{"".join(shown)}</div>'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>"
        )

    def to_html(self) -> str:
        """Give the whole page.

        Returns
        -------
        str
            To be written as UTF-8.
        """
        first = self._first_heading
        body = "\n".join([*self._parts[:first], *self._contents(), *self._parts[first:]])
        style = STYLE + "".join(_size_rule(*each) for each in sorted(self._sizes))
        return (
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{self._title}</title>\n<style>{style}</style>\n</head>\n"
            f"<body>\n{body}\n</body>\n</html>\n"
        )

    def _contents(self) -> list[str]:
        """Give the list of headings, where there are several."""
        if len(self._headings) < 2:
            return []
        lines = "".join(
            f'<li><a href="#{anchor}">{text}</a></li>' for anchor, text in self._headings.items()
        )
        return [f'<nav aria-label="On this page"><ul>{lines}</ul></nav>']


def _size_rule(columns: int, least: int) -> str:
    """Give the rule for pictures, or grids of some columns of them, not to be made narrower."""
    if not columns:
        return f".w{least} {{ min-width: {least}px; }}\n"
    narrowest = f"max(min(100%, {least}px), calc(100% / {columns} - 4px))"
    return (
        f".c{columns}-{least} {{ grid-template-columns: "
        f"repeat(auto-fit, minmax({narrowest}, 1fr)); }}\n"
    )
