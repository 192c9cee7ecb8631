"""From words to a picture of a room: by an image endpoint, or composed from the library by a room grammar."""
