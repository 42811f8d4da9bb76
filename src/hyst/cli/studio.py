"""hyst studio: the whole job in a browser, on this machine."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

import hyst.studio

Folder = Annotated[
    Path,
    typer.Argument(
        metavar="FOLDER", help="With your records; nothing else is read, nothing else written."
    ),
]
Port = Annotated[
    int, typer.Option(metavar="N", min=0, max=65535, help="To listen on; 0 for any that is free.")
]
NoBrowser = Annotated[
    bool, typer.Option("--no-browser", help="Print the address only; open no browser.")
]


def studio(folder: Folder = Path(), port: Port = 0, no_browser: NoBrowser = False) -> None:
    """Do the whole job in a browser: look, identify, follow a reference, export; no typing."""

    def ready(address: str) -> None:
        print(f"hyst studio: {address}", flush=True)
        print("for this machine only; stop it with Ctrl+C", flush=True)
        if not no_browser:
            webbrowser.open(address)

    hyst.studio.serve(folder, port, ready)
