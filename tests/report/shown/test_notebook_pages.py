"""What a notebook shows beside pictures: no script, no ground of its own, all of it escaped."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest

import hyst
from hyst.operators import Verdict

EVIL = "<script>alert(1)</script>&\"'"
K = np.arange(1200.0)
U = 3.0 * np.sin(2.0 * np.pi * K / 200.0) * np.exp(-K / 2000.0)
STAGE = hyst.PrandtlIshlinskii([0.5, 0.3], [0.4, 1.1], p0=1.0)
RECORD = hyst.Record(
    U, STAGE(U) + np.random.default_rng(3).normal(0.0, 0.01, U.size), 1e-3,
    input_name=EVIL, output_name=EVIL, input_unit=EVIL, output_unit=EVIL, notes=(EVIL,),
)  # fmt: skip


class Seen(HTMLParser):
    """Collects elements that are open, styles and text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.open: list[str] = []
        self.attributes: set[str] = set()
        self.styles = ""
        self.text = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes |= {name for name, _ in attrs}
        self.styles += " ".join(value or "" for name, value in attrs if name == "style")
        if tag != "br":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data + " "


@pytest.fixture(scope="module")
def pages() -> dict[str, Any]:
    found = hyst.identify(RECORD, family="pi", plays=2, delay=0)
    comparison = hyst.compare({EVIL: found, "line": hyst.Affine(1.5)}, RECORD)
    return {
        "record": RECORD,
        "model": found.model,
        "bare model": STAGE,
        "found": found,
        "comparison": comparison,
        "diagnosis": hyst.diagnose(RECORD),
    }


@pytest.mark.parametrize(
    "kind", ["record", "model", "bare model", "found", "comparison", "diagnosis"]
)
def test_a_page_is_whole_escaped_and_of_no_theme(kind: str, pages: dict[str, Any]) -> None:
    page = pages[kind]._repr_html_()
    seen = Seen(page)
    assert not seen.open
    assert seen.tags <= {
        "div", "p", "strong", "table", "caption", "thead", "tbody", "tr", "th", "td", "ul", "li",
        "br",
    }  # fmt: skip
    assert seen.attributes <= {"style"}
    if kind not in ("bare model", "diagnosis"):
        assert EVIL in seen.text
    # The colour of text and ground is that of the notebook, light or dark.
    assert not re.search(r"(?<![\w-])color:", seen.styles)
    grounds = re.findall(r"background: ([^;]*);", seen.styles)
    assert all(each.startswith(("rgba(", "transparent")) for each in grounds)


def test_pages_hold_the_numbers(pages: dict[str, Any]) -> None:
    assert "1200 samples, 1.199 s at 1000 Hz" in Seen(RECORD._repr_html_()).text
    found = pages["found"]
    page = Seen(found._repr_html_()).text
    assert f"Verdict: {found.verdict.level}" in page
    assert f"{found.metrics['training'].rms_percent:.3f}" in page
    assert "prandtl_ishlinskii.r[2]" in page
    told = Seen(pages["comparison"]._repr_html_()).text
    assert pages["comparison"].sentences()[0] in told


def test_long_tables_are_cut_and_say_so() -> None:
    many = hyst.PrandtlIshlinskii(np.full(60, 0.1), np.linspace(0.1, 6.0, 60), p0=1.0)
    page = Seen(many._repr_html_()).text
    assert "... and 81 more." in page  # of 60 weights, 60 radii and p0, 40 are shown


@pytest.mark.parametrize("level", ["good", "fair", "unfit"])
def test_a_verdict_is_written_and_coloured(level: Any) -> None:
    about = hyst.ModelDescription(verdict=Verdict(level, ("It is so.", "Do that.")))
    page = Seen(STAGE.with_description(about)._repr_html_())
    assert f"Verdict: {level}  - It is so." in page.text
    assert "border-left: 5px solid" in page.styles
