"""Printers: from IR to the text of one language. `printer.py` has what the languages share."""
