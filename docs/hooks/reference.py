"""Pages of the reference: every public name, from its docstring.

What is public is what a package offers as ``__all__``; that of ``hyst`` is made from its stub. A
name is described on the page of the package that offers it, those of ``hyst`` itself on the first.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterable
from types import ModuleType

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

import hyst

# The order of the navigation; a package that is not named here fails the check of the site.
PACKAGES = (
    "models",
    "operators",
    "signals",
    "io",
    "diagnosis",
    "identification",
    "compensation",
    "control",
    "online",
    "fleet",
    "export",
    "report",
    "demo",
    "studies",
    "studio",
    "jax",
    "sklearn",
    "torch",
)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages of the reference."""
    for page, text in reference_pages().items():
        files.append(File.generated(config, page, content=text))
    return files


def reference_pages() -> dict[str, str]:
    """Give the text of each page by its address."""
    packages = [importlib.import_module(f"hyst.{name}") for name in PACKAGES]
    pages = {address(each): package_page(each) for each in packages}
    return {"reference/index.md": first_page(packages), **pages}


def address(package: ModuleType) -> str:
    """Give the page of a package."""
    return f"reference/{package.__name__.removeprefix('hyst.')}.md"


def in_order(names: Iterable[str]) -> list[str]:
    """Put classes before functions before constants, each by the alphabet."""
    return sorted(names, key=lambda name: (name.isupper(), not name[0].isupper(), name.lower()))


def package_page(package: ModuleType) -> str:
    """Give the page of one package: its first sentence, then name by name."""
    path = package.__name__
    names = [f"::: {path}.{name}" for name in in_order(package.__all__)]
    return "\n\n".join([f"# {path}", _sentence(package), *names]) + "\n"


def _sentence(package: ModuleType) -> str:
    return (package.__doc__ or "").strip().partition("\n")[0].partition("; see")[0]


def first_page(packages: list[ModuleType]) -> str:
    """Give the page of hyst: what it offers and where that is described, and what is only there."""
    homes = {name: each for each in reversed(packages) for name in each.__all__}
    shown = [name for name in hyst.__all__ if name not in (*PACKAGES, "__version__")]
    own = in_order(name for name in shown if name not in homes)
    borrowed = {each.__name__: [] for each in packages}
    for name in in_order(name for name in shown if name in homes):
        borrowed[homes[name].__name__].append(f"[`{name}`][{homes[name].__name__}.{name}]")
    lists = [_package_list(each, borrowed[each.__name__]) for each in packages]
    return "\n".join(
        [
            "# Reference",
            "",
            "Every public name, from its docstring. The letters are those of",
            "[symbols](../symbols.md). What the command line has, `hyst --help` says.",
            "",
            *lists,
            f"`hyst` itself has {', '.join(f'[`{name}`][hyst.{name}]' for name in own)}.",
            "",
            *(f"::: hyst.{name}\n" for name in own),
        ]
    )


def _package_list(package: ModuleType, links: list[str]) -> str:
    """Give a paragraph on a package: what it is, and what of it ``hyst`` offers itself."""
    path = package.__name__
    said = f"**[{path}]({address(package).removeprefix('reference/')})** {_sentence(package)}"
    return f"{said} As `hyst.NAME` too: {', '.join(links)}.\n" if links else f"{said}\n"
