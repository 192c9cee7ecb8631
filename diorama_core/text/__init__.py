"""From words to rooms and edits: a grammar, a language model where one is set up, and a composer of rooms."""
