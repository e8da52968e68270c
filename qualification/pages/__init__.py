"""Each module writes one page of docs/ from what it measures."""
