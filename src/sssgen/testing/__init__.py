"""Users' own tests: the pytest plug-in, `sssgen ci`, golden pictures."""
