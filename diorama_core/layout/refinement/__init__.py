"""After the layout: poses are fitted to the photo's masks, as far as supports, walls and neighbours leave room."""
