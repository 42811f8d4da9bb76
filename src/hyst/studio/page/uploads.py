"""Takes a file that was dropped on the page, piece by piece, into the folder."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Any
from urllib.parse import unquote

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse

from hyst.errors import HystError
from hyst.studio.session import StudioSession
from hyst.studio.work.sentences import sentence_of


def add_upload_route(app: FastAPI, session: StudioSession) -> None:
    """Let the page put a file into the folder.

    Parameters
    ----------
    app
        The program.
    session
        Whose folder takes it.
    """

    async def take(request: Request) -> Any:
        name = unquote(request.headers.get("x-file-name", ""))
        try:
            kept = await session.folder.keep(name, _pieces(request))
        except (HystError, OSError) as refusal:
            return JSONResponse({"refused": sentence_of(refusal)}, status_code=400)
        return JSONResponse({"kept": kept})

    app.add_api_route("/upload", take, methods=["PUT"])


async def _pieces(request: Request) -> AsyncIterator[bytes]:
    async for piece in request.stream():
        yield piece
