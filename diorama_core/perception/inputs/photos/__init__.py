"""Photos: decoded, upright, eight bits, without frames."""
