"""The page for firmware authors names what the XML has and what the services answer."""

import re
from pathlib import Path

from laglab_protocol import EndReason
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.dialect.mavgen import LANGUAGES

README = (Path(__file__).parents[2] / "protocol" / "README.md").read_text()
OURS = [each for number, each in dialect.mavlink_map.items() if number >= 52100]


def row_of(name: str) -> str:
    (row,) = re.findall(rf"^\| \d+ \| {name} \|.*$", README, re.MULTILINE)
    return str(row)


def test_each_message_has_a_row_with_its_id_and_fields() -> None:
    for message in OURS:
        row = row_of(message.msgname)
        assert row.startswith(f"| {message.id} |")
        for field in message.fieldnames:
            if not field.startswith("p_"):
                assert re.search(rf"`[^`]*\b{field}\b[^`]*`", row), f"{message.msgname}.{field}"


def test_the_reasons_and_languages_are_told() -> None:
    assert all(f"{each.value} {each.name}" in row_of("LAGLAB_END") for each in EndReason)
    assert all(language in README for language in LANGUAGES)


def test_the_tests_it_names_exist() -> None:
    here = Path(__file__).parent
    named = set(re.findall(r"`(test_\w+\.py)`", README))

    assert named
    assert all(list(here.parent.rglob(name)) for name in named)
    assert (here / "golden.py").is_file()
