"""What is done to the IR between the front end and the printers: one idea a file, each a pure function of a module."""
