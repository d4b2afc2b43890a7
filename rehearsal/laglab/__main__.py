"""``laglab``, and ``python -m laglab``: Ctrl-C ends it in one line from the first moment on."""

import sys

from laglab.interrupts import deafen, leave, on_interrupt


def main() -> None:
    """Run the command."""
    on_interrupt(leave)
    try:
        from laglab.command import run_command

        code = run_command(None)
    except KeyboardInterrupt:
        leave()
    deafen()  # it is over: there is nothing left to interrupt
    sys.exit(code)


if __name__ == "__main__":
    main()
