"""Fuzzing by coverage, on demand: `pip install laglab[fuzz]`, then

    python tests/protocol/fuzz.py receiver|signed|lint|services|station|relay [-max_total_time=60]

What is fuzzed is in `fuzz_targets.py`, of which `test_fuzz.py` tries a little on every run; this
tries it for as long as it is let.
"""

import sys

import atheris

with atheris.instrument_imports(
    include=["laglab_protocol", "laglab_gateway", "laglab_station", "laglab_control"]
):
    from fuzz_targets import TARGETS

target = TARGETS[sys.argv.pop(1)]
atheris.Setup(sys.argv, target)
atheris.Fuzz()
