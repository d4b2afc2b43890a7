"""Who may ask a live page for what; and where it is."""

from http import HTTPStatus

import pytest

from laglab.errors import LiveError
from laglab.live import Place, place_of, spelled_out
from laglab.live.door import Door, Request, parse
from laglab.live.live import LivePage
from laglab.live.messages import Given, Rows, packed, unpacked

HOME = Door(Place("127.0.0.1", 8000), "right")
ABROAD = Door(Place("0.0.0.0", 8000), "right")
FORBIDDEN = HTTPStatus.FORBIDDEN


def get(path: str, token: str = "", host: str = "127.0.0.1:8000") -> Request:
    return Request("GET", path, token, host, None)


def test_on_loopback_anybody_may_look() -> None:
    for path in ("/", "/events"):
        assert HOME.refusal(get(path)) is None
        assert HOME.refusal(get(path, "right")) is None
        assert HOME.refusal(get(path, "wrong")) is FORBIDDEN


def test_beyond_loopback_nobody_may_without_the_token() -> None:
    host = "192.0.2.7:8000"
    for path in ("/", "/events"):
        assert ABROAD.refusal(get(path, host=host)) is FORBIDDEN
        assert ABROAD.refusal(get(path, "right", host)) is None


@pytest.mark.parametrize("host", ["", "elsewhere.example:8000", "127.0.0.1", "127.0.0.1:x", "[::1"])
def test_a_name_that_is_not_ours_is_refused(host: str) -> None:
    assert HOME.refusal(get("/", "right", host)) is FORBIDDEN


@pytest.mark.parametrize(
    ("origin", "refused"),
    [
        ("http://127.0.0.1:8000", None),
        ("http://localhost:8000", FORBIDDEN),
        ("https://127.0.0.1:8000", FORBIDDEN),
        ("http://127.0.0.1:9000", FORBIDDEN),
        ("null", FORBIDDEN),
        (None, FORBIDDEN),
    ],
)
def test_only_our_own_page_gives_orders(origin: str | None, refused: HTTPStatus | None) -> None:
    request = Request("POST", "/stop", "right", "127.0.0.1:8000", origin)
    assert HOME.refusal(request) is refused


@pytest.mark.parametrize(
    "head",
    [
        b"",
        b"GET /\r\n\r\n",
        b"GET / HTTP/2\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: a\r\nhost: b\r\n\r\n",
        b"GET http://[ HTTP/1.1\r\n\r\n",
        b"\xff\xfe\r\n\r\n",
    ],
)
def test_what_is_no_request_is_none(head: bytes) -> None:
    assert parse(head) is None


def test_a_request_is_read() -> None:
    head = b"POST /stop?token=a%2Bb HTTP/1.1\r\nHost: h:1\r\nOrigin: http://h:1\r\n\r\n"
    assert parse(head) == Request("POST", "/stop", "a+b", "h:1", "http://h:1")


@pytest.mark.parametrize(
    ("told", "place"),
    [
        ("0", Place("127.0.0.1", 0)),
        ("8000", Place("127.0.0.1", 8000)),
        ("0.0.0.0:8000", Place("0.0.0.0", 8000)),
        ("[::1]:80", Place("::1", 80)),
    ],
)
def test_where_it_is_to_be(told: str, place: Place) -> None:
    assert place_of(told) == place


@pytest.mark.parametrize("told", ["", "x", "65536", "host:", ":80x"])
def test_where_nothing_can_be(told: str) -> None:
    with pytest.raises(LiveError, match="not a PORT nor HOST:PORT"):
        place_of(told)


def test_the_option_may_stand_alone() -> None:
    assert spelled_out([]) == []
    assert spelled_out(["run", "--live", "lab"]) == ["run", "--live=0", "lab"]
    assert spelled_out(["run", "lab", "--live"]) == ["run", "lab", "--live=0"]
    assert spelled_out(["run", "--live", "8000", "lab"]) == ["run", "--live", "8000", "lab"]
    assert spelled_out(["run", "--live", "::1:80"]) == ["run", "--live", "::1:80"]


def test_what_others_can_reach_is_said_in_so_many_words() -> None:
    assert LivePage(Place("127.0.0.1", 1), "t", "1:s").warning is None
    assert LivePage(Place("::1", 1), "t", "1:s").address == "http://[::1]:1/?token=t"
    warning = LivePage(Place("0.0.0.0", 1), "t", "1:s").warning
    assert warning is not None
    assert "whoever has its address" in warning


def test_only_who_knows_the_secret_is_heard() -> None:
    assert unpacked(packed(Given("stop"), "ours"), "ours") == Given("stop")
    assert unpacked(packed(Rows(), "theirs"), "ours") is None
    assert unpacked(b"ours and rubbish", "ours") is None
