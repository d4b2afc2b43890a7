"""Write what is generated of the reference, beside this file: python docs/reference/generate.py"""

import inspect
import pkgutil
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import typer

import laglab
from laglab.command import app_of
from laglab.errors import LaglabError
from laglab.export.reference import page as topics
from laglab.scenario.reference import GENERATED as OF_SCENARIOS
from laglab_protocol.dialect.mavgen import dialect_path

HERE = Path(__file__).parent
MADE = "<!-- Generated: python docs/reference/generate.py -->"
TREES = ("laglab_fmu", "laglab_protocol", "laglab_gateway", "laglab_control", "laglab_station")
WIDTH = 96

COMMAND_LINE = f"""\
# The command line

{MADE}

What `laglab COMMAND --help` says. Options beat the scenario's file, and `--set KEY=VALUE` reaches
every [key of a scenario](scenario.md). `laglab --install-completion` teaches the shell to complete.
[Exit codes](errors.md) are the same for all commands.
"""
ERRORS = f"""\
# Exit codes and errors

{MADE}

What goes wrong is told in one line on standard error, that says what happened, to what, and what to
do; a traceback is a bug of ours.

| exit code | |
|---|---|
| 0 | the run reached its end, or the command did what it was asked |
| 1 | `conform`, `protocol lint`, `check`, `plant check` or `soak` found faults |
| 2 | something that was asked for cannot be; nothing has run |
| 3 | the estimate diverged, and the robot was stopped |
| 4 | a side, the link or the disk failed, or another station took over |
| 5 | an emergency stop |
| 130 | interrupted, here or on the other side: Ctrl-C, SIGTERM, or the terminal closed |
| 141 | whoever read the output went away |

From Python these are exceptions, one tree in each package. Those of `laglab` carry the exit code
with which the command line ends.
"""
MESSAGES = f"""\
# Messages

{MADE}

Those of the dialect, `protocol/laglab.xml`, as mavgen reads it. Who sends what when, and what the
other side owes in return, is told in [the protocol](../../protocol/README.md). Fields stand in the
order in which they travel.
"""


def command_line() -> str:
    """Every command's help, as it is printed."""
    return COMMAND_LINE + "".join(_commands(typer.main.get_command(app_of()), "laglab"))


def _commands(command: object, name: str) -> Iterator[str]:
    context = command.make_context(name, [], resilient_parsing=True)  # type: ignore[attr-defined]
    context.terminal_width = context.max_content_width = WIDTH
    text = "\n".join(line.rstrip() for line in context.get_help().splitlines())
    yield f"\n## `{name}`\n\n```text\n{text.strip()}\n```\n"
    for each, inner in sorted(getattr(command, "commands", {}).items()):
        yield from _commands(inner, f"{name} {each}")


def errors() -> str:
    """The exit codes, and the trees of exceptions."""
    for package in (laglab, *map(import_module, TREES)):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.endswith("__main__"):
                import_module(module.name)  # or some of them are not known yet
    ours = "| `laglab` | exit code | |\n|---|---|---|\n" + "".join(
        f"| {'· ' * depth}`{kind.__name__}` | {kind.exit_code} | {_sentence(kind)} |\n"
        for depth, kind in _tree(LaglabError)
    )
    return "\n".join([ERRORS, ours, *map(_of_component, TREES)])


def _of_component(name: str) -> str:
    module = import_module(f"{name}.errors")
    (root,) = [
        each
        for each in vars(module).values()
        if isinstance(each, type) and each.__bases__ == (Exception,)
    ]
    import_module(name)
    return f"| `{name}` | |\n|---|---|\n" + "".join(
        f"| {'· ' * depth}`{kind.__name__}` | {_sentence(kind)} |\n" for depth, kind in _tree(root)
    )


def _tree(root: type, depth: int = 0) -> Iterator[tuple[int, type]]:
    yield depth, root
    for kind in sorted(root.__subclasses__(), key=lambda each: each.__name__):
        yield from _tree(kind, depth + 1)


def _sentence(kind: type) -> str:
    return (inspect.getdoc(kind) or "").split("\n\n")[0].replace("\n", " ")


def messages() -> str:
    """The dialect's own messages, a table each."""
    root = ElementTree.parse(dialect_path()).getroot()
    return MESSAGES + "".join(map(_message, root.iter("message")))


def _message(message: ElementTree.Element) -> str:
    fields = "".join(
        f"| `{field.get('name')}` | {field.get('type')} | {field.get('units') or '-'} "
        f"| {' '.join((field.text or '').split())} |\n"
        for field in message.iter("field")
    )
    return (
        f"\n## {message.get('name')} ({message.get('id')})\n\n{message.findtext('description')}\n\n"
        f"| field | type | unit | |\n|---|---|---|---|\n{fields}"
    )


GENERATED: Mapping[str, Callable[[], str]] = {
    **OF_SCENARIOS,
    "topics.md": topics,
    "command-line.md": command_line,
    "errors.md": errors,
    "messages.md": messages,
}

if __name__ == "__main__":
    for name, make in GENERATED.items():
        (HERE / name).write_text(make(), encoding="utf-8")
