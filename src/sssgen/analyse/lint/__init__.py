"""`sssgen lint`: the operations of a program that have a domain, what is assumed, and reports for other tools."""
