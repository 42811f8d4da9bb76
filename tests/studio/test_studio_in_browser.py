"""The whole job in a real browser: by mouse, by keyboard alone, on a desktop and on a phone."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from studio_browser import CHROMIUM, Studio, chromium, running, write_loop

import hyst
from hyst.cli import main

pytest.importorskip("nicegui", reason="the studio needs NiceGUI")
pytest.importorskip("playwright", reason="tests in a browser need Playwright")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium on this machine"),
]

PATIENCE = 60_000  # ms: other tests may run beside this one
CONTRAST = (Path(__file__).parent / "contrast.js").read_text()


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    folder = tmp_path_factory.mktemp("work")
    write_loop(folder / "loop.csv")
    (folder / "words.csv").write_text("no,numbers\nat,all\n")
    with running(folder) as made:
        yield made


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with chromium() as made:
        yield made


@pytest.fixture
def page(studio: Studio, browser: Any) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    made = context.new_page()
    made.set_default_timeout(PATIENCE)
    made.troubles = []
    made.elsewhere = []
    made.on("pageerror", lambda error: made.troubles.append(str(error)))
    made.on("request", lambda request: _note_elsewhere(made, studio, request.url))
    made.goto(studio.address)
    made.wait_for_selector("#file-title")
    yield made
    context.close()


def _note_elsewhere(page: Any, studio: Studio, url: str) -> None:
    if not url.startswith((studio.host, studio.host.replace("http", "ws"), "data:", "blob:")):
        page.elsewhere.append(url)


def wait(page: Any, selector: str) -> Any:
    page.wait_for_selector(selector)
    return page.locator(selector)


def tab_to(page: Any, selector: str, most: int = 150) -> None:
    """Go on with the tabulator until something has the focus."""
    for _ in range(most):
        if page.evaluate("s => document.activeElement?.closest(s) !== null", selector):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"the tabulator does not come to {selector}")


def open_file(page: Any, name: str, shown: str) -> Any:
    """Choose a file of the folder, and wait for what is shown of it now."""
    page.evaluate("document.querySelectorAll('section').forEach(e => { e.dataset.old = '1'; })")
    page.get_by_role("button", name=name, exact=True).click()
    page.wait_for_selector("#columns:not([data-old])")
    return wait(page, shown)


def open_loop(page: Any) -> None:
    open_file(page, "loop.csv", "#record:not([data-old]) .plots svg")


def folders(studio: Studio) -> set[str]:
    return {each.parent.name for each in studio.folder.glob("*/commands.sh")}


def test_by_mouse_from_a_dropped_file_to_c(studio: Studio, page: Any, tmp_path: Path) -> None:
    write_loop(tmp_path / "dropped.csv", 2500)
    page.set_input_files("#dropped", str(tmp_path / "dropped.csv"))
    wait(page, "#record .plots svg")
    assert (studio.folder / "dropped.csv").read_bytes() == (tmp_path / "dropped.csv").read_bytes()
    page.click("#identify-button")
    wait(page, "#identify [role=progressbar]")
    wait(page, "#reference .plots svg")
    assert "good" in page.inner_text("#models h3")
    before = page.inner_text("#reference")
    wait(page, "#point-3").scroll_into_view_if_needed()
    box = page.locator("#point-3").bounding_box()
    page.mouse.move(box["x"] + 5, box["y"] + 5)
    page.mouse.down()
    page.mouse.move(box["x"] + 5, box["y"] + 60, steps=4)
    page.mouse.up()
    page.wait_for_function("t => document.querySelector('#reference').innerText !== t", arg=before)
    assert page.locator("#point-3").bounding_box()["y"] > box["y"] + 30
    page.click("#export-c")
    wait(page, "#export-c[aria-checked=true]")
    page.click("#save-button")
    assert "Wrote" in wait(page, "#save .done").inner_text()
    (name,) = folders(studio)
    written = studio.folder / name
    assert (written / "c" / "stage.h").is_file()
    assert hyst.load(written / "models" / "auto" / "model.json").description.verdict is not None
    assert page.troubles == []
    assert page.elsewhere == []
    _repeats(written)


def _repeats(session: Path) -> None:
    """Run the commands of a session, and find the session's numbers again."""
    lines = (session / "commands.sh").read_text().splitlines()
    commands = [each for each in lines if each.startswith(("hyst identify", "hyst compensate"))]
    assert len(commands) == 2
    with contextlib.chdir(session):
        quickly = [commands[0] + " --no-figures", commands[1]]
        assert [main(each.split()[1:]) for each in quickly] == [0, 0]
    first, again = (
        json.loads((session / folder / "auto" / "metrics.json").read_text())
        for folder in ("models", "again")
    )
    assert again["parameters"] == first["parameters"]
    command, repeated = (
        (session / folder / "command.csv").read_text().splitlines()[1000].split(",")[-2:]
        for folder in (".", "again")
    )
    numbers = [float(each) for each in command]
    assert [float(each) for each in repeated] == pytest.approx(numbers, abs=1e-9)


