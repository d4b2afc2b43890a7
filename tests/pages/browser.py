"""Chromium without a window, over its DevTools protocol: what a page asks for, says and shows."""

import base64
import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from websockets.sync.client import ClientConnection, connect

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
PATIENCE = 30.0
"""[s]"""
OPTIONS = (
    "--headless=new",
    "--remote-debugging-port=0",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-extensions",
    "--disable-gpu",
    "--disable-sync",
    "--hide-scrollbars",
)


def chromium() -> str | None:
    """Where it is, if it is."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Tab:
    """One page: what it asked the network for, and what went wrong in it."""

    def __init__(self, link: ClientConnection) -> None:
        self.requests: list[str] = []
        self.errors: list[str] = []
        self._link = link
        self._number = 0
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: object) -> Any:
        """One command of the protocol; what it gives."""
        self._number += 1
        order = {"id": self._number, "method": method, "params": parameters}
        self._link.send(json.dumps(order))
        while True:
            told = json.loads(self._link.recv(timeout=PATIENCE))
            if told.get("id") == self._number:
                assert "error" not in told, told["error"]
                return told["result"]
            self._note(told)

    def _note(self, told: dict[str, Any]) -> None:
        about = told.get("params", {})
        match told.get("method"):
            case "Network.requestWillBeSent":
                self.requests.append(about["request"]["url"])
            case "Runtime.exceptionThrown":
                details = about["exceptionDetails"]
                self.errors.append(str(details.get("exception", details).get("description")))
            case "Runtime.consoleAPICalled" if about["type"] in ("error", "warning", "assert"):
                self.errors.append(" ".join(str(each.get("value")) for each in about["args"]))
            case "Log.entryAdded" if about["entry"]["level"] in ("error", "warning"):
                self.errors.append(about["entry"]["text"])

    def open(self, address: str, wide: int = 1280, high: int = 900) -> None:
        """Go there, and wait until it is drawn."""
        self.resize(wide, high)
        self.call("Page.navigate", url=address)
        self.wait("document.documentElement?.dataset.ready === 'yes'")

    def resize(self, wide: int, high: int) -> None:
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=wide,
            height=high,
            deviceScaleFactor=1,
            mobile=False,
        )

    def value(self, script: str) -> Any:
        """Of an expression in the page; a promise is waited for."""
        given = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in given, given["exceptionDetails"]
        return given["result"].get("value")

    def wait(self, script: str) -> None:
        """Until the expression is true."""
        deadline = time.monotonic() + PATIENCE
        while not self.value(script):
            assert time.monotonic() < deadline, f"{script} is not true; errors: {self.errors}"
            time.sleep(0.05)

    def column(self, source: str, name: str) -> list[Any]:
        """Of a data source of the page's plots."""
        found = f"Bokeh.documents[0].get_model_by_name('{source}').data['{name}']"
        column: list[Any] = self.value(f"Array.from({found})")
        return column

    def click(self, selector: str) -> None:
        self.value(f"document.querySelector('{selector}').click()")

    def text(self, selector: str) -> str:
        text: str = self.value(f"document.querySelector('{selector}').textContent")
        return text

    def picture(self, whole: bool = True) -> bytes:
        """A PNG."""
        told = self.call("Page.captureScreenshot", captureBeyondViewport=whole)
        return base64.b64decode(told["data"])

    def close(self) -> None:
        self._link.close()


class Browser:
    """A running Chromium."""

    def __init__(self, port: int) -> None:
        self._port = port

    @contextmanager
    def tab(self) -> Iterator[Tab]:
        target = self._ask("/json/new?about:blank", "PUT")
        with connect(target["webSocketDebuggerUrl"], max_size=None, proxy=None) as link:
            yield Tab(link)
            with suppress(OSError):
                self._ask(f"/json/close/{target['id']}")

    def _ask(self, path: str, method: str = "GET") -> Any:
        from urllib.request import Request

        request = Request(f"http://127.0.0.1:{self._port}{path}", method=method)
        with urlopen(request, timeout=PATIENCE) as answer:
            text = answer.read()
        return json.loads(text) if text.startswith(b"{") else None


@contextmanager
def browser(program: str, folder: Path) -> Iterator[Browser]:
    """Its profile in the folder; gone at the end."""
    sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
    command = [program, *OPTIONS, *sandbox, f"--user-data-dir={folder}", "about:blank"]
    process = subprocess.Popen(
        command,
        env=os.environ | {"TMPDIR": str(folder)},  # killed, it leaves a folder there
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        yield Browser(_port(folder / "DevToolsActivePort", process))
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)  # nothing of its profile is kept
        process.wait()


def _port(file: Path, process: "subprocess.Popen[bytes]") -> int:
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        assert process.poll() is None, f"{process.args} has ended with {process.returncode}"
        if file.exists() and (lines := file.read_text().splitlines()):
            return int(lines[0])
        time.sleep(0.05)
    raise AssertionError(f"{process.args} does not tell its port")
