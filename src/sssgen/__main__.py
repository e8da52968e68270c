"""`python -m sssgen` is `sssgen`."""

from sssgen.cli.main import main

if __name__ == "__main__":
    raise SystemExit(main())
