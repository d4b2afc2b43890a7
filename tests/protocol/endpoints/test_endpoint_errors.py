"""What is wrong with an endpoint is said, with the part that is wrong."""

import socket

import pytest

from laglab_protocol import (
    BadUrlError,
    EndpointError,
    NoSuchPortError,
    PortBusyError,
    open_endpoint,
)


@pytest.mark.parametrize(
    ("url", "part"),
    [
        ("tcp://127.0.0.1:5760", "kind 'tcp'"),
        ("robot", "no kind"),
        ("udpin://127.0.0.1", "port '//127.0.0.1'|no port"),
        ("udpin://127.0.0.1:many", "port 'many'"),
        ("udpout://127.0.0.1:70000", "port '70000'"),
        ("udpout://127.0.0.1:0", "port '0' is no number from 1 to"),
        ("serial:///dev/ttyUSB0", "no baud"),
        ("serial:///dev/ttyUSB0:fast", "baud 'fast'"),
        ("/dev/ttyUSB0", "no baud"),
        ("/dev/ttyUSB0,0", "baud '0'"),
        ("serial://:57600", "no device"),
        ("pty://", "no path"),
    ],
)
def test_a_wrong_spelling_names_the_part(url: str, part: str) -> None:
    with pytest.raises(BadUrlError, match=part) as caught:
        open_endpoint(url)

    assert url in str(caught.value)


@pytest.mark.parametrize(
    ("url", "error"),
    [
        ("serial:///dev/ttyNOTHERE:57600", NoSuchPortError),
        ("serial:///dev/null:57600", NoSuchPortError),
        ("udpin://192.0.2.1:14550", NoSuchPortError),
        ("udpout://no.such.host.invalid:14550", NoSuchPortError),
        ("pty:///no/such/folder/robot", NoSuchPortError),
    ],
)
def test_what_does_not_exist_is_said(url: str, error: type[EndpointError]) -> None:
    with pytest.raises(error) as caught:
        open_endpoint(url)

    assert url.removeprefix("udpin://") in str(caught.value)


def test_a_port_in_use_is_said() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        port = other.getsockname()[1]
        with pytest.raises(PortBusyError, match=str(port)):
            open_endpoint(f"udpin://127.0.0.1:{port}")
