"""What the photo says of how objects look: pictures of flat faces, materials of surfaces, and the light."""
