"""Anything at all."""

from hypothesis import given
from hypothesis import strategies as st

from laglab_gateway import Safety, Services, Timesyncing, standard_parameters
from laglab_protocol import (
    CommandLong,
    FileTransferProtocol,
    LogRequestData,
    Message,
    MissionRequestList,
    ParamExtSet,
    ParamRequestRead,
    ParamSet,
    Ping,
    RequestDataStream,
    Sender,
    SetMode,
    Timesync,
)

from .asking import RESET, ask

NUMBERS = st.floats(width=32)
BYTE, WORD, ONE = st.integers(0, 255), st.integers(0, 65535), st.just(1)
REQUESTS = st.one_of(
    st.builds(CommandLong, *[NUMBERS] * 7, st.integers(0, 65535), BYTE, BYTE, BYTE),
    st.builds(
        CommandLong,
        *[NUMBERS] * 7,
        st.sampled_from([400, 176, 185, 410, 511, 512, 520, RESET]),
        st.just(1),
        st.just(1),
        BYTE,
    ),
    st.builds(ParamSet, NUMBERS, st.just(1), st.just(1), st.binary(max_size=16), BYTE),
    st.builds(
        ParamSet, NUMBERS, st.just(1), st.just(1), st.sampled_from([b"V_MAX", b"DELAY_N"]), BYTE
    ),
    st.builds(ParamRequestRead, st.integers(-(2**15), 2**15 - 1), BYTE, BYTE, st.binary()),
    st.builds(FileTransferProtocol, BYTE, ONE, ONE, st.tuples(*[BYTE] * 251)),
    st.builds(MissionRequestList, ONE, ONE, BYTE),
    st.builds(SetMode, st.integers(0, 2**32 - 1), ONE, BYTE),
    st.builds(ParamExtSet, ONE, ONE, st.binary(max_size=16), st.binary(max_size=128), BYTE),
    st.builds(LogRequestData, *[st.integers(0, 2**32 - 1)] * 2, WORD, ONE, ONE),
    st.builds(RequestDataStream, WORD, ONE, ONE, BYTE, BYTE),
    st.builds(Ping, BYTE, BYTE, BYTE, BYTE),
    st.builds(Timesync, BYTE, BYTE),
)


@given(st.lists(REQUESTS, max_size=20))
def test_no_request_raises_and_every_answer_can_be_sent(requests: list[Message]) -> None:
    services = Services(standard_parameters(10, 20, Safety()), timesync=Timesyncing(lambda: 1))
    sender = Sender(1, 1)
    for request in requests:
        for answer in ask(services, request):
            sender.frame(answer)
        assert 0.0 <= services.parameters["V_MAX"] <= 100.0
        assert services.parameters["DELAY_N"] == 10
