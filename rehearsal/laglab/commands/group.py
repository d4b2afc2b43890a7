"""A command that has commands: alone it shows its help."""

from collections.abc import Callable

import typer


def alone(context: typer.Context) -> None:
    """Without a command, show the help."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def group(
    help: str,  # noqa: A002 as Typer calls it
    callback: Callable[..., None] = alone,
    completion: bool = False,
) -> typer.Typer:
    """An empty group; `help` says what it is for; `completion`: shells can learn to complete it."""
    return typer.Typer(
        help=help,
        callback=callback,
        invoke_without_command=True,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        add_completion=completion,
    )
