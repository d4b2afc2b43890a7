"""``laglab``, and ``python -m laglab``: Ctrl-C ends it in one line from the first moment on."""

import sys

INTERRUPTED = 130


def main() -> None:
    """Run the command; while it is still being loaded, too, an interrupt is no traceback."""
    try:
        from laglab.command import run_command

        code = run_command(None)
    except KeyboardInterrupt:
        print("laglab: interrupted", file=sys.stderr)
        code = INTERRUPTED
    sys.exit(code)


if __name__ == "__main__":
    main()
