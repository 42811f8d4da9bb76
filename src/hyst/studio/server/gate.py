"""Nothing is answered without the token, from another address, or beyond the limit of size."""

from __future__ import annotations

import hmac
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

from hyst.studio.work.folder import MOST_BYTES

_REFUSED = """<!doctype html><html lang="en"><meta charset="utf-8"><title>hyst studio</title>
<body style="font:18px sans-serif;max-width:40em;margin:3em auto;padding:0 1em"><main>
<h1>This address does not open the studio</h1><p>{why}</p><p>Open the whole address that
<code>hyst studio</code> printed when it was started; each start makes a new one.</p></main>"""
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' "
    "'unsafe-inline'; img-src 'self' data:; font-src 'self' data:; connect-src 'self' ws: wss:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)


class Gate:
    """The program behind it is reached with the token only, over http and websockets alike.

    Parameters
    ----------
    app
        What is behind it.
    token
        That the address must have, or the cookie that it is answered with.
    port
        Of the server: another host in a request is that of a page elsewhere.
    """

    def __init__(self, app: Any, token: str, port: int) -> None:
        self._app, self._token, self._port = app, token, port
        self._hosts = {f"{host}:{port}" for host in ("127.0.0.1", "localhost")}
        self._cookie = f"hyst-studio-{port}"

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        why = self._objection(scope)
        if why:
            await _refuse(scope, send, why)
        else:
            await self._app(scope, receive, self._keeping_token(scope, send))

    def _objection(self, scope: Any) -> str:
        headers = {name: value.decode("latin-1") for name, value in scope["headers"]}
        if headers.get(b"host", "") not in self._hosts:
            return "The studio answers on this machine only."
        origin = headers.get(b"origin")
        if origin is not None and origin.partition("://")[2] not in self._hosts:
            return "The studio answers no other page."
        if not self._is_known(scope, headers.get(b"cookie", "")):
            return "The token of the address is wrong or missing."
        length = headers.get(b"content-length", "0")
        if not length.isdecimal() or int(length) > MOST_BYTES:
            return "What was sent is larger than the studio takes."
        return ""

    def _is_known(self, scope: Any, cookies: str) -> bool:
        try:
            said = SimpleCookie(cookies).get(self._cookie)
        except CookieError:
            said = None
        asked = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        given = [*asked, *([said.value] if said is not None else [])]
        return any(hmac.compare_digest(each.encode(), self._token.encode()) for each in given)

    def _keeping_token(self, scope: Any, send: Any) -> Any:
        async def keeping(message: Any) -> None:
            if message["type"] == "http.response.start":
                cookie = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"
                more = {
                    "set-cookie": cookie,
                    "content-security-policy": _POLICY,
                    "referrer-policy": "no-referrer",
                    "x-content-type-options": "nosniff",
                }
                told = [(name.encode(), value.encode()) for name, value in more.items()]
                message = {**message, "headers": [*message.get("headers", []), *told]}
            await send(message)

        return keeping


async def _refuse(scope: Any, send: Any, why: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})  # before it is accepted: 403
        return
    body = _REFUSED.format(why=why).encode()
    headers = [(b"content-type", b"text/html; charset=utf-8")]
    headers.append((b"content-length", str(len(body)).encode()))
    headers.append((b"connection", b"close"))  # what comes with the request is not read
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})
