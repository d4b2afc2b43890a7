"""``python -m laglab`` is the ``laglab`` command."""

from laglab.command import main

if __name__ == "__main__":
    main()
