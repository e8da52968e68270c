"""What `sssgen show` prints: one module for each kind of thing, with the name of the kind in `show.KINDS`.

Each has `names()`; `describe(name)`, which gives the facts for JSON; and `lines(facts, width)`, which gives them as
text.
"""
