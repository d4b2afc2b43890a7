"""The lint finds each fault that mavgen lets through, and nothing in our own dialect."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from laglab_protocol import DialectError
from laglab_protocol.dialect.lint import Finding, lint
from laglab_protocol.dialect.mavgen import dialect_path, generate

GOOD = """<mavlink>
  <include>common.xml</include>
  <enums>
    <enum name="ROVER_MOOD"><description>Its mood.</description>
      <entry value="0" name="ROVER_MOOD_GOOD"><description>Good.</description></entry>
      <entry value="1" name="ROVER_MOOD_BAD"><description>Bad.</description></entry>
    </enum>
  </enums>
  <messages>
    <message id="52200" name="ROVER_STATE"><description>Its state.</description>
      <field type="float" name="speed" units="m/s">Speed.</field>
      <field type="uint8_t" name="mood" enum="ROVER_MOOD">Mood.</field>
      <field type="uint8_t" name="target_system">Whom.</field>
      <field type="uint8_t" name="target_component">Whom.</field>
    </message>
    <message id="52201" name="ROVER_TEXT"><description>Text.</description>
      <field type="char[200]" name="text">Text.</field>
    </message>
  </messages>
</mavlink>
"""

FAULTS = {
    "payload over 255 bytes": ("char[200]", "double[32]", "payload of 256 bytes"),
    "a reserved word of Python": ('name="speed"', 'name="from"', "collides"),
    "a reserved word of C": ('name="speed"', 'name="register"', "collides"),
    "a method of the generated class": ('name="speed"', 'name="pack"', "collides"),
    "lower-case message name": ('name="ROVER_STATE"', 'name="rover_state"', "upper-case"),
    "upper-case field name": ('name="speed"', 'name="Speed"', "lower-case"),
    "id below the private range": ('id="52200"', 'id="51000"', "private dialects"),
    "id above the private range": ('id="52200"', 'id="60000"', "private dialects"),
    "id of an included message": ('id="52200"', 'id="30"', "an included dialect"),
    "id that is no number": ('id="52200"', 'id="many"', "plain number"),
    "the same id twice": ('id="52201"', 'id="52200"', "used 2 times"),
    "the same name twice": ('"ROVER_TEXT"', '"ROVER_STATE"', "used 2 times"),
    "name of an included message": ('"ROVER_TEXT"', '"ATTITUDE"', "an included dialect"),
    "the same field twice": ('name="mood"', 'name="speed"', "used 2 times"),
    "no units": (' units="m/s"', "", "no units"),
    "no message description": ("<description>Text.</description>", "", "no description"),
    "no field description": (">Speed.<", "><", "no description"),
    "no enum description": ("<description>Its mood.</description>", "", "no description"),
    "no entry description": ("<description>Bad.</description>", "", "no description"),
    "unknown type": ('"float"', '"half"', "no type of MAVLink"),
    "array of nothing": ("char[200]", "char[0]", "no type of MAVLink"),
    "unknown enum": ('enum="ROVER_MOOD"', 'enum="MOOD"', "defined nowhere"),
    "the same enum value twice": ('value="1"', 'value="0"', "used 2 times"),
    "a value to be evaluated": ('value="1"', 'value="__import__(1)"', "plain number"),
    "entry without its enum's name": ("ROVER_MOOD_BAD", "BAD", "begin it with"),
    "lower-case entry": ("ROVER_MOOD_BAD", "ROVER_MOOD_bad", "upper-case"),
    "target of a wide type": ('"uint8_t" name="target_s', '"uint16_t" name="target_s', "routers"),
    "half a target": ('name="target_system"', 'name="whom"', "without target_system"),
    "an include that is nowhere": ("common.xml", "uncommon.xml", "nowhere"),
    "another file": ("mavlink>", "robot>", "root is <robot>"),
}


def linted(folder: Path, text: str | bytes) -> list[Finding]:
    path = folder / "rover.xml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return lint(path)


def test_our_dialect_has_no_fault() -> None:
    assert lint(dialect_path()) == []


PUBLISHED = """
    <message id="183" name="AUTOPILOT_VERSION_REQUEST"><description>Of another.</description>
      <field type="uint8_t" name="target_system">Whom.</field>
      <field type="uint8_t" name="target_component">Whom.</field>
    </message>
  </messages>"""
"""As in ardupilotmega.xml, which `GOOD` does not include."""


def test_a_message_of_another_published_dialect_may_be_repeated_as_it_is(tmp_path: Path) -> None:
    assert linted(tmp_path, GOOD.replace("</messages>", PUBLISHED)) == []
    for was, becomes in {"_REQUEST": "_QUESTION", "target_component": "whom"}.items():
        (found,) = linted(tmp_path, GOOD.replace("</messages>", PUBLISHED.replace(was, becomes)))
        assert "private dialects" in found.what


def test_a_good_dialect_has_no_fault_and_generates(tmp_path: Path) -> None:
    assert linted(tmp_path, GOOD) == []
    generate(tmp_path / "rover.xml", "Python3", tmp_path / "rover.py")


@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_is_found(tmp_path: Path, name: str) -> None:
    right, wrong, says = FAULTS[name]
    assert right in GOOD

    findings = linted(tmp_path, GOOD.replace(right, wrong))

    assert any(says in finding.what for finding in findings), findings


@pytest.mark.parametrize(
    "name",
    ["payload over 255 bytes", "a reserved word of Python", "a method of the generated class"],
)
def test_mavgen_lets_it_through(tmp_path: Path, name: str) -> None:
    """Why there is a lint at all."""
    right, wrong, _ = FAULTS[name]
    (tmp_path / "rover.xml").write_text(GOOD.replace(right, wrong))

    generate(tmp_path / "rover.xml", "Python3", tmp_path / "rover.py")
    assert (tmp_path / "rover.py").exists()


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(DialectError, match=r"no\.xml"):
        lint(tmp_path / "no.xml")


def check_anything(folder: Path, data: bytes) -> None:
    """Findings, or our own error: nothing else comes of any bytes."""
    try:
        assert all(isinstance(finding, Finding) for finding in linted(folder, data))
    except DialectError:
        return


@given(data=st.binary(max_size=300))
def test_any_bytes(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    check_anything(tmp_path_factory.getbasetemp(), data)


@given(data=st.data())
def test_a_spoiled_dialect(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(GOOD)))
    stop = data.draw(st.integers(start, min(start + 30, len(GOOD))))
    patch = data.draw(st.sampled_from([*"<>\"'/&0aA-", "", "name=''", "id='0x'", "<field/>", "½"]))
    text = GOOD[:start] + patch + GOOD[stop:]

    check_anything(tmp_path_factory.getbasetemp(), text.encode())
