"""The golden table in C: mavgen's headers, compiled here, make and read the very same bytes."""

import math
import subprocess
from pathlib import Path
from string import Template

import pytest
from msgspec.structs import astuple

from laglab_fmu import c_compiler
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.dialect.mavgen import dialect_path, generate
from laglab_protocol.messages.layout import layout_of

from .golden import GOLDEN, Golden

PROGRAM = Template("""
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <laglab/mavlink.h>

static void print_frame(const mavlink_message_t *message)
{
    uint8_t raw[MAVLINK_MAX_PACKET_LEN];
    const uint16_t size = mavlink_msg_to_send_buffer(raw, message);
    for (uint16_t i = 0; i < size; i++)
        printf("%02x", raw[i]);
    printf("\\n");
}

static void made(void)
{
    mavlink_message_t message;
$made
}

/* Parse one byte at a time, decode into the struct, encode from the struct again. */
static void read_again(const uint8_t *raw, size_t size)
{
    mavlink_message_t message, again;
    mavlink_status_t status;
    for (size_t i = 0; i < size; i++)
        if (mavlink_parse_char(MAVLINK_COMM_1, raw[i], &message, &status))
            switch (message.msgid) {
$cases
            }
    print_frame(&again);
}

int main(void)
{
    made();
$read
    return 0;
}
""")


def c_double(value: float) -> str:
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "-INFINITY"
    return value.hex()


def c_value(value: float | tuple[float, ...], kind: str) -> str:
    if isinstance(value, tuple):
        return f"(const {kind}[]){{{', '.join(c_value(each, kind) for each in value)}}}"
    return c_double(value) if isinstance(value, float) else f"{value}LL"


def lower_name(row: Golden) -> str:
    return layout_of(row.message).name.lower()


def declared_order(row: Golden) -> list[str]:
    """C's pack functions take the fields as the XML declares them."""
    generated = dialect.mavlink_map[layout_of(row.message).id]
    values = [astuple(row.message)[i] for i in generated.orders]
    return list(map(c_value, values, generated.fieldtypes))


def make_in_c(row: Golden) -> str:
    # mavlink_version is not given to C: it fills it in.
    fields = ", ".join(declared_order(row)[: 5 if "heart" in row.name else None])
    return (
        f"    mavlink_get_channel_status(MAVLINK_COMM_0)->current_tx_seq = {row.sequence};\n"
        f"    mavlink_msg_{lower_name(row)}_pack("
        f"{row.system}, {row.component}, &message, {fields});\n"
        "    print_frame(&message);"
    )


def read_in_c(row: Golden) -> str:
    raw = ", ".join(str(byte) for byte in row.raw)
    return f"    read_again((const uint8_t[]){{{raw}}}, {len(row.raw)});"


def case_in_c(name: str) -> str:
    return f"""            case MAVLINK_MSG_ID_{name.upper()}: {{
                mavlink_{name}_t fields;
                mavlink_msg_{name}_decode(&message, &fields);
                mavlink_get_channel_status(MAVLINK_COMM_0)->current_tx_seq = message.seq;
                mavlink_msg_{name}_encode(message.sysid, message.compid, &again, &fields);
                break;
            }}"""


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    folder = tmp_path_factory.mktemp("c")
    generate(dialect_path(), "C", folder / "include")
    source = folder / "golden.c"
    source.write_text(
        PROGRAM.substitute(
            made="\n".join(map(make_in_c, GOLDEN)),
            cases="\n".join(case_in_c(name) for name in sorted(set(map(lower_name, GOLDEN)))),
            read="\n".join(map(read_in_c, GOLDEN)),
        )
    )
    return run(compiled(source, folder))


def compiled(source: Path, folder: Path) -> Path:
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsanitize=undefined"]
    program = folder / "golden"
    subprocess.run(
        [*c_compiler(), *strict, "-isystem", folder / "include", source, "-lm", "-o", program],
        check=True,
        timeout=50,
    )
    return program


def run(program: Path) -> list[str]:
    done = subprocess.run([program], capture_output=True, text=True, check=True, timeout=10)
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize("index", range(len(GOLDEN)), ids=lambda i: GOLDEN[i].name)
def test_c_makes_these_bytes(printed: list[str], index: int) -> None:
    assert printed[index] == GOLDEN[index].hexadecimal


@pytest.mark.parametrize("index", range(len(GOLDEN)), ids=lambda i: GOLDEN[i].name)
def test_c_reads_these_bytes_and_makes_them_again(printed: list[str], index: int) -> None:
    assert printed[len(GOLDEN) + index] == GOLDEN[index].hexadecimal
