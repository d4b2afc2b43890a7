"""A command that has commands: alone it shows its help."""

import typer


def group(help: str) -> typer.Typer:  # noqa: A002 as Typer calls it
    """An empty one, with what it is for."""
    return typer.Typer(
        help=help,
        callback=_alone,
        invoke_without_command=True,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        add_completion=False,
    )


def _alone(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
