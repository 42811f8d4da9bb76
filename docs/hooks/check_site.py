"""The site as it was built: links lead somewhere, nothing comes from elsewhere, names are there.

MkDocs checks links in Markdown; this looks at the pages themselves, with what themes and raw HTML
put into them.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError

import hyst

FETCHED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}
NOT_FETCHED = {"canonical", "prev", "next", "alternate"}


class Page(HTMLParser):
    """What a page has: anchors, links, what it fetches, pictures without words."""

    def __init__(self) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.wordless: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag brings."""
        said = {name: value or "" for name, value in attrs}
        self.anchors |= {said[name] for name in ("id", "name") if name in said}
        if tag == "a" and "href" in said:
            self.links.append(said["href"])
        if tag == "img" and not said.get("alt"):
            self.wordless.append(said.get("src", ""))
        if tag in FETCHED and said.get("rel") not in NOT_FETCHED:
            self.fetched.append(said.get(FETCHED[tag], ""))


def on_post_build(config: MkDocsConfig) -> None:
    """Refuse a site with a fault."""
    faults = list(faults_of(Path(config.site_dir)))
    if faults:
        raise PluginError("\n".join(["the site has faults:", *faults]))


def faults_of(site: Path) -> Iterator[str]:
    """Give what is wrong with a site, one sentence each."""
    pages = {file: _read(file) for file in sorted(site.rglob("*.html"))}
    for file, page in pages.items():
        where = file.relative_to(site)
        if where.name == "404.html":  # its links are from the root, wherever that is
            continue
        for address in page.fetched:
            if urlsplit(address).netloc:
                yield f"{where} fetches {address}"
        for source in page.wordless:
            yield f"{where} has a picture without a text for those who do not see it: {source}"
        for link in [*page.links, *page.fetched]:
            if not _leads_somewhere(link, file, pages):
                yield f"{where} has a link that leads nowhere: {link}"
    described = set().union(*(page.anchors for page in pages.values()))
    yield from (f"no page describes {name}" for name in public_names() if name not in described)


def _read(file: Path) -> Page:
    page = Page()
    page.feed(file.read_text(encoding="utf-8"))
    return page


def _leads_somewhere(link: str, file: Path, pages: dict[Path, Page]) -> bool:
    if urlsplit(link).scheme or urlsplit(link).netloc:
        return True
    address, anchor = urldefrag(link)
    target = (file.parent / unquote(address)).resolve() if address else file
    if not target.is_file():
        return False
    return not anchor or target not in pages or unquote(anchor) in pages[target].anchors


def public_names() -> Iterator[str]:
    """Every public name, each by a path under which it is offered."""
    below = [
        importlib.import_module(f"hyst.{each.name}")
        for each in pkgutil.iter_modules(hyst.__path__)
        if each.ispkg
    ]
    packages = {
        each.__name__.removeprefix("hyst."): each for each in below if hasattr(each, "__all__")
    }
    offered: set[str] = set()
    for name, package in packages.items():
        if name != "cli":
            offered |= set(package.__all__)
            yield from (f"hyst.{name}.{each}" for each in package.__all__)
    alone = set(hyst.__all__) - offered - set(packages) - {"__version__"}
    yield from (f"hyst.{each}" for each in sorted(alone))
