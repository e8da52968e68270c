"""`python -m sssgen` is `sssgen`."""

from .cli import program

if __name__ == "__main__":
    program()
