"""Room layout by render and compare (Stekovic et al. 2020): a baseline."""
