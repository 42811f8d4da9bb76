"""The gate lets in who has the token, from this machine, and nobody else."""

import asyncio
from typing import Any

import pytest

from hyst.studio.server.gate import Gate
from hyst.studio.work.folder import MOST_BYTES

TOKEN, HOST = "right-token", b"127.0.0.1:8000"


async def program(scope: Any, receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"data"})


def answer(
    path: str = "/",
    query: str = f"token={TOKEN}",
    headers: tuple[tuple[bytes, bytes], ...] = (),
    kind: str = "http",
    host: bytes = HOST,
) -> list[dict[str, Any]]:
    sent: list[dict[str, Any]] = []

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    scope = {
        "type": kind,
        "path": path,
        "query_string": query.encode(),
        "headers": [(b"host", host), *headers],
    }
    asyncio.run(Gate(program, TOKEN, 8000)(scope, None, send))
    return sent


def test_the_token_opens_and_is_kept_in_a_cookie_no_script_reads() -> None:
    start, body = answer()
    assert start["status"] == 200
    cookie = dict(start["headers"])[b"set-cookie"].decode()
    assert cookie == f"hyst-studio-8000={TOKEN}; Path=/; HttpOnly; SameSite=Strict"
    assert body["body"] == b"data"


def test_the_cookie_alone_opens_too() -> None:
    start, _ = answer(query="", headers=((b"cookie", f"a=b; hyst-studio-8000={TOKEN}".encode()),))
    assert start["status"] == 200


@pytest.mark.parametrize("path", ["/", "/upload", "/_nicegui/3/static/nicegui.css"])
@pytest.mark.parametrize(
    "query", ["", "token=", "token=wrong", "token=right-toke", "Token=right-token"]
)
def test_without_the_token_every_route_is_forbidden(path: str, query: str) -> None:
    start, body = answer(path, query)
    assert start["status"] == 403
    assert b"hyst studio" in body["body"]
    assert TOKEN.encode() not in body["body"]


def test_without_the_token_a_websocket_is_closed_before_it_is_accepted() -> None:
    assert answer("/_nicegui_ws/socket.io", "", kind="websocket") == [
        {"type": "websocket.close", "code": 1008}
    ]


@pytest.mark.parametrize("host", [b"evil.example", b"127.0.0.1:9000", b"127.0.0.1", b""])
def test_a_name_of_another_machine_is_refused_even_with_the_token(host: bytes) -> None:
    start, _ = answer(host=host)
    assert start["status"] == 403


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_another_page_is_refused_even_with_the_token(kind: str) -> None:
    sent = answer(headers=((b"origin", b"http://evil.example"),), kind=kind)
    assert sent[0].get("status") == 403 or sent[0]["type"] == "websocket.close"


def test_what_is_too_large_is_refused_before_it_is_read() -> None:
    start, body = answer("/upload", headers=((b"content-length", str(MOST_BYTES + 1).encode()),))
    assert start["status"] == 403
    assert b"larger than the studio takes" in body["body"]


def test_pages_may_load_nothing_from_elsewhere() -> None:
    start, _ = answer()
    policy = dict(start["headers"])[b"content-security-policy"].decode()
    assert "default-src 'self'" in policy
    assert "http" not in policy
