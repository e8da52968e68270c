"""`sssgen check`: shader files and the compilers that read them."""
