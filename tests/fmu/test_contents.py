"""What lies in the FMUs beside the binary, and what the checkers that users have say of them."""

import struct
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.util import read_csv
from fmpy.validation import validate_fmu
from lxml import etree

from laglab_fmu.archive.contents import REFERENCE_LAYER, own_files
from laglab_fmu.models import ROBOT, Role

ROOT = Path(__file__).parents[2]
SCHEMAS = Path(str(files("fmpy"))) / "schema" / "fmi3"


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_fmpy_finds_no_problem(fmus: dict[str, Path], name: str) -> None:
    assert validate_fmu(str(fmus[name])) == []


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_the_manipulation_toolbox_finds_no_error_and_no_warning(
    fmus: dict[str, Path], name: str
) -> None:
    command = [sys.executable, "-m", "fmu_manipulation_toolbox.cli.fmutool"]
    done = subprocess.run(
        [*command, "-input", str(fmus[name]), "-check"], capture_output=True, text=True, check=True
    )
    said = done.stdout + done.stderr
    assert "seems to be compliant" in said
    assert "No semantic error" in said
    assert not any(level in said for level in ("ERROR", "WARNING", "CRITICAL"))


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_every_variable_has_type_unit_and_display_unit(fmus: dict[str, Path], name: str) -> None:
    model = read_model_description(str(fmus[name]))
    for variable in model.modelVariables:
        if variable.type in ("Real", "Float64"):
            declared = variable.declaredType
            assert declared is not None, variable.name
            assert declared.unit, variable.name
            assert declared.displayUnit, variable.name
        assert variable.description
    assert model.coSimulation
    assert model.modelExchange


def test_the_size_of_a_fleet_comes_before_what_it_sizes(extracted: dict[str, Path]) -> None:
    """Importers follow a dimension as soon as they read it."""
    model = etree.parse(extracted["Fleet3"] / "modelDescription.xml").find("ModelVariables")
    read: set[str] = set()
    for variable in model:
        read.add(variable.get("valueReference"))
        assert {dimension.get("valueReference") for dimension in variable} <= read
    assert len(read) == len(ROBOT.variables)


def test_every_fmu_has_a_token_of_its_own(fmus: dict[str, Path]) -> None:
    models = [read_model_description(str(path)) for path in fmus.values()]
    assert len({model.guid for model in models}) == len(fmus)
    for model, name in zip(models, fmus, strict=True):
        assert model.coSimulation.modelIdentifier == model.modelName == name[:-1]


def test_fmi_2_leaves_time_out_and_gives_a_tolerance(fmus: dict[str, Path]) -> None:
    model = read_model_description(str(fmus["Robot2"]))
    assert "time" not in [variable.name for variable in model.modelVariables]
    assert float(model.defaultExperiment.tolerance) == 1e-6


@pytest.mark.parametrize("name", ["Robot3", "Fleet3"])
@pytest.mark.parametrize(
    ("file", "schema"),
    [
        ("terminalsAndIcons/terminalsAndIcons.xml", "fmi3TerminalsAndIcons.xsd"),
        ("sources/buildDescription.xml", "fmi3BuildDescription.xsd"),
    ],
)
def test_other_xml_is_valid(extracted: dict[str, Path], name: str, file: str, schema: str) -> None:
    etree.XMLSchema(etree.parse(SCHEMAS / schema)).assertValid(etree.parse(extracted[name] / file))


def test_terminals_hold_every_input_and_output(extracted: dict[str, Path]) -> None:
    root = etree.parse(extracted["Robot3"] / "terminalsAndIcons" / "terminalsAndIcons.xml")
    members = [m.get("variableName") for m in root.iter("TerminalMemberVariable")]
    connected = (Role.INPUT, Role.STATE, Role.SAMPLED, Role.ALGEBRAIC)
    assert members == [variable.name for variable in ROBOT.variables if variable.role in connected]


@pytest.mark.parametrize(
    ("name", "icon"), [("Robot2", "model.png"), ("Robot3", "terminalsAndIcons/icon.png")]
)
def test_there_is_an_icon(extracted: dict[str, Path], name: str, icon: str) -> None:
    image = (extracted[name] / icon).read_bytes()
    assert image.startswith(b"\x89PNG\r\n")
    assert struct.unpack_from(">II", image, 16) == (100, 100)


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_the_page_explains_every_variable(extracted: dict[str, Path], name: str) -> None:
    page = (extracted[name] / "documentation" / "index.html").read_text(encoding="utf-8")
    for variable in ROBOT.variables:
        assert variable.name == "time" or f"<td>{variable.name}</td>" in page
    etree.HTML(page)


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_licences_are_inside(extracted: dict[str, Path], name: str) -> None:
    licences = extracted[name] / "documentation" / "licenses"
    assert (licences / "license.txt").read_text() == (ROOT / "LICENSE").read_text()
    assert "2-Clause BSD" in (licences / "fmi-headers.txt").read_text()


@pytest.mark.parametrize("name", ROBOT.fmus)
def test_reference_results_are_listed_and_current(extracted: dict[str, Path], name: str) -> None:
    """After a change that is meant to change them, run fmu/reference_results.py."""
    layer = extracted[name] / "extra" / REFERENCE_LAYER
    manifest = etree.parse(layer / "fmi-ls-manifest.xml").getroot()
    listed = {related.get("role"): related.get("source") for related in manifest}
    assert listed == {"input": f"{name[:-1]}_in.csv", "result": f"{name[:-1]}_out.csv"}
    given, results = read_csv(layer / listed["input"]), read_csv(layer / listed["result"])
    assert given.dtype.names == ("time", "omega_left", "omega_right")
    assert (layer / listed["result"]).read_bytes() == (
        own_files("content") / "Robot_out.csv"
    ).read_bytes()
    assert np.ptp(results["time"]) == 10.0
