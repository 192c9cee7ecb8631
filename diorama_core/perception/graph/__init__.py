"""What holds up what, from where things are: without asking anybody."""
