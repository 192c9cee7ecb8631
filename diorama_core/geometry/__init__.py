"""Maths without opinions: transforms, boxes, planes, surfaces, collision."""
