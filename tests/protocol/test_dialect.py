"""The committed Python, and our classes, are what the XML says."""

import tomllib
from enum import IntEnum
from pathlib import Path
from xml.etree import ElementTree

import pytest

from laglab_protocol import DIALECT_VERSION, DialectError, EndReason, message_type
from laglab_protocol.dialect.generated import laglab as dialect
from laglab_protocol.dialect.mavgen import (
    GENERATED,
    LANGUAGES,
    dialect_path,
    generate,
    generate_into,
)
from laglab_protocol.messages.names import WRITTEN_OUT

PYTHON_TYPE = {"float": float, "double": float, "char": bytes}


def test_regenerating_gives_the_committed_bytes(tmp_path: Path) -> None:
    generate(dialect_path(), "Python3", tmp_path / "laglab.py")

    assert (tmp_path / "laglab.py").read_bytes() == GENERATED.read_bytes()


@pytest.mark.parametrize("name", WRITTEN_OUT)
def test_written_out_messages_are_the_xml_s(name: str) -> None:
    written = WRITTEN_OUT[name]
    generated = next(each for each in dialect.mavlink_map.values() if each.msgname == name)
    types = dict(zip(generated.fieldnames, generated.fieldtypes, strict=True))
    arrays = dict(zip(generated.ordered_fieldnames, generated.lengths, strict=True))

    assert list(written.__struct_fields__) == generated.ordered_fieldnames
    for field, annotation in written.__annotations__.items():
        expected = PYTHON_TYPE.get(types[field], int)
        assert annotation == (tuple[expected, ...] if arrays[field] > 1 else expected), field


def test_our_messages_declare_their_fields_in_wire_order() -> None:
    ours = [each for number, each in dialect.mavlink_map.items() if number >= 52100]

    assert [each.msgname for each in ours] == [name for name in WRITTEN_OUT if "LAGLAB" in name]
    assert all(each.fieldnames == each.ordered_fieldnames for each in ours)


def test_the_version_is_the_xml_s() -> None:
    assert ElementTree.parse(dialect_path()).findtext("version") == str(DIALECT_VERSION)


@pytest.mark.parametrize(("ours", "name"), [(EndReason, "LAGLAB_END_REASON")])
def test_enums_are_the_xml_s(ours: type[IntEnum], name: str) -> None:
    theirs = {
        entry.name.removeprefix(f"{name}_"): value
        for value, entry in dialect.enums[name].items()
        if not entry.name.endswith("_ENUM_END")
    }

    assert {each.name: each.value for each in ours} == theirs


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(DialectError, match="LAGLAB_NOTHING"):
        message_type("LAGLAB_NOTHING")


def test_what_mavgen_refuses_is_our_error(tmp_path: Path) -> None:
    xml = tmp_path / "broken.xml"
    xml.write_text("<mavlink><messages><message id='1'/></messages></mavlink>")

    with pytest.raises(DialectError, match=r"broken\.xml"):
        generate(xml, "Python3", tmp_path / "out.py")


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_is_generated(tmp_path: Path, language: str) -> None:
    where = generate_into(language, tmp_path / "out")
    made = [where] if where.is_file() else [path for path in where.rglob("*") if path.is_file()]
    names = [path.name.lower() for path in made]
    texts = [path.read_text(errors="replace").lower() for path in made]

    assert any("laglab_measurement" in text for text in [*names, *texts])


OWN = """<mavlink><include>common.xml</include><messages><message id="52990" name="OWN_{name}">
<description>One.</description><field type="uint8_t" name="one">One.</field></message></messages>
</mavlink>"""


def test_a_dialect_beside_it_may_be_included(tmp_path: Path) -> None:
    (tmp_path / "own.xml").write_text(OWN.format(name="FIRST"))
    two = OWN.format(name="SECOND").replace("common.xml", "own.xml").replace("52990", "52991")
    (tmp_path / "two.xml").write_text(two)
    made = generate_into("Python3", tmp_path / "out", tmp_path / "two.xml").read_text()
    assert "OWN_FIRST" in made
    assert "OWN_SECOND" in made
    (tmp_path / "own.xml").unlink()
    with pytest.raises(DialectError, match=r"two\.xml includes 'own\.xml', which is neither"):
        generate_into("Python3", tmp_path / "out", tmp_path / "two.xml")


def test_a_language_that_there_is_not_is_said(tmp_path: Path) -> None:
    with pytest.raises(DialectError, match="COBOL"):
        generate_into("COBOL", tmp_path)
    with pytest.raises(DialectError, match=r"no\.xml"):
        generate_into("C", tmp_path, tmp_path / "no.xml")


def test_the_installed_package_carries_the_dialect() -> None:
    """In a clone the XML lies beside the package, in a wheel inside it."""
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())
    forced = project["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]

    assert forced["protocol/laglab.xml"] == "laglab_protocol/laglab.xml"
