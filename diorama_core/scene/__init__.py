"""What a scene is: immutable values, pure edits, history and the documented file."""
