"""Take the pictures of docs/studio.md: the studio at work on a simulated stage, in Chromium.

Run as ``python docs/figures/draw_studio.py FOLDER``; needs the extras studio and dev, and Chromium.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "studio"))

from PIL import Image
from studio_browser import chromium, running, write_loop

PARTS = ("columns", "record", "reference")


def take(page: Any, folder: Path) -> None:
    """Do the job and take pictures of its parts."""
    page.set_default_timeout(120_000)
    page.get_by_role("button", name="stage.csv", exact=True).click()
    page.wait_for_selector("#record .plots svg")
    page.click("#identify-button")
    page.wait_for_selector("#reference .plots svg")
    page.focus("#point-4")
    for _ in range(6):
        page.keyboard.press("ArrowDown")
    page.wait_for_timeout(1500)
    for part in PARTS:
        shoot(page, part, folder / f"studio-{part}.png")


def shoot(page: Any, part: str, path: Path) -> None:
    """Take a picture of a part, in few colours, which is a third of the bytes."""
    page.locator(f"#{part}").screenshot(path=path)
    Image.open(path).convert("RGB").quantize(48).save(path, optimize=True)


def main(folder: Path) -> None:
    """Take all pictures."""
    with tempfile.TemporaryDirectory() as work:
        write_loop(Path(work) / "stage.csv", 8000)
        with running(Path(work)) as studio, chromium() as browser:
            page = browser.new_page(viewport={"width": 1000, "height": 800})
            page.goto(studio.address)
            page.wait_for_selector("#file-title")
            take(page, folder)
            page.set_viewport_size({"width": 390, "height": 844})
            page.wait_for_timeout(500)
            shoot(page, "reference", folder / "studio-phone.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent))
