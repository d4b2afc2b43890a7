"""The live page's own process: it listens to the loop, and serves whoever looks.

Nothing here can hold the loop: that sends its datagrams whether anybody reads them or not.
"""

import asyncio
import math
import os
from contextlib import suppress
from http import HTTPStatus
from time import monotonic
from typing import Any

from msgspec.structs import replace

from laglab.live.door import ORDERS, Door, answer, head, parse
from laglab.live.messages import Given, Line, LiveOrder, Order, Over, Rows, packed, unpacked
from laglab.live.page import page_html
from laglab.live.place import Place
from laglab.live.session import Viewed, words
from laglab.live.stream import Known, Piece, event
from laglab.runs.processes.child import Tell
from laglab.runs.processes.reports import Failed, Showing
from laglab.scenario import Scenario

PATIENCE = 5.0
"""[s] for the head of a request."""
LONGEST_HEAD = 16 * 1024
MOST_UNREAD = 1 << 20
"""[byte] A reader that is further behind is sent away; its page calls again."""
MOST_READERS = 250
SOONEST = 0.08
"""[s] between two pieces of news: of a loop's datagrams every other is passed on as it comes."""
LATEST = 0.2
"""[s] that rows wait for more of them, when their loop pauses."""
GOODBYE = 0.5
"""[s]"""
POLITE = 19
"""The loop goes first; but no further down, or a page starves on a machine that is busy."""


def serve(order: LiveOrder, tell: Tell) -> None:
    """Until our parent wants us to go."""
    if hasattr(os, "nice"):
        os.nice(POLITE)
    try:
        asyncio.run(_Server(order).run(tell))
    except OSError as error:
        code = error.errno or 0
        why = os.strerror(code) if code > 0 else error.strerror  # the resolver's are below 0
        tell(Failed(f"--live: cannot listen at {order.host}:{order.port}: {why}", False))


class _Server(asyncio.DatagramProtocol):
    def __init__(self, order: LiveOrder) -> None:
        self._order = order
        self._scenario = Scenario.from_toml(order.scenario)
        self._door = Door(Place(order.host, order.port), order.token)
        self._pages = {
            controls: page_html(self._scenario, order, controls).encode()
            for controls in (False, True)
        }
        self._known = Known()
        self._readers: set[asyncio.StreamWriter] = set()
        self._waiting: list[Rows] = []
        self._passed_on = -math.inf
        self._wanted: Order | None = None
        self._session = Viewed(self._scenario) if order.station_alone else None
        self._loop_at: tuple[str, int] | None = None

    async def run(self, tell: Tell) -> None:
        """Raises OSError when we cannot listen there."""
        asyncio.get_running_loop().set_exception_handler(_unless_crowded)
        server = await asyncio.start_server(
            self._meet, self._order.host, self._order.port, limit=LONGEST_HEAD
        )
        port = server.sockets[0].getsockname()[1]
        self._door = Door(Place(self._order.host, port), self._order.token)
        ears, _ = await asyncio.get_running_loop().create_datagram_endpoint(
            lambda: self, local_addr=("127.0.0.1", 0)
        )
        self._ears = ears
        line = Line(ears.get_extra_info("sockname")[1], self._order.secret)
        tell(Showing(port, str(line)))
        try:
            while True:
                await asyncio.sleep(LATEST)
                self._pass_on_after(LATEST)
        except asyncio.CancelledError:
            await self._say_goodbye()
            raise

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        """The loop has something to tell, or whoever started it."""
        match unpacked(data, self._order.secret):
            case Rows() as rows:
                self._loop_at = addr
                self._waiting.append(rows)
                self._insist(rows)
                self._pass_on_after(SOONEST)
            case Over(verdict):
                self._known.verdict = verdict
            case _:
                pass

    def _insist(self, rows: Rows) -> None:
        """A datagram may be lost, so what is wanted is said until it is so."""
        if self._wanted == "stop" and rows.stopped:
            self._wanted = None
        if self._wanted is not None and self._loop_at:
            self._ears.sendto(packed(Given(self._wanted), self._order.secret), self._loop_at)

    def _pass_on_after(self, wait: float) -> None:
        """Once that long [s] has gone by since the last time.

        Best when rows have just come: the loop tells when it has begun its tick, and by the clock
        it does not need the processor before the next one.
        """
        if monotonic() - self._passed_on >= wait:
            self._pass_on()

    def _pass_on(self) -> None:
        self._passed_on = monotonic()
        waiting, self._waiting = self._waiting, []
        if not waiting:
            return
        rows = _together(waiting)
        said = words(rows.frames)
        if self._session is not None:
            rows = replace(self._session.hear(rows.frames), stopped=rows.stopped)
        self._tell_all(self._known.learn(rows, said, self._scenario))

    def _tell_all(self, piece: Piece) -> None:
        if not self._readers:
            return
        data = event(piece)
        for reader in list(self._readers):
            if reader.transport.get_write_buffer_size() > MOST_UNREAD:
                self._readers.discard(reader)
                reader.transport.abort()
            else:
                reader.write(data)

    async def _say_goodbye(self) -> None:
        await asyncio.sleep(0.05)  # the last words may be on their way
        self._pass_on()
        if self._known.verdict is not None:
            self._tell_all(Piece({}, (), self._known.stopped, verdict=self._known.verdict))
        for reader in self._readers:
            reader.close()
        with suppress(TimeoutError):
            gone = (reader.wait_closed() for reader in self._readers)
            await asyncio.wait_for(asyncio.gather(*gone, return_exceptions=True), GOODBYE)

    async def _meet(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            asked = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), PATIENCE)
            if self._answer(asked, writer):
                while await reader.read(LONGEST_HEAD):
                    pass  # to the end: then the reader has gone
        except (OSError, EOFError, TimeoutError, asyncio.LimitOverrunError):
            pass
        finally:
            self._readers.discard(writer)
            writer.close()

    def _answer(self, asked: bytes, writer: asyncio.StreamWriter) -> bool:
        """Answer a request; True when its reader is to be told all that comes, too."""
        request = parse(asked)
        say = writer.write
        if request is None:
            say(answer(HTTPStatus.BAD_REQUEST))
        elif refused := self._door.refusal(request):
            say(answer(refused))
        elif request.path in ORDERS:
            self._wanted = "stop" if request.path == "/stop" else "end"
            say(answer(HTTPStatus.ACCEPTED))
        elif request.path == "/":
            page = self._pages[self._door.knows(request)]
            say(answer(HTTPStatus.OK, "text/html", page))
        elif len(self._readers) >= MOST_READERS:
            say(answer(HTTPStatus.SERVICE_UNAVAILABLE))
        else:
            say(head(HTTPStatus.OK, "text/event-stream") + event(self._known.whole))
            self._readers.add(writer)
            return True
        return False


def _unless_crowded(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """A caller for whom the system has no room waits until it has: that is nobody's fault."""
    if not isinstance(context.get("exception"), OSError):
        loop.default_exception_handler(context)


def _together(several: list[Rows]) -> Rows:
    *lists, _ = Rows.__struct_fields__
    whole = Rows(stopped=several[-1].stopped)
    for rows in several:
        for name in lists:
            getattr(whole, name).extend(getattr(rows, name))
    return whole
