"""Starts the studio on this machine, at an address that nobody can guess."""

from __future__ import annotations

import importlib.util
import os
import secrets
import socket
from collections.abc import Callable
from typing import Any

from hyst.errors import InputError, MissingExtraError
from hyst.studio.work.folder import WorkFolder

HOST = "127.0.0.1"


def serve(
    folder: str | os.PathLike[str], port: int = 0, ready: Callable[[str], None] = print
) -> None:
    """Serve the studio of a folder until it is stopped.

    Parameters
    ----------
    folder
        Beyond which nothing is read and nothing is written.
    port
        To listen on, on 127.0.0.1 only; 0 for any that is free.
    ready
        Told the address, with its token, as soon as it answers.

    Raises
    ------
    InputError
        If there is no such folder, or the port is taken.
    MissingExtraError
        If NiceGUI is not installed.
    """
    require_nicegui()
    root = WorkFolder.at(folder)
    listening = _listening(port)
    with listening:
        at = listening.getsockname()[1]
        token = secrets.token_urlsafe(24)
        app, stop = studio_at(root, token, at)
        try:
            _run(app, listening, lambda: ready(f"http://{HOST}:{at}/?token={token}"))
        finally:
            stop()


def studio_at(root: WorkFolder, token: str, port: int) -> tuple[Any, Callable[[], None]]:
    """Give the program that a server runs, and what ends its processes.

    Parameters
    ----------
    root
        The folder.
    token
        That its address must have.
    port
        On which it will be.
    """
    from hyst.studio.session import StudioSession

    session = StudioSession(root)  # its processes load while the server does
    from fastapi import FastAPI
    from nicegui import ui

    from hyst.studio.page.frame import build_page
    from hyst.studio.page.uploads import add_upload_route
    from hyst.studio.server.gate import Gate

    app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    add_upload_route(app, session)
    ui.run_with(
        app,
        root=lambda: build_page(session),
        title="hyst studio",
        favicon=_ICON,
        language="en-US",
        tailwind=False,
        dark=None,
        show_welcome_message=False,
        reconnect_timeout=10.0,
    )
    app.add_middleware(Gate, token=token, port=port)
    return app, session.stop


def require_nicegui() -> None:
    """Refuse to start without NiceGUI.

    Raises
    ------
    MissingExtraError
        If it is not installed.
    """
    if importlib.util.find_spec("nicegui") is None:
        raise MissingExtraError("the studio needs NiceGUI; pip install 'hyst[studio]'")


_ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><path d="M4 26C14 26 12 6 28 6'
    'C18 6 20 26 4 26" fill="none" stroke="#1f6feb" stroke-width="4"/></svg>'
)


def _listening(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((HOST, port))
    except (OSError, OverflowError) as refusal:
        listening.close()
        raise InputError(
            f"port {port} cannot be had ({refusal}); choose another one, or leave it out"
        ) from None
    return listening


def _run(app: Any, listening: socket.socket, ready: Callable[[], None]) -> None:
    import uvicorn

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets=sockets)
            if self.started:
                ready()

    config = uvicorn.Config(
        app, log_level="error", access_log=False, timeout_graceful_shutdown=1, server_header=False
    )
    Server(config).run(sockets=[listening])
