"""The paper's recipes."""
