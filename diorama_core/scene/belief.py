"""How sure a build is of an object: probabilities of what it decided and of the alternatives."""

from __future__ import annotations

from dataclasses import dataclass, replace

Shares = tuple[tuple[str, float], ...]
"""Alternatives with their probabilities, the one that was decided first, then the others, likeliest first."""
CERTAIN_FRONT = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Belief:
    """What is believed of one object. What a person says is certain; an empty tuple says that nothing is known."""

    present: float = 1.0
    """Probability that there is such an object at all."""
    kinds: Shares = ()
    """Categories."""
    fronts: tuple[float, ...] = ()
    """Probabilities that it faces where it was put, and one to three quarters of a turn left of it, given its kind."""
    supporters: Shares = ()
    """Ids of objects and planes that hold it, given its kind."""
    place_sigma_m: float = 0.0
    """Standard deviation of its place, nearly all of it along the line of sight."""
    size_sigma: float = 0.0
    """Standard deviation of the logarithm of its size."""

    @property
    def right(self) -> float:
        """Probability that all that was decided is right, its exact place and size apart."""
        shares = (*self.kinds[:1], *self.supporters[:1])
        probability = self.present * (self.fronts[0] if self.fronts else 1.0)
        for _, share in shares:
            probability *= share
        return probability

    def with_kind(self, kind: str) -> Belief:
        """This belief once a person said what the object is: so there is one."""
        return replace(self, present=1.0, kinds=((kind, 1.0),))

    def with_front(self) -> Belief:
        """This belief once a person said which way the object faces, and it was turned there."""
        return replace(self, present=1.0, fronts=CERTAIN_FRONT)

    def with_supporter(self, supporter: str) -> Belief:
        """This belief once a person said what holds the object."""
        return replace(self, present=1.0, supporters=((supporter, 1.0),))
