"""The subcommands of `sssgen`, one module each; a module is imported when its command runs."""
