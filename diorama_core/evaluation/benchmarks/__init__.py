"""What is run to measure it, one module a `diorama bench` subject."""
