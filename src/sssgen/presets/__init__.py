"""Ready materials that work on any mesh, and projects of engines that show them."""
