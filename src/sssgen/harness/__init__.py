"""What runs the generated text: compilers that this project did not write, and a report of what they said."""
