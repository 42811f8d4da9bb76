"""A page of HTML that needs nothing but itself: no network, no script, pictures inside.

Everything that comes from a file of the user is escaped where it enters the page.
"""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence

from hyst.operators import Verdict
from hyst.report.table import Table

_STYLE = """
:root { color-scheme: light; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 4rem; max-width: 62rem; color: #1f2937;
  background: #ffffff; font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; }
h1 { font-size: 1.65rem; line-height: 1.25; margin: 0.5rem 0 0.25rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 0.5rem; padding-top: 0.8rem;
  border-top: 1px solid #e5e7eb; }
p, ul { margin: 0.5rem 0; max-width: 46rem; }
.faint { color: #6b7280; font-size: 0.9rem; }
.banner { background: #fef3c7; border-left: 4px solid #d97706; padding: 0.6rem 0.9rem;
  font-weight: 600; }
.verdict { border-left: 6px solid; padding: 0.6rem 0.9rem; max-width: none; }
.verdict p { margin: 0.2rem 0; max-width: none; }
.good { background: #dcfce7; border-color: #16a34a; }
.fair { background: #fef3c7; border-color: #d97706; }
.unfit { background: #fee2e2; border-color: #dc2626; }
figure { margin: 1rem 0; }
figure img { max-width: 100%; height: auto; }
figcaption { color: #4b5563; font-size: 0.9rem; max-width: 46rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.92rem;
  margin: 0.6rem 0; }
caption { text-align: left; color: #4b5563; font-size: 0.9rem; padding-bottom: 0.3rem; }
th, td { text-align: right; padding: 0.22rem 0.9rem 0.22rem 0; white-space: nowrap;
  border-bottom: 1px solid #f0f1f3; }
th { color: #4b5563; font-weight: 600; border-bottom: 1px solid #9ca3af; }
th:first-child, td:first-child { text-align: left; }
tr.marked td { background: #ffedd5; font-weight: 600; }
pre, code { font: 0.88rem/1.5 ui-monospace, "Cascadia Mono", Menlo, Consolas, monospace; }
pre { background: #f3f4f6; padding: 0.7rem 0.9rem; overflow-x: auto; border-radius: 4px; }
.equation { font: italic 1.08rem/1.8 Georgia, "Times New Roman", serif;
  margin: 0.6rem 0 0.6rem 1.2rem; }
"""


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

    def heading(self, text: str) -> None:
        """Begin a section."""
        self._parts.append(f"<h2>{html.escape(text)}</h2>")

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
        head = "".join(f"<th>{html.escape(each)}</th>" for each in table.header)
        rows = []
        for index, row in enumerate(table.rows):
            cells = "".join(f"<td>{html.escape(each)}</td>" for each in row)
            rows.append(
                f'<tr class="marked">{cells}</tr>' if index == table.marked else f"<tr>{cells}</tr>"
            )
        self._parts.append(
            f'<div class="wide"><table><caption>{html.escape(table.title)}</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
        )

    def picture(self, png: bytes, caption: str) -> None:
        """Add a picture, the bytes ``png``, inside the page; ``caption`` says what it shows."""
        data = base64.b64encode(png).decode("ascii")
        words = html.escape(caption)
        self._parts.append(
            f'<figure><img alt="{words}" src="data:image/png;base64,{data}">'
            f"<figcaption>{words}</figcaption></figure>"
        )

    def to_html(self) -> str:
        """Give the whole page.

        Returns
        -------
        str
            To be written as UTF-8.
        """
        body = "\n".join(self._parts)
        return (
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{self._title}</title>\n<style>{_STYLE}</style>\n</head>\n"
            f"<body>\n{body}\n</body>\n</html>\n"
        )
