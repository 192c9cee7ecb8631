"""PlainRecon as published: the baseline."""
