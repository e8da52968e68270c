"""`sssgen completion`: the script that makes a shell complete commands, options and names.

The completion itself is argcomplete's (https://github.com/kislyuk/argcomplete, Apache License 2.0): the shell runs
`sssgen` with a variable set, and `main` calls `complete`. Nothing of it is imported otherwise.
"""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from sssgen.cli.output import OK, print_result

SHELLS = {
    "bash": 'eval "$(sssgen completion bash)"   # in ~/.bashrc',
    "zsh": 'eval "$(sssgen completion zsh)"   # in ~/.zshrc, after compinit',
    "fish": "sssgen completion fish | source   # in ~/.config/fish/config.fish",
}
"""Shell → the line for its start file."""


def add_options(parser: ArgumentParser) -> None:
    lines = "\n".join(f"  {shell}: {line}" for shell, line in SHELLS.items())
    parser.epilog = (
        "examples:\n  sssgen completion bash\n  sssgen completion fish\n"
        f"Add the line to the start file of your shell:\n{lines}"
    )
    parser.add_argument("SHELL", choices=tuple(SHELLS), help=", ".join(SHELLS))


def run(arguments: Namespace) -> int:
    """Prints the script."""
    from argcomplete.shell_integration import shellcode

    script = shellcode(["sssgen"], shell=arguments.SHELL)
    print_result(arguments.json, {"shell": arguments.SHELL, "script": script}, script)
    return OK
