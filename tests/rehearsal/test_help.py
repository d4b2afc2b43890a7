"""What a command that has commands says when it stands alone."""

import pytest

from laglab.command import main


@pytest.mark.parametrize("group", [(), ("bench",), ("fmu",), ("protocol",)])
def test_a_group_alone_shows_its_help(
    group: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    shown = []
    for arguments in (group, (*group, "--help")):
        with pytest.raises(SystemExit) as ended:
            main([*arguments])
        assert ended.value.code == 0
        shown.append(capsys.readouterr())
    alone, asked = shown
    assert alone == asked
    assert "\nCommands:\n  " in alone.out
