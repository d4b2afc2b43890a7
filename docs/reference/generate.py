"""Write what is generated of the reference, beside this file: python docs/reference/generate.py"""

from pathlib import Path

from laglab.export.reference import page
from laglab.scenario.reference import GENERATED

for name, make in (GENERATED | {"topics.md": page}).items():
    (Path(__file__).parent / name).write_text(make(), encoding="utf-8")
