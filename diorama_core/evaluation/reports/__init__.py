"""Tables and pictures, beside the paper's."""
