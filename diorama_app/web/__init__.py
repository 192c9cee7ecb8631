"""What viser does not do: access control, uploads, pictures over HTTP, panels drawn as HTML."""
