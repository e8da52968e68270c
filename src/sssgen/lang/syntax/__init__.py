"""Source text to syntax tree: lexer, parser tables, tree."""
