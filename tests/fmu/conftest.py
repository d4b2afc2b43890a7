"""The FMUs under test, built once from the sources as they are."""

from pathlib import Path

import pytest

from laglab_fmu import build_fmus
from laglab_fmu import slave as slave_module


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The FMUs by file name without suffix."""
    return {path.stem: path for path in build_fmus(tmp_path_factory.mktemp("fmus"))}


@pytest.fixture(autouse=True)
def use_fresh_fmus(fmus: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """Robots open the FMUs of this session, not what an earlier installation left."""
    monkeypatch.setattr(slave_module, "built", lambda name: fmus[Path(name).stem])