def test_by_keyboard_alone_on_a_phone(studio: Studio, page: Any) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.focus("body")
    tab_to(page, "#file-1")
    page.keyboard.press("Enter")
    wait(page, "#record .plots svg")
    assert page.evaluate("document.activeElement.id") == "file-1"  # drawn again, and kept
    tab_to(page, "#identify-button")
    page.keyboard.press("Enter")
    wait(page, "#reference .point")
    tab_to(page, "#point-2")
    before = float(page.get_attribute("#point-2", "aria-valuenow"))
    page.keyboard.press("ArrowDown")
    page.wait_for_function(
        "b => Number(document.querySelector('#point-2').getAttribute('aria-valuenow')) < b",
        arg=before,
    )
    assert page.evaluate("document.activeElement.id") == "point-2"
    tab_to(page, "#export-c")
    page.keyboard.press("Space")
    wait(page, "#export-c[aria-checked=true]")
    known = folders(studio)
    tab_to(page, "#save-button")
    page.keyboard.press("Enter")
    wait(page, "#save .done")
    (name,) = folders(studio) - known
    assert (studio.folder / name / "c" / "stage.h").is_file()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.troubles == []


def test_what_has_the_focus_is_seen_and_all_that_can_be_used_has_a_name(page: Any) -> None:
    open_loop(page)
    page.keyboard.press("Tab")
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    unnamed = page.evaluate(
        "[...document.querySelectorAll('button, input, [role=slider], [role=radio], svg.plot')]"
        ".filter(e => e.offsetParent !== null || e.matches('svg'))"
        ".filter(e => !(e.ariaLabel || e.innerText || e.labels?.length || e.closest('label') ||"
        " e.closest('[aria-label]')))"
        ".map(e => e.outerHTML.slice(0, 200))"
    )
    assert outline == "solid"
    assert unnamed == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_words_stand_out_from_their_ground(page: Any, scheme: str) -> None:
    page.emulate_media(color_scheme=scheme)
    open_loop(page)
    assert page.evaluate(CONTRAST) == []  # all at 4.5 or more


def test_what_cannot_be_read_ends_in_a_sentence(page: Any) -> None:
    said = open_file(page, "words.csv", "section:not([data-old]) .said").inner_text()
    assert "Traceback" not in said
    assert len(said.split()) > 4
    open_loop(page)


def test_a_file_of_two_gigabytes_is_refused_before_it_is_read(page: Any, tmp_path: Path) -> None:
    with (tmp_path / "huge.csv").open("wb") as file:
        file.truncate(2_000_000_000)  # sparse: it takes no room
    page.set_input_files("#dropped", str(tmp_path / "huge.csv"))
    page.wait_for_function("document.querySelector('#file .said')?.innerText.includes('2.00 GB')")
    assert "--in-file yes" in page.inner_text("#file .said")


def test_a_cancelled_identification_leaves_the_page_as_it_was(page: Any) -> None:
    open_loop(page)
    page.click("#identify-button")
    wait(page, "#identify [role=progressbar]")
    page.click("#identify-button:has-text('Cancel')")
    assert "cancelled" in wait(page, "#identify .said").inner_text()
    assert page.locator("#models article").count() == 0
    wait(page, "#identify-button:has-text('Identify')")


def test_two_tabs_show_the_same(studio: Studio, page: Any) -> None:
    other = page.context.new_page()
    other.goto(studio.address)
    wait(other, "#file-title")
    open_loop(page)
    wait(other, "#record .plots svg")
    signals = "[...document.querySelectorAll('#record .plots svg')].map(e => e.outerHTML)"
    assert other.evaluate(signals) == page.evaluate(signals)
    other.close()
    open_file(page, "words.csv", "section:not([data-old]) .said")


def test_without_the_token_nothing_opens(studio: Studio, browser: Any) -> None:
    context = browser.new_context()
    page = context.new_page()
    assert page.goto(studio.host).status == 403
    assert "does not open the studio" in page.inner_text("h1")
    given = {"data": "1", "headers": {"x-file-name": "a.csv"}}
    answer = context.request.put(f"{studio.host}/upload", **given)
    assert answer.status == 403
    assert not (studio.folder / "a.csv").exists()
    context.close()


def test_a_server_that_is_stopped_is_told_on_the_page(studio: Studio, page: Any) -> None:
    studio.stop()  # the last test of this file
    page.wait_for_selector("#lost:not([hidden])")
    assert "run hyst studio there" in page.inner_text("#lost")
