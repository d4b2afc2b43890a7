"""As much of HTTP as the live page needs: who may ask for what. No I/O."""

import secrets
from http import HTTPStatus
from ipaddress import ip_address
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

from laglab.live.place import Place

HEADERS = {
    "Cache-Control": "no-store",
    "Connection": "close",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
ORDERS = {"/stop": "stop", "/end": "end"}


class Request(NamedTuple):
    """What is asked for, and by whom, as far as that matters."""

    method: str
    path: str
    token: str
    host: str
    origin: str | None


def parse(head: bytes) -> Request | None:
    """The head of a request, up to its empty line; None when it is none."""
    first, *rest = head.decode("latin-1").split("\r\n")
    match first.split(" "):
        case [method, target, "HTTP/1.1" | "HTTP/1.0"]:
            pass
        case _:
            return None
    headers = {}
    for line in filter(None, rest):
        name, colon, value = line.partition(":")
        if not colon or name.lower() in headers:
            return None
        headers[name.lower()] = value.strip()
    try:
        url = urlsplit(target)
    except ValueError:
        return None
    token = parse_qs(url.query).get("token", [""])[-1]
    return Request(method, url.path, token, headers.get("host", ""), headers.get("origin"))


class Door(NamedTuple):
    """Where we are, and the token that opens."""

    place: Place
    token: str

    def knows(self, request: Request) -> bool:
        """Whether it has the token."""
        return secrets.compare_digest(request.token.encode(), self.token.encode())

    def refusal(self, request: Request) -> HTTPStatus | None:
        """Why not; None: it is allowed.

        To look needs no token on loopback, unless one is given; to do something always needs it,
        and a page of our own that asks. A host that is not one of our names is a
        stranger's, whose page had that name resolved to our address.
        """
        if not self._is_ours(request.host):
            return HTTPStatus.FORBIDDEN
        if request.origin not in (None, f"http://{request.host}"):
            return HTTPStatus.FORBIDDEN
        needed = bool(request.token) or not self.place.local or request.path in ORDERS
        if needed and not self.knows(request):
            return HTTPStatus.FORBIDDEN
        if request.path in ORDERS:
            if request.method != "POST":
                return HTTPStatus.METHOD_NOT_ALLOWED
            return HTTPStatus.FORBIDDEN if request.origin is None else None
        if request.path not in ("/", "/events"):
            return HTTPStatus.NOT_FOUND
        return None if request.method == "GET" else HTTPStatus.METHOD_NOT_ALLOWED

    def _is_ours(self, host: str) -> bool:
        """An address, or the name that we were told to be at."""
        try:
            url = urlsplit(f"http://{host}")
            name, port = url.hostname or "", url.port or 80
        except ValueError:
            return False
        return port == self.place.port and (
            name in ("localhost", self.place.host) or _is_address(name)
        )


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def answer(status: HTTPStatus, kind: str = "text/plain", body: bytes = b"") -> bytes:
    """A whole answer."""
    body = body or status.phrase.encode()
    return head(status, kind, {"Content-Length": str(len(body))}) + body


def head(status: HTTPStatus, kind: str, more: dict[str, str] | None = None) -> bytes:
    """What goes before the body."""
    headers = {"Content-Type": f"{kind}; charset=utf-8"} | HEADERS | (more or {})
    lines = [f"HTTP/1.1 {status.value} {status.phrase}"]
    lines += [f"{name}: {value}" for name, value in headers.items()]
    return ("\r\n".join(lines) + "\r\n\r\n").encode()
