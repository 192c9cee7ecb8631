"""Which shapes could stand for each object, best first."""
