"""The front end: source text → syntax tree → checked IR."""
