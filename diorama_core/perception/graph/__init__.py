"""What holds up what, from where objects are: without asking anybody."""
