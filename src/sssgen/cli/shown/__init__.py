"""What `sssgen show` prints: one module for each kind of thing.

Each has `names()`; `describe(name)`, which gives the facts for JSON; and `lines(facts, width)`, which gives them as
text.
"""
