"""A report on a phone, in a real browser: nothing beside the page, no letter too small to read."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

import hyst
from hyst.report.canvas import blank, drawn
from hyst.report.page import Page
from studio import studio_browser

pytest.importorskip("playwright", reason="tests in a browser need Playwright")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        studio_browser.CHROMIUM is None, reason="there is no Chromium on this machine"
    ),
]

CONTRAST = (Path(studio_browser.__file__).parent / "contrast.js").read_text()
LONG = "a_name_of_a_column_that_is_longer_than_the_screen_of_a_phone_is_wide_and_has_no_spaces"


@drawn
def draw(columns: int, rows: int, width: float) -> Any:
    figure, axes = blank(columns, rows, width, 3.0 * rows)
    for each in axes:
        each.plot([0.0, 1.0], [0.0, 2.0], label="record")
        each.set(title="Loop", xlabel="drive [V]", ylabel="position [um]")
    figure.legend(["record"], loc="outside lower center")
    figure.suptitle("SIMULATED")
    return figure


def letters(png: bytes) -> float:
    with Image.open(io.BytesIO(png)) as picture:
        return float(json.loads(picture.info["hyst panels"])["letters"])


@pytest.fixture(scope="module")
def figures() -> list[bytes]:
    return [draw(2, 2, 10.0), draw(3, 1, 13.0), draw(1, 1, 10.0)]


@pytest.fixture(scope="module")
def file(figures: list[bytes], tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = Page(f"Hysteresis of {LONG}")
    page.banner("SIMULATED")
    page.verdict(hyst.operators.Verdict("good", (f"{LONG} is good.",)))
    for number, png in enumerate(figures):
        page.heading(f"Figure {number}")
        page.picture(png, "Seen here.")
        page.faint("Said in small letters.")
    page.table(hyst.report.Table("Wide", (LONG, LONG), (("1", "2 " * 60),), 0))
    page.equation("y = " + "x + " * 60)
    page.code("hyst " + "word " * 60)
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page.to_html(), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with studio_browser.chromium() as made:
        yield made


@pytest.mark.parametrize("look", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1280])
def test_a_page_is_legible(
    browser: Any, file: Path, figures: list[bytes], width: int, look: str
) -> None:
    page = browser.new_page(viewport={"width": width, "height": 800}, color_scheme=look)
    page.goto(file.as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") == width
    shown = page.evaluate(
        "[...document.querySelectorAll('figure')].map(figure => "
        "[...figure.querySelectorAll('img')].map(image => [image.clientWidth / image.naturalWidth,"
        " image.getBoundingClientRect().left]))"
    )
    # A figure with a legend is one picture more.
    assert [len(each) for each in shown] == [5, 4, 2]
    for panels, png in zip(shown, figures, strict=True):
        assert min(scale for scale, _ in panels) * letters(png) >= 9.0
        assert max(scale for scale, _ in panels) <= 1.0
    # One panel under another on a phone; on a desk as many beside each other as were drawn.
    columns = [len({round(left) for _, left in panels[:-1]}) for panels in shown]
    assert columns == ([1, 1, 1] if width == 390 else [2, 3, 1])
    assert page.evaluate(CONTRAST) == []
    page.close()


def test_a_page_on_paper_hides_nothing(browser: Any, file: Path) -> None:
    page = browser.new_page(viewport={"width": 680, "height": 900}, color_scheme="dark")
    page.emulate_media(media="print")
    page.goto(file.as_uri())
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert page.evaluate("getComputedStyle(document.querySelector('nav')).display") == "none"
    assert page.evaluate("document.documentElement.scrollWidth") == 680
    page.close()
