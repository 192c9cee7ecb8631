"""Networks: which there are, fetching them, running them; one facade per network. No weights come with Diorama."""
