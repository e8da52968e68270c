"""What an editor shows of a file while it is written: errors, explanations, completions, definitions, lenses.

The functions here work on texts and places; `server` alone speaks the language server protocol.
"""
