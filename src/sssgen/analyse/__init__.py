"""What is wrong with a program: `lint`, `stress`, and `transpile --verify`."""
